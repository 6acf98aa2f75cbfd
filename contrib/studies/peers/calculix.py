"""A case of nodus as a deck of CalculiX on the same mesh, and its run: what plain_case takes, and no more."""

import os
import re

import numpy as np
from plain_case import limited

ELEMENTS = {1: "C3D8", 2: "C3D20R"}
# By mortar: of nodes that cannot be fixed, and of sticking contact, in the largest Young's modulus times or over a unit of length.
SPRING = 1e4


class Deck:
    """The text of a deck. stiffness: of the contact, pressure over overlap; stick: shear over slip in sticking contact; without them
    contact is hard, by mortar. solver: of linear systems, as CalculiX names it."""

    def __init__(self, case, stiffness=None, stick=None, solver="SPOOLES"):
        self.case, self.stiffness, self.stick, self.solver = case, stiffness, stick, solver
        self.lines = []
        self._mesh()
        self._materials()
        self._contact()
        self._steps()
        self.text = "\n".join(self.lines) + "\n"

    def _mesh(self):
        self.lines += ["*NODE, NSET=ALL"] + ["%d, %.12g, %.12g, %.12g" % (i, *self.case.points[i - 1]) for i in np.unique(self.case.elements)]
        kind = ELEMENTS[self.case.degree]
        for body in np.unique(self.case.body):
            self.lines.append(f"*ELEMENT, TYPE={kind}, ELSET=BODY{body}")
            for e in np.flatnonzero(self.case.body == body):
                text = ", ".join(map(str, [e + 1, *self.case.elements[e]]))
                self.lines.append(re.sub(r"((?:\d+, ){15})", r"\1\n", text, count=1) if kind != "C3D8" else text)

    def _materials(self):
        for number, (linear, modulus, ratio) in self.case.laws().items():
            self.lines.append(f"*MATERIAL, NAME=MATERIAL{number}")
            if linear:
                self.lines += ["*ELASTIC", f"{modulus}, {ratio}"]
            else:
                shear, bulk = modulus / (2 * (1 + ratio)), modulus / (3 * (1 - 2 * ratio))
                self.lines += ["*HYPERELASTIC, NEO HOOKE", f"{shear / 2:.12g}, {2 / bulk:.12g}"]
            self.lines.append(f"*SOLID SECTION, ELSET=BODY{number}, MATERIAL=MATERIAL{number}")

    def _contact(self):
        for number, (slave, master, friction) in self.case.pairs().items():
            for side, faces in (("SLAVE", slave), ("MASTER", master)):
                self.lines += [f"*SURFACE, NAME={side}{number}, TYPE=ELEMENT", *(f"{e}, S{s}" for e, s in faces)]
            self.lines.append(f"*SURFACE INTERACTION, NAME=CONTACT{number}")
            if self.stiffness:
                self.lines += ["*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR", f"{self.stiffness:.8g}"]
            if friction:
                self.lines += ["*FRICTION", f"{friction}, {self.stick or SPRING * self._stiffest():.8g}"]
            kind = "SURFACE TO SURFACE" if self.stiffness else "MORTAR"
            self.lines += [f"*CONTACT PAIR, INTERACTION=CONTACT{number}, TYPE={kind}", f"SLAVE{number}, MASTER{number}"]

        for number, sides in self.case.ties().items():
            for side, faces in zip(("SLAVE", "MASTER"), sides):
                self.lines += [f"*SURFACE, NAME={side}{number}, TYPE=ELEMENT", *(f"{e}, S{s}" for e, s in faces)]
            self.lines += [f"*TIE, NAME=TIE{number}", f"SLAVE{number}, MASTER{number}"]

    def _stiffest(self):
        return max(modulus for _, modulus, _ in self.case.laws().values())

    def _springs(self):
        """Mortar contact is singular at slave nodes with more than one fixed component: springs hold the others. Returns them as (node, axis)."""
        if self.stiffness:
            return set()
        first, found = {}, set()
        slaves = {node for slave, _, _ in self.case.pairs().values() for node in self.case.nodes_of(slave)}
        for faces, components in self.case.conditions().values():
            for node in slaves.intersection(self.case.nodes_of(faces)):
                found |= {(node, c + 1) for c, history in components if first.setdefault(node, c) != c and not history.any()}
        stiffness, number = SPRING * self._stiffest(), len(self.case.elements)
        for axis in sorted({axis for _, axis in found}):
            self.lines.append(f"*ELEMENT, TYPE=SPRING1, ELSET=SPRINGS{axis}")
            for node in sorted(node for node, other in found if other == axis):
                number += 1
                self.lines.append(f"{number}, {node}")
            self.lines += [f"*SPRING, ELSET=SPRINGS{axis}", f"{axis}", f"{stiffness:.6e}"]
        return found

    def _steps(self):
        """One for each interval; what changes is a table over the time at the ends of nodus's increments."""
        fixed, moved, prints, springs = ["*BOUNDARY"], [], [], self._springs()
        for number, (faces, components) in self.case.conditions().items():
            name = f"CONDITION{number}"
            self.lines += [f"*NSET, NSET={name}"] + [f"{n}," for n in self.case.nodes_of(faces)]
            prints += [f"*NODE PRINT, NSET={name}, TOTALS=ONLY", "RF"]
            for component, history in components:
                axis = component + 1
                if not history.any():
                    nodes = self.case.nodes_of(faces)
                    held = any((node, axis) in springs for node in nodes)
                    fixed += [f"{node}, {axis}, {axis}" for node in nodes if (node, axis) not in springs] if held else [f"{name}, {axis}, {axis}"]
                    continue
                self.lines.append(f"*AMPLITUDE, NAME=A{number}{axis}, TIME=TOTAL TIME")
                self.lines += [f"{t:.12g}, {value:.12g}" for t, value in zip(self.case.times(), history)]
                moved += [f"*BOUNDARY, AMPLITUDE=A{number}{axis}", f"{name}, {axis}, {axis}, 1"]
        if self.case.probe:
            self.lines += ["*NSET, NSET=CONDITION0", f"{self.case.probe},"]
            prints += ["*NODE PRINT, NSET=CONDITION0", "U"]
        self.lines += fixed
        for begin, end, count in self.case.intervals():
            step = (end - begin) / count
            self.lines += ["*STEP, NLGEOM, INC=10000", f"*STATIC, SOLVER={self.solver}", f"{step:.10g}, {end - begin:.10g}, {1e-6 * step:.3g}, {step:.10g}",
                           *moved, *prints, "*NODE PRINT, NSET=ALL", "U", "*END STEP"]  # fmt: skip


