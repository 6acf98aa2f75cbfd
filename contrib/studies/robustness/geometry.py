"""Surfaces of bodies measured anew from bodies.vtu: smoothed faces, closest points, gaps of all schemes, depths. Written from
theory.md (sections 6 to 8) and not from the program; nothing here reads a gap, a normal, an area or a partner that nodus wrote.

Lengths are those of the file. Faces are [eta, xi] lattices of nodes with xi x eta outward, local coordinates in [0, 1].
Not handled: hanging nodes, planes of symmetry through contact edges, rigid masters in closed form.
"""

import numpy as np

SINGLE = 6e-8  # files hold single precision, relative
SMOOTH, SHARP = 0.70710678, 0.5  # faces that meet at less than 45 degrees have a common normal, at more than 60 none
FAR_SIDE = 0.5  # a face that looks along the slave normal is the far side of a body
FACING, FLANK = 0.70710678, 0.25881905  # master faces count in full within 45 degrees, from 75 on not at all
# Symmetric rules on triangles (Dunavant 1985), degrees 4 and 8: weight and barycentric a of (a, a, 1 - 2a); all their weights
# add up to 1.
_RULES = {1: ([(0.223381589678011, 0.445948490915965), (0.109951743655322, 0.091576213509771)], None, None),
          2: ([(0.095091634267285, 0.459292588292723), (0.103217370534718, 0.170569307751760),
               (0.032458497623198, 0.050547228317031)], 0.144315607677787,
              (0.027230314174435, 0.263112829634638, 0.008394777409958))}  # fmt: skip


def triangle_rule(degree, fine=False):
    """Points (n, 2) and weights (n,) with sum 1, on the triangle (0,0), (1,0), (0,1); fine: on each quarter of it."""
    orbits, centre, general = _RULES[degree]
    points, weights = [], []
    for weight, a in orbits:
        points += [(a, a), (a, 1 - 2 * a), (1 - 2 * a, a)]
        weights += [weight] * 3
    if centre:
        weight, a, b = general
        points += [(1 / 3, 1 / 3)] + [(s, t) for s in (a, b, 1 - a - b) for t in (a, b, 1 - a - b) if s != t]
        weights += [centre] + [weight] * 6
    points, weights = np.array(points), np.array(weights)
    if not fine:
        return points, weights
    quarters = [(points + corner) / 2 for corner in ([0, 0], [1, 0], [0, 1])] + [(1 - points) / 2]
    return np.concatenate(quarters), np.tile(weights / 4, 4)


def line_rule(kind, n):
    """Points and weights on [0, 1]: "Gauss", "Simpson" (composite, n odd) or "Newton-Cotes"."""
    if kind == "Gauss":
        x, w = np.polynomial.legendre.leggauss(n)
        return (x + 1) / 2, w / 2
    x = np.linspace(0, 1, n)
    if kind == "Simpson":
        w = np.full(n, 2.0)
        w[1::2], w[[0, -1]] = 4, 1
        return x, w / w.sum()
    return x, np.linalg.solve(np.vander(x, increasing=True).T, 1 / np.arange(1, n + 1))


def square_rule(kind, n):
    x, w = line_rule(kind, n)
    eta, xi = np.meshgrid(x, x, indexing="ij")
    return xi.ravel(), eta.ravel(), np.outer(w, w).ravel()


def shape(degree, xi, eta):
    """Values and both derivatives (3 arrays (n, (degree+1)^2)) of a face's functions at local coordinates (n,)."""
    def line(s):
        if degree == 1:
            return np.stack([1 - s, s], 1), np.stack([-np.ones_like(s), np.ones_like(s)], 1)
        return (np.stack([(1 - s) * (1 - 2 * s), 4 * s * (1 - s), s * (2 * s - 1)], 1),
                np.stack([4 * s - 3, 4 - 8 * s, 4 * s - 1], 1))  # fmt: skip

    (a, da), (b, db) = line(xi), line(eta)
    product = lambda y, x: (y[:, :, None] * x[:, None, :]).reshape(len(x), (degree + 1) ** 2)
    return product(b, a), product(b, da), product(db, a)


