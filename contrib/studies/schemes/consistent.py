"""The paper's own integrals: consistent weights with several rules and both status tests through the studies of the schemes.

Writes consistent.md with the parts that have been run. With names of parts (patch, rings, hertz, ...) it runs those alone and keeps the
others' results, which are in consistent.json in the scratch folder; with --report it only writes the texts again.
"""

import json
import os
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path[:0] = [HERE, os.path.dirname(HERE)]
import cattaneo_mindlin  # noqa: E402
import common  # noqa: E402
import hertz  # noqa: E402
import manufactured  # noqa: E402
import patch  # noqa: E402
import rings  # noqa: E402
import unsticking  # noqa: E402

BESIDE = ["nodal", "averaged, segment"]  # of the other schemes


def schemes(degree, beside=BESIDE):
    """A rule needs more points than the degree."""
    return beside + [name for name in common.CONSISTENT if degree == 1 or not name.endswith("Gauss 2")]


def run_patch():
    found = []
    for degree in (1, 2):
        for scheme in schemes(degree):
            errors = [
                patch.errors(degree, pair, slave, scheme) for pair in patch.PAIRS for slave in ("upper", "lower")
            ]
            done = [error for error in errors if error is not None]
            found.append([
                degree, scheme, len(errors) - len(done), max(e[0] for e in done), max(e[1] for e in done)
            ] if done else [degree, scheme, len(errors), None, None])  # fmt: skip
    return found


RINGS = ((1, "faceted"), (1, "smoothed"), (2, "faceted"))
LEVELS = (0, 1, 2, 3)


def run_rings():
    found = []
    for load in (1.0, 0.01):
        for degree, surface in RINGS:
            for scheme in schemes(degree):
                results = []
                for level in LEVELS:
                    sets = {
                        "Discretization/Degree": degree,
                        "Boundary condition 4/Value": rings.TRACTION.format(load=load),
                    }
                    keys = {**common.keys_of(scheme), "Surface": surface}
                    run = common.run(rings.case("non-matching", level), "rings", sets, keys)
                    results.append(rings.evaluate(run, load))
                found.append([load, degree, surface, scheme, results])
    return found


HERTZ = {(1, "faceted"): (5, 7, 10, 14), (2, "curved"): (2.5, 3.5, 5)}


def run_hertz():
    found = {}
    for family, sizes in HERTZ.items():
        for n in sizes:
            for scheme in schemes(family[0]):
                hertz.solve(found, family, n, scheme, "hertz_consistent.json")
    return [
        [*key, value and [value["profile"], value["inside"], value["newton"], value["again"]]] for key, value in found.items()
    ]


def run_cattaneo_mindlin():
    found = []
    for degree, n in ((1, 3), (1, 4), (1, 5), (1, 6), (2, 2.5), (2, 3)):
        for scheme in schemes(degree):
            row, values, _ = cattaneo_mindlin.line(degree, n, 0.0, scheme)
            found.append([degree, n, scheme, row[-1], values])
    return found


def run_manufactured():
    found = []
    for degree, solution, surface, levels in (
        (1, manufactured.Solution("v4", manufactured.U4), "smoothed", (2, 4, 8)),
        (2, manufactured.Solution("cubic", manufactured.U4_CUBIC), "faceted", (2, 4)),
    ):
        for scheme in schemes(degree):
            row, (_, error_u, error_p) = manufactured.series(solution, degree, levels, scheme, surface, "matched")
            found.append([degree, scheme, list(error_u), list(error_p), row[5], row[7], row[8]])
    return found


def run_unsticking():
    kinds = {
        **{name: common.keys_of(name) for name in schemes(1)},
        "points, Gauss 2": unsticking.KINDS["Gauss 2"],
        "points, Simpson": unsticking.KINDS["Simpson 3"],
    }
    return [[case, kind, *unsticking.measure(case, keys, kind)] for case in unsticking.CASES for kind, keys in kinds.items()]


PARTS = ("pairing", "contact assembly", "linear solver")


def run_cost():
    """Alternating runs; all with the block solver, which consistent weights need."""
    best = {}
    for n, repetitions in ((7, 3), (14, 2)):
        prm = hertz.case(n, 1)
        for _ in range(repetitions):
            for scheme in schemes(1):
                run = common.run(prm, "cost", {"Linear solver/Type": "block"}, common.keys_of(scheme))
                if not run.converged:
                    continue
                timing = common.timing(run)
                newton = int(run.contact[-1]["Newton iterations"])
                new = [newton, run.cpu] + [timing[part] for part in PARTS]
                old = best.get((n, scheme))
                best[n, scheme] = new if old is None else [newton] + [min(pair) for pair in zip(old[1:], new[1:])]
    return [[*key, *value] for key, value in best.items()]


