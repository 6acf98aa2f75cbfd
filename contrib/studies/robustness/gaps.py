"""Gaps, areas and jump operators of a contact pair, computed anew from the deformed surfaces for each scheme (theory.md, 6 to 8).

Signs are those of theory.md: normals from slave to master, distances positive inside; the gap of users is minus the distance.
"""

import collections

import numpy as np

import geometry
from geometry import shape

FLUSH = 0.01  # of TOLERANCE: sites beyond a rim by no more are on it, however deep
TOLERANCE = 0.05  # Projection tolerance by default [face sizes]; sites that were closed keep their partner up to twice that
# Spreads of master nodes that balance moments [areas around a node], as of geometry.fading (section 7): when their own count, and
# when those around them do not share.
SPREAD, APART = (1e-5, 1e-6), (1e-2, 1e-4)
# Covered parts of the surface around a node (J9): from the first one on it does not share its part out; one that has a constraint
# does not from the second one on.
WELL_COVERED, STILL_COVERED = 0.2, 0.1


class Rows:
    """Sites of a pair: distance (k,), normal (k, 3), area (k,), paired (k,), unsure (k,): nobody can tell without the history; g
    (k, n) the jump operator on all nodes of the bodies, turn (k, n, 3) what normal displacements add along the surface (J5), slave
    (n,) which nodes are of the slave."""

    def __init__(self, k, n):
        self.distance, self.normal, self.area = np.zeros(k), np.zeros((k, 3)), np.zeros(k)
        self.paired, self.unsure = np.zeros(k, bool), np.zeros(k, bool)
        self.g, self.turn, self.slave = np.zeros((k, n)), np.zeros((k, n, 3)), np.zeros(n, bool)
        self.whole = self.area  # (k,) of the surface around a node, covered or not
        self.others = []  # the same with other rules

    def jump(self, field):
        """Of the sites (k, 3), of a field (n, 3) on the nodes; and how much other rules change it (k,)."""
        jump = self._jump(field)
        return jump, max_of([np.linalg.norm(other._jump(field) - jump, axis=1) for other in self.others], len(jump))

    def _jump(self, field):
        return self.g @ field + np.einsum("kne,kn->ke", self.turn, self.normal @ field.T)

    def force(self, on_slave):
        """On all nodes (n, 3), of forces (k, 3) on the slave at its sites; and how much other rules change it (n,)."""
        force = self._force(on_slave)
        return force, max_of([np.linalg.norm(other._force(on_slave) - force, axis=1) for other in self.others], len(force))

    def _force(self, on_slave):
        return self.g.T @ on_slave + np.einsum("kne,ke->kn", self.turn, on_slave).T @ self.normal

    def drop(self, sites):
        self.g[sites], self.turn[sites] = 0, 0

    def spread(self):
        """How much other rules change distances, areas and normals, (k,) each."""
        k = len(self.distance)
        return (max_of([np.abs(other.distance - self.distance) for other in self.others], k),
                max_of([np.abs(other.area - self.area) for other in self.others], k),
                max_of([np.abs(other.normal - self.normal).max(axis=1) for other in self.others], k))  # fmt: skip


def max_of(fields, n):
    # the errors of two rules of the same degree are of the same size, not the same
    return 4 * np.max(fields, axis=0) if fields else np.zeros(n)


