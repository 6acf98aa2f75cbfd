#!/usr/bin/python3
"""Kills a run at random moments, restarts it each time, and compares with the run that was left alone.

    kill.py [--seed N] [--kills N] [--ranks N] [case.prm]    (default: 1, 10, 1 and prm/sliding_blocks.prm)

Every other kill is SIGTERM (checkpoint, then the end), the others SIGKILL (no warning). After each one the results folder
is searched for files that are not complete. Prints the table of README.md; NODUS names the program.
"""

import argparse
import csv
import os
import random
import shutil
import signal
import subprocess
import sys
import time
import xml.etree.ElementTree

import numpy as np

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
import common

CASE = os.path.join(common.ROOT, "prm", "sliding_blocks.prm")
# Small and in many increments: what counts here is how often it is interrupted.
OVERRIDES = ["Load stepping/Increments=240,480", "Output/Checkpoint interval=3", "Output/VTU interval=5"]
COARSE = ["Body 1/Generator arguments=3,3,2 : 0,0.25,0 : 1,1.25,0.5 : true",
          "Body 2/Generator arguments=8,4,2 : -1,0,-0.5 : 2,1.5,0 : true"]


def start(case, folder, ranks, restart):
    command = [common.NODUS, case] + (["--restart"] if restart else [])
    for value in [f"Output/Results folder={folder}"] + OVERRIDES + (COARSE if case == CASE else []):
        command += ["--set", value]
    if ranks > 1:
        command = ["mpirun", "-n", str(ranks)] + command
    return subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)


def damaged_files(folder):
    """Files under their final names that are not complete."""
    damaged = []
    for name in os.listdir(folder):
        path = os.path.join(folder, name)
        try:
            if name.endswith((".vtu", ".pvtu", ".pvd")):
                xml.etree.ElementTree.parse(path)
            elif name.endswith(".csv"):
                with open(path, newline="") as file:
                    text = file.read()
                lengths = {len(row) for row in csv.reader(text.splitlines())}
                if len(lengths) != 1 or not text.endswith("\n"):
                    damaged.append(name)
        except xml.etree.ElementTree.ParseError:
            damaged.append(name)
    return damaged


def difference(a, b, name):
    """Largest difference of the forces, moments, areas and energies, relative to the largest value of its column."""
    first, second = common.nodus.Results(a).table(name), common.nodus.Results(b).table(name)
    if len(first) != len(second):
        return f"{len(first)} and {len(second)} rows"
    columns = [c for c, unit in first.units.items() if unit in ("force", "force length", "area", "pressure", "energy")]
    scale = {c: np.abs(second[c]).max() for c in columns}
    least = 1e-6 * max(scale.values())
    return max(np.abs(first[c] - second[c]).max() / max(scale[c], least) for c in columns)


def same_text(a, b, name):
    with open(os.path.join(a, name), "rb") as first, open(os.path.join(b, name), "rb") as second:
        return first.read() == second.read()


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--kills", type=int, default=10)
    parser.add_argument("--ranks", type=int, default=1)
    parser.add_argument("case", nargs="?", default=CASE)
    options = parser.parse_args()
    random.seed(options.seed)

    whole, parts = (os.path.join(common.SCRATCH, "kill", name) for name in ("whole", "parts"))
    for folder in (whole, parts):
        shutil.rmtree(folder, ignore_errors=True)
    begin = time.time()
    run = start(options.case, whole, options.ranks, False)
    run.communicate()
    if run.returncode != 0:
        raise SystemExit(f"the run that nobody kills ends with {run.returncode}")
    duration = time.time() - begin
    print(f"{os.path.basename(options.case)}, {options.ranks} rank(s), {', '.join(OVERRIDES)}: {duration:.0f} s alone\n")

    print("| kill | signal | after s | exit code | had continued after increment | damaged files |\n|---|---|---|---|---|---|")
    bad = 0
    for kill in range(options.kills):
        # Later runs have less to do: moments from what one part of the run takes.
        wait = random.uniform(0.0, 2.0 / (options.kills + 1)) * duration + 1.0
        what = (signal.SIGTERM, signal.SIGKILL)[kill % 2]
        run = start(options.case, parts, options.ranks, kill > 0)
        try:
            log, _ = run.communicate(timeout=wait)
            code = run.returncode
        except subprocess.TimeoutExpired:
            run.send_signal(what)
            log, _ = run.communicate()
            code = run.returncode
        damaged = damaged_files(parts) if os.path.isdir(parts) else []
        bad += len(damaged)
        continued = [line.split()[3].rstrip(",") for line in log.splitlines() if line.startswith("Continues after increment")]
        print(f"| {kill + 1} | {what.name} | {wait:.1f} | {code} | {continued[0] if continued else '-'} | "
              f"{', '.join(damaged) or 'none'} |", flush=True)
    run = start(options.case, parts, options.ranks, True)
    log, _ = run.communicate()
    left = [os.path.join(place, name) for place, folders, files in os.walk(parts) for name in folders + files
            if name.endswith(".incomplete")]
    print(f"\nlast run: exit code {run.returncode}; left incomplete: {', '.join(left) or 'none'}")
    for name in ("contact.csv", "reactions.csv", "energy.csv"):
        print(f"{name}: largest relative difference to the run left alone: {difference(parts, whole, name)}, "
              f"{'the same text' if same_text(parts, whole, name) else 'not the same text'}")
    if bad or left or run.returncode != 0:
        raise SystemExit("not as it should be")


if __name__ == "__main__":
    main()
