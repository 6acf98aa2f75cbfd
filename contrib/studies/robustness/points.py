"""The laws of integration points. They hold in the mean over closed points, and neither statuses nor multipliers of points are in a
file: both are found again here, and must fit to what the files do say."""

import numpy as np

from geometry import shape

# Of the largest pressure: what Newton leaves (2.3e-6), a geometry loop (theory.md, 34; 1.7e-4). Of the smaller mean face, beyond the
# bulges of both surfaces: closed points keep their distance in the mean alone (0.024).
LAW, LAW_LOOPS, DEPTH = 1e-4, 2e-3, 0.05


class Points:
    """Of a pair (gaps.Pair with force, area) at one time. phi (q, nodes) over all slave nodes, w (q,) areas, d (q,) distances,
    positive inside, -inf without partner, normal (q, 3); unsure (q,): only the history tells whether they have one, fresh (q,):
    whether they would find one without it; place (q,): equal numbers at the same place."""

    def __init__(self, pair):
        self.d, f, xi, eta, self.w, self.found, over, self.normal = pair.integration_points()
        self.unsure, self.fresh = self.found & (over > 0.9), self.found & (over <= 1)
        x = np.round(pair.slave.at(f, xi, eta)[0] / (1e-4 * pair.cell))
        self.place = np.unique(x, axis=0, return_inverse=True)[1].ravel()
        self.phi = np.zeros((len(f), len(pair.nodes)))
        np.put_along_axis(self.phi, pair.faces[f], shape(pair.degree, xi, eta)[0], axis=1)
        self.weighted = self.w[:, None] * self.phi
        self.turn = self.normal @ pair.normal.T  # cosines with the normals of the nodes


def solve(points, pair, augmentation, found, closed, regularised):
    """Pressures of the nodes (raw, negative in compression) that belong to the forces of the nodes and to statuses of the points (W4),
    (55, 56), (F3). Returns lambda at the points (q,), and by how much the laws are off [of the largest pressure] (k,)."""
    normal_force = (pair.force * pair.normal).sum(1)
    d = augmentation * np.where(found, points.d, 0)[closed]
    turned = points.weighted[closed] * points.turn[closed]
    on, off = turned.T @ points.phi[closed], points.weighted[~closed].T @ points.phi[~closed]
    gap, push = points.weighted[closed].T @ d, turned.T @ d if regularised else 0
    values = np.linalg.lstsq(on + off, normal_force - gap + push, rcond=1e-10)[0]
    return points.phi @ values, np.abs(off @ values + gap) / (pair.area * np.abs(pair.pressure).max())


def multipliers(points, pair, augmentation, found, regularised):
    """solve() with statuses that are changed until none contradicts, or of those that were met the ones that fit best: lambda,
    statuses (q,), and by how much the laws are off."""
    d = np.where(found, points.d, 0)
    closed, best = found & (d > -1e-6 * pair.cell), (None, None, np.full(len(pair.nodes), np.inf))
    for _ in range(20):
        at, law = solve(points, pair, augmentation, found, closed, regularised)
        if law.max() < best[2].max():
            best = at, closed, law
        again = found & (at - augmentation * d <= 0)
        if (again == closed).all():
            break
        closed = again
    return best


def other_statuses(points, pair, augmentation, found, regularised, start):
    """Statuses that contradict nowhere are not unique, because the pressure of a point jumps where it closes. start: what multipliers()
    returns. Points change sides, those of a place together, where the laws fit better then; what is left has no contradiction, or is
    not taken."""
    d = np.where(found, points.d, 0)
    at, closed, law = start
    closed = closed.copy()
    for _ in range(len(points.phi)):
        before = law @ law
        near = (points.phi[:, law > 0.1 * LAW] != 0).any(axis=1)
        places = [np.flatnonzero(points.place == place) for place in np.unique(points.place[near])]
        for place in places:
            closed[place] = ~closed[place]
            trial = solve(points, pair, augmentation, found, closed & found, regularised)
            if trial[1] @ trial[1] < law @ law:
                at, law = trial
            else:
                closed[place] = ~closed[place]
        if law @ law == before:
            break
    closed &= found
    fits = ((at - augmentation * d <= 0) & found == closed).all() and law.max() < start[2].max()
    return (at, closed, law) if fits else start


