#!/usr/bin/python3
"""nodus beside CalculiX, GetFEM and Kratos on cases of the gallery, prm/ironing.prm and the comparison case hertz: the same mesh, elements
and law, one process and one thread each.

    peers.py [--time-limit S] [--programs PROGRAM,...] [--report] [CASE ...]    (default: all)

Writes <case>.csv and ../../doc/gallery/<case>_peers.png (forces over the time) and peers.md; cases that are not named, and programs that are
not, keep their rows of peers.json. Needs ccx (Debian: calculix-ccx), python3-getfem and, as KRATOS_PYTHON, a Python that has Kratos
(kratos_peer.py). NODUS names the program, CCX that of CalculiX.
"""

import argparse
import csv
import json
import os
import sys

import numpy as np

import calculix
import getfem_peer
import kratos_peer
from plain_case import HERE, PlainCase, Unsupported, common

import hertz_case  # of the folder that plain_case adds

PRM = os.path.join(common.ROOT, "prm")
MERGED = {f"{loop} loop/Mode": "newton" for loop in ("Geometry", "Threshold", "Status")}


def _cells(bodies):
    """Full cells of degree 1 and the law that the others have, too."""
    sets = {"Discretization/Degree": "1"}
    for body in range(1, bodies + 1):
        sets[f"Body {body}/Volumetric treatment"] = "standard"
        sets[f"Body {body}/Material/Law"] = "Mooney-Rivlin"
    return sets


def _ring(n):
    """prm/ironing.prm, which has n = 4."""
    return {**_cells(2), "Body 1/Generator arguments": f"{14 * n},{5 * n // 2},1 : -1.5,-1.5,0 : 5.5,0,0.2 : true",
            "Body 2/Generator arguments": f"0.2 : 0.6 : 1 : {9 * n // 2} : 1"}  # fmt: skip


# Until the upper tube touches itself: its lower half on the lower tube.
TUBES = {"Contact pair 1/Self contact": "false", "Contact pair 1/Slave body": "upper", "Contact pair 1/Master body": "lower",
         "Contact pair 1/Slave where": "y<24 && (y-24)^2+z^2>11.9^2", "Contact pair 1/Master where": "x^2+y^2>11.9^2",
         "Load stepping/Interval ends": "0.75", "Load stepping/Increments": "30"}  # fmt: skip
ONE = {"Load stepping/Interval ends": "1", "Load stepping/Increments": "1"}
# File in prm/ or number of cells of hertz, keys, condition whose forces are compared, or point whose displacements are; contact stiffness of CalculiX in the
# soft body's modulus over length: as a user, as an expert; how far GetFEM looks for the other surface: less than the thickness of a body.
CASES = {
    "hertz_12": (12, ONE, 4, (50, 1000), 0.2),
    "hertz_24": (24, ONE, 4, (50,), 0.2),
    "ironing_ring": ("ironing.prm", _ring(6), 4, (100, 1000), 0.15),
    "ironing_3d": ("gallery/ironing_3d.prm",
                   {**_cells(2), "Body 1/Generator arguments": "36, 8, 8 : 0,0,0 : 9,2,3 : true", "Load stepping/Increments": "10, 40"},
                   4, (100, 1000), 0.15),
    "ironing": ("gallery/ironing.prm", _cells(2), 4, (10, 100), 1.0),
    "double_arch": ("gallery/double_arch.prm", {}, (0, 10, 0), (1, 10), 4.0),
    "double_arch_0": ("gallery/double_arch.prm", {"Contact pair 1/Friction coefficient": "0"}, (0, 10, 0), (1, 10), 4.0),
    "press_fit": ("gallery/press_fit.prm", _cells(2), 2, (1, 10), 100.0),
    "crossed_tubes": ("gallery/crossed_tubes.prm", {**_cells(2), **TUBES}, 2, (1, 10), 0.6),
}  # fmt: skip
HEADER = ["case", "unknowns", "program", "to t =", "increments", "cut back", "Newton iterations", "CPU s", "/ nodus", "peak MiB",
          "largest difference of forces until there", "ripple", "penetration"]  # fmt: skip


