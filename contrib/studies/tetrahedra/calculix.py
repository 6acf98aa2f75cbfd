#!/usr/bin/python3
"""Forces of a CalculiX deck of two solids, beside those of nodus on what contrib/convert makes of it. Writes calculix.md.

A cube is pressed by 0.02 on a block twice as wide and shifted by 0.02 with friction 0.3, linear elastic, E = 1000, nu = 0.3.
The deck has sets of nodes and surfaces of element faces, and CalculiX (`ccx`, Debian: calculix-ccx) runs it as it is.
"""

import os
import re
import subprocess
import sys

import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path[:0] = [HERE, os.path.dirname(os.path.dirname(HERE))]
import meshes  # noqa: E402
from meshes import common  # noqa: E402
from meshes_from.gmsh_in import read_gmsh  # noqa: E402
from meshes_from.mesh import Faces  # noqa: E402

PRESS, SHIFT, FRICTION = 0.02, 0.02, 0.3

TETRAHEDRA = """SetFactory("OpenCASCADE");
Box(1) = {{0.5, 0.5, 0, 1, 1, 1}}; Box(2) = {{0, 0, -1, 2, 2, 1}};
Physical Volume("CUBE") = {{1}}; Physical Volume("BLOCK") = {{2}};
Physical Surface("BELOW") = {{5}}; Physical Surface("TOP") = {{6}}; Physical Surface("BASE") = {{11}};
Physical Surface("ABOVE") = {{12}};
Field[1] = MathEval; Field[1].F = "{size}*(1 + 0.7*abs(z))"; Background Field = 1;
Mesh.MeshSizeExtendFromBoundary = 0; Mesh.MeshSizeFromPoints = 0;
"""
HEXAHEDRA = TETRAHEDRA.replace("Field[1] =", "//") + """
Transfinite Curve {{1:12}} = {n} + 1; Transfinite Curve {{13:24}} = 2*{n} + 1;
Transfinite Curve {{13, 15, 17, 19}} = {n} + 1;
Transfinite Surface {{:}}; Recombine Surface {{:}}; Transfinite Volume {{:}};
"""

STEPS = """*MATERIAL, NAME=STEEL
*ELASTIC
1000, 0.3
*SOLID SECTION, ELSET=CUBE, MATERIAL=STEEL
*SOLID SECTION, ELSET=BLOCK, MATERIAL=STEEL
*SURFACE INTERACTION, NAME=DRY
*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR
{stiffness}
*FRICTION
{friction}, {stick}
*CONTACT PAIR, INTERACTION=DRY, TYPE=SURFACE TO SURFACE
BELOW, ABOVE
*BOUNDARY
BASE, 1, 3
*STEP, INC=500
*STATIC
0.25, 1
*BOUNDARY
TOP, 1, 2
TOP, 3, 3, {press}
*NODE PRINT, NSET=TOP, TOTALS=ONLY
RF
*END STEP
*STEP, INC=500
*STATIC
0.1, 1
*BOUNDARY
TOP, 1, 1, {shift}
*NODE PRINT, NSET=TOP, TOTALS=ONLY
RF
*END STEP
"""

BODY = """subsection Body {number}
  set Name = {name}
  set Mesh file = {file}
  set Volume ids = {id}
  set Volumetric treatment = {treatment}
  subsection Material
    set Law = linear elastic
    set Young's modulus = 1000
    set Poisson's ratio = 0.3
  end
end
"""
PRM = """subsection Discretization
  set Degree = {degree}
end
{bodies}subsection Boundary condition 1
  set Name = base
  set Boundary ids = {BASE}
  set Components = x, y, z
  set Value = 0
end
subsection Boundary condition 2
  set Name = top
  set Boundary ids = {TOP}
  set Components = x, y, z
  set Value = {shift}*max(t-1,0); 0; -{press}*min(t,1)
end
subsection Contact pair 1
  set Slave body = 1
  set Slave boundary ids = {BELOW}
  set Master body = 2
  set Master boundary ids = {ABOVE}
  set Friction coefficient = {friction}
end
subsection Load stepping
  set Interval ends = 1, 2
  set Increments = 2, 10
end
"""


