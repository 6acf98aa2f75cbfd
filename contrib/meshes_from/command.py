"""The command contrib/convert: read, divide, check, write, print the table of ids."""

import argparse
import os
import re
import sys

import numpy as np

from .abaqus import read_abaqus
from .division import Hexahedra, check_quality
from .gmsh_in import read_gmsh
from .gmsh_out import combinations, write_gmsh
from .groups import surface_groups, volume_groups
from .mesh import MeshError
from .other_formats import read_other

EPILOG = """The names of sets become physical groups: those of elements are `Volume ids` of nodus, surfaces `Boundary ids`.
Tetrahedra become four hexahedra each, wedges three, or six where their neighbours need it; hexahedra beside them eight. Second
order keeps its curved sides. contrib/doc/meshes.md has more."""


def _arguments(arguments):
    parser = argparse.ArgumentParser(prog="contrib/convert", epilog=EPILOG, description="Makes a mesh for nodus of one of "
                                     "Abaqus or CalculiX (.inp), gmsh (.msh), or what meshio reads (VTU, Exodus, MED, ...).")
    parser.add_argument("input", metavar="IN")
    parser.add_argument("output", metavar="OUT.msh")
    overlap = parser.add_mutually_exclusive_group()
    overlap.add_argument("--first", action="store_const", const="first", dest="overlap", default="refuse",
                         help="a face in several surfaces belongs to the first")
    overlap.add_argument("--pieces", action="store_const", const="pieces", dest="overlap",
                         help="the faces that surfaces share get an id of their own")
    parser.add_argument("--without", metavar="NAME", action="append", default=[], help="pass a set over; may be repeated")
    parser.add_argument("--no-node-sets", action="store_true", help="pass over all sets of nodes")
    parser.add_argument("--refine", action="store_true", help="halve all edges: hexahedra become eight, wedges six")
    parser.add_argument("--straight", action="store_true", help="write 8 corners only, also of second order; with --refine "
                        "these are on the curved sides")
    return parser.parse_args(arguments)


def _read(path):
    ending = os.path.splitext(path)[1].lower()
    return {".inp": read_abaqus, ".msh": read_gmsh}.get(ending, read_other)(path)


def _leave_out(mesh, options):
    if options.no_node_sets:
        mesh.node_sets = {}
    for name in options.without:
        matches = [(sets, known) for sets in (mesh.element_sets, mesh.node_sets, mesh.face_sets) for known in list(sets)
                   if known.upper() == name.upper()]
        if not matches:
            raise MeshError(f"--without {name}: there is no such set in {mesh.file}")
        for sets, known in matches:
            del sets[known]


def convert(options):
    """Does it all; prints what there is. @raises MeshError"""
    if not options.output.lower().endswith(".msh"):
        raise MeshError(f"{options.output}: the name of the result must end in .msh")
    if not os.path.isfile(options.input):
        raise MeshError(f"{options.input}: there is no such file")
    folder = os.path.dirname(options.output)
    if folder and not os.path.isdir(folder):
        raise MeshError(f"{options.output}: there is no folder {folder}")
    if os.path.exists(options.output) and os.path.samefile(options.input, options.output):
        raise MeshError(f"{options.output}: is the input itself; give the result another name")
    mesh = _read(options.input)
    _leave_out(mesh, options)
    volumes = volume_groups(mesh)
    surfaces, faces = surface_groups(mesh, options.overlap)
    hexahedra = Hexahedra(mesh, options.refine, options.straight)
    quality = check_quality(hexahedra)
    of_face = [hexahedra.faces(faces.element[group.members], faces.number[group.members])[0] for group in surfaces]
    outer = np.flatnonzero(faces.outer)
    named = np.zeros(len(faces.rows), bool)
    for group in surfaces:
        named[group.members] = True
    rest = outer[~named[outer]]
    rest = hexahedra.faces(faces.element[rest], faces.number[rest])[0]
    parts = [(ids, hexahedra.cells[np.isin(hexahedra.parent, elements)]) for ids, elements in
             combinations(volumes, mesh.n_elements)]
    write_gmsh(options.output, hexahedra, (volumes, parts), (surfaces, [((g.id,), f) for g, f in zip(surfaces, of_face)]))
    _report(options, mesh, hexahedra, quality)
    _tables(hexahedra, volumes, surfaces, of_face, rest)


def _report(options, mesh, hexahedra, quality):
    kinds = {}
    for block in mesh.blocks:
        kinds[block.kind.shape.name, len(block.kind.nodes)] = len(block.nodes)
    print(f"{mesh.file}: " + ", ".join(f"{n} {name} of {nodes} nodes" for (name, nodes), n in kinds.items()))
    if mesh.skipped:
        print("  skipped: " + ", ".join(f"{name} {n}" for name, n in sorted(mesh.skipped.items())))
    if hexahedra.mirrored:
        print(f"  {hexahedra.mirrored} elements were mirrored and have been turned")
    if hexahedra.apart:
        print(f"  at {hexahedra.apart} nodes straight sides are beside curved ones, and have been curved")
    for note in mesh.notes:
        print(f"  warning: {note}")
    second = any(len(block.kind.nodes) > len(block.kind.shape.corners) for block in mesh.blocks)
    sides = ("curved sides are kept" if hexahedra.order == 2 else "" if not second else "curved sides have become straight"
             if options.straight else "all sides are straight, so that 8 nodes do")
    print(f"{options.output}: {len(hexahedra.cells)} hexahedra of {(hexahedra.order + 1)**3} nodes, "
          f"{len(hexahedra.points)} nodes" + (f"; {sides}" if sides else ""))
    print(f"  scaled Jacobian: {quality[0]:.3g} at least ({quality[1]}), {quality[2]:.3g} in the median")


def _tables(hexahedra, volumes, surfaces, of_face, rest):
    volume = np.bincount(hexahedra.parent, hexahedra.volumes(), minlength=hexahedra.mesh.n_elements)
    count = np.bincount(hexahedra.parent, minlength=hexahedra.mesh.n_elements)
    rows = [("Volume id", "name", "cells", "volume", "from")]
    for group in volumes:
        rows.append((group.id, " = ".join(group.names), count[group.members].sum(), f"{volume[group.members].sum():.6g}",
                     group.source))
    _print(rows)
    rows = [("Boundary id", "name", "faces", "area", "from")]
    for group, lattices in zip(surfaces, of_face):
        source = re.sub(r"\bnode set\b", "node set, the outer faces with all nodes in it", group.source)
        rows.append((group.id, " = ".join(group.names), len(lattices), f"{hexahedra.areas(lattices).sum():.6g}", source))
    if len(rest):
        rows.append((0, "(none)", len(rest), f"{hexahedra.areas(rest).sum():.6g}", "outer faces without a surface"))
    _print(rows)


def _print(rows):
    rows = [[str(entry) for entry in row] for row in rows]
    widths = [max(len(row[i]) for row in rows) for i in range(len(rows[0]))]
    print()
    for row in rows:
        print("  ".join(entry.ljust(width) if i in (1, 4) else entry.rjust(width)
                        for i, (entry, width) in enumerate(zip(row, widths))).rstrip())


def main(arguments=None):
    """Exit code 0, or 1 with one message on stderr."""
    try:
        convert(_arguments(arguments))
    except MeshError as error:
        print(f"convert: {error}", file=sys.stderr)
        return 1
    except OSError as error:
        print(f"convert: {error.filename}: {error.strerror}", file=sys.stderr)
        return 1
    return 0
