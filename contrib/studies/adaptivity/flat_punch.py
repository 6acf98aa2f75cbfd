#!/usr/bin/python3
"""A rigid flat punch without friction on an elastic block, uniform and adaptive meshes: error of the pressure away from the
edge, where it is singular, and of the force. Writes flat_punch.md, flat_punch.png.

    flat_punch.py [--report]     (--report: from the runs that are there)

Exact (Johnson, Contact Mechanics, 1985, ch. 3): P = 2 E* a d, p = P / (2 pi a sqrt(a^2 - r^2)). On the far faces of the block
the displacements are those of a concentrated force P on a half space (Boussinesq). The punch is a plane in closed
form that a circle of slave faces meets, and in a second series a body with "Rigid = true" whose rim cuts faces.
"""

import json
import os
import re
import sys

import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.dirname(HERE))
import common  # noqa: E402

YOUNG, POISSON, DEPTH = 1000.0, 0.3, 1e-3
E_STAR = YOUNG / (1 - POISSON**2)
FORCE = 2 * E_STAR * DEPTH  # of the whole punch, a = 1
INSIDE = 0.9


def write_mesh(name):
    """Quarter of a cylinder under z = 0, one row of whose cells ends at r = 1; second order. Surfaces: 1 x = 0, 2 y = 0, 3 far,
    4 z = 0."""
    inner, middle, arcs = 0.5, 0.4, np.array([1, 1.5, 2.5, 4.5, 8.5, 16])
    depth = np.array([0, 0.5, 1, 1.5, 2.5, 4.5, 8.5, 16])

    def lattice(points):
        return np.interp(np.arange(0, len(points) - 0.9, 0.5), np.arange(len(points)), points)

    half = np.linspace(0, 1, 3)
    i, j = np.meshgrid(half, half, indexing="ij")
    corners = [np.array(c) for c in ((0, 0), (inner, 0), (middle, middle), (0, inner))]
    weights = [(1 - i) * (1 - j), i * (1 - j), i * j, (1 - i) * j]
    patches = [sum(w[..., None] * c for w, c in zip(weights, corners))]
    for first, second, start in ((1, 2, 0), (2, 3, np.pi / 4)):
        edge = (1 - half)[:, None] * corners[first] + half[:, None] * corners[second]
        arc = np.stack([np.cos(start + half * np.pi / 4), np.sin(start + half * np.pi / 4)], axis=-1)
        rows = [(1 - s) * edge + s * arc for s in (0, 0.5)] + [r * arc for r in lattice(arcs)]
        patches.append(np.round(rows, 12))  # zeros are zeros
    z = -lattice(depth)[::-1]
    lattice27 = common._CORNERS + [common._middle(e) for e in common._EDGES]
    lattice27 += [common._middle(f) for f in common._FACES] + [(1, 1, 1)]
    around = [(0, 0), (2, 0), (2, 2), (0, 2), (1, 0), (2, 1), (1, 2), (0, 1), (1, 1)]
    numbers, points, hexes, quads = {}, [], [], []
    for patch in patches:
        nodes = np.concatenate([np.broadcast_to(patch[:, :, None], patch.shape[:2] + (len(z), 2)),
                                np.broadcast_to(z[:, None], patch.shape[:2] + (len(z), 1))], axis=-1)  # fmt: skip
        number = np.zeros(nodes.shape[:3], int)
        for index in np.ndindex(*number.shape):
            key = tuple(np.round(nodes[index], 8) + 0.0)
            if key not in numbers:
                numbers[key] = len(numbers) + 1
                points.append(nodes[index])
            number[index] = numbers[key]
        for start in np.ndindex(*(n // 2 for n in number.shape)):
            cell = number[tuple(slice(2 * s, 2 * s + 3) for s in start)]
            hexes.append([cell[position] for position in lattice27])
            for direction in range(3):
                for side in (0, 2):
                    sheet = np.take(cell, side, axis=direction)
                    face = [sheet[position] for position in around]
                    x = np.array([points[n - 1] for n in face])
                    far = (np.hypot(x[:, 0], x[:, 1]) > 15.999) | (x[:, 2] < -15.999)
                    for surface, on in enumerate((abs(x[:, 0]) < 1e-9, abs(x[:, 1]) < 1e-9, far, abs(x[:, 2]) < 1e-9), 1):
                        if np.all(on):
                            quads.append((surface, face))
    with open(os.path.join(common.SCRATCH, "adaptivity", name), "w") as file:
        file.write(f"$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n{len(points)}\n")
        for n, x in enumerate(points, 1):
            file.write(f"{n} {x[0]:.16g} {x[1]:.16g} {x[2]:.16g}\n")
        file.write(f"$EndNodes\n$Elements\n{len(quads) + len(hexes)}\n")
        elements = [(10, tag, nodes) for tag, nodes in quads] + [(12, 1, nodes) for nodes in hexes]
        for n, (kind, tag, nodes) in enumerate(elements, 1):
            file.write(f"{n} {kind} 2 {tag} {tag} " + " ".join(map(str, nodes)) + "\n")
        file.write("$EndElements\n")


PLANE = f"""
  set Slave where         = x^2+y^2 < 1
  set Master surface      = plane
  set Master axis         = 0, 0, -1
  set Master translation  = 0; 0; -{DEPTH}*t"""
BODY = """
  set Slave where         = x^2+y^2 < 4
  set Master body         = 2
  set Master boundary ids = 2"""
PUNCH = f"""subsection Body 2
  set Name                = punch
  set Generator           = cylinder
  set Generator arguments = 1 : 0.5
  set Rotation axis       = 0, 1, 0
  set Rotation angle      = 90
  set Translation         = 0, 0, 0.5
  set Global refinement   = 3
  set Rigid               = true
  set Rigid translation   = 0; 0; -{DEPTH}*t
end
"""


def write_case(punch):
    """punch: "plane" (the rim runs along edges of faces) or "body" (it cuts faces of a mesh of cubes)."""
    os.makedirs(os.path.join(common.SCRATCH, "adaptivity"), exist_ok=True)
    ids = {"x": "1", "y": "2", "far": "3", "top": "4"}
    mesh = "flat_punch_plane.msh"
    if punch == "plane":
        write_mesh(mesh)
    else:
        axis = np.array([0, 0.5, 1, 1.5, 2.5, 4.5, 8.5, 16])
        axis = np.interp(np.arange(0, len(axis) - 0.9, 0.5), np.arange(len(axis)), axis)
        x, y, z = np.meshgrid(axis, axis, -axis[::-1], indexing="ij")
        mesh = os.path.basename(common.write_mesh("adaptivity/flat_punch_body", [np.stack([x, y, z], axis=-1)]))
        ids = {"x": "10", "y": "12", "far": "11, 13, 14", "top": "15"}
    factor, rho = FORCE * (1 + POISSON) / (2 * np.pi * YOUNG), "sqrt(x^2+y^2+z^2)"
    aside = f"{factor}*t*(-z/{rho}^3-{1 - 2 * POISSON}/({rho}*({rho}-z)))"
    down = f"-{factor}*t*(z^2/{rho}^3+{2 * (1 - POISSON)}/{rho})"
    return common.write_case("adaptivity/flat_punch_" + punch, f"""set Title = Rigid flat punch
subsection Body 1
  set Name      = block
  set Mesh file = {mesh}
  subsection Material
    set Law             = linear elastic
    set Young's modulus = {YOUNG}
    set Poisson's ratio = {POISSON}
  end
end
{PUNCH if punch == "body" else ""}subsection Boundary condition 1
  set Name         = symmetry x
  set Body         = 1
  set Boundary ids = {ids["x"]}
  set Components   = x
  set Value        = 0
end
subsection Boundary condition 2
  set Name         = symmetry y
  set Body         = 1
  set Boundary ids = {ids["y"]}
  set Components   = y
  set Value        = 0
end
subsection Boundary condition 3
  set Name         = far field
  set Body         = 1
  set Boundary ids = {ids["far"]}
  set Components   = x, y, z
  set Value        = x*{aside}; y*{aside}; {down}
end
subsection Contact pair 1
  set Name                = contact
  set Slave body          = 1
  set Slave boundary ids  = {ids["top"]}{BODY if punch == "body" else PLANE}
end
subsection Linear solver
  set Type = condensed
end
""")  # fmt: skip


def cases():
    for degree, levels in ((1, (0, 1, 2, 3)), (2, (0, 1, 2))):
        for level in levels:
            yield "plane", f"Q{degree} uniform {level}", {"Discretization/Degree": degree, "Body 1/Global refinement": level}
    for degree, levels in ((1, (1, 2, 3, 4, 5)), (2, (1, 2, 3, 4))):
        for level in levels:
            yield ("plane", f"Q{degree} adaptive {level}",
                   {"Discretization/Degree": degree, "Adaptivity/Repetitions": level, "Adaptivity/Maximum level": level,
                    "Adaptivity/Refine fraction": 0.7, "Adaptivity/Coarsen fraction": 0})  # fmt: skip
    for level in (0, 1, 2):
        yield "body", f"Q1 uniform {level}", {"Body 1/Global refinement": level}
    for level in (1, 2, 3):
        yield ("body", f"Q1 adaptive {level}",
               {"Adaptivity/Repetitions": level, "Adaptivity/Maximum level": level, "Adaptivity/Refine fraction": 0.7,
                "Adaptivity/Coarsen fraction": 0})  # fmt: skip


def measure(punch, name, keys):
    prm = os.path.join(common.SCRATCH, "adaptivity", f"flat_punch_{punch}.prm")
    merged = {f"{loop} loop/Mode": "newton" for loop in ("Geometry", "Threshold", "Status")}
    run = common.run(prm, re.sub(" ", "_", f"adaptivity/flat_punch {punch} {name}"), {**merged, **keys})
    if not run.converged:
        return {"name": name, "punch": punch, "converged": False}
    surface = run.surface()
    kept = surface.fields["area"] > 0
    x, first = np.unique(np.round(surface.reference[kept], 9), axis=0, return_index=True)
    r, area, pressure = np.hypot(x[:, 0], x[:, 1]), surface.fields["area"][kept][first], surface.field("CPRESS")[kept][first]
    exact = FORCE / (2 * np.pi * np.sqrt(1 - r[r < INSIDE] ** 2))
    area = area[r < INSIDE]
    error = np.sqrt(np.sum(area * (pressure[r < INSIDE] - exact) ** 2) / np.sum(area * exact**2))
    force = -4 * run.contact[-1]["slave force z"]
    found = re.findall(r"-> (\d+) unknowns", run.log) or re.findall(r"(\d+) displacement degrees of freedom", run.log)
    return {"name": name, "punch": punch, "converged": True, "unknowns": int(found[-1]), "cpu": run.cpu, "error": error,
            "force": abs(force / FORCE - 1), "signed": force / FORCE - 1, "largest": pressure.max() / (FORCE / np.pi),
            "nodes": int(np.sum(r < INSIDE)), "r": list(r), "p": list(pressure)}  # fmt: skip


def main():
    kept = os.path.join(common.SCRATCH, "adaptivity", "flat_punch.json")
    if "--report" in sys.argv:
        with open(kept) as file:
            found = json.load(file)
    else:
        for punch in ("plane", "body"):
            write_case(punch)
        found = [measure(*keys) for keys in cases()]
        with open(kept, "w") as file:
            json.dump(found, file)
    rows = []
    for run in found:
        if run["converged"]:
            rows.append([run["punch"], run["name"], run["unknowns"], f"{run['cpu']:.1f}", run["nodes"], f"{100 * run['error']:.2f} %",
                         f"{100 * run['signed']:+.2f} %", f"{run['largest']:.2f}"])  # fmt: skip
        else:
            rows.append([run["punch"], run["name"], "did not converge"] + [""] * 5)
    header = ["punch", "mesh", "unknowns", "CPU s", "slave nodes r < 0.9 a", "L2 error of the pressure, r < 0.9 a", "force"]
    text = common.table(os.path.join(common.SCRATCH, "part.md"), header + ["largest / mean pressure"], rows)
    with open(os.path.join(HERE, "flat_punch.md"), "w") as file:
        file.write(TEXT.format(table=text))

    figure, axes = common.figure(10.0, 6.0)
    figure.clear()
    axes = figure.subplots(2, 2)
    for row, (what, label) in enumerate((("error", "L2 error of the pressure, r < 0.9 a"), ("force", "error of the force"))):
        for axis, key, text in ((axes[row][0], "unknowns", "unknowns"), (axes[row][1], "cpu", "CPU s")):
            for kind, style in (("Q1 uniform", "o--"), ("Q1 adaptive", "o-"), ("Q2 uniform", "s--"), ("Q2 adaptive", "s-")):
                runs = [run for run in found if run["converged"] and run["punch"] == "plane" and run["name"].startswith(kind)]
                axis.loglog([run[key] for run in runs], [run[what] for run in runs], style, label=kind)
            axis.set_xlabel(text)
            axis.set_ylabel(label)
            axis.grid(True, which="both", alpha=0.3)
    axes[0][0].legend()
    figure.savefig(os.path.join(HERE, "flat_punch.png"), dpi=120)


TEXT = """## Rigid flat punch

Quarter of an elastic half space (size 16 a, exact displacements of a concentrated force on its far faces), no friction, approach
0.001 a, one increment; adaptive meshes by repetition of the increment, Refine fraction 0.7. Force against P = 2 E* a d, pressure
against that of the exact force at the slave nodes with r < 0.9 a, weighted with their areas. CPU contains 0.5 s for the start of the program.

{table}
- Punch = plane, slave faces up to r = a: the force converges with order 1 on uniform meshes (the singularity), Q1 as Q2.
  Adaptive Q1 has the force of uniform meshes with 3 (level 4) and 8 times (level 5) the unknowns, at about the same CPU: five repetitions,
  each of a small problem. The error of the pressure of Q1 is 5 % on nearly all meshes, most of it between 0.85 and 0.9 a.
- Adaptive Q2 has the force of the finest uniform mesh with a thirteenth of its unknowns (level 4), and the smaller error of the pressure,
  for a fourteenth of its CPU. The rim of the slave region is the edge of larger faces outside of it there: the node in the middle of
  such an edge follows none and carries a multiplier.
- Punch = body, whose rim cuts slave faces: nodes beyond the rim are loaded on slivers of their faces and get pressures of up to 90
  times the mean, nodes inside open. The uniform meshes have the force, not the pressure. On the **adaptive ones the error of the
  force stays at 8 %**: the indicator takes those nodal pressures as they are ("estimated error 377 %" in the log) and goes on refining there.

![Errors](flat_punch.png)
"""

if __name__ == "__main__":
    main()