def _forces(path):
    """condition -> rows (time, x, y, z)."""
    rows, lines = {}, iter(open(path, encoding="utf-8").read().splitlines())
    for line in lines:
        found = re.search(r" set CONDITION(\d+) and time +(\S+)", line)
        if found:
            text = next(value for value in lines if value.strip())
            rows.setdefault(int(found.group(1)), []).append([float(found.group(2)), *map(float, text.split()[-3:])])
    return {number: np.array(values) for number, values in rows.items()}


def _displacements(path, n):
    """Of all nodes (n, 3) in the last increment, or None."""
    found, inside = None, False
    with open(path, encoding="utf-8") as file:
        for line in file:
            if " for set " in line:
                inside = "for set ALL and" in line
                if inside:
                    found = np.zeros((n, 3))
            elif inside and line.strip():
                number, *values = line.split()
                found[int(number) - 1] = list(map(float, values))
    return found


def run(case, stiffness, stick, folder, time_limit=3600, solver="SPOOLES"):
    """Writes and runs the deck in a folder, on one thread; without stiffness by mortar, which takes SPOOLES alone. Returns {"finished", "time", "increments",
    "iterations", "cut-backs", "cpu" s, "memory" MiB, "forces": condition -> rows (time, x, y, z), "displacements": of the points at the end, where it
    finished with cells that have all of them, those of degree 1}; deck.log has what CalculiX says."""
    os.makedirs(folder, exist_ok=True)
    deck = Deck(case, stiffness, stick, solver)
    for name in os.listdir(folder):
        if name.startswith("deck."):
            os.remove(os.path.join(folder, name))
    with open(os.path.join(folder, "deck.inp"), "w", encoding="utf-8") as file:
        file.write(deck.text)
    code, use = limited([os.environ.get("CCX", "ccx"), "deck"], "deck.log", folder, time_limit)
    with open(os.path.join(folder, "deck.sta"), encoding="utf-8") as file:
        rows = np.array([[line.split()[2], line.split()[4]] for line in file.readlines()[2:]]).reshape(-1, 2)
    failed = np.char.endswith(rows[:, 0], "U")  # of the attempts
    with open(os.path.join(folder, "deck.cvg"), encoding="utf-8") as file:
        iterations = len(file.readlines()[4:])
    with open(os.path.join(folder, "deck.log"), encoding="utf-8", errors="replace") as log:
        finished = code == 0 and "Job finished" in log.read()
    return {
        "finished": finished,
        "time": float(rows[~failed, 1][-1]) if not failed.all() else 0.0,
        "increments": int(np.count_nonzero(~failed)),
        "iterations": iterations,
        "cut-backs": int(np.count_nonzero(failed)),
        **use,
        "forces": _forces(os.path.join(folder, "deck.dat")),
        "displacements": _displacements(os.path.join(folder, "deck.dat"), len(case.points)) if finished and case.degree == 1 else None,
    }