RUNS = {name[4:]: run for name, run in globals().items() if name.startswith("run_")}


def percent(value):
    return "no solution" if value is None else f"{100 * value:.2g} %" if value < 10 else f"{100 * value:.0e} %"


def report_patch(found):
    rows = [[f"Q{d}", scheme, f"{percent(p)}", f"{percent(u)}", failed or ""] for d, scheme, failed, p, u in found]
    return ["cells", "weights", "largest error of p", "of u on top", "of 6 without solution"], rows


def report_rings(found):
    rows = []
    for load, degree, surface, scheme, results in found:
        errors = [(1 / (6 * 2**level), r[2]) for level, r in zip(LEVELS, results) if r][-3:]
        order = "{:.2f} ± {:.2f}".format(*common.fitted_order(*zip(*errors))) if len(errors) == 3 else "-"
        cells = ["no solution" if r is None else f"{r[0]}, {percent(r[2])}" for r in results]
        rows.append([f"Q{degree} {surface if degree == 1 else 'curved'}", f"{load:g}", scheme, *cells, order])
    return ["cells", "load", "weights"] + [f"{6 * 2**level} faces" for level in LEVELS] + ["order"], rows


def report_hertz(found):
    rows = []
    for family, sizes in HERTZ.items():
        for scheme in schemes(family[0]):
            results = [next(v[4] for v in found if (v[0], v[1], v[2], v[3]) == (*family, n, scheme)) for n in sizes]
            cells = [
                "no solution" if r is None else f"{percent(r[0])}, {r[2]}" + (" *" if r[3] else "") for r in results
            ]
            done = [(1 / n, r[0]) for n, r in zip(sizes, results) if r]
            order = "{:.2f} ± {:.2f}".format(*common.fitted_order(*zip(*done))) if len(done) > 2 else "-"
            rows.append([f"Q{family[0]}", scheme, *cells, *[""] * (4 - len(cells)), order])
    return ["cells", "weights", "coarsest", "", "", "finest", "order"], rows


def report_cattaneo_mindlin(found):
    rows = []
    for degree, n, scheme, notes, values in found:
        numbers = [""] * 4
        if values:
            numbers = [f"{values['stick'] / values['c'] - 1:+.1%}", percent(values["pressure"]), percent(values["shear"])]
            numbers += [f"{values['Newton']:.0f}"]
        rows.append([f"Q{degree}", f"{n:g}", scheme, *numbers, notes])
    return ["cells", "n", "weights", "stick radius", "L2 error of p", "of q", "Newton", ""], rows


def report_manufactured(found):
    rows = [
        [f"Q{d}", scheme, ", ".join(f"{e:.2e}" for e in u), order_u, ", ".join(f"{e:.2e}" for e in p), order_p, note]
        for d, scheme, u, p, order_u, order_p, note in found
    ]
    return ["cells", "weights", "L2(u)", "order", "L2(λ̄)", "order", ""], rows


def report_unsticking(found):
    return ["case", "weights", *unsticking.HEADER], found


def report_cost(found):
    rows = []
    for n, scheme, newton, cpu, *parts in found:
        nodal = next(v for v in found if v[0] == n and v[1] == "nodal")
        per = [part / newton for part in (cpu, *parts)]
        base = [part / nodal[2] for part in nodal[3:]]
        rows.append([
            n, scheme, newton, f"{cpu:.2f}", f"{per[0] / base[0]:.2f}", f"{1e3 * per[1]:.1f}", f"{1e3 * per[2]:.1f}",
            f"{100 * (per[1] + per[2]) / per[0]:.1f} %", f"{per[3] / base[3]:.2f}",
        ])  # fmt: skip
    return [
        "faces per radius", "weights", "Newton", "CPU s", "per Newton iteration / nodal", "pairing ms", "contact assembly ms",
        "share of both", "linear solver / nodal",
    ], rows  # fmt: skip


def merged(header, rows):
    """Rows that differ in the name of the weights alone, and not in the columns before it, become one."""
    column, found = header.index("weights"), {}
    for row in rows:
        names = found.setdefault(tuple(map(str, row[:column] + row[column + 1 :])), (row, []))[1]
        names.append(row[column])
    return [
        row[:column] + ["; ".join(names).replace("; consistent, ", ", ").replace("nodal, ", "nodal; consistent, ")] + row[column + 1 :]
        for row, names in found.values()
    ]