def hats(degree, xi, eta):
    """Bilinear hats of the nodes, for degree 2 on the quarters of a face (J2)."""
    line = lambda s: np.maximum(0, 1 - np.abs(degree * s[:, None] - np.arange(degree + 1)))
    return (line(eta)[:, :, None] * line(xi)[:, None, :]).reshape(len(xi), (degree + 1) ** 2)


def clusters(values, tolerance):
    """Labels of numbers that lie closer together than a tolerance."""
    order = np.argsort(values)
    label = np.empty(len(values), np.int64)
    label[order] = np.concatenate([[0], np.cumsum(np.diff(values[order]) > tolerance)])
    return label


class Bodies:
    """Nodes and boundary of bodies.vtu at one time: x, X (n, 3) deformed and reference positions, body (n,), node (points of
    the file,), faces (m, p+1, p+1) of the whole boundary, face_body (m,), degree p."""

    def __init__(self, mesh, scale):
        keys = [clusters(mesh.reference[:, c], 4e-6 * scale) for c in range(3)] + [np.round(mesh.fields["body"]).astype(int)]
        _, first, node = np.unique(np.column_stack(keys), axis=0, return_index=True, return_inverse=True)
        # in the order of the file, the same at all times: labels are not where coordinates differ by round-off alone
        self.node, first = np.argsort(np.argsort(first))[node.ravel()], np.sort(first)
        self.x, self.X, self.body = mesh.points[first], mesh.reference[first], keys[3][first]
        self.degree = mesh.cells.shape[1] - 1
        self.cells = c = self.node[mesh.cells]
        turned = lambda faces: np.swapaxes(faces, 1, 2)  # so that xi x eta looks outward
        faces = np.concatenate([turned(c[:, :, :, 0]), c[:, :, :, -1], c[:, :, 0], turned(c[:, :, -1]), turned(c[:, 0]), c[:, -1]])
        ends = np.sort(faces[:, [0, 0, -1, -1], [0, -1, 0, -1]], axis=1)
        _, once, count = np.unique(ends, axis=0, return_index=True, return_counts=True)
        self.faces = faces[once[count == 1]]
        self.face_body = self.body[self.faces[:, 0, 0]]

    def nearest(self, X, body):
        """Nodes of a body at reference positions, and how far they are from there."""
        own = np.where(self.body == body)[0]
        distance = np.linalg.norm(X[:, None] - self.X[own][None], axis=2)
        return own[distance.argmin(axis=1)], distance.min(axis=1, initial=np.inf)


def fading(cosine, all_, none):
    """(P6), (J8): 1 from the cosine all_ on, 0 below none, a smooth step between."""
    t = np.clip((cosine - none) / (all_ - none), 0, 1)
    return t**2 * (3 - 2 * t)


def geometric_median(points, counts, scale):
    """Of points (n, 2) by Weiszfeld's iteration; distances below a millionth of the scale are not told apart."""
    median = counts @ points / counts.sum()
    for _ in range(100):
        pull = counts / np.hypot(np.linalg.norm(points - median, axis=1), 1e-6 * scale)
        median = pull @ points / pull.sum()
    return median


def combination(tilts, target, parts):
    """(P7): parts >= 0 of sum one, near to the given ones, of tilts (n, 2) that add up to the target, or to what is nearest to it:
    exchanges between pairs."""
    parts, first, hold = parts.copy(), parts, 1e-6 * (tilts**2).sum()
    for _ in range(200):
        before = parts.copy()
        for a in range(len(parts)):
            for b in range(a):
                rest, apart = parts @ tilts - target, tilts[a] - tilts[b]
                pull = rest @ apart + hold * (parts[a] - first[a] - parts[b] + first[b])
                step = np.clip(-pull / (apart @ apart + 2 * hold), -parts[a], parts[b])
                parts[a], parts[b] = parts[a] + step, parts[b] - step
        if np.abs(parts - before).max() < 1e-9:
            break
    return parts


