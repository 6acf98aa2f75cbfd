"""The deformed bodies over the time of a run, as a GIF or a film."""

import os

import matplotlib.animation
import numpy as np

from .errors import ResultsError
from .figures import Picture
from .overview import shown_faces
from .render import view_axes
from .views import colours, default_view, is_flat, show, window_around

PIXELS = 500  # along the longer side of the picture of the bodies
KINDS = {".gif": matplotlib.animation.PillowWriter, ".mp4": matplotlib.animation.FFMpegWriter}


def animate(results, path, *, field="von_mises", view=None, cut=None, title=None, frames_per_second=8):
    """Writes a picture for each time that there are fields of to path, NAME.gif or NAME.mp4 (which needs ffmpeg), all in one frame
    and with one scale of colours. field: of the bodies, "von_mises" or "displacement z"; view and cut: as of plot(). The last
    picture stands for a second. @throws ResultsError"""
    kind = os.path.splitext(path)[1].lower()
    if kind not in KINDS:
        raise ResultsError(f"{path}: an animation is a .gif or a .mp4")
    if not KINDS[kind].isAvailable():
        raise ResultsError(f"{path}: there is no ffmpeg to write it with; install it (Debian: apt-get install ffmpeg), or take a .gif")

    times = results.times
    axes = view_axes(*(view or default_view(results.bodies(times[-1]).points)))
    faces, projected, values = [], [], []
    for t in times:  # what all of them fit into
        bodies = results.bodies(t)
        faces.append(shown_faces(bodies, cut))
        there = np.unique(faces[-1])
        projected.append(bodies.points[there] @ axes.T)
        values.append(bodies.field(field)[there])
    window = window_around(np.concatenate(projected), 0.04)
    least, largest = min(v.min() for v in values), max(v.max() for v in values)
    colour_map = colours("viridis", largest, min(least, 0))

    height = 4.2 if is_flat(window) else 5.8
    figure = Picture(figsize=(7.6, height), layout="constrained")
    unfinished = f"{os.path.splitext(path)[0]}.incomplete{kind}"
    writer = KINDS[kind](fps=frames_per_second)
    with writer.saving(figure, unfinished, dpi=100):
        for t, shown in zip(times, faces):
            bodies = results.bodies(t)
            figure.clear()
            axis = figure.subplots()
            show(figure, axis, bodies.points, shown, bodies.field(field), axes, window, colour_map, field.replace("_", " "), 0.45,
                 PIXELS)
            figure.suptitle(f"{title or os.path.basename(os.path.normpath(results.folder))}, t = {t:g}")
            figure.draw_without_rendering()  # the layout settles in the second drawing
            for _ in range(1 if t < times[-1] else frames_per_second):
                writer.grab_frame()
    os.replace(unfinished, path)
