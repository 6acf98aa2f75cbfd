#!/usr/bin/python3
"""The punch of prm/gallery/punch.prm in CalculiX, axisymmetric, on a mesh that is fine where the flat end turns into the edge, and nodus beside it.

    punch.py [--size H] [--stiffness K]    (mm, of the cells at r = 40; MPa/mm, of the contact)

Writes prm/gallery/punch_pressure.csv, pressure and displacement of the foundation over the radius, and contrib/doc/gallery/punch_pressure.png with nodus.
Needs ccx (Debian: calculix-ccx) and gmsh; CCX and NODUS name the programs.
"""

import argparse
import os
import subprocess

import numpy as np
from plain_case import common, nodus

CASE = os.path.join(common.ROOT, "prm", "gallery", "punch.prm")
LOAD = 100.0
AXIS = 8.0  # beside it pressures of CalculiX' wedges say nothing
FOLDER = os.path.join(common.SCRATCH, "peers", "punch")

# Sizes grow with the distance from where the flat end turns into the edge.
GEOMETRY = """
Point(1) = {{0, -200, 0}}; Point(2) = {{100, -200, 0}}; Point(3) = {{100, 0, 0}}; Point(4) = {{48, 0, 0}}; Point(5) = {{40, 0, 0}}; Point(6) = {{0, 0, 0}};
Line(1) = {{1, 2}}; Line(2) = {{2, 3}}; Line(3) = {{3, 4}}; Line(4) = {{4, 5}}; Line(5) = {{5, 6}}; Line(6) = {{6, 1}};
Curve Loop(1) = {{1 : 6}}; Plane Surface(1) = {{1}};
Point(11) = {{0, 0, 0}}; Point(12) = {{40, 0, 0}}; Point(13) = {{40, 10, 0}}; Point(14) = {{47, 10 - Sqrt(51), 0}}; Point(15) = {{50, 10, 0}};
Point(16) = {{50, 100, 0}}; Point(17) = {{0, 100, 0}};
Line(11) = {{11, 12}}; Circle(12) = {{12, 13, 14}}; Circle(13) = {{14, 13, 15}}; Line(14) = {{15, 16}}; Line(15) = {{16, 17}}; Line(16) = {{17, 11}};
Curve Loop(2) = {{11 : 16}}; Plane Surface(2) = {{2}};
Physical Surface("foundation", 1) = {{1}}; Physical Surface("punch", 2) = {{2}};
Physical Curve("slave", 11) = {{4, 5}}; Physical Curve("master", 12) = {{11, 12}}; Physical Curve("load", 13) = {{15}}; Physical Curve("support", 14) = {{1}};
Physical Curve("axis", 15) = {{6, 16}};
Field[1] = MathEval; Field[1].F = "min(3, {size} + 0.12 * max(0, sqrt((x - 40)^2 + y^2) - {fine}))"; Background Field = 1;
Mesh.MeshSizeExtendFromBoundary = 0; Mesh.MeshSizeFromPoints = 0; Mesh.Algorithm = 6; Mesh.RecombineAll = 1; Mesh.RecombinationAlgorithm = 2;
Mesh.MshFileVersion = 2.2;
"""


def mesh(size):
    """Points (n, 2), cells and sides by the number of their physical group, corners from 1 on."""
    path = os.path.join(FOLDER, "punch")
    with open(path + ".geo", "w", encoding="ascii") as file:
        file.write(GEOMETRY.format(size=size, fine=8 * size))
    subprocess.run(["gmsh", "-2", "-v", "1", path + ".geo", "-o", path + ".msh"], check=True)
    with open(path + ".msh", encoding="ascii") as file:
        lines = iter(file.read().splitlines())
    points, cells, sides = [], {}, {}
    for text in lines:
        if text == "$Nodes":
            points = [tuple(map(float, next(lines).split()[1:3])) for _ in range(int(next(lines)))]
        elif text == "$Elements":
            for _ in range(int(next(lines))):
                _, kind, n_tags, group, *rest = map(int, next(lines).split())
                {1: sides, 2: cells, 3: cells}[kind].setdefault(group, []).append(tuple(rest[n_tags - 1 :]))
    return np.array(points), cells, sides


