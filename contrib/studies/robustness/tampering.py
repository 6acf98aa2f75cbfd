#!/usr/bin/python3
"""Would checks.py notice? Changes the results of finished random cases in one way at a time and prints which check saw it.

    tampering.py [--seed N] [--only N ...] [--time-limit S]

Runs the cases as random_cases.py does (NODUS, NODUS_STUDIES), each into its folder, and tampers with copies of it. Cases that have
not finished, or in whose last state nothing touches, are left out.
"""

import argparse
import base64
import csv
import os
import shutil
import struct
import xml.etree.ElementTree as ElementTree
import zlib

import numpy as np

import checks
import common
import random_cases
from common import nodus
from states import Case, State


def change_field(path, name, change):
    """Replaces a field (or "points") of a .vtu by change(old values as doubles)."""
    tree = ElementTree.parse(path)
    piece = tree.getroot().find("UnstructuredGrid/Piece")
    arrays = [piece.find("Points/DataArray")] if name == "points" else [a for a in piece.find("PointData") if a.get("Name") == name]
    array = arrays[0]
    values = nodus.mesh.decode(array).astype(float)
    width = 3 if name == "points" else int(array.get("NumberOfComponents", 1))
    values = change(values.reshape(-1, width) if width > 1 else values)
    raw = np.ascontiguousarray(values, np.float32).tobytes()
    packed = zlib.compress(raw)
    array.text = (base64.b64encode(struct.pack("<4I", 1, len(raw), len(raw), len(packed))) + base64.b64encode(packed)).decode()
    tree.write(path)


def change_table(path, change):
    """Replaces the rows (lists of texts, header first) of a .csv by change(rows)."""
    with open(path, newline="") as file:
        rows = change(list(csv.reader(file)))
    with open(path, "w", newline="") as file:
        csv.writer(file).writerows(rows)


