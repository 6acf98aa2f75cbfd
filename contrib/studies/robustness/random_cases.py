#!/usr/bin/python3
"""Random contact cases: do they finish, do those that stop say why, and is what they report true?

    random_cases.py [--seed N] [--cases N] [--only N] [--jobs N] [--time-limit S] [--advice]
                    [--increments N] [--set KEY=VALUE ...]

Writes case_<n>.prm for each, runs it, checks the results with checks.py and prints the table of README.md; details go to
random_cases/results_seed_<seed>.json in the scratch folder (NODUS_STUDIES). NODUS names the program. With --advice, cases that
stop are run again with each change that their diagnosis.md proposes, one at a time, and these runs are checked, too; what each key
comes to is the last table. --increments (of each interval) and --set make all of them harder, e.g. --increments 1
--set "Load stepping/Cut back=false". The cases are well posed by
construction: loads in proportion to the softest body, upper bodies held by prescribed displacements or by springs.
"""

import argparse
import collections
import concurrent.futures
import functools
import json
import math
import os
import re
import shlex
import shutil
import signal
import subprocess
import sys

import numpy as np

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
import checks
import common

# Length and pressure units that a millimetre and a megapascal are written in.
UNITS = {
    "mm, MPa": (1.0, 1.0),
    "m, Pa": (1e-3, 1e6),
    "um, MPa": (1e3, 1.0),
    "mm, GPa": (1.0, 1e-3),
    "inch, psi": (1 / 25.4, 145.0377),
    "cm, kPa": (0.1, 1e3),
}
LOOPS = ("Geometry", "Threshold", "Status")


def rotation_matrix(axis, degrees):
    a = np.asarray(axis) / np.linalg.norm(axis)
    cross = np.array([[0, -a[2], a[1]], [a[2], 0, -a[0]], [-a[1], a[0], 0]])
    angle = math.radians(degrees)
    return np.eye(3) + math.sin(angle) * cross + (1 - math.cos(angle)) * cross @ cross


def block(cells, low, high, bottom=None, top=None):
    """Grid for common.write_mesh between two sheets z = bottom(x, y) and z = top(x, y), flat unless given."""
    x, y, z = (np.linspace(low[d], high[d], 2 * cells[d] + 1) for d in range(3))
    grid = np.stack(np.meshgrid(x, y, z, indexing="ij"), axis=-1)
    s = (grid[..., 2] - low[2]) / (high[2] - low[2])
    below = bottom(grid[..., 0], grid[..., 1]) if bottom else 0.0
    above = top(grid[..., 0], grid[..., 1]) if top else 0.0
    grid[..., 2] += (1 - s) * below + s * above
    return grid


def prm(tree):
    """Nested dictionaries as a parameter file."""
    return common.nodus.prm.to_text(tree, written=lambda value: value if isinstance(value, str) else format(value, ".12g"))


