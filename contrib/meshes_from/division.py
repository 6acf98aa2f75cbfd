"""Elements divided into hexahedra that fit together, with nodes merged by what they lie on."""

import functools

import numpy as np

from .elements import FIRST_ORDER, LATTICES, ORDER, division, gauss_points, halved_edges, lattice, on_face
from .mesh import MeshError, unique_rows

CHUNK = 20000  # hexahedra at a time, for memory
FRACTION = 10080  # unit coordinates and weights of the points of divided elements are multiples of its inverse


class Template:
    """How all elements of a shape are divided: `points` in unit coordinates, and per hexahedron its lattice of them."""

    def __init__(self, shape, halved, order):
        corners = division(shape, halved)
        trilinear = LATTICES[1].values(lattice(order))
        nodes = np.einsum("lc,hcd->hld", trilinear, corners)
        _, first, inverse = np.unique(np.round(nodes.reshape(-1, 3) * FRACTION).astype(int), axis=0, return_index=True,
                                      return_inverse=True)
        self.points = nodes.reshape(-1, 3)[first]
        self.hexahedra = inverse.reshape(nodes.shape[:2])
        # what a point lies on: corners of the element and their weights, four at most on a face
        self.weights = np.round(FIRST_ORDER[shape].values(self.points) * FRACTION).astype(int)
        self.inside = (self.weights > 0).all(axis=1)
        # faces of the hexahedra on those of the element: (hexahedron, its face) for each
        self.faces = [[(h, f) for h in range(len(corners)) for f, face in enumerate(face_lattices(1))
                       if on_face(shape, number, corners[h][face]).all()] for number in range(len(shape.faces))]


@functools.lru_cache(None)
def template(shape, halved, order):
    """One per shape."""
    return Template(shape, halved, order)


def face_lattices(order):
    """Positions in the lattice of a hexahedron of its six faces, each as a lattice of its own."""
    grid = np.arange((order + 1)**3).reshape((order + 1,) * 3)  # [z, y, x]
    return [np.take(grid, end, axis=axis).reshape(-1) for axis in range(3) for end in (0, order)]


