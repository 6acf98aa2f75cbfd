#!/usr/bin/python3
"""nodus beside CalculiX, GetFEM and Kratos on cases of the gallery, prm/ironing.prm and the comparison case hertz: the same mesh, elements
and law, one process and one thread each.

    peers.py [--time-limit S] [--programs PROGRAM,...] [CASE ...]    (default: all)

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
from plain_case import HERE, PlainCase, common

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


ONE = {"Load stepping/Interval ends": "1", "Load stepping/Increments": "1"}
# file in prm/ or number of cells of hertz, keys, condition whose forces are compared, contact stiffness of CalculiX in the soft body's modulus over length: as a user, as an expert;
# how far GetFEM looks for the other surface: less than the thickness of a body
CASES = {
    "hertz_12": (12, ONE, 4, (50, 1000), 0.2),
    "hertz_24": (24, ONE, 4, (50,), 0.2),
    "ironing_ring": ("ironing.prm", _ring(6), 4, (100, 1000), 0.15),
    "ironing_3d": ("gallery/ironing_3d.prm",
                   {**_cells(2), "Body 1/Generator arguments": "36, 8, 8 : 0,0,0 : 9,2,3 : true", "Load stepping/Increments": "10, 40"},
                   4, (100, 1000), 0.15),
    "ironing": ("gallery/ironing.prm", _cells(2), 4, (10, 100), 1.0),
    "press_fit": ("gallery/press_fit.prm", _cells(2), 2, (1, 10), 100.0),
}  # fmt: skip
HEADER = ["case", "unknowns", "program", "to t =", "increments", "cut back", "Newton iterations", "CPU s", "/ nodus", "peak MiB",
          "largest difference of forces until there"]  # fmt: skip


def run_nodus(name, path, sets, condition):
    run = common.program().run(path, sets={**MERGED, **sets, "Output/Results folder": os.path.join(common.SCRATCH, "peers", name)},
                               profile=True, check=False)  # fmt: skip
    rows = run.reactions.where(condition=common.nodus.Case.read(path, program=common.program())[f"Boundary condition {condition}"]["Name"])
    forces = np.column_stack([rows[column] for column in ("time", "force x", "force y", "force z")])
    return {"finished": run.converged, "time": float(forces[-1, 0]), "increments": len(forces), "cpu": run.cpu, "memory": run.memory,
            "iterations": run.profile["newton_iterations"] if run.converged else None,
            "cut-backs": run.log.count("the increment is halved"), "forces": forces.tolist()}  # fmt: skip


def moved(condition):
    """Columns of the components that a condition moves; those that it only holds share their nodes with others."""
    return [component + 1 for component, history in condition[1] if history.any()]


def difference(forces, other, columns):
    """Largest distance of the forces at the times of the first that the others reach, over the largest force."""
    forces, other = np.array(forces), np.array(other)
    times = forces[forces[:, 0] <= other[-1, 0] * (1 + 1e-9)]
    between = np.column_stack([np.interp(times[:, 0], other[:, 0], other[:, c]) for c in columns])
    return np.linalg.norm(between - times[:, columns], axis=1).max() / np.linalg.norm(forces[:, columns], axis=1).max()


def write_csv(name, found):
    """The programs' forces one after the other."""
    lines = [f"# Forces on the driven body of {CASES[name][0]} by contrib/studies/peers/peers.py", "program,time,x,y,z"]
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


