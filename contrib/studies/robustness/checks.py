"""Checks a finished run from its results folder, mesh and conditions: the independent double of the judge of the program.

What is measured here and what is taken from the files:
- gaps, normals, areas, partners, jumps, depths: from the deformed faces in bodies.vtu alone (geometry.py, gaps.py), and what the
  files say about them is compared with that. Where two faces are equally near, or where only the history tells whether a node beyond
  the rim has a partner, the files decide;
- pressures and friction tractions: those of contact.vtu. That they balance the bodies is checked by reactions.csv, by loads and
  springs integrated anew and, node by node, by the stresses that the displacements cause (solids.py); the laws of integration points
  by finding their multipliers and statuses again (points.py);
- energy.csv: external work, frictional dissipation, contact work and stored energy are summed up anew (friction and contact work not
  for integration points, whose forces are in no file). That the imbalance is small is not checked: it is an error of the account.
Moments of reactions are in no table: bodies whose displacements are prescribed have their moments checked by their nodes. Depths are
those of written states: a node that goes through a whole body between two of them is not seen.

Signs are those of users: pressures and gaps are positive. Lengths are relative to the smaller mean face of the pair ("cells"). The
largest values in 275 random cases are in brackets, all of them in README.md.
"""

import json
import os
import sys

import numpy as np

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
import geometry  # noqa: E402
import points  # noqa: E402
import solids  # noqa: E402
from common import nodus  # noqa: E402
from states import SECOND, Case, State  # noqa: E402

# Positions are known to 1e-6 cells in single precision, and so are gaps, normals, prescribed displacements (2.1e-6).
LENGTH = 1e-5
# Of the largest pressure or of the cone: what Newton leaves (2.6e-6); loops on the threshold stop at changes of 1e-4 (7.7e-5).
LAW, LAW_LOOPS = 1e-5, 2e-4
# Of the sum of the nodal forces: what Newton leaves (1.5e-6); fixed-point loops may end with 2e-3 (theory.md, 34; 8.3e-5).
BODIES, BODIES_LOOPS = 1e-5, 2e-3
# A geometry loop may end before surfaces are where they were paired (README.md): of gaps in cells (1.2e-5), of all that else depends
# on the pairing (1.8e-3).
LENGTH_LOOPS, PAIRING_LOOPS = 1e-4, 2e-3
# Resultants of fields in single precision against tables (2.2e-6), their moments in cells (1.8e-6): arms are up to ten cells.
SUMS, MOMENTS = 1e-5, 5e-5
# Hats have kinks in the middle of faces of degree 2, which straight quarters follow to second order; rules differ there (1.7e-5).
AREA = 1e-4
# Moments of both sides, in cells: twelve digits in the tables.
LEVER = 1e-8
# Rules may differ by this in gaps (1.3e-3), else the checks would say nothing.
RULES = 5e-3
# Depth of slave nodes, of master nodes, beyond the bulges of both surfaces between their nodes. The nodal scheme holds slave nodes to
# the master (2e-3), and between them nodes of a master with smaller faces come through (0.14); the others hold means over the faces
# around a node, so that nodes at corners and beside kinks are inside (0.056; 0.035). With the bulges: at most 0.25.
DEPTH = {"nodal": (0.01, 0.2), "averaged": (0.1, 0.1), "integration point": (0.1, 0.1)}
DEPTH_AT_ALL = 0.25
# Of master nodes, of points where there are some: what the judge tolerates, of the smaller mean face.
TOLERATED = {"nodal": 0.2, "averaged": 0.1, "integration point": 0.05}
# Of the largest energy: tables in 12 digits (1e-7), slips as differences of displacements in single precision (4.5e-5).
WORK, SLIP_WORK = 1e-5, 1e-4


class Findings:
    """Largest measured value of each check in all increments, and those beyond their tolerance."""

    def __init__(self):
        self.measured, self.broken = {}, {}

    def compare(self, name, value, tolerance, t, where=""):
        value = np.asarray(value, float)
        value = float(np.where(np.isfinite(value), value, np.inf).max(initial=0.0))
        self.measured[name] = max(self.measured.get(name, 0.0), value)
        if value > tolerance and value > self.broken.get(name, (0.0,))[0]:
            self.broken[name] = (value, tolerance, t, where)

    def violations(self):
        return [f"{name}: {value:.3g} > {tolerance:.3g} at t = {t:g} {where}".rstrip()
                for name, (value, tolerance, t, where) in self.broken.items()]  # fmt: skip


