#!/usr/bin/python3
"""CPU, memory and iterations of nodus over the size of the model: case `hertz`, three linear solvers, with friction and
without.

    size.py [N | SOLVER | FRICTION]...    e.g. size.py 24 condensed 0.3; without names all of the default

Writes size.md and size.png; runs that are not named keep their results of size.json.
"""

import os
import sys

import hertz_case
from hertz_case import common

# Sizes of each solver; those in SLOW only when named.
SIZES = {"condensed": [6, 12, 16, 24, 32, 48, 64], "block": [6, 12, 16, 24, 32, 48], "direct": [6, 12, 16]}
SLOW = {("condensed", 64), ("block", 48)}
FRICTION = [0.0, 0.3]
PHASES = ["mesh and set-up", "pairing", "status", "contact assembly", "bulk assembly", "solver set-up",
          "solver iterations", "output"]  # fmt: skip


def key(solver, n, friction):
    return f"{solver} {n} {friction}"


def measure(solver, n, friction):
    run = hertz_case.nodus(n, f"size_{solver}_{n}_{friction}", solver, friction)
    result = {"solver": solver, "n": n, "friction": friction, "converged": run["exit"] == 0}
    if result["converged"]:
        profile = run["profile"]
        result.update({
            "cpu": run["cpu"],
            "peak": run["peak MiB"] * 2**20,
            "private": run["private MiB"] * 2**20,
            "Newton": profile["newton_iterations"],
            "Krylov": profile["krylov_iterations"],
            "phases": {phase["name"]: phase["cpu_seconds"] for phase in profile["phases"]},
            "solves": next(p["calls"] for p in profile["phases"] if p["name"] == "solver iterations"),
            "force": run["contact"]["slave force z"],
        })  # fmt: skip
    return result


def main():
    names = sys.argv[1:]
    solvers = [x for x in SIZES if x in names] or list(SIZES)
    friction = [x for x in FRICTION if any("." in y and float(y) == x for y in names)] or FRICTION
    sizes = [int(x) for x in names if x.isdigit()]
    kept = hertz_case.Kept("size")
    for n in sorted({n for solver in solvers for n in SIZES[solver]}):
        for solver in solvers:
            if n not in SIZES[solver] or (n not in sizes if sizes else (solver, n) in SLOW):
                continue
            for mu in friction:
                kept[key(solver, n, mu)] = measure(solver, n, mu)
    write(kept)


def write(kept):
    found = [kept.get(key(s, n, mu)) for s in SIZES for mu in FRICTION for n in SIZES[s]]
    found = [r for r in found if r]
    rows, phases = [], []
    for r in found:
        dofs = hertz_case.dofs(r["n"])
        row = [r["solver"], r["friction"], r["n"], hertz_case.spaced(dofs)]
        if not r["converged"]:
            rows.append([*row, "stops", *[""] * 5])
            continue
        per_newton = r["Krylov"] / r["Newton"]
        rows.append([
            *row,
            f"{r['cpu']:.1f}",
            f"{1e6 * r['cpu'] / dofs:.0f}",
            hertz_case.spaced(r["peak"] / dofs),
            hertz_case.spaced(r["private"] / dofs),
            r["Newton"],
            f"{per_newton:.1f}" if r["Krylov"] else "",
        ])  # fmt: skip
        if r["solver"] == "condensed":
            per_iteration = 1e6 * r["phases"]["solver iterations"] / dofs / max(r["Krylov"], 1)
            per_dof = [f"{1e6 * r['phases'][name] / dofs:.1f}" for name in PHASES]
            phases.append([r["friction"], r["n"], hertz_case.spaced(dofs), *per_dof, f"{per_iteration:.2f}"])
    path = os.path.join(hertz_case.HERE, "size.md")
    header = ["solver", "friction", "n", "degrees of freedom", "CPU s", "CPU us per DoF", "bytes per DoF",
              "private bytes per DoF", "Newton iterations", "Krylov per Newton"]  # fmt: skip
    phase_header = ["friction", "n", "degrees of freedom", *PHASES, "one Krylov iteration"]
    phase_text = common.table(path, phase_header, phases)
    text = common.table(path, header, rows)
    with open(path, "w") as file:
        file.write(f"""## Cost over the size of the model

`contrib/studies/scaling/size.py` on {hertz_case.machine()}, one process; {kept.dates()}. Case hertz (`hertz_case.py`),
Q1, one increment, one run each: other load on the machine changes CPU by 10 to 25 %. Degrees of freedom: displacements.
*Bytes* are the peak resident memory with the code of all libraries (some 145 MiB), *private* its anonymous part (heap),
sampled every 10 ms. Condensed: GMRES, with multigrid on what is left when multipliers are eliminated; block: GMRES on
all unknowns; direct: MUMPS.

{text}
CPU of the phases of the condensed solver's runs, in microseconds per degree of freedom:

{phase_text}
![CPU and iterations over size](size.png)
""")
    plot([r for r in found if r["converged"]])


def plot(found):
    common.figure()  # chooses how to draw
    import matplotlib.pyplot as plt

    figure, (left, right) = plt.subplots(1, 2, figsize=(9, 3.6), layout="constrained")
    for solver, colour in zip(SIZES, ("C0", "C1", "C2")):
        for mu, style in zip(FRICTION, ("o-", "s--")):
            chosen = [r for r in found if r["solver"] == solver and r["friction"] == mu]
            if not chosen:
                continue
            x = [hertz_case.dofs(r["n"]) for r in chosen]
            label = f"{solver}, friction {mu:g}"
            cpu = [1e6 * r["cpu"] / n for r, n in zip(chosen, x)]
            left.loglog(x, cpu, style, color=colour, label=label, markersize=4)
            if solver != "direct":
                krylov = [r["Krylov"] / r["Newton"] for r in chosen]
                right.semilogx(x, krylov, style, color=colour, label=label, markersize=4)
    left.set_ylabel("CPU per degree of freedom [us]")
    right.set_ylabel("Krylov per Newton iteration")
    right.set_ylim(bottom=0)
    left.legend(fontsize=8)
    for axes in (left, right):
        axes.set_xlabel("degrees of freedom")
        axes.grid(True, which="major", alpha=0.3)
    figure.savefig(os.path.join(hertz_case.HERE, "size.png"), dpi=120)


if __name__ == "__main__":
    main()
