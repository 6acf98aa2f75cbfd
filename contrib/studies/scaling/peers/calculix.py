#!/usr/bin/python3
"""The case `hertz` in CalculiX (program ccx, Debian package calculix-ccx): surface-to-surface penalty contact without
friction, linear elastic C3D8, geometrically nonlinear, one increment, one thread.

    calculix.py N [--solver "ITERATIVE CHOLESKY"] [--penalty 50] [--program ccx] [--keep FOLDER]

--penalty: slope of pressure over penetration in units of Young's modulus per length; 50 is CalculiX's own for hard
contact. Convergence as CalculiX has it. Prints one line of JSON.
"""

import argparse
import json
import os
import shutil
import sys
import tempfile

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
import hertz_case  # noqa: E402

LABEL = {"z-": "S1", "z+": "S2"}


def write(mesh, path, arguments):
    def numbers(values):
        values = [str(value + 1) for value in values]
        return ",\n".join(", ".join(values[i : i + 12]) for i in range(0, len(values), 12)) + "\n"

    with open(path, "w") as file:
        file.write("*NODE, NSET=ALL\n")
        file.writelines(f"{i}, {x:.12g}, {y:.12g}, {z:.12g}\n" for i, (x, y, z) in enumerate(mesh.nodes.tolist(), 1))
        number = 0
        for body, cells in mesh.cells.items():
            file.write(f"*ELEMENT, TYPE=C3D8, ELSET=BODY{body}\n")
            for nodes in (cells + 1).tolist():
                number += 1
                file.write(f"{number}, {', '.join(map(str, nodes))}\n")
        file.write(f"*MATERIAL, NAME=ELASTIC\n*ELASTIC\n{hertz_case.E}, {hertz_case.NU}\n")
        for body in mesh.cells:
            file.write(f"*SOLID SECTION, ELSET=BODY{body}, MATERIAL=ELASTIC\n")
        for name, (cells, _), side in (("SLAVE", mesh.slave, "z-"), ("MASTER", mesh.master, "z+")):
            file.write(f"*SURFACE, NAME={name}, TYPE=ELEMENT\n")
            file.writelines(f"{cell + 1}, {LABEL[side]}\n" for cell in cells)
        for name, sides in (
            ("SYMX", [(1, "x-"), (2, "x-")]),
            ("SYMY", [(1, "y-"), (2, "y-")]),
            ("BOTTOM", [(2, "z-")]),
            ("TOP", [(1, "z+")]),
        ):
            file.write(f"*NSET, NSET={name}\n" + numbers(mesh.nodes_of(*sides)))
        file.write(
            "*SURFACE INTERACTION, NAME=CONTACT\n*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n"
            f"{arguments.penalty * hertz_case.E:.8g}\n"
            "*CONTACT PAIR, INTERACTION=CONTACT, TYPE=SURFACE TO SURFACE\nSLAVE, MASTER\n"
            "*BOUNDARY\nSYMX, 1, 1\nSYMY, 2, 2\nBOTTOM, 1, 3\n"
            f"*STEP, NLGEOM, INC=2000\n*STATIC, SOLVER={arguments.solver}\n1, 1, 1e-8, 1\n"
            f"*BOUNDARY\nTOP, 3, 3, {-hertz_case.INDENTATION}\n"
            "*NODE FILE\nU\n*CONTACT FILE\nCDIS, CSTR\n*NODE PRINT, NSET=BOTTOM, TOTALS=ONLY\nRF\n*END STEP\n"
        )


def contact_stresses(path):
    """Last block CONTACT of the .frd file: node -> values, the fourth is the pressure."""
    values, inside = {}, False
    with open(path, errors="replace") as file:
        for line in file:
            if line.startswith(" -4"):
                inside = line.split()[1] == "CONTACT"
                if inside:
                    values = {}
            elif line.startswith(" -3"):
                inside = False
            elif inside and line.startswith(" -1"):
                row = line[13:].rstrip("\n")
                values[int(line[3:13]) - 1] = [float(row[i : i + 12]) for i in range(0, len(row), 12)]
    return values


def total_force(path):
    with open(path) as file:
        text = file.read().split("total force (fx,fy,fz) for set BOTTOM")[-1].splitlines()
    return float([line for line in text[1:] if line.strip()][0].split()[2])


def count(path, width):
    """Rows of numbers of a table."""
    with open(path) as file:
        return sum(1 for line in file if len(line.split()) >= width and line.split()[0].isdigit())


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("n", type=int)
    parser.add_argument("--solver", default="ITERATIVE CHOLESKY")
    parser.add_argument("--penalty", type=float, default=50.0)
    parser.add_argument("--program", default=os.environ.get("CCX", "ccx"))
    parser.add_argument("--keep", default="")
    arguments = parser.parse_args()
    mesh = hertz_case.Mesh(arguments.n)
    folder = arguments.keep or tempfile.mkdtemp(prefix="calculix_")
    os.makedirs(folder, exist_ok=True)
    path = os.path.join(folder, "hertz")
    write(mesh, path + ".inp", arguments)
    result = hertz_case.measured(
        [arguments.program, "-i", "hertz"], os.path.join(folder, "log"), folder, hertz_case.environment()
    )
    with open(os.path.join(folder, "log"), errors="replace") as file:
        result["converged"] = result["exit"] == 0 and "Job finished" in file.read()
    if result["converged"]:
        pressure = contact_stresses(path + ".frd")
        result["Newton"] = count(path + ".cvg", 4)
        result["increments"] = count(path + ".sta", 7)
        result["force"] = total_force(path + ".dat")
        result["pressure"] = [pressure.get(int(node), [0.0] * 6)[3] for node in mesh.slave_nodes]
    print(json.dumps(result))
    if not arguments.keep:
        shutil.rmtree(folder)


if __name__ == "__main__":
    main()
