#!/usr/bin/python3
"""What `Type = automatic` costs beside each linear solver by itself, on every case of prm/ with its own settings.

Writes automatic.md. Cases may be named on the command line: the others keep their earlier results; without names all run.
"""

import json
import os
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.dirname(HERE))
import common  # noqa: E402

SOLVERS = ("automatic", "direct", "condensed", "block")

CONCLUSION = """Fourteen of these cases are within a tenth of the fastest, the others lose 0.1 to 1.3 s. One run each, CPU seconds of
the whole run: differences of a tenth are those of the machine. Up to 1500 displacements `automatic` is the direct solver, beyond 20000 the condensed one (the block solver where integration points or consistent weights
ask for it). Between them the cost of a system is counted: 0.2 us per entry and 1/12000 us per operation for the direct solver, for
the iterative ones 0.15 us per 3x3 block of the stiffness, 0.9 us where the hierarchy is set up and 0.08 us per iteration. These
numbers come from systems of first_case, hertz, cantilevers, ironing and metal_blank, which they reproduce to a fifth but
for hierarchies of small models (3 to 4 us per block). They are no times, so that a run can be repeated to the last digit.

What `automatic` pays for: one system of the direct solver, trials of the one that is not in use, and in each increment of the
iterative solver one more system, which tells whether the state is stable (theory, section 21.4).
"""


def row_of(case):
    seconds, iterations = {}, {}
    for solver in SOLVERS:
        prm = os.path.join(common.ROOT, "prm", case + ".prm")
        sets = {"Linear solver/Type": solver, "Output/Results folder": os.path.join(common.SCRATCH, f"automatic_{case}_{solver}")}
        run = common.program().run(prm, 1, sets=sets, profile=True, check=False)
        print(f"  {case}, {solver}: exit {run.code}, {run.cpu:.1f} CPU s", flush=True)
        if run.converged:
            seconds[solver] = run.cpu
            counts = {row["increment"]: row for row in run.contact}.values()
            iterations[solver] = int(sum(row["Newton iterations"] for row in counts))
    fastest = min(seconds[solver] for solver in SOLVERS[1:] if solver in seconds)
    return [case, *(f"{seconds[s]:.1f}" if s in seconds else "stops" for s in SOLVERS), f"{seconds['automatic'] / fastest:.2f}",
            " / ".join(str(iterations.get(s, "-")) for s in SOLVERS)]  # fmt: skip


def main():
    store = os.path.join(HERE, "automatic.json")
    known = json.load(open(store)) if os.path.exists(store) else {}
    cases = sorted(name[:-4] for name in os.listdir(os.path.join(common.ROOT, "prm")) if name.endswith(".prm"))
    for case in sys.argv[1:] or cases:
        known[case] = row_of(case)
        with open(store, "w") as file:
            json.dump(known, file, indent=0)
    path = os.path.join(HERE, "automatic.md")
    header = ["case", *(f"{solver}, CPU s" for solver in SOLVERS), "automatic over the fastest", "Newton iterations"]
    text = common.table(path, header, [known[case] for case in cases if case in known])
    with open(path, "w") as file:
        file.write(f"# {__doc__.splitlines()[0]}\n\nMade by `contrib/studies/scaling/automatic.py`.\n\n{text}\n{CONCLUSION}")


if __name__ == "__main__":
    main()
