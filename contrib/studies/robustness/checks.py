"""Checks a finished run from its results folder alone: contact laws at the nodes, balance of forces, and the distance of the
deformed surfaces measured anew from bodies.vtu."""

import json
import os
import sys

import numpy as np

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
from common import results  # noqa: E402

# Tolerances: of pressures relative to the largest one of the pair, of lengths relative to the cell, of forces relative to
# the contact force. A loop on the threshold stops at a change of 1e-4.
LAW, LAW_LOOPS = 1e-5, 2e-4
LENGTH = 1e-5
BALANCE = 1e-5
# What only holds at integration points holds at nodes as far as the surface does not turn between the two.
POINTS = 0.06
# Nodes under the facets of the master, in its cells: averages and rounded surfaces allow some.
DEPTH = 0.15

_QUAD_TRIANGLES = ((0, 1, 2), (0, 2, 3))


def unique_nodes(mesh, scale):
    """Nodes of a VTU mesh that were written once for each cell: places of the first ones, and node of each point."""
    keys = np.round(np.column_stack([mesh.reference, _tag(mesh) * scale]) / scale * 1e6).astype(np.int64)
    _, first, inverse = np.unique(keys, axis=0, return_index=True, return_inverse=True)
    return first, inverse.ravel()


def _tag(mesh):
    return np.round(mesh.fields["body" if "body" in mesh.fields else "pair"])


def boundary_triangles(mesh, scale):
    """Triangles of each body's deformed boundary: body -> corners (n, 3, 3), outward."""
    _, node = unique_nodes(mesh, scale)
    sub = []  # sub-cells of eight corners, in the lattice order of results._LATTICE: local x last
    n = mesh.cells.shape[1] - 1
    for k in range(n):
        for j in range(n):
            for i in range(n):
                sub.append(mesh.cells[:, k : k + 2, j : j + 2, i : i + 2].reshape(-1, 8))
    cells = np.concatenate(sub)
    # faces with an outward normal for x, y, z numbered as 4 z + 2 y + x
    faces = [(0, 4, 6, 2), (1, 3, 7, 5), (0, 1, 5, 4), (2, 6, 7, 3), (0, 2, 3, 1), (4, 5, 7, 6)]
    quads = np.concatenate([cells[:, face] for face in faces])
    key = np.sort(node[quads], axis=1)
    _, first, count = np.unique(key, axis=0, return_index=True, return_counts=True)
    quads = quads[first[count == 1]]
    body = _tag(mesh)[quads[:, 0]].astype(int)
    found = {}
    for b in np.unique(body):
        corners = mesh.points[quads[body == b]]
        middle = corners.mean(axis=1)  # four triangles around the middle: the bilinear face to second order
        found[b] = np.concatenate([np.stack([corners[:, i], corners[:, (i + 1) % 4], middle], axis=1) for i in range(4)])
    return found


def depth_below(points, triangles):
    """How deep each point lies under the surface (negative: outside), by the nearest triangle."""
    a, b, c = triangles[:, 0], triangles[:, 1], triangles[:, 2]
    normal = np.cross(b - a, c - a)
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    deepest = np.empty(len(points))
    for number, p in enumerate(points):
        height = np.einsum("ij,ij->i", p - a, normal)
        foot = p - height[:, None] * normal
        inside = np.ones(len(a), bool)
        distance = np.full(len(a), np.inf)
        for s, e in ((a, b), (b, c), (c, a)):
            along = e - s
            inside &= np.einsum("ij,ij->i", np.cross(along, foot - s), normal) >= 0
            t = np.clip(np.einsum("ij,ij->i", p - s, along) / np.einsum("ij,ij->i", along, along), 0, 1)
            distance = np.minimum(distance, np.linalg.norm(p - s - t[:, None] * along, axis=1))
        distance[inside] = np.abs(height[inside])
        near = distance <= distance.min() * (1 + 1e-9) + 1e-12
        # at an edge the face that sees the point most decides
        nearest = np.where(near)[0][np.argmax(np.abs(height[near]))]
        deepest[number] = -np.sign(height[nearest]) * distance[nearest]
    return deepest


