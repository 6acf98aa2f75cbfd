#!/usr/bin/python3
"""Ironing: a rigid sphere is pressed into an elastic block and dragged along; the mesh follows the moving contact zone.

The force history on adaptive meshes against that on the uniform mesh of the same smallest cells. Writes ironing.md,
ironing.png.

    ironing.py [NAME ...]     (all cases without names; --report: from the runs that are there)
"""

import json
import os
import re
import sys

import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.dirname(HERE))
import common  # noqa: E402

PRM = """set Title = Ironing with a rigid sphere, half model
subsection Body 1
  set Name                = block
  set Generator           = subdivided_hyper_rectangle
  set Generator arguments = 14,4,4 : -1,0,-1 : 2.5,1,0 : true
  subsection Material
    set Law             = neo-Hookean
    set Young's modulus = 100
    set Poisson's ratio = 0.3
  end
end
subsection Boundary condition 1
  set Name         = symmetry
  set Boundary ids = 2
  set Components   = y
  set Value        = 0
end
subsection Boundary condition 2
  set Name         = support
  set Boundary ids = 4
  set Components   = x, y, z
  set Value        = 0
end
subsection Contact pair 1
  set Name                 = contact
  set Slave body           = 1
  set Slave boundary ids   = 5
  set Slave where          = y < 0.7
  set Master surface       = sphere
  set Master point         = 0, 0, 1
  set Master radius        = 1
  set Master translation   = 1.5*max(t-1,0); 0; -0.08*min(t,1)
  set Friction coefficient = 0.3
end
subsection Load stepping
  set Interval ends = 1, 2
  set Increments    = 4, 30
end
subsection Linear solver
  set Type = condensed
end
subsection Output
  set Write VTU = false
end
"""


MERGED = {f"{loop} loop/Mode": "newton" for loop in ("Geometry", "Threshold", "Status")}


def adaptive(level, fraction, interval=2):
    return {"Adaptivity/Interval": interval, "Adaptivity/Initial cycles": level, "Adaptivity/Maximum level": level,
            "Adaptivity/Contact distance": 0.12, "Adaptivity/Refine fraction": fraction,
            "Adaptivity/Coarsen fraction": 0.01}  # fmt: skip


CASES = {
    "uniform 1": {"Body 1/Global refinement": 1},
    "uniform 2": {"Body 1/Global refinement": 2},
    "adaptive 2": adaptive(2, fraction=0.9),
    "uniform 3": {"Body 1/Global refinement": 3},
    "adaptive 3": adaptive(3, fraction=0.9),
}


def measure(name, keys):
    path = common.write_case("adaptivity/ironing", PRM)
    run = common.run(path, "adaptivity/ironing_" + re.sub("[, ]+", "_", name), {**MERGED, **keys})
    history = [[row["time"], row["slave force x"], row["slave force z"]] for row in run.contact]
    unknowns = [int(found) for found in re.findall(r"-> (\d+) unknowns", run.log)]
    unknowns = unknowns or [int(re.search(r"(\d+) displacement degrees of freedom", run.log).group(1))]
    jumps = [float(found) for found in re.findall(r"contact changes by ([-+.e0-9]+) %", run.log)]
    return {"name": name, "converged": run.converged, "unknowns": max(unknowns), "cpu": run.cpu, "history": history,
            "jumps": jumps}  # fmt: skip


def differences(run, reference):
    """Largest difference of the forces along x and z while the sphere is dragged, relative to those."""
    a, b = (np.array([row for row in r["history"] if row[0] > 1.0 + 1e-9]) for r in (run, reference))
    return [np.max(np.abs(a[:, c] / b[:, c] - 1)) for c in (1, 2)]


def main():
    kept = os.path.join(common.SCRATCH, "adaptivity", "ironing.json")
    done = {}
    if os.path.exists(kept):
        with open(kept) as file:
            done = {run["name"]: run for run in json.load(file)}
    for name in sys.argv[1:] or CASES:
        if name != "--report":
            done[name] = measure(name, CASES[name])
            with open(kept, "w") as file:  # each as it comes
                json.dump(list(done.values()), file, indent=1)
    found = [done[name] for name in CASES if name in done]
    reference_of = {run["name"].split()[1].rstrip(","): run for run in found if run["name"].startswith("uniform")}
    rows = []
    for run in found:
        reference = reference_of[run["name"].split()[1].rstrip(",")]
        row = [run["name"], run["unknowns"], f"{run['cpu']:.0f}"]
        if run is reference:
            row += ["", "", "", ""]
        else:
            x, z = differences(run, reference)
            # jumps while dragged: the mesh is still being built up before
            row += [f"{reference['cpu'] / run['cpu']:.1f}", f"{100 * x:.2f} %", f"{100 * z:.2f} %",
                    f"{max(run['jumps'][2:]):.2f} %"]  # fmt: skip
        rows.append(row)
    header = ["mesh", "unknowns, largest", "CPU s", "uniform / this CPU", "force x differs by", "force z differs by",
              "largest change at a new mesh"]  # fmt: skip
    common.table(os.path.join(HERE, "ironing.md"), header, rows)

    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    figure, axes = plt.subplots(1, 2, figsize=(9, 4), constrained_layout=True)
    for run in found:
        history = np.array(run["history"])
        for axis, column in zip(axes, (1, 2)):
            style = "-" if run["name"].startswith("uniform") else "--"
            axis.plot(history[:, 0], np.abs(history[:, column]), style, label=run["name"])
    for axis, label in zip(axes, ("force x", "force z")):
        axis.set_xlabel("t")
        axis.set_ylabel(label)
        axis.grid(alpha=0.3)
    axes[0].legend()
    figure.savefig(os.path.join(HERE, "ironing.png"), dpi=120)


if __name__ == "__main__":
    main()
