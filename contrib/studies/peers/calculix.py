"""A case of nodus as a deck of CalculiX on the same mesh, and its run: what the cases of the gallery need, and no more.

Bodies are deformable, linear elastic or of Mooney-Rivlin's law with ratio 0, which is CalculiX' neo-Hookean law; conditions are displacements
that depend on the time alone; surfaces are those that nodus finds (`--validate --surfaces`). What else a case has is refused.
"""

import os
import re
import resource
import subprocess
import sys

import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.dirname(HERE))
import common  # noqa: E402
from common import nodus  # noqa: E402

# One thread for each program, that of nodus among them.
os.environ.update(dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "CCX_NPROC_STIFFNESS", "CCX_NPROC_RESULTS",
                                 "CCX_NPROC_EQUATION_SOLVER"), "1"))  # fmt: skip

# Nodes of an element as positions in the lattice of nodes, in their order; the first eight are the corners.
_CORNERS = "000 100 110 010 001 101 111 011".split()
_EDGES = [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7)]
# Corners of the faces S1 to S6.
_FACES = [(0, 1, 2, 3), (4, 7, 6, 5), (0, 4, 5, 1), (1, 5, 6, 2), (2, 6, 7, 3), (3, 7, 4, 0)]
ELEMENTS = {1: "C3D8", 2: "C3D20R"}


class Unsupported(Exception):
    """What the deck cannot say."""


def listed(value, separator):
    """The entries, as texts, of a key that is a list, or a text that says one."""
    return [str(entry) for entry in (value if isinstance(value, (list, tuple)) else str(value).split(separator))]