def deck(points, cells, sides, stiffness):
    """Laws and friction are those of the case."""
    case = nodus.Case.read(CASE, program=common.program())
    friction = case["Contact pair 1"]["Friction coefficient"]
    lines = ["*NODE, NSET=ALL", *(f"{i}, {x:.12g}, {y:.12g}, 0." for i, (x, y) in enumerate(points, 1))]
    edges, number = {}, 0
    for body, name in ((1, "FOUNDATION"), (2, "PUNCH")):
        for corners in (3, 4):
            lines.append(f"*ELEMENT, TYPE=CAX{corners}, ELSET={name}")
            for cell in (cell for cell in cells[body] if len(cell) == corners):
                a, b, c = points[np.array(cell[:3]) - 1]
                cell = cell if np.cross(b - a, c - a) > 0 else cell[::-1]
                number += 1
                lines.append(", ".join(map(str, (number, *cell))))
                for side in range(corners):
                    edges[frozenset((cell[side], cell[(side + 1) % corners]))] = number, side + 1
    for body, name in ((1, "FOUNDATION"), (2, "PUNCH")):
        law = case[f"Body {body}"]["Material"]
        lines += [f"*MATERIAL, NAME=M{name}", "*ELASTIC", "{}, {}".format(law["Young's modulus"], law["Poisson's ratio"]), f"*SOLID SECTION, ELSET={name}, MATERIAL=M{name}"]
    for name, group in (("SLAVE", 11), ("MASTER", 12)):
        lines += [f"*SURFACE, NAME={name}, TYPE=ELEMENT", *("%d, S%d" % edges[frozenset(side)] for side in sides[group])]
    for name, group in (("SUPPORT", 14), ("AXIS", 15)):
        lines += [f"*NSET, NSET={name}", *(f"{node}," for node in sorted({node for side in sides[group] for node in side}))]
    lines += ["*SURFACE INTERACTION, NAME=CONTACT", "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR", f"{stiffness:g}", "*FRICTION",
              f"{friction}, {stiffness / 10:g}", "*CONTACT PAIR, INTERACTION=CONTACT, TYPE=SURFACE TO SURFACE", "SLAVE, MASTER", "*BOUNDARY",
              "SUPPORT, 1, 2", "AXIS, 1, 1", "*STEP, NLGEOM, INC=1000", "*STATIC", "0.1, 1., 1e-5, 0.1", "*DLOAD"]  # fmt: skip
    lines += ["%d, P%d, %g" % (*edges[frozenset(side)], LOAD) for side in sides[13]]
    return "\n".join(lines + ["*NODE FILE", "U", "*CONTACT FILE", "CDIS, CSTR", "*END STEP"]) + "\n"


def read(path):
    """Radius, pressure and vertical displacement of the nodes on the foundation's upper side at the end, from the .frd file."""
    tables, name = {}, None
    with open(path, errors="replace", encoding="ascii") as file:
        for line in file:
            if line.startswith("    2C"):
                name = "nodes"
            elif line.startswith(" -4"):
                name = line.split()[1]
                tables[name] = {}
            elif line.startswith(" -3"):
                name = None
            elif line.startswith(" -1") and name in ("nodes", "DISP", "CONTACT"):
                row = line.rstrip("\n")
                tables.setdefault(name, {})[int(row[3:13])] = [float(row[i : i + 12]) for i in range(13, len(row), 12)]
    rows = {}
    for node, values in tables["CONTACT"].items():
        x, y, z = tables["nodes"][node]
        if abs(y) < 1e-6:  # of both surfaces; the master's have no pressure
            rows[round(np.hypot(x, z), 6)] = max(rows.get(round(np.hypot(x, z), 6), (0, 0)), (values[3], tables["DISP"][node][1]))
    return np.array([(r, *values) for r, values in sorted(rows.items()) if r > AXIS])


