#!/usr/bin/python3
"""Loops around Newton against loops merged into Newton: iterations, CPU and answers of the cases of prm/.

Writes modes.md. Cases may be named on the command line: the others keep their earlier results; without names all run.
"""

import json
import os
import sys

import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.dirname(HERE))
import common  # noqa: E402

# Merged into Newton: geometry, threshold, status.
MODES = {
    "three loops": "",
    "status": "s",
    "geometry": "g",
    "threshold, status": "ts",
    "all": "gts",
}

# Case and further keys. Tolerances of the loops as shipped: answers agree to those.
CASES = {
    "plate_on_rigid_plane": {},
    "plate_on_rigid_plane, tight loops": {"Threshold loop/Tolerance": "1e-7", "Geometry loop/Tolerance": "1e-6"},
    "cantilevers": {},
    "cantilevers, friction 0.2": {"Contact pair 1/Friction coefficient": "0.2"},
    "sliding_blocks": {},
    "unsticking": {},
    "inclined_interface": {},
    "ring": {},
    "patch": {},
    "hertz, one increment": {"Load stepping/Increments": "1"},
    "hertz, one increment, direct": {"Load stepping/Increments": "1", "Linear solver/Type": "direct"},
}
FORCES = [f"slave force {axis}" for axis in "xyz"]


CONCLUSION = """With all three merged every case finishes, at a quarter to nine tenths of the CPU of the three loops where that is above
a second (but 1.6 times that of the loops in `ring`, where merging saves no iteration), and with the geometry of the
converged state where the loops stop at 1e-2 of the step. Threshold and status merged alone cost about the same CPU in
total: they need more iterations, each cheaper, because the tangent of a frozen geometry has fewer entries and keeps its
pattern. Merging the geometry alone pays without friction (cantilevers) and not where status and threshold loops repeat
its iterations in every pass. `patch` and `inclined_interface` are linear at frozen geometry; merging it costs them one
iteration, which is the one that moves it.

The cantilevers with friction, where Code_Aster stops at t = 0.90, reach the end in every mode; with all merged in 254
iterations instead of 928 with three loops, two increments by way of a fallback.

The default is therefore `newton` for all three.
"""


def measure(case, mode):
    name = case.split(",")[0]
    sets = dict(CASES[case])
    for loop, letter in (("Geometry", "g"), ("Threshold", "t"), ("Status", "s")):
        sets[f"{loop} loop/Mode"] = "newton" if letter in MODES[mode] else "fixed point"
    sets["Output/VTU interval"] = "0"
    prm = os.path.join(common.ROOT, "prm", name + ".prm")
    run = common.run(prm, f"modes_{case}_{mode}".replace(", ", "_").replace(" ", "_"), sets)
    # one row per increment and pair; the counts are those of the increment
    rows = {row["increment"]: row for row in run.contact}.values() if run.converged else []
    return run, list(rows)


def rows_of(case):
    """Rows of the table: one for each mode."""
    table, reference = [], None
    for mode in MODES:
        run, rows = measure(case, mode)
        if not run.converged:
            table.append([case, mode, "stops", *[""] * 6])
            continue
        newton = [int(row["Newton iterations"]) for row in rows]
        forces = np.array([[row[key] for key in FORCES] + [row["maximum pressure"]] for row in rows])
        if reference is None:
            reference = forces
        scale = np.abs(reference).max(axis=0)
        scale[:3] = scale[:3].max()
        timing = common.timing(run)
        table.append([
            case,
            mode,
            f"{sum(newton)}",
            f"{sum(newton) / len(newton):.1f}",
            f"{max(newton)}",
            f"{sum(int(row['Krylov iterations']) for row in rows)}",
            f"{sum(int(row['fallbacks']) for row in rows)}",
            f"{run.cpu:.1f} ({timing.get('linear solver', 0):.1f})",
            f"{np.max(np.abs(forces - reference) / scale):.1e}",
        ])  # fmt: skip
    return table


def main():
    path = os.path.join(common.SCRATCH, "modes.json")
    done = {}
    if os.path.exists(path):
        with open(path) as file:
            done = json.load(file)
    os.makedirs(common.SCRATCH, exist_ok=True)
    for case in sys.argv[1:] or CASES:
        done[case] = rows_of(case)
        with open(path, "w") as file:
            json.dump(done, file)
    table = [row for case in CASES for row in done.get(case, [])]
    header = ["case", "merged into Newton", "Newton iterations", "per increment", "most", "Krylov", "fallbacks",
              "CPU s (linear solver)", "difference"]  # fmt: skip
    path = os.path.join(HERE, "modes.md")
    text = common.table(path, header, table)
    with open(path, "w") as file:
        file.write(
            "## Three nested loops against loops merged into Newton\n\n"
            "Each of the geometry, threshold and status loops is a fixed point around Newton or part of each Newton iteration "
            "(`Mode`). `difference`: of contact forces and largest pressures over all increments from those of the three "
            "loops, relative to their largest; the loops stop at their tolerances (geometry 1e-2, threshold 1e-4) where "
            "merged iterations go on to those of Newton (1e-8). `fallbacks`: increments in which the merged iteration stalled "
            "and was done again, first with the geometry as a loop, then with three loops; all their iterations count. One core, CPU of the whole run.\n\n" + text + "\n" + CONCLUSION
        )


if __name__ == "__main__":
    main()
