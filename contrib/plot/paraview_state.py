"""State of ParaView for a results folder of nodus: deformed bodies coloured by stress, the slave surface by pressure.

In ParaView:   File > Load State, this file; the results are those of the environment variable NODUS_RESULTS, or of the
               folder that ParaView was started in.
From a shell:  NODUS_RESULTS=results/hertz paraview --script=contrib/plot/paraview_state.py
A picture:     pvpython contrib/plot/paraview_state.py results/hertz picture.png

Bodies and contact surface lie side by side in two views that share the time. Other fields are in the list of the colour
bar: COPEN, CSTATUS (0 open, 1 slip, 2 stick), CSHEAR1, CSHEAR2, CSLIP1, CSLIP2, displacement, cauchy_stress, and what Output/Fields names.
"""

import glob
import os
import sys

from paraview.simple import (
    ColorBy,
    CreateLayout,
    CreateView,
    GetAnimationScene,
    GetColorTransferFunction,
    GetScalarBar,
    PVDReader,
    Render,
    SaveScreenshot,
    SetActiveView,
    Show,
    Text,
    WarpByVector,
)


def results_folder():
    folder = sys.argv[1] if len(sys.argv) > 1 else os.environ.get("NODUS_RESULTS", os.getcwd())
    if not os.path.exists(os.path.join(folder, "bodies.pvd")):
        sys.exit(f"paraview_state: there is no bodies.pvd in {folder}; set NODUS_RESULTS to a results folder")
    return os.path.abspath(folder)


def read(folder, name):
    """What the .pvd refers to, warped by the displacement where the points are not those of the deformed configuration."""
    reader = PVDReader(registrationName=name, FileName=os.path.join(folder, name + ".pvd"))
    with open(glob.glob(os.path.join(folder, name + "_*.vtu"))[0], encoding="utf-8") as file:
        head = file.read(1000)
    if '>1<' in head[head.index('Name="deformed"'):].split("\n", 1)[0]:
        return reader
    return WarpByVector(registrationName=name + ", deformed", Input=reader, Vectors=["POINTS", "displacement"], ScaleFactor=1)


def show(reader, view, field, title, preset, edges):
    """The surface of what the reader reads, coloured by a field at the nodes."""
    display = Show(reader, view)
    display.Representation = "Surface With Edges" if edges else "Surface"
    display.EdgeColor = [0.25, 0.25, 0.25]
    display.NonlinearSubdivisionLevel = 2  # cells of degree 2 are curved
    ColorBy(display, ("POINTS", field))
    colours = GetColorTransferFunction(field)
    colours.ApplyPreset(preset, True)
    display.RescaleTransferFunctionToDataRange(False, True)
    bar = GetScalarBar(colours, view)
    bar.Title, bar.ComponentTitle = title, ""
    bar.TitleColor = bar.LabelColor = [0.1, 0.1, 0.1]
    bar.TitleFontSize = bar.LabelFontSize = 12
    bar.Orientation, bar.WindowLocation, bar.ScalarBarLength = "Horizontal", "Lower Center", 0.4
    display.SetScalarBarVisibility(view, True)
    return display


def new_view(direction, up):
    view = CreateView("RenderView")
    view.UseColorPaletteForBackground = 0
    view.Background = [1.0, 1.0, 1.0]
    view.OrientationAxesLabelColor = [0.1, 0.1, 0.1]
    view.CameraPosition, view.CameraFocalPoint, view.CameraViewUp = direction, [0, 0, 0], up
    return view


def label(view, text):
    display = Show(Text(Text=text), view)
    display.WindowLocation = "Upper Center"
    display.Color = [0.1, 0.1, 0.1]
    display.FontSize = 12


def main():
    folder = results_folder()
    bodies = read(folder, "bodies")
    with_contact = os.path.exists(os.path.join(folder, "contact.pvd"))

    layout = CreateLayout("nodus")
    left = new_view([-1.0, -2.0, 1.0], [0, 0, 1])
    layout.AssignView(0, left)
    views = [left]
    if with_contact:
        contact = read(folder, "contact")
        right = new_view([0.0, 0.0, -1.0], [0, 1, 0])
        layout.SplitHorizontal(0, 0.5)
        layout.AssignView(2, right)
        views.append(right)

    scene = GetAnimationScene()
    scene.UpdateAnimationUsingDataTimeSteps()
    scene.GoToLast()

    SetActiveView(left)
    show(bodies, left, "von_mises", "von Mises stress", "Viridis (matplotlib)", True)
    label(left, os.path.basename(folder))
    if with_contact:
        SetActiveView(right)
        show(contact, right, "CPRESS", "contact pressure (CPRESS)", "Inferno (matplotlib)", True)
        label(right, "slave surface, seen from below")
    for view in views:
        view.ResetCamera(False)
        view.CameraParallelProjection = 1
        Render(view)
    if len(sys.argv) > 2:
        SaveScreenshot(sys.argv[2], layout, ImageResolution=[1400, 700])


main()
