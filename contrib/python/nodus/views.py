"""Where pictures of results look from and what they frame; shared by figures and the overview."""

import matplotlib.cm
import matplotlib.colors
import numpy as np

from .render import axes_facing, render, view_axes

PANEL_PIXELS = 900


def colours(name, largest, least=0):
    """The function that maps values in [least, largest] to RGB, and what the colour bar needs."""
    scale = matplotlib.cm.ScalarMappable(matplotlib.colors.Normalize(least, largest if largest > least else least + 1), name)
    return (lambda values: scale.to_rgba(values)[:, :3]), scale


def window_around(projected, margin, narrowest=0.35):
    """Window (left, right, bottom, top) around projected points; narrowest is its least ratio of sides."""
    low, high = projected[:, :2].min(0), projected[:, :2].max(0)
    size = np.maximum(high - low, narrowest * np.max(high - low))
    centre = (low + high) / 2
    low, high = centre - (0.5 + margin) * size, centre + (0.5 + margin) * size
    return low[0], high[0], low[1], high[1]


def is_flat(window):
    return window[3] - window[2] < 0.5 * (window[1] - window[0])


def picture(axis, points, faces, values, axes, window, function, edges, resolution=PANEL_PIXELS):
    pixels = np.array([window[1] - window[0], window[3] - window[2]])
    pixels = (resolution * pixels / pixels.max()).round().astype(int)
    image = render(points, faces, values, axes, window, pixels, function, edges=edges)
    axis.imshow(image, extent=window, interpolation="antialiased")
    axis.set_aspect("equal")
    name_axes(axis, axes)


def show(figure, axis, points, faces, values, axes, window, colour_map, label, edges, resolution=PANEL_PIXELS):
    function, scale = colour_map
    picture(axis, points, faces, values, axes, window, function, edges, resolution)
    place = {"location": "bottom", "fraction": 0.07} if is_flat(window) else {"fraction": 0.046}
    figure.colorbar(scale, ax=axis, label=label, pad=0.03, **place)


def show_statuses(axis, surface, faces, axes, window, palette):
    """Every point of the surface in the colour of the node that weighs most there."""
    status = surface.fields["CSTATUS"].round().astype(int)
    rgb = np.array([matplotlib.colors.to_rgb(colour) for colour in palette])
    picture(axis, surface.points, faces, np.eye(len(rgb))[status], axes, window,
            lambda weights: rgb[np.argmax(weights, axis=1)], 0.35)


def name_axes(axis, axes):
    """Coordinates when the picture looks along one of them, otherwise the three directions in a corner."""
    main = np.argmax(np.abs(axes), axis=1)
    if np.allclose(np.abs(axes).max(1), 1):
        for set_label, set_format, direction in (
            (axis.set_xlabel, axis.xaxis.set_major_formatter, 0),
            (axis.set_ylabel, axis.yaxis.set_major_formatter, 1),
        ):
            sign = np.sign(axes[direction, main[direction]])
            set_label("xyz"[main[direction]])
            set_format(lambda value, _, sign=sign: f"{sign * value:g}")
        axis.tick_params(labelsize="small")
        for side in ("top", "right"):
            axis.spines[side].set_visible(False)
        return
    axis.set_axis_off()
    for direction, letter in enumerate("xyz"):
        tip = 0.075 * axes[:2, direction]
        if np.linalg.norm(tip) < 0.01:
            continue
        axis.annotate("", xy=(0.02 + tip[0], 0.02 + tip[1]), xytext=(0.02, 0.02), xycoords="axes fraction",
                      arrowprops={"arrowstyle": "->", "lw": 1.2, "shrinkA": 0, "shrinkB": 0})
        axis.annotate(letter, xy=(0.02 + 1.35 * tip[0], 0.02 + 1.35 * tip[1]), xycoords="axes fraction",
                      ha="center", va="center")


def coordinates(points):
    """What formulas of profiles and cuts may use."""
    x, y, z = points.T
    return {"x": x, "y": y, "z": z, "r": np.hypot(x, y), "angle": np.degrees(np.arctan2(y, x))}


def contact_zone(surface):
    """Nodes of the faces with a node under pressure (of all when there is none), and the faces near them that hang together
    with these."""
    pressure = surface.fields["CPRESS"]
    loaded = pressure > 0.01 * pressure.max() if pressure.max() > 0 else np.ones(len(pressure), bool)
    nodes = np.unique(surface.cells[loaded[surface.cells].any((1, 2))])
    centre, size = surface.points[nodes].mean(0), np.ptp(surface.points[nodes], axis=0).max()
    distance = np.linalg.norm(surface.points[surface.cells].mean((1, 2)) - centre, axis=1)
    near = surface.cells[distance < 2 * size]
    return nodes, near[_reached(near, nodes, len(pressure))]


def _reached(faces, nodes, n_nodes):
    """Which faces are reached from nodes, over nodes that faces share."""
    seen = np.zeros(n_nodes, bool)
    seen[nodes] = True
    reached, before = np.zeros(len(faces), bool), -1
    while reached.sum() > before:
        before = reached.sum()
        reached = seen[faces].any((1, 2))
        seen[faces[reached]] = True
    return reached


def contact_view(surface, nodes, faces):
    """Axes of a look at the contact along its normal; a closed contact has none and is seen from outside and above."""
    weight = surface.fields["CPRESS"][nodes] if surface.fields["CPRESS"].max() > 0 else np.ones(len(nodes))
    normal = weight @ surface.fields["normal"][nodes] / weight.sum()
    if np.linalg.norm(normal) < 0.3:
        return view_axes(-60.0, 35.0)
    corner = surface.points[faces[:, [0, 0, -1, -1], [0, -1, 0, -1]]]
    face_normals = np.cross(corner[:, 3] - corner[:, 0], corner[:, 2] - corner[:, 1])
    cosine = np.abs(face_normals @ normal) / (np.linalg.norm(face_normals, axis=1) * np.linalg.norm(normal))
    return axes_facing(normal, either_side=cosine.min() > 0.5)


def default_view(points):
    """From the side of negative y, a little from above; at a slice straight on."""
    size = np.ptp(points, axis=0)
    thin = int(np.argmin(size))
    return ((0.0, 0.0), (-90.0, 0.0), (-90.0, 90.0))[thin] if size[thin] < 0.15 * size.max() else (-60.0, 22.0)