class Hexahedra:
    """The divided mesh: `cells` are lattices of `points`, `parent` is the element that a cell is of."""

    def __init__(self, mesh, refine=False, straight=False):
        self.mesh = mesh
        self.order = 2 if not straight and any(_is_curved(block, mesh.points) for block in mesh.blocks) else 1
        self.halved = _halved(mesh, refine)
        self._build()
        self.mirrored = self._turn()

    def _pieces(self):
        """(block, number of its first element, elements of the block, template) where all are divided alike."""
        for block, start in zip(self.mesh.blocks, self.mesh.starts()):
            halved = self.halved[start:start + len(block.nodes)]
            for value in (False, True):
                chosen = np.flatnonzero(halved == value)
                if len(chosen):
                    yield block, start, chosen, template(block.kind.shape, value, self.order)

    def _build(self):
        keys, positions, cells, parents, offset = [], [], [], [], 0
        self._first_cell = np.zeros(self.mesh.n_elements, int)
        for block, start, chosen, plan in self._pieces():
            nodes = block.nodes[chosen]
            keys.append(_keys(nodes[:, :plan.weights.shape[1]], plan, offset).reshape(-1, 4))
            positions.append(np.einsum("pn,enc->epc", block.kind.values(plan.points), self.mesh.points[nodes]).reshape(-1, 3))
            local = offset + np.arange(len(chosen))[:, None] * len(plan.points)
            cells.append((local[:, :, None] + plan.hexahedra[None]).reshape(-1, plan.hexahedra.shape[1]))
            parents.append(np.repeat(start + chosen, len(plan.hexahedra)))
            self._first_cell[start + chosen] = sum(map(len, cells[:-1])) + np.arange(len(chosen)) * len(plan.hexahedra)
            offset += len(chosen) * len(plan.points)
        keys, positions = np.concatenate(keys), np.concatenate(positions)
        first, merged, _ = unique_rows(keys)
        self.points = positions[first]
        self.points[merged] = positions  # blocks of second order come last: their curved sides count
        self.cells, self.parent = merged[np.concatenate(cells)], np.concatenate(parents)
        size = np.ptp(self.points, axis=0).max()
        self.apart = int((np.abs(positions - self.points[merged]).max(axis=1) > 1e-9 * size).sum())

    def _turn(self):
        """Mirrors the cells of elements that are mirrored as a whole; how many elements those are."""
        negative = corner_jacobians(self) < 0
        wrong = np.ones(self.mesh.n_elements, bool)
        np.logical_and.at(wrong, self.parent, negative.all(axis=1))
        flipped = np.arange(self.cells.shape[1]).reshape(-1, self.order + 1)[:, ::-1].reshape(-1)
        cells = np.flatnonzero(wrong[self.parent])
        self.cells[cells] = self.cells[cells][:, flipped]
        self.turned = wrong
        return int(wrong.sum())

    def faces(self, elements, numbers):
        """Lattices of the faces of cells on these faces of elements, and for each which of these it is on."""
        lattices, owners, sides = [], [], face_lattices(self.order)
        mirrored = sides[:4] + sides[:3:-1]  # a mirrored cell has its x- face where x+ was
        for block, start, chosen, plan in self._pieces():
            mine = np.zeros(self.mesh.n_elements, bool)
            mine[start + chosen] = True
            for number, where in enumerate(plan.faces):
                for turned in (False, True):
                    those = np.flatnonzero(mine[elements] & (numbers == number) & (self.turned[elements] == turned))
                    for h, f in where if len(those) else ():
                        cell = self._first_cell[elements[those]] + h
                        lattices.append(self.cells[cell][:, (mirrored if turned else sides)[f]])
                        owners.append(those)
        if not lattices:
            return np.zeros((0, (self.order + 1)**2), int), np.zeros(0, int)
        return np.concatenate(lattices), np.concatenate(owners)

    def volumes(self):
        """Of each cell."""
        points, weights = gauss_points()
        kind, result = LATTICES[self.order], []
        for i in range(0, len(self.cells), CHUNK):
            result.append(np.linalg.det(kind.jacobians(self.points[self.cells[i:i + CHUNK]], points)) @ weights)
        return np.concatenate(result)

    def areas(self, lattices):
        """Of faces of cells."""
        abscissae, weights = np.polynomial.legendre.leggauss(4)
        s, step = (abscissae + 1) / 2, np.linspace(0, 1, self.order + 1)
        values, slopes = _lagrange(step, s), _lagrange(step, s, derivative=True)
        n = self.order + 1
        nodes = self.points[lattices].reshape(-1, n, n, 3)
        first = np.einsum("pa,qb,fbac->fpqc", slopes, values, nodes)
        second = np.einsum("pa,qb,fbac->fpqc", values, slopes, nodes)
        return np.einsum("p,q,fpq->f", weights / 2, weights / 2, np.linalg.norm(np.cross(first, second), axis=-1))


def _is_curved(block, points):
    """Whether middles of sides are not where the corners have them, by more than the digits of a file."""
    if ORDER[block.name] == 1 or not len(block.nodes):
        return False
    positions, n_corners = points[block.nodes], len(block.kind.shape.corners)
    straight = np.einsum("pn,enc->epc", FIRST_ORDER[block.kind.shape].values(block.kind.nodes), positions[:, :n_corners])
    size = np.ptp(positions, axis=1).max(axis=1)
    return bool((np.abs(positions - straight).max(axis=(1, 2)) > 1e-5 * size).any())


def _lagrange(nodes, points, derivative=False):
    """(points, nodes): Lagrange polynomials on `nodes`, or their derivatives."""
    result = []
    for i in range(len(nodes)):
        others = np.delete(nodes, i)
        polynomial = np.poly1d(others, r=True) / np.prod(nodes[i] - others)
        result.append((polynomial.deriv() if derivative else polynomial)(points))
    return np.array(result).T


