"""Meshes of the study: tetrahedra by gmsh, converted by contrib/convert, and what the converter says of them."""

import os
import re
import subprocess
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.dirname(HERE))
import common  # noqa: E402

CONVERT = os.path.join(common.ROOT, "contrib", "convert")
# the default of nodus, not the three loops that other studies compare with
MERGED = {f"{loop} loop/Mode": "newton" for loop in ("Geometry", "Threshold", "Status")}


def gmsh(name, geometry, order=1):
    """Meshes the text of a .geo; returns the path of the .msh."""
    path = common.write_case(f"tetrahedra/{name}.geo", geometry + f"\nMesh.ElementOrder = {order};\n")
    mesh = path[:-4] + ".msh"
    subprocess.run(["gmsh", "-3", "-v", "1", path, "-o", mesh], check=True)
    return mesh


def convert(path, *options):
    """Returns (path of the hexahedra, {name: id} of volumes, of surfaces, log)."""
    out = os.path.splitext(path)[0] + "_hexahedra.msh"
    done = subprocess.run([CONVERT, path, out, *options], stdout=subprocess.PIPE, check=True, text=True)
    tables = re.split(r"\n *(?:Volume|Boundary) id .*\n", done.stdout)
    volumes, surfaces = ({name: int(number) for number, names in re.findall(r"^ *(\d+)  (.*?)  +\d+ ", table, re.M)
                          for name in names.split(" = ")} for table in tables[1:])
    return out, volumes, surfaces, done.stdout


def quality(log):
    """(least, median) scaled Jacobian"""
    return tuple(map(float, re.search(r"scaled Jacobian: (\S+) .*, (\S+) in the median", log).groups()))


def unknowns(log):
    """Of the log of nodus."""
    return int(re.search(r"(\d+) displacement degrees of freedom", log).group(1))