class Pair:
    """Both surfaces of a pair (keys: the dictionary of its parameters) at one time."""

    def __init__(self, bodies, keys, slave_faces, master_faces):
        smoothed = keys.get("Surface", "smoothed") == "smoothed"
        self.keys, self.bodies, self.degree = keys, bodies, bodies.degree
        self.clearance = 0.0  # that slave nodes may be inside [length]
        self.slave = geometry.Surface(bodies, slave_faces, smoothed)
        self.master = geometry.Surface(bodies, master_faces, smoothed)
        self.kind = keys.get("Normal", "averaged")
        self.friction = float(keys.get("Friction coefficient", 0)) > 0 or "tied" in keys.get("Contact law", "") or keys.get("Friction law") == "Tresca"
        self.nodes = self.slave.nodes
        box = bodies.x[self.master.nodes]
        self.reach = 0.25 * np.linalg.norm(np.ptp(box, axis=0))
        self.row = np.full(len(bodies.x), -1)
        self.row[self.nodes] = np.arange(len(self.nodes))
        self.faces = self.row[self.slave.faces]  # with numbers of slave nodes
        self.node_normal = np.zeros((len(self.nodes), 3))
        np.add.at(self.node_normal, self.faces.ravel(), self.slave.nodal_normal.reshape(-1, 3))
        self.node_normal /= np.linalg.norm(self.node_normal, axis=1)[:, None]

    def _empty(self):
        rows = Rows(len(self.nodes), len(self.bodies.x))
        rows.slave[self.nodes] = True
        return rows

    def compute(self, preferred, had_partner):
        """Rows of the slave nodes: their own jumps, or averaged ones (J1). preferred (k, 3): normals that decide where two faces
        are equally near, or where only the history tells whether a node beyond the rim has a closest point. had_partner (k,):
        what decides where only the history tells whether a node shares its part out."""
        rows = self._empty()
        x = self.bodies.x[self.nodes]
        face, xi, eta, over, ties = self.master.closest(x, self.node_normal)
        found = face >= 0
        found[found] = np.linalg.norm(x[found] - self.master.at(face[found], xi[found], eta[found])[0], axis=1) <= self.reach
        if self.kind == "slave":
            choices = np.arange(len(x))[found], self.node_normal[found]
        else:
            choices = ties[0], self.normal_of_master(*ties[1:4])
        over[ties[0]] = np.inf
        np.minimum.at(over, ties[0], ties[4])  # whether a node has a partner depends on the face
        if self.keys["Scheme"] == "integration point":  # frames of the multipliers alone
            rows.normal[:] = self.node_normal
            hit = np.where(found)[0]
            normals = self.node_normal[hit] if self.kind == "slave" else self.normal_of_master(face[hit], xi[hit], eta[hit])
            depth, sunk = ((x[hit] - self.master.at(face[hit], xi[hit], eta[hit])[0]) * normals).sum(1), over.copy()
            sunk[hit] = self.sunk(depth, over[hit], face[hit])  # which what had a partner does not mind
            beyond = np.where(found & (np.maximum(over, sunk) > 0.9 * TOLERANCE))[0]
            use = found[choices[0]] & (over <= 2 * TOLERANCE)[choices[0]]
            choose(rows.normal, preferred, np.concatenate([choices[0][use], beyond]),
                   np.concatenate([choices[1][use], self.node_normal[beyond]]))  # fmt: skip
            return rows
        if self.keys["Scheme"] == "averaged":
            if self.keys.get("Integration", "segment") == "face":
                self._averaged(rows, self._face_points(False), found, over, choices, preferred, had_partner)
                # single precision does not tell on which of two faces a point is
                rows.others.append(self._averaged(self._empty(), self._face_points(True), found, over, choices, preferred, had_partner))
                return rows
            # hats and warped faces are integrated by no rule exactly: other triangles and a finer rule show how much is left
            overlaps = Segments(self.slave, self.master, self.reach)
            self._averaged(rows, overlaps.points(0), found, over, choices, preferred, had_partner)
            for points in (overlaps.points(1), overlaps.points(0, fine=True)):
                rows.others.append(self._averaged(self._empty(), points, found, over, choices, preferred, had_partner))
            return rows
        rows.paired = found & (over <= TOLERANCE)
        rows.unsure = found & (over > 0.9 * TOLERANCE) & (over <= 2 * TOLERANCE)
        hit = np.where(found)[0]
        rows.normal[:] = self.node_normal
        chosen = choose(rows.normal, preferred, *choices)
        if self.kind != "slave":  # the closest point is that of the face whose normal was chosen
            sites = ties[0][chosen]
            face[sites], xi[sites], eta[sites] = ties[1][chosen], ties[2][chosen], ties[3][chosen]
        face, xi, eta = face[hit], xi[hit], eta[hit]
        rows.distance[hit] = ((x[hit] - self.master.at(face, xi, eta)[0]) * rows.normal[hit]).sum(1) - self.clearance
        rows.unsure[hit] |= rows.paired[hit] & (self.sunk(rows.distance[hit], over[hit], face) > TOLERANCE)
        rows.g[hit, self.nodes[hit]] = 1
        np.subtract.at(rows.g, (hit[:, None], self.master.faces[face]), shape(self.degree, xi, eta)[0])
        masters = self.master.faces[face]
        size = self.slave_size()
        for i, k in enumerate(hit):
            self._balance(rows, k, *self._shares_around(masters[i], rows.g[k, masters[i]], rows.normal[k]), size)
        # trapezoids, Simpson's rule, or p + 2 Gauss points (section 8), current configuration
        lumped = self.keys.get("Weights", "nodal quadrature") == "nodal quadrature"
        xi, eta, w = geometry.square_rule("Newton-Cotes" if lumped else "Gauss", self.degree + (1 if lumped else 2))
        self.add_areas(rows.area, xi, eta, w)
        return rows

    def normal_of_master(self, face, xi, eta):
        if self.kind == "averaged":
            return -self.master.normal(face, xi, eta, True)
        return -self.master.facet_normal(face, xi, eta)

    def add_areas(self, area, xi, eta, w):
        f = np.repeat(np.arange(len(self.faces)), len(w))
        xi, eta, w = (np.tile(v, len(self.faces)) for v in (xi, eta, w))
        part = w[:, None] * self.slave.element(f, xi, eta)[:, None] * shape(self.degree, xi, eta)[0]
        np.add.at(area, self.faces[f], part)

    def points(self, kind, n, tolerance, last=False):
        """Points of a fixed rule on all slave faces with their closest master points: f, xi, eta, w, face, xi', eta', overhang;
        face -1 where there is none."""
        xi, eta, w = geometry.square_rule(kind, n)
        f = np.repeat(np.arange(len(self.faces)), len(w))
        xi, eta, w = (np.tile(v, len(self.faces)) for v in (xi, eta, w))
        x = self.slave.at(f, xi, eta)[0]
        averaged = self.keys["Scheme"] == "integration point"
        face, a, b, over, _ = self.master.closest(x, self.slave.normal(f, xi, eta, averaged), last)
        far = np.linalg.norm(x - self.master.at(face, a, b)[0], axis=1) > self.reach
        face[far | (over > tolerance)] = -1
        return f, xi, eta, w, face, a, b, over

    def point_rule(self):
        kind = self.keys.get("Quadrature rule", "Gauss")
        return kind, self.degree + 1 if kind == "Gauss" else 2 * self.degree + 1

    def sunk(self, depth, over, face):
        """How far sites are beyond the rim of the master [face sizes], their depth [length] included where they are below it: what slid
        off and sunk finds no partner again, what had one keeps it."""
        below = np.maximum(depth, 0) / self.master.size[face]
        return np.where(over > FLUSH * TOLERANCE, np.hypot(over, below), over)

    def integration_points(self):
        """Distance, face, local coordinates, weights with area, whether they have a partner, how far they hang over the rim
        [Projection tolerance] (n,), and normals (n, 3) of the points of an integration point pair."""
        f, xi, eta, w, face, a, b, over = self.points(*self.point_rule(), 2 * TOLERANCE)
        hit = np.where(face >= 0)[0]
        distance, normal = np.full(len(f), -np.inf), self.slave.normal(f, xi, eta, True)
        if self.kind != "slave":
            normal[hit] = self.normal_of_master(face[hit], a[hit], b[hit])
        apart = self.slave.at(f[hit], xi[hit], eta[hit])[0] - self.master.at(face[hit], a[hit], b[hit])[0]
        distance[hit] = (apart * normal[hit]).sum(1)
        over[hit] = self.sunk(distance[hit], over[hit], face[hit])
        return distance, f, xi, eta, w * self.slave.element(f, xi, eta), face >= 0, over / TOLERANCE, normal

    def _face_points(self, last):
        """Points of a fixed rule, which fade out beyond the rim (J7), and the covered fraction of each face."""
        rule = "Gauss", 6 if self.degree == 1 else 10
        f, s, t, w, m, a, b, over = self.points(*rule, TOLERANCE, last)
        counts = np.where(m >= 0, np.maximum(0, 1 - 2 * over / TOLERANCE), 0)
        coverage = np.bincount(f, w * counts, len(self.faces))  # in local coordinates
        keep = counts > 0
        return [v[keep] for v in (f, s, t, w * counts, m, a, b)] + [coverage, np.ones_like(coverage)]

    def _averaged(self, rows, points, found, over, choices, preferred, had_partner):
        """(J1) to (J4), (J9), (J10). Nodes that have a closest point themselves take the normal there: one of choices (site, normal)."""
        f, s, t, w, m, a, b, coverage, counted = points
        phi, hat, theirs = shape(self.degree, s, t)[0], geometry.hats(self.degree, s, t), shape(self.degree, a, b)[0]
        n_faces = len(self.faces)
        w = w * self.slave.element(f, s, t)
        nn = phi.shape[1]
        mass, lump = np.zeros((n_faces, nn, nn)), np.zeros((n_faces, nn))
        np.add.at(mass, f, w[:, None, None] * phi[:, :, None] * phi[:, None])
        np.add.at(lump, f, w[:, None] * phi)
        dual_part = np.clip((coverage - 0.75) / 0.25, 0, 1)
        dual = np.zeros_like(mass)
        some = dual_part > 0
        dual[some] = dual_part[some, None, None] * lump[some][:, :, None] * np.linalg.inv(mass[some])
        psi = w[:, None] * (np.einsum("qab,qb->qa", dual[f], phi) + (1 - dual_part[f])[:, None] * hat)
        sums, exact, full = np.zeros((n_faces, nn)), np.zeros((n_faces, nn)), np.zeros((n_faces, nn))
        np.add.at(sums, f, psi)
        for u, v, weight in zip(*geometry.square_rule("Gauss", 4)):
            u, v = np.full(n_faces, u), np.full(n_faces, v)
            area = weight * self.slave.element(np.arange(n_faces), u, v)[:, None]
            exact += area * shape(self.degree, u, v)[0]
            full += area * geometry.hats(self.degree, u, v)
        exact_part = np.clip((coverage - 0.999) / 0.001, 0, 1)
        scale = 1 + exact_part[:, None] * (counted[:, None] * exact / np.where(sums == 0, 1, sums) - 1)
        psi *= scale[f]
        whole = np.zeros(len(self.nodes))
        np.add.at(whole, self.faces, dual_part[:, None] * exact + (1 - dual_part[:, None]) * full)
        passed, shared = self._share_out(sums * scale, whole, had_partner)
        psi, hat = (np.einsum("qab,qb->qa", passed[f], v) for v in (psi, hat))
        sites = self.faces[f]  # (q, nn)
        gap = self.slave.at(f, s, t)[0] - self.master.at(m, a, b)[0]
        across = self.slave.normal(f, s, t, True) if self.kind == "slave" else self.normal_of_master(m, a, b)
        mean, normal = np.zeros((len(self.nodes), 3)), np.zeros((len(self.nodes), 3))
        np.add.at(rows.area, sites, psi)
        np.add.at(mean, sites, psi[:, :, None] * gap[:, None])
        np.add.at(normal, sites, (w[:, None] * hat)[:, :, None] * across[:, None])
        np.add.at(rows.g, (sites[:, :, None], self.slave.faces[f][:, None]), psi[:, :, None] * phi[:, None])
        np.add.at(rows.g, (sites[:, :, None], self.master.faces[m][:, None]), -psi[:, :, None] * theirs[:, None])
        covered, rows.whole = rows.area / whole, whole
        rows.paired, rows.unsure = (covered > 0.02) & ~shared, np.abs(covered - 0.02) < 0.001
        rows.drop(~rows.paired)
        on = np.where(rows.paired)[0]
        rows.normal[:] = self.node_normal
        rows.normal[on] = normal[on] / np.linalg.norm(normal[on], axis=1)[:, None]
        # beyond the rim by 1 to 2 tolerances a node has a closest point if it had one: the mean is a choice like others
        own, maybe = found & (over <= TOLERANCE), found & (over > 0.9 * TOLERANCE) & (over <= 2 * TOLERANCE)
        use = rows.paired[choices[0]] & (own | maybe)[choices[0]]
        mean_too = np.where(rows.paired & maybe)[0]
        choose(rows.normal, preferred, np.concatenate([choices[0][use], mean_too]),
               np.concatenate([choices[1][use], rows.normal[mean_too]]))  # fmt: skip
        rows.g[on] /= rows.area[on, None]
        rows.distance[on] = (mean[on] * rows.normal[on]).sum(1) / rows.area[on]
        for k in on:
            masters = np.where((np.abs(rows.g[k]) > 1e-13) & ~rows.slave)[0]
            share = np.abs(rows.g[k, masters])
            if self.keys.get("Integration", "segment") == "face":
                masters, share = self._shares_around(masters, share, rows.normal[k])
            else:
                masters, share = self._shares_around_one(masters, share, rows.normal[k], whole[k])
            self._balance(rows, k, masters, share, np.sqrt(whole[k]))
        # nodes without partner have the area of their whole surface
        plain = np.zeros(len(self.nodes))
        xi, eta, w = geometry.square_rule("Newton-Cotes", self.degree + 1)
        self.add_areas(plain, xi, eta, w)
        rows.area[~rows.paired] = plain[~rows.paired]
        return rows

    def _share_out(self, areas, whole, had_partner):
        """(J9), areas (faces, nodes) that are covered: parts (faces, nodes, nodes) of the psi of each node of a face that are in the
        rows of each; and which nodes share theirs out (k,)."""
        area = np.bincount(self.faces.ravel(), areas.ravel(), len(self.nodes))
        well = area >= np.where(had_partner, STILL_COVERED, WELL_COVERED) * whole
        alone = (areas > 0) & ~well[self.faces].any(axis=1)[:, None]
        shared = (area > 0) & ~well
        shared[self.faces[alone]] = False
        takes = well[self.faces] / np.maximum(1, well[self.faces].sum(axis=1))[:, None]
        kept = np.where(shared[self.faces], 0, 1)[:, :, None] * np.eye(areas.shape[1])
        return kept + takes[:, :, None] * shared[self.faces][:, None], shared

    def slave_size(self):
        """Of the mean slave face in the reference."""
        corners = self.bodies.X[self.slave.faces.reshape(len(self.slave.faces), -1)]
        a, b = corners[:, -1] - corners[:, 0], corners[:, -1 - self.degree] - corners[:, self.degree]
        return np.sqrt(np.mean(0.5 * np.linalg.norm(np.cross(a, b), axis=1)))

    def _shares_around(self, nodes, weights, normal):
        """(J6): nodes and their shares."""
        m, shares = self.master, collections.defaultdict(float)
        for node, weight in zip(nodes, np.abs(weights)):
            faces, places = np.where(m.faces == node)
            belongs = geometry.fading(-m.unit[faces, places] @ normal, geometry.SMOOTH, geometry.SHARP)
            if belongs.sum() < 0.1:
                shares[node] += weight
                continue
            for face, place, part in zip(faces, places, belongs / belongs.sum()):
                j, i = divmod(place, m.n)
                beside = m.faces[face].reshape(m.n, m.n)[max(j - 1, 0) : j + 2, max(i - 1, 0) : i + 2].ravel()
                for other in beside:
                    shares[other] += weight * part / len(beside)
        return np.array(list(shares)), np.array(list(shares.values()))

    def _shares_around_one(self, nodes, weights, normal, area):
        """Those of the nodes, and (J6) as far as these are in one place or line."""
        y = (self.bodies.x[nodes] - weights @ self.bodies.x[nodes] / weights.sum()) @ (np.eye(3) - np.outer(normal, normal))
        smaller = np.linalg.eigvalsh(np.einsum("e,ei,ej->ij", weights, y, y))[1]  # 0 along the normal
        part = 1 - geometry.fading(smaller / area, *APART)
        if part == 0:
            return nodes, weights
        around, shares = self._shares_around(nodes, weights, normal)
        total = collections.defaultdict(float, zip(around, part * shares))
        for node, weight in zip(nodes, weights):
            total[node] += weight
        return np.array(list(total)), np.array(list(total.values()))

    def _balance(self, rows, k, masters, share, size):
        """(J4), (J5): master weights that put the (mean) master point on the normal through the slave point, and turns for what is
        left along it."""
        x, n, g = self.bodies.x, rows.normal[k], rows.g[k]
        across = np.eye(3) - np.outer(n, n)
        v = across @ (g @ x)
        length = np.linalg.norm(v)
        limit = 0.5 * size
        v *= min(1.0, limit / max(length, 1e-300))
        y = (x[masters] - share @ x[masters] / share.sum()) @ across
        values, axes = np.linalg.eigh(np.einsum("e,ei,ej->ij", share, y, y))
        part = geometry.fading(values / size**2, *SPREAD)
        factor = np.where(part > 0, part / np.where(part > 0, values, 1), 0)
        slope = share[:, None] * (y @ ((axes * factor) @ axes.T))
        g[masters] -= slope @ v
        if self.friction:
            rows.turn[k, masters] = np.clip(n @ (g @ x) - self.clearance, -limit, limit) * slope


