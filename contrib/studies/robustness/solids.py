"""Forces that the deformed bodies exert on their nodes and the energy that they store, integrated anew from the displacements in
bodies.vtu with the laws of theory.md (sections 2 to 4)."""

import numpy as np

import geometry

# A node may be out of balance by so much of the largest nodal force; a geometry loop ends with up to 2e-3 (judge: the same).
NODES, NODES_LOOPS = 1e-4, 2e-3


def moduli(material):
    """Lame's lambda and mu of a material (keys of a parameter file)."""
    e, nu = float(material["Young's modulus"]), float(material["Poisson's ratio"])
    return e * nu / ((1 + nu) * (1 - 2 * nu)), e / (2 * (1 + nu))


def stress(material, F):
    """First Piola-Kirchhoff stress (n, 3, 3) and stored energy (n,) per reference volume at F (n, 3, 3), (B6) and (B7)."""
    lame, mu = moduli(material)
    one = np.eye(3)
    trace = lambda a: np.einsum("qii->q", a)
    at = lambda s: s[:, None, None]
    if material["Law"] == "linear elastic":
        e = (F + np.swapaxes(F, 1, 2)) / 2 - one
        return lame * at(trace(e)) * one + 2 * mu * e, lame / 2 * trace(e) ** 2 + mu * (e**2).sum((1, 2))
    C = np.swapaxes(F, 1, 2) @ F
    if material["Law"] == "St Venant-Kirchhoff":
        e = (C - one) / 2
        return F @ (lame * at(trace(e)) * one + 2 * mu * e), lame / 2 * trace(e) ** 2 + mu * (e**2).sum((1, 2))
    A, J = np.linalg.inv(C), np.linalg.det(F)
    if material["Law"] == "neo-Hookean":
        log = np.log(J)
        return F @ (mu * one + at(lame * log - mu) * A), mu / 2 * (trace(C) - 3) - mu * log + lame / 2 * log**2
    ratio = float(material["Mooney-Rivlin ratio"])
    c10 = mu / (2 * (1 + ratio))
    c01, bulk = ratio * c10, lame + 2 * mu / 3
    i1 = trace(C)
    i2 = (i1**2 - (C**2).sum((1, 2))) / 2
    a, b = 2 * c10 * J ** (-2 / 3), 2 * c01 * J ** (-4 / 3)
    q = a / 3 * i1 + 2 * b / 3 * i2 - bulk * (J - 1) * J
    energy = c10 * (J ** (-2 / 3) * i1 - 3) + c01 * (J ** (-4 / 3) * i2 - 3) + bulk / 2 * (J - 1) ** 2
    return F @ (at(a) * one + at(b) * (at(i1) * one - C) - at(q) * A), energy


class Solid:
    """The cells of one body: gradients of the shape functions and volumes at (p + 1)^3 Gauss points a cell."""

    def __init__(self, bodies, body, material, mean_dilatation):
        self.material, self.mean = material, mean_dilatation
        cells = bodies.cells[bodies.body[bodies.cells[:, 0, 0, 0]] == body]
        self.cells = cells.reshape(len(cells), -1)
        p = bodies.degree
        s, w = geometry.line_rule("Gauss", p + 1)
        zeta, eta, xi = (a.ravel() for a in np.meshgrid(s, s, s, indexing="ij"))
        self.weights = np.einsum("i,j,k->ijk", w, w, w).ravel()
        flat, d1, d2 = geometry.shape(p, xi, eta)
        up, _, _ = geometry.shape(p, zeta, np.zeros_like(zeta))
        _, dup, _ = geometry.shape(p, zeta, np.zeros_like(zeta))
        up, dup = up[:, : p + 1], dup[:, : p + 1]
        product = lambda z, xy: (z[:, :, None] * xy[:, None]).reshape(len(xi), -1)
        local = np.stack([product(up, d1), product(up, d2), product(dup, flat)], 2)  # (q, nodes, 3)
        jacobian = np.einsum("eac,qad->eqcd", bodies.X[self.cells], local)
        self.gradient = np.einsum("qad,eqdc->eqac", local, np.linalg.inv(jacobian))
        self.volume = np.linalg.det(jacobian) * self.weights
        modes = np.ones((len(xi), 1)) if p == 1 else np.stack([np.ones_like(xi), 2 * xi - 1, 2 * eta - 1, 2 * zeta - 1], 1)
        mass = np.einsum("eq,qk,ql->ekl", self.volume, modes, modes)
        self.mean_of = lambda f: np.einsum("qk,ekl,rl,er->eq", modes, np.linalg.inv(mass), modes, self.volume * f)

    def forces(self, u):
        """Internal forces on all nodes (n, 3) and stored energy."""
        F = np.eye(3) + np.einsum("eac,eqad->eqcd", u[self.cells], self.gradient)
        shape = F.shape
        law = lambda f: [a.reshape(shape[:2] + a.shape[1:]) for a in stress(self.material, f.reshape(-1, 3, 3))]
        trace = lambda a: np.einsum("eqii->eq", a)[..., None, None]
        one = np.eye(3)
        if not self.mean:
            P, energy = law(F)
        elif self.material["Law"] == "linear elastic":  # B-bar
            volume = trace(F) - 3
            P, energy = law(F + (self.mean_of(volume[..., 0, 0])[..., None, None] - volume) / 3 * one)
            P = P + (self.mean_of(trace(P)[..., 0, 0])[..., None, None] - trace(P)) / 3 * one
        else:
            J = np.linalg.det(F)
            theta = self.mean_of(J)
            bar = (theta / J)[..., None, None] ** (1 / 3) * F
            P, energy = law(bar)
            tau = P @ np.swapaxes(bar, 2, 3)
            pressure = self.mean_of(trace(tau)[..., 0, 0] / (3 * theta))
            tau = tau - trace(tau) / 3 * one + (J * pressure)[..., None, None] * one
            P = tau @ np.swapaxes(np.linalg.inv(F), 2, 3)
        force = np.zeros_like(u)
        np.add.at(force, self.cells, np.einsum("eq,eqcd,eqad->eac", self.volume, P, self.gradient))
        return force, (self.volume * energy).sum()


