#!/usr/bin/python3
"""The cup of prm/gallery/deep_drawing.prm in CalculiX, axisymmetric, with quadratic cells, or a wedge of it in nodus.

    deep_drawing.py [--radial N] [--layers L] [--stiffness K]    (MPa/mm, of the contact)
    deep_drawing.py --wedge [--radial N] [--layers L] [--increments N] [--degree P]

Writes prm/gallery/deep_drawing.csv. The force of CalculiX depends on its increments, and halving them takes half of that away: there are two runs, with
increments of 0.125 and 0.0625 mm, and the force is extrapolated to none. The tools are meshed and prescribed, the edges of die and punch in 96 facets; the law is read from the case.
Needs ccx (Debian: calculix-ccx); CCX names the program. With --wedge: 2 degrees of the cup in one layer of cells, its force on the whole punch is
printed (needs gmsh).
"""

import argparse
import math
import os
import re
import subprocess

import numpy as np
from plain_case import common, listed, nodus

CASE = os.path.join(common.ROOT, "prm", "gallery", "deep_drawing.prm")
THICKNESS, RADIUS, TRAVEL = 2.0, 40.0, 25.0
HOLDER, FRICTION = 20000.0, {"SPUNCH": 0.25, "SHOLDER": 0.125, "SDIE": 0.125}
FACETS = 96
WEDGE = 2  # degrees
# Of the way, at most.
INCREMENTS = 0.005, 0.0025
YOUNG, POISSON = "Young's modulus", "Poisson's ratio"


def line(a, b, n):
    return [(a[0] + (b[0] - a[0]) * k / n, a[1] + (b[1] - a[1]) * k / n) for k in range(n + 1)]


def profile(flat, centre, radius, end, outwards, depth):
    """Flat, edge and side of a tool, `depth` inside of it; outwards: +1 for the punch, -1 for the die, whose side looks inwards."""
    z = centre[1] - outwards * (radius - depth)
    arc = [
        (centre[0] + outwards * (radius - depth) * math.sin(a), centre[1] - outwards * (radius - depth) * math.cos(a))
        for a in (math.pi / 2 * k / FACETS for k in range(FACETS + 1))
    ]
    return line((flat, z), arc[0], 6)[:-1] + arc + line(arc[-1], (arc[-1][0], end), 8)[1:]


class Deck:
    def __init__(self):
        self.nodes, self.elements, self.lines = [], 0, []

    def node(self, point):
        self.nodes.append(point)
        return len(self.nodes)

    def blank(self, radial, layers):
        """Cells as (number, nodes); numbers of those below and above."""
        grid = {(i, j): self.node((RADIUS * i / (2 * radial), THICKNESS * j / (2 * layers)))
                for i in range(2 * radial + 1) for j in range(2 * layers + 1) if i % 2 == 0 or j % 2 == 0}  # fmt: skip
        corners = ((0, 0), (2, 0), (2, 2), (0, 2), (1, 0), (2, 1), (1, 2), (0, 1))
        cells, lower, upper = [], [], []
        for i in range(radial):
            for j in range(layers):
                self.elements += 1
                cells.append((self.elements, [grid[2 * i + a, 2 * j + b] for a, b in corners]))
                middle = RADIUS * (i + 0.5) / radial
                lower += [(self.elements, middle)] if j == 0 else []
                upper += [(self.elements, middle)] if j == layers - 1 else []
        return cells, lower, upper, [grid[0, j] for j in range(2 * layers + 1)]

    def tool(self, outside, inside):
        """Cells between two lines, their first side on the outer one; all nodes."""
        a, b = [self.node(p) for p in outside], [self.node(p) for p in inside]
        cells = []
        for i in range(len(a) - 1):
            self.elements += 1
            (x0, y0), (x1, y1), (x2, y2) = (self.nodes[k - 1] for k in (a[i], a[i + 1], b[i + 1]))
            left = (x1 - x0) * (y2 - y0) > (x2 - x0) * (y1 - y0)
            cells.append((self.elements, [a[i], a[i + 1], b[i + 1], b[i]] if left else [a[i + 1], a[i], b[i], b[i + 1]]))
        return cells, a + b

    def write(self, *lines):
        self.lines += lines

    def numbers(self, keyword, values):
        self.write(keyword, *(", ".join(map(str, values[i : i + 10])) + "," for i in range(0, len(values), 10)))

    def surface(self, name, faces):
        self.write(f"*SURFACE, NAME={name}, TYPE=ELEMENT", *(f"{element}, S{side}" for element, side in faces))


