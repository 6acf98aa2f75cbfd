#!/usr/bin/python3
"""What every rank holds and does for the whole model: the coarse mesh of the file, and the contact surfaces.

    replicated.py

Writes replicated.md. Work is CPU outside of MPI (mpi_count.c, see ranks.py).
"""

import os

import hertz_case
import ranks
from hertz_case import common

RANKS = 8
# Cells along the edge and refinements: the same cells, of 5 103 or 40 824 in the file.
MESHES = [(12, 1), (24, 0)]
# Cells along the edge of bodies of two layers of cells: surface and little else.
SURFACES = [32, 64]


def validate(library, name, n, layers=None, refinement=0):
    """Peak resident bytes and work in seconds, both mean over the ranks, of a case that is read, paired and checked."""
    folder = os.path.join(common.SCRATCH, "hertz", "replicated_" + name)
    prm = hertz_case.write(n, folder)
    if layers:
        hertz_case.Mesh(n, layers).write(os.path.join(folder, f"hertz_{n}.msh"))
    variables = {**hertz_case.environment(), "MPI_COUNT": os.path.join(folder, "mpi_count")}
    command = ["mpirun", "-x", "LD_PRELOAD=" + library, "-x", "MPI_COUNT", "-n", str(RANKS), common.NODUS, prm]
    for body in (1, 2):
        command += ["--set", f"Body {body}/Global refinement={refinement}"]
    command.append("--validate")
    done = hertz_case.measured(command, os.path.join(folder, "log"), environment=variables)
    print(f"  {name}: exit {done['exit']}, {done['cpu']:.1f} CPU s", flush=True)
    count = ranks.counted(folder, RANKS)
    return count["peak"].mean(), (count["process cpu"] - count["cpu"]).mean()


def main():
    os.makedirs(common.SCRATCH, exist_ok=True)
    library = ranks.counting_library()
    rows = []
    found = [validate(library, f"mesh_{n}", n, refinement=level) for n, level in MESHES]
    cells = [n**3 + round(1.25 * n) ** 3 for n, _ in MESHES]
    for (n, level), (peak, work), m in zip(MESHES, found, cells):
        rows.append(["mesh", f"n = {n}, refined {level} times", hertz_case.spaced(m), f"{peak / 2**20:.0f}", f"{work:.2f}"])
    per_cell = [(found[1][i] - found[0][i]) / (cells[1] - cells[0]) for i in range(2)]

    found = [validate(library, f"surface_{n}", n, layers=2) for n in SURFACES]
    nodes = [(n + 1) ** 2 for n in SURFACES]
    for n, (peak, work), m in zip(SURFACES, found, nodes):
        rows.append(["surface", f"n = {n}, two layers", hertz_case.spaced(m), f"{peak / 2**20:.0f}", f"{work:.2f}"])
    # less what the cells of the file cost
    surface_cells = [2 * (n**2 + round(1.25 * n) ** 2) for n in SURFACES]
    per_node = [
        (found[1][i] - found[0][i] - per_cell[i] * (surface_cells[1] - surface_cells[0])) / (nodes[1] - nodes[0])
        for i in range(2)
    ]
    path = os.path.join(hertz_case.HERE, "replicated.md")
    text = common.table(path, ["", "case", "coarse cells / slave nodes", "peak MiB", "work s"], rows)
    with open(path, "w") as file:
        file.write(f"""## What each rank holds for the whole model

`contrib/studies/scaling/replicated.py` on {hertz_case.machine()}; {hertz_case.today()}. Cases are read, paired and
checked only (`--validate`), on {RANKS} ranks, means over them; work is CPU outside of MPI, with the start of the program.

{text}
- *mesh*: the same cells, once from the file and once refined from an eighth of them. Each cell of the file costs
  **{hertz_case.spaced(per_cell[0])} bytes** and **{1e6 * per_cell[1]:.0f} us** on every rank.
- *surface*: bodies of two layers of cells. Each slave node, with its 1.56 master nodes, costs
  **{hertz_case.spaced(per_node[0])} bytes** and, for one pairing, **{1e6 * per_node[1]:.0f} us** on each of the {RANKS} ranks beyond what its five
  cells of the file cost. That is an upper bound of what is replicated: a share of 1 / {RANKS} in it is each rank's own work.
""")


if __name__ == "__main__":
    main()