def vector(row, name):
    return np.array([float(row[f"{name} {c}"]) for c in "xyz"])


def check(folder, facts):
    """facts: of random_cases.py. Returns {"violations": [...], "measured": {...}}."""
    run, case, find = nodus.Results(folder), Case(facts), Findings()
    tables = check_tables(find, run, case)
    before, sums = None, dict.fromkeys(("external", "friction", "contact", "blur"), 0.0)
    times = sorted(run.series("contact"))
    for t in times:
        state = State(run, case, t)
        find.compare("numbers in fields that are not finite", state.infinite, 0, t)
        if state.infinite:
            break
        check_surfaces(find, state, before)
        if t > 0:  # what is written before the first increment is in no table
            rows = {name: [r for r in table if same_time(r, t)] for name, table in tables.items()}
            row_of = {r["condition"]: vector(r, "force") for r in rows["reactions.csv"]}
            state.fixed_point = facts["loops"] != "newton" or any(int(r["fallbacks"]) > 0 for r in rows["contact.csv"])
            for pair in state.pairs:
                row = next(r for r in rows["contact.csv"] if r["pair"] == pair.name)
                check_resultants(find, state, pair, row)
                if pair.rows:
                    check_gaps(find, state, pair, row)
                else:
                    points.check_points(find, state, pair, row)
                check_friction(find, state, before, pair)
                if pair.name.endswith(SECOND):
                    check_clearance(find, state, pair)
                else:
                    check_depth(find, state, pair)
            check_bodies(find, state, row_of)
            stored, blur = solids.check_equilibrium(find, state, row_of, np.abs(state.u - before.u).max())
            check_energy(find, state, before, row_of, rows["energy.csv"][0], sums, stored, blur)
            state.row_of = row_of
        before = state
    find.compare("nothing was written", times[-1:] in ([], [0.0]), 0, 0)
    return {"violations": find.violations(), "measured": find.measured}


def check_tables(find, run, case):
    """Finite numbers in all tables; a row for each pair and condition at each written time. Returns the tables."""
    bad, names = 0, ("contact.csv", "reactions.csv", "energy.csv", "convergence.csv")
    tables = {name: run.table(name) for name in names}
    for table in tables.values():
        bad += sum(int((~np.isfinite(table[column])).sum()) for column in table.names if column not in ("pair", "condition"))
    find.compare("numbers in tables that are not finite", bad, 0, 0)
    if bad:
        raise nodus.ResultsError("; ".join(find.violations()))
    written = [t for t in run.series("contact") if t > 0]
    missing = int(run.series("bodies").keys() != run.series("contact").keys())
    held = [c["Name"] for c in case.conditions if c["Type"] == "displacement"]
    asked = {"contact.csv": ("pair", lambda t: [p["Name"] for p in case.pairs_at(run, t)]),
             "energy.csv": ("time", lambda t: [None]), "reactions.csv": ("condition", lambda t: held)}  # fmt: skip
    for name, (column, wanted_at) in asked.items():
        missing += len(tables[name]) != sum(len(wanted_at(t)) for t in written)
        for t in written:
            wanted, found = wanted_at(t), [r[column] for r in tables[name] if same_time(r, t)]
            missing += len(found) != 1 if name == "energy.csv" else sorted(found) != sorted(wanted)
    find.compare("rows or states that are missing", missing, 0, 0)
    if missing:
        raise nodus.ResultsError("; ".join(find.violations()))
    return tables


def same_time(row, t):
    return abs(float(row["time"]) - t) < 1e-9 * max(1, t)


