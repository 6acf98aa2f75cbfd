"""Decks that the test converts: boxes, a ball, a rod and mixtures, written as Abaqus and CalculiX have them."""

import itertools

import numpy as np

HEXAHEDRON = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]
EDGES = {"C3D10": [(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)],
         "C3D15": [(0, 1), (1, 2), (2, 0), (3, 4), (4, 5), (5, 3), (0, 3), (1, 4), (2, 5)],
         "C3D20": [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7)]}


class Nodes:
    """Numbers of points, the same for the same point."""

    def __init__(self):
        self.points, self._numbers = [], {}

    def number(self, point):
        key = tuple(np.round(np.asarray(point, float) * 2**20).astype(int))
        if key not in self._numbers:
            self.points.append(point)
            self._numbers[key] = len(self.points)
        return self._numbers[key]

    def element(self, kind, corners):
        """Corners and, of second order, middles of edges."""
        corners = [np.asarray(corner, float) for corner in corners]
        return [self.number(c) for c in corners] + [self.number((corners[a] + corners[b]) / 2) for a, b in EDGES.get(kind, ())]

    def text(self, place=lambda p: p):
        return "*NODE\n" + "".join("{}, {:.16g}, {:.16g}, {:.16g}\n".format(n, *place(np.asarray(p)))
                                   for n, p in enumerate(self.points, 1))


def elements_text(kind, elements, first=1, more=""):
    """*ELEMENT, with lines that go on after ten numbers."""
    text = f"*ELEMENT, TYPE={kind}{more}\n"
    for number, nodes in enumerate(elements, first):
        entries = [str(n) for n in [number, *nodes]]
        text += "".join(", ".join(entries[i:i + 10]) + (",\n" if i + 10 < len(entries) else "\n")
                        for i in range(0, len(entries), 10))
    return text


def grid(n):
    return itertools.product(range(n), repeat=3)


def box(kind, n, nodes=None, origin=(0, 0, 0)):
    """(nodes, elements) of a unit cube of n x n x n hexahedra, or six times as many tetrahedra or two times wedges."""
    nodes, elements = nodes or Nodes(), []
    for k, j, i in grid(n):
        at = np.array(origin) + np.array([i, j, k]) / n
        corner = [at + np.array(c) / n for c in HEXAHEDRON]
        if kind in ("C3D8", "C3D20"):
            elements.append(nodes.element(kind, corner))
        elif kind in ("C3D6", "C3D15"):
            elements += [nodes.element(kind, [corner[c] for c in prism]) for prism in ((0, 1, 2, 4, 5, 6), (0, 2, 3, 4, 6, 7))]
        else:
            elements += [nodes.element(kind, [corner[c] for c in tetrahedron]) for tetrahedron in tetrahedra_of_cube()]
    return nodes, elements


def tetrahedra_of_cube():
    """Six, along the diagonal from corner 0 to corner 6; of positive orientation."""
    for order in itertools.permutations(range(3)):
        path = [np.zeros(3)]
        for d in order:
            path.append(path[-1] + np.eye(3)[d])
        chosen = [HEXAHEDRON.index(tuple(p.astype(int))) for p in path]
        steps = np.diff(np.array(path), axis=0)
        yield chosen if np.linalg.det(steps) > 0 else [chosen[1], chosen[0], chosen[2], chosen[3]]


def simplices(n, dimension):
    """Corners of the n^dimension simplices of the one at the origin with unit edges along the axes."""
    for cell in itertools.product(range(n), repeat=dimension):
        for order in itertools.permutations(range(dimension)):
            path = [np.array(cell)]
            for d in order:
                path.append(path[-1] + np.eye(dimension, dtype=int)[d])
            if all(np.all(np.diff(p) <= 0) for p in path):  # x >= y >= z
                yield [np.append(p[:-1] - p[1:], p[-1]) / n for p in path]


def round_out(p):
    """From where the sum of |coordinates| is r to where the distance is."""
    length = np.linalg.norm(p)
    return p * (np.abs(p).sum() / length) if length else p


def ball(kind, n):
    """(nodes, elements) of the unit ball in 8 n^3 tetrahedra: an octahedron before `round_out`."""
    nodes, elements = Nodes(), []
    for signs in itertools.product((1, -1), repeat=3):
        for corners in simplices(n, 3):
            corners = [c * signs for c in corners]
            if np.linalg.det(np.diff(corners, axis=0)) < 0:
                corners[:2] = corners[1::-1]
            elements.append(nodes.element(kind, corners))
    return nodes, elements


def rod(kind, n):
    """(nodes, elements) of a cylinder of radius and height 1 in 4 n^3 wedges: a square before `round_out`."""
    nodes, elements = Nodes(), []
    for signs in itertools.product((1, -1), repeat=2):
        for corners in simplices(n, 2):
            corners = [c * signs for c in corners]
            if np.linalg.det(np.diff(corners, axis=0)) < 0:
                corners[:2] = corners[1::-1]
            elements += [nodes.element(kind, [np.append(c, (k + up) / n) for up in (0, 1) for c in corners]) for k in range(n)]
    return nodes, elements


def round_about_z(p):
    return np.append(round_out(p[:2]), p[2])


def mixture(kinds):
    """A hexahedron, wedges on its side x = 1, tetrahedra on their triangles z = 1, and five hexahedra more in a row."""
    hexahedron, wedge, tetrahedron = kinds
    nodes = Nodes()
    hexahedra = [nodes.element(hexahedron, np.array(HEXAHEDRON) - (i, 0, 0)) for i in range(6)]
    low = [(1, 0), (2, 0), (2, 1), (1, 1)]
    wedges = [nodes.element(wedge, [(*low[c], z) for z in (0, 1) for c in triangle]) for triangle in ((0, 1, 2), (0, 2, 3))]
    tetrahedra = [nodes.element(tetrahedron, [(*low[c], 1) for c in triangle] + [(1.5, 0.5, 2)])
                  for triangle in ((0, 1, 2), (0, 2, 3))]
    text = nodes.text() + elements_text(hexahedron, hexahedra, more=", ELSET=BLOCK") + elements_text(
        wedge, wedges, 11, ", ELSET=WEDGES") + elements_text(tetrahedron, tetrahedra, 21, ", ELSET=ROOF")
    return text + "*SURFACE, NAME=BELOW\nBLOCK, S1\nWEDGES, S1\n*SURFACE, NAME=FAR\n6, S6\n*SURFACE, NAME=RIDGE\n21, S2\n"