class Findings:
    """Largest measured value of each check in all increments, and those beyond their tolerance."""

    def __init__(self):
        self.measured, self.broken = {}, {}

    def compare(self, name, value, tolerance, t, pair=""):
        value = float(value)
        if not np.isfinite(value):
            value = float("inf")
        self.measured[name] = max(self.measured.get(name, 0.0), value)
        if value > tolerance and value > self.broken.get(name, (0.0,))[0]:
            self.broken[name] = (value, tolerance, t, pair)

    def violations(self):
        return [f"{name}: {value:.3g} > {tolerance:.3g} at t = {t:g} {pair}".rstrip()
                for name, (value, tolerance, t, pair) in self.broken.items()]  # fmt: skip


def check(folder, facts):
    """facts: of random_cases.py. Returns {"violations": [...], "measured": {...}}."""
    run = results.Results(folder)
    find = Findings()
    tables = {"contact.csv": run.rows("contact.csv"), "reactions.csv": run.rows("reactions.csv")}
    size = facts["size"]
    cell = facts["cell"] * min(1.0, 1 / facts["cells upper/lower"]) * size
    master_cell = facts["cell"] * max(1.0, 1 / facts["cells upper/lower"]) * size
    mu = facts["mu"]
    before = {}
    for t in sorted(t for t in run.series("contact") if t > 0):  # 0: before the first increment, in no table
        surface, bodies = run.mesh("contact", t), run.mesh("bodies", t)
        boundary = boundary_triangles(bodies, size)
        first, _ = unique_nodes(surface, size)
        forces = {}
        for number, pair in enumerate(facts["pairs"], 1):
            nodes = first[_tag(surface)[first] == number]
            row = [r for r in tables["contact.csv"] if r["pair"] == pair["Name"] and abs(float(r["time"]) - t) < 1e-9][0]
            vector = {side: np.array([float(row[f"{side} {c}"]) for c in "xyz"])
                      for side in ("slave force", "master force", "slave moment", "master moment")}  # fmt: skip
            forces[number] = vector
            values = {name: field[nodes] for name, field in surface.fields.items()}
            values["x"] = surface.points[nodes]
            values["X"] = surface.reference[nodes]
            before[number] = check_pair(find, t, pair, values, vector, before.get(number), mu, facts, cell,
                                        facts["loops"] == "three loops" or int(row["fallbacks"]) > 0)  # fmt: skip
            inside = depth_below(values["x"][values["paired"] > 0.5], boundary[int(pair["Master body"])])
            if len(inside):
                find.compare("depth under the facets of the master [cells]", inside.max() / master_cell, DEPTH, t, pair["Name"])
            lost = (values["paired"] < 0.5)
            if lost.any():
                inside = depth_below(values["x"][lost], boundary[int(pair["Master body"])])
                find.compare("depth of nodes without partner [cells]", inside.max() / master_cell, DEPTH, t, pair["Name"])
        check_balance(find, t, [r for r in tables["reactions.csv"] if abs(float(r["time"]) - t) < 1e-9], forces, facts)
    if not before:
        find.compare("nothing was written", 1.0, 0.0, 0.0)
    return {"violations": find.violations(), "measured": find.measured}


