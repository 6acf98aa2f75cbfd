"""A case of nodus in GetFEM on the same mesh: contact of large sliding by ray tracing with multipliers on the slave side (Poulios & Renard 2015).

run() puts what plain_case takes into a folder and starts this file as a program of its own there, so that its CPU and memory can be measured.
Needs Debian's python3-getfem.
"""

import json
import sys

import numpy as np

# Of displacements, in Young's moduli over the length of an element; residuals are relative to what it gives.
PENALTY, TOLERANCE = 1e4, 3e-11
HALVINGS, ITERATIONS = 10, 30


def run(case, augmentation, release, folder, time_limit=3600):
    """augmentation: in pressure; release: how far the other surface is looked for [length]. Returns what calculix.run() returns."""
    from plain_case import solved

    content = {
        "points": case.points.tolist(), "body of point": case.body_of_point.tolist(), "degree": case.degree, "probe": case.probe,
        "bodies": {str(b): {"elements": case.lattice[case.body == b].tolist(), "law": law} for b, law in case.laws().items()},
        "pairs": [[case.lattice_of(slave), case.lattice_of(master), friction] for slave, master, friction in case.pairs().values()],
        "ties": [[case.lattice_of(slave), case.lattice_of(master)] for slave, master in case.ties().values()],
        "conditions": {str(number): [case.lattice_of(faces), [[c, history.tolist()] for c, history in components]]
                       for number, (faces, components) in case.conditions().items()},
        "times": case.times().tolist(), "augmentation": augmentation, "release": release,
    }  # fmt: skip
    return solved(sys.executable, __file__, content, folder, time_limit)