# Times between which a force should be even.
EVEN = {"ironing_ring": (1.1, 1.9), "ironing_3d": (0.7, 1.4), "ironing": (1.2, 1.9), "press_fit": (1.7, 1.95)}


def run_nodus(name, case, path, sets, condition):
    run = common.program().run(path, sets={**MERGED, **sets, "Output/Results folder": os.path.join(common.SCRATCH, "peers", name)},
                               profile=True, check=False)  # fmt: skip
    if isinstance(condition, tuple):
        forces = displacements(run, condition)
    else:
        rows = run.reactions.where(condition=common.nodus.Case.read(path, program=common.program())[f"Boundary condition {condition}"]["Name"])
        forces = np.column_stack([rows[column] for column in ("time", "force x", "force y", "force z")])
    return {"finished": run.converged, "time": float(forces[-1, 0]), "increments": len(forces), "cpu": run.cpu, "memory": run.memory,
            "iterations": run.profile["newton_iterations"] if run.converged else None,
            "cut-backs": run.log.count("the increment is halved"), "forces": forces.tolist(),
            "displacements": case.displacements(run.bodies()) if run.converged else None}  # fmt: skip


def displacements(run, point):
    """Rows (time, x, y, z) of the node there."""
    found = []
    for time in run.times[1:]:
        mesh = run.bodies(time)
        found.append([time, *mesh.fields["displacement"][np.linalg.norm(mesh.reference - point, axis=1).argmin()]])
    return np.array(found)


def moved(case, condition, forces):
    """Columns of the components that a condition moves, since those that it only holds share their nodes with others; of those that a point moves in."""
    if case.probe:
        largest = np.abs(forces[:, 1:]).max(axis=0)
        return [c + 1 for c in np.flatnonzero(largest > 1e-3 * largest.max())]
    return [component + 1 for component, history in case.conditions()[condition][1] if history.any()]


def difference(forces, other, columns):
    """Largest distance of the forces at the times of the first that the others reach, over the largest force."""
    forces, other = np.array(forces), np.array(other)
    times = forces[forces[:, 0] <= other[-1, 0] * (1 + 1e-9)]
    between = np.column_stack([np.interp(times[:, 0], other[:, 0], other[:, c]) for c in columns])
    return np.linalg.norm(between - times[:, columns], axis=1).max() / np.linalg.norm(forces[:, columns], axis=1).max()


def ripple(forces, columns, begin, end):
    """Largest distance, peak to peak, of a component of the forces between two times from a cubic, over its mean; None where they do not get there."""
    forces = np.array(forces)
    if not len(forces) or forces[-1, 0] < end - 1e-9:
        return None
    rows = forces[(forces[:, 0] > begin - 1e-9) & (forces[:, 0] < end + 1e-9)]
    found = []
    for column in columns:
        rest = rows[:, column] - np.polyval(np.polyfit(rows[:, 0], rows[:, column], 3), rows[:, 0])
        found.append(np.ptp(rest) / abs(rows[:, column].mean()))
    return float(max(found))


def write_csv(name, found):
    """What was compared, of one program after the other."""
    what = f"Displacements of {CASES[name][2]}" if isinstance(CASES[name][2], tuple) else "Forces on the driven body"
    lines = [f"# {what} of {CASES[name][0]} by contrib/studies/peers/peers.py", "program,time,x,y,z"]
    for program, r in found.items():
        lines += [f'"{program}",' + ",".join(f"{value:.6g}" for value in row) for row in r["forces"]]
    with open(os.path.join(HERE, name + ".csv"), "w", encoding="utf-8") as file:
        file.write("\n".join(lines) + "\n")


def read_csv(name):
    """program -> rows of its forces, of earlier runs."""
    found, path = {}, os.path.join(HERE, name + ".csv")
    if os.path.exists(path):
        with open(path, encoding="utf-8") as file:
            for program, *values in list(csv.reader(file))[2:]:
                found.setdefault(program, []).append(list(map(float, values)))
    return found