def check_pair(find, t, pair, values, force, before, mu, facts, cell, loops):
    """One pair at a time t; returns the accumulated slip, for the next time."""
    name = pair["Name"]
    at_points = pair["Scheme"] == "integration point"
    law = POINTS if at_points else LAW
    pressure, gap, status = values["CPRESS"], values["COPEN"], np.round(values["CSTATUS"])
    paired = values["paired"] > 0.5
    shear = values["friction_traction"]
    largest = np.abs(pressure).max()
    # components add up in the frames of each time: their difference is the slip of the increment in the present frame
    slip = np.column_stack([values["CSLIP1"], values["CSLIP2"]])

    # forces: both sides, and the fields against the table
    total = max(np.linalg.norm(force["slave force"]), 1e-300)
    find.compare("action and reaction: forces", np.linalg.norm(force["slave force"] + force["master force"]) / total, 1e-9, t, name)
    if largest == 0.0:
        return slip
    scale = (np.abs(pressure) * values["area"]).sum()
    sum_of_fields = (values["area"][:, None] * (shear - pressure[:, None] * values["normal"])).sum(axis=0)
    find.compare("sum of tractions against contact.csv", np.linalg.norm(sum_of_fields - force["slave force"]) / scale, 1e-5, t, name)
    moment = force["slave moment"] + force["master moment"]
    find.compare("action and reaction: moments [cells]", np.linalg.norm(moment) / (scale * cell), 0.05, t, name)

    # Signorini. Corner functions of degree 2 are negative somewhere: what points push there pulls at the corner.
    if not (at_points and facts["degree"] == 2):
        find.compare("tension", -pressure.min() / largest, law, t, name)
    if not at_points:
        find.compare("penetration [cells]", -gap[paired].min(initial=np.inf) / cell, LENGTH, t, name)
        find.compare("gap under pressure [cells]", np.abs(gap[status > 0]).max(initial=0) / cell, LENGTH, t, name)
        find.compare("pressure times gap", np.minimum(np.abs(pressure) / largest, np.abs(gap) / cell).max(), law, t, name)
        find.compare("pressure of open nodes", np.abs(pressure[status == 0]).max(initial=0) / largest, law, t, name)

    # Coulomb
    size = np.linalg.norm(shear, axis=1)
    if mu == 0:
        find.compare("friction without a coefficient", size.max() / largest, law, t, name)
        return slip
    if pair.get("Weights") == "consistent" or at_points and facts["degree"] == 2:  # the law holds between the nodes
        return slip
    law = LAW_LOOPS if loops and not at_points else law
    find.compare("beyond the cone", (size - mu * pressure).max() / (mu * largest), law, t, name)
    if at_points:
        return slip
    slips, sticks = status == 1, status == 2
    find.compare("slip within the cone", (np.abs(size - mu * pressure)[slips]).max(initial=0) / (mu * largest), law, t, name)
    change = slip - (0 if before is None else before)
    length = np.linalg.norm(change, axis=1)
    # files hold single precision
    moved = slips & (length > 1e-4 * np.linalg.norm(slip, axis=1)) & (length > 1e-5 * cell) & (size > 1e-3 * mu * largest)
    tangential = np.column_stack([values["CSHEAR1"], values["CSHEAR2"]])
    cosine = np.einsum("ij,ij->i", change, tangential)[moved] / (length[moved] * size[moved])
    find.compare("slip not against friction [1 + cos]", (1 + cosine).max(initial=0), 1e-5, t, name)
    find.compare("slip of sticking nodes [cells]", length[sticks].max(initial=0) / cell, 1e-5, t, name)
    return slip


def check_balance(find, t, reactions, forces, facts):
    """Reactions of a body against the contact forces on it, where no springs and loads take part."""
    held = {1: ["support"]}
    last = len(facts["laws"])
    if facts["driven"] == "displacement":
        held[last] = ["top"]
        if facts["shape"] == "two indenters":
            held[last - 1] = ["other top"]
    scale = max(np.linalg.norm(f["slave force"]) for f in forces.values())
    if scale == 0.0:
        return
    for body, names in held.items():
        total = np.zeros(3)
        for row in reactions:
            if row["condition"] in names:
                total += np.array([float(row[f"force {c}"]) for c in "xyz"])
        for number, pair in enumerate(facts["pairs"], 1):
            for role in ("slave", "master"):
                if int(pair[f"{role.capitalize()} body"]) == body:
                    total += forces[number][f"{role} force"]
        find.compare("equilibrium of a body", np.linalg.norm(total) / scale, BALANCE, t, f"body {body}")


def main():
    with open(sys.argv[2]) as file:
        print(json.dumps(check(sys.argv[1], json.load(file)), indent=1))


if __name__ == "__main__":
    main()