class Solid:
    """Model of GetFEM with one displacement for each body; conditions by penalty."""

    def __init__(self, content):
        import getfem

        self.getfem, self.content = getfem, content
        self.model = getfem.Model("real")
        self.points = np.array(content["points"])
        self.meshes, self.spaces, self.rules, self.regions = {}, {}, {}, 0
        for body, data in content["bodies"].items():
            self._add_body(int(body), np.array(data["elements"]), *data["law"])
        self.conditions = [self._condition(number, *data) for number, data in content["conditions"].items()]
        for p, pair in enumerate(content["pairs"], 1):
            self._add_pair(p, *pair)
        for p, tie in enumerate(content["ties"], 1):
            self._add_tie(p, *tie)

    def _add_body(self, body, elements, linear, modulus, ratio):
        getfem, model = self.getfem, self.model
        mesh = getfem.Mesh("empty", 3)
        degree = self.content["degree"]
        mesh.add_convex(getfem.GeoTrans(f"GT_QK(3,{degree})"), self.points[elements].transpose(2, 1, 0))
        self.meshes[body] = mesh
        self.spaces[body] = getfem.MeshFem(mesh, 3)
        self.spaces[body].set_classical_fem(degree)
        self.rules[body] = getfem.MeshIm(mesh, 2 * degree + 2)
        model.add_fem_variable(f"u{body}", self.spaces[body])
        model.add_fem_data(f"w{body}", self.spaces[body])  # at the last time
        shear, bulk = modulus / (2 * (1 + ratio)), modulus / (3 * (1 - 2 * ratio))
        if linear:
            model.add_initialized_data(f"first{body}", bulk - 2 * shear / 3)
            model.add_initialized_data(f"shear{body}", shear)
            model.add_isotropic_linearized_elasticity_brick(self.rules[body], f"u{body}", f"first{body}", f"shear{body}")
        else:
            model.add_initialized_data(f"law{body}", [shear / 2, bulk / 2])
            model.add_finite_strain_elasticity_brick(self.rules[body], "Compressible Neo Hookean", f"u{body}", f"law{body}")
        edges = self.points[elements[0, [degree, degree * (degree + 1), degree * (degree + 1) ** 2]]] - self.points[elements[0, 0]]
        size = np.cbrt(abs(np.linalg.det(edges)))
        model.add_initialized_data(f"penalty{body}", PENALTY * modulus / size)

    def _region(self, faces):
        """body -> region of its faces."""
        found = {}
        for body in sorted({body for body, _ in faces}):
            mesh = self.meshes[body]
            columns = [mesh.faces_from_pid(mesh.pid_from_coords(self.points[nodes].T)) for b, nodes in faces if b == body]
            self.regions += 1
            mesh.set_region(self.regions, np.hstack(columns))
            found[body] = self.regions
        return found

    def _condition(self, number, faces, components):
        """Its displacements are data. Returns its number, regions by body, [(component, history)]."""
        regions = self._region(faces)
        for component, _ in components:
            self.model.add_initialized_data(f"d{number}_{component}", 0.0)
            for body, region in regions.items():
                self.model.add_linear_term(self.rules[body], f"penalty{body}*(u{body}({component + 1})-d{number}_{component})"
                                           f"*Test_u{body}({component + 1})", region)  # fmt: skip
        return number, regions, components

    def _add_pair(self, p, slave, master, friction):
        model = self.model
        ((slave_body, slave_region),) = self._region(slave).items()
        ((master_body, master_region),) = self._region(master).items()
        for name, value in (("augmentation", self.content["augmentation"]), ("friction", friction), ("alpha", 1.0)):
            model.add_initialized_data(f"{name}{p}", value)
        model.add_filtered_fem_variable(f"lambda{p}", self.spaces[slave_body], slave_region)
        brick = model.add_integral_large_sliding_contact_brick_raytracing(f"augmentation{p}", self.content["release"], f"friction{p}", f"alpha{p}", 0)
        model.add_slave_contact_boundary_to_large_sliding_contact_brick(brick, self.rules[slave_body], slave_region, f"u{slave_body}", f"lambda{p}",
                                                                        f"w{slave_body}")  # fmt: skip
        model.add_master_contact_boundary_to_large_sliding_contact_brick(brick, self.rules[master_body], master_region, f"u{master_body}",
                                                                         f"w{master_body}")  # fmt: skip

    def _add_tie(self, p, slave, master):
        """By the penalty of the slave; both sides have the same reference surface."""
        ((slave_body, region),) = self._region(slave).items()
        master_body = master[0][0]
        there = f"there{p}"
        self.model.add_interpolate_transformation_from_expression(there, self.meshes[slave_body], self.meshes[master_body], "X")
        u, v = f"u{slave_body}", f"u{master_body}"
        self.model.add_linear_term(self.rules[slave_body], f"penalty{slave_body}*({u}-Interpolate({v},{there}))"
                                   f".(Test_{u}-Interpolate(Test_{v},{there}))", region)  # fmt: skip

    def at(self, t):
        for number, _, components in self.conditions:
            for component, history in components:
                self.model.set_variable(f"d{number}_{component}", float(np.interp(t, self.content["times"], history)))

    def forces(self):
        """condition -> what it does to the bodies."""
        found = {}
        for number, regions, components in self.conditions:
            found[number] = [0.0, 0.0, 0.0]
            for component, _ in components:
                for body, region in regions.items():
                    found[number][component] += float(self.getfem.asm_generic(
                        self.rules[body], 0, f"penalty{body}*(d{number}_{component}-u{body}({component + 1}))", region, self.model))  # fmt: skip
        if self.content["probe"]:
            point = self.points[self.content["probe"] - 1]
            for body, space in self.spaces.items():
                if np.any(np.linalg.norm(space.basic_dof_nodes().T - point, axis=1) < 1e-9 * (1 + np.linalg.norm(point))):
                    values = self.getfem.compute_interpolate_on(space, self.model.variable(f"u{body}"), point.reshape(3, 1))
                    found["0"] = np.ravel(values).tolist()
        return found

    def displacements(self):
        """Of all points, which are nodes; some are outside of the mesh by round-off, so that nothing could be interpolated there."""
        from scipy.spatial import cKDTree  # which GetFEM has

        found, body_of = np.zeros_like(self.points), np.array(self.content["body of point"])
        for body, space in self.spaces.items():
            here = body_of == body
            distance, node = cKDTree(space.basic_dof_nodes()[:, ::3].T).query(self.points[here])
            assert distance.max() < 1e-8
            found[here] = self.model.variable(f"u{body}").reshape(-1, 3)[node]
        return found.tolist()

    def solve(self, t):
        """Newton iterations, and whether they converged."""
        self.at(t)
        return self.model.solve("max_res", TOLERANCE, "max_iter", ITERATIONS, "lsolver", "mumps", "lsearch", "simplest",
                                "alpha max ratio", 1.5, "alpha min", 0.05, "alpha mult", 0.6, "noisy")  # fmt: skip


def main():
    with open("case.json", encoding="utf-8") as file:
        content = json.load(file)
    solid = Solid(content)
    state = solid.model.from_variables()
    result = {"finished": False, "time": 0.0, "increments": 0, "iterations": 0, "cut-backs": 0, "forces": {}}
    targets, halved = list(content["times"][:0:-1]), 0
    while targets:
        t = targets[-1]
        iterations, converged = solid.solve(t)
        result["iterations"] += int(iterations)
        if converged:
            targets.pop()
            halved = max(0, halved - 1)
            state = solid.model.from_variables()
            for body in solid.meshes:
                solid.model.set_variable(f"w{body}", solid.model.variable(f"u{body}"))
            result.update(time=t, increments=result["increments"] + 1)
            for number, force in solid.forces().items():
                result["forces"].setdefault(number, []).append([t, *force])
        else:
            solid.model.to_variables(state)
            halved += 1
            result["cut-backs"] += 1
            if halved > HALVINGS:
                break
            targets.append((result["time"] + t) / 2)
        result["finished"] = not targets
        if result["finished"]:
            result["displacements"] = solid.displacements()
        with open("result.json", "w", encoding="utf-8") as file:
            json.dump(result, file)
        print(f"t = {result['time']:g}, {result['iterations']} iterations, {result['cut-backs']} cut-backs", flush=True)


if __name__ == "__main__":
    main()
