#!/usr/bin/python3
"""nodus beside CalculiX and GetFEM on cases of the gallery: the same mesh, elements and law, one process and one thread each.

    peers.py [--time-limit S] [CASE ...]    (default: all)

Writes <case>.csv and ../../doc/gallery/<case>_peers.png (forces over the time) and peers.md; cases that are not named keep
their rows of peers.json. Needs ccx (Debian: calculix-ccx) and python3-getfem. NODUS names the program, CCX that of CalculiX.
"""

import argparse
import json
import os
import sys

import numpy as np

import calculix
import getfem_peer
from plain_case import HERE, PlainCase, common

GALLERY = os.path.join(common.ROOT, "prm", "gallery")
MERGED = {f"{loop} loop/Mode": "newton" for loop in ("Geometry", "Threshold", "Status")}


def _cells(bodies):
    """Full cells of degree 1 and the law that the others have, too."""
    sets = {"Discretization/Degree": "1"}
    for body in range(1, bodies + 1):
        sets[f"Body {body}/Volumetric treatment"] = "standard"
        sets[f"Body {body}/Material/Law"] = "Mooney-Rivlin"
    return sets


# file, keys, condition whose forces are compared, contact stiffness of CalculiX in the soft body's modulus over length: as a user, as an expert;
# how far GetFEM looks for the other surface: less than the thickness of a body
CASES = {
    "ironing_3d": ("ironing_3d.prm", {**_cells(2), "Body 1/Generator arguments": "36, 8, 8 : 0,0,0 : 9,2,3 : true",
                                      "Load stepping/Increments": "10, 40"}, 4, (100, 1000), 0.15),
    "ironing": ("ironing.prm", _cells(2), 4, (10, 100), 1.0),
    "press_fit": ("press_fit.prm", _cells(2), 2, (1, 10), 100.0),
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


def plot(name, found, columns):
    """The forces that the condition moves against."""
    figure, _ = common.figure(5 * len(columns), 4)
    figure.clear()
    for axis, column in zip(figure.subplots(1, len(columns), squeeze=False)[0], columns):
        for (program, r), style in zip(found.items(), ("-", "o", "x", "+")):
            forces = np.array(r["forces"])
            axis.plot(forces[:, 0], forces[:, column], style, ms=4, mfc="none", label=program)
        axis.set_xlabel("time")
        axis.set_ylabel("force " + "xyz"[column - 1])
    axis.legend(fontsize="small")
    figure.savefig(os.path.join(common.ROOT, "contrib", "doc", "gallery", name + "_peers.png"), dpi=100)


def measure(name, time_limit):
    file, sets, condition, stiffnesses, release = CASES[name]
    path = os.path.join(GALLERY, file)
    found = {"nodus": run_nodus(name, path, sets, condition)}
    folder = os.path.join(common.SCRATCH, "peers", name)
    case = PlainCase(path, sets, folder)
    found["nodus"]["unknowns"] = case.n_unknowns
    softest = min(modulus for _, modulus, _ in case.laws().values())
    for factor in stiffnesses:
        found[f"CalculiX, contact stiffness {factor} E"] = calculix.run(case, factor * softest, 0.1 * factor * softest, f"{folder}_ccx_{factor}", time_limit)
    found["GetFEM"] = getfem_peer.run(case, softest, release, f"{folder}_getfem", time_limit)
    for program, r in found.items():
        if program != "nodus":
            r["forces"] = np.asarray(r["forces"].get(condition, [])).tolist()
        print(f"  {name}, {program}: to t = {r['time']:g}, {r['cpu']:.1f} CPU s", flush=True)
    write_csv(name, found)
    columns = moved(case.conditions()[condition])
    plot(name, found, columns)
    forces = {program: r.pop("forces") for program, r in found.items()}
    for program, r in found.items():
        if program != "nodus" and forces[program] and forces[program][-1][0] >= forces["nodus"][0][0]:
            r["apart"] = difference(forces["nodus"], forces[program], columns)
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
    options = parser.parse_args()
    kept, store = {}, os.path.join(HERE, "peers.json")
    if os.path.exists(store):
        with open(store, encoding="utf-8") as file:
            kept = json.load(file)
    for name in options.cases or CASES:
        if name not in CASES:
            sys.exit(f"peers.py: there is no case {name}; there are {', '.join(CASES)}")
        kept[name] = measure(name, options.time_limit)
        with open(store, "w", encoding="utf-8") as file:
            json.dump(kept, file, indent=1)
    page = os.path.join(HERE, "peers.md")
    text = common.table(page, HEADER, rows(kept))
    with open(page, "w", encoding="utf-8") as file:
        file.write(f"""# nodus, CalculiX and GetFEM on cases of the gallery

`contrib/studies/peers/peers.py`: the same mesh, full cells of degree 1 (C3D8), the neo-Hookean law that CalculiX has, one process and one
thread each. nodus with its default settings. CalculiX with surface-to-surface contact of two stiffnesses, in Young's moduli of the softer body by
length, sticking contact ten times softer, its own tolerances and increments as long as those of nodus at most; SPOOLES. GetFEM with its contact of large
sliding by ray tracing (Poulios and Renard), multipliers of degree 1 on the slave side, augmentation by Young's modulus of the softer body, increments of
nodus, halved where Newton's method takes more than 30 iterations; MUMPS. Forces are those on the driven body; [the gallery](../../doc/gallery.md) shows them.

{text}""")


if __name__ == "__main__":
    main()