def choose(normals, preferred, sites, choices):
    """Sets normals (k, 3) of sites (c,) to those of their choices (c, 3) that are nearest to the preferred ones (k, 3). Returns which
    choices were taken, one of each site."""
    order = np.lexsort((np.linalg.norm(choices - preferred[sites], axis=1), sites))
    order = order[np.unique(sites[order], return_index=True)[1]]
    normals[sites[order]] = choices[order]
    return order


class Segments:
    """Overlaps of the master with the slave in the planes of slave cells (faces, quarters for degree 2)."""

    def __init__(self, slave, master, reach):
        self.slave, self.master, self.reach = slave, master, reach
        (self.sf, self.su, self.sc), (self.mf, self.mu, mc) = quarters(slave), quarters(master)
        sc = self.sc
        self.diagonal = np.cross(sc[:, 2] - sc[:, 0], sc[:, 3] - sc[:, 1])
        normal = self.diagonal / np.linalg.norm(self.diagonal, axis=1)[:, None]
        theirs = np.cross(mc[:, 2] - mc[:, 0], mc[:, 3] - mc[:, 1])
        theirs /= np.linalg.norm(theirs, axis=1)[:, None]
        e1 = sc[:, 1] - sc[:, 0]
        e1 -= (e1 * normal).sum(1)[:, None] * normal
        e1 /= np.linalg.norm(e1, axis=1)[:, None]
        self.axes = np.stack([e1, np.cross(normal, e1)], 1)  # (cells, 2, 3)
        flat = np.einsum("sac,skc->ska", self.axes, sc - sc[:, :1])
        shadow = np.einsum("sac,smkc->smka", self.axes, mc[None] - sc[:, None, :1])
        self.part = geometry.fading(-(theirs @ normal.T).T, geometry.FACING, geometry.FLANK)
        near = self.part > 0
        for c in range(2):
            near &= (shadow[..., c].max(2) > flat[..., c].min(1)[:, None]) & (shadow[..., c].min(2) < flat[..., c].max(1)[:, None])
        self.polygons = [(s, m, clip(flat[s], shadow[s, m][::-1])) for s, m in zip(*np.where(near))]
        with np.errstate(divide="ignore", invalid="ignore"):  # those across have no part
            rises = theirs / (normal @ theirs.T)[..., None]  # of planes of master cells, (s, m, 3)
        self.height = np.einsum("smc,smc->sm", mc.mean(1) - sc[:, None, 0], rises)  # over the plane of the slave cell
        self.slope = -np.einsum("sac,smc->sma", self.axes, rises)

    def points(self, first, fine=False):
        """Points on triangles around corner `first` of each overlap: f, xi, eta, w (without element of area), master face, xi', eta';
        the covered fraction of each slave face, and the mean part that its points count with."""
        slave, master, p = self.slave, self.master, self.slave.degree
        rule, weight = geometry.triangle_rule(p, fine)
        cell, other, at, area = [], [], [], []
        for s, m, polygon in self.polygons:
            polygon = polygon[first % max(len(polygon), 1) :] + polygon[: first % max(len(polygon), 1)]
            for a, b in zip(polygon[1:-1], polygon[2:]):
                a, b = a - polygon[0], b - polygon[0]
                cell.append(s), other.append(m), area.append(0.5 * (a[0] * b[1] - a[1] * b[0]))
                at.append(polygon[0] + rule[:, :1] * a + rule[:, 1:] * b)
        cell, other = np.repeat(np.array(cell, int), len(weight)), np.repeat(np.array(other, int), len(weight))
        at, area = np.array(at).reshape(-1, 2), np.outer(area, weight).ravel()
        f, m, axes, origin = self.sf[cell], self.mf[other], self.axes[cell], self.sc[cell, 0]
        xi, eta, det, _ = invert(at, slave.x[slave.faces[f]], p, axes, origin, self.su[cell])
        x = slave.at(f, xi, eta)[0]
        straight = np.einsum("qac,qc->qa", axes, x - origin)
        a, b, _, good = invert(straight, master.shape_points[m], master.shape_degree, axes, origin, self.mu[other])
        good &= np.linalg.norm(master.at(m, a, b)[0] - x, axis=1) <= self.reach
        whole = 0.5 * np.linalg.norm(self.diagonal, axis=1)
        part = self.part[cell, other] * self.seen(cell, other, at)
        once, twice = (np.bincount(f, area * good * p, len(slave.faces)) for p in (part, part**2))
        counted = np.divide(twice, once, out=np.ones_like(once), where=once > 0)
        coverage = once / np.bincount(self.sf, whole, len(slave.faces)) / counted
        return [v[good] for v in (f, xi, eta, part * area / det, m, a, b)] + [coverage, counted]

    def seen(self, cell, other, at):
        """What nearer master cells leave of the part of each point (J11)."""
        left = np.ones(len(cell))
        own = np.abs(self.height[cell, other] + (self.slope[cell, other] * at).sum(1)) - 1e-6 * self.reach
        first, last = np.searchsorted(cell, np.arange(len(self.sf))), np.searchsorted(cell, np.arange(len(self.sf)), "right")
        for s, m, polygon in self.polygons:
            here = np.arange(first[s], last[s])
            before = np.abs(self.height[s, m] + at[here] @ self.slope[s, m]) < own[here]
            for q in here[before & (self.mf[other[here]] != self.mf[m])]:
                if polygon and inside(polygon, at[q]):
                    left[q] = min(left[q], 1 - self.part[s, m])
        return left