def check_equilibrium(find, state, row_of, step):
    """Balance of each node under stresses, loads, springs and contact (B1); reactions of each condition. row_of: condition -> its
    force in reactions.csv; step: the largest displacement in the increment. What single precision leaves is measured:
    forces at displacements changed by their last digit."""
    t, u, bodies, case = state.t, state.u, state.bodies, state.case
    tolerance = NODES_LOOPS if state.fixed_point else NODES
    internal, noise, stored, blur = np.zeros_like(u), np.zeros(len(u)), 0.0, 0.0
    random = np.random.default_rng(1).uniform(-1, 1, u.shape) * geometry.SINGLE
    for b, (material, mean) in enumerate(zip(case.facts["materials"], case.facts["mean dilatation"]), 1):
        solid = Solid(bodies, b, material, mean)
        force, energy = solid.forces(u)
        shaken, shaken_energy = solid.forces(u * (1 + random))
        # laws see I + grad u: energies are resolved to 1e-13 of moduli times volumes (theory.md, 31)
        blur += 4 * abs(shaken_energy - energy) + 1e-13 * float(material["Young's modulus"]) * solid.volume.sum()
        internal, stored = internal + force, stored + energy
        digits = 1e-14 * float(material["Young's modulus"]) * solid.volume.sum() ** (2 / 3)
        noise[bodies.body == b] = 4 * np.linalg.norm(shaken - force, axis=1)[bodies.body == b].max() + digits
    contact, unknown = np.zeros_like(u), np.zeros(len(u), bool)
    for pair in state.pairs:
        if pair.rows is None:  # who has the forces of integration points on the master side no file says
            contact[pair.nodes] += pair.force
            unknown[pair.master.nodes] = True
        else:
            force, spread = pair.rows.force(pair.force)
            # areas are known as well as their rules
            loose, _ = pair.rows.force(pair.force * (pair.area_spread / pair.area)[:, None])
            contact, noise = contact + force, noise + spread + np.linalg.norm(loose, axis=1)
    missing = internal - state.loads() - contact  # what reactions do
    # forces below 1e-5 of those that hold the softest body in its place are none to the program either (theory.md, 22)
    floor = 1e-5 * min(float(m["Young's modulus"]) for m in case.facts["materials"]) * min(p.cell for p in state.pairs) * step
    scale = max(np.linalg.norm(internal, axis=1).max(), np.linalg.norm(contact, axis=1).max(), floor)
    held = np.zeros(len(u), bool)
    for c in case.conditions:
        if c["Type"] == "displacement":
            on = state.weights[c["Name"]] != 0
            held |= on
            off = missing[on].sum(axis=0) - row_of[c["Name"]]
            size = np.linalg.norm(missing[on], axis=1).sum() + scale
            find.compare("reactions against stresses, beyond round-off",
                         max(np.linalg.norm(off) - noise[on].sum(), 0) / size, tolerance, t, c["Name"])  # fmt: skip
    free = ~held & ~unknown
    rest = np.maximum(np.linalg.norm(missing, axis=1) - noise, 0)
    if scale > 0:
        find.compare("nodes out of balance, beyond round-off", rest[free] / scale, tolerance, t)
    for b in np.unique(bodies.body[unknown]):  # what nobody knows of each node is known of all together
        on = unknown & (bodies.body == b)
        pairs = [pair for pair in state.pairs if pair.rows is None and int(pair.keys["Master body"]) == b]
        if not held[on].any():
            off = np.linalg.norm(missing[on].sum(axis=0) - sum(pair.master_force for pair in pairs)) - noise[on].sum()
            off /= max(sum(pair.scale for pair in pairs), scale, 1e-300)
            find.compare("master force against stresses, beyond round-off", off, tolerance, t)
    for c in case.conditions:
        if c["Type"] == "spring":
            stored += state.springs(c)[1]
    return stored, blur
