"""One picture of a results folder: the deformed bodies, the contact pressure, and a profile of it."""

import os

import numpy as np

from .errors import ResultsError
from .figures import Picture, _condition, _draw_curves, axis_name
from .render import boundary_faces, view_axes
from .views import colours, contact_view, contact_zone, coordinates, default_view, is_flat, show, window_around

# Contact zones smaller than this part of the model get a close-up.
CLOSE_UP_BELOW = 0.25


def _plot_profile(axis, surface, profile):
    field, variable, where, curves = profile
    known = coordinates(surface.points)
    chosen = _condition(where, known) if where else np.ones(len(surface.points), bool)
    if not chosen.any():
        raise ResultsError(f'no node of the contact surface satisfies "{where}"')
    abscissa, ordinate = known[variable][chosen], surface.field(field)[chosen]

    # where the contact is, and a little more
    loaded = known[variable][contact_zone(surface)[0]]
    margin = 0.15 * np.ptp(loaded)
    low = 0 if variable == "r" else max(loaded.min() - margin, abscissa.min())
    high = min(loaded.max() + margin, abscissa.max())
    near = (abscissa >= low) & (abscissa <= high)

    axis.plot(abscissa[near], ordinate[near], "o", ms=3.5, mfc="none", label="nodus, nodes", zorder=3)
    _draw_curves(axis, curves, np.linspace(low, high, 500))
    axis.set_xlabel(axis_name(variable))
    axis.set_ylabel("contact pressure" if field == "CPRESS" else field)
    axis.set_xlim(low, high)
    if field == "CPRESS":
        axis.set_ylim(min(0, 1.1 * ordinate[near].min()), 1.1 * max(ordinate[near].max(), axis.get_ylim()[1] / 1.1))
    axis.grid(alpha=0.3)
    axis.legend(frameon=False)


def shown_faces(bodies, cut):
    """Faces of the bodies to draw, of those cells with a centre where a condition holds."""
    keep = None
    if cut:
        keep = _condition(cut, coordinates(bodies.points[bodies.cells.reshape(len(bodies.cells), -1)].mean(1)))
        if not keep.any():
            raise ResultsError(f'no cell is left by the cut "{cut}"')
    return boundary_faces(bodies, keep)


def _panels(names, windows):
    """A figure with axes by name."""
    columns = 2 if len(names) in (2, 4) else len(names)
    rows = -(-len(names) // columns)
    flat = "profile" not in names and all(is_flat(one) for one in windows)
    figure = Picture(figsize=(6.2 * columns, (3.6 if flat else 5.4) * rows), layout="constrained")
    return figure, dict(zip(names, figure.subplots(rows, columns, squeeze=False).ravel()))


def picture(results, t=None, title=None, view=None, cut=None, profile=None):
    """view: (azimuth, elevation) of the viewer in degrees; cut: the cells with a centre where it holds, "y > 0"; profile:
    (field, x, y, z, r or angle, condition or None, curves or None). @throws ResultsError"""
    bodies = results.bodies(t)
    faces = shown_faces(bodies, cut)
    von_mises = bodies.fields["von_mises"]
    try:
        surface = results.surface(t)
    except ResultsError:
        surface = None

    axes = view_axes(*(view or default_view(bodies.points)))
    projected = bodies.points @ axes.T
    windows = [window_around(projected[np.unique(faces)], 0.04)]
    close_up = False
    if surface:
        zone, near = contact_zone(surface)
        zone_points = surface.points[zone]
        close_up = bool(np.ptp(zone_points, axis=0).max() < CLOSE_UP_BELOW * np.ptp(bodies.points, axis=0).max())
        if close_up:
            windows.append(window_around(zone_points @ axes.T, 1.0, narrowest=1))
        facing = contact_view(surface, zone, near)
        windows.append(window_around(zone_points @ facing.T, 0.15))
    names = ["bodies"] + ["close-up"] * close_up + ["pressure"] * (surface is not None)
    names += ["profile"] * (surface is not None and profile is not None)
    figure, axis = _panels(names, windows)

    stress = colours("viridis", von_mises[np.unique(faces)].max())
    for name, window, text in zip(names, windows, ("Deformed bodies", "Close-up of the contact")[: 1 + close_up]):
        show(figure, axis[name], bodies.points, faces, von_mises, axes, window, stress, "von Mises stress", 0.45)
        axis[name].set_title(text)
    if surface:
        pressure = surface.fields["CPRESS"]
        show(figure, axis["pressure"], surface.points, near, pressure, facing, windows[-1],
             colours("inferno", pressure.max()), "contact pressure (CPRESS)", 0.3)
        axis["pressure"].set_title("Slave surface")
    if "profile" in axis:
        _plot_profile(axis["profile"], surface, profile)
        axis["profile"].set_title("Profile")
    time = max(results.series("bodies")) if t is None else t
    figure.suptitle(f"{title or os.path.basename(os.path.normpath(results.folder))}, t = {time:g}")
    return figure