def plot(name, found, columns, what):
    """Their components in these columns."""
    figure, _ = common.figure(5 * len(columns), 4)
    figure.clear()
    for axis, column in zip(figure.subplots(1, len(columns), squeeze=False)[0], columns):
        for (program, r), style in zip(found.items(), ("-", "o", "x", "+", "^", "v", "s")):
            forces = np.array(r["forces"])
            axis.plot(forces[:, 0], forces[:, column], style, ms=4, mfc="none", label=program)
        axis.set_xlabel("time")
        axis.set_ylabel(what + " " + "xyz"[column - 1])
    axis.legend(fontsize="small")
    figure.savefig(os.path.join(common.ROOT, "contrib", "doc", "gallery", name + "_peers.png"), dpi=100)


def peers(case, stiffnesses, release, folder, time_limit):
    """label -> a function that runs it."""
    soft = min(modulus for _, modulus, _ in case.laws().values())
    found = {
        f"CalculiX, contact stiffness {factor} E": lambda factor=factor: calculix.run(
            case, factor * soft, 0.1 * factor * soft, f"{folder}_ccx_{factor}", time_limit)
        for factor in stiffnesses
    }  # fmt: skip
    if all(linear for linear, _, _ in case.laws().values()):  # a large block, for which its iterative solver is made
        found["CalculiX, iterative"] = lambda: calculix.run(
            case, stiffnesses[0] * soft, 0.1 * stiffnesses[0] * soft, folder + "_ccx_iterative", time_limit, "ITERATIVE CHOLESKY")
    found["CalculiX mortar"] = lambda: calculix.run(case, None, None, folder + "_ccx_mortar", time_limit)
    found["GetFEM"] = lambda: getfem_peer.run(case, soft, release, folder + "_getfem", time_limit)
    found["Kratos direct"] = lambda: kratos_peer.run(case, "direct", folder + "_kratos", time_limit)
    found["Kratos AMG"] = lambda: kratos_peer.run(case, "AMG", folder + "_kratos_amg", time_limit)
    return found


def measure(name, programs, time_limit, before):
    """before: what earlier runs found, of which programs that are not asked for remain."""
    source, sets, condition, stiffnesses, release = CASES[name]
    path = os.path.join(PRM, source) if isinstance(source, str) else hertz_case.write(source, os.path.join(common.SCRATCH, "hertz"))
    folder = os.path.join(common.SCRATCH, "peers", name)
    case, forces = PlainCase(path, sets, folder, condition if isinstance(condition, tuple) else None), read_csv(name)
    found = {"nodus": run_nodus(name, case, path, sets, condition)}
    found["nodus"]["unknowns"] = case.n_unknowns
    for program, run in peers(case, stiffnesses, release, folder, time_limit).items():
        if not any(program.startswith(begin) for begin in programs):
            if program in before:
                found[program] = {**before[program], "forces": forces.get(program, [])}
            continue
        try:
            r = run()
        except Unsupported as why:
            print(f"  {name}, {program}: not with {why}", flush=True)
            continue
        found[program] = r
        r["forces"] = np.asarray(r["forces"].get(0 if case.probe else condition, [])).tolist()
        print(f"  {name}, {program}: to t = {r['time']:g}, {r['cpu']:.1f} CPU s", flush=True)
    ours = found["nodus"]["forces"]
    columns = moved(case, condition, np.array(ours))
    for program, r in found.items():
        if program != "nodus" and r["forces"] and r["forces"][-1][0] >= ours[0][0]:
            r["apart"] = difference(ours, r["forces"], columns)
        displacements = r.pop("displacements", None)
        if displacements is not None:
            r["penetration"] = float(case.penetration(np.array(displacements)))
        r["ripple"] = ripple(r["forces"], columns, *EVEN[name]) if name in EVEN else None
    write_csv(name, found)
    if len(ours) > 1:
        # a curve that is somewhere else altogether would flatten the others
        plot(name, {program: r for program, r in found.items() if r["forces"] and r.get("apart", 0) < 1}, columns, "displacement" if case.probe else "force")
    for r in found.values():
        del r["forces"]
    return found