def main(names=()):
    path = os.path.join(common.SCRATCH, "consistent.json")
    found = {}
    wanted = [name for name in names if name in RUNS]
    if (wanted or "--report" in names) and os.path.exists(path):
        with open(path) as file:
            found = json.load(file)
    for name in [] if "--report" in names else wanted or RUNS:
        found[name] = RUNS[name]()
        with open(path, "w") as file:
            json.dump(found, file)
    with open(os.path.join(HERE, "consistent.md"), "w") as file:
        file.write(INTRODUCTION)
        for name, title in TITLES.items():
            if name in found:
                part = os.path.join(common.SCRATCH, f"consistent_{name}.md")
                header, rows = globals()["report_" + name](found[name])
                file.write(f"\n{title}:\n\n" + common.table(part, header, merged(header, rows)))


INTRODUCTION = """## The paper's own integrals: consistent weights

Equations (34) to (59) of the paper integrate products of shape functions, `Weights = consistent`, with statuses at the nodes. Here are the
studies above with several rules for that, with the status test on the mean pressure of a node (the default) and on its multiplier (test
of the node), beside nodal quadrature and the averaged scheme. Rows that agree in all digits are one.

**Do statuses at the nodes need the paper's integrals, and what does a richer quadrature cost?** With gaps and statuses at the nodes, displacements
see multipliers as nodal forces $p=M\\lambda$ alone, and the laws of contact and friction are asked of these forces: a node that is closed has no gap, one
that is open has no force, and Coulomb's cone bounds the tangential part of the force by its normal part. Which matrix $M$ stands between force and multiplier is then a
matter of names. Every rule that integrates $M$, from Gauss 2 to Newton-Cotes 4, and nodal quadrature, which makes it diagonal, have the same
displacements, mean pressures and statuses in the end: in the tables they differ in no digit but where the area of curved faces of degree 2
is integrated by different rules (10 for 9.9 %); without friction they take the same iterations but for one or two, too. So a richer quadrature gains nothing in accuracy or in order.
It costs, and not by its points: $M$ couples multipliers, so that they are not eliminated node by node (the condensed solver would have to factorise
it to find what nodal quadrature gives it), and with friction the statuses of neighbours pull at each other on the way: the plate under load changes 140 statuses for 84, the plate
that is unloaded 750 to 1058 for 382, the pulled block 2689 to 2775 for 517, with cycles of up to 12 where nodal quadrature has none, and 1.3 to 3.0 times the Newton iterations (1.1 to 3.2 times in Cattaneo and Mindlin's problem). The pulled
block takes 3.5 to 4.0 times the CPU (85 to 98 s for 25 s; one run each, on a busy machine), with little between the rules. **The overcost of the richer quadrature itself** is small:
without friction a Newton iteration with consistent weights takes 1.27 to 1.30 times one with nodal quadrature (Hertz, 14 faces, block solver for all, least of two or three runs, which repeat
within some 10 %), most of it in the solver (1.33 to 1.38 times), and between the rules with the fewest and the most points there are 3 % of that, 3 ms of 300 in the assembly of contact. What $M$ does change is the multiplier itself:
$\\lambda=M^{-1}p$ oscillates where the pressure ends, and a status that is tested on it contradicts itself there; faceted rings from 24 faces on, all Hertz meshes of degree
1 and two of three of degree 2 then have no solution. Statuses at the nodes are worth having with nodal quadrature: they change least of all there, less than statuses at
integration points (188 to 460 and 746 to 1384 in the two plates, of two to four times as many). Gains are to be had where gaps are averaged, not where forces are
integrated: the averaged scheme passes the patch test and has the higher orders, with as many changes as nodal quadrature and about its cost.
"""
TITLES = {
    "patch": "Patch test, largest errors over the meshes and slave sides",
    "rings": "Rings that do not match: open nodes, which contradict, and error of the pressure",
    "hertz": "Hertz: error of the profile, Newton iterations (* with augmentation 0.1)",
    "cattaneo_mindlin": "Cattaneo and Mindlin",
    "manufactured": "Manufactured solution",
    "unsticking": "Unsticking: passes of the loops, Newton iterations, statuses that changed, and what there is in the end",
    "cost": "Cost, all with the block solver, which consistent weights need; least of alternating runs",
}

if __name__ == "__main__":
    main(sys.argv[1:])
