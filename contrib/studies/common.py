"""What the studies share: runs of nodus, fitted orders, tables and plots."""

import functools
import os
import sys

import numpy as np

FOLDER = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(FOLDER))
sys.path.insert(0, os.path.join(ROOT, "contrib", "python"))
import nodus  # noqa: E402

NODUS = os.environ.get("NODUS", os.path.join(ROOT, "build-release", "nodus"))
# results of the runs, not kept
SCRATCH = os.environ.get("NODUS_STUDIES", os.path.join(ROOT, "results", "studies"))

# The schemes that the studies compare, as keys of a contact pair.
SCHEMES = {
    "nodal": {"Scheme": "nodal"},
    "integration point": {"Scheme": "integration point"},
    "averaged, face": {"Scheme": "averaged", "Integration": "face"},
    "averaged, segment": {"Scheme": "averaged", "Integration": "segment"},
}

# The paper's own integrals, products of shape functions, by several rules, and with the status test on the multipliers themselves. Of the
# rules with more points than the degree the one with degree + 2 Gauss points is the default.
_CONSISTENT = {"Scheme": "nodal", "Weights": "consistent"}
CONSISTENT = {
    "consistent, Gauss 2": {**_CONSISTENT, "Quadrature points": 2},
    "consistent, Gauss 3": {**_CONSISTENT, "Quadrature points": 3},
    "consistent, Gauss 4": {**_CONSISTENT, "Quadrature points": 4},
    "consistent, Simpson": {**_CONSISTENT, "Quadrature rule": "Simpson"},  # 3 points for degree 1, 5 for degree 2
    "consistent, Newton-Cotes 4": {**_CONSISTENT, "Quadrature rule": "Newton-Cotes", "Quadrature points": 4},
    "consistent, test of the node": {**_CONSISTENT, "Status test": "raw"},
}


def keys_of(scheme):
    return SCHEMES[scheme] if scheme in SCHEMES else CONSISTENT[scheme]


# Nothing merged into Newton's iteration: the loops of the paper, and studies count their passes.
THREE_LOOPS = {f"{loop} loop/Mode": "fixed point" for loop in ("Geometry", "Threshold", "Status")}


@functools.lru_cache(None)
def program():
    return nodus.Program(NODUS)


def timing(run):
    """CPU seconds of all ranks by phase, and "linear solver" for its two phases."""
    found = {phase["name"]: phase["cpu_seconds"] for phase in run.profile["phases"]}
    found["linear solver"] = found["solver set-up"] + found["solver iterations"]
    return found


def write_case(name, text):
    """Writes <name>.prm (or any other file) into the scratch folder; returns its path."""
    path = os.path.join(SCRATCH, name if "." in os.path.basename(name) else name + ".prm")
    os.makedirs(os.path.dirname(path), exist_ok=True)
    with open(path, "w") as file:
        file.write(text)
    return path


def run(prm, name, sets=None, pair=None, ranks=1):
    """A nodus.Run of a case, with three nested loops unless `sets` has other modes. sets: {"Section/Key": value}; pair: keys
    of "Contact pair 1". A failed run is a result too."""
    keys = {**THREE_LOOPS, **(sets or {})}
    for key, value in (pair or {}).items():
        keys["Contact pair 1/" + key] = value
    keys["Output/Results folder"] = os.path.join(SCRATCH, name)
    done = program().run(prm, ranks, sets=keys, profile=True, check=False)
    if "input error" in done.log:
        raise SystemExit(f"{name}: {done.log}")
    print(f"  {name}: exit {done.code}, {done.cpu:.1f} CPU s", flush=True)
    return done


def fitted_order(h, error):
    """Order of convergence and its standard deviation, from a line through the logarithms."""
    x, y = np.log(np.asarray(h)), np.log(np.asarray(error))
    if len(x) < 3:
        return (y[-1] - y[0]) / (x[-1] - x[0]), float("nan")
    (order, _), covariance = np.polyfit(x, y, 1, cov="unscaled")
    residual = y - np.polyval(np.polyfit(x, y, 1), x)
    return order, float(np.sqrt(covariance[0, 0] * np.sum(residual**2) / (len(x) - 2)))