def plot(name, found, columns):
    """The forces that the condition moves against."""
    figure, _ = common.figure(5 * len(columns), 4)
    figure.clear()
    for axis, column in zip(figure.subplots(1, len(columns), squeeze=False)[0], columns):
        for (program, r), style in zip(found.items(), ("-", "o", "x", "+", "^", "v", "s")):
            forces = np.array(r["forces"])
            axis.plot(forces[:, 0], forces[:, column], style, ms=4, mfc="none", label=program)
        axis.set_xlabel("time")
        axis.set_ylabel("force " + "xyz"[column - 1])
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
    case, forces = PlainCase(path, sets, folder), read_csv(name)
    found = {"nodus": run_nodus(name, path, sets, condition)}
    found["nodus"]["unknowns"] = case.n_unknowns
    for program, run in peers(case, stiffnesses, release, folder, time_limit).items():
        if not any(program.startswith(begin) for begin in programs):
            if program in before:
                found[program] = {**before[program], "forces": forces.get(program, [])}
            continue
        r = found[program] = run()
        r["forces"] = np.asarray(r["forces"].get(condition, [])).tolist()
        print(f"  {name}, {program}: to t = {r['time']:g}, {r['cpu']:.1f} CPU s", flush=True)
    columns = moved(case.conditions()[condition])
    ours = found["nodus"]["forces"]
    for program, r in found.items():
        if program != "nodus" and r["forces"] and r["forces"][-1][0] >= ours[0][0]:
            r["apart"] = difference(ours, r["forces"], columns)
    write_csv(name, found)
    if len(ours) > 1:
        plot(name, {program: r for program, r in found.items() if r["forces"]}, columns)
    for r in found.values():
        del r["forces"]
    return found


def rows(kept):
    for name, found in kept.items():
        ours = found["nodus"]
        for program, r in found.items():
            yield [name, ours["unknowns"], program, f"{r['time']:.4g}" + ("" if r["finished"] else ", stops"), r["increments"], r["cut-backs"],
                   r["iterations"], f"{r['cpu']:.1f}", f"{r['cpu'] / ours['cpu']:.2f}", f"{r['memory']:.0f}",
                   f"{100 * r['apart']:.2g} %" if "apart" in r else ""]  # fmt: skip


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("cases", nargs="*", metavar="CASE", help=", ".join(CASES))
    parser.add_argument("--time-limit", type=int, default=1800, help="CPU seconds of a run of the others")
    parser.add_argument("--programs", default="CalculiX,GetFEM,Kratos", help="beginnings of the others' names (default: %(default)s)")
    options = parser.parse_args()
    kept, store = {}, os.path.join(HERE, "peers.json")
    if os.path.exists(store):
        with open(store, encoding="utf-8") as file:
            kept = json.load(file)
    for name in options.cases or CASES:
        if name not in CASES:
            sys.exit(f"peers.py: there is no case {name}; there are {', '.join(CASES)}")
        kept[name] = measure(name, options.programs.split(","), options.time_limit, kept.get(name, {}))
        with open(store, "w", encoding="utf-8") as file:
            json.dump(kept, file, indent=1)
    page = os.path.join(HERE, "peers.md")
    text = common.table(page, HEADER, rows(kept))
    with open(page, "w", encoding="utf-8") as file:
        file.write(f"""# nodus, CalculiX, GetFEM and Kratos on the same meshes

`contrib/studies/peers/peers.py`: cases of [the gallery](../../doc/gallery.md), which shows their forces, and the comparison case
[hertz](../scaling/peers.md); the same mesh, full cells of degree 1 (C3D8), the neo-Hookean law that CalculiX has (hertz: linear elastic), one process and one
thread each. nodus with its default settings.

- CalculiX with surface-to-surface contact of two stiffnesses, in Young's moduli of the softer body by length, sticking contact ten times softer, and with
  its mortar contact; its own tolerances and increments as long as those of nodus at most; SPOOLES.
- GetFEM with its contact of large sliding by ray tracing (Poulios and Renard), multipliers of degree 1 on the slave side, augmentation by Young's
  modulus of the softer body, increments of nodus, halved where Newton's method takes more than 30 iterations; MUMPS.
- Kratos with its mortar contact by augmented Lagrangian multipliers, whose penalty it chooses itself, residuals and corrections to 1e-6, increments of nodus,
  all of them cut in four where one fails; its sparse LU, and AMG with the settings of its contact examples. Its neo-Hookean law has another term of the
  volume, the same to first order. Not in the table, for it was tried with this driver in another run (2026-11-30): with friction it stops where the first
  nodes of a surface are in contact and others are not (`prm/ironing.prm`, `ironing`, `ironing_3d`: zero columns, or cells inverted in the first increment);
  `prm/ironing.prm` without friction ends with -3.741 for the vertical force of nodus with friction, in 363 iterations; in `press_fit`, which begins with an
  overlap of 1, it finds no contact.

Forces are those on the driven body.

{text}""")


if __name__ == "__main__":
    main()
