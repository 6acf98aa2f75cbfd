#!/usr/bin/python3
"""Runs the Python script of README.md as it stands there, and compares what it finds with Hertz (Johnson, Contact Mechanics,
1985, ch. 4)."""

import os
import re
import sys

import numpy as np

from harness import NODUS, SOURCE, check, run

PNG = b"\x89PNG"


def test_script_of_the_README():
    with open(os.path.join(SOURCE, "README.md"), encoding="utf-8") as file:
        scripts = re.findall(r"^```python\n(.*?)^```$", file.read(), re.M | re.S)
    check("scripts", len(scripts), 1)
    check("at most 30 lines", len(scripts[0].splitlines()) <= 30, True)
    os.environ["NODUS"] = NODUS
    names = {}
    exec(compile(scripts[0], "README.md", "exec"), names)  # what a user does
    results, force = names["results"], names["F"]
    stiffness = names["E"] / (1 - names["nu"] ** 2)
    radius = (3 * 4 * force * names["R"] / (4 * stiffness)) ** (1 / 3)
    check("exit code", results.code, 0)
    check("force on the block", -results.contact[-1]["slave force z"], force, 1e-6)
    check("largest pressure (Hertz)", results.contact[-1]["maximum pressure"], 3 * 4 * force / (2 * np.pi * radius**2), 0.03)
    check("penetration (Hertz)", -results.rigid_bodies[-1]["translation z"], radius**2 / names["R"], 0.05)
    check("ranks", results.log.count("2 processes") > 0, True)
    for name in ("force.png", "pressure.png"):
        with open(name, "rb") as file:
            check(name, file.read(4) == PNG and os.path.getsize(name) > 5000, True)
    check("pyplot is loaded", "matplotlib.pyplot" in sys.modules, False)


run(test_script_of_the_README)