def share_at_node(own, unit, weight, seen, turn, inside, rim):
    """(P7): share of face `own` in the averaged normal of a node; unit normals of its faces there, and the normals that they see at
    the node from their middles and other corners, how far these are from those in the middles; whether their far corner is inside of
    the surface; direction of the rim or None."""
    part = fading(unit @ unit[own], SMOOTH, SHARP)
    average = (part * weight) @ unit
    average /= np.linalg.norm(average)
    if rim is None:
        along = np.linalg.svd(average[None])[2][1:]
    else:
        direction = rim - rim @ average * average
        along = np.stack([direction / np.linalg.norm(direction), np.zeros(3)])
    belongs = np.where(part > 0)[0]
    chosen = belongs[inside[belongs]] if inside.any() else belongs
    sides, tilts = seen[chosen] @ along.T, unit[belongs] @ along.T
    largest = np.linalg.norm(tilts, axis=1).max()
    if len(sides) < 2 or largest < 1e-3:
        return 1.0
    points, counts = np.vstack([sides, np.zeros(2)]), np.append(np.ones(len(sides)), len(sides) / 2)
    found = geometric_median(points, counts, largest)
    length = np.linalg.norm(found)
    ratio = length / max(np.abs(tilts @ found).max() / max(length, 1e-300), 0.2 * largest)
    strength = fading(ratio, 0.5, 0.2) * fading(length, 2e-3, 1e-3)  # smaller angles are those of rounded coordinates
    if strength == 0:
        return 1.0
    flat = 1 / (turn[chosen] ** 2 + (1e-3 * largest) ** 2)
    better = flat @ sides / flat.sum()  # what the flatter side sees
    target = strength * (better if np.linalg.norm(better - found) < 0.5 * length else found)
    first = (part * weight)[belongs] / (part * weight)[belongs].sum()
    parts = combination(tilts, target, first)
    if np.linalg.norm(parts @ tilts - target) >= 0.3 * np.linalg.norm(target):
        return 1.0
    share = parts / first
    return max(share[list(belongs).index(own)] / share.max(), 1e-6)


def normal_shares(faces, X):
    """(P7) of faces (m, 4) at their nodes, from the reference positions X."""
    c = X[faces]
    t1, t2 = c[:, [1, 1, 3, 3]] - c[:, [0, 0, 2, 2]], c[:, [2, 3, 2, 3]] - c[:, [0, 1, 0, 1]]
    area = np.cross(t1, t2)
    length = np.linalg.norm(area, axis=2)
    unit, weight = area / length[..., None], length / ((t1**2).sum(2) * (t2**2).sum(2))
    middle = np.cross(c[:, 3] - c[:, 0], c[:, 2] - c[:, 1])
    middle /= np.linalg.norm(middle, axis=1)[:, None]
    around, edges = {}, {}
    for f, nodes in enumerate(faces):
        for n, node in enumerate(nodes):
            around.setdefault(node, []).append((f, n))
            for m in (n ^ 1, n ^ 2):
                edges.setdefault(node, []).append(nodes[m])
    rims, averaged = {}, np.zeros_like(unit)
    for node, corners in around.items():
        ends = [other for other in edges[node] if edges[node].count(other) == 1]
        rims[node] = X[ends[1]] - X[ends[0]] if len(ends) > 1 else None
        f, n = np.array(corners).T
        averaged[f, n] = fading(unit[f, n] @ unit[f, n].T, SMOOTH, SHARP) @ (weight[f, n][:, None] * unit[f, n])
    averaged /= np.linalg.norm(averaged, axis=2)[..., None]
    seen = 2 * middle[:, None] + averaged - averaged.sum(1)[:, None] / 2  # the middle is the mean of the corners
    turn = np.linalg.norm(seen - middle[:, None], axis=2)
    share = np.ones(faces.shape)
    for node, corners in around.items():
        f, n = np.array(corners).T
        inside = np.array([rims[other] is None for other in faces[f, 3 - n]])
        for i in range(len(f)):
            share[f[i], n[i]] = share_at_node(i, unit[f, n], weight[f, n], seen[f, n], turn[f, n], inside, rims[node])
    return share


