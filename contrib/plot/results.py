"""Results of nodus: reader of its .pvd/.pvtu/.vtu and .csv files, and the formulas in the comments of a .prm file.

Needs NumPy only. The reader understands what nodus writes (zlib-compressed base64 by deal.II), not every VTU file.
"""

import ast
import base64
import csv
import math
import operator
import os
import re
import xml.etree.ElementTree as ElementTree
import zlib

import numpy as np


class ResultsError(Exception):
    """Something asked for is not in the results; the message says what there is."""


# Nodes of a VTK cell as positions in the lattice of nodes per direction, by cell type.
_LATTICE = {
    9: "00 10 11 01",
    12: "000 100 110 010 001 101 111 011",
    70: "00 20 22 02 10 21 12 01 11",
    72: "000 200 220 020 002 202 222 022 100 210 120 010 102 212 122 012 001 201 021 221 011 211 101 121 110 112 111",
}
_LATTICE = {kind: [tuple(int(digit) for digit in node) for node in text.split()] for kind, text in _LATTICE.items()}


def _lattice(kind, version):
    """In files of version 2.2, which deal.II 9.5 and later write, two edges of quadratic hexahedra have changed places."""
    nodes = list(_LATTICE[kind])
    if kind == 72 and version >= (2, 2):
        nodes[18], nodes[19] = nodes[19], nodes[18]
    return nodes


class Mesh:
    """points (n, 3) on the deformed configuration; fields: name -> (n,) or (n, 3) or (n, 9); cells: array (n_cells,
    nodes per direction, ...) of point numbers, last index along the first local direction."""

    def __init__(self, points, fields, cells):
        self.points, self.fields, self.cells = points, fields, cells

    @property
    def reference(self):
        return self.points - self.fields["displacement"]

    def field(self, name):
        """Values of a field, or of a component: "displacement z"."""
        base, _, component = name.partition(" ")
        if base not in self.fields:
            raise ResultsError(f'there is no field "{base}"; there are {", ".join(sorted(self.fields))}')
        values = self.fields[base]
        if not component:
            if values.ndim != 1:
                raise ResultsError(f'"{base}" has components: write "{base} x" (vector) or "{base} xx" (tensor)')
            return values
        index = 0
        for letter in component:
            index = 3 * index + "xyz".index(letter)
        return values[:, index]


def _decode(array):
    kinds = {"Float32": np.float32, "Float64": np.float64, "Int32": np.int32, "UInt8": np.uint8}
    text = (array.text or "").strip()
    if not text:
        return np.zeros(0, kinds[array.get("type")])
    # base64 of (number of blocks = 1, size, size, compressed size), then base64 of the block
    return np.frombuffer(zlib.decompress(base64.b64decode(text[24:])), kinds[array.get("type")])


def _read_piece(name):
    root = ElementTree.parse(name).getroot()
    piece = root.find("UnstructuredGrid/Piece")
    if int(piece.get("NumberOfCells")) == 0:
        return None
    points = _decode(piece.find("Points/DataArray")).astype(float).reshape(-1, 3)
    cells = {array.get("Name"): _decode(array) for array in piece.find("Cells")}
    lattice = _lattice(int(cells["types"][0]), tuple(int(part) for part in root.get("version").split(".")))
    n = max(lattice)[0] + 1
    connectivity = cells["connectivity"].reshape(-1, len(lattice))
    grid = np.zeros((len(connectivity),) + (n,) * len(lattice[0]), int)
    for node, position in enumerate(lattice):
        grid[(slice(None),) + position[::-1]] = connectivity[:, node]
    fields = {}
    for array in piece.find("PointData"):
        values = _decode(array).astype(float)
        width = int(array.get("NumberOfComponents", 1))
        fields[array.get("Name")] = values if width == 1 else values.reshape(-1, width)
    return Mesh(points, fields, grid)