def check_surfaces(find, state, before):
    """The slave surfaces lie on the bodies; reference positions stay; prescribed displacements are there."""
    for pair in state.pairs:
        find.compare("contact.vtu beside bodies.vtu [cells]", pair.beside, LENGTH, state.t, pair.name)
    cell = min(pair.cell for pair in state.pairs)
    if before is not None:
        same = len(before.u) == len(state.u)
        moved = np.abs(state.bodies.X - before.bodies.X) if same else np.inf
        find.compare("reference positions that move [cells]", moved / cell, LENGTH, state.t)
    for c in state.case.conditions:
        if c["Type"] == "displacement":
            off = np.abs(state.u[state.weights[c["Name"]] != 0] - state.case.value(c, state.t))
            find.compare("prescribed displacements [cells]", off / cell, LENGTH, state.t, c["Name"])


def check_resultants(find, state, pair, row):
    """Fields against contact.csv, and both sides against each other; moments about the origin."""
    t, v, name = state.t, pair.values, pair.name
    table = {side: vector(row, side) for side in ("slave force", "master force", "slave moment", "master moment")}
    pair.row_of_table, pair.master_force = row, table["master force"]
    scale = max(pair.scale, 1e-300)
    x, loops = state.bodies.x, PAIRING_LOOPS * state.fixed_point
    find.compare("action and reaction: forces", np.linalg.norm(table["slave force"] + table["master force"]) / scale, 1e-9, t, name)
    lever = pair.clearance * np.cross(pair.normal, pair.force).sum(axis=0)  # of friction across a clearance, in single precision
    both = np.linalg.norm(table["slave moment"] + table["master moment"] - lever) - 4 * geometry.SINGLE * pair.clearance * scale
    find.compare("action and reaction: moments [cells]", both / (scale * pair.cell), max(LEVER, loops), t, name)
    forces = {"slave": np.zeros_like(x), "master": None}
    forces["slave"][pair.nodes] = pair.force
    if pair.rows:
        nodal, _ = pair.rows.force(pair.force)
        forces = {"slave": nodal * pair.rows.slave[:, None], "master": nodal * ~pair.rows.slave[:, None]}
    # what areas leave open, forces do
    open_ = (np.linalg.norm(pair.force, axis=1) * pair.area_spread / pair.area).sum() / scale
    arm = np.linalg.norm(x[pair.nodes] - x[pair.nodes].mean(axis=0), axis=1).max() + np.linalg.norm(x[pair.nodes].mean(axis=0))
    for side, f in forces.items():
        if f is not None:
            off = np.linalg.norm(f.sum(axis=0) - table[f"{side} force"]) / scale - open_
            find.compare("sum of tractions against contact.csv", off, max(SUMS, loops), t, f"{name}, {side}")
            off = np.linalg.norm(np.cross(x, f).sum(axis=0) - table[f"{side} moment"]) / scale - open_ * arm
            find.compare("moment of tractions against contact.csv [cells]", off / pair.cell, max(MOMENTS, loops), t, f"{name}, {side}")
    status = np.round(v["CSTATUS"])
    if pair.rows:
        counts = {"open nodes": status == 0, "slip nodes": status == 1, "stick nodes": status == 2,
                  "unpaired nodes": v["paired"] < 0.5}  # fmt: skip
        off = sum(abs(int(row[column]) - int(of.sum())) for column, of in counts.items())
        find.compare("counts of nodes against contact.csv", off, 0, t, name)
        off = abs(pair.area[status > 0].sum() - float(row["contact area"])) - pair.area_spread.sum()
        find.compare("contact area", off / pair.whole.sum(), max(SUMS, loops), t, name)
    largest = pair.pressure[status > 0].max(initial=0)
    turned = (np.linalg.norm(pair.shear, axis=1) * pair.normal_spread).max()  # a normal that is not known tilts friction
    off = abs(largest - float(row["maximum pressure"])) - turned
    find.compare("maximum pressure", off / max(largest, 1e-300), max(SUMS, loops), t, name)
    off = np.abs(v["area"] - pair.area) - pair.area_spread
    find.compare("areas [of the surface around a node]", off / pair.whole, max(AREA, loops), t, name)
    off = np.abs(v["normal"] - pair.normal).max(axis=1) - pair.normal_spread
    find.compare("normals", off[v["paired"] > 0.5], max(LENGTH, loops), t, name)