class Surface:
    """A set of faces of Bodies, `smoothed` (P2) or not. Positions of points come from the smoothed faces, areas and
    displacements from those of the nodes."""

    def __init__(self, bodies, faces, smoothed):
        self.degree, self.x, self.faces = bodies.degree, bodies.x, faces.reshape(len(faces), -1)
        self.n = n = self.degree + 1
        self.nodes = np.unique(self.faces)
        lattice = np.arange(n) / self.degree
        _, d1, d2 = shape(self.degree, np.tile(lattice, n), np.repeat(lattice, n))
        corners = self.x[self.faces]
        t1, t2 = np.einsum("qa,fac->fqc", d1, corners), np.einsum("qa,fac->fqc", d2, corners)
        area = np.cross(t1, t2)
        self.unit = area / np.linalg.norm(area, axis=2)[..., None]
        share = normal_shares(self.faces, bodies.X) if self.degree == 1 else np.ones(self.faces.shape)
        self._average((share / ((t1**2).sum(2) * (t2**2).sum(2)))[..., None] * area)
        self.bulge = self._bulge(corners)
        self.shape_degree, self.shape_points = self.degree, corners
        if smoothed and self.degree == 1:
            self._smooth(corners)
        middle = np.full(1, 0.5)
        _, d1, d2 = shape(self.shape_degree, middle, middle)
        centre_area = np.cross(np.einsum("a,fac->fc", d1[0], self.shape_points), np.einsum("a,fac->fc", d2[0], self.shape_points))
        self.size = np.sqrt(np.linalg.norm(centre_area, axis=1))
        self.centre_normal = centre_area / self.size[:, None] ** 2
        grid = self.faces.reshape(-1, n, n)
        ends = (([0, -1], [0, 0]), ([0, -1], [-1, -1]), ([0, 0], [0, -1]), ([-1, -1], [0, -1]))
        edges = np.stack([grid[:, eta, xi] for eta, xi in ends], 1)
        _, edge, count = np.unique(np.sort(edges, 2).reshape(-1, 2), axis=0, return_inverse=True, return_counts=True)
        self.rim = count[edge.ravel()].reshape(-1, 4) == 1  # edges at xi = 0, xi = 1, eta = 0, eta = 1

    def _average(self, weighted):
        """(P1): normal (faces, nodes, 3) of each node of each face."""
        flat, unit = self.faces.ravel(), self.unit.reshape(-1, 3)
        weighted, order = weighted.reshape(-1, 3), np.argsort(self.faces.ravel(), kind="stable")
        starts = np.concatenate([[0], np.where(np.diff(flat[order]))[0] + 1, [len(flat)]])
        normal = np.empty_like(unit)
        for a, b in zip(starts[:-1], starts[1:]):
            i = order[a:b]
            normal[i] = fading(unit[i] @ unit[i].T, SMOOTH, SHARP) @ weighted[i]
        self.nodal_normal = (normal / np.linalg.norm(normal, axis=1)[:, None]).reshape(self.unit.shape)

    def _bulge(self, corners):
        """How far an arc that meets the normals rises above an edge, or half an edge of degree 2, at most."""
        p, n, largest = self.degree, self.n, 0.0
        for a, b in ((0, p), (0, n * p), (p, n * n - 1), (n * p, n * n - 1)):
            turn = self.nodal_normal[:, b] - self.nodal_normal[:, a]
            largest = max(largest, np.abs(((corners[:, b] - corners[:, a]) * turn).sum(1)).max() / (8 * p**2))
        return largest

    def _smooth(self, corners):
        """(P2): nine points a face, the middles of edges on arcs."""
        points = np.zeros((len(corners), 9, 3))
        points[:, [0, 2, 6, 8]] = corners
        for a, b, m in ((0, 1, 1), (0, 2, 3), (1, 3, 5), (2, 3, 7)):
            chord, na, nb = corners[:, b] - corners[:, a], self.nodal_normal[:, a], self.nodal_normal[:, b]
            length = np.linalg.norm(chord, axis=1)
            angle = np.arcsin(np.clip((chord * (nb - na)).sum(1) / (2 * length), -0.7, 0.7))
            rise = length / 2 * np.tan(angle / 2)
            points[:, m] = (corners[:, a] + corners[:, b]) / 2 + (rise / np.linalg.norm(na + nb, axis=1))[:, None] * (na + nb)
        points[:, 4] = points[:, [1, 3, 5, 7]].sum(1) / 2 - points[:, [0, 2, 6, 8]].sum(1) / 4
        self.shape_degree, self.shape_points = 2, points

    def at(self, f, xi, eta):
        """Positions on the smoothed faces and both tangents, (n, 3) each."""
        return [np.einsum("qa,qac->qc", s, self.shape_points[f]) for s in shape(self.shape_degree, xi, eta)]

    def element(self, f, xi, eta):
        """Area over that in local coordinates, of faces that are not smoothed."""
        _, d1, d2 = shape(self.degree, xi, eta)
        x = self.x[self.faces[f]]
        return np.linalg.norm(np.cross(np.einsum("qa,qac->qc", d1, x), np.einsum("qa,qac->qc", d2, x)), axis=1)

    def normal(self, f, xi, eta, averaged):
        """Outward unit normals, averaged or of the smoothed face itself."""
        if averaged:
            n = np.einsum("qa,qac->qc", shape(self.degree, xi, eta)[0], self.nodal_normal[f])
        else:
            _, t1, t2 = self.at(f, xi, eta)
            n = np.cross(t1, t2)
        return n / np.linalg.norm(n, axis=1)[:, None]

    def facet_normal(self, f, xi, eta):
        """(P5): normals of the faces, averaged ones on edges that two faces share."""
        nearest = np.where(self.rim[f], 1, np.stack([xi, 1 - xi, eta, 1 - eta], 1)).min(axis=1)
        s = np.maximum(0, 1 - nearest / 0.1)[:, None]
        n = s * self.normal(f, xi, eta, True) + (1 - s) * self.normal(f, xi, eta, False)
        return n / np.linalg.norm(n, axis=1)[:, None]

    def closest(self, p, normal, last=False):
        """Closest points of faces that do not look along `normal` (far sides). p, normal: (n, 3). Returns face (-1: none), xi, eta,
        how far the point hangs over the rim [face sizes], (n,) each; and ties, which single precision does not tell apart: point,
        face, xi, eta, overhang. Of these the first face is taken, or the last one."""
        ties = []
        face, xi, eta = np.full(len(p), -1), np.zeros(len(p)), np.zeros(len(p))
        middle = np.full(len(self.faces), 0.5)
        centre = self.at(np.arange(len(self.faces)), middle, middle)[0]
        radius = 1.1 * np.linalg.norm(self.shape_points - centre[:, None], axis=2).max(axis=1)
        for start in range(0, len(p), 2000):
            part = slice(start, start + 2000)
            distance = np.linalg.norm(p[part, None] - centre[None], axis=2)
            distance[normal[part] @ self.centre_normal.T > FAR_SIDE] = np.inf
            q, f = np.where(distance - radius <= distance.min(axis=1)[:, None])
            q, f = q[np.isfinite(distance[q, f])], f[np.isfinite(distance[q, f])]
            s, t = self._project(p[part][q], f)
            away = np.linalg.norm(p[part][q] - self.at(f, s, t)[0], axis=1)
            nearest = np.full(len(p), np.inf)
            np.minimum.at(nearest, q, away)
            tie = away <= nearest[q] + 2e-6 * self.size.mean()
            order = np.lexsort((-f if last else f, ~tie, q))
            best = order[np.unique(q[order], return_index=True)[1]]
            ties.append(np.stack([start + q[tie], f[tie], s[tie], t[tie]]))
            face[start + q[best]], xi[start + q[best]], eta[start + q[best]] = f[best], s[best], t[best]
        ties = np.concatenate(ties, axis=1) if ties else np.zeros((4, 0))
        q, f, s, t = ties[0].astype(int), ties[1].astype(int), ties[2], ties[3]
        over = np.zeros(len(p))
        hit = np.where(face >= 0)[0]
        over[hit] = self._overhang(p[hit], face[hit], xi[hit], eta[hit])
        return face, xi, eta, over, (q, f, s, t, self._overhang(p[q], f, s, t))

    def _overhang(self, p, f, xi, eta):
        """How far points hang over the rim at their closest points [face sizes]."""
        at_rim = np.stack([xi <= 0, xi >= 1, eta <= 0, eta >= 1], 1) & self.rim[f]
        n = self.normal(f, xi, eta, False)
        r = p - self.at(f, xi, eta)[0]
        return np.linalg.norm(r - (r * n).sum(1)[:, None] * n, axis=1) / self.size[f] * at_rim.any(axis=1)

    def _project(self, p, f):
        """Local coordinates of the points of faces f that are closest to p, by Gauss-Newton steps within the square."""
        at = np.full((len(p), 2), 0.5)
        open_ = np.arange(len(p))
        for _ in range(50):
            x, t1, t2 = self.at(f[open_], at[open_, 0], at[open_, 1])
            r = p[open_] - x
            g = np.stack([(r * t1).sum(1), (r * t2).sum(1)], 1)
            a, b, c = (t1 * t1).sum(1), (t1 * t2).sum(1), (t2 * t2).sum(1)
            here = at[open_]
            held = ((here <= 0) & (g <= 0)) | ((here >= 1) & (g >= 0))
            b = np.where(held.any(axis=1), 0, b)
            det = a * c - b * b
            step = np.stack([c * g[:, 0] - b * g[:, 1], a * g[:, 1] - b * g[:, 0]], 1) / det[:, None]
            new = np.clip(here + np.where(held, 0, step), 0, 1)
            at[open_] = new
            open_ = open_[np.abs(new - here).max(axis=1) > 1e-13]
            if len(open_) == 0:
                break
        return at[:, 0], at[:, 1]

    def triangles(self):
        """(n, 3, 3): each face as four triangles around its middle, of degree 2 or smoothed each sixteenth of it."""
        n = 1 if self.shape_degree == 1 else 4
        quads = []
        f = np.arange(len(self.faces))
        corner = lambda i, j: self.at(f, np.full(len(f), i / n), np.full(len(f), j / n))[0]
        for i in range(n):
            for j in range(n):
                places = ((i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1), (i + 0.5, j + 0.5))
                quads.append(np.stack([corner(*place) for place in places], 1))
        quads = np.concatenate(quads)
        return np.concatenate([quads[:, [i, (i + 1) % 4, 4]] for i in range(4)])


