#!/usr/bin/python3
"""pip, in a virtual environment and without a network, installs the package; it is found there and finds the program."""

import os
import re
import shutil
import subprocess
import sys

from harness import NODUS, SOURCE, check, run

SCRIPT = """import nodus
print(nodus.__file__)
case = nodus.Case("installed")
case["Body 1/Generator"] = "hyper_cube"
print(case.program.path, len(case.reference.keys) > 100)
"""


def output(*command, **options):
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False, **options)
    if done.returncode != 0:
        print(done.stdout)
    check(" ".join(map(os.path.basename, command[:3])) + ", exit code", done.returncode, 0)
    return done.stdout


def test_pip():
    shutil.copytree(os.path.join(SOURCE, "contrib", "python"), "source")  # pip builds in it
    # numpy and setuptools are those of the system
    output(sys.executable, "-m", "venv", "--system-site-packages", "environment")
    output("environment/bin/pip", "install", "--no-index", "--no-build-isolation", "--disable-pip-version-check", "./source")
    with open("script.py", "w", encoding="utf-8") as file:
        file.write(SCRIPT)
    environment = {name: value for name, value in os.environ.items() if not name.startswith("PYTHON")}
    lines = output("environment/bin/python", "script.py", env={**environment, "NODUS": NODUS}).splitlines()
    with open(os.path.join(SOURCE, "include/nodus/base/version.h"), encoding="utf-8") as file:
        version = re.search(r'define NODUS_VERSION "(.+)"', file.read()).group(1)
    told = output("environment/bin/pip", "show", "nodus")
    check("version", re.search("^Version: (.*)$", told, re.M).group(1), version)
    here = os.path.realpath("environment")
    check("found where it was installed", [os.path.realpath(lines[0]).startswith(here + os.sep)] + lines[1:],
          [True, f"{NODUS} True"])
    names = sorted(name for name in os.listdir(os.path.dirname(lines[0])) if not name.startswith("__pycache__"))
    check("all of its files", names, sorted(name for name in os.listdir(os.path.join(SOURCE, "contrib", "python", "nodus"))
                                            if not name.startswith("__pycache__")))


run(test_pip)
