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
import time
import xml.etree.ElementTree

ROOT = os.path.abspath(os.path.join(os.path.dirname(__file__), "..", "..", ".."))
NODUS = os.environ.get("NODUS", os.path.join(ROOT, "build-release", "nodus"))
SCRATCH = os.environ.get("NODUS_STUDIES", os.path.join(ROOT, "results", "studies"))
CASE = os.path.join(ROOT, "prm", "sliding_blocks.prm")
# Small and in many increments: what counts here is how often it is interrupted.
OVERRIDES = ["Load stepping/Increments=240,480", "Output/Checkpoint interval=3", "Output/VTU interval=5"]
COARSE = ["Body 1/Generator arguments=3,3,2 : 0,0.25,0 : 1,1.25,0.5 : true",
          "Body 2/Generator arguments=8,4,2 : -1,0,-0.5 : 2,1.5,0 : true"]


def start(case, folder, ranks, restart):
    command = [NODUS, case] + (["--restart"] if restart else [])
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


def table(folder, name):
    with open(os.path.join(folder, name), newline="") as file:
        return list(csv.reader(file))


def difference(a, b, name):
    """Largest difference of the forces, moments, areas and energies, relative to the largest value of its column."""
    first, second = table(a, name), table(b, name)
    if len(first) != len(second):
        return f"{len(first)} and {len(second)} rows"
    columns = [i for i, title in enumerate(first[0]) if any(kind in title for kind in ("force", "area", "pressure", "[energy]"))]
    largest = 0.0
    for i in columns:
        scale = max(abs(float(row[i])) for row in second[1:])
        scale = max(scale, 1e-6 * max(abs(float(row[j])) for row in second[1:] for j in columns))
        largest = max([largest] + [abs(float(x[i]) - float(y[i])) / scale for x, y in zip(first[1:], second[1:])])
    return largest


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--kills", type=int, default=10)
    parser.add_argument("--ranks", type=int, default=1)
    parser.add_argument("case", nargs="?", default=CASE)
    options = parser.parse_args()
    random.seed(options.seed)

    whole, parts = (os.path.join(SCRATCH, "kill", name) for name in ("whole", "parts"))
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
              f"{'the same text' if table(parts, name) == table(whole, name) else 'not the same text'}")
    if bad or left or run.returncode != 0:
        raise SystemExit("not as it should be")


if __name__ == "__main__":
    main()