def inside(polygon, p):
    """Of a convex one, counterclockwise."""
    ends = np.roll(polygon, -1, axis=0)
    return all((b[0] - a[0]) * (p[1] - a[1]) >= (b[1] - a[1]) * (p[0] - a[0]) for a, b in zip(polygon, ends))


def quarters(surface):
    """Cells of each face: face (c,), local coordinates of their middles (c, 2), corners (c, 4, 3) counterclockwise."""
    p, face, middle, corner = surface.degree, [], [], []
    grid = surface.faces.reshape(-1, p + 1, p + 1)
    for j in range(p):
        for i in range(p):
            face.append(np.arange(len(grid)))
            middle.append(np.tile([(i + 0.5) / p, (j + 0.5) / p], (len(grid), 1)))
            corner.append(surface.x[np.stack([grid[:, j, i], grid[:, j, i + 1], grid[:, j + 1, i + 1], grid[:, j + 1, i]], 1)])
    return np.concatenate(face), np.concatenate(middle), np.concatenate(corner)


def clip(window, polygon):
    """The part of a convex polygon inside a convex window, both counterclockwise lists of points in the plane."""
    for a, b in zip(window, np.roll(window, -1, axis=0)):
        inside = [(b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]) for p in polygon]
        rest = []
        for i, p in enumerate(polygon):
            k = (i + 1) % len(polygon)
            if inside[i] >= 0:
                rest.append(p)
            if inside[i] * inside[k] < 0:
                rest.append(p + inside[i] / (inside[i] - inside[k]) * (polygon[k] - p))
        polygon = rest
        if len(polygon) < 3:
            return []
    return polygon


def invert(at, points, degree, axes, origin, start):
    """Local coordinates at which faces (points (q, nodes, 3)) are seen at places `at` (q, 2) of planes; the area in the plane over
    that in local coordinates; whether that was found."""
    flat = np.einsum("qac,qnc->qna", axes, points - origin[:, None])
    xi, eta = start[:, 0].copy(), start[:, 1].copy()
    for _ in range(30):
        values, d1, d2 = (np.einsum("qn,qna->qa", s, flat) for s in shape(degree, xi, eta))
        r = at - values
        det = d1[:, 0] * d2[:, 1] - d1[:, 1] * d2[:, 0]
        step = (r[:, 0] * d2[:, 1] - r[:, 1] * d2[:, 0]) / det, (d1[:, 0] * r[:, 1] - d1[:, 1] * r[:, 0]) / det
        xi, eta = np.clip(xi + step[0], -9, 9), np.clip(eta + step[1], -9, 9)
        size = np.abs(step[0]) + np.abs(step[1])
        if size.max(initial=0) < 1e-12:
            break
    return xi, eta, np.abs(det), size < 1e-8
