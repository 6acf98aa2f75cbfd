"""What the tests of contrib/convert share: runs of it, what it prints and writes, and comparisons."""

import os
import re
import subprocess
import sys

import numpy as np

SOURCE = os.path.abspath(sys.argv[1])
TOOL = os.path.join(SOURCE, "contrib", "convert")
failures = []


def check(what, value, reference, tolerance=0.):
    """Prints a number or text beside what it should be."""
    if isinstance(value, str) or value is None:
        good = value == reference
        print(f"{what}: {value}" + ("" if good else f"   NO, should be {reference}"))
    else:
        good = abs(value - reference) <= tolerance * abs(reference)
        print(f"{what}: {value:.8g} for {reference:.8g}" + (f" within {tolerance:g}" if tolerance else "")
              + ("" if good else "   NO"))
    if not good:
        failures.append(what)


class Result:
    """What the tool has printed and written: `volumes` and `surfaces` are name -> (id, number, measure)."""

    def __init__(self, name, text, *options, ending=".inp"):
        with open(name + ending, "w", encoding="utf-8") as file:
            file.write(text)
        done = subprocess.run([TOOL, name + ending, name + ".msh" if ending != ".msh" else name + "_out.msh", *options],
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, check=False)
        self.file, self.code, self.error, self.log = name + ".msh", done.returncode, done.stderr.strip(), done.stdout
        if ending == ".msh":
            self.file = name + "_out.msh"
        parts = re.split(r"\n *(?:Volume|Boundary) id .*\n", self.log + "\n")
        self.volumes, self.surfaces = ([self._rows(part) for part in parts[1:]] + [{}, {}])[:2]

    @staticmethod
    def _rows(text):
        rows = {}
        for line in text.splitlines():
            found = re.fullmatch(r" *(\d+)  (.*?)  +(\d+)  +([\d.e+-]+)  .*", line)
            if found:
                rows[found.group(2)] = (int(found.group(1)), int(found.group(3)), float(found.group(4)))
        return rows

    def mesh(self):
        """(points, [(dimension, rows of nodes from 0)]) of the file."""
        with open(self.file, encoding="utf-8") as file:
            lines = file.read().splitlines()
        at = lines.index("$Nodes") + 3
        n = int(lines[at - 1].split()[3])
        points = np.array([line.split() for line in lines[at + n:at + 2 * n]], float)
        at, blocks = lines.index("$Elements") + 2, []
        while lines[at] != "$EndElements":
            dimension, _, _, count = map(int, lines[at].split())
            blocks.append((dimension, np.array([line.split()[1:] for line in lines[at + 1:at + 1 + count]], int) - 1))
            at += 1 + count
        return points, blocks

    def outer_faces(self):
        """Number of the faces of one hexahedron: more than the surfaces have where cells do not fit together."""
        faces = {}
        for dimension, rows in self.mesh()[1]:
            for cell in rows if dimension == 3 else ():
                for face in ("0123", "4567", "0154", "1265", "2376", "3047"):
                    key = tuple(sorted(cell[[int(c) for c in face]]))
                    faces[key] = faces.get(key, 0) + 1
        return sum(count == 1 for count in faces.values())

    def check_fit(self, what):
        check(f"{what}, faces of one cell", self.outer_faces(), sum(row[1] for row in self.surfaces.values()))


def refused(what, expected, text, *options, ending=".inp"):
    """One message, exit code 1, nothing written."""
    result = Result("wrong", text, *options, ending=ending)
    check(what, result.error, "convert: " + expected)
    left = sorted(name for name in os.listdir(".") if name.startswith("wrong") and name != "wrong" + ending)
    check(f"{what}, exit code {result.code}, files", str((result.code, left)), "(1, [])")
    os.remove("wrong" + ending)
