"""One picture of what a case makes of the outer faces of its bodies, before it is run: sides of contact pairs and boundary
conditions, from the file of `nodus --validate --surfaces`."""

import matplotlib.colors
import matplotlib.patches
import numpy as np

from .figures import Picture
from .mesh import read_mesh
from .render import render, view_axes
from .views import default_view, name_axes, window_around

NO_ROLE = "#d9dce1"
# slave and master of a pair have one hue, conditions have others
PAIRS = (("#174a9c", "#7db4f0"), ("#a8430f", "#f7a873"), ("#5e2f91", "#c3a0e6"), ("#0b6b6b", "#79cfcf"))
CONDITIONS = ("#2f9440", "#d6a400", "#c2186b", "#8c6239", "#7a9a01", "#e8553a", "#4d4d4d", "#b07aa1")
PIXELS = 440


class Roles:
    """mesh of the outer faces; names of the roles; faces: name -> which faces have it (n,); nodes: name -> points that it holds
    and that are not on these; colours: name -> colour."""

    def __init__(self, path):
        self.mesh = read_mesh(path)
        fields = self.mesh.cell_fields
        self.names = [name for name in fields if name not in ("body", "boundary_id")]
        self.faces = {name: fields[name] > 0.5 for name in self.names}
        self.nodes, self.colours = {}, {}
        conditions = 0
        for name in self.names:
            held = self.mesh.fields[name] > 0.5 if name in self.mesh.fields else np.zeros(len(self.mesh.points), bool)
            held[self.mesh.cells[self.faces[name]]] = False
            self.nodes[name] = np.flatnonzero(held)
            if name.startswith("contact pair"):
                pair = int(name.split()[2].rstrip(",")) - 1
                self.colours[name] = PAIRS[pair % len(PAIRS)][name.endswith("master")]
            else:
                self.colours[name] = CONDITIONS[conditions % len(CONDITIONS)]
                conditions += 1

    def text(self, name):
        """The name and, in a line of its own, what it is and how much there is of it."""
        faces, nodes = int(np.count_nonzero(self.faces[name])), len(self.nodes[name])
        whose, what = name.rsplit(", ", 1)
        if faces and (self.mesh.cell_fields["boundary_id"][self.faces[name]] < 0).all():
            return f"{whose}\n{what}, rigid, opposite to {faces} face{'s' * (faces != 1)}"
        parts = [f"{faces} face{'s' * (faces != 1)}"] * bool(faces or not nodes)
        parts += [f"{nodes} {'more ' * bool(faces)}node{'s' * (nodes != 1)}"] * bool(nodes)
        return f"{whose}\n{', '.join([what, *parts])}"


def _normals(mesh):
    """Outward normals of the faces times their areas."""
    corner = [mesh.points[mesh.cells[:, j, i]] for j, i in ((0, 0), (0, -1), (-1, -1), (-1, 0))]
    return np.cross(corner[2] - corner[0], corner[3] - corner[1]) / 2


def _looking_at(normals, otherwise):
    """Axes of a viewer who sees faces from outside, at an angle that shows their depth."""
    mean = normals.sum(0)
    if np.linalg.norm(mean) < 0.1 * np.linalg.norm(normals, axis=1).sum():
        return view_axes(*otherwise)
    x, y, z = mean / np.linalg.norm(mean)
    if np.hypot(x, y) < 0.3:
        return view_axes(otherwise[0], 40 if z > 0 else -40)
    return view_axes(np.degrees(np.arctan2(y, x)) - 25, 20 if z > -0.3 else -20)


def _draw(axis, mesh, chosen, colours, axes, window, alpha=1.):
    """The chosen faces, each in one colour."""
    faces = mesh.cells[chosen]
    if not len(faces):
        return
    rgb = np.array([matplotlib.colors.to_rgb(colour) for colour in np.asarray(colours)[chosen]])
    points = mesh.points[faces].reshape(-1, 3)
    numbers = np.arange(len(points)).reshape(faces.shape)
    pixels = np.array([window[1] - window[0], window[3] - window[2]])
    pixels = (PIXELS * pixels / pixels.max()).round().astype(int)
    image = render(points, numbers, np.repeat(rgb, faces[0].size, axis=0), axes, window, pixels, lambda value: value, edges=0.5)
    axis.imshow(image, extent=window, interpolation="antialiased", alpha=alpha)


