"""Solid elements of first and second order: nodes, shape functions, and the hexahedra that they are divided into.

Nodes are in the order of Abaqus and CalculiX (corners, edges, then faces and centre), faces in that of the labels S1, S2, ...
A hexahedron that is written has its nodes in a lattice of 2 or 3 per direction, the first direction running fastest.
"""

import itertools

import numpy as np


class Shape:
    """Corners in unit coordinates, edges and faces as numbers of corners."""

    def __init__(self, name, corners, edges, faces):
        digits = lambda texts: [[int(digit) for digit in text] for text in texts.split()]
        self.name, self.corners = name, np.array(digits(corners), float)
        self.edges, self.faces = digits(edges), digits(faces)


TETRAHEDRON = Shape("tetrahedra", "000 100 010 001", "01 12 20 03 13 23", "012 031 132 230")
WEDGE = Shape("wedges", "000 100 010 001 101 011", "01 12 20 34 45 53 03 14 25", "012 354 0341 1452 2530")
HEXAHEDRON = Shape("hexahedra", "000 100 110 010 001 101 111 011", "01 12 23 30 45 56 67 74 04 15 26 37",
                   "0123 4765 0451 1562 2673 3740")


class Kind:
    """Polynomials on nodes: `exponents` are those of the monomials that span the shape functions."""

    def __init__(self, shape, nodes, spans):
        self.shape, self.nodes = shape, np.array(nodes)
        self.exponents = np.array([e for e in itertools.product(range(3), repeat=3) if spans(*e)])
        self._coefficients = np.linalg.inv(self._monomials(self.nodes))

    def _monomials(self, points, derivative=None):
        factor, exponents = np.ones(len(self.exponents)), self.exponents
        if derivative is not None:
            factor = exponents[:, derivative]
            exponents = np.maximum(exponents - np.eye(3, dtype=int)[derivative], 0)
        return factor * np.prod(points[:, None, :] ** exponents, axis=2)

    def values(self, points):
        """(points, nodes)"""
        return self._monomials(points) @ self._coefficients

    def gradients(self, points):
        """(points, directions, nodes)"""
        return np.stack([self._monomials(points, d) @ self._coefficients for d in range(3)], axis=1)

    def jacobians(self, positions, points):
        """(elements, points, directions, components) for the positions of the nodes, (elements, nodes, components)"""
        return np.einsum("pdn,enc->epdc", self.gradients(points), positions)


def _with_middles(shape, faces=(), centre=False):
    middles = [shape.corners[list(corners)].mean(0) for corners in shape.edges + [shape.faces[f] for f in faces]]
    return np.vstack([shape.corners, *middles] + [shape.corners.mean(0)] * centre)


KINDS = {
    "C3D4": Kind(TETRAHEDRON, TETRAHEDRON.corners, lambda x, y, z: x + y + z < 2),
    "C3D10": Kind(TETRAHEDRON, _with_middles(TETRAHEDRON), lambda x, y, z: x + y + z < 3),
    "C3D6": Kind(WEDGE, WEDGE.corners, lambda x, y, z: x + y < 2 and z < 2),
    "C3D15": Kind(WEDGE, _with_middles(WEDGE), lambda x, y, z: x + y < 3 and z < 2 or x + y < 2 and z < 3),
    "C3D18": Kind(WEDGE, _with_middles(WEDGE, (2, 3, 4)), lambda x, y, z: x + y < 3),
    "C3D8": Kind(HEXAHEDRON, HEXAHEDRON.corners, lambda x, y, z: max(x, y, z) < 2),
    "C3D20": Kind(HEXAHEDRON, _with_middles(HEXAHEDRON), lambda x, y, z: (x, y, z).count(2) < 2),
    "C3D27": Kind(HEXAHEDRON, _with_middles(HEXAHEDRON, range(6), True), lambda x, y, z: True),
}
FIRST_ORDER = {kind.shape: kind for kind in (KINDS["C3D4"], KINDS["C3D6"], KINDS["C3D8"])}
ORDER = {name: 1 if kind in FIRST_ORDER.values() else 2 for name, kind in KINDS.items()}


def lattice(order):
    """Nodes of a hexahedron that is written, in unit coordinates."""
    steps = np.linspace(0, 1, order + 1)
    return np.array([(x, y, z) for z in steps for y in steps for x in steps])


LATTICES = {order: Kind(HEXAHEDRON, lattice(order), lambda x, y, z, order=order: max(x, y, z) <= order) for order in (1, 2)}


def gauss_points():
    """27 points and weights on the unit cube, exact for the volume of a triquadratic hexahedron."""
    points, weights = np.polynomial.legendre.leggauss(3)
    grid = np.array(list(itertools.product(points, repeat=3)))
    return (grid + 1) / 2, np.prod(list(itertools.product(weights, repeat=3)), axis=1) / 8


def on_face(shape, face, points):
    """Which points lie on a face."""
    weights = FIRST_ORDER[shape].values(points)
    others = [corner for corner in range(len(shape.corners)) if corner not in shape.faces[face]]
    return np.abs(weights[:, others]).max(axis=1) < 1e-9


def _hexahedron_at(shape, corner):
    """The hexahedron of a corner: the corner, the middles of its edges, of its faces, and the centre. Every corner of a
    tetrahedron, wedge or hexahedron has three edges, so that they all divide alike."""
    ends = [b if a == corner else a for a, b in shape.edges if corner in (a, b)]
    steps = shape.corners[ends] - shape.corners[corner]
    if np.linalg.det(steps) < 0:
        ends.reverse()
    result = []
    for chosen in itertools.product((0, 1), repeat=3):
        spanned = {corner}.union(end for end, bit in zip(ends, reversed(chosen)) if bit)
        entities = [[corner]] + shape.edges + shape.faces + [range(len(shape.corners))]
        entity = min((e for e in entities if spanned <= set(e)), key=len)
        result.append(shape.corners[list(entity)].mean(0))
    return result


def _upright_at(corner):
    """A third of a wedge, from triangle to triangle."""
    a, b = (corner + 1) % 3, (corner + 2) % 3
    triangle = WEDGE.corners[:3]
    quadrilateral = [triangle[list(nodes)].mean(0) for nodes in ((corner,), (corner, a), (corner, b), (0, 1, 2))]
    return [point + height for height in ((0, 0, 0), (0, 0, 1)) for point in quadrilateral]


def division(shape, halved):
    """The hexahedra of an element in its unit coordinates, (hexahedra, 8, 3). Where not all edges are halved, hexahedra
    stay whole, and wedges keep the edges between their triangles."""
    if halved or shape is TETRAHEDRON:
        return np.array([_hexahedron_at(shape, corner) for corner in range(len(shape.corners))])
    if shape is WEDGE:
        return np.array([_upright_at(corner) for corner in range(3)])
    return lattice(1)[None]


def halved_edges(shape):
    """Edges that `division` halves in any case, and those that it keeps whole where it can."""
    if shape is TETRAHEDRON:
        return shape.edges, []
    return (shape.edges[:6], shape.edges[6:]) if shape is WEDGE else ([], shape.edges)