def check_gaps(find, state, pair, row):
    """Signorini's conditions at the sites of nodal and averaged pairs, with gaps from the faces."""
    t, v, name, rows = state.t, pair.values, pair.name, pair.rows
    paired, status = v["paired"] > 0.5, np.round(v["CSTATUS"])
    find.compare("partners that are missing or too many", (paired != rows.paired) & ~rows.unsure, 0, t, name)
    sure = paired & (rows.paired | rows.unsure)
    length = LENGTH_LOOPS if state.fixed_point else LENGTH
    gap, largest = -rows.distance / pair.cell, max(np.abs(pair.pressure).max(), 1e-300)
    pressure, spread = pair.pressure / largest, pair.gap_spread / pair.cell
    size = np.maximum(np.abs(gap) - spread, 0)
    find.compare("(gaps that other rules change [cells])", spread[sure & (pressure > 0)], RULES, t, name)
    find.compare("COPEN against the faces [cells]", (np.abs(v["COPEN"] / pair.cell - gap) - spread)[sure], length, t, name)
    find.compare("penetration [cells]", (-gap - spread)[sure], length, t, name)
    find.compare("gap of closed nodes [cells]", size[status > 0], length, t, name)
    find.compare("pressure times gap", np.minimum(np.abs(pressure), size)[sure], max(LAW, length * state.fixed_point), t, name)
    find.compare("tension", -pressure, LAW, t, name)
    find.compare("pressure of open or unpaired nodes", np.abs(pressure[(status == 0) | ~paired]), LAW, t, name)


def check_friction(find, state, before, pair):
    """Coulomb's law; slips from the jump operators of gaps.py at displacements of both times."""
    t, name, mu = state.t, pair.name, state.case.facts["mu"]
    size, pressure = np.linalg.norm(pair.shear, axis=1), pair.pressure
    largest, status = np.abs(pressure).max(), np.round(pair.values["CSTATUS"])
    if largest == 0 or not pair.rows:
        return
    if mu == 0:
        find.compare("friction without a coefficient", size / largest, PAIRING_LOOPS if state.fixed_point else LAW, t, name)
        return
    law = (LAW_LOOPS if state.fixed_point else LAW) + 4 * geometry.SINGLE / mu  # tractions hold single precision
    if pair.keys.get("Weights") != "consistent":  # there the law holds between the nodes
        held, limit = size, mu * pressure
        if state.fixed_point:  # the normals of the pairing that the loop ended with; how far these are off is a check by itself
            traction, normal = pair.shear - pressure[:, None] * pair.normal, pair.values["normal"]
            across = (traction * normal).sum(1)
            held, limit = np.linalg.norm(traction - across[:, None] * normal, axis=1), -mu * across
        over, turned = held - limit, np.abs(pressure) * pair.normal_spread  # a normal that is not known tilts the pressure
        find.compare("beyond the cone", (over - turned) / (mu * largest), law, t, name)
        find.compare("slip within the cone", (np.abs(over) - turned)[status == 1] / (mu * largest), law, t, name)
    length_tolerance = LENGTH_LOOPS if state.fixed_point else LENGTH
    slips, sticks = status == 1, status == 2
    jump, spread = pair.rows.jump(state.u - before.u)
    slip = jump - (jump * pair.normal).sum(1)[:, None] * pair.normal
    spread = spread + pair.normal_spread * np.linalg.norm(jump, axis=1)  # a normal that is not known turns it
    length = np.linalg.norm(slip, axis=1)
    noise = geometry.SINGLE * np.abs(state.u).max()
    find.compare("slip of sticking nodes [cells]", (length - spread)[sticks] / pair.cell, length_tolerance, t, name)
    # a direction is known to the last digits of displacements over its length
    moved = slips & (length > np.maximum(300 * (noise + spread), 1e-5 * pair.cell)) & (size > 1e-3 * mu * largest)
    cosine = (slip * pair.shear).sum(1)[moved] / (length[moved] * size[moved])
    if pair.keys.get("Weights") != "consistent":
        find.compare("slip not against friction [1 + cos]", 1 + cosine, 1e-5, t, name)
    slipped = lambda pair: np.column_stack([pair.values[c] for c in ("CSLIP1", "CSLIP2")])
    now, old = slipped(pair), earlier(before, state, pair)
    change = np.linalg.norm(now - (slipped(old) if old else 0), axis=1)
    off = np.abs(change - length) - spread - 2 * geometry.SINGLE * np.abs(now).max()
    find.compare("CSLIP against the bodies [cells]", off[status > 0] / pair.cell, length_tolerance, t, name)