def table(path, header, rows):
    """Writes a Markdown table and prints it."""
    lines = ["| " + " | ".join(header) + " |", "|" + "---|" * len(header)]
    lines += ["| " + " | ".join(str(cell) for cell in row) + " |" for row in rows]
    text = "\n".join(lines) + "\n"
    with open(path, "w") as file:
        file.write(text)
    print(text, flush=True)
    return text


def figure(width=6.0, height=4.0):
    """An empty matplotlib figure and its axes, drawn without a screen."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    return plt.subplots(figsize=(width, height), layout="constrained")


# Corners, edges and faces of gmsh's hexahedra (types 5 and 12) as positions in the 3 x 3 x 3 lattice of nodes.
_CORNERS = [(0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0), (0, 0, 2), (2, 0, 2), (2, 2, 2), (0, 2, 2)]
_EDGES = [(0, 1), (0, 3), (0, 4), (1, 2), (1, 5), (2, 3), (2, 6), (3, 7), (4, 5), (4, 7), (5, 6), (6, 7)]
_FACES = [(0, 3, 2, 1), (0, 1, 5, 4), (0, 4, 7, 3), (1, 2, 6, 5), (2, 3, 7, 6), (4, 5, 6, 7)]


def _middle(corners):
    return tuple(sum(_CORNERS[c][d] for c in corners) // len(corners) for d in range(3))


def write_mesh(name, bodies):
    """Writes grids of 27-node hexahedra as a gmsh file into the scratch folder; returns its path.

    bodies: arrays of nodes with shape (2 nx + 1, 2 ny + 1, 2 nz + 1, 3). Body b is the physical volume b = 1, 2, ...;
    its sides are the surfaces 10 b + 0 ... 5 = x-, x+, y-, y+, z-, z+ of the grid.
    """
    lattice27 = _CORNERS + [_middle(e) for e in _EDGES] + [_middle(f) for f in _FACES] + [(1, 1, 1)]
    points, quads, hexes, before = [], [], [], 0
    for b, nodes in enumerate(bodies, 1):
        number = before + 1 + np.arange(nodes[..., 0].size).reshape(nodes.shape[:3])
        before += number.size
        points.append(nodes.reshape(-1, 3))
        cells = np.array([number[i : number.shape[0] - 2 + i : 2, j : number.shape[1] - 2 + j : 2,
                                 k : number.shape[2] - 2 + k : 2] for i, j, k in lattice27])  # fmt: skip
        hexes += [(b, cell) for cell in cells.reshape(27, -1).T]
        for side in range(6):
            sheet = np.moveaxis(number, side // 2, 0)[-(side % 2)]
            around = [(0, 0), (2, 0), (2, 2), (0, 2), (1, 0), (2, 1), (1, 2), (0, 1), (1, 1)]
            faces = np.array([sheet[i : sheet.shape[0] - 2 + i : 2, j : sheet.shape[1] - 2 + j : 2] for i, j in around])
            quads += [(10 * b + side, face) for face in faces.reshape(9, -1).T]
    path = os.path.join(SCRATCH, name + ".msh")
    os.makedirs(SCRATCH, exist_ok=True)
    with open(path, "w") as file:
        file.write(f"$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n{before}\n")
        for n, (x, y, z) in enumerate(np.concatenate(points), 1):
            file.write(f"{n} {x:.16g} {y:.16g} {z:.16g}\n")
        file.write(f"$EndNodes\n$Elements\n{len(quads) + len(hexes)}\n")
        for n, (kind, (tag, cell)) in enumerate([(10, q) for q in quads] + [(12, h) for h in hexes], 1):
            file.write(f"{n} {kind} 2 {tag} {tag} " + " ".join(map(str, cell)) + "\n")
        file.write("$EndElements\n")
    return path