def depth_below(points, triangles):
    """How deep points (n, 3) lie under a closed surface (negative: outside), by the nearest of its outward triangles (m, 3, 3)."""
    if len(points) == 0:
        return np.zeros(0)
    centre = triangles.mean(axis=1)
    radius = np.linalg.norm(triangles - centre[:, None], axis=2).max(axis=1)
    p_, t_ = [], []
    for start in range(0, len(points), 500):
        distance = np.linalg.norm(points[start : start + 500, None] - centre[None], axis=2)
        q, t = np.where(distance - radius <= distance.min(axis=1)[:, None] * (1 + 1e-6))
        p_.append(q + start), t_.append(t)
    q, t = np.concatenate(p_), np.concatenate(t_)
    a, b, c = triangles[t, 0], triangles[t, 1], triangles[t, 2]
    normal = np.cross(b - a, c - a)
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    p = points[q]
    height = ((p - a) * normal).sum(1)
    foot = p - height[:, None] * normal
    inside, distance = np.ones(len(q), bool), np.full(len(q), np.inf)
    for s, e in ((a, b), (b, c), (c, a)):
        along = e - s
        inside &= (np.cross(along, foot - s) * normal).sum(1) >= 0
        k = np.clip(((p - s) * along).sum(1) / (along * along).sum(1), 0, 1)
        distance = np.minimum(distance, np.linalg.norm(p - s - k[:, None] * along, axis=1))
    distance[inside] = np.abs(height[inside])
    nearest = np.full(len(points), np.inf)
    np.minimum.at(nearest, q, distance)
    near = distance <= nearest[q] * (1 + 1e-9) + 1e-9 * radius.mean()
    order = np.lexsort((np.where(near, -np.abs(height), 1.0), q))  # at an edge the face that sees the point most decides
    order = order[np.unique(q[order], return_index=True)[1]]
    return -np.sign(height[order]) * nearest[q[order]]
