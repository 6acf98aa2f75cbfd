"""Fields at one time: the .vtu and .pvtu files that nodus writes.

The reader understands these (one zlib-compressed block in base64, as deal.II writes it), not every VTU file."""

import base64
import os
import xml.etree.ElementTree as ElementTree
import zlib

import numpy as np

from .errors import ResultsError
from .html import table
from .tables import _pandas

# Nodes of a VTK cell as positions in the lattice of nodes per direction, by cell type: vtkQuad, vtkHexahedron,
# vtkBiQuadraticQuad, vtkTriQuadraticHexahedron.
_LATTICE = {
    9: "00 10 11 01",
    12: "000 100 110 010 001 101 111 011",
    28: "00 20 22 02 10 21 12 01 11",
    29: "000 200 220 020 002 202 222 022 100 210 120 010 102 212 122 012 001 201 221 021 011 211 101 121 110 112 111",
}
_LATTICE = {kind: [tuple(int(digit) for digit in node) for node in text.split()] for kind, text in _LATTICE.items()}
_KINDS = {"Float32": np.float32, "Float64": np.float64, "Int32": np.int32, "UInt8": np.uint8}


class Mesh:
    """points (n, 3) on the deformed configuration, whichever the file has; fields: name -> (n,) or (n, 3) or (n, 9); cells:
    array (n_cells, nodes per direction, ...) of point numbers, last index along the first local direction; cell_fields:
    name -> (n_cells,). Cells share the points of their nodes, but for those of different ranks and under `Nodal values = by
    cell`."""

    def __init__(self, points, fields, cells, cell_fields=None):
        self.points, self.fields, self.cells, self.cell_fields = points, fields, cells, cell_fields or {}

    @property
    def reference(self):
        """Positions (n, 3) in the reference configuration."""
        return self.points - self.fields["displacement"]

    def field(self, name):
        """Values (n,) of a field, or of a component: "displacement z", "cauchy_stress xx". @throws ResultsError"""
        base, _, component = name.partition(" ")
        if base not in self.fields:
            raise ResultsError(f'there is no field "{base}"; there are {", ".join(sorted(self.fields))}')
        values = self.fields[base]
        if not component:
            if values.ndim != 1:
                raise ResultsError(f'"{base}" has components: write "{base} x" (vector) or "{base} xx" (tensor)')
            return values
        if values.ndim == 1 or 3 ** len(component) != values.shape[1] or set(component) - set("xyz"):
            raise ResultsError(f'"{base}" has no component "{component}"')
        index = 0
        for letter in component:
            index = 3 * index + "xyz".index(letter)
        return values[:, index]

    def nearest(self, **position):
        """The number of the point nearest to a reference position; coordinates left out do not matter: nearest(x=0, y=0)."""
        reference = self.reference
        distance = sum((reference[:, "xyz".index(axis)] - value) ** 2 for axis, value in position.items())
        return int(np.argmin(distance + np.zeros(len(reference))))

    def nodes(self, decimals=9):
        """Numbers of one point of each node. Ranks, and cells under `Nodal values = by cell`, have their own points: equal are
        those of one body or pair at the same reference position, rounded."""
        key = [np.round(self.reference, decimals)]
        key += [self.fields[name].round()[:, None] for name in ("body", "pair") if name in self.fields]
        return np.unique(np.concatenate(key, axis=1), axis=0, return_index=True)[1]

    def frame(self):
        """A pandas.DataFrame with a row for each point: x, y, z and the fields by component."""
        columns = dict(zip("xyz", self.points.T))
        for name, values in self.fields.items():
            axes = {1: [""]}.get(values.ndim) or [" " + a + b for a in "xyz" for b in ("xyz" if values.shape[1] == 9 else [""])]
            columns.update(zip([name + axis for axis in axes], values.reshape(len(values), -1).T))
        return _pandas().DataFrame(columns)

    def __repr__(self):
        return f"<mesh: {len(self.cells)} cells, {len(self.points)} points, {', '.join(sorted(self.fields))}>"

    def _repr_html_(self):
        rows = [[name, "" if values.ndim == 1 else values.shape[1], f"{values.min():.6g}", f"{values.max():.6g}"]
                for name, values in sorted(self.fields.items())]
        return table(["field", "components", "smallest", "largest"], rows, f"{len(self.cells)} cells, {len(self.points)} points")


