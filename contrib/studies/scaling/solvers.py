#!/usr/bin/python3
"""The three linear solvers on every case of prm/: their answers differ by no more than the tolerances of Newton.

Writes solvers.md. Cases may be named on the command line: the others keep their earlier results; without names all run.
"""

import json
import os
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.dirname(HERE))
import common  # noqa: E402

SOLVERS = ("direct", "condensed", "block")
TIGHT = {
    "Newton/Force tolerance": "1e-9",
    "Newton/Contact tolerance": "1e-10",
    "Newton/Maximum iterations": "40",
    "Newton/Largest forcing term": "0",
    "Linear solver/Tolerance": "1e-13",
    "Geometry loop/Tolerance": "1e-9",
    "Output/Write VTU": "false",
}
# What is out of reach of residuals: forces of the slender beams are small beside stiffness times displacement.
ATTAINABLE = {"cantilevers": {"Linear solver/Tolerance": "1e-9"}}
MODES = {f"{loop} loop/Mode": "newton" for loop in ("Geometry", "Threshold", "Status")}
# Columns of one scale each; the numbers of nodes are compared exactly.
GROUPS = {
    "force": [f"slave force {axis}" for axis in "xyz"],
    "moment": [f"slave moment {axis}" for axis in "xyz"],
    "area": ["contact area"],
    "pressure": ["maximum pressure"],
}
STATUSES = [f"{status} nodes" for status in ("open", "slip", "stick", "unpaired")]


CONCLUSION = """All linear systems are solved to the tolerance of the solver (`Largest forcing term = 0`), so that Newton's
iterations take the same path. With forcing terms `plate_on_rigid_plane`, where nodes are on the verge of slip at a
coefficient of friction of 1, has a second solution: four nodes of the thin plate stick, and forces across it do not vanish.

`cantilevers` does not reach a relative residual of 1e-13: forces are small beside stiffness times displacement in these slender
beams. Its systems are solved to 1e-9 (`ATTAINABLE`), and Newton's iterations end with the same residuals as elsewhere.
A correction that an iterative solver does not bring to its tolerance leaves the rest of its increment to the direct one: once in
`rubber_block` (condensed) and in `wedge`.
"""


def common_times(rows, reference):
    """Pairs of rows of the same pair and time: cut-backs add some."""
    known = {(row["pair"], row["time"]): row for row in reference}
    return [(row, known[row["pair"], row["time"]]) for row in rows if (row["pair"], row["time"]) in known]


def difference(rows, reference):
    """Largest difference of the columns in all increments, relative to the largest value of their group; forces and
    moments may cancel in the sum and are relative to pressure times area, and times its edge, where those are larger."""
    worst = 0.0
    load = max(row["maximum pressure"] * row["contact area"] for row in reference)
    least = {"force": load, "moment": load * max(row["contact area"] for row in reference) ** 0.5}
    for group, columns in GROUPS.items():
        scale = max([least.get(group, 0.0)] + [abs(row[c]) for row in reference for c in columns])
        for row, other in common_times(rows, reference):
            for c in columns:
                worst = max(worst, abs(row[c] - other[c]) / scale if scale > 0.0 else 0.0)
    return worst


def rows_of(case):
    table, reference = [], None
    for solver in SOLVERS:
        prm = os.path.join(common.ROOT, "prm", case + ".prm")
        run = common.run(prm, f"solvers_{case}_{solver}", {**MODES, **TIGHT, **ATTAINABLE.get(case, {}), "Linear solver/Type": solver})
        if not run.converged:
            table.append([case, solver, "stops", "", "", "", f"{run.cpu:.1f}"])
            continue
        rows = run.contact
        counts = {row["increment"]: row for row in rows}.values()
        reference = reference or rows
        table.append([
            case,
            solver,
            "" if rows is reference else f"{difference(rows, reference):.0e}",
            "" if rows is reference else
            "yes" if all(a[c] == b[c] for a, b in common_times(rows, reference) for c in STATUSES) else "no",
            int(sum(row["fallbacks"] for row in counts)),
            int(sum(row["Newton iterations"] for row in counts)),
            f"{run.cpu:.1f}",
        ])  # fmt: skip
    return table


def main():
    store = os.path.join(HERE, "solvers.json")
    known = json.load(open(store)) if os.path.exists(store) else {}
    cases = sorted(name[:-4] for name in os.listdir(os.path.join(common.ROOT, "prm")) if name.endswith(".prm"))
    for case in sys.argv[1:] or cases:
        known[case] = rows_of(case)
        with open(store, "w") as file:
            json.dump(known, file, indent=0)
    path = os.path.join(HERE, "solvers.md")
    text = common.table(
        path,
        ["case", "solver", "largest difference to direct", "same statuses", "fallbacks", "Newton iterations", "CPU s"],
        [row for case in cases if case in known for row in known[case]],
    )
    with open(path, "w") as file:
        file.write(__doc__.split("\n")[0] + "\n\nForces, moments, areas and largest pressures of all increments, relative"
                   " to the largest of their kind.\nMade by `contrib/studies/scaling/solvers.py`.\n\n" + text + "\n" + CONCLUSION)


if __name__ == "__main__":
    main()
