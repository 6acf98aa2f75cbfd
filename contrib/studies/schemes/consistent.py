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


def main():
    path = os.path.join(common.SCRATCH, "consistent.json")
    found = {}
    wanted = [name for name in sys.argv[1:] if name in RUNS]
    if (wanted or "--report" in sys.argv) and os.path.exists(path):
        with open(path) as file:
            found = json.load(file)
    for name in [] if "--report" in sys.argv else wanted or RUNS:
        found[name] = RUNS[name]()
        with open(path, "w") as file:
            json.dump(found, file)
    with open(os.path.join(HERE, "consistent.md"), "w") as file:
        file.write(INTRODUCTION)
        for name, title in TITLES.items():
            if name in found:
                part = os.path.join(common.SCRATCH, f"consistent_{name}.md")
                file.write(f"\n{title}:\n\n" + common.table(part, *globals()["report_" + name](found[name])))


INTRODUCTION = """## The paper's own integrals: consistent weights

Equations (34) to (59) of the paper integrate products of shape functions, `Weights = consistent`, with statuses at the nodes. Here are the
studies above with several rules for that, with the status test on the mean pressure of a node (the default) and on its multiplier (test
of the node), beside nodal quadrature and the averaged scheme.
"""
TITLES = {
    "patch": "Patch test, largest errors over the meshes and slave sides",
    "rings": "Rings that do not match: open nodes, which contradict, and error of the pressure",
    "hertz": "Hertz: error of the profile, Newton iterations (* with augmentation 0.1)",
    "cattaneo_mindlin": "Cattaneo and Mindlin",
    "manufactured": "Manufactured solution",
    "unsticking": "Unsticking",
    "cost": "Cost, all with the block solver, which consistent weights need; least of alternating runs",
}

if __name__ == "__main__":
    main()