def _element_nodes(cells):
    """Rows of point numbers in the order of CalculiX, of cells (n, nodes per direction, ...)."""
    degree = cells.shape[1] - 1
    places = [np.array([int(c) for c in corner]) * degree for corner in _CORNERS]
    if degree == 2:
        places += [(places[a] + places[b]) // 2 for a, b in _EDGES]
    return np.stack([cells[:, k, j, i] for i, j, k in places], axis=1)


class Deck:
    """The text of a deck. stiffness: of the contact, pressure over overlap; stick: shear over slip in sticking contact."""

    def __init__(self, path, sets, stiffness, stick, folder):
        self.case = nodus.Case.read(path, program=common.program())
        for key, value in sets.items():
            self.case[key] = self.case.reference[key].value(value)
        self.stiffness, self.stick = stiffness, stick
        self.lines = []
        self._mesh(path, sets, folder)
        self._surfaces(path, sets, folder)
        self._materials()
        self._contact()
        self._steps()
        self.text = "\n".join(self.lines) + "\n"

    def _numbered(self, name):
        return {int(key.split()[-1]): self.case[key] for key in self.case if re.fullmatch(name + r" \d+", key)}

    def _mesh(self, path, sets, folder):
        """Of the fields at the start of a run that ends there."""
        start = {**sets, "Output/Results folder": os.path.join(folder, "mesh"), "Load stepping/Interval ends": 1e-9,
                 "Load stepping/Increments": 1, "Output/Checkpoint interval": 0}  # fmt: skip
        run = common.program().run(path, sets=start, check=False)
        self.mesh = run.bodies(0.0)
        nodes = _element_nodes(self.mesh.cells)
        self.used, rows = np.unique(nodes, return_inverse=True)
        self.elements = rows.reshape(nodes.shape) + 1
        self.body = self.mesh.fields["body"][nodes[:, 0]].round().astype(int)
        self.points = self.mesh.reference[self.used]
        self.n_unknowns = 3 * len(self.used)
        self.lines += ["*NODE, NSET=ALL"] + ["%d, %.12g, %.12g, %.12g" % (i, *x) for i, x in enumerate(self.points, 1)]
        kind = ELEMENTS[self.mesh.cells.shape[1] - 1]
        for body in np.unique(self.body):
            self.lines.append(f"*ELEMENT, TYPE={kind}, ELSET=BODY{body}")
            for e in np.flatnonzero(self.body == body):
                text = ", ".join(map(str, [e + 1, *self.elements[e]]))
                self.lines.append(re.sub(r"((?:\d+, ){15})", r"\1\n", text, count=1) if kind != "C3D8" else text)

    def _surfaces(self, path, sets, folder):
        """Element faces and nodes of the roles that faces have: "boundary condition 1 (...), ..." and the like."""
        file = os.path.join(folder, "surfaces.vtu")
        common.program().validate(path, sets=sets, surfaces=file)
        outside = nodus.read_mesh(file)
        number = {self._key(x, b): n for n, (x, b) in enumerate(zip(self.points, self._node_bodies()), 1)}
        body = outside.cell_fields["body"].round().astype(int)
        ends = outside.cells[:, [0, 0, -1, -1], [0, -1, -1, 0]]
        corners = [frozenset(number[self._key(x, b)] for x in outside.points[face]) for face, b in zip(ends, body)]
        sides = {frozenset(element[list(face)]): (e, s) for e, element in enumerate(self.elements, 1)
                 for s, face in enumerate(_FACES, 1)}  # fmt: skip
        self.faces = {}
        for role, chosen in outside.cell_fields.items():
            if role not in ("body", "boundary_id"):
                self.faces[role] = [sides[corners[f]] for f in np.flatnonzero(chosen > 0.5)]

    @staticmethod
    def _key(x, body):
        return (*np.float32(x), int(body))

    def _node_bodies(self):
        return self.mesh.fields["body"][self.used].round().astype(int)

    def _nodes_of(self, faces):
        nodes = set()
        for e, s in faces:
            element, corners = self.elements[e - 1], _FACES[s - 1]
            nodes.update(element[list(corners)])
            if len(element) > 8:
                nodes.update(element[8 + i] for i, edge in enumerate(_EDGES) if set(edge) <= set(corners))
        return sorted(nodes)

    def _role(self, begin):
        found = [faces for role, faces in self.faces.items() if re.match(begin, role)]
        if len(found) != 1:
            raise Unsupported(f"roles {sorted(self.faces)} have not one that begins with '{begin}'")
        return found[0]

    def _materials(self):
        for number, body in self._numbered("Body").items():
            material = body["Material"]
            modulus, ratio, law = material["Young's modulus"], material.get("Poisson's ratio", 0.3), material["Law"]
            self.lines.append(f"*MATERIAL, NAME=MATERIAL{number}")
            if law == "linear elastic":
                self.lines += ["*ELASTIC", f"{modulus}, {ratio}"]
            elif law == "Mooney-Rivlin" and material.get("Mooney-Rivlin ratio", 0) == 0:
                shear, bulk = modulus / (2 * (1 + ratio)), modulus / (3 * (1 - 2 * ratio))
                self.lines += ["*HYPERELASTIC, NEO HOOKE", f"{shear / 2:.12g}, {2 / bulk:.12g}"]
            else:
                raise Unsupported(f"law {law} of body {number}")
            self.lines.append(f"*SOLID SECTION, ELSET=BODY{number}, MATERIAL=MATERIAL{number}")

    def _contact(self):
        for number, pair in self._numbered("Contact pair").items():
            for side in ("slave", "master"):
                faces = self._role(rf"contact pair {number}\b.*{side}")
                self.lines += [f"*SURFACE, NAME={side.upper()}{number}, TYPE=ELEMENT", *(f"{e}, S{s}" for e, s in faces)]
            self.lines += [f"*SURFACE INTERACTION, NAME=CONTACT{number}", "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR",
                           f"{self.stiffness:.8g}"]  # fmt: skip
            friction = pair.get("Friction coefficient", 0)
            if friction:
                self.lines += ["*FRICTION", f"{friction}, {self.stick:.8g}"]
            self.lines += [f"*CONTACT PAIR, INTERACTION=CONTACT{number}, TYPE=SURFACE TO SURFACE", f"SLAVE{number}, MASTER{number}"]

    def _steps(self):
        """One for each interval; what changes is a table over the time at the ends of nodus's increments."""
        load = self.case["Load stepping"]
        ends, counts = np.atleast_1d(load["Interval ends"]), np.atleast_1d(load["Increments"]).astype(int)
        begins = np.concatenate([[0.0], ends[:-1]])
        times = np.unique(np.concatenate([np.linspace(a, b, n + 1) for a, b, n in zip(begins, ends, counts)]))
        fixed, moved, prints = ["*BOUNDARY"], [], []
        for number, condition in self._numbered("Boundary condition").items():
            if condition.get("Type", "displacement") != "displacement":
                raise Unsupported(f"boundary condition {number} is no displacement")
            name = f"CONDITION{number}"
            self.lines += [f"*NSET, NSET={name}"] + [f"{n}," for n in self._nodes_of(self._role(rf"boundary condition {number}\b"))]
            prints += [f"*NODE PRINT, NSET={name}, TOTALS=ONLY", "RF"]
            values = listed(condition["Value"], ";")
            for i, component in enumerate(listed(condition["Components"], ",")):
                axis = "xyz".index(component.strip()) + 1
                text = values[i if len(values) > 1 else 0]
                history = np.array([float(nodus.evaluate(text, {"t": t})) for t in times])
                if not history.any():
                    fixed.append(f"{name}, {axis}, {axis}")
                    continue
                self.lines.append(f"*AMPLITUDE, NAME=A{number}{axis}, TIME=TOTAL TIME")
                self.lines += [f"{t:.12g}, {value:.12g}" for t, value in zip(times, history)]
                moved += [f"*BOUNDARY, AMPLITUDE=A{number}{axis}", f"{name}, {axis}, {axis}, 1"]
        self.lines += fixed
        for begin, end, count in zip(begins, ends, counts):
            step = (end - begin) / count
            self.lines += ["*STEP, NLGEOM, INC=10000", "*STATIC", f"{step:.10g}, {end - begin:.10g}, {1e-6 * step:.3g}, {step:.10g}",
                           *moved, *prints, "*END STEP"]  # fmt: skip


def _forces(path):
    """condition -> rows (time, x, y, z)."""
    rows, lines = {}, iter(open(path, encoding="utf-8").read().splitlines())
    for line in lines:
        found = re.search(r"for set CONDITION(\d+) and time +(\S+)", line)
        if found:
            text = next(value for value in lines if value.strip())
            rows.setdefault(int(found.group(1)), []).append([float(found.group(2)), *map(float, text.split())])
    return {number: np.array(values) for number, values in rows.items()}


def run(path, sets, stiffness, stick, folder, time_limit=3600):
    """Writes and runs the deck in a folder, on one thread. Returns {"finished", "time", "increments", "iterations", "cut-backs",
    "cpu" s, "memory" MiB, "unknowns", "forces": condition -> rows (time, x, y, z)}; deck.log has what CalculiX says."""
    os.makedirs(folder, exist_ok=True)
    deck = Deck(path, sets, stiffness, stick, folder)
    for name in os.listdir(folder):
        if name.startswith("deck."):
            os.remove(os.path.join(folder, name))
    with open(os.path.join(folder, "deck.inp"), "w", encoding="utf-8") as file:
        file.write(deck.text)
    limit = lambda: resource.setrlimit(resource.RLIMIT_CPU, (time_limit, time_limit + 5))  # noqa: E731
    with open(os.path.join(folder, "deck.log"), "w", encoding="utf-8") as log:
        child = subprocess.Popen([os.environ.get("CCX", "ccx"), "deck"], cwd=folder, stdout=log, stderr=subprocess.STDOUT,
                                 preexec_fn=limit)  # fmt: skip
        _, status, usage = os.wait4(child.pid, 0)
    child.returncode = os.waitstatus_to_exitcode(status)
    rows = np.loadtxt(os.path.join(folder, "deck.sta"), skiprows=2, usecols=(2, 4), dtype=str, ndmin=2)
    failed = np.char.endswith(rows[:, 0], "U")  # of the attempts
    iterations = np.loadtxt(os.path.join(folder, "deck.cvg"), skiprows=4, usecols=0, dtype=int, ndmin=1)
    with open(os.path.join(folder, "deck.log"), encoding="utf-8", errors="replace") as log:
        finished = child.returncode == 0 and "Job finished" in log.read()
    return {
        "finished": finished,
        "time": float(rows[~failed, 1][-1]) if not failed.all() else 0.0,
        "increments": int(np.count_nonzero(~failed)),
        "iterations": len(iterations),
        "cut-backs": int(np.count_nonzero(failed)),
        "cpu": usage.ru_utime + usage.ru_stime,
        "memory": usage.ru_maxrss / 1024,
        "unknowns": deck.n_unknowns,
        "forces": _forces(os.path.join(folder, "deck.dat")),
    }
