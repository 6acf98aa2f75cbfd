"""Data lines of an Abaqus or CalculiX deck as numbers, and what its types of elements are."""

import re
import warnings

import numpy as np

from .abaqus_lines import split
from .elements import KINDS
from .mesh import MeshError

SOLID = re.compile(r"(?:C3D|DC3D|AC3D|DCC3D)(\d+)[A-Z]*")
# shells, membranes, plane and surface elements: their sets can name surfaces of solids (gmsh writes CPS3)
SKIN = re.compile(r"(?:STRI|SFM3D|SFM|M3D|R3D|DS|CPS|CPEG|CPE|CAX|S)(3|4|6|65|8|9)[A-Z]*\d?")
# lines, points and connections are no part of a contact model of solids
OTHER = re.compile(r"(?:T2D|T3D|DC1D|B2|B3|R2D|RB2D|RB3D|SAX|FRAME|PIPE|CONN|MASS|ROTARYI|HEATCAP|SPRING|DASHPOT|GAP|DCOUP"
                   r"|JOINT|ITS|DISTR|DGAP|RAX|F3D|F2D|D)[A-Z0-9]*")


def solid_kind(keyword):
    """Name in KINDS of the elements of *ELEMENT, or the number of corners of a skin, or None for what is passed over.
    @raises MeshError for types that are unknown, or that nodus cannot have."""
    kind = keyword.need("TYPE").upper()
    solid = SOLID.fullmatch(kind)
    if solid and "C3D" + solid.group(1) in KINDS and solid.group(1) != "18":
        return "C3D" + solid.group(1)
    if solid and solid.group(1) in ("5", "13"):
        raise MeshError(f"{keyword.where()}: element type {kind}: pyramids cannot be divided into hexahedra; mesh this "
                        "place with tetrahedra, wedges or hexahedra")
    skin = SKIN.fullmatch(kind)
    if skin:
        return {"3": 3, "6": 6, "65": 6, "4": 4, "8": 8, "9": 9}[skin.group(1)]
    if not solid and OTHER.fullmatch(kind):
        return None
    raise MeshError(f"{keyword.where()}: element type {kind} is unknown; solids are " + ", ".join(
        name for name in KINDS if name != "C3D18") + " and their variants (C3D8R, C3D8I, C3D10M, ...)")


def node_table(keyword):
    """(labels, coordinates) of *NODE; missing coordinates are zero."""
    if keyword.get("SYSTEM", "R").upper() != "R":
        raise MeshError(f"{keyword.where()}: nodes in cylindrical or spherical coordinates are not read; write the deck with "
                        "rectangular ones")
    if not keyword.lines:
        return np.zeros(0, int), np.zeros((0, 3))
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            table = np.loadtxt([line.rstrip(", ") for line in keyword.lines], delimiter=",", ndmin=2)
    except ValueError:
        table = np.array([_node(keyword, i, line) for i, line in enumerate(keyword.lines)])
    table = np.pad(table, ((0, 0), (0, max(0, 4 - table.shape[1]))))[:, :4]
    bad = np.flatnonzero(~np.isfinite(table).all(axis=1) | (table[:, 0] != np.round(table[:, 0])) | (table[:, 0] < 1))
    if len(bad):
        raise MeshError(f"{keyword.where(bad[0])}: '{keyword.lines[bad[0]]}' is no node: number, x, y, z")
    return table[:, 0].astype(int), table[:, 1:]


def _node(keyword, i, line):
    try:
        entries = [float(re.sub("[dD]", "e", entry)) if entry else 0. for entry in split(line)[:4]]
    except ValueError:
        raise MeshError(f"{keyword.where(i)}: '{line}' is no node: number, x, y, z") from None
    return entries + [0.] * (4 - len(entries))


def element_table(keyword, n_nodes):
    """(labels, nodes, data lines where they start) of *ELEMENT, whose nodes may go on in further lines."""
    lines = [line.rstrip(", ") for line in keyword.lines]
    if not lines:
        return np.zeros(0, int), np.zeros((0, n_nodes), int), np.zeros(0, int)
    starts, found = [], 0
    for i, line in enumerate(lines):
        if found == 0:
            starts.append(i)
        found += line.count(",") + 1
        if found > n_nodes + 1:
            raise MeshError(_wrong_number(keyword, starts[-1], n_nodes, found))
        if found == n_nodes + 1:
            found = 0
    if found:
        raise MeshError(_wrong_number(keyword, starts[-1], n_nodes, found))
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            table = np.fromstring(",".join(lines), np.int64, sep=",").reshape(-1, n_nodes + 1)
    except (ValueError, DeprecationWarning):
        bad = next((i for i, line in enumerate(lines) if not re.fullmatch(r"[\s\d,]*\d", line)), 0)
        raise MeshError(f"{keyword.where(bad)}: '{keyword.lines[bad]}' has something that is no number of an element or "
                        "node") from None
    return table[:, 0], table[:, 1:], np.array(starts)


def _wrong_number(keyword, line, n_nodes, found):
    return (f"{keyword.where(line)}: an element of type {keyword.get('TYPE')} has {n_nodes} nodes, here are {found - 1}; is a "
            "line cut off?")


def check_once(what, labels, places):
    """@raises MeshError where a number is given twice. places: [(keyword, data lines)] in the order of the labels."""
    order = np.argsort(labels, kind="stable")
    twice = np.flatnonzero(np.diff(labels[order]) == 0)
    if len(twice):
        where = [place_of(places, order[twice[0] + i]) for i in (0, 1)]
        more = f" ({len(twice)} numbers are there twice)" if len(twice) > 1 else ""
        raise MeshError(f"{where[1]}: {what} {labels[order[twice[0]]]} is there already, {where[0]}{more}")


def place_of(places, index):
    """File and line of the index-th node or element. places: [(keyword, data lines)]"""
    for keyword, lines in places:
        if index < len(lines):
            return keyword.where(lines[index])
        index -= len(lines)
    return "?"
