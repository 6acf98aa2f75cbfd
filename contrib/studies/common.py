"""What the studies share: runs of nodus, their results, fitted orders, tables and plots."""

import csv
import os
import re
import resource
import subprocess
import sys

import numpy as np

FOLDER = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(FOLDER))
sys.path.insert(0, os.path.join(ROOT, "contrib", "plot"))
import results  # noqa: E402

NODUS = os.environ.get("NODUS", os.path.join(ROOT, "build-release", "nodus"))
# results of the runs, not kept
SCRATCH = os.environ.get("NODUS_STUDIES", os.path.join(ROOT, "results", "studies"))

# The schemes that the studies compare, as keys of a contact pair.
SCHEMES = {
    "nodal": {"Scheme": "nodal"},
    "integration point": {"Scheme": "integration point"},
    "averaged, face": {"Scheme": "averaged", "Integration": "face"},
    "averaged, segment": {"Scheme": "averaged", "Integration": "segment"},
}


class Run:
    """One finished run: exit code, log, CPU seconds, and the tables and surfaces that it wrote."""

    def __init__(self, folder, code, log, cpu, memory):
        self.folder, self.code, self.log, self.cpu, self.memory = folder, code, log, cpu, memory

    @property
    def converged(self):
        return self.code == 0

    def contact(self):
        """Rows of contact.csv as dictionaries of numbers where they are numbers."""
        rows = []
        with open(os.path.join(self.folder, "contact.csv")) as file:
            for row in csv.DictReader(file):
                rows.append({re.sub(r" \[.*\]$", "", key): _number(value) for key, value in row.items()})
        return rows

    def surface(self, time=None):
        """The contact surfaces (results.Mesh) at a time, the last by default."""
        return results.Results(self.folder).mesh("contact", time)

    def body(self, time=None):
        return results.Results(self.folder).mesh("bodies", time)

    def timing(self):
        """CPU seconds per phase from the table at the end of the log."""
        found = {}
        for name, seconds in re.findall(r"^  ([a-z][a-z -]+?) +[0-9]* +([0-9.]+) +[0-9.]+$", self.log, re.M):
            found[name] = float(seconds)
        return found


def _number(text):
    try:
        return float(text)
    except ValueError:
        return text


def write_case(name, text):
    """Writes <name>.prm (or any other file) into the scratch folder; returns its path."""
    path = os.path.join(SCRATCH, name if "." in os.path.basename(name) else name + ".prm")
    os.makedirs(os.path.dirname(path), exist_ok=True)
    with open(path, "w") as file:
        file.write(text)
    return path


def run(prm, name, sets=None, pair=None, ranks=1):
    """Runs a case. sets: {"Section/Key": value}; pair: keys of "Contact pair 1". A failed run is a result too."""
    folder = os.path.join(SCRATCH, name)
    keys = dict(sets or {})
    for key, value in (pair or {}).items():
        keys["Contact pair 1/" + key] = value
    keys["Output/Results folder"] = folder
    command = [NODUS, prm]
    if ranks > 1:
        command = ["mpirun", "-n", str(ranks)] + command
    for key, value in keys.items():
        command += ["--set", f"{key}={value}"]
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    cpu = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    os.makedirs(folder, exist_ok=True)
    with open(os.path.join(folder, "log"), "w") as file:
        file.write(done.stdout)
    if "input error" in done.stdout:
        raise SystemExit(f"{name}: {done.stdout}")
    print(f"  {name}: exit {done.returncode}, {cpu:.1f} CPU s", flush=True)
    return Run(folder, done.returncode, done.stdout, cpu, after.ru_maxrss)


def fitted_order(h, error):
    """Order of convergence and its standard deviation, from a line through the logarithms."""
    x, y = np.log(np.asarray(h)), np.log(np.asarray(error))
    if len(x) < 3:
        return (y[-1] - y[0]) / (x[-1] - x[0]), float("nan")
    (order, _), covariance = np.polyfit(x, y, 1, cov="unscaled")
    residual = y - np.polyval(np.polyfit(x, y, 1), x)
    return order, float(np.sqrt(covariance[0, 0] * np.sum(residual**2) / (len(x) - 2)))


def table(path, header, rows):
    """Writes a Markdown table and prints it."""
    lines = ["| " + " | ".join(header) + " |", "|" + "---|" * len(header)]
    lines += ["| " + " | ".join(str(cell) for cell in row) + " |" for row in rows]
    text = "\n".join(lines) + "\n"
    with open(path, "w") as file:
        file.write(text)
    print(text, flush=True)
    return text


def figure(width=6.0, height=4.0):
    """An empty matplotlib figure and its axes, drawn without a screen."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    return plt.subplots(figsize=(width, height), layout="constrained")
