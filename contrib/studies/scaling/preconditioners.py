#!/usr/bin/python3
"""nodus's own multigrid, ML and MueLu as preconditioners of the displacements: CPU, memory, iterations, answers.

    preconditioners.py [CASE]... [--only PRECONDITIONER] [--rounds N] [--cost | --answers | --write]

CASE: part of the name of a row, e.g. "hertz 24" or ironing; without one all. The preconditioners take turns, `rounds`
times (3 by default, 1 at n = 32); the least CPU counts. --cost runs with the tolerances of the case, --answers with tight
ones, to compare forces and pressures; without either both are done. --write only makes the page.

Writes preconditioners.md; runs that are not done keep their results of preconditioners.json. Rows are printed as they
come.
"""

import argparse
import os
import re

import hertz_case
import solvers
from hertz_case import common

PRECONDITIONERS = ("nodus", "ML", "MueLu")
# name of the row -> (hertz: n and friction, or a case of prm/; solver)
CASES = {f"hertz {n}, friction {mu:g}": ((n, mu), "condensed") for n in (12, 24, 32) for mu in (0.0, 0.3)}
CASES.update({case: (case, "condensed") for case in ("ironing", "metal_blank", "rubber_block")})
CASES.update({"hertz 24, friction 0.3, block": ((24, 0.3), "block")})
# No direct solver steps in, and each goes on until it gets there.
EACH_BY_ITSELF = {"Strategy/Without": "direct solver", "Linear solver/Maximum iterations": 3000}
TIGHT = {**solvers.TIGHT, "Newton/Force tolerance": "1e-11", "Newton/Contact tolerance": "1e-11"}
# Forces that are small beside stiffness times displacement: residuals do not get there.
ATTAINABLE = {"rubber_block": {"Linear solver/Tolerance": "1e-11", "Newton/Force tolerance": "1e-10"}}


def run(row, preconditioner, name, sets):
    """What hertz_case.measured() says of a run, its profile and rows of contact.csv."""
    case, solver = CASES[row]
    folder = os.path.join(common.SCRATCH, "preconditioners", re.sub(r"[^\w.]+", "_", f"{row} {preconditioner} {name}"))
    os.makedirs(folder, exist_ok=True)
    keys = {
        "Linear solver/Type": solver,
        "Linear solver/Preconditioner": preconditioner,
        "Output/Results folder": folder,
        "Output/Write VTU": "false",
        **EACH_BY_ITSELF,
        **sets,
    }
    if isinstance(case, tuple):
        prm = hertz_case.write(case[0], os.path.join(common.SCRATCH, "hertz"), case[1])
    else:
        prm = os.path.join(common.ROOT, "prm", case + ".prm")
    command = [common.NODUS, prm, "--profile"] + [x for key in keys.items() for x in ("--set", "{}={}".format(*key))]
    result = hertz_case.measured(command, os.path.join(folder, "log"), environment=hertz_case.environment())
    if result["exit"] != 0:
        raise SystemExit(f"{row}, {preconditioner}: exit code {result['exit']}, see {folder}/log")
    found = common.nodus.Results(folder)
    return result, found.profile, found.contact


def cost(row, preconditioner, kept):
    """One run; the least CPU of all rounds of this call stays."""
    measured, profile, contact = run(row, preconditioner, "cost", {})
    phases = {phase["name"]: phase for phase in profile["phases"]}
    result = {
        "cpu": measured["cpu"],
        "peak": measured["peak MiB"],
        "Newton": profile["newton_iterations"],
        "Krylov": profile["krylov_iterations"],
        "set-up": phases["solver set-up"]["cpu_seconds"],
        "iterations": phases["solver iterations"]["cpu_seconds"],
        "fallbacks": sum(r["fallbacks"] for r in {r["increment"]: r for r in contact}.values()),
    }
    best = kept.get(row, preconditioner)
    result["rounds"] = best["rounds"] + 1 if best else 1
    result["most cpu"] = max(best["most cpu"], result["cpu"]) if best else result["cpu"]
    if best and best["cpu"] <= result["cpu"]:
        result = {**best, "rounds": result["rounds"], "most cpu": result["most cpu"]}
    kept.set(row, preconditioner, result)
    print(f"  {row}, {preconditioner}: {measured['cpu']:.2f} s, {measured['peak MiB']:.0f} MiB, "
          f"{profile['newton_iterations']} Newton, {profile['krylov_iterations']} Krylov", flush=True)  # fmt: skip