def _window(mesh, axes):
    return window_around(mesh.points[np.unique(mesh.cells)] @ axes.T, 0.04)


def _panel(axis, roles, shown, behind, colours, axes, names):
    """Faces that are shown, others that are hinted at, and single nodes of the roles named."""
    mesh = roles.mesh
    window = _window(mesh, axes)
    _draw(axis, mesh, behind, colours, axes, window, 0.2)
    _draw(axis, mesh, shown, colours, axes, window)
    for name in names:
        place = mesh.points[roles.nodes[name]] @ axes.T
        axis.plot(place[:, 0], place[:, 1], "o", ms=4, mfc=roles.colours[name], mec="black", mew=0.5)
    axis.set_xlim(window[:2])
    axis.set_ylim(window[2:])
    axis.set_aspect("equal")
    name_axes(axis, axes)
    axis.set_axis_off()


def picture(path, title=""):
    """All roles from two sides and a legend, then each role by itself, seen from outside, on its bodies. @throws ResultsError"""
    roles = Roles(path)
    mesh, names = roles.mesh, roles.names
    every = np.ones(len(mesh.cells), bool)
    view = default_view(mesh.points)
    if view[1] == 0 or view[1] == 90:  # a slice
        view = (view[0] + 15, 20) if view[1] == 0 else (-75, 60)
    normals, body = _normals(mesh), mesh.cell_fields["body"]
    nodes = {name: np.isin(mesh.cells, roles.nodes[name]).any((1, 2)) for name in names}  # faces around single nodes
    looks = {name: _looking_at(normals[roles.faces[name] if roles.faces[name].any() else nodes[name]], view) for name in names}
    around = [view_axes(*view), view_axes(view[0] + 180, -view[1])]
    ratios = [(top - bottom) / (right - left) for left, right, bottom, top in (_window(mesh, axes) for axes in (*around, *looks.values()))]

    columns = 3 if len(names) <= 6 else 4
    rows = -(-(len(names) + 3) // columns)
    ratios.insert(2, min(0.3 + 0.1 * len(names), 0.9))  # the legend
    heights = [3.8 * min(max(0.4, *ratios[columns * row:columns * (row + 1)]), 1) + 0.6 for row in range(rows)]
    figure = Picture(figsize=(4.1 * columns, sum(heights) + 0.3), layout="constrained")
    panels = figure.subplots(rows, columns, squeeze=False, gridspec_kw={"height_ratios": heights}).ravel()
    for panel in panels:
        panel.set_axis_off()
    first = np.full(len(mesh.cells), NO_ROLE, dtype=object)
    for name in reversed(names):
        first[roles.faces[name]] = roles.colours[name]
    for panel, axes, text in zip(panels, around, ("All", "All, from the opposite side")):
        _panel(panel, roles, every, ~every, first, axes, names)
        panel.set_title(text, fontsize="medium")
    patches = [matplotlib.patches.Patch(color=roles.colours[name], label=roles.text(name)) for name in names]
    patches.append(matplotlib.patches.Patch(color=NO_ROLE, label="no role"))
    panels[2].legend(handles=patches, loc="center left", frameon=False, fontsize="small", title_fontsize="small",
                     title="Of several roles of a face\nthe first one is drawn under All")
    for panel, name in zip(panels[3:], names):
        own = roles.faces[name]
        bodies = np.isin(body, body[own | nodes[name]])
        _panel(panel, roles, bodies, ~bodies, np.where(own, roles.colours[name], NO_ROLE), looks[name], [name])
        dark = 0.75 * np.array(matplotlib.colors.to_rgb(roles.colours[name]))
        panel.set_title(roles.text(name), color=dark, fontsize="medium", fontweight="bold")
    figure.suptitle(title)
    return figure
