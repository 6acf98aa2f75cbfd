"""contrib/plot/watch and status.json: of a run that goes on, that is killed, interrupted, stopped and finished."""

import json
import os
import signal
import subprocess
import sys
import time

from harness import NODUS, SOURCE, below, check, nodus, run

PARAMETERS = os.path.join(SOURCE, "tests", "parameters")
BLOCKS = ("two_blocks.prm", "--set", "Load stepping/Increments=400, 600", "--set", "Output/Write VTU=false")


def watch(folder, *options):
    """Exit code and text."""
    done = subprocess.run([sys.executable, os.path.join(SOURCE, "contrib", "plot", "watch"), folder, *options],
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False, timeout=300)  # fmt: skip
    print("    " + done.stdout.replace("\n", "\n    ").rstrip())
    return done.returncode, done.stdout


def status(folder):
    with open(os.path.join(folder, "status.json"), encoding="utf-8") as file:
        return json.load(file)


def start(folder):
    """A run that has done a few increments."""
    process = subprocess.Popen([NODUS, os.path.join(PARAMETERS, BLOCKS[0]), *BLOCKS[1:], "--set", f"Output/Results folder={folder}"],
                               stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)  # fmt: skip
    until = time.monotonic() + 600
    while time.monotonic() < until:
        if os.path.exists(os.path.join(folder, "status.json")) and status(folder)["increment"] >= 3:
            return process
        time.sleep(0.02)
    raise RuntimeError("the run does not begin")


def test_finished():
    case = nodus.Case.read(os.path.join(PARAMETERS, BLOCKS[0]), program=nodus.Program(NODUS))
    case["Load stepping/Increments"] = [2, 3]
    results = case.run("results/blocks", 2)
    code, text = watch("results/blocks", "--png", "history.png")
    check("exit code", code, 0)
    check("says so", "finished" in text and "100 %" in text and "2 ranks" in text, True)
    now = status("results/blocks")
    check("increment", now["increment"], 5)
    check("time", now["time"], 2.)
    check("iterations", now["Newton iterations of all increments"], int(results.contact["Newton iterations"].sum()))
    last = text.rstrip().split("\n")[-1].split()
    check("last increment", (last[0], last[2]), ("5", str(int(results.contact["Newton iterations"][-1]))))
    force = sum(results.contact[f"slave force {c}"][-1] ** 2 for c in "xyz") ** 0.5
    below("force", abs(float(last[5]) / force - 1), 1e-3)
    with open("history.png", "rb") as file:
        check("picture", file.read(4), b"\x89PNG")


def test_running():
    process = start("results/going")
    process.send_signal(signal.SIGSTOP)
    code, text = watch("results/going", "--once")
    check("exit code", code, 0)
    check("says so", "running" in text and "left" in text, True)
    now = status("results/going")
    check("part done", now["part done"], now["time"] / 2, 1e-12)
    check("at this pace", now["seconds left"], now["seconds"] * (1 - now["part done"]) / now["part done"], 1e-9)
    process.kill()
    process.wait()
    code, text = watch("results/going")
    check("killed: exit code", code, 1)
    check("says so", "without a word" in text, True)


def test_interrupted():
    process = start("results/parts")
    process.send_signal(signal.SIGTERM)
    process.wait()
    code, text = watch("results/parts")
    check("exit code", code, 1)
    check("says so", "interrupted" in text and "SIGTERM" in text, True)


def test_stopped():
    subprocess.run([NODUS, os.path.join(PARAMETERS, "free_block.prm"), "--set", "Output/Results folder=results/free"],
                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=False)  # fmt: skip
    code, text = watch("results/free")
    check("exit code", code, 1)
    check("says why", "stopped" in text and "is free" in text, True)
    code, text = watch("results/none")
    check("no run: exit code", code, 1)
    check("says so", "no run has begun there" in text, True)


run(test_finished, test_running, test_interrupted, test_stopped)
