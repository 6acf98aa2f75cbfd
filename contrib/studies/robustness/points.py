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


def system(points, pair, augmentation, closed, regularised):
    """Of the pressures of the nodes (raw, negative in compression) that belong to the forces of the nodes and to statuses of the points
    (W4), (55, 56), (F3): matrix (k, k) and right-hand side (k,), and the laws, off @ pressures + gap = 0: off (k, k), gap (k,)."""
    d = augmentation * np.where(closed, points.d, 0)[closed]
    turned = points.weighted[closed] * points.turn[closed]
    on, off = turned.T @ points.phi[closed], points.weighted[~closed].T @ points.phi[~closed]
    gap, push = points.weighted[closed].T @ d, turned.T @ d if regularised else 0
    return on + off, (pair.force * pair.normal).sum(1) - gap + push, off, gap


def solve(points, pair, augmentation, closed, regularised):
    """Pressures at the points (q,), and by how much the laws are off [of the largest pressure] (k,)."""
    matrix, rhs, off, gap = system(points, pair, augmentation, closed, regularised)
    values = np.linalg.lstsq(matrix, rhs, rcond=1e-10)[0]
    return points.phi @ values, np.abs(off @ values + gap) / (pair.area * np.abs(pair.pressure).max())


def best_changes(points, pair, augmentation, closed, regularised, places):
    """Of places whose points change sides: those that leave the smallest misfit, best first, where the matrix stays as it is."""
    matrix, rhs, off, gap = system(points, pair, augmentation, closed, regularised)
    inverse = np.linalg.pinv(matrix, rcond=1e-10)
    values, to_law, size = inverse @ rhs, off @ inverse, pair.area * np.abs(pair.pressure).max()
    law, left = off @ values + gap, []
    for place in places:
        q = np.flatnonzero(points.found & (points.place == place))
        sign, d, w = np.where(closed[q], -1, 1), augmentation * points.d[q], points.weighted[q]
        more_gap = w.T @ (sign * d)
        more = ((w * points.turn[q]).T @ (sign * d) if regularised else 0) - more_gap
        at = points.phi[q] @ (values + inverse @ more)
        left.append(np.linalg.norm((law + to_law @ more + more_gap - w.T @ (sign * at)) / size))
    return [places[i] for i in np.argsort(left)]


def multipliers(points, pair, augmentation, found, regularised):
    """solve() with statuses that are changed until none contradicts, or of those that were met the ones that fit best: lambda,
    statuses (q,), and by how much the laws are off."""
    d = np.where(found, points.d, 0)
    closed, best = found & (d > -1e-6 * pair.cell), (None, None, np.full(len(pair.nodes), np.inf))
    for _ in range(20):
        at, law = solve(points, pair, augmentation, closed, regularised)
        if law.max() < best[2].max():
            best = at, closed, law
        again = found & (at - augmentation * d <= 0)
        if (again == closed).all():
            break
        closed = again
    return best


def statuses(points, pair, augmentation, regularised, fit):
    """multipliers() with the choices that the files leave open. Statuses that contradict nowhere are not unique, because the pressure of
    a point jumps where it closes, and of some points only the history tells whether they have a partner: open, they need none. From
    three choices of partners on, the place whose points reduce the misfit of the laws most changes sides, until all is as it should:
    fit(at, closed, law). Taken is what has no contradiction; failing that, what multipliers() says with the partners of today."""
    ends = []
    for found in (points.found & (points.fresh | ~points.unsure), points.found & ~points.unsure, points.found):
        at, closed, law = multipliers(points, pair, augmentation, found, regularised)
        ends.append((at, closed, law))
        for _ in range(len(points.phi)):
            if fit(at, closed, law):
                break
            near = np.unique(points.place[points.found & (points.phi[:, law > 0.1 * LAW] != 0).any(axis=1)])
            for place in best_changes(points, pair, augmentation, closed, regularised, near)[:3]:
                trial = closed ^ (points.found & (points.place == place))
                at_trial, law_trial = solve(points, pair, augmentation, trial, regularised)
                if law_trial @ law_trial < law @ law:
                    at, closed, law = at_trial, trial, law_trial
                    break
            else:
                break
        for _ in range(len(points.phi) if fit(at, closed, law) else 0):  # what contradicts itself follows, the worst first, while all fits
            test = at - augmentation * np.where(points.found, points.d, 0)
            wrong = points.found & np.where(closed, test > 0, (test <= 0) & ~points.unsure)
            if not wrong.any():
                return at, closed, law
            for q in np.flatnonzero(wrong)[np.argsort(-np.abs(test[wrong]))]:
                trial = closed ^ (np.arange(len(closed)) == q)
                at_trial, law_trial = solve(points, pair, augmentation, trial, regularised)
                if fit(at_trial, trial, law_trial):
                    at, closed, law = at_trial, trial, law_trial
                    break
            else:
                break
    return ends[0]


def bends(points, closed):
    """Sines between the normals of closed points and those of the nodes, the largest around each node (k,): friction on a curved surface
    has a part along the normal of the node."""
    uses = points.phi != 0
    bend = np.where(closed[:, None] & uses, np.sqrt(np.maximum(1 - points.turn**2, 0)), 0).max(axis=0)
    return ((uses.T @ uses.astype(float) > 0) * bend[None]).max(axis=1)  # the multipliers of a face go together


def beyond_friction(points, pair, mu, push):
    """By how much the friction of each node is more than what the pressures of its points, push (q,), allow [of the largest] (k,)."""
    friction = pair.force - (points.weighted * push[:, None]).T @ points.normal
    limit = np.abs(points.weighted).T @ (mu * np.maximum(-push, 0))
    return (np.linalg.norm(friction, axis=1) - limit) / (pair.area * np.abs(pair.pressure).max())


def check_points(find, state, pair, row):
    """Depth of the points; Signorini's law in the mean; friction of each node at most what the pressures of its points allow."""
    t, name, mu = state.t, pair.name, state.case.facts["mu"]
    points = Points(pair)
    sure = points.found & ~points.unsure
    bulge = (pair.slave.bulge + pair.master.bulge) / pair.cell
    find.compare("penetration of integration points beyond bulges [cells]", points.d[sure] / pair.cell - bulge, DEPTH, t, name)
    largest = np.abs(pair.pressure).max()
    if largest == 0:
        return
    materials = state.case.facts["materials"]
    young = min(float(materials[int(pair.keys[f"{role} body"]) - 1]["Young's modulus"]) for role in ("Slave", "Master"))
    tolerance = LAW_LOOPS if state.fixed_point else LAW
    augmentation = young / state.reference_sizes(pair)[0]
    blur = augmentation * state.noise / largest  # gaps are known to the last digits of positions
    trials = []
    for regularised in (False, True)[: 1 + (int(row["regularised law"]) > 0)]:

        def misfits(at, closed, law):
            push = closed * (at - (augmentation * np.where(closed, points.d, 0) if regularised else 0))
            tilt = blur + mu * bends(points, closed)
            return law - tilt, beyond_friction(points, pair, mu, push) - tilt

        def fit(*state):
            return max(misfit.max() for misfit in misfits(*state)) <= tolerance

        found = statuses(points, pair, augmentation, regularised, fit)
        trials.append(misfits(*found))
        if fit(*found):
            break
    law, beyond = min(trials, key=lambda trial: max(misfit.max() for misfit in trial))
    find.compare("law of integration points, beyond round-off", law, tolerance, t, name)
    find.compare("friction beyond that of the points", beyond, tolerance, t, name)