class RandomCase:
    """Case n of a seed: `tree` (the parameter file), `facts` (for the table and the checks), `meshes`."""

    def __init__(self, seed, n):
        self.rng = rng = np.random.default_rng([seed, n])
        self.name = f"case_{n}"
        self.tree = {"Title": f"random case {n} of seed {seed}"}
        self.grids, self.conditions, self.pairs = [], [], []
        self.shape = self.pick({"flat": 0.36, "paraboloid": 0.12, "sphere": 0.1, "cylinder": 0.14, "trough": 0.08,
                                "stack": 0.1, "two indenters": 0.1})
        self.degree = 1 if rng.random() < 0.7 else 2
        self.friction = 0.0 if rng.random() < 0.2 else round(rng.uniform(0, 1.5), 3)
        self.drag = rng.random() < 0.6
        self.driven = self.pick({"displacement": 0.75, "force": 0.25}) if self.shape != "stack" else "displacement"

        unit = rng.choice(list(UNITS))
        length, pressure = UNITS[unit]
        self.size = length * 10 ** rng.uniform(-1, 2)
        self.axis = rng.normal(size=3)
        self.angle = 0.0 if rng.random() < 0.3 else rng.uniform(0, 360)
        self.turn = rotation_matrix(self.axis, self.angle)
        self.ratio = 10 ** rng.uniform(-3, 3)
        self.soft = pressure * 10 ** rng.uniform(-1, 5)

        # Strain of the softer body: a few per cent, sometimes more; friction must not shear it by more than that allows.
        self.strain = 0.002 * 20 ** rng.random() if rng.random() < 0.85 else rng.uniform(0.04, 0.12)
        self.strain = min(self.strain, 0.12 / (2.6 * max(self.friction, 0.4)))
        self.laws = [self.law() for _ in range(3)]
        self.height = rng.uniform(0.4, 0.6), rng.uniform(0.3, 0.6)  # upper, lower; the upper length is 1
        self.meshes()
        self.loads()
        self.sections(unit)

    def pick(self, choices):
        names = list(choices)
        weights = np.array([choices[name] for name in names])
        return names[self.rng.choice(len(names), p=weights / weights.sum())]

    def law(self):
        rng = self.rng
        law = self.pick({"linear elastic": 0.2, "neo-Hookean": 0.4, "St Venant-Kirchhoff": 0.2, "Mooney-Rivlin": 0.2})
        if law in ("linear elastic", "St Venant-Kirchhoff"):
            self.strain = min(self.strain, 0.05)  # both mean little in strong compression
        nu = rng.uniform(0, 0.45) if rng.random() < 0.8 else rng.uniform(0.45, 0.495)
        keys = {"Law": law, "Poisson's ratio": round(nu, 4)}
        if law == "Mooney-Rivlin":
            keys["Mooney-Rivlin ratio"] = round(rng.uniform(0.05, 1), 3)
        return keys

    def meshes(self):
        """Upper bodies over a lower one; all lengths in upper lengths, before scaling and rotation."""
        rng, (upper, lower) = self.rng, self.height
        n = int(rng.integers(3, 6)) if self.degree == 1 else int(rng.integers(2, 4))
        self.mesh_ratio = 3 ** rng.uniform(-1, 1)  # cell of the upper body over that of the lower one
        self.cell = 1.0 / n
        self.travel = rng.uniform(0.1, 0.6) if self.drag else 0.0
        theta = {"trough": math.pi / 2, "two indenters": 0.0}.get(self.shape, rng.uniform(0, math.pi / 2))
        if self.shape == "cylinder" and rng.random() < 0.5:
            theta = 0.0
        self.direction = np.array([math.cos(theta), math.sin(theta), 0.0])

        # The gap between the bodies, in cells: none, open, or too much material.
        kind = self.pick({"closed": 0.4, "gap": 0.3, "overclosure": 0.3})
        overclosure = -min(0.05 * self.cell, 0.3 * self.strain * upper) * rng.random()
        self.gap = {"closed": 0.0, "gap": 0.1 * self.cell * rng.random(), "overclosure": overclosure}[kind]

        radius = rng.uniform(0.9, 3)
        cap = {
            "paraboloid": lambda x, y: (x**2 + y**2) / (2 * radius),
            "sphere": lambda x, y: radius - np.sqrt(radius**2 - x**2 - y**2),
            "cylinder": lambda x, y: radius - np.sqrt(radius**2 - x**2) + 0 * y,
            "trough": lambda x, y: radius - np.sqrt(radius**2 - x**2) + 0 * y,
            "two indenters": lambda x, y: (x**2 + y**2) / (2 * radius),
        }.get(self.shape)
        wide = radius * rng.uniform(1.05, 2)
        hollow = (lambda x, y: wide - np.sqrt(wide**2 - x**2) + 0 * y) if self.shape == "trough" else None
        self.curved = cap is not None

        reach = 0.65 + self.travel * self.direction
        low = np.array([-0.65, -0.65, -lower])
        high = np.array([reach[0], reach[1], 0.0])
        if self.shape == "trough":  # the side walls stay within the arc
            low[0], high[0] = -0.55, 0.55
        if self.shape == "two indenters":
            high[0] += 1.2
        upper_cells = [n, n, int(rng.integers(2, 4)) if self.degree == 1 else int(rng.integers(1, 3))]
        most = 12 if self.degree == 1 else 6
        lower_cells = [int(np.clip(round((high[d] - low[d]) / (self.cell / self.mesh_ratio)), 2, most)) for d in (0, 1)]
        lower_cells.append(upper_cells[2])

        self.grids = [block(lower_cells, low, high, top=hollow)]
        base = self.gap
        if self.shape == "stack":
            middle = 0.5 * upper
            cells = [max(2, int(round(n * rng.uniform(0.6, 1.5)))) for _ in range(2)]
            self.grids.append(block(cells + [upper_cells[2]], (-0.55, -0.55, base), (0.55, 0.55, base + middle)))
            base += middle
        corners = (-0.5, -0.5, base), (0.5, 0.5, base + upper)
        self.grids.append(block(upper_cells, *corners, bottom=cap))
        if self.shape == "two indenters":
            self.grids.append(self.grids[-1] + np.array([1.2, 0, 0]))
        self.cells = [grid.shape[0] // 2 * (grid.shape[1] // 2) * (grid.shape[2] // 2) for grid in self.grids]

        soft_upper = rng.random() < 0.5
        self.moduli = [1.0] * len(self.grids)  # of the bodies, in units of the softest one
        stiff = max(self.ratio, 1 / self.ratio)
        for b in range(1, len(self.grids)):
            self.moduli[b] = 1.0 if soft_upper else stiff
        self.moduli[0] = stiff if soft_upper else 1.0
        self.stiffness_ratio = self.moduli[-1] / self.moduli[0]

    def loads(self):
        """Press, then perhaps drag; and what holds the bodies."""
        rng, (upper, lower) = self.rng, self.height
        compliance = upper / self.moduli[-1] + lower / self.moduli[0]
        if self.shape == "stack":
            compliance += 0.5 * upper / self.moduli[1]
        depth = self.strain * compliance
        if self.curved and self.shape != "trough":
            depth = min(depth, (self.strain / 0.2) ** 2)
            depth = max(depth, 5e-4)
        self.depth = depth
        down = np.array([0.0, 0.0, -1.0])
        press, drag = "min(t,1)", "max(t-1,0)"

        self.condition("support", 1, 4, "displacement", np.zeros(3))
        last = len(self.grids)
        uppers = [last - 1, last] if self.shape == "two indenters" else [last]
        for b in uppers:
            name = "top" if b == last else "other top"
            if self.driven == "displacement":
                self.condition(name, b, 5, "displacement", (depth + self.gap) * down, press,
                               self.travel * self.direction, drag)  # fmt: skip
                continue
            # Springs take two thirds of the force where everything is in contact and keep the body upright.
            spring = 2.0 / upper
            self.condition(name + " springs", b, 5, "spring", np.full(3, spring), turned=False)
            normal = 3 * self.strain if not self.curved else 3 * depth / upper
            shear = min(2 * self.friction * normal / 3 + 0.05 * self.strain, spring * 0.5) if self.drag else 0.0
            self.condition(name + " load", b, 5, "traction", (normal + spring * max(self.gap, 0)) * down, press,
                           shear * self.direction, drag)  # fmt: skip
        if self.shape == "stack":
            for side in range(4):
                self.condition(f"weak springs {side}", 2, side, "spring", np.full(3, 0.05), turned=False)

    def condition(self, name, body, side, kind, first, first_t="", second=None, second_t="", turned=True):
        unit = {"displacement": self.size, "traction": self.soft, "spring": self.soft / self.size}[kind]
        value = []
        for d in range(3):
            terms = []
            for vector, factor in ((first, first_t), (second, second_t)):
                if vector is not None and (not turned or np.any(vector)):
                    v = unit * ((self.turn @ vector)[d] if turned else vector[d])
                    terms.append(f"{v:.10g}" + (f"*{factor}" if factor else ""))
            value.append(" + ".join(terms).replace("+ -", "- ") or "0")
        self.conditions.append({"Name": name, "Type": kind, "Body": body, "Boundary ids": self.side(body, side),
                                "Components": "x, y, z", "Value": "; ".join(value)})  # fmt: skip

    @staticmethod
    def side(body, side):
        return f"{10 * body + side}"

    def pair(self, lower, upper):
        rng = self.rng
        keys = {"Name": f"pair {len(self.pairs) + 1}"}
        # two indenters: a face is a slave of one pair only, so the common one is the master
        upper_slave = self.shape == "two indenters" or rng.random() < 0.5
        ends = [(upper, 4), (lower, 5)]
        for role, (body, side) in zip(("Slave", "Master"), ends if upper_slave else ends[::-1]):
            keys[f"{role} body"], keys[f"{role} boundary ids"] = body, self.side(body, side)
        keys["Scheme"] = self.scheme
        if self.scheme == "nodal":
            keys["Weights"] = self.pick({"nodal quadrature": 0.6, "dual": 0.2, "consistent": 0.2})
        elif self.scheme == "averaged":
            keys["Integration"] = self.pick({"segment": 0.7, "face": 0.3})
        if self.scheme == "integration point":
            keys["Quadrature rule"] = self.pick({"Gauss": 0.5, "Simpson": 0.3, "Newton-Cotes": 0.2})
        if self.friction > 0:
            keys["Friction coefficient"] = self.friction
        keys["Surface"] = self.pick({"smoothed": 0.75, "faceted": 0.25})
        keys["Normal"] = self.pick({"averaged": 0.7, "master facet": 0.15, "slave": 0.15})
        self.pairs.append(keys)

    def sections(self, unit):
        rng = self.rng
        self.scheme = self.pick({"averaged": 0.5, "nodal": 0.3, "integration point": 0.2})
        if self.shape == "two indenters":
            self.pair(1, 2), self.pair(1, 3)
        else:
            for b in range(1, len(self.grids)):
                self.pair(b, b + 1)
        points = self.scheme == "integration point" or any(p.get("Weights") == "consistent" for p in self.pairs)
        solver = self.pick({"direct": 0.5, "block": 0.25, "condensed": 0.0 if points else 0.25})
        loops = self.pick({"newton": 0.7, "geometry loop": 0.1, "three loops": 0.2})
        fixed = {"newton": (), "geometry loop": LOOPS[:1], "three loops": LOOPS}[loops]

        self.tree["Discretization"] = {"Degree": self.degree}
        for b in range(1, len(self.grids) + 1):
            material = dict(self.laws[b - 1])
            material["Young's modulus"] = self.soft * self.moduli[b - 1]
            self.tree[f"Body {b}"] = {
                "Name": f"body {b}", "Mesh file": self.name + ".msh", "Volume ids": str(b), "Scale": self.size,
                "Rotation axis": ", ".join(f"{a:.15g}" for a in self.axis), "Rotation angle": self.angle,
                "Volumetric treatment": "mean dilatation" if material["Poisson's ratio"] > 0.45 else "standard",
                "Material": material,
            }  # fmt: skip
        self.tree.update({f"Boundary condition {i}": c for i, c in enumerate(self.conditions, 1)})
        self.tree.update({f"Contact pair {i}": p for i, p in enumerate(self.pairs, 1)})
        self.tree.update({f"{loop} loop": {"Mode": "fixed point"} for loop in fixed})
        self.tree["Linear solver"] = {"Type": solver}
        steps = [int(rng.integers(1, 4))]
        if self.drag:  # about a third to a whole cell in an increment
            steps.append(int(np.clip(self.travel / self.cell * rng.uniform(1, 3), 2, 8)))
        self.tree["Load stepping"] = {"Interval ends": "1, 2" if self.drag else "1",
                                      "Increments": ", ".join(map(str, steps))}  # fmt: skip
        self.tree["Output"] = {"Checkpoint interval": 0}
        self.facts = {
            "shape": self.shape, "degree": self.degree, "scheme": self.scheme, "solver": solver, "loops": loops,
            "mu": self.friction, "stiffness upper/lower": self.stiffness_ratio, "strain": self.strain,
            "cells upper/lower": self.mesh_ratio, "gap": self.gap, "cell": self.cell, "size": self.size, "units": unit,
            "driven": self.driven, "drag": self.travel, "curved": self.curved,
            "kind of weights": "consistent" if any(p.get("Weights") == "consistent" for p in self.pairs) else "others",
            "laws": [law["Law"] for law in self.laws[: len(self.grids)]], "cells": sum(self.cells),
            "pairs": self.pairs, "conditions": self.conditions, "turn": self.turn.tolist(),
            "materials": [self.tree[f"Body {b}"]["Material"] for b in range(1, len(self.grids) + 1)],
            "mean dilatation": [self.tree[f"Body {b}"]["Volumetric treatment"] == "mean dilatation"
                                for b in range(1, len(self.grids) + 1)],
        }  # fmt: skip

    def write(self, folder):
        path = common.write_case(os.path.join(folder, self.name), prm(self.tree))
        self.facts["mesh"] = common.write_mesh(os.path.join(folder, self.name), self.grids)
        return path


# Why runs stop, by what their message says; the first that fits counts.
CAUSES = {
    "statuses cycle": "status(es| loop) cycle",
    "geometry cycles": "geometry loop cycles",
    "threshold loop": "threshold loop did",
    "geometry loop": "geometry loop did",
    "status loop": "status loop did",
    "linear solver": "solver: relative residual|singular|MUMPS",
    "cell turned inside out": "turned inside out",
    "Newton": "Newton",
    "input error": "input error",
}


def classify(reason, killed):
    if killed:
        return "time limit"
    if not re.match(r"nodus: (no solution|input error): .{40}", reason):
        return "NOT EXPLAINED"
    return next((cause for cause, words in CAUSES.items() if re.search(words, reason)), "other")


def remedies_used(log):
    """How often each thing was tried where something failed, by name, from the end of a log."""
    line = re.search(r"^Tried where something failed, times: (.*)$", log, re.MULTILINE)
    return {name: int(n) for name, n in re.findall(r"([a-z][a-z ]*?) (\d+)(?:,|$)", line.group(1))} if line else {}


def run(path, results, time_limit, changes=()):
    """Exit code, whether the time limit stopped it, CPU seconds, log."""
    shutil.rmtree(results, ignore_errors=True)
    environment = dict(os.environ, OMP_NUM_THREADS="1")
    # CPU time: what others do on the machine decides nothing. wait4 tells what this child took, also when several run.
    limit = f"ulimit -t {time_limit}; exec \"$@\""
    with open(results + ".log", "w") as log:
        child = subprocess.Popen(["bash", "-c", limit, "nodus", common.NODUS, path, "--set", f"Output/Results folder={results}", *changes],
                                 stdout=log, stderr=subprocess.STDOUT, env=environment)  # fmt: skip
        _, status, usage = os.wait4(child.pid, 0)
        child.returncode = os.waitstatus_to_exitcode(status)
    with open(results + ".log") as log:
        text = log.read()
    return child.returncode, child.returncode in (-signal.SIGKILL, -signal.SIGXCPU), usage.ru_utime + usage.ru_stime, text


def judged(results, code, facts):
    try:
        return checks.check(results, facts)
    except checks.nodus.ResultsError as error:
        return {"violations": [f"unreadable results: {error}"] if code == 0 else [], "measured": {}}


def with_settings(facts, settings):
    """facts of a case with these options of the command line, as far as checks look at them."""
    facts = json.loads(json.dumps(facts))
    for setting in settings[1::2]:
        key, value = setting.split("=", 1)
        if pair := re.fullmatch(r"Contact pair (\d+)/(.*)", key):
            facts["pairs"][int(pair[1]) - 1][pair[2]] = value
            if pair[2] == "Friction coefficient":
                facts["mu"] = float(value)
        elif key.endswith(" loop/Mode") and value != "newton":
            facts["loops"] = "some"
    return facts


def try_advice(path, results, time_limit, facts, settings):
    """What each change that diagnosis.md proposes comes to: the change, and the exit code, or "violated" where it ends well."""
    diagnosis = os.path.join(results, "diagnosis.md")
    if not os.path.exists(diagnosis):
        return []
    with open(diagnosis) as file:
        lines = [line for line in file if line.startswith("--set ")]
    outcomes = []
    for k, line in enumerate(lines, 1):
        folder = f"{results}_advice_{k}"
        changes = shlex.split(line)
        keys = {change.split("=", 1)[0] for change in changes[1::2]}  # each may be given once
        changes += [word for setting in settings[1::2] if setting.split("=", 1)[0] not in keys for word in ("--set", setting)]
        code, _, _, _ = run(path, folder, 3 * time_limit, changes)
        violations = judged(folder, code, with_settings(facts, changes))["violations"]
        outcomes.append((line.strip(), code or ("violated" if violations else 0)))
    return outcomes


def run_case(n, seed, time_limit, increments=None, changes=(), advice=False):
    """Writes, runs and judges a case. changes: of keys (--set). Returns its facts and what came of it."""
    case = RandomCase(seed, n)
    if increments:
        stepping = case.tree["Load stepping"]
        stepping["Increments"] = ", ".join([str(increments)] * (stepping["Interval ends"].count(",") + 1))
    path = case.write("random_cases")
    results = path[: -len(".prm")]
    settings = [word for setting in changes for word in ("--set", setting)]
    code, stopped, cpu, text = run(path, results, time_limit, settings)
    row = {"case": n, **case.facts, "exit": code, "cpu": cpu,
           "cut-backs": text.count("the increment is halved"), "fallbacks": text.count(" given up: "),
           "used": remedies_used(text),
           "lost": text.count("have no master point any more")}  # fmt: skip
    row["reason"] = text.strip().splitlines()[-1] if code else ""
    if code:
        row["cause"] = classify(row["reason"], stopped)
        row["advice"] = try_advice(path, results, time_limit, case.facts, settings) if advice else []
    row.update(judged(results, code, with_settings(case.facts, settings)))
    if os.path.exists(os.path.join(results, "convergence.csv")):
        row["iterations"] = int((common.nodus.Results(results).convergence["iteration"] != 0).sum())
    return row


def summary(rows):
    finished = [r for r in rows if r["exit"] == 0]
    causes = collections.Counter(r["cause"] for r in rows if r["exit"] != 0)
    lines = [("cases", len(rows)),
             ("finished", f"{len(finished)} ({100 * len(finished) / len(rows):.1f} %)"),
             ("stopped with a message, by cause", ", ".join(f"{c}: {k}" for c, k in causes.items()) or "none"),
             ("cases that violate a check", sum(bool(r["violations"]) for r in rows)),
             ("CPU s, sum / median / largest", " / ".join(f"{f([r['cpu'] for r in rows]):.1f}"
                                                          for f in (sum, np.median, max))),
             ("increments cut back / cases with one",
              f"{sum(r['cut-backs'] for r in rows)} / {sum(r['cut-backs'] > 0 for r in rows)}"),
             ("fallbacks to loops / cases with one",
              f"{sum(r['fallbacks'] for r in rows)} / {sum(r['fallbacks'] > 0 for r in rows)}"),
             *((f"{name}: times / cases", f"{sum(r['used'].get(name, 0) for r in rows)} / {sum(name in r['used'] for r in rows)}")
               for name in sorted({name for r in rows for name in r["used"]})),
             ("cases with closed nodes that lost their master point", sum(r["lost"] > 0 for r in rows)),
             ("stopped cases with advice / of them finished by some / by the first",
              " / ".join(str(sum(map(helps, (r.get("advice", []) for r in rows))))
                         for helps in (bool, lambda a: any(o == 0 for _, o in a), lambda a: bool(a) and a[0][1] == 0)))]  # fmt: skip
    print("\n| | |\n|---|---|")
    for name, value in lines:
        print(f"| {name} | {value} |")
    print("\n| | cases | finished | cut-backs | fallbacks | Newton iterations |\n|---|---|---|---|---|---|")
    for key in ("scheme", "degree", "loops", "solver", "shape", "kind of weights"):
        for value in sorted({r[key] for r in rows}, key=str):
            part = [r for r in rows if r[key] == value]
            print(f"| {key} {value} | {len(part)} | {sum(r['exit'] == 0 for r in part)} | "
                  f"{sum(r['cut-backs'] for r in part)} | {sum(r['fallbacks'] for r in part)} | "
                  f"{sum(r.get('iterations', 0) for r in part)} |")  # fmt: skip
    tried = [(change, outcome) for r in rows for change, outcome in r.get("advice", [])]
    if tried:
        outcomes = collections.defaultdict(list)
        for change, outcome in tried:
            outcomes[re.sub(r" \d+/", " <n>/", re.search(r'"([^=]*)=', change)[1])].append(outcome)
        print("\n| advice | tried | finishes | of these beyond a check |\n|---|---|---|---|")
        for key, found in sorted(outcomes.items(), key=lambda item: -len(item[1])):
            print(f"| {key} | {len(found)} | {sum(o in (0, 'violated') for o in found)} | {found.count('violated')} |")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--cases", type=int, default=200)
    parser.add_argument("--only", type=int, nargs="+", help="numbers of cases")
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--time-limit", type=int, default=60, help="CPU seconds of one case")
    parser.add_argument("--advice", action="store_true", help="try what diagnosis.md proposes")
    parser.add_argument("--increments", type=int, help="of each interval, in the place of random ones")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", help="of all cases")
    parser.add_argument("--write", action="store_true", help="only write the cases")
    options = parser.parse_args()
    numbers = options.only or range(1, options.cases + 1)
    os.makedirs(os.path.join(common.SCRATCH, "random_cases"), exist_ok=True)
    if options.write:
        for n in numbers:
            print(RandomCase(options.seed, n).write("random_cases"))
        return
    rows = []
    # processes: OpenBLAS without threads of its own, on which checks stand, is not safe to call from several
    with concurrent.futures.ProcessPoolExecutor(options.jobs) as pool:
        one = functools.partial(run_case, seed=options.seed, time_limit=options.time_limit, increments=options.increments,
                                changes=options.set, advice=options.advice)  # fmt: skip
        for row in pool.map(one, numbers):
            rows.append(row)
            state = "finished" if row["exit"] == 0 else f"exit {row['exit']} ({row['cause']})"
            print(f"{row['case']:4d} {row['shape']}, {row['scheme']}, degree {row['degree']}, mu {row['mu']}, {row['loops']}, "
                  f"{row['solver']}: {state}, {row['cpu']:.1f} CPU s, {row['cut-backs']} cut-backs, "
                  f"{row['fallbacks']} fallbacks", *row["violations"], sep="\n       ! " if row["violations"] else "",
                  flush=True)  # fmt: skip
            with open(os.path.join(common.SCRATCH, "random_cases", f"results_seed_{options.seed}.json"), "w") as file:
                json.dump(rows, file, indent=1)
    summary(rows)
    if any(r["violations"] or r.get("cause") == "NOT EXPLAINED" for r in rows):
        raise SystemExit("not as it should be")


if __name__ == "__main__":
    main()
