#!/usr/bin/python3
"""What `Type = automatic` costs beside each linear solver by itself: cases of prm/ and of the gallery with their own settings, and
the comparison cases `hertz n` and `ironing n` at several sizes.

    automatic.py [CASE ...]    (default: all)

Writes automatic.md; cases that are not named keep their rows of automatic.json. A case is the name of a file of prm/ or of prm/gallery
(`gallery/ironing`), `hertz 24` or `ironing 6`: prm/ironing.prm with 14 n x 2.5 n x n / 2 cells in the slab and 9 n around the ring.
"""

import glob
import json
import os
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.dirname(HERE))
import common  # noqa: E402
import hertz_case  # noqa: E402

SOLVERS = ("automatic", "condensed", "block", "direct")
PRM = os.path.join(common.ROOT, "prm")
SIZES = [f"hertz {n}" for n in (6, 8, 12, 16, 24, 32)] + [f"ironing {n}" for n in (2, 4, 6, 8)]
# Runs shorter than this take turns twice, and the smaller number counts: the machine's own differences are seconds' tenths.
SHORT = 20.0
# A solver by itself that needs so many times the CPU of the fastest so far is stopped there.
HOPELESS = 3.0

CONCLUSION = """Twenty-seven of these 34 cases are within a tenth of the fastest; the others lose 0.1 to 1.4 s. CPU seconds of the whole run, the smaller of two
below 20 s, two cases at a time; differences of a tenth are those of the machine. *>*: stopped there, at three times the fastest. Not run with this program: `hertz 32`, `ironing 8` and
the larger cases of the gallery; `ironing 6` was broken off after one turn (18.3 s, condensed 16.4, block 21.1: 1.12).

Up to 1500 displacements `automatic` is the direct solver, beyond 150 000 the condensed one (the block solver where integration points or consistent weights
ask for it). Between them the cost of a system is counted: 0.3 us per entry, half of it for the symbolic analysis, and 1/12000 us per operation for the direct solver, for
the iterative ones 0.15 us per 3x3 block of the stiffness, 0.9 us where the hierarchy is set up and 0.08 us per iteration. These are the counts of a machine half as fast as that of the table;
they are no times, so that a run can be repeated to the last digit. The iterative solver begins, and the analysis of the direct one is made once a tenth of what was spent pays for it and the direct
one could be the cheaper of the two: it takes 0.3 us per entry at least.
Before, the direct one solved the first system: `hertz 12` took 1.65 s for 1.00 of the condensed one.

What `automatic` pays for: that analysis, trials of the solver that is not in use, and, up to 20 000 displacements, in each increment of the iterative solver one
more system, which tells whether the state is stable (theory, section 21.4). It cannot know that another solver finds a shorter way through the statuses (`s_seal`: 111 Newton iterations
with block, 160 to 176 with the others).
"""


def case_of(name):
    """Path and keys."""
    kind, _, n = name.partition(" ")
    if kind == "hertz" and n:
        return hertz_case.write(int(n), os.path.join(common.SCRATCH, "automatic")), {}
    path = os.path.join(PRM, kind + ".prm")
    if kind == "ironing" and n:
        n = int(n)
        return path, {
            "Body 1/Generator arguments": f"{14 * n},{5 * n // 2},{n // 2} : -1.5,-1.5,0 : 5.5,0,0.2 : true",
            "Body 2/Generator arguments": f"0.2 : 0.6 : 1 : {9 * n // 2} : {max(1, n // 4)}",
        }
    return path, {}


def row_of(name):
    path, keys = case_of(name)
    runs = {}
    for turn in range(2):
        for solver in SOLVERS:
            fastest = min([runs[s].cpu for s in runs if runs[s].converged], default=float("inf"))
            if turn and (solver not in runs or not runs[solver].converged or fastest > SHORT):
                continue
            folder = os.path.join(common.SCRATCH, f"automatic_{name}_{solver}".replace("/", "_").replace(" ", "_"))
            limit = None if solver == "automatic" else f"prlimit --cpu={int(HOPELESS * fastest) + 2}"
            sets = {**keys, "Linear solver/Type": solver, "Output/Results folder": folder}
            run = common.program().run(path, sets=sets, profile=True, check=False, launcher=limit)
            print(f"  {name}, {solver}: exit {run.code}, {run.cpu:.2f} CPU s", flush=True)
            if solver not in runs or run.converged and run.cpu < runs[solver].cpu:
                runs[solver] = run
    seconds = {s: runs[s].cpu for s in runs if runs[s].converged}
    fastest = min(seconds[s] for s in SOLVERS[1:] if s in seconds)
    shown = [f"{seconds[s]:.2f}" if s in seconds else f"> {runs[s].cpu:.0f}" if runs[s].code < 0 or runs[s].code > 128 else "stops" for s in SOLVERS]
    iterations = [str(runs[s].profile["newton_iterations"]) if s in seconds else "-" for s in SOLVERS]
    return [name, str(runs["automatic"].profile["displacement_degrees_of_freedom"]), *shown, f"{seconds['automatic'] / fastest:.2f}", " / ".join(iterations)]


def main():
    store = os.path.join(HERE, "automatic.json")
    known = json.load(open(store)) if os.path.exists(store) else {}
    files = sorted(os.path.relpath(f, PRM)[:-4] for f in glob.glob(os.path.join(PRM, "*.prm")) + glob.glob(os.path.join(PRM, "gallery", "*.prm")))
    cases = files + SIZES
    for case in sys.argv[1:] or cases:
        known[case] = row_of(case)
        with open(store, "w") as file:
            json.dump(known, file, indent=0)
    path = os.path.join(HERE, "automatic.md")
    header = ["case", "displacements", *(f"{solver}, CPU s" for solver in SOLVERS), "automatic over the fastest", "Newton iterations"]
    text = common.table(path, header, [known[case] for case in cases if case in known])
    with open(path, "w") as file:
        file.write(f"# What `Type = automatic` costs beside each linear solver by itself\n\nMade by `contrib/studies/scaling/automatic.py`.\n\n{text}\n{CONCLUSION}")


if __name__ == "__main__":
    main()