class Tamper:
    """The copy of a results folder and its last state; each method is one kind of damage."""

    def __init__(self, folder, facts, state, files):
        self.folder, self.facts, self.state = folder, facts, state
        self.contact, self.bodies = (os.path.join(folder, os.path.basename(files[name])) for name in ("contact", "bodies"))
        self.pair = max(state.pairs, key=lambda pair: pair.scale)
        self.number = state.pairs.index(self.pair) + 1
        self.node = self.pair.pressure.argmax()
        self.x = self.pair.bodies.x[self.pair.nodes[self.node]]
        self.n = self.pair.normal[self.node]
        self.upper = len(facts["materials"])  # a body that moves as a whole

    def field(self, name, change, where=None):
        """change(values, points of the pair) of contact.vtu at the node of the largest pressure, or `where`."""
        mesh = nodus.read_mesh(self.contact)
        on = np.round(mesh.fields["pair"]) == self.number
        if where != "everywhere":
            on &= np.linalg.norm(mesh.points - self.x, axis=1) < 1e-3 * self.pair.cell

        def apply(values):
            values[on] = change(values[on])
            return values

        change_field(self.contact, name, apply)

    def table(self, name, column, change, key=None):
        """A number in the last row of a table (of a pair or a condition)."""
        def apply(rows):
            k = [i for i, c in enumerate(rows[0]) if c.startswith(column)][0]
            row = [r for r in rows[1:] if key is None or key in r][-1]
            row[k] = change(row[k])
            return rows

        change_table(os.path.join(self.folder, name), apply)

    def move(self, body, by, near=None, fields=("displacement",)):
        """Nodes of a body, or those near a place, in both files of the last state, whose points are where nodes are in the reference."""
        for path, label in ((self.bodies, "body"), (self.contact, "pair")):
            mesh = nodus.read_mesh(path)
            of = np.round(mesh.fields[label])
            if label == "pair":
                of = np.array([0] + [int(p["Slave body"]) for p in self.facts["pairs"]])[of.astype(int)]
            on = of == body
            if near is not None:
                on &= np.linalg.norm(mesh.points - near, axis=1) < 1e-3 * self.pair.cell
            for name in fields:
                change_field(path, name, lambda values: values + on[:, None] * by)

    def side(self):
        """Of the body that is moved: +1 if it is the slave, whose normal looks into the master."""
        return 1 if int(self.pair.keys["Slave body"]) == self.upper else -1

    def tangent(self):
        return np.linalg.svd(self.n[None])[2][1]

    def body_pressed_in(self):
        self.move(self.upper, 0.05 * self.pair.cell * self.side() * self.n)

    def body_lifted(self):
        self.move(self.upper, -0.05 * self.pair.cell * self.side() * self.n)

    def body_shifted_sideways(self):
        self.move(self.upper, 0.01 * self.pair.cell * self.tangent())

    def points_without_displacement(self):
        self.move(self.upper, 0.01 * self.pair.cell * self.tangent(), fields=("points",))

    def node_of_the_contact_moved(self):
        self.move(int(self.pair.keys["Slave body"]), 0.01 * self.pair.cell * self.n, near=self.x)

    def master_node_in_the_slave(self):
        nodes = self.pair.master.nodes
        near = self.pair.bodies.x[nodes[np.linalg.norm(self.pair.bodies.x[nodes] - self.x, axis=1).argmin()]]
        self.move(int(self.pair.keys["Master body"]), -0.3 * self.pair.cell * self.n, near=near)

    def node_inside_a_body_moved(self):
        bodies = self.state.bodies
        inner = np.setdiff1d(np.arange(len(bodies.x)), bodies.faces)
        nearest = inner[np.linalg.norm(bodies.x[inner] - self.x, axis=1).argmin()]
        self.move(bodies.body[nearest], 0.01 * self.pair.cell * self.n, near=bodies.x[nearest])

    def pressure_of_one_node(self):
        self.field("CPRESS", lambda v: 1.05 * v)

    def node_that_pulls(self):
        self.field("CPRESS", lambda v: -v)

    def all_forces_with_their_tables(self):
        """10 % more contact force in every file that has one: nothing but the stresses tells."""
        for name in ("CPRESS", "friction_traction", "CSHEAR1", "CSHEAR2"):
            self.field(name, lambda v: 1.1 * v, "everywhere")
        for of, key in (("contact.csv", self.pair.name), ("reactions.csv", None)):
            def apply(rows):
                forces = [k for k, column in enumerate(rows[0]) if any(word in column for word in ("force ", "moment", "pressure ["))]
                for row in rows[1:]:
                    for k in forces if row[1] == rows[-1][1] and (key is None or key in row) else ():
                        row[k] = repr(1.1 * float(row[k]))
                return rows

            change_table(os.path.join(self.folder, of), apply)

    def traction_flipped(self):
        self.field("friction_traction", lambda v: -v, "everywhere")

    def friction_turned_by_10_degrees(self):
        a = np.radians(10)
        self.field("friction_traction", lambda v: np.cos(a) * v + np.sin(a) * np.cross(self.n, v), "everywhere")

    def friction_of_one_node(self):
        self.field("friction_traction", lambda v: 1.05 * v)

    def partner_lost(self):
        self.field("paired", lambda v: 0 * v)

    def status_open(self):
        self.field("CSTATUS", lambda v: 0 * v)

    def slip_for_stick(self):
        self.field("CSTATUS", lambda v: 3 - v)

    def gap_of_one_node(self):
        self.field("COPEN", lambda v: v + 0.01 * self.pair.cell)

    def slip_of_one_node(self):
        self.field("CSLIP1", lambda v: v + 0.01 * self.pair.cell)

    def normal_of_one_node(self):
        self.field("normal", lambda v: v + 0.02 * self.tangent())

    def area_of_one_node(self):
        self.field("area", lambda v: 1.01 * v)

    def not_a_number_in_a_field(self):
        self.field("CSLIP2", lambda v: np.nan * v)

    def infinite_stress(self):
        change_field(self.bodies, "von_mises", lambda v: np.where(np.arange(len(v)) == 3, np.inf, v))

    def not_a_number_in_a_table(self):
        self.table("contact.csv", "thresholds", lambda text: "nan", self.pair.name)

    def reaction(self):
        k = np.abs(self.state.row_of["support"]).argmax()
        self.table("reactions.csv", "force " + "xyz"[k], lambda text: repr(1.01 * float(text)), "support")

    def force_on_the_master(self):
        k = np.abs(self.pair.master_force).argmax()
        self.table("contact.csv", "master force " + "xyz"[k], lambda text: repr(1.001 * float(text)), self.pair.name)

    def moment_on_the_slave(self):
        by = 0.01 * self.pair.scale * self.pair.cell
        self.table("contact.csv", "slave moment y", lambda text: repr(float(text) + by), self.pair.name)

    def both_moments(self):
        by = 0.01 * self.pair.scale * self.pair.cell
        self.table("contact.csv", "slave moment y", lambda text: repr(float(text) + by), self.pair.name)
        self.table("contact.csv", "master moment y", lambda text: repr(float(text) - by), self.pair.name)

    def count_of_nodes(self):
        self.table("contact.csv", "stick nodes", lambda text: str(int(text) + 1), self.pair.name)

    def work_of_loads(self):
        self.table("energy.csv", "external work", lambda text: repr(1.01 * float(text)))
        self.table("energy.csv", "imbalance", lambda text: repr(float(text) + 0.01 / 1.01 * self.energy("external work")))

    def energy(self, column):
        return nodus.Results(self.folder).energy[-1][column]

    def stored_energy(self):
        self.table("energy.csv", "stored energy", lambda text: repr(1.01 * float(text)))
        self.table("energy.csv", "imbalance", lambda text: repr(float(text) - 0.01 / 1.01 * self.energy("stored energy")))

    def dissipation(self):
        old = self.energy("frictional dissipation")
        self.table("energy.csv", "frictional dissipation", lambda text: repr(1.01 * float(text)))
        self.table("energy.csv", "imbalance", lambda text: repr(float(text) - 0.01 * old))

    def row_missing(self):
        change_table(os.path.join(self.folder, "contact.csv"), lambda rows: rows[:-1])

    def state_missing(self):
        for name in ("contact", "bodies"):
            path = os.path.join(self.folder, name + ".pvd")
            tree = ElementTree.parse(path)
            collection = tree.getroot().find("Collection")
            collection.remove(list(collection)[-1])
            tree.write(path)

    def bodies_of_an_earlier_time(self):
        files = sorted(f for f in os.listdir(self.folder) if f.startswith("bodies_") and f.endswith(".vtu"))
        shutil.copy(os.path.join(self.folder, files[-2]), self.bodies)


