#!/usr/bin/python3
"""Bending of a cantilever of divided tetrahedra beside one of genuine hexahedra. Writes cantilever.md.

A beam 8 x 1 x 1 in plane strain, linear elastic, whose root moves as the elastic solution says and whose end carries the
parabola of shear that belongs to it (Timoshenko and Goodier, Theory of Elasticity, art. 21): the solution is exact in three
dimensions, and the end moves by F L^3 / (3 E' I) (1 + (4 + 5 nu') h^2 / (8 L^2)), the same at all its points, with E' =
E / (1 - nu^2), nu' = nu / (1 - nu).
"""

import os
import sys

import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, HERE)
import meshes  # noqa: E402
from meshes import common  # noqa: E402

L, E, LOAD = 8.0, 1000.0, 0.01
I = 1 / 12

GEOMETRY = """SetFactory("OpenCASCADE");
Box(1) = {{0, 0, -0.5, {L}, 1, 1}};
Mesh.MeshSizeMin = {size}; Mesh.MeshSizeMax = {size};
Physical Volume("beam") = {{1}};
Physical Surface("root", 1) = {{1}}; Physical Surface("end", 2) = {{2}};
Physical Surface("sides", 3) = {{3, 4}};
"""

PRM = """set Title = cantilever
subsection Discretization
  set Degree = {degree}
end
subsection Body 1
{mesh}  set Volumetric treatment = {treatment}
  subsection Material
    set Law = linear elastic
    set Young's modulus = {E}
    set Poisson's ratio = {nu}
  end
end
subsection Boundary condition 1
  set Name = sides
  set Boundary ids = {sides}
  set Components = y
  set Value = 0
end
subsection Boundary condition 2
  set Name = root
  set Boundary ids = {root}
  set Components = x, z
  set Value = -({warping!r})*z*(z^2-0.25); {lift!r}*z^2
end
subsection Boundary condition 3
  set Name = end
  set Type = traction
  set Boundary ids = {end}
  set Components = z
  set Value = {shear!r}*(0.25-z^2)
end
"""


def exact(nu):
    """(E', nu', deflection of the end)"""
    E1, nu1 = E / (1 - nu**2), nu / (1 - nu)
    return E1, nu1, LOAD * L**3 / (3 * E1 * I) * (1 + (4 + 5 * nu1) / (8 * L**2))


def measure(name, mesh, degree, treatment, nu):
    """(unknowns, relative error of the deflection, CPU seconds). mesh: (keys of the body, ids)"""
    E1, nu1, deflection = exact(nu)
    keys, (root, end, sides) = mesh
    text = PRM.format(degree=degree, treatment=treatment, mesh=keys, E=E, nu=nu, root=root, end=end, sides=sides,
                      warping=LOAD * (2 + nu1) / (6 * E1 * I), lift=LOAD * nu1 * 3 * L / (6 * E1 * I), shear=LOAD / (2 * I))
    prm = common.write_case(f"tetrahedra/{name}.prm", text)
    run = common.run(prm, f"tetrahedra/runs/{name}", meshes.MERGED)
    if not run.converged:
        return meshes.unknowns(run.log), float("nan"), run.cpu
    body = run.bodies()
    at_end = np.abs(body.reference[:, 0] - L) < 1e-6
    return meshes.unknowns(run.log), body.field("displacement z")[at_end].mean() / deflection - 1, run.cpu


def tetrahedra(size):
    """((keys of the body, ids), scaled Jacobians)"""
    path, _, ids, log = meshes.convert(meshes.gmsh(f"beam_{size}", GEOMETRY.format(L=L, size=size)))
    return (f"  set Mesh file = {path}\n", (ids["root"], ids["end"], ids["sides"])), meshes.quality(log)


def hexahedra(unknowns, degree):
    """A grid of cubes, as nearly as it goes, with this number of unknowns."""
    n = max(1, round((unknowns / 3 / L) ** (1 / 3) / degree - 0.5))
    along = max(1, round((unknowns / 3 / (degree * n + 1) ** 2 - 1) / degree))
    return ("  set Generator = subdivided_hyper_rectangle\n"
            f"  set Generator arguments = {along},{n},{n} : 0,0,-0.5 : {L},1,0.5 : true\n", (0, 1, "2, 3")), (along, n)


def main():
    rows = []
    for size in (0.7, 0.5, 0.35, 0.25):
        mesh, quality = tetrahedra(size)
        for degree, treatment in ((1, "standard"), (1, "mean dilatation"), (2, "standard"), (2, "mean dilatation")):
            if degree == 2 and size < 0.35:
                continue
            for nu in (0.3, 0.499):
                name = f"{size}_{degree}_{treatment[0]}_{nu}"
                n, error, cpu = measure("tetrahedra_" + name, mesh, degree, treatment, nu)
                other, cells = hexahedra(n, degree)
                n_other, error_other, cpu_other = measure("hexahedra_" + name, other, degree, treatment, nu)
                rows.append((f"Q{degree} {treatment}", nu, size, n, f"{100 * error:+.3g} %", f"{cpu:.1f}",
                             f"{cells[0]} x {cells[1]} x {cells[1]}", n_other, f"{100 * error_other:+.3g} %",
                             f"{cpu_other:.1f}"))
        print(f"scaled Jacobian of size {size}: {quality}", flush=True)
    rows.sort(key=lambda row: (row[0], row[1], -row[2]))
    common.table(os.path.join(HERE, "cantilever.md"),
                 ("cells", "nu", "edge of tetrahedra", "unknowns", "error", "CPU s", "hexahedra", "unknowns", "error", "CPU s"),
                 rows)


if __name__ == "__main__":
    main()
