"""Gmsh files, version 2.2 or 4.1: solid elements of first and second order, and their physical groups."""

import os
import shutil
import subprocess
import tempfile
import warnings

import numpy as np

from .elements import KINDS
from .gmsh_out import EDGES
from .mesh import Block, Mesh, MeshError, face_rows

N_NODES = {1: 2, 2: 3, 3: 4, 4: 4, 5: 8, 6: 6, 7: 5, 8: 3, 9: 6, 10: 9, 11: 10, 12: 27, 13: 18, 14: 14, 15: 1, 16: 8, 17: 20,
           18: 15, 19: 13}
SKINS = {2: 3, 9: 3, 3: 4, 10: 4, 16: 4}  # type -> corners
_TETRAHEDRON_EDGES = ((0, 1), (1, 2), (2, 0), (3, 0), (2, 3), (1, 3))
_WEDGE_EDGES = ((0, 1), (0, 2), (0, 3), (1, 2), (1, 4), (2, 5), (3, 4), (3, 5), (4, 5))
_WEDGE_FACES = ((0, 1, 3, 4), (0, 2, 3, 5), (1, 2, 4, 5))
_HEXAHEDRON_FACES = ((0, 1, 2, 3), (0, 1, 4, 5), (0, 3, 4, 7), (1, 2, 5, 6), (2, 3, 6, 7), (4, 5, 6, 7))


def _permutation(name, edges=(), faces=()):
    """Where the nodes of a kind are in gmsh's order: middles are found by the corners they lie between."""
    kind = KINDS[name]
    corners = kind.shape.corners
    foreign = [*corners] + [corners[list(middle)].mean(0) for middle in edges + faces]
    if len(foreign) < len(kind.nodes):
        foreign.append(corners.mean(0))
    return [int(np.abs(np.array(foreign) - node).max(axis=1).argmin()) for node in kind.nodes]


SOLIDS = {4: ("C3D4", _permutation("C3D4")), 11: ("C3D10", _permutation("C3D10", _TETRAHEDRON_EDGES)),
          6: ("C3D6", _permutation("C3D6")), 18: ("C3D15", _permutation("C3D15", _WEDGE_EDGES)),
          13: ("C3D18", _permutation("C3D18", _WEDGE_EDGES, _WEDGE_FACES)), 5: ("C3D8", _permutation("C3D8")),
          17: ("C3D20", _permutation("C3D20", EDGES)), 12: ("C3D27", _permutation("C3D27", EDGES, _HEXAHEDRON_FACES))}


class _Content:
    """The file as it is: elements are (type, dimension, ids of physical groups, rows of label and nodes)."""

    def __init__(self, path):
        self.path, self.names, self.entities, self.elements = path, {}, {}, []
        self.labels, self.points, self.version = np.zeros(0, int), np.zeros((0, 3)), None
        with open(path, encoding="utf-8", errors="replace") as file:
            self.lines = file.read().splitlines()
        at = 0
        while at < len(self.lines):
            section = self.lines[at].strip()
            at += 1
            if not section.startswith("$"):
                continue
            end = at
            while end < len(self.lines) and not self.lines[end].startswith("$End"):
                end += 1
            if end == len(self.lines):
                raise MeshError(f"{path}: section {section} ends early")
            self._read(section, at, end)
            at = end + 1
        if self.version is None:
            raise MeshError(f"{path}: is no gmsh file, it has no $MeshFormat")

    def _read(self, section, at, end):
        reader = {"$MeshFormat": self._format, "$PhysicalNames": self._names, "$Entities": self._entities,
                  "$Nodes": self._nodes, "$Elements": self._elements}.get(section)
        if reader:
            try:
                reader(at, end)
            except (ValueError, IndexError, DeprecationWarning):
                raise MeshError(f"{self.path}: section {section} cannot be read; write it again with gmsh") from None

    def _format(self, at, end):
        self.version = self.lines[at].split()[0]

    def _names(self, at, end):
        for line in self.lines[at + 1:end]:
            dimension, number, name = line.split(None, 2)
            self.names[int(dimension), int(number)] = name.strip().strip('"')

    def _numbers(self, at, n, kind=float):
        """The next n lines as one row of numbers."""
        if at + n > len(self.lines):
            raise ValueError
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            return np.fromstring(" ".join(self.lines[at:at + n]), kind, sep=" ") if n else np.zeros(0, kind)

    def _entities(self, at, end):
        counts = [int(n) for n in self.lines[at].split()]
        at += 1
        for dimension, count in enumerate(counts):
            for line in self.lines[at:at + count]:
                words = line.split()
                first = 4 if dimension == 0 else 7
                ids = words[first + 1:first + 1 + int(words[first])]
                self.entities[dimension, int(words[0])] = tuple(sorted({abs(int(i)) for i in ids}))
            at += count

    def _nodes(self, at, end):
        if self.version == "2.2":
            table = self._numbers(at + 1, int(self.lines[at])).reshape(-1, 4)
            self.labels, self.points = table[:, 0].astype(int), table[:, 1:]
            return
        labels, points = [], []
        n_blocks, at = int(self.lines[at].split()[0]), at + 1
        for _ in range(n_blocks):
            count = int(self.lines[at].split()[3])
            labels.append(self._numbers(at + 1, count, np.int64))
            if count:  # gmsh writes empty blocks
                points.append(self._numbers(at + 1 + count, count).reshape(count, -1)[:, :3])
            at += 1 + 2 * count
        self.labels, self.points = np.concatenate(labels), np.concatenate(points) if points else self.points

    def _elements(self, at, end):
        if self.version != "2.2":
            n_blocks, at = int(self.lines[at].split()[0]), at + 1
            for _ in range(n_blocks):
                dimension, entity, type_, count = (int(word) for word in self.lines[at].split())
                if count:
                    rows = self._numbers(at + 1, count, np.int64).reshape(count, -1)
                    self.elements.append((type_, self.entities.get((dimension, entity), ()), rows))
                at += 1 + count
            return
        groups = {}
        for line in self.lines[at + 1:at + 1 + int(self.lines[at])]:
            words = line.split()
            n_tags = int(words[2])
            ids = (abs(int(words[3])),) if n_tags and words[3] != "0" else ()
            groups.setdefault((int(words[1]), ids), []).append([words[0]] + words[3 + n_tags:])
        for (type_, ids), rows in groups.items():
            self.elements.append((type_, ids, np.array(rows).astype(np.int64)))