def _keys(corners, plan, offset):
    """Four numbers per point that say what it lies on: corners with their weights; those inside are of this element alone."""
    keys = np.zeros((len(corners), len(plan.points), 4), int)
    for p, weights in enumerate(plan.weights):
        if plan.inside[p]:
            keys[:, p, 0] = -1 - offset - p - np.arange(len(corners)) * len(plan.points)
            continue
        on = np.flatnonzero(weights)
        keys[:, p, :len(on)] = np.sort(corners[:, on] * 2 * FRACTION + weights[on], axis=1)
    return keys


def _halved(mesh, refine):
    """Which elements have all their edges halved: so that sides fit, where neighbours ask for it."""
    pieces, n = [], len(mesh.points)
    for block, start in zip(mesh.blocks, mesh.starts()):
        always, where_needed = (
            np.sort(block.nodes[:, np.array(edges, int).reshape(-1, 2)], axis=2) for edges in halved_edges(block.kind.shape))
        pieces.append((start, len(block.nodes), always @ [n, 1], where_needed @ [n, 1]))
    flat = np.concatenate([part.reshape(-1) for piece in pieces for part in piece[2:]])
    codes, numbers = np.unique(flat, return_inverse=True)
    halved_edge = np.zeros(len(codes), bool)
    result, at, split = np.full(mesh.n_elements, refine), 0, []
    for start, count, always, where_needed in pieces:
        edges = [numbers[at:at + always.size].reshape(always.shape)]
        at += always.size
        edges.append(numbers[at:at + where_needed.size].reshape(where_needed.shape))
        at += where_needed.size
        split.append((slice(start, start + count), edges))
        halved_edge[edges[0]] = True
        if always.shape[1] == 6 and not where_needed.size:
            result[start:start + count] = False  # tetrahedra have one way only
    while True:
        before = halved_edge.sum()
        for part, (always, where_needed) in split:
            if where_needed.size:
                result[part] |= halved_edge[where_needed].any(axis=1)
                halved_edge[where_needed[result[part]]] = True
        if halved_edge.sum() == before:
            return result


def corner_jacobians(hexahedra):
    """Scaled Jacobians of the straight cells at their eight corners, as nodus checks them."""
    n = hexahedra.order
    at = np.array([x * n + y * n * (n + 1) + z * n * (n + 1)**2 for z in (0, 1) for y in (0, 1) for x in (0, 1)])
    result = []
    for i in range(0, len(hexahedra.cells), CHUNK):
        positions = hexahedra.points[hexahedra.cells[i:i + CHUNK][:, at]]
        result.append(_scaled(LATTICES[1].jacobians(positions, lattice(1))))
    return np.concatenate(result)


def scaled_jacobians(hexahedra):
    """The least of each cell: at the corners of the straight one, and of a curved one at 27 nodes and 27 Gauss points."""
    least = corner_jacobians(hexahedra).min(axis=1)
    if hexahedra.order == 2:
        points = np.concatenate([lattice(2), gauss_points()[0]])
        for i in range(0, len(least), CHUNK):
            jacobians = LATTICES[2].jacobians(hexahedra.points[hexahedra.cells[i:i + CHUNK]], points)
            least[i:i + CHUNK] = np.minimum(least[i:i + CHUNK], _scaled(jacobians).min(axis=1))
    return least


def _scaled(jacobians):
    lengths = np.prod(np.linalg.norm(jacobians, axis=-1), axis=-1)
    return np.linalg.det(jacobians) / np.where(lengths > 0, lengths, 1)


def check_quality(hexahedra):
    """(least, its element, median) of the scaled Jacobians. @raises MeshError for cells that nodus refuses."""
    mesh, quality = hexahedra.mesh, scaled_jacobians(hexahedra)
    bad = np.unique(hexahedra.parent[~(quality > 1e-6)])
    if len(bad):
        whole = len(bad) == 1
        raise MeshError(f"{mesh.file}: {len(bad)} element{'' if whole else 's'} turned inside out or collapsed, at a corner or "
                        f"along curved sides: {mesh.names(bad)}; mesh {'this place' if whole else 'these places'} anew"
                        + (", or take --straight sides" if hexahedra.order == 2 else ""))
    worst = int(quality.argmin())
    return float(quality[worst]), mesh.name(hexahedra.parent[worst]), float(np.median(quality))
