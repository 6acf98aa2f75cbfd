"""State of ParaView for a results folder of nodus: deformed bodies coloured by stress, the slave surface by pressure.

In ParaView:   File > Load State, this file; the results are those of the environment variable NODUS_RESULTS, or of the
               folder that ParaView was started in.
From a shell:  NODUS_RESULTS=results/hertz paraview --script=contrib/plot/paraview_state.py
A picture:     pvpython contrib/plot/paraview_state.py results/hertz picture.png

Bodies and contact surface lie side by side in two views that share the time: the bodies as `# Plot: view` of the case file says
that NODUS_CASE names (NODUS_CASE=prm/gallery/ironing.prm), the contact zone from the side of the master. Other fields are in the
list of the colour bar: COPEN, CSTATUS (0 open, 1 slip, 2 stick), CSHEAR1, CSHEAR2, CSLIP1, CSLIP2, displacement, cauchy_stress,
and what Output/Fields names.
"""

import glob
import os
import re
import sys

import numpy as np
from paraview import servermanager
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
from vtkmodules.util.numpy_support import vtk_to_numpy

# More cells than this have edges that hide the colours.
MOST_CELLS_WITH_EDGES = 3000


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


def nodal(reader, field=None):
    """Values at the nodes, or their positions, at the time that is shown."""
    data = servermanager.Fetch(reader)
    return vtk_to_numpy(data.GetPointData().GetArray(field) if field else data.GetPoints().GetData()).astype(float)


def viewer_of_case(points):
    """Unit vector to the viewer: as in the case file, straight on a slice, or from the side of negative y, a little above."""
    path = os.environ.get("NODUS_CASE")
    if path:
        number = r"([-+]?[0-9.]+)"
        with open(path, encoding="utf-8") as file:
            view = re.search(rf"^#\s*Plot:\s*view\s+{number}\s+{number}\s*$", file.read(), re.M)
        if view:
            azimuth, elevation = (np.radians(float(angle)) for angle in view.groups())
            flat = np.cos(elevation)
            return np.array([flat * np.cos(azimuth), flat * np.sin(azimuth), np.sin(elevation)])
    size = np.ptp(points, axis=0)
    if size.min() < 0.15 * size.max():
        return np.array([1, -1, 1]) * np.eye(3)[np.argmin(size)]
    return np.array([-1.0, -2.0, 1.0]) / np.sqrt(6)


def contact_zone(contact):
    """Points under pressure (all when there are none), and the unit vector from them to the master."""
    points, pressure, normal = (nodal(contact, field) for field in (None, "CPRESS", "normal"))
    loaded = pressure > 0.01 * pressure.max() if pressure.max() > 0 else np.ones(len(pressure), bool)
    towards = np.maximum(pressure[loaded], 1e-300) @ normal[loaded]
    length = np.linalg.norm(towards)
    if length < 0.3 * np.maximum(pressure[loaded], 1e-300).sum():  # around a pin
        return points[loaded], np.array([0.5, -0.7, 0.5])
    return points[loaded], towards / length


def new_view():
    view = CreateView("RenderView")
    view.UseColorPaletteForBackground = 0
    view.Background = [1.0, 1.0, 1.0]
    view.OrientationAxesLabelColor = [0.1, 0.1, 0.1]
    view.CameraParallelProjection = 1
    return view


def look(view, points, towards):
    """At the points from far away in this direction, with z upwards, or y where that is impossible."""
    up = np.array([0, 1, 0]) if abs(towards[2]) > 0.9 else np.array([0, 0, 1])
    right = np.cross(up, towards) / np.linalg.norm(np.cross(up, towards))
    projected = points @ np.array([right, np.cross(towards, right), towards]).T
    low, high = projected.min(0), projected.max(0)
    size = np.linalg.norm(np.ptp(points, axis=0))
    centre = (low + high) / 2 @ np.array([right, np.cross(towards, right), towards])
    view.CameraFocalPoint, view.CameraPosition, view.CameraViewUp = centre, centre + 5 * size * towards, up
    width, height = (high - low)[:2]
    view.CameraParallelScale = max(0.6 * width, 0.85 * height)  # title and colour bar need the rest


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
    left = new_view()
    layout.AssignView(0, left)
    if with_contact:
        contact = read(folder, "contact")
        right = new_view()
        layout.SplitHorizontal(0, 0.5)
        layout.AssignView(2, right)

    scene = GetAnimationScene()
    scene.UpdateAnimationUsingDataTimeSteps()
    scene.GoToLast()

    SetActiveView(left)
    few = servermanager.Fetch(bodies).GetNumberOfCells() < MOST_CELLS_WITH_EDGES
    show(bodies, left, "von_mises", "von Mises stress", "Viridis (matplotlib)", few)
    label(left, os.path.basename(folder))
    points = nodal(bodies)
    Render(left)  # the first time it frames what it shows itself
    look(left, points, viewer_of_case(points))
    Render(left)
    if with_contact:
        SetActiveView(right)
        show(contact, right, "CPRESS", "contact pressure (CPRESS)", "Inferno (matplotlib)", True)
        label(right, "slave surface, from the side of the master")
        Render(right)
        look(right, *contact_zone(contact))
        Render(right)
    if len(sys.argv) > 2:
        SaveScreenshot(sys.argv[2], layout, ImageResolution=[1400, 700])


main()