def earlier(before, state, pair):
    """A pair as it was in the state before, or None where the run has added it since."""
    number = state.pairs.index(pair)
    return before.pairs[number] if number < len(before.pairs) else None


def check_clearance(find, state, pair):
    """Of a second pass: half of what is tolerated, behind what facets rise (V2). No pair of random_cases.py is adjusted."""
    first = next(p for p in state.case.pairs if p["Name"] + SECOND == pair.name)
    expected = 0.5 * TOLERATED[first["Scheme"]] * min(state.reference_sizes(pair))
    off = pair.clearance - expected
    if first.get("Surface") != "faceted" or state.bodies.degree > 1:
        find.compare("clearance of a second pass [cells]", abs(off) / pair.cell, LENGTH, state.t, pair.name)
    find.compare("clearance of a second pass below that of theory [cells]", -off / pair.cell, LENGTH, state.t, pair.name)
    find.compare("clearance of a second pass at all [cells]", pair.clearance / pair.cell, DEPTH_AT_ALL, state.t, pair.name)


def check_depth(find, state, pair):
    """Boundary nodes of either body in the other one, paired or not [smaller mean faces in the reference]."""
    bodies, scheme = state.bodies, pair.keys["Scheme"]
    ids = [int(pair.keys[f"{role} body"]) for role in ("Slave", "Master")]
    slave_size, master_size = state.reference_sizes(pair)
    cell = min(slave_size, master_size)
    # a master with smaller faces bulges over those of the slave, which see its mean
    rises = (pair.slave.bulge + pair.master.bulge, pair.slave.bulge + pair.master.bulge * max(1, slave_size / master_size) ** 2)
    for k, side in enumerate(("slave nodes in the master", "master nodes in the slave")):
        surface = geometry.Surface(bodies, bodies.faces[bodies.face_body == ids[1 - k]], False)
        nodes = np.unique(bodies.faces[bodies.face_body == ids[k]])
        box = bodies.x[surface.nodes].min(axis=0), bodies.x[surface.nodes].max(axis=0)
        nodes = nodes[((bodies.x[nodes] > box[0]) & (bodies.x[nodes] < box[1])).all(axis=1)]
        depth = geometry.depth_below(bodies.x[nodes], surface.triangles()) / cell
        find.compare(f"depth of {side} beyond bulges [cells], {scheme}", depth - rises[k] / cell, DEPTH[scheme][k], state.t, pair.name)
        find.compare(f"depth of {side} [cells], {scheme}", depth, DEPTH_AT_ALL, state.t, pair.name)


def check_bodies(find, state, row_of):
    """Resultants of each body: contact, loads, springs and reactions; moments where no displacement is prescribed."""
    loads, x, X = state.loads(), state.bodies.x, state.bodies.X
    scale = max(pair.scale for pair in state.pairs)
    tolerance = BODIES_LOOPS if state.fixed_point else BODIES
    if scale == 0:
        return
    for b in np.unique(state.bodies.body):
        own = (state.bodies.body == b)[:, None]
        # small strains: forces and moments are in equilibrium in the reference configuration
        small = state.case.facts["materials"][b - 1]["Law"] == "linear elastic"
        force, moment = (loads * own).sum(axis=0), np.cross(X if small else x, loads * own).sum(axis=0)
        sizes = scale + np.linalg.norm(loads * own, axis=1).sum()
        # springs are as sure as displacements in single precision
        springs = [state.springs(c)[0] for c in state.case.conditions if c["Type"] == "spring"]
        digits, levers = (geometry.SINGLE * sum((lever * np.linalg.norm(own * f, axis=1)).sum() for f in springs)
                          for lever in (1.0, np.linalg.norm(x, axis=1)))  # fmt: skip
        for pair in state.pairs:
            for role in ("slave", "master"):
                if int(pair.keys[f"{role.capitalize()} body"]) == b:
                    force = force + vector(pair.row_of_table, f"{role} force")
                    if not small:
                        moment = moment + vector(pair.row_of_table, f"{role} moment")
                    elif pair.rows:
                        moment = moment + np.cross(X, own * pair.rows.force(pair.force)[0]).sum(axis=0)
        held = [c["Name"] for c in state.case.conditions if c["Type"] == "displacement" and int(c["Body"]) == b]
        force = force + sum(row_of[name] for name in held)
        find.compare("equilibrium of a body: forces", (np.linalg.norm(force) - digits) / sizes, tolerance, state.t, f"body {b}")
        if not held and not (small and any(pair.rows is None for pair in state.pairs)):
            arm = sizes * min(pair.cell for pair in state.pairs)
            find.compare("equilibrium of a body: moments [cells]", (np.linalg.norm(moment) - levers) / arm, tolerance, state.t, f"body {b}")