def left_out_of(pair, facts, dissipated):
    """Kinds that have nothing to change in a case, or change what is in no law of it. dissipated: by friction, of all energy."""
    left_out = set()
    status, shear = np.round(pair.values["CSTATUS"]), np.linalg.norm(pair.values["friction_traction"], axis=1)
    node = pair.pressure.argmax()
    if shear[node] < 1e-3 * pair.pressure[node]:
        left_out |= {"traction_flipped", "friction_turned_by_10_degrees", "friction_of_one_node"}
    if facts["mu"] == 0 or status[node] == 0:
        left_out |= {"slip_for_stick", "slip_of_one_node"}
    if dissipated < 0.01 or pair.rows is None:
        left_out |= {"dissipation"}
    if pair.rows is None:  # statuses, gaps and slips of nodes are means that no law asks for
        left_out |= {"status_open", "slip_for_stick", "slip_of_one_node", "gap_of_one_node", "partner_lost", "count_of_nodes"}
    return left_out


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", type=int, nargs="+", default=[11, 16, 18, 19, 21, 24, 25, 28], help="numbers of cases")
    parser.add_argument("--time-limit", type=int, default=60, help="CPU seconds of one case")
    options = parser.parse_args()
    os.makedirs(os.path.join(common.SCRATCH, "random_cases"), exist_ok=True)
    tools = ("field", "table", "move", "side", "tangent", "energy")
    kinds = [name for name in vars(Tamper) if name[0] != "_" and name not in tools]
    seen = {kind: [] for kind in kinds}
    for n in options.only:
        row = random_cases.run_case(n, options.seed, options.time_limit)
        case = random_cases.RandomCase(options.seed, n)
        folder = case.write("random_cases")[: -len(".prm")]
        run = nodus.Results(folder)
        times = sorted(run.series("contact"))
        state = State(run, Case(case.facts), times[-1])
        last = {name: [r for r in run.table(name) if checks.same_time(r, times[-1])] for name in ("reactions.csv", "contact.csv")}
        state.row_of = {r["condition"]: checks.vector(r, "force") for r in last["reactions.csv"]}
        if row["exit"] != 0 or row["violations"] or max(pair.scale for pair in state.pairs) == 0:
            print(f"case {n} is left out:", row.get("reason", ""), *row["violations"])
            continue
        for pair, of in zip(state.pairs, last["contact.csv"]):
            pair.master_force = checks.vector(of, "master force")
        energies = {name: abs(value) for name, value in run.energy[-1].items() if name not in ("increment", "time")}
        dissipated = energies["frictional dissipation"] / max(energies.values())
        left_out = left_out_of(max(state.pairs, key=lambda pair: pair.scale), case.facts, dissipated)
        for kind in kinds:
            if kind in left_out:
                continue
            copy = folder + "_tampered"
            shutil.rmtree(copy, ignore_errors=True)
            shutil.copytree(folder, copy)
            getattr(Tamper(copy, case.facts, state, {name: run.series(name)[times[-1]] for name in ("contact", "bodies")}), kind)()
            try:
                found = checks.check(copy, case.facts)["violations"]
            except nodus.ResultsError as error:
                found = [str(error)]
            seen[kind].append((n, [text.split(":")[0] for text in found]))
            shutil.rmtree(copy)
    print("\n| damage | cases | not seen in | seen by, in the first of them |\n|---|---|---|---|")
    for kind, found in seen.items():
        unseen = [n for n, by in found if not by]
        by = next((by for _, by in found if by), [])
        print(f"| {kind.replace('_', ' ')} | {len(found)} | {', '.join(map(str, unseen)) or '-'} | {'; '.join(by[:4])} |")
    if any(not by for found in seen.values() for _, by in found) or not all(seen.values()):
        raise SystemExit("not everything is seen")


if __name__ == "__main__":
    main()