def write_deck(name, mesh_file, kind, stiffness):
    """Writes <name>.inp with element faces and sets of nodes; returns its path."""
    mesh = read_gmsh(mesh_file)
    faces, block = Faces(mesh), mesh.blocks[0]
    used, rows = np.unique(block.nodes, return_inverse=True)
    nodes = rows.reshape(block.nodes.shape) + 1
    parts = ["*HEADING\ncube on block\n*NODE\n"] + ["%d, %.16g, %.16g, %.16g\n" % (i + 1, *p) for i, p in
                                                   enumerate(mesh.points[used])]
    for name_of_set, elements in mesh.element_sets.items():
        parts.append(f"*ELEMENT, TYPE={kind}, ELSET={name_of_set}\n")
        parts += [", ".join(map(str, [e + 1, *nodes[e]])) + "\n" for e in elements]
    for name_of_set, corners in mesh.face_sets.items():
        found = faces.find(corners)
        if name_of_set in ("BELOW", "ABOVE"):
            parts.append(f"*SURFACE, NAME={name_of_set}, TYPE=ELEMENT\n")
            parts += [f"{e + 1}, S{n + 1}\n" for e, n in zip(faces.element[found], faces.number[found])]
        else:
            height = mesh.points[corners[0, -1], 2]
            parts.append(f"*NSET, NSET={name_of_set}\n")
            parts += [f"{i + 1},\n" for i in np.flatnonzero(np.abs(mesh.points[used, 2] - height) < 1e-9)]
    parts.append(STEPS.format(stiffness=stiffness, stick=stiffness / 10, friction=FRICTION, press=-PRESS, shift=SHIFT))
    return common.write_case(f"tetrahedra/{name}.inp", "".join(parts)), 3 * len(used)


def run_ccx(deck):
    """Forces of TOP at the end of both steps."""
    done = subprocess.run(["ccx", os.path.basename(deck)[:-4]], cwd=os.path.dirname(deck), stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, text=True, check=False, env={**os.environ, "OMP_NUM_THREADS": "1"})
    with open(deck[:-4] + ".dat", encoding="utf-8") as file:
        found = re.findall(r"set TOP and time +(\S+)\s+(\S+) +(\S+) +(\S+)", file.read())
    forces = {float(t): np.array([float(x), float(y), float(z)]) for t, x, y, z in found}
    if not forces or abs(max(forces) - 2) > 1e-6:
        raise SystemExit(done.stdout[-2000:])
    return forces[1.0], forces[max(forces)]


def run_nodus(name, path, volumes, surfaces, degree, treatment):
    """(unknowns, forces at both ends)"""
    bodies = "".join(BODY.format(number=i, name=body, file=path, id=volumes[body], treatment=treatment)
                     for i, body in ((1, "CUBE"), (2, "BLOCK")))
    prm = common.write_case(f"tetrahedra/{name}.prm", PRM.format(bodies=bodies, degree=degree, shift=SHIFT, press=PRESS,
                                                                friction=FRICTION, **surfaces))
    run = common.run(prm, f"tetrahedra/runs/{name}", meshes.MERGED)
    forces = [np.array([run.reactions.value(f"force {d}", t, condition="top") for d in "xyz"]) for t in (1, 2)]
    return meshes.unknowns(run.log), *forces


def main():
    rows = []

    def add(program, cells, unknowns, first, last):
        rows.append((program, cells, unknowns, f"{abs(first[2]):.4f}", f"{abs(last[2]):.4f}", f"{abs(last[0]):.4f}"))
        print(rows[-1], flush=True)

    for kind, geometry, order, stiffnesses in (
            ("C3D8", HEXAHEDRA.format(size=1, n=8), 1, (1e5, 1e6)), ("C3D4", TETRAHEDRA.format(size=0.14), 1, (1e6,)),
            ("C3D10", TETRAHEDRA.format(size=0.14), 2, (1e6,))):
        mesh_file = meshes.gmsh("press_" + kind, geometry, order)
        for stiffness in stiffnesses:
            deck, unknowns = write_deck("press_" + kind, mesh_file, kind, stiffness)
            add(f"ccx, {kind}, contact stiffness {stiffness:g}", "as they are", unknowns, *run_ccx(deck))
        path, volumes, surfaces, log = meshes.convert(deck)
        print(log)
        for degree, treatment in ((1, "standard"), (1, "mean dilatation"), (2, "standard")):
            if kind == "C3D4" or (kind == "C3D10" and degree == 2):
                continue
            result = run_nodus(f"press_{kind}_{degree}{treatment[0]}", path, volumes, surfaces, degree, treatment)
            add(f"nodus, Q{degree}" + (" mean dilatation" if treatment[0] == "m" else ""), f"of {kind}", *result)
    common.table(os.path.join(HERE, "calculix.md"), ("program", "cells", "unknowns", "force z, pressed", "force z, shifted",
                                                     "force x, shifted"), rows)


if __name__ == "__main__":
    main()