def _as_text(path, folder):
    """The path itself, or that of the file as gmsh 4.1 text, which gmsh makes of binary ones and other versions."""
    with open(path, "rb") as file:
        start = file.read(200).split()
    if len(start) < 3 or start[0] != b"$MeshFormat" or (start[1] in (b"2.2", b"4.1") and start[2] == b"0"):
        return path
    if not shutil.which("gmsh"):
        raise MeshError(f"{path}: is binary or of a version that is not read; install gmsh, which converts it, or save with "
                        "Mesh.Binary=0 and Mesh.MshFileVersion=4.1")
    text = os.path.join(folder, "text.msh")
    done = subprocess.run(["gmsh", path, "-save", "-format", "msh41", "-o", text], stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, text=True, check=False)
    if done.returncode or not os.path.exists(text):
        raise MeshError(f"{path}: gmsh cannot read it: {done.stdout.strip().splitlines()[-1:]}")
    return text


def read_gmsh(path):
    """The mesh with its physical volumes and surfaces, which keep their ids."""
    with tempfile.TemporaryDirectory() as folder:
        content = _Content(_as_text(path, folder))
    content.path = path
    order = np.argsort(content.labels)
    if (np.diff(content.labels[order]) == 0).any():
        raise MeshError(f"{path}: a node number is there twice; write it again with gmsh")
    blocks, in_volumes, faces = {}, {}, {}
    for type_, ids, rows in content.elements:
        if type_ not in N_NODES:
            raise MeshError(f"{path}: elements of gmsh type {type_}; save with Mesh.ElementOrder=1 or 2")
        if type_ in (7, 14, 19):
            raise MeshError(f"{path}: element {rows[0, 0]} is a pyramid, which cannot be divided into hexahedra; mesh this "
                            "place with tetrahedra, wedges or hexahedra")
        if rows.shape[1] != N_NODES[type_] + 1:
            raise MeshError(f"{path}: element {rows[0, 0]} has {rows.shape[1] - 1} nodes, those of gmsh type {type_} have "
                            f"{N_NODES[type_]}; write it again with gmsh")
        if type_ not in SOLIDS and type_ not in SKINS:
            continue
        labels, nodes = rows[:, 0], _positions(content, order, rows)
        if type_ in SOLIDS:
            name, permutation = SOLIDS[type_]
            blocks.setdefault(name, []).append((labels, nodes[:, permutation], ids))
        else:
            for number in ids:
                faces.setdefault(number, []).append(face_rows(nodes[:, :SKINS[type_]]))
    if not blocks:
        raise MeshError(f"{path}: there are no solid elements; mesh in three dimensions (gmsh -3), and have the volumes in a "
                        "physical group")
    mesh = Mesh(path, content.points, [Block(name, np.concatenate([nodes for _, nodes, _ in found]),
                                             np.concatenate([labels for labels, _, _ in found]))
                                       for name, found in blocks.items()])
    at = 0
    for block in mesh.blocks:
        for _, nodes, ids in blocks[block.name]:
            for number in ids:
                in_volumes.setdefault(number, []).append(at + np.arange(len(nodes)))
            at += len(nodes)
    for found, sets, ids, dimension, what in ((in_volumes, mesh.element_sets, mesh.volume_ids, 3, "volume"),
                                              (faces, mesh.face_sets, mesh.surface_ids, 2, "surface")):
        for number in sorted(found):
            name = content.names.get((dimension, number), f"physical {what} {number}")
            if name in sets:
                name = f"{name} {number}"
            sets[name], ids[name] = np.concatenate(found[number]), number
    return mesh


def _positions(content, order, rows):
    """Nodes of elements as rows of points."""
    wanted, known = rows[:, 1:], content.labels[order]
    at = np.minimum(np.searchsorted(known, wanted), max(len(known) - 1, 0))
    wrong = np.argwhere(known[at] != wanted) if len(known) else np.argwhere(wanted == wanted)
    if len(wrong):
        i, j = wrong[0]
        raise MeshError(f"{content.path}: element {rows[i, 0]} has node {wanted[i, j]}, which is not there")
    return order[at]
