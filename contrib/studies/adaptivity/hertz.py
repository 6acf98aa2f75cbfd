#!/usr/bin/python3
"""Hertz contact on uniform and adaptive meshes: error of the pressure against unknowns and CPU. Writes hertz.md, hertz.png.

    hertz.py [--report]     (--report: from the runs that are there)

The case is prm/adaptive_hertz.prm. The exact pressures are Hertz's with the force that the run found.
"""

import json
import os
import re
import sys

import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.dirname(HERE))
import common  # noqa: E402

CASE = os.path.join(common.ROOT, "prm", "adaptive_hertz.prm")
E_STAR = 1000 / (2 * (1 - 0.3**2))
OFF = {"Adaptivity/Interval": 0, "Adaptivity/Initial cycles": 0, "Load stepping/Increments": 1}
MERGED = {f"{loop} loop/Mode": "newton" for loop in ("Geometry", "Threshold", "Status")}


def uniform(degree, level):
    return {**OFF, "Discretization/Degree": degree, "Body 1/Global refinement": level, "Body 2/Global refinement": level}


def adaptive(degree, cycles, level):
    return {"Discretization/Degree": degree, "Adaptivity/Initial cycles": cycles, "Adaptivity/Maximum level": level}


def cases():
    for degree, levels in ((1, (2, 3, 4, 5)), (2, (1, 2, 3, 4))):
        for level in levels:
            yield f"Q{degree} uniform {level}", uniform(degree, level)
    for degree, pairs in ((1, ((2, 3), (3, 4), (4, 5), (5, 6))), (2, ((2, 2), (3, 3), (3, 4), (4, 5)))):
        for cycles, level in pairs:
            yield f"Q{degree} adaptive {level}", adaptive(degree, cycles, level)


def profile(run):
    surface = run.surface()
    r = np.hypot(surface.reference[:, 0], surface.reference[:, 1])
    return r, surface.field("CPRESS").ravel(), surface.field("area").ravel()


def measure(name, keys):
    run = common.run(CASE, "adaptivity/" + name.replace(" ", "_"), {**MERGED, **keys})
    if not run.converged:
        return {"name": name, "converged": False}
    force = 4 * run.contact[-1]["slave force z"]
    a, p0 = common.nodus.references.hertz_sphere(force, 1.0, E_STAR)
    r, pressure, area = profile(run)
    exact = common.nodus.references.elliptic(r, a, p0)
    error = np.sqrt(np.sum(area * (pressure - exact) ** 2) / np.sum(area * exact**2))
    unknowns = [int(found) for found in re.findall(r"-> (\d+) unknowns", run.log)]
    unknowns = unknowns or [int(re.search(r"(\d+) displacement degrees of freedom", run.log).group(1))]
    return {"name": name, "converged": True, "unknowns": unknowns[-1], "cpu": run.cpu, "error": error,
            "force": force, "largest": pressure.max() / p0}  # fmt: skip


def main():
    kept = os.path.join(common.SCRATCH, "adaptivity", "hertz.json")
    if "--report" in sys.argv:
        with open(kept) as file:
            found = json.load(file)
    else:
        found = [measure(name, keys) for name, keys in cases()]
        with open(kept, "w") as file:
            json.dump(found, file, indent=1)
    rows = []
    for run in found:
        if run["converged"]:
            rows.append([run["name"], run["unknowns"], f"{run['cpu']:.1f}", f"{100 * run['error']:.2f} %",
                         f"{run['force']:.4f}", f"{run['largest']:.3f}"])  # fmt: skip
        else:
            rows.append([run["name"], "did not converge", "", "", "", ""])
    header = ["mesh", "unknowns", "CPU s", "L2 error of the pressure", "force", "largest / Hertz's"]
    common.table(os.path.join(HERE, "hertz.md"), header, rows)

    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    figure, axes = plt.subplots(1, 2, figsize=(9, 4), constrained_layout=True)
    for axis, key, label in ((axes[0], "unknowns", "unknowns"), (axes[1], "cpu", "CPU s")):
        for kind, style in (("Q1 uniform", "o--"), ("Q1 adaptive", "o-"), ("Q2 uniform", "s--"), ("Q2 adaptive", "s-")):
            runs = [run for run in found if run["converged"] and run["name"].startswith(kind)]
            axis.loglog([run[key] for run in runs], [run["error"] for run in runs], style, label=kind)
        axis.set_xlabel(label)
        axis.set_ylabel("L2 error of the pressure")
        axis.grid(True, which="both", alpha=0.3)
    axes[0].legend()
    figure.savefig(os.path.join(HERE, "hertz.png"), dpi=120)


if __name__ == "__main__":
    main()