class Costs:
    """Results of this call by row and preconditioner; kept for the next ones when they are complete."""

    def __init__(self):
        self.kept, self.now = hertz_case.Kept("preconditioners"), {}

    def get(self, row, preconditioner):
        return self.now.get((row, preconditioner))

    def set(self, row, preconditioner, result):
        self.now[row, preconditioner] = result
        self.kept[f"{row}: {preconditioner}"] = result


def answers(row, chosen, kept):
    """The largest difference to nodus's own multigrid, of forces alone and of everything in contact.csv."""
    reference, forces = None, {"force": solvers.GROUPS["force"]}
    for preconditioner in PRECONDITIONERS:
        if preconditioner not in chosen and preconditioner != "nodus":
            continue
        sets = {**solvers.MODES, **TIGHT, **ATTAINABLE.get(row, {})}
        _, profile, contact = run(row, preconditioner, "answers", sets)
        if reference is None:
            reference = contact
            continue
        everything, groups = solvers.difference(contact, reference), solvers.GROUPS
        solvers.GROUPS = forces
        force, solvers.GROUPS = solvers.difference(contact, reference), groups
        same = all(a[c] == b[c] for a, b in solvers.common_times(contact, reference) for c in solvers.STATUSES)
        kept[f"{row}: {preconditioner}, answers"] = {
            "force": force, "all": everything, "same": same, "Newton": profile["newton_iterations"]}  # fmt: skip
        print(f"  {row}, {preconditioner}: forces differ by {force:.0e}, all by {everything:.0e}, "
              f"statuses {'the same' if same else 'others'}", flush=True)  # fmt: skip


def tell(difference):
    """contact.csv has twelve digits."""
    return f"{difference:.0e}" if difference > 1e-12 else "< 1e-12"


def page(kept):
    header = ["case", "preconditioner", "CPU s", "/ nodus", "set-up s", "iterations s", "peak MiB", "Newton", "Krylov",
              "forces differ by", "all differs by", "same statuses"]  # fmt: skip
    rows = []
    for row in CASES:
        own = kept.get(f"{row}: nodus")
        for preconditioner in PRECONDITIONERS:
            r, a = kept.get(f"{row}: {preconditioner}"), kept.get(f"{row}: {preconditioner}, answers")
            if not r or not own:
                continue
            rows.append([
                row, preconditioner, f"{r['cpu']:.1f}", f"{r['cpu'] / own['cpu']:.2f}", f"{r['set-up']:.1f}",
                f"{r['iterations']:.1f}", f"{r['peak']:.0f}", r["Newton"], r["Krylov"],
                *((tell(a["force"]), tell(a["all"]), "yes" if a["same"] else "no") if a else ("", "", "")),
            ])  # fmt: skip
    path = os.path.join(hertz_case.HERE, "preconditioners.md")
    with open(path) as file:
        text = file.read()
    table = common.table(path, header, rows)
    rounds = sorted({kept.get(f"{row}: {p}")["rounds"] for row in CASES for p in PRECONDITIONERS if kept.get(f"{row}: {p}")})
    made = f"\nOn {hertz_case.machine()}; {kept.dates()}; rounds: {', '.join(map(str, rounds))}.\n\n{table}\n"
    begin, end = "<!-- table: preconditioners.py -->\n", "<!-- end of the table -->\n"
    with open(path, "w") as file:
        file.write(text[: text.index(begin) + len(begin)] + made + text[text.index(end) :])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("cases", nargs="*")
    parser.add_argument("--only", choices=PRECONDITIONERS, action="append")
    parser.add_argument("--rounds", type=int)
    what = parser.add_mutually_exclusive_group()
    for name in ("cost", "answers", "write"):
        what.add_argument("--" + name, action="store_true")
    options = parser.parse_args()
    chosen = options.only or PRECONDITIONERS
    costs = Costs()
    for row in CASES:
        if options.write or options.cases and not any(part in row for part in options.cases):
            continue
        for _ in range(0 if options.answers else options.rounds or (1 if "32" in row else 3)):
            for preconditioner in chosen:
                cost(row, preconditioner, costs)
        if not options.cost:
            answers(row, chosen, costs.kept)
    page(costs.kept)


if __name__ == "__main__":
    main()
