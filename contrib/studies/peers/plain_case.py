"""A case of nodus as other programs can take it: mesh, surfaces, laws, displacements and pairs, and no more.

Bodies are deformable, linear elastic or of Mooney-Rivlin's law with ratio 0; conditions are displacements that depend on the time alone; surfaces
are those that nodus finds (`--validate --surfaces`), free or tied. What else a case has is refused. Histories of forces are by the number of a condition; 0
stands for the displacements of one node, `probe`, where it is asked for.
"""

import json
import os
import re
import sys

import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.dirname(HERE))
import common  # noqa: E402
from common import nodus  # noqa: E402

sys.path.insert(0, os.path.join(common.FOLDER, "scaling"))
from hertz_case import measured  # noqa: E402

# One thread for each program, that of nodus among them.
os.environ.update(dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "CCX_NPROC_STIFFNESS", "CCX_NPROC_RESULTS",
                                 "CCX_NPROC_EQUATION_SOLVER"), "1"))  # fmt: skip

# Nodes of an element as positions in the lattice of nodes, in the order of CalculiX; the first eight are the corners.
_CORNERS = "000 100 110 010 001 101 111 011".split()
EDGES = [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7)]
# Corners of the faces S1 to S6; their axis, and on which end of it they are.
FACES = [(0, 1, 2, 3), (4, 7, 6, 5), (0, 4, 5, 1), (1, 5, 6, 2), (2, 6, 7, 3), (3, 7, 4, 0)]
SIDES = [(2, 0), (2, 1), (1, 0), (0, 1), (1, 1), (0, 0)]


class Unsupported(Exception):
    """What a case has and other programs are not given."""


def limited(command, log, folder, time_limit):
    """Runs a program there, to a number of CPU seconds at most. Returns its exit code, {"cpu" s, "memory" MiB, "out of time"}."""
    run = measured(["prlimit", f"--cpu={time_limit}:{time_limit + 5}", *command], os.path.join(folder, log), folder)
    return run["exit"], {"cpu": run["cpu"], "memory": run["peak MiB"], "out of time": run["cpu"] > 0.99 * time_limit}


def solved(python, program, content, folder, time_limit):
    """Of a program in Python that makes result.json of the content of case.json: that, with arrays of the forces by condition, cpu and memory."""
    os.makedirs(folder, exist_ok=True)
    result = os.path.join(folder, "result.json")
    if os.path.exists(result):  # of an earlier run
        os.remove(result)
    with open(os.path.join(folder, "case.json"), "w", encoding="utf-8") as file:
        json.dump(content, file)
    code, use = limited([python, os.path.abspath(program)], "log", folder, time_limit)
    if use["out of time"] and not os.path.exists(result):
        return {"finished": False, "time": 0.0, "increments": 0, "iterations": None, "cut-backs": 0, "forces": {}, **use}
    if not os.path.exists(result):
        sys.exit(f"{program} ends with {code} and no result: see {os.path.join(folder, 'log')}")
    with open(result, encoding="utf-8") as file:
        found = json.load(file)
    found["forces"] = {int(number): np.array(rows) for number, rows in found["forces"].items()}
    return {**found, **use}


def listed(value, separator):
    """The entries, as texts, of a key that is a list, or a text that says one."""
    return [str(entry) for entry in (value if isinstance(value, (list, tuple)) else str(value).split(separator))]