def calculix(size, stiffness):
    os.makedirs(FOLDER, exist_ok=True)
    with open(os.path.join(FOLDER, "deck.inp"), "w", encoding="ascii") as file:
        file.write(deck(*mesh(size), stiffness))
    done = subprocess.run([os.environ.get("CCX", "ccx"), "deck"], cwd=FOLDER, env={**os.environ, "OMP_NUM_THREADS": "1"},
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)  # fmt: skip
    if "Job finished" not in done.stdout:
        raise SystemExit("punch.py: CalculiX stops: " + done.stdout[-500:])
    return read(os.path.join(FOLDER, "deck.frd"))


# Name in the plot -> keys.
ONCE = {f"Body {body}/Global refinement": "0" for body in (1, 2)}
NODUS = {
    "nodus, the case": {},
    "faceted": {"Contact pair 1/Surface": "faceted"},
    "degree 2, cells of the files": {**ONCE, "Discretization/Degree": "2"},
    "adaptive": {**ONCE, "Adaptivity/Interval": "1", "Adaptivity/Repetitions": "4", "Adaptivity/Maximum level": "5", "Adaptivity/Refine fraction": "0.8"},
}  # fmt: skip


def of_nodus(keys):
    """Rows of radius and pressure of the slave nodes; the run."""
    run = common.program().run(CASE, sets={**keys, "Output/Results folder": os.path.join(FOLDER, "nodus")}, profile=True)
    surface = run.surface()
    radius = np.hypot(*surface.reference[:, :2].T)
    order = np.argsort(radius)
    return np.column_stack([radius, surface.fields["CPRESS"]])[order], run


def plot(reference, found):
    figure, _ = common.figure(11, 4.5)
    figure.clear()
    for axis, begin in zip(figure.subplots(1, 2), (30, 39)):
        axis.plot(*reference[:, :2].T, "k-", label="CalculiX, axisymmetric, fine")
        for (name, rows), marker in zip(found.items(), "osx."):
            axis.plot(*rows.T, marker, ms=4, mfc="none", label=name)
        axis.set_xlim(begin, 41)
        axis.set_xlabel("radius")
        axis.set_ylabel("pressure")
        axis.grid(alpha=0.3)
    axis.legend(fontsize="small")
    figure.savefig(os.path.join(common.ROOT, "contrib", "doc", "gallery", "punch_pressure.png"), dpi=100)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--size", type=float, default=0.02)
    parser.add_argument("--stiffness", type=float, default=1e7)
    options = parser.parse_args()
    reference = calculix(options.size, options.stiffness)
    with open(os.path.join(os.path.dirname(CASE), "punch_pressure.csv"), "w", encoding="utf-8") as file:
        file.write(f"# Punch of NAFEMS CB2, friction coefficient 0.1: CalculiX by contrib/studies/peers/punch.py, axisymmetric, cells of {options.size:g} mm at r = 40, "
                   f"contact stiffness {options.stiffness:g} MPa/mm\nr,pressure,axial displacement\n")  # fmt: skip
        file.writelines(f"{r:.6g},{p:.5g},{u:.5g}\n" for r, p, u in reference)
    found = {}
    for name, keys in NODUS.items():
        found[name], run = of_nodus(keys)
        at = [np.interp(r, *found[name].T) for r in (36.02, 38.15, 38.81, 39.41)]
        edge = found[name][np.abs(found[name][:, 0] - 40) < 1e-3, 1]
        print(f"{name}: " + ", ".join(f"{p:.0f}" for p in at) + f", {edge.min():.0f} to {edge.max():.0f}; {run.cpu:.0f} CPU s", flush=True)
    plot(reference, found)


if __name__ == "__main__":
    main()
