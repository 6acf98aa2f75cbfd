"""What a run was asked for and one state that it wrote, as checks.py looks at them."""

import numpy as np

import gaps
import geometry
from common import nodus

SECOND = ", second pass"
FIELDS = ("CPRESS", "COPEN", "CSTATUS", "paired", "area", "normal", "friction_traction", "CSHEAR1", "CSHEAR2", "CSLIP1", "CSLIP2")


class Case:
    """Facts of random_cases.py. sides: boundary id -> middles of its faces in the reference (n, 3), from the mesh file."""

    def __init__(self, facts):
        self.facts, self.pairs, self.conditions = facts, facts["pairs"], facts["conditions"]
        self.sides = {}
        turn, nodes, section = np.array(facts["turn"]), {}, ""
        with open(facts["mesh"]) as file:
            for line in file:
                words = line.split()
                if line[0] == "$":
                    section = words[0]
                elif section == "$Nodes" and len(words) == 4:
                    nodes[words[0]] = np.array(words[1:], float)
                elif section == "$Elements" and len(words) > 5 and words[1] == "10":
                    self.sides.setdefault(words[3], []).append(sum(nodes[n] for n in words[5:9]) / 4)
        self.sides = {side: facts["size"] * np.array(middles) @ turn.T for side, middles in self.sides.items()}

    def faces(self, bodies, body, side):
        """Faces of a body (m, p+1, p+1) on a boundary id, in ascending order."""
        own = bodies.faces[bodies.face_body == int(body)]
        middle = bodies.X[own[:, [0, 0, -1, -1], [0, -1, 0, -1]]].mean(axis=1)
        distance = np.linalg.norm(self.sides[side][:, None] - middle[None], axis=2)
        if not distance.min(axis=1).max() < 1e-5 * self.facts["size"]:
            raise nodus.ResultsError(f"faces of boundary {side} are not in bodies.vtu")
        return own[np.unique(distance.argmin(axis=1))]

    def pairs_at(self, run, t):
        """Keys of the pairs in contact.csv at time t: those given, then the second passes that the run has added (theory, 34)."""
        passes = [row["pair"] for row in run.table("contact.csv") if row["pair"].endswith(SECOND) and abs(float(row["time"]) - t) < 1e-9 * max(1, t)]
        return self.pairs + [self.second_pass(next(p for p in self.pairs if p["Name"] + SECOND == name)) for name in passes]

    @staticmethod
    def second_pass(keys):
        """Those of the pass that holds the master nodes of a pair."""
        swapped = {"Slave": "Master", "Master": "Slave"}
        second = {" ".join([swapped.get(key.split()[0], key.split()[0])] + key.split()[1:]): value for key, value in keys.items()}
        second.update(Name=keys["Name"] + SECOND, Scheme="nodal", Weights="nodal quadrature")
        return second

    @staticmethod
    def value(condition, t):
        """The three components that a condition prescribes at time t."""
        return np.array([float(nodus.evaluate(text, {"t": t})) for text in condition["Value"].split(";")])


