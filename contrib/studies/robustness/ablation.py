#!/usr/bin/python3
"""What is each of the things good for that are tried where something fails?

    ablation.py [--seeds N[:CASES] ...] [--jobs N] [--time-limit S] [--longest S] [--remedies NAME ...]

Runs random cases (random_cases.py) and the cases of prm/ and of hard_paths.py, with merged iterations and with three
loops, and reads from the end of each log what was tried and how often. Then every case in which a remedy was used runs
again without it (`Strategy/Without`). Prints the table of README.md; details go to ablation.json in the scratch folder
(NODUS_STUDIES), from which runs that are already there are taken. NODUS names the program.
"""

import argparse
import concurrent.futures
import glob
import json
import os
import re
import signal
import subprocess
import sys

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
import common
import random_cases

PRM = os.path.join(common.ROOT, "prm")
LOOPS = ("Geometry", "Threshold", "Status")
FOLDER = os.path.join(common.SCRATCH, "ablation")


def remedies():
    """Names, from the program's own list of allowed values."""
    return common.program().reference["Strategy/Without"].choices


def fixed_cases():
    """Name and command line of the cases that are not random."""
    cases = {}
    for path in sorted(glob.glob(os.path.join(PRM, "*.prm"))):
        name = os.path.basename(path)[:-4]
        for loops, mode in (("merged", "newton"), ("three loops", "fixed point")):
            sets = {f"{loop} loop/Mode": mode for loop in LOOPS}
            cases[f"{name}, {loops}"] = (path, sets)
            if name == "wedge":
                for mu in (0.1, 0.3):
                    cases[f"{name} {mu}, {loops}"] = (path, {**sets, "Contact pair 1/Friction coefficient": mu})
            if name == "cantilevers":
                cases[f"{name} 0.2, {loops}"] = (path, {**sets, "Contact pair 1/Friction coefficient": 0.2})
            if name == "ironing":
                cases[f"{name} faceted, {loops}"] = (path, {**sets, "Contact pair 1/Surface": "faceted",
                                                            "Contact pair 1/Normal": "master facet"})  # fmt: skip
    return cases


def run(options, name, path, sets, without):
    """CPU time, exit code, Newton iterations and what was tried."""
    results = os.path.join(FOLDER, re.sub(r"\W+", "_", f"{name} {without or ''}"))
    sets = {**sets, "Output/Results folder": results, "Output/Write VTU": "false", "Output/Checkpoint interval": 0}
    if without:
        sets["Strategy/Without"] = without
    command = [common.NODUS, path] + [part for key, value in sets.items() for part in ("--set", f"{key}={value}")]
    limit = f"ulimit -t {options.time_limit}; exec \"$@\""
    with open(results + ".log", "w") as log:
        child = subprocess.Popen(["bash", "-c", limit, "nodus"] + command, stdout=log, stderr=subprocess.STDOUT,
                                 env=dict(os.environ, OMP_NUM_THREADS="1"))  # fmt: skip
        _, status, usage = os.wait4(child.pid, 0)
    code = os.waitstatus_to_exitcode(status)
    with open(results + ".log") as log:
        text = log.read()
    # a run that is stopped by the limit does not say what it tried
    return {"exit": code, "cpu": usage.ru_utime + usage.ru_stime, "used": random_cases.remedies_used(text),
            "limit": code in (-signal.SIGKILL, -signal.SIGXCPU),
            "Newton": sum(map(int, re.findall(r"(\d+) Newton iterations?", text))),
            "halved": text.count("the increment is halved"),
            "given up": re.findall(r"(?:merged iteration|three loops) given up: (.*?); again with (.*)", text),
            "reason": text.strip().splitlines()[-1][:300] if code else ""}  # fmt: skip


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", nargs="*", default=["1:200", "2:100"], help="and the number of their cases, 200 without")
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--time-limit", type=int, default=60, help="CPU seconds of one run")
    parser.add_argument("--longest", type=float, default=1e9, help="cases that took more CPU seconds do not run again")
    parser.add_argument("--remedies", nargs="*", help="these alone")
    parser.add_argument("--base", action="store_true", help="no run without a remedy")
    options = parser.parse_args()
    os.makedirs(FOLDER, exist_ok=True)
    store = os.path.join(FOLDER, "ablation.json")
    done = json.load(open(store)) if os.path.exists(store) else {}

    cases = fixed_cases()
    for seed, _, number in (text.partition(":") for text in options.seeds):
        for n in range(1, int(number or 200) + 1):
            case = random_cases.RandomCase(int(seed), n)
            cases[f"seed {seed}, case {n}"] = (case.write(f"ablation/seed_{seed}"), {})

    def run_all(jobs):
        jobs = [(name, without) for name, without in jobs if f"{name} | {without or ''}" not in done]
        with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
            results = pool.map(lambda job: run(options, job[0], *cases[job[0]], job[1]), jobs)
            for (name, without), result in zip(jobs, results):
                done[f"{name} | {without or ''}"] = result
                with open(store, "w") as file:
                    json.dump(done, file, indent=0)
                if without or result["exit"]:
                    print(f"{name}, without {without or 'nothing'}: exit {result['exit']}, {result['cpu']:.1f} CPU s", flush=True)

    run_all([(name, None) for name in cases])
    base = {name: done[f"{name} | "] for name in cases}
    print(f"{len(base)} cases, {sum(b['exit'] == 0 for b in base.values())} finished, {sum(b['cpu'] for b in base.values()):.0f} CPU s")
    if options.base:
        return
    rows = []
    for remedy in options.remedies or remedies():
        users = [name for name in cases if base[name]["used"].get(remedy) and base[name]["cpu"] <= options.longest]
        run_all([(name, remedy) for name in users])
        without = {name: done[f"{name} | {remedy}"] for name in users}
        lost = [name for name in users if base[name]["exit"] == 0 and without[name]["exit"]]
        gained = [name for name in users if base[name]["exit"] and without[name]["exit"] == 0]
        both = [name for name in users if base[name]["exit"] == 0 and without[name]["exit"] == 0]
        ratio = lambda key: sum(without[n][key] for n in both) / max(1e-9, sum(base[n][key] for n in both))  # noqa: E731
        rows.append([remedy, len(users), sum(base[n]["used"][remedy] for n in users), len(lost), len(gained),
                     f"{ratio('Newton'):.2f}" if both else "-", f"{ratio('cpu'):.2f}" if both else "-",
                     "; ".join(lost[:4]) + (" ..." if len(lost) > 4 else "")])  # fmt: skip
        print(rows[-1], "gained:", gained, flush=True)
    common.table(os.path.join(FOLDER, "ablation.md"),
                 ["remedy", "cases that use it", "times", "fail without it", "finish without it alone",
                  "Newton iterations of the others, times", "CPU, times", "for example"], rows)  # fmt: skip


if __name__ == "__main__":
    main()
