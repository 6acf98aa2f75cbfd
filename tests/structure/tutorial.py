#!/usr/bin/env python3
"""Holds contrib/doc/tutorial.md against the program: tutorial.py <source folder> <nodus>

Blocks without a language are lines of meshes/lug.geo or prm/lug.prm. Of the console blocks each `$ nodus ...` with output below it is
run, and must say that, whatever the line breaks are; `...` stands for what is left out.
"""

import pathlib
import re
import shlex
import subprocess
import sys
import tempfile

SOURCE, NODUS = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]).resolve()


def one_line(text):
    return " ".join(text.split())


def meshes(folder):
    """The case, and the meshes of the mistakes, where the tutorial has them."""
    for name in ("prm/lug.prm", "meshes/lug.msh"):
        (folder / name).parent.mkdir()
        (folder / name).write_bytes((SOURCE / name).read_bytes())
    geometry = (SOURCE / "meshes/lug.geo").read_text()
    straight = re.sub(r"Mesh\.(ElementOrder|SecondOrder).*\n", "", geometry)
    for name, text, dimension in (("tetrahedra", re.sub(r"Recombine Surface.*\n|Recombine; ", "", geometry), "-3"),
                                  ("flat", geometry, "-2"), ("first_order", straight, "-3")):
        (folder / f"{name}.geo").write_text(text)
        subprocess.run(["gmsh", dimension, "-v", "1", folder / f"{name}.geo", "-o", folder / "prm" / f"{name}.msh"], check=True)


def quoted(block, files):
    """Whether a block stands in one of the files, wherever its lines begin."""
    lines = [line.strip() for line in block.strip().splitlines()]
    for text in files:
        there = [line.strip() for line in text.splitlines()]
        if any(there[i:i + len(lines)] == lines for i in range(len(there))):
            return True
    return False


def say(command, expected, folder):
    """What of @p expected the command does not say, or None."""
    made = subprocess.run([NODUS, *shlex.split(command)[1:]], cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    rest = one_line(made.stdout)
    for part in re.split(r"(?:^|\s)\.\.\.(?=\s|$)", expected):
        part = one_line(part)
        if part not in rest:
            return f"$ {command}\ndoes not say: {part}\nbut:\n{made.stdout}"
        rest = rest[rest.index(part) + len(part):]
    return None


page = (SOURCE / "contrib/doc/tutorial.md").read_text(encoding="utf-8")
blocks = re.findall(r"^```(\w*)\n(.*?)^```", page, re.MULTILINE | re.DOTALL)
files = [(SOURCE / name).read_text() for name in ("meshes/lug.geo", "prm/lug.prm")]
faults = [f"not in lug.geo or lug.prm:\n{block}" for language, block in blocks if not language and not quoted(block, files)]
runs = 0
with tempfile.TemporaryDirectory() as folder:
    folder = pathlib.Path(folder)
    meshes(folder)
    for language, block in blocks:
        for command, expected in re.findall(r"^\$ (.*)\n((?:(?!\$ ).*\n)*)", block, re.MULTILINE) if language == "console" else []:
            if command.startswith("nodus ") and expected.strip():
                faults.append(say(command, expected, folder))
                runs += 1
faults = [fault for fault in faults if fault]
print("\n\n".join(faults) or f"{runs} commands say what the tutorial says that they say.")
sys.exit(1 if faults or runs < 14 else 0)