def read_mesh(name):
    """A .vtu, or all pieces of a .pvtu."""
    pieces = [name]
    if name.endswith(".pvtu"):
        record = ElementTree.parse(name).getroot()
        pieces = [os.path.join(os.path.dirname(name), piece.get("Source")) for piece in record.iter("Piece")]
    meshes = [mesh for mesh in map(_read_piece, pieces) if mesh is not None]
    if not meshes:
        raise ResultsError(f"{name} holds no cells")
    before = np.cumsum([0] + [len(mesh.points) for mesh in meshes])
    return Mesh(
        np.concatenate([mesh.points for mesh in meshes]),
        {key: np.concatenate([mesh.fields[key] for mesh in meshes]) for key in meshes[0].fields},
        np.concatenate([mesh.cells + shift for mesh, shift in zip(meshes, before)]),
    )


def _nearest(times, t):
    """The last time, or the one asked for."""
    if not times:
        raise ResultsError("there is no time in the results")
    if t is None:
        return max(times)
    best = min(times, key=lambda time: abs(time - t))
    if abs(best - t) > 1e-6 * max(1.0, abs(t)):
        raise ResultsError(f"there is no time {t:g}; the nearest is {best:g}")
    return best


class Results:
    """A results folder."""

    def __init__(self, folder):
        self.folder = folder
        self._meshes, self._tables = {}, {}

    def series(self, name):
        """Times and files of bodies.pvd or contact.pvd."""
        path = os.path.join(self.folder, name + ".pvd")
        if not os.path.exists(path):
            raise ResultsError(f"there is no {path}")
        return {
            float(entry.get("timestep")): os.path.join(self.folder, entry.get("file"))
            for entry in ElementTree.parse(path).getroot().iter("DataSet")
        }

    def mesh(self, name, t=None):
        files = self.series(name)
        path = files[_nearest(list(files), t)]
        if path not in self._meshes:
            self._meshes[path] = read_mesh(path)
        return self._meshes[path]

    def rows(self, file):
        """A table as a list of dictionaries of texts; units in the header do not belong to the names of the columns."""
        if file not in self._tables:
            path = os.path.join(self.folder, file)
            if not os.path.exists(path):
                raise ResultsError(f"there is no {path}")
            with open(path, newline="", encoding="utf-8") as stream:
                rows = list(csv.reader(stream))
            header = [re.sub(r" \[.*\]$", "", name) for name in rows[0]]
            self._tables[file] = [dict(zip(header, values)) for values in rows[1:]]
        if not self._tables[file]:
            raise ResultsError(f"{os.path.join(self.folder, file)} has no rows")
        return self._tables[file]

    def table(self, file, key, row, column, t=None):
        """A number of contact.csv, reactions.csv or rigid_bodies.csv."""
        rows = [values for values in self.rows(file) if values[key] == row]
        if not rows:
            names = sorted({values[key] for values in self._tables[file]})
            raise ResultsError(f'{file} has no {key} "{row}"; it has ' + ", ".join(f'"{name}"' for name in names))
        if column not in rows[0]:
            raise ResultsError(f'{file} has no column "{column}"; it has {", ".join(rows[0])}')
        time = _nearest([float(values["time"]) for values in rows], t)
        return float([values for values in rows if float(values["time"]) == time][-1][column])

    def at_node(self, mesh, field, t=None, **position):
        """Value at the node nearest to a reference position; coordinates left out do not matter."""
        mesh = self.mesh(mesh, t)
        distance = sum((mesh.reference[:, "xyz".index(axis)] - value) ** 2 for axis, value in position.items())
        return float(mesh.field(field)[np.argmin(distance)])

    def functions(self):
        """What the formulas of `# Check:` lines may call."""
        return {
            "reaction": lambda name, column, t=None: self.table("reactions.csv", "condition", name, column, t),
            "rigid": lambda name, column, t=None: self.table("rigid_bodies.csv", "body", name, column, t),
            "contact": lambda pair, column, t=None: self.table("contact.csv", "pair", pair, column, t),
            "surface": lambda field, t=None, **position: self.at_node("contact", field, t, **position),
            "body": lambda field, t=None, **position: self.at_node("bodies", field, t, **position),
        }


