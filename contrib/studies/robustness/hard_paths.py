#!/usr/bin/python3
"""Paths on which contact codes stop: sliding cantilevers with friction, a wedge in its slot, ironing, a rubber seal in a groove.
Prints the tables of README.md; NODUS names the program.
"""

import collections
import os
import sys

import numpy as np

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
import common
import seal

PRM = os.path.join(common.ROOT, "prm")
MERGED = {f"{loop} loop/Mode": "newton" for loop in ("Geometry", "Threshold", "Status")}
# Sums of the reactions of the two clamps with mu = 0.2 by Code_Aster 14.6, which stops at t = 0.90.
CODE_ASTER = {0.2: 436.995, 0.4: 1696.64, 0.6: 3577.69, 0.8: 3504.28}


def cost(run):
    rows = run.contact if run.converged else []
    cell = f"{sum(r['Newton iterations'] for r in rows):.0f}" if rows else "-"
    return [cell, run.log.count("the increment is halved"), run.log.count(" given up: "), f"{run.cpu:.1f}"]


def cantilevers():
    run = common.run(os.path.join(PRM, "cantilevers.prm"), "hard/cantilevers", MERGED, {"Friction coefficient": 0.2})
    print("exit code", run.code, "; Newton iterations, cut-backs, fallbacks, CPU s:", *cost(run))
    rows = run.reactions
    body = []
    for t in (0.2, 0.4, 0.6, 0.8, 0.9, 1.0):
        total = sum(r["force y"] for r in rows if r["condition"].startswith("clamp") and abs(r["time"] - t) < 1e-9)
        known = CODE_ASTER.get(t)
        body.append([t, f"{total:.3f}", known or "-", f"{100 * (total / known - 1):+.3f} %" if known else "-"])
    common.table(os.path.join(common.SCRATCH, "cantilevers.md"), ["t", "sum of y reactions", "Code_Aster", "deviation"], body)


def wedge():
    slope, force, body = 0.115, 1000.0, []
    for mu in (0.1, 0.2, 0.3):
        exact = force * (1 - mu * slope) / (slope + mu)
        for name, loops in (("merged", MERGED), ("three loops", common.THREE_LOOPS)):
            run = common.run(os.path.join(PRM, "wedge.prm"), f"hard/wedge_{mu}_{name[0]}", loops, {"Friction coefficient": mu})
            value, error = "-", run.log.strip().splitlines()[-1][:160]
            if run.converged:
                rows = run.reactions.where(condition="guide")
                value = -rows[-1]["force z"]
                error = f"{100 * (value / exact - 1):+.1e} %"
                value = f"{value:.3f}"
            body.append([mu, name, f"{exact:.3f}", value, error] + cost(run))
    common.table(os.path.join(common.SCRATCH, "wedge.md"),
                 ["mu", "loops", "exact", "computed", "deviation, or why it stops", "Newton", "cut-backs", "fallbacks", "CPU s"],
                 body)  # fmt: skip


def rubber_seal():
    body = []
    for increments in (8, 64):
        for n, friction in ((8, 0.5), (12, 0.3), (12, 0.5), (16, 0.5)):
            run = common.run(seal.write(n, friction, 0.4, increments), f"hard/seal_{n}_{friction}_{increments}", MERGED)
            counts, eighths = collections.Counter(), collections.Counter()
            for row in run.convergence:
                counts[row["increment"]] += row["iteration"] != 0
                eighths[np.ceil(8 * row["time"] - 1e-9)] += row["iteration"] != 0
            why = "yes" if run.converged else run.log.strip().splitlines()[-1][:160]
            body.append([increments, f"{n} x {n}", friction, why, len(counts), max(counts.values()), max(eighths.values()),
                         sum(counts.values())] + cost(run)[1:])  # fmt: skip
    common.table(os.path.join(common.SCRATCH, "seal.md"),
                 ["asked for", "cells", "friction", "finished", "increments", "most iterations in one", "in an eighth of the way", "all",
                  "cut-backs", "fallbacks", "CPU s"],
                 body)  # fmt: skip


def ironing():
    variants = {
        "default": ({}, {}),
        "normals of the facets": ({"Surface": "faceted", "Normal": "master facet"}, {}),
        "ring is the slave": ({"Slave body": 2, "Slave boundary ids": 0, "Master body": 1, "Master boundary ids": 3,
                               "Slave where": "y < 0.7 && x^2 + (y-1)^2 > 0.8 && abs(z - 0.1) < 0.0999", "Master where": ""}, {}),
        "three loops": ({}, common.THREE_LOOPS),
    }  # fmt: skip
    body = []
    for name, (pair, loops) in variants.items():
        run = common.run(os.path.join(PRM, "ironing.prm"), "hard/ironing_" + name.replace(" ", "_"),
                         {**MERGED, **loops, "Output/VTU interval": 0}, pair)  # fmt: skip
        row = [name, "yes" if run.converged else run.log.strip().splitlines()[-1][:160]]
        axle = run.reactions.where(condition="axle")
        forces = np.column_stack([axle[column] for column in ("time", "force x", "force y")])
        steady = forces[(forces[:, 0] > 1.0999) & (forces[:, 0] < 1.9001)]
        for c in (1, 2):
            f = steady[:, c]
            row.append(f"{f.mean():.4f} +- {50 * np.ptp(f) / abs(f.mean()):.1f} %" if len(f) else "-")
        body.append(row + cost(run))
    common.table(os.path.join(common.SCRATCH, "ironing.md"),
                 ["variant", "finished", "force x, t = 1.1 to 1.9", "force y", "Newton", "cut-backs", "fallbacks", "CPU s"],
                 body)  # fmt: skip


if __name__ == "__main__":
    for part in sys.argv[1:] or ("cantilevers", "wedge", "ironing", "seal"):
        {"cantilevers": cantilevers, "wedge": wedge, "ironing": ironing, "seal": rubber_seal}[part]()