def _element_nodes(cells):
    """Rows of point numbers in the order of CalculiX, of cells (n, nodes per direction, ...)."""
    degree = cells.shape[1] - 1
    places = [np.array([int(c) for c in corner]) * degree for corner in _CORNERS]
    if degree == 2:
        places += [(places[a] + places[b]) // 2 for a, b in EDGES]
    return np.stack([cells[:, k, j, i] for i, j, k in places], axis=1)


def _depth(points, triangles):
    """Largest depth of a point under the nearest triangle that it is above or below, 0 where there is none within the size of a triangle."""
    a, b, c = triangles.transpose(1, 0, 2)
    normal = np.cross(b - a, c - a)
    size = np.sqrt(np.linalg.norm(normal, axis=1))
    normal /= size[:, None] ** 2
    deepest = 0.0
    for point in points:
        height = ((point - a) * normal).sum(1)
        foot = point - height[:, None] * normal
        inside = np.abs(height) < size
        for s, e in ((a, b), (b, c), (c, a)):
            inside &= (np.cross(e - s, foot - s) * normal).sum(1) >= -1e-9 * size**2
        if inside.any():
            deepest = max(deepest, -min(height[inside], key=abs))
    return deepest


class PlainCase:
    """points (n, 3) at the start; elements (n, nodes), numbers from 1 on, in the order of CalculiX; lattice (n, nodes), numbers from 0 on, of all nodes of
    each element, x fastest; body of each element; n_unknowns."""

    def __init__(self, path, sets, folder, probe=None):
        """probe: a point of a node, in the reference state."""
        self.case = nodus.Case.read(path, program=common.program())
        for key, value in sets.items():
            self.case[key] = self.case.reference[key].value(value)
        self._mesh(path, sets, folder)
        self._surfaces(path, sets, folder)
        self.probe = None if probe is None else self.node_at(probe)

    def numbered(self, name):
        """Sections such as Body 1, Body 2 by their numbers."""
        return {int(key.split()[-1]): self.case[key] for key in self.case if re.fullmatch(name + r" \d+", key)}

    def _mesh(self, path, sets, folder):
        """Of the fields at the start of a run that ends there."""
        start = {**sets, "Output/Results folder": os.path.join(folder, "mesh"), "Load stepping/Interval ends": 1e-9,
                 "Load stepping/Increments": 1, "Output/Checkpoint interval": 0}  # fmt: skip
        mesh = common.program().run(path, sets=start, check=False).bodies(0.0)
        used, rows = np.unique(mesh.cells, return_inverse=True)
        cells = rows.reshape(mesh.cells.shape)
        self.degree = cells.shape[1] - 1
        self.elements, self.lattice = _element_nodes(cells) + 1, cells.reshape(len(cells), -1)
        self.body = mesh.fields["body"][mesh.cells[:, 0, 0, 0]].round().astype(int)
        self.points, self._used = mesh.reference[used], used
        self.body_of_point = mesh.fields["body"][used].round().astype(int)
        self.n_unknowns = 3 * len(used)

    def _surfaces(self, path, sets, folder):
        """Element faces of the roles that faces have: "boundary condition 1 (...), ..." and the like."""
        file = os.path.join(folder, "surfaces.vtu")
        common.program().validate(path, sets=sets, surfaces=file)
        outside = nodus.read_mesh(file)
        number = {self._key(x, b): n for n, (x, b) in enumerate(zip(self.points, self.body_of_point), 1)}
        body = outside.cell_fields["body"].round().astype(int)
        ends = outside.cells[:, [0, 0, -1, -1], [0, -1, -1, 0]]
        corners = [frozenset(number[self._key(x, b)] for x in outside.points[face]) for face, b in zip(ends, body)]
        sides = {frozenset(element[list(face)]): (e, s) for e, element in enumerate(self.elements, 1)
                 for s, face in enumerate(FACES, 1)}  # fmt: skip
        self._faces = {}
        for role, chosen in outside.cell_fields.items():
            if role not in ("body", "boundary_id"):
                self._faces[role] = [sides[corners[f]] for f in np.flatnonzero(chosen > 0.5)]

    @staticmethod
    def _key(x, body):
        return (*np.float32(x), int(body))

    def nodes_of(self, faces):
        """Numbers, from 1 on, of the nodes of element faces (element, side), both from 1 on."""
        nodes = set()
        for e, s in faces:
            element, corners = self.elements[e - 1], FACES[s - 1]
            nodes.update(element[list(corners)])
            if len(element) > 8:
                nodes.update(element[8 + i] for i, edge in enumerate(EDGES) if set(edge) <= set(corners))
        return sorted(nodes)

    def corners_of(self, faces):
        """Body and corners, numbers from 0 on, of element faces."""
        return [[int(self.body[e - 1]), (self.elements[e - 1][list(FACES[s - 1])] - 1).tolist()] for e, s in faces]

    def lattice_of(self, faces):
        """Body and all nodes, numbers from 0 on, of element faces."""
        found = []
        for e, s in faces:
            axis, end = SIDES[s - 1]
            lattice = self.lattice[e - 1].reshape((self.degree + 1,) * 3)
            found.append([int(self.body[e - 1]), lattice.take(end * self.degree, axis=2 - axis).ravel().tolist()])
        return found

    def displacements(self, mesh):
        """Of points, from the bodies of a run of nodus."""
        assert np.allclose(mesh.reference[self._used], self.points)
        return mesh.fields["displacement"][self._used]

    def penetration(self, displacements):
        """How deep nodes of slave and master faces are under faces of the other side of their pair, at most, in mean sides of slave faces at the start.
        Faces of cells of degree 2 are four of degree 1."""
        x, deepest = self.points + displacements, 0.0
        for slave, master, _ in self.pairs().values():
            for here, there in ((slave, master), (master, slave)):
                nodes = np.unique([node for _, face in self.lattice_of(here) for node in face])
                deepest = max(deepest, _depth(x[nodes], self._triangles(x, there)))
            triangles = self._triangles(self.points, slave)
            area = np.linalg.norm(np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]), axis=1).sum() / 2
        return deepest / np.sqrt(area / len(slave))

    def _triangles(self, x, faces):
        """(m, 3, 3), outwards: four around the middle of each face, or of each quarter of one of degree 2."""
        found = []
        for (_, nodes), (_, side) in zip(self.lattice_of(faces), faces):
            grid = x[nodes].reshape(self.degree + 1, self.degree + 1, 3)
            axis, end = SIDES[side - 1]
            if (end == 1) == (axis == 1):  # the second axis of the grid comes first; a face at the end of its axis looks along it
                grid = grid.transpose(1, 0, 2)
            quads = [grid[:-1, :-1], grid[:-1, 1:], grid[1:, 1:], grid[1:, :-1]]
            middle = sum(quads) / 4
            found += [np.stack([quads[i], quads[(i + 1) % 4], middle], axis=2).reshape(-1, 3, 3) for i in range(4)]
        return np.concatenate(found)

    def node_at(self, point):
        """Number, from 1 on, of the node there."""
        return int(np.linalg.norm(self.points - point, axis=1).argmin()) + 1

    def _role(self, begin):
        found = [faces for role, faces in self._faces.items() if re.match(begin, role)]
        if len(found) != 1:
            raise Unsupported(f"roles {sorted(self._faces)} have not one that begins with '{begin}'")
        return found[0]

    def laws(self):
        """body -> (whether it is linear elastic; if not it is neo-Hookean, shape and volume apart), Young's modulus, Poisson's ratio."""
        found = {}
        for number, body in self.numbered("Body").items():
            material = body["Material"]
            law = material["Law"]
            if law != "linear elastic" and (law != "Mooney-Rivlin" or material.get("Mooney-Rivlin ratio", 0) != 0):
                raise Unsupported(f"law {law} of body {number}")
            found[number] = law == "linear elastic", material["Young's modulus"], material.get("Poisson's ratio", 0.3)
        return found

    def pairs(self):
        """Of those that open, slide or stick: number -> slave faces, master faces, friction coefficient."""
        return {number: (*sides, pair.get("Friction coefficient", 0)) for number, pair, *sides in self._all_pairs() if not self._tied(pair)}

    def ties(self):
        """Of tied pairs: number -> slave faces, master faces."""
        return {number: sides for number, pair, *sides in self._all_pairs() if self._tied(pair)}

    @staticmethod
    def _tied(pair):
        return pair.get("Contact law", "unilateral") == "tied"

    def _all_pairs(self):
        return [(number, pair, *(self._role(rf"contact pair {number}\b.*{side}") for side in ("slave", "master")))
                for number, pair in self.numbered("Contact pair").items()]  # fmt: skip

    def intervals(self):
        """(begin, end, increments) of each."""
        load = self.case["Load stepping"]
        ends, counts = np.atleast_1d(load["Interval ends"]), np.atleast_1d(load["Increments"]).astype(int)
        return list(zip(np.concatenate([[0.0], ends[:-1]]), ends, counts))

    def times(self):
        """Ends of all increments, from 0 on."""
        return np.unique(np.concatenate([np.linspace(a, b, n + 1) for a, b, n in self.intervals()]))

    def conditions(self):
        """number -> faces, [(component 0, 1 or 2, displacements at times())]."""
        found = {}
        for number, condition in self.numbered("Boundary condition").items():
            if condition.get("Type", "displacement") != "displacement":
                raise Unsupported(f"boundary condition {number} is no displacement")
            values = listed(condition["Value"], ";")
            texts = [values[i if len(values) > 1 else 0] for i in range(len(listed(condition["Components"], ",")))]
            found[number] = self._role(rf"boundary condition {number}\b"), [
                ("xyz".index(component.strip()), np.array([float(nodus.evaluate(text, {"t": t})) for t in self.times()]))
                for component, text in zip(listed(condition["Components"], ","), texts)
            ]
        return found
