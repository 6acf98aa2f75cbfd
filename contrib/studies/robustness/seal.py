"""A rubber seal that a lid presses into a groove, with friction: mesh and parameter file for hard_paths.py."""

import os
import sys

import numpy as np

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
import common

# Body: name, box in the plane, cells (n: as many as the seal has along a side), side that is held, side in contact, where.
STEEL = [("floor", (-1.05, 1.05), (-1.4, -1.0), ("n", 2), 2, 3),
         ("left", (-1.4, -1.05), (-1.4, 0.9), (2, "n"), 0, 1),
         ("right", (1.05, 1.4), (-1.4, 0.9), (2, "n"), 1, 0),
         ("lid", (-1.0185, 1.0185), (1.0, 1.4), ("n", 2), 3, 2)]  # fmt: skip
THICKNESS = 0.25


def grid(x, y, cells):
    axes = [np.linspace(a, b, 2 * c + 1) for (a, b), c in zip((x, y, (0, THICKNESS)), (*cells, 1))]
    return np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1)


def rounded(n):
    """A square with round sides and corners, 2 wide."""
    nodes = grid((-1, 1), (-1, 1), (n, n))
    u, v = nodes[..., 0].copy(), nodes[..., 1].copy()
    nodes[..., 0] = 0.7 * u * np.sqrt(1 - v * v / 2) + 0.255 * u
    nodes[..., 1] = 0.7 * v * np.sqrt(1 - u * u / 2) + 0.255 * v
    nodes[..., :2] /= np.abs(nodes[..., :2]).max()
    return nodes


def write(n, friction, way, increments):
    """Path of the parameter file: n x n cells in the seal, pressed together by `way` of its 2."""
    name = f"seal_{n}_{friction}"
    cells = [[n if c == "n" else c for c in body[3]] for body in STEEL]
    common.write_mesh(name, [rounded(n)] + [grid(body[1], body[2], c) for body, c in zip(STEEL, cells)])
    tree = {"Title": f"rubber seal in a groove, friction {friction}"}
    for b, (what, modulus, nu) in enumerate([("seal", 10, 0.499)] + [(body[0], 1000, 0.3) for body in STEEL], 1):
        tree[f"Body {b}"] = {"Name": what, "Mesh file": f"{name}.msh", "Volume ids": b,
                             "Volumetric treatment": "mean dilatation" if b == 1 else "standard",
                             "Material": {"Law": "neo-Hookean", "Young's modulus": modulus, "Poisson's ratio": nu}}  # fmt: skip
    sides = ", ".join(f"{10 * b + side}" for b in range(1, 6) for side in (4, 5))
    conditions = [{"Name": what, "Body": b, "Boundary ids": 10 * b + held, "Components": "x, y",
                   "Value": f"0; -{way}*t" if what == "lid" else "0; 0"}
                  for b, (what, _, _, _, held, _) in enumerate(STEEL, 2)]  # fmt: skip
    conditions += [{"Name": "plane strain", "Boundary ids": sides, "Components": "z", "Value": 0},
                   {"Name": "soft spring", "Type": "spring", "Body": 1, "Boundary ids": "10, 11", "Components": "x, y",
                    "Value": 1e-3}]  # fmt: skip
    tree.update({f"Boundary condition {c}": keys for c, keys in enumerate(conditions, 1)})
    for p, (what, _, _, _, _, side) in enumerate(STEEL, 1):
        tree[f"Contact pair {p}"] = {"Name": what, "Slave body": p + 1, "Slave boundary ids": 10 * (p + 1) + side,
                                     "Master body": 1, "Master boundary ids": "10, 11, 12, 13",
                                     "Friction coefficient": friction}  # fmt: skip
    tree["Load stepping"] = {"Interval ends": 1, "Increments": increments}
    return common.write_case(name, common.nodus.prm.to_text(tree))