def best_partners(points, pair, augmentation, regularised, had, fits):
    """multipliers() with the choice of partners that the files leave open: of points of which only the history tells whether they
    have one. None has that belongs to a node without force, for it would be closed. The others begin with those that had one
    in the last state (had) or would find one today, with the latter alone or with all, and change sides, first those of a place
    together, then each, until no change makes the laws fit better, or they fit: fits(law, closed). Returns what multipliers() does and
    who has a partner (q,)."""
    idle = np.abs(pair.force).max(axis=1) == 0
    unsure = points.unsure & (points.d > 0)
    lost = unsure & (points.phi[:, idle] != 0).any(axis=1)
    open_choices = np.flatnonzero(unsure & ~lost)
    groups = [open_choices[points.place[open_choices] == place] for place in np.unique(points.place[open_choices])]
    ends = []
    for start in (np.where(unsure, points.fresh | had, points.found), np.where(unsure, points.fresh, points.found), points.found):
        found = start & ~lost
        best = multipliers(points, pair, augmentation, found, regularised)
        for _ in open_choices:
            before = best[2] @ best[2]
            if fits(best[2], best[1]):
                break
            for group in groups + [[q] for q in open_choices]:
                found[group] = ~found[group]
                trial = multipliers(points, pair, augmentation, found, regularised)
                if trial[2] @ trial[2] < best[2] @ best[2]:
                    best = trial
                else:
                    found[group] = ~found[group]
            if best[2] @ best[2] == before:
                break
        ends.append((*best, found))
        if fits(best[2], best[1]):
            break
    return min(ends, key=lambda end: end[2].max())


def bends(points, closed):
    """Sines between the normals of closed points and those of the nodes, the largest around each node (k,): friction on a curved surface
    has a part along the normal of the node."""
    uses = points.phi != 0
    bend = np.where(closed[:, None] & uses, np.sqrt(np.maximum(1 - points.turn**2, 0)), 0).max(axis=0)
    return ((uses.T @ uses.astype(float) > 0) * bend[None]).max(axis=1)  # the multipliers of a face go together


def check_points(find, state, before, pair, row):
    """Depth of the points; Signorini's law in the mean; friction of each node at most what the pressures of its points allow."""
    t, name, mu = state.t, pair.name, state.case.facts["mu"]
    points = Points(pair)
    sure = points.found & ~points.unsure
    bulge = (pair.slave.bulge + pair.master.bulge) / pair.cell
    find.compare("penetration of integration points beyond bulges [cells]", points.d[sure] / pair.cell - bulge, DEPTH, t, name)
    largest = np.abs(pair.pressure).max()
    if largest == 0:
        pair.partners = points.fresh
        return
    materials = state.case.facts["materials"]
    young = min(float(materials[int(pair.keys[f"{role} body"]) - 1]["Young's modulus"]) for role in ("Slave", "Master"))
    tolerance = LAW_LOOPS if state.fixed_point else LAW
    augmentation = young / state.reference_sizes(pair)[0]
    had = getattr(before.pairs[state.pairs.index(pair)], "partners", np.zeros_like(points.found))
    blur = augmentation * state.noise / largest  # gaps are known to the last digits of positions

    def unexplained(law, closed):
        return law - blur - mu * bends(points, closed)

    def fits(law, closed):
        return (unexplained(law, closed) <= tolerance).all()

    trials = []
    for regularised in (False, True)[: 1 + (int(row["regularised law"]) > 0)]:
        at, closed, law, found = best_partners(points, pair, augmentation, regularised, had, fits)
        if not fits(law, closed):
            at, closed, law = other_statuses(points, pair, augmentation, found, regularised, (at, closed, law))
        trials.append((at, closed, law, found, regularised))
    values, closed, law, pair.partners, regularised = min(trials, key=lambda trial: trial[2].max())
    find.compare("law of integration points, beyond round-off", unexplained(law, closed), tolerance, t, name)
    push = closed * (values - (augmentation * np.where(closed, points.d, 0) if regularised else 0))
    friction = pair.force - (points.weighted * push[:, None]).T @ points.normal
    limit = np.abs(points.weighted).T @ (mu * np.maximum(-push, 0))
    beyond = (np.linalg.norm(friction, axis=1) - limit) / (pair.area * largest)
    find.compare("friction beyond that of the points", unexplained(beyond, closed), tolerance, t, name)
