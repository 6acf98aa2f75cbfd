#!/usr/bin/python3
"""Cells per second of the element kernel and of the assembled tangent, beside plain deal.II and the machine's limits.

Builds kernel.cc (target kernel_study) in the build folder of nodus, runs it and writes kernel.md.
"""

import os
import subprocess
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.dirname(HERE))
import common  # noqa: E402

GOAL = 4  # times the cells per second of plain deal.II, neo-Hookean, Q1


def measure():
    build = os.path.dirname(common.NODUS)
    subprocess.run(["cmake", "--build", build, "--target", "kernel_study"], check=True)
    done = subprocess.run([os.path.join(build, "kernel_study")], check=True, text=True, stdout=subprocess.PIPE)
    return [line.split(",") for line in done.stdout.splitlines()]


def machine():
    with open("/proc/cpuinfo") as file:
        names = [line.split(":")[1].strip() for line in file if line.startswith("model name")]
    compiler = subprocess.run(["c++", "--version"], text=True, capture_output=True).stdout.splitlines()[0]
    return f"one core of {names[0]}, {compiler}"


def number(value):
    """Three digits, thousands apart."""
    return f"{float(f'{float(value):.3g}'):,.0f}".replace(",", " ")


def main():
    rows = measure()
    limits = {row[1]: float(row[2]) for row in rows if row[0] == "limit"}
    bandwidth, peak = limits["triad [B/s]"], limits["multiply-add [flop/s]"]
    difference = max(float(row[3]) for row in rows if row[1] == "difference")
    plain = {(row[0], row[1]): float(row[3]) for row in rows if row[2:3] == ["plain deal.II"]}
    table, ratio = [], {}
    for row in rows:
        if row[0] == "limit" or row[1] == "difference":
            continue
        degree, what, name, rate, flops, traffic = *row[:3], float(row[3]), row[4], row[5]
        times = rate / plain[degree, what]
        if name == "neo-Hookean":
            ratio[degree, what] = times
        cells = [f"Q{degree}", what, name, number(rate), f"{times:.1f}"]
        if flops:
            cells += [number(flops), f"{100 * rate * float(flops) / peak:.0f} %"]
            cells += [number(traffic), f"{100 * rate * float(traffic) / bandwidth:.0f} %"]
        else:
            cells += [""] * 4
        table.append(cells)
    header = ["degree", "what", "law", "cells/s", "/ plain", "flops per cell", "of the peak", "bytes per cell",
              "of the bandwidth"]  # fmt: skip
    path = os.path.join(HERE, "kernel.md")
    text = common.table(path, header, table)
    verdict = "met" if min(ratio["1", "element"], ratio["1", "assembled"]) >= GOAL else "NOT met"
    with open(path, "w") as file:
        file.write(
            "## Cells per second of tangent and residual\n\n"
            f"Goal: Q1, neo-Hookean, at least {GOAL} times a plain implementation with `FEValues` and `SymmetricTensor`: "
            f"**{verdict}**, {ratio['1', 'element']:.1f} times by element and {ratio['1', 'assembled']:.1f} times assembled "
            f"(Q2: {ratio['2', 'element']:.1f} and {ratio['2', 'assembled']:.1f}).\n\n"
            f"Measured on {machine()}; CPU time, least of the rounds, all in one program whose parts take turns "
            "(`contrib/studies/scaling/kernel.py`, which builds and runs `kernel.cc`). 32^3 Q1 or 16^3 Q2 distorted cells, "
            "107 811 degrees of freedom, displacements that differ from cell to cell. All code has the same compiler "
            f"options (`-O3 -march=native`). Forces and stiffnesses of both implementations agree to {difference:.0e}.\n\n"
            "- *element*: displacements gathered, force and stiffness of all cells computed and dropped; *assembled*: "
            "the same and all that `SolidAssembler::tangent` does (constraints, scatter into the matrix, vectors).\n"
            "- *plain deal.II*: step-44 style: `FEValues::reinit` in each cell, spatial `SymmetricTensor<4>`, products "
            "hoisted out of the inner loop, lower half; assembled with `distribute_local_to_global` into a Trilinos matrix.\n"
            "- *by evaluate()*: a law that has only the tensor interface, as a new one would.\n"
            f"- Peak: {peak / 1e9:.1f} Gflop/s, independent fused multiply-adds on registers. Bandwidth: {bandwidth / 1e9:.1f} "
            "GB/s, STREAM triad of three arrays of 128 MB (24 bytes an entry).\n"
            "- Flops are additions and multiplications as the source has them, without logarithms and roots: with n nodes "
            "(= points) per cell, each point takes 51 + 18 n for the reference geometry, 33 n for gradients and F, 14 for "
            "det F, 20 to 380 for the law, 51 + 18 n for the force, 549 for dP/dF, 135 n and 54 n (n + 1)/2 for the "
            "stiffness. Bytes: numbers of the nodes, and assembled the blocks of the matrix (72 bytes each: zeroed, read, "
            "written) with their positions (4 each).\n\n" + text
        )


if __name__ == "__main__":
    main()