def deck(radial, layers, stiffness, increment):
    material = nodus.Case.read(CASE, program=common.program())["Body 1"]["Material"]
    d = Deck()
    cells, lower, upper, axis = d.blank(radial, layers)
    tools = {
        "DIE": d.tool(*(profile(44, (27.5, -5), 5, -32, -1, depth) for depth in (0, 3))),
        "PUNCH": d.tool(*(profile(0, (14, THICKNESS + 6), 6, THICKNESS + 36, 1, depth) for depth in (0, 3))),
        "HOLDER": d.tool(*(line((27.5, z), (44, z), 6) for z in (THICKNESS, THICKNESS + 3))),
    }
    d.write("*NODE, NSET=ALL", *(f"{i}, {x:.9g}, {y:.9g}, 0." for i, (x, y) in enumerate(d.nodes, 1)))
    d.write("*ELEMENT, TYPE=CAX8R, ELSET=BLANK", *(f"{e}, " + ", ".join(map(str, c)) for e, c in cells))
    for name, (elements, nodes) in tools.items():
        d.write(f"*ELEMENT, TYPE=CAX4, ELSET={name}", *(f"{e}, " + ", ".join(map(str, c)) for e, c in elements))
        d.numbers(f"*NSET, NSET=N{name}", nodes)
        d.surface(f"S{name}", [(e, 1) for e, _ in elements])
    d.numbers("*NSET, NSET=AXIS", axis)
    d.surface("INNER", [(e, 3) for e, r in upper if r < 27.5])
    d.surface("OUTER", [(e, 3) for e, r in upper if r > 27.5])
    d.surface("LOWER", [(e, 1) for e, r in lower if r > 21])
    d.write("*MATERIAL, NAME=STEEL", "*ELASTIC", f"{material[YOUNG]}, {material[POISSON]}", "*PLASTIC")
    d.write(*(f"{stress}, {strain}" for strain, stress in
              zip(listed(material["Hardening strains"], ","), listed(material["Hardening stresses"], ","))))
    d.write("*MATERIAL, NAME=TOOL", "*ELASTIC", "211000., .3", "*SOLID SECTION, ELSET=BLANK, MATERIAL=STEEL")
    d.write(*(f"*SOLID SECTION, ELSET={name}, MATERIAL=TOOL" for name in tools))
    for slave, master in (("INNER", "SPUNCH"), ("OUTER", "SHOLDER"), ("LOWER", "SDIE")):
        d.write(f"*SURFACE INTERACTION, NAME=ON_{master}", "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR", f"{stiffness:g}, 0.001",
                "*FRICTION", f"{FRICTION[master]}, {stiffness / 10:g}",
                f"*CONTACT PAIR, INTERACTION=ON_{master}, TYPE=SURFACE TO SURFACE", f"{slave}, {master}")  # fmt: skip
    first, *others = tools["HOLDER"][1]
    for node in others:
        d.write("*EQUATION", "2", f"{node}, 2, 1., {first}, 2, -1.")
    d.write("*BOUNDARY", "AXIS, 1, 1", "NDIE, 1, 2", "NPUNCH, 1, 2", "NHOLDER, 1, 1")
    output = ["*NODE PRINT, NSET=NPUNCH, TOTALS=ONLY", "RF", "*END STEP"]
    d.write("*STEP, NLGEOM, INC=1000", "*STATIC", ".1, 1., 1e-5, .5", "*CLOAD", f"{first}, 2, {-HOLDER:g}", *output)
    d.write("*STEP, NLGEOM, INC=5000", "*STATIC", f"{INCREMENTS[-1]}, 1., 1e-6, {increment}", "*BOUNDARY", f"NPUNCH, 2, 2, {-TRAVEL:g}", *output)
    return "\n".join(d.lines) + "\n"