class State:
    """One written time. u (n, 3); weights: condition -> integrals of the shape functions over its faces (n,); pairs: gaps.Pair with
    rows (None at integration points), values (name -> by slave node) of the files and, from these and own areas and normals: force
    (k, 3) on the slave, pressure (k,), shear (k, 3)."""

    def __init__(self, run, case, t):
        mesh, surface = run.mesh("bodies", t), run.mesh("contact", t)
        self.t, self.case, self.size = t, case, case.facts["size"]
        fields = [mesh.points, surface.points, *mesh.fields.values(), *surface.fields.values()]
        self.infinite = sum(int((~np.isfinite(field)).sum()) for field in fields)
        if self.infinite:
            return
        self.bodies = geometry.Bodies(mesh, self.size)
        self.u = np.zeros_like(self.bodies.x)
        self.u[self.bodies.node] = mesh.fields["displacement"]
        self.noise = geometry.SINGLE * np.abs(self.bodies.x).max()  # of positions
        self._faces, self.weights = {}, {}
        for c in case.conditions:
            self._faces[c["Name"]] = self._integral(case.faces(self.bodies, c["Body"], c["Boundary ids"]))
            self.weights[c["Name"]] = np.zeros(len(self.u))
            for faces, n, area in self._faces[c["Name"]]:
                np.add.at(self.weights[c["Name"]], faces, area[:, None] * n)
        self.pairs = [self._pair(surface, number, keys) for number, keys in enumerate(case.pairs_at(run, t), 1)]

    def _integral(self, faces):
        """Nodes of faces, values of their functions and areas in the reference, at each Gauss point."""
        p, points = self.bodies.degree, []
        faces = faces.reshape(len(faces), -1)
        for xi, eta, w in zip(*geometry.square_rule("Gauss", p + 2)):
            n, d1, d2 = (s[0] for s in geometry.shape(p, np.array([xi]), np.array([eta])))
            X = self.bodies.X[faces]
            area = w * np.linalg.norm(np.cross(np.einsum("a,fac->fc", d1, X), np.einsum("a,fac->fc", d2, X)), axis=1)
            points.append((faces, n, area))
        return points

    def _pair(self, surface, number, keys):
        sides = [self.case.faces(self.bodies, keys[role + " body"], keys[role + " boundary ids"]) for role in ("Slave", "Master")]
        pair = gaps.Pair(self.bodies, keys, *sides)
        pair.name, pair.cell = keys["Name"], min(pair.slave.size.mean(), pair.master.size.mean())
        points = np.where(np.round(surface.fields["pair"]) == number)[0]
        node, beside = self.bodies.nearest(surface.reference[points], int(keys["Slave body"]))
        pair.beside = max(beside.max(), np.linalg.norm(surface.points[points] - self.bodies.x[node], axis=1).max()) / pair.cell
        pair.values = v = {}
        for name in FIELDS:
            v[name] = np.full((len(pair.nodes),) + surface.fields[name].shape[1:], np.nan)
            v[name][pair.row[node]] = surface.fields[name][points]
        if keys["Scheme"] == "integration point":
            pair.rows, pair.normal, pair.area = None, pair.compute(v["normal"], v["paired"] > 0.5).normal, np.zeros(len(pair.nodes))
            pair.gap_spread, pair.area_spread, pair.normal_spread = np.zeros((3, len(pair.nodes)))
            pair.add_areas(pair.area, *geometry.square_rule(*pair.point_rule()))
            pair.whole = pair.area
        else:
            pair.rows = pair.compute(v["normal"], v["paired"] > 0.5)
            if pair.name.endswith(SECOND) and (v["paired"] > 0.5).any():
                # the rise of facets is part of it: it is read off gaps, and is the same for all nodes
                pair.clearance = np.median((v["COPEN"] + pair.rows.distance)[v["paired"] > 0.5])
                pair.rows = pair.compute(v["normal"], v["paired"] > 0.5)
            pair.normal, pair.area = pair.rows.normal, pair.rows.area
            pair.gap_spread, pair.area_spread, pair.normal_spread = pair.rows.spread()
            pair.whole = pair.rows.whole
            # without partner there is no jump; where only the history tells, the file does
            for rows in [pair.rows] + pair.rows.others:
                rows.drop(~np.where(rows.unsure, v["paired"] > 0.5, rows.paired))
        traction = v["friction_traction"] - v["CPRESS"][:, None] * v["normal"]
        pair.force = pair.area[:, None] * traction
        pair.scale = np.linalg.norm(pair.force, axis=1).sum()
        pair.pressure = -(traction * pair.normal).sum(1)
        pair.shear = traction + pair.pressure[:, None] * pair.normal
        return pair

    def reference_sizes(self, pair):
        """Mean sizes of the slave and of the master faces in the reference configuration: roots of the areas at their middles."""
        _, d1, d2 = (s[0] for s in geometry.shape(self.bodies.degree, np.full(1, 0.5), np.full(1, 0.5)))
        sizes = []
        for side in (pair.slave, pair.master):
            t1, t2 = (np.einsum("a,fac->fc", d, self.bodies.X[side.faces]) for d in (d1, d2))
            sizes.append(np.sqrt(np.linalg.norm(np.cross(t1, t2), axis=1)).mean())
        return sizes

    def loads(self):
        """Forces (n, 3) of tractions and springs on the nodes."""
        force = np.zeros_like(self.u)
        for c in self.case.conditions:
            if c["Type"] == "traction":
                force += self.weights[c["Name"]][:, None] * self.case.value(c, self.t)
            if c["Type"] == "spring":
                force -= self.springs(c)[0]
        return force

    def springs(self, c):
        """Forces of a body on its springs (n, 3), and what these store."""
        force, k = np.zeros_like(self.u), self.case.value(c, self.t)
        for faces, n, area in self._faces[c["Name"]]:
            u = np.einsum("a,fac->fc", n, self.u[faces])
            np.add.at(force, faces, (area[:, None] * u * k)[:, None] * n[None, :, None])
        return force, 0.5 * (force * self.u).sum()