def rows(kept):
    for name, found in kept.items():
        ours = found["nodus"]
        for program, r in found.items():
            end = "" if r["finished"] else ", out of time" if r.get("out of time") else ", stops"
            yield [name, ours["unknowns"], program, f"{r['time']:.4g}" + end, r["increments"], r["cut-backs"],
                   "" if r["iterations"] is None else r["iterations"], f"{r['cpu']:.1f}", f"{r['cpu'] / ours['cpu']:.2f}", f"{r['memory']:.0f}",
                   f"{100 * r['apart']:.2g} %" if "apart" in r else "", f"{100 * r['ripple']:.2g} %" if r.get("ripple") else "",
                   f"{r['penetration']:.2g}" if "penetration" in r else ""]  # fmt: skip


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("cases", nargs="*", metavar="CASE", help=", ".join(CASES))
    parser.add_argument("--time-limit", type=int, default=1800, help="CPU seconds of a run of the others")
    parser.add_argument("--programs", default="CalculiX,GetFEM,Kratos", help="beginnings of the others' names (default: %(default)s)")
    parser.add_argument("--report", action="store_true", help="only write the page again")
    options = parser.parse_args()
    kept, store = {}, os.path.join(HERE, "peers.json")
    if os.path.exists(store):
        with open(store, encoding="utf-8") as file:
            kept = json.load(file)
    for name in [] if options.report else options.cases or CASES:
        if name not in CASES:
            sys.exit(f"peers.py: there is no case {name}; there are {', '.join(CASES)}")
        kept[name] = measure(name, options.programs.split(","), options.time_limit, kept.get(name, {}))
        with open(store, "w", encoding="utf-8") as file:
            json.dump(kept, file, indent=1)
    page = os.path.join(HERE, "peers.md")
    text = common.table(page, HEADER, rows(kept))
    with open(page, "w", encoding="utf-8") as file:
        file.write(f"""# nodus, CalculiX, GetFEM and Kratos on the same meshes

`contrib/studies/peers/peers.py`: cases of [the gallery](../../doc/gallery.md), which shows their forces, `prm/ironing.prm` with n = 6 (*ironing_ring*: 84 x 15
cells in the slab) and the comparison case [hertz](../scaling/peers.md) with n = 12 and 24; the same mesh, full cells of degree 1 (C3D8; the double arch: degree 2, C3D20), the
neo-Hookean law that CalculiX has (hertz: linear elastic), one process and one thread each. nodus with its default settings.

- CalculiX with surface-to-surface contact of two stiffnesses, in Young's moduli of the softer body by length, sticking contact ten times softer, and with
  its mortar contact; its own tolerances and increments as long as those of nodus at most; SPOOLES, and for hertz its iterative solver with the softer contact.
- GetFEM with its contact of large sliding by ray tracing (Poulios and Renard), multipliers of the degree of the cells on the slave side, augmentation by Young's
  modulus of the softer body, increments of nodus, halved where Newton's method takes more than 30 iterations; tied surfaces by a penalty; MUMPS.
- Kratos with its mortar contact by augmented Lagrangian multipliers, whose penalty it chooses itself, residuals and corrections to 1e-6, increments of nodus,
  all of them cut in four where one fails; its sparse LU, and AMG with the settings of its contact examples. Its neo-Hookean law has another term of the
  volume, the same to first order. With friction it stops where the first nodes of a surface are in contact and others are not (zero columns, or cells
  inverted in the first increment; `prm/ironing.prm` without friction ends, in 363 iterations); in `press_fit`, which begins with an overlap, it finds no
  contact. With cells of degree 2 it was not run.

Runs of the others end at a number of CPU seconds (`--time-limit`; 600 to 1800 here). Forces are those on the driven body; of the double arch it is the displacement of the
middle of the ring that is compared. *Ripple*: largest distance, peak to peak, of a force on the driven body from a cubic over the time while it slides (ironing: t = 1.2 to
1.9, ring 1.1 to 1.9, in three dimensions 0.7 to 1.4; press fit 1.7 to 1.95), over its mean. *Penetration*: largest depth of a node under the faces of the other body at the end,
in sides of slave faces, of programs that end; faces are flat here, so that of rounded surfaces, as nodus has them, something is left (empty: not measured, as in cells
of CalculiX of degree 2, which lack nodes). A force of nodus is of the contact without a stiffness, so CalculiX' differences get smaller with a stiffer contact where that ends.

{text}""")


if __name__ == "__main__":
    main()