def run(radial, layers, stiffness, increment):
    """Way of the punch [mm] and force on it [N]; CalculiX prints that of a wedge of 2 degrees."""
    folder = os.path.join(common.SCRATCH, "peers", f"deep_drawing_{increment}")
    os.makedirs(folder, exist_ok=True)
    with open(os.path.join(folder, "cup.inp"), "w", encoding="ascii") as file:
        file.write(deck(radial, layers, stiffness, increment))
    done = subprocess.run([os.environ.get("CCX", "ccx"), "cup"], cwd=folder, env={**os.environ, "OMP_NUM_THREADS": "1"},
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)  # fmt: skip
    if "ERROR" in done.stdout:
        print("CalculiX stops: " + done.stdout[done.stdout.index("*ERROR") :].splitlines()[0])
    return forces(folder)


def forces(folder):
    with open(os.path.join(folder, "cup.dat"), encoding="ascii") as file:
        found = re.findall(r"NPUNCH and time\s+(\S+)\s+\S+\s+(\S+)", file.read())
    return np.array([(TRAVEL * (float(time) - 1), -180 * float(force)) for time, force in found if float(time) > 1])


def wedge(radial, layers, increments, degree):
    """Way of the punch [mm] and force on it [N]."""
    folder = os.path.join(common.SCRATCH, "peers", f"deep_drawing_wedge_{radial}_{layers}_{increments}_{degree}")
    os.makedirs(folder, exist_ok=True)
    mesh = os.path.join(folder, "wedge.msh")
    numbers = [word for name, value in (("wedge", WEDGE), ("r", radial), ("l", layers), ("o", degree)) for word in ("-setnumber", name, str(value))]
    subprocess.run(["gmsh", "-3", "-v", "2", os.path.splitext(CASE)[0] + ".geo", *numbers, "-o", mesh], check=True)
    case, angle = nodus.Case.read(CASE, program=common.program()), math.radians(WEDGE)
    for body in range(1, 5):
        case[f"Body {body}/Mesh file"] = mesh
    case["Body 4/Rigid force"] = f"0; 0; -{HOLDER * WEDGE / 360}*min(t,1)"
    case["Boundary condition 1"] = {"Name": "inclined symmetry", "Type": "spring", "Body": "blank", "Boundary ids": "x_symmetry",
                                    "Direction": [-math.sin(angle), math.cos(angle), 0], "Value": "1e8"}  # fmt: skip
    case["Boundary condition 3"] = {"Name": "axis", "Body": "blank", "Where": "x^2+y^2<0.51^2", "Components": "x, y", "Value": "0"}
    case["Load stepping/Increments"] = [1, increments]
    case["Discretization/Degree"] = degree
    rows = case.run(os.path.join(folder, "results"), check=False).masters.where(body="punch")
    return np.column_stack([TRAVEL * (rows["time"] - 1), 360 / WEDGE * rows["force z"]])[rows["time"] > 1]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--radial", type=int, default=60)
    parser.add_argument("--layers", type=int, default=3)
    parser.add_argument("--stiffness", type=float, default=5e4)
    parser.add_argument("--wedge", action="store_true")
    parser.add_argument("--increments", type=int, default=100)
    parser.add_argument("--degree", type=int, default=1)
    options = parser.parse_args()
    if options.wedge:
        for way, force in wedge(options.radial, options.layers, options.increments, options.degree):
            print(f"{way:.4g} {force:.6g}")
        return
    runs = [run(options.radial, options.layers, options.stiffness, increment) for increment in INCREMENTS]
    ways = np.arange(0.25, min(r[-1, 0] for r in runs) + 1e-6, 0.25)
    coarse, fine = (np.interp(ways, *r.T) for r in runs)
    with open(os.path.splitext(CASE)[0] + ".csv", "w", encoding="utf-8") as file:
        file.write(f"# Way of the punch [mm] and force on it [N]: CalculiX by contrib/studies/peers/deep_drawing.py, {options.radial} x {options.layers} cells CAX8R, "
                   f"contact stiffness {options.stiffness:g} MPa/mm; extrapolated from those with increments of 0.125 and 0.0625 mm\n"
                   "way,force,increments of 0.125,increments of 0.0625\n")  # fmt: skip
        for row in zip(ways, 2 * fine - coarse, coarse, fine):
            file.write(",".join(f"{value:.6g}" for value in row) + "\n")


if __name__ == "__main__":
    main()