_OPERATORS = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
    ast.Pow: operator.pow,
    ast.USub: operator.neg,
    ast.UAdd: operator.pos,
    ast.Lt: operator.lt,
    ast.Gt: operator.gt,
    ast.LtE: operator.le,
    ast.GtE: operator.ge,
}
_MATHEMATICS = {
    "pi": math.pi,
    "abs": np.abs,
    "sqrt": np.sqrt,
    "exp": np.exp,
    "log": np.log,
    "sin": np.sin,
    "cos": np.cos,
    "tan": np.tan,
    "atan2": np.arctan2,
    "min": np.minimum,
    "max": np.maximum,
}


def evaluate(formula, names):
    """Arithmetic with the given names and functions, and nothing else: cases come from anywhere."""
    names = {**_MATHEMATICS, **names}

    def value(node):
        if isinstance(node, ast.Constant) and isinstance(node.value, (int, float, str)):
            return node.value
        if isinstance(node, ast.Name) and node.id in names:
            return names[node.id]
        if isinstance(node, ast.UnaryOp) and type(node.op) in _OPERATORS:
            return _OPERATORS[type(node.op)](value(node.operand))
        if isinstance(node, ast.BinOp) and type(node.op) in _OPERATORS:
            return _OPERATORS[type(node.op)](value(node.left), value(node.right))
        if isinstance(node, ast.Compare) and len(node.ops) == 1 and type(node.ops[0]) in _OPERATORS:
            return _OPERATORS[type(node.ops[0])](value(node.left), value(node.comparators[0]))
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and callable(names.get(node.func.id)):
            return names[node.func.id](
                *(value(argument) for argument in node.args),
                **{keyword.arg: value(keyword.value) for keyword in node.keywords},
            )
        raise ResultsError(f'cannot evaluate "{ast.unparse(node)}"; known names are {", ".join(sorted(names))}')

    try:
        tree = ast.parse(formula.strip().replace("^", "**"), mode="eval")
    except SyntaxError as error:
        raise ResultsError(f'"{formula}" is no formula: {error.msg}') from None
    try:
        return value(tree.body)
    except TypeError as error:
        raise ResultsError(f'"{formula}": {error}') from None


class Case:
    """The comments of a .prm file that tools read; prm/README.md describes them."""

    def __init__(self, path=None):
        self.title, self.checks, self.profile, self.view, self.cut = None, [], None, None, None
        if path is None:
            return
        with open(path, encoding="utf-8") as stream:
            text = stream.read()
        title = re.search(r"^set Title\s*=\s*(.*?)\s*$", text, re.M) or re.search(r'"Title"\s*:\s*"([^"]*)"', text)
        self.title = title.group(1) if title else None
        for kind, content in re.findall(r"^#\s*(Check|Plot):\s*(.*?)\s*$", text, re.M):
            self.add(kind, content)

    def add(self, kind, content):
        number = r"[-+]?[0-9.]+(?:[eE][-+]?[0-9]+)?"
        check = re.fullmatch(rf"(.*\S)\s+=\s+({number})\s+\+-\s+({number})(\s*%)?\s*\((.*)\)", content)
        profile = re.fullmatch(
            r"profile\s+(\S+)\s+over\s+(x|y|z|r|angle)(?:\s+where\s+(.*?))?(?:\s+=\s+(.*\S)\s+\(([^()]*)\))?", content
        )
        view = re.fullmatch(rf"view\s+({number})\s+({number})", content)
        cut = re.fullmatch(r"cut\s+(.*)", content)
        if kind == "Check" and check:
            expression, value, tolerance, percent, source = check.groups()
            allowed = float(tolerance) * (abs(float(value)) / 100 if percent else 1)
            self.checks.append((expression, float(value), allowed, source))
        elif kind == "Plot" and profile:
            self.profile = profile.groups()
        elif kind == "Plot" and view:
            self.view = tuple(float(angle) for angle in view.groups())
        elif kind == "Plot" and cut:
            self.cut = cut.group(1)
        else:
            raise ResultsError(f"cannot read the comment '# {kind}: {content}'; prm/README.md has the forms")
