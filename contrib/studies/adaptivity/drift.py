#!/usr/bin/python3
"""Drift of a state with stick and slip while cells are split and joined again, twenty times, at constant load.
Writes drift.md, drift.png.

    drift.py [--report]     (--report: from the runs that are there)

Cases: prm/plate_on_rigid_plane.prm (loads by tractions; stick, slip and open), and partial slip of cattaneo_mindlin.py, with
forces and with displacements that are held. Meshes change after every increment; what is compared are the times at which the
mesh is the same.
"""

import json
import os
import re
import sys

import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.dirname(HERE))
sys.path.insert(0, HERE)
import common  # noqa: E402
import partial_slip_case as case  # noqa: E402

CYCLES = 20
MERGED = {f"{loop} loop/Mode": "newton" for loop in ("Geometry", "Threshold", "Status")}
# cells that have just been split have small errors and are joined again, those that have just been joined are split
TURNS = {"Adaptivity/Interval": 1, "Adaptivity/Maximum level": 1, "Adaptivity/Refine fraction": 0.5,
         "Adaptivity/Coarsen fraction": 0.5}  # fmt: skip


def write_plate():
    with open(os.path.join(common.ROOT, "prm", "plate_on_rigid_plane.prm")) as file:
        text = file.read()
    return common.write_case("adaptivity/drift_plate", text.replace("e7*t", "e7*min(t,1)"))


def cases():
    plate = write_plate()
    held = {"Load stepping/Interval ends": "1, 2", "Load stepping/Increments": f"1, {2 * CYCLES + 6}"}
    yield "plate", plate, {**TURNS, **held, "Output/VTU interval": 0}
    graded = case.graded()
    held = {"Load stepping/Interval ends": "1, 2, 3", "Load stepping/Increments": f"1, 3, {2 * CYCLES + 6}"}
    for name, loads in (("force", case.BY_FORCE), ("displacement", case.BY_DISPLACEMENT)):
        prm = case.write("graded_" + name, graded, loads)
        yield "partial slip, " + name, prm, {**TURNS, **held, "Body 1/Global refinement": 1, "Body 2/Global refinement": 1,
                                              "Output/VTU interval": 0}  # fmt: skip


def measure(name, prm, keys):
    run = common.run(prm, re.sub(r"[ ,]+", "_", "adaptivity/drift " + name), {**MERGED, **keys})
    rows = [[row["increment"], row["time"], row["slave force x"], row["slave force y"], row["slave force z"],
             row["open nodes"], row["slip nodes"], row["stick nodes"]] for row in run.contact()]  # fmt: skip
    cells = [int(n) for n in re.findall(r"(\d+) unknowns, \d+ slave nodes$", run.log, re.M)]
    jumps = [float(jump) for jump in re.findall(r"the contact force of contact changes by (\S+) %", run.log)]
    return {"name": name, "converged": run.converged, "cpu": run.cpu, "rows": rows, "unknowns": cells, "jumps": jumps,
            "failed": run.log.count("no equilibrium on the new mesh")}  # fmt: skip


def main():
    kept = os.path.join(common.SCRATCH, "adaptivity", "drift.json")
    if "--report" in sys.argv:
        with open(kept) as file:
            found = json.load(file)
    else:
        found = [measure(*keys) for keys in cases()]
        with open(kept, "w") as file:
            json.dump(found, file)
    for run in found:
        print(run["name"], run["converged"], f"{run['cpu']:.1f}", run["unknowns"], run["jumps"])
        for row in run["rows"]:
            print("  ", row)


if __name__ == "__main__":
    main()
