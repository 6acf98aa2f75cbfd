#!/usr/bin/python3
"""Hertz contact (prm/hertz.prm) on divided tetrahedra beside the hexahedra of the case. Writes hertz.md.

The tetrahedra of gmsh have edges `size` up to a distance of 0.3 from the contact point, from where they grow by 0.3 of the
distance; the contact radius is 0.179. The sphere's poles are elsewhere, so that its surface is meshed as any other.
"""

import os
import sys

import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, HERE)
import meshes  # noqa: E402
from meshes import common  # noqa: E402

CASE = os.path.join(common.ROOT, "prm", "hertz.prm")
R, APPROACH, E_STAR = 8.0, 0.004, 2000 / (2 * (1 - 0.3**2))
A = np.sqrt(R * APPROACH)
FORCE, P0 = 4 / 3 * E_STAR * np.sqrt(R) * APPROACH**1.5 / 4, 2 * E_STAR * A / (np.pi * R)

MEAN = {f"Body {b}/Volumetric treatment": "mean dilatation" for b in (1, 2)}

GEOMETRY = """SetFactory("OpenCASCADE");
Sphere(1) = {{0, 0, 8, 8}};
Rotate {{{{1, 0, 0}}, {{0, 0, 8}}, Pi/2}} {{ Volume{{1}}; }}
Box(3) = {{0, 0, 0, 8, 8, 8}};
BooleanIntersection(4) = {{ Volume{{1}}; Delete; }}{{ Volume{{3}}; Delete; }};
Box(5) = {{0, 0, -16, 16, 16, 16}};
e = 1e-3;
x1() = Surface In BoundingBox{{-e, -e, -e, e, 8 + e, 8 + e}};
y1() = Surface In BoundingBox{{-e, -e, -e, 8 + e, e, 8 + e}};
t1() = Surface In BoundingBox{{-e, -e, 8 - e, 8 + e, 8 + e, 8 + e}};
x2() = Surface In BoundingBox{{-e, -e, -16 - e, e, 16 + e, e}};
y2() = Surface In BoundingBox{{-e, -e, -16 - e, 16 + e, e, e}};
b2() = Surface In BoundingBox{{-e, -e, -16 - e, 17, 17, -16 + e}};
t2() = Surface In BoundingBox{{-e, -e, -e, 17, 17, e}};
all() = Boundary{{ Volume{{4}}; }};
curved() = all(); curved() -= x1(); curved() -= y1(); curved() -= t1();
Physical Volume("sphere", 1) = {{4}}; Physical Volume("block", 2) = {{5}};
Physical Surface("sphere x", 11) = x1(); Physical Surface("sphere y", 12) = y1(); Physical Surface("sphere top", 13) = t1();
Physical Surface("sphere curved", 14) = curved();
Physical Surface("block x", 21) = x2(); Physical Surface("block y", 22) = y2(); Physical Surface("block bottom", 23) = b2();
Physical Surface("block top", 24) = t2();
Field[1] = MathEval;
Field[1].F = "{size} + 0.3*(max(sqrt(x*x+y*y+z*z), 0.3) - 0.3)";
Background Field = 1;
Mesh.MeshSizeExtendFromBoundary = 0; Mesh.MeshSizeFromPoints = 0; Mesh.HighOrderOptimize = 0;
"""


def measure(name, keys):
    """A row of the table."""
    run = common.run(CASE, "tetrahedra/runs/hertz_" + name.replace(" ", "_"), {**meshes.MERGED, **keys})
    if not run.converged:
        return [meshes.unknowns(run.log), "no solution", "", "", "", f"{run.cpu:.0f}"]
    contact = run.contact[-1]
    force = contact["slave force z"]
    a, p0 = common.nodus.references.hertz_sphere(4 * force, R, E_STAR)
    surface = run.surface()
    r = np.hypot(surface.reference[:, 0], surface.reference[:, 1])
    pressure, area = surface.field("CPRESS").ravel(), surface.field("area").ravel()
    exact = common.nodus.references.elliptic(r, a, p0)
    error = np.sqrt(np.sum(area * (pressure - exact) ** 2) / np.sum(area * exact**2))
    return [meshes.unknowns(run.log), int((pressure > 0).sum()), f"{100 * (abs(force) / FORCE - 1):+.2f} %",
            f"{100 * (pressure.max() / P0 - 1):+.2f} %", f"{100 * error:.2f} %", f"{run.cpu:.0f}"]


def main():
    rows = [["hexahedra of the case", "Q1"] + measure("hexahedra", {}),
            ["hexahedra of the case", "Q1 mean dilatation"] + measure("hexahedra_mean", MEAN)]
    for order, size, kinds in ((2, 0.16, ("Q2",)), (2, 0.08, ("Q1", "Q1 mean dilatation", "Q2")),
                               (2, 0.056, ("Q1", "Q1 mean dilatation", "Q2")), (1, 0.056, ("Q1",)),
                               (2, 0.04, ("Q1", "Q1 mean dilatation"))):
        path, volumes, _, log = meshes.convert(meshes.gmsh(f"hertz_{order}_{size}", GEOMETRY.format(size=size), order))
        print(meshes.quality(log), flush=True)
        body = {f"Body {b}/Mesh file": path for b in (1, 2)}
        body["Body 2/Global refinement"] = 0
        for kind in kinds:
            keys = {"Q1": {}, "Q1 mean dilatation": MEAN, "Q2": {"Discretization/Degree": 2}}[kind]
            name = f"{10 if order == 2 else 4}-node tetrahedra, edges {size}"
            rows.append([name, kind] + measure(f"{order}_{size}_{kind}", {**body, **keys}))
    common.table(os.path.join(HERE, "hertz.md"), ("mesh", "cells", "unknowns", "nodes in contact", "force", "largest pressure",
                                                  "pressure, L2", "CPU s"), rows)


if __name__ == "__main__":
    main()