def decode(array):
    """The numbers of a DataArray element."""
    kind = _KINDS[array.get("type")]
    text = (array.text or "").strip()
    if not text:
        return np.zeros(0, kind)
    # base64 of (number of blocks = 1, size, size, compressed size), then base64 of the block
    if array.get("format") != "binary" or np.frombuffer(base64.b64decode(text[:24]), np.uint32)[0] != 1:
        raise ResultsError(f'cannot read the array "{array.get("Name")}": it is not one compressed block')
    return np.frombuffer(zlib.decompress(base64.b64decode(text[24:])), kind)


def parse(path):
    """The root of an XML file. @throws ResultsError where it is not there or not complete"""
    if not os.path.exists(path):
        raise ResultsError(f"there is no {path}")
    try:
        return ElementTree.parse(path).getroot()
    except ElementTree.ParseError as error:
        raise ResultsError(f"{path} is damaged: {error}") from None


def _read_piece(name):
    root = parse(name)
    if root.get("compressor") != "vtkZLibDataCompressor":
        raise ResultsError(f"{name} is not compressed by zlib, as files of nodus are where deal.II has zlib")
    piece = root.find("UnstructuredGrid/Piece")
    if int(piece.get("NumberOfCells")) == 0:
        return None
    points = decode(piece.find("Points/DataArray")).astype(float).reshape(-1, 3)
    cells = {array.get("Name"): decode(array) for array in piece.find("Cells")}
    if len(set(cells["types"])) > 1 or cells["types"][0] not in _LATTICE:
        raise ResultsError(f"{name} has cells of types {sorted(set(cells['types']))}; nodus writes one of {sorted(_LATTICE)}")
    lattice = _LATTICE[int(cells["types"][0])]
    n = max(lattice)[0] + 1
    connectivity = cells["connectivity"].reshape(-1, len(lattice))
    grid = np.zeros((len(connectivity),) + (n,) * len(lattice[0]), int)
    for node, position in enumerate(lattice):
        grid[(slice(None),) + position[::-1]] = connectivity[:, node]
    fields, cell_fields = ({array.get("Name"): _values(array) for array in piece.find(data)} for data in ("PointData", "CellData"))
    if not any(array.get("Name") == "deformed" and int(array.text) for array in root.iter("DataArray")):
        points = points + fields["displacement"]
    return Mesh(points, fields, grid, cell_fields)


def _values(array):
    values = decode(array).astype(float)
    width = int(array.get("NumberOfComponents", 1))
    return values if width == 1 else values.reshape(-1, width)


def read_mesh(name):
    """A .vtu, or all pieces of a .pvtu, which ranks have written. @throws ResultsError"""
    pieces = [name]
    if name.endswith(".pvtu"):
        pieces = [os.path.join(os.path.dirname(name), piece.get("Source")) for piece in parse(name).iter("Piece")]
    meshes = [mesh for mesh in map(_read_piece, pieces) if mesh is not None]
    if not meshes:
        raise ResultsError(f"{name} holds no cells")
    before = np.cumsum([0] + [len(mesh.points) for mesh in meshes])
    return Mesh(
        np.concatenate([mesh.points for mesh in meshes]),
        {key: np.concatenate([mesh.fields[key] for mesh in meshes]) for key in meshes[0].fields},
        np.concatenate([mesh.cells + shift for mesh, shift in zip(meshes, before)]),
        {key: np.concatenate([mesh.cell_fields[key] for mesh in meshes]) for key in meshes[0].cell_fields},
    )