def check_energy(find, state, before, row_of, row, sums, stored, blur):
    """Works of mean forces (E2) since the start and energies against energy.csv, relative to the largest of them."""
    t, case = state.t, state.case
    columns = {name: float(value) for name, value in row.items() if name not in ("increment", "time")}
    step = state.u - before.u
    for c in case.conditions:
        if c["Type"] == "displacement":
            old = getattr(before, "row_of", {}).get(c["Name"], np.zeros(3))
            sums["external"] += 0.5 * (old + row_of[c["Name"]]) @ (case.value(c, t) - case.value(c, before.t))
        if c["Type"] == "traction":
            mean = 0.5 * (case.value(c, t) + case.value(c, before.t))
            sums["external"] += (state.weights[c["Name"]][:, None] * step).sum(axis=0) @ mean
    for pair in state.pairs:
        if pair.rows:
            jump, _ = pair.rows.jump(step)
            across = (jump * pair.normal).sum(1)
            sums["friction"] -= (pair.force * (jump - across[:, None] * pair.normal)).sum()
            # last digits of displacements, and of positions over a face, which normals are known to
            digits = 2 * geometry.SINGLE * np.abs(state.u).max() + 2 * state.noise / pair.cell * np.linalg.norm(jump, axis=1)
            sums["blur"] += (np.linalg.norm(pair.force, axis=1) * digits).sum()
            old = earlier(before, state, pair)
            force = pair.force if old is None else pair.force + old.force
            sums["contact"] += (0.5 * (force * pair.normal).sum(1) * across).sum()
    scale = max(abs(v) for v in columns.values())
    stiffest = max(float(m["Young's modulus"]) for m in case.facts["materials"])
    if scale < 1e-24 * stiffest * min(pair.cell for pair in state.pairs) ** 3:  # strains of round-off: nothing touches yet
        return
    sums["loops"] = sums.get("loops", False) or state.fixed_point
    slip_work = PAIRING_LOOPS if sums["loops"] else SLIP_WORK
    find.compare("external work", abs(sums["external"] - columns["external work"]) / scale, WORK, t)
    if all(pair.rows for pair in state.pairs):
        find.compare("frictional dissipation", (abs(sums["friction"] - columns["frictional dissipation"]) - sums["blur"]) / scale, slip_work, t)
        find.compare("contact work", (abs(sums["contact"] - columns["contact work"]) - sums["blur"]) / scale, slip_work, t)
    find.compare("stored energy", (abs(stored - columns["stored energy"]) - blur) / scale, WORK, t)
    rest = (columns["external work"] + columns["released work"] + columns["contact work"] - columns["stored energy"]
            - columns["frictional dissipation"] - columns["plastic dissipation"] - columns["stabilisation"])  # fmt: skip
    find.compare("sum of energies", abs(rest - columns["imbalance"]) / scale, 1e-9, t)


def main():
    with open(sys.argv[2]) as file:
        print(json.dumps(check(sys.argv[1], json.load(file)), indent=1))


if __name__ == "__main__":
    main()
