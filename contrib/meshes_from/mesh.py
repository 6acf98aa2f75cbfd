"""A mesh of solid elements as its file has it: sets with their names, nothing divided yet."""

import numpy as np

from .elements import KINDS, on_face


class MeshError(Exception):
    """What is wrong, where, and the fix."""


class Block:
    """Elements of one kind: `nodes` are rows of points, `labels` the numbers in the file."""

    def __init__(self, name, nodes, labels):
        self.name, self.kind = name, KINDS[name]
        self.nodes, self.labels = np.asarray(nodes, int).reshape(-1, len(self.kind.nodes)), np.asarray(labels, int)


class Mesh:
    """Elements are numbered through all blocks. A face of a set is the row of its corners in ascending order, the first of
    the four being -1 for a triangle."""

    INSTANCE = 10**10  # labels of the i-th instance of a part start at i times this number

    def __init__(self, file, points, blocks):
        self.file, self.points, self.blocks = file, np.asarray(points, float).reshape(-1, 3), blocks
        self.element_sets, self.node_sets, self.face_sets = {}, {}, {}  # name -> elements, rows of points, rows of faces
        self.volume_ids, self.surface_ids = {}, {}  # ids that sets have in the file already
        self.instances, self.notes, self.skipped = [], [], {}
        # second order may be in the file and not in all blocks
        self.blocks.sort(key=lambda block: len(block.kind.nodes) > len(block.kind.shape.corners))

    @property
    def n_elements(self):
        """Of all blocks."""
        return sum(len(block.nodes) for block in self.blocks)

    @property
    def labels(self):
        """Numbers of all elements in the file."""
        return np.concatenate([block.labels for block in self.blocks])

    def starts(self):
        """Number of the first element of each block."""
        return np.cumsum([0] + [len(block.nodes) for block in self.blocks])[:-1]

    def name(self, element):
        """Of an element, for messages."""
        instance, number = divmod(int(self.labels[element]), self.INSTANCE)
        return f"element {number}" + (f" of instance {self.instances[instance - 1]}" if instance else "")

    def names(self, elements):
        """Of the first few elements."""
        return ", ".join(self.name(e) for e in elements[:5]) + (", ..." if len(elements) > 5 else "")

    def corners(self):
        """Corners of all elements in eight columns, in which wedges and tetrahedra repeat their last one."""
        return np.concatenate([np.pad(block.nodes[:, :len(block.kind.shape.corners)],
                                      ((0, 0), (0, 8 - len(block.kind.shape.corners))), mode="edge")
                               for block in self.blocks])

    def solids(self):
        """A number for each element, the same where elements are connected by nodes, and how many solids there are."""
        corners = self.corners()
        root = np.arange(len(self.points))
        while True:
            least = root[corners].min(axis=1)
            joined = root.copy()
            for nodes in (corners, root[corners]):
                np.minimum.at(joined, nodes, least[:, None])
            joined = joined[joined]
            if np.array_equal(joined, root):
                break
            root = joined
        roots, solid = np.unique(root[corners[:, 0]], return_inverse=True)
        return solid, len(roots)


class Faces:
    """The different faces of a mesh: `rows`, and of the first element that has it `element` and `number`; `count` says how
    many elements share it."""

    def __init__(self, mesh):
        elements, numbers, corners = [], [], []
        for block, start in zip(mesh.blocks, mesh.starts()):
            for number, face in enumerate(block.kind.shape.faces):
                corners.append(face_rows(block.nodes[:, face]))
                elements.append(start + np.arange(len(block.nodes)))
                numbers.append(np.full(len(block.nodes), number))
        elements, numbers, corners = np.concatenate(elements), np.concatenate(numbers), np.concatenate(corners)
        first, self._of_side, self.count = unique_rows(corners)
        self.rows, self.element, self.number = corners[first], elements[first], numbers[first]
        self._side_elements, self._mesh = elements, mesh

    @property
    def outer(self):
        """Mask of the faces of one element only."""
        return self.count == 1

    def check(self):
        """A face has two elements at most."""
        crowded = np.flatnonzero(self.count > 2)
        if len(crowded):
            elements = self._side_elements[self._of_side == crowded[0]]
            raise MeshError(f"{self._mesh.file}: {len(crowded)} faces are shared by more than two elements, the first by "
                            f"{self._mesh.names(elements)}; elements overlap or are there twice")

    def find(self, rows):
        """Number of the face of each row, -1 where there is none."""
        return find_rows(np.asarray(rows, int).reshape(-1, 4), self.rows)

    def inside(self, nodes):
        """Mask of the outer faces all of whose nodes, those at middles of edges too, are among these."""
        marked = np.zeros(len(self._mesh.points), bool)
        marked[nodes] = True
        result = np.zeros(len(self.rows), bool)
        for block, start in zip(self._mesh.blocks, self._mesh.starts()):
            own = self.outer & (self.element >= start) & (self.element < start + len(block.nodes))
            for number in range(len(block.kind.shape.faces)):
                faces = np.flatnonzero(own & (self.number == number))
                local = np.flatnonzero(on_face(block.kind.shape, number, block.kind.nodes))
                result[faces] = marked[block.nodes[self.element[faces] - start][:, local]].all(axis=1)
        return result


def face_rows(corners):
    """Corners of triangles or quadrilaterals as the rows of a set of faces."""
    corners = np.asarray(corners, int)
    rows = np.full((len(corners), 4), -1)
    rows[:, 4 - corners.shape[1]:] = np.sort(corners, axis=1)
    return rows


def unique_rows(rows):
    """(position of the first of each kind in ascending order, kind of each row, number of each kind)"""
    # by a hash, since sorting whole rows takes minutes for a million elements; checked, so that it decides nothing
    odd = np.array([0x9E3779B97F4A7C15, 0xC2B2AE3D27D4EB4F, 0x165667B19E3779F9, 0xD6E8FEB86659FD93], np.uint64)
    mixed = np.zeros(len(rows), np.uint64)
    for column in range(rows.shape[1]):
        mixed = (mixed ^ (mixed >> np.uint64(29))) * odd[column % 4] + rows[:, column].astype(np.uint64)
        mixed = (mixed ^ (mixed >> np.uint64(32))) * odd[(column + 1) % 4]
    _, first, inverse, counts = np.unique(mixed, return_index=True, return_inverse=True, return_counts=True)
    if not np.array_equal(rows[first][inverse], rows):
        _, first, inverse, counts = np.unique(rows, axis=0, return_index=True, return_inverse=True, return_counts=True)
    order = np.argsort(first)
    place = np.empty_like(order)
    place[order] = np.arange(len(order))
    return first[order], place[inverse.reshape(-1)], counts[order]


def find_rows(rows, table):
    """Position of each row in a table of different rows, -1 where it is not in it."""
    _, inverse, _ = unique_rows(np.concatenate([table, rows]))
    found = inverse[len(table):]  # the table comes first, so that its rows keep their positions
    return np.where(found < len(table), found, -1)
