"""Writes hexahedra as a gmsh file, version 4.1, ASCII: the format in which a volume can be in several groups."""

import os

import numpy as np

# Where gmsh's nodes are in the lattice: corners, edges and faces by corners (its reference manual, "Node ordering").
_CORNERS = np.array([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)])
EDGES = ((0, 1), (0, 3), (0, 4), (1, 2), (1, 5), (2, 3), (2, 6), (3, 7), (4, 5), (4, 7), (5, 6), (6, 7))
FACES = ((0, 1, 2, 3), (0, 1, 4, 5), (0, 3, 4, 7), (1, 2, 5, 6), (2, 3, 6, 7), (4, 5, 6, 7))


def _order(corners, middles, order):
    points = [2 * corner for corner in corners] + [2 * corners[list(m)].mean(0) for m in middles] * (order == 2)
    n = order + 1
    return np.array([int(sum(round(x * order / 2) * n**d for d, x in enumerate(point))) for point in points])


def hexahedron_order(order):
    """Positions in the lattice of the nodes of gmsh's hexahedron of 8 or 27 nodes."""
    return _order(_CORNERS, EDGES + FACES + (tuple(range(8)),), order)


def quadrilateral_order(order):
    """The same for 4 or 9 nodes."""
    return _order(_CORNERS[:4, :2], ((0, 1), (1, 2), (2, 3), (3, 0), (0, 1, 2, 3)), order)


def combinations(groups, n):
    """[(ids, members)]: members are in one combination of groups each."""
    of_member = np.zeros(n, int)
    known = {(): 0}
    for group in groups:
        old, inverse = np.unique(of_member[group.members], return_inverse=True)
        ids = list(known)
        new = [known.setdefault(ids[i] + (group.id,), len(known)) for i in old]
        of_member[group.members] = np.array(new, int)[inverse]
    parts = [(ids, np.flatnonzero(of_member == i)) for ids, i in known.items()]
    return [(ids, members) for ids, members in parts if len(members)]


def write_gmsh(path, hexahedra, volumes, surfaces):
    """volumes and surfaces: (groups, [(ids, cells or lattices of faces)]). Nothing is left behind where it fails."""
    temporary = f"{path}.{os.getpid()}.tmp"
    try:
        with open(temporary, "w", encoding="utf-8") as file:
            _write(file, hexahedra, volumes, surfaces)
        os.replace(temporary, path)
    finally:
        if os.path.exists(temporary):
            os.remove(temporary)


def _write(file, hexahedra, volumes, surfaces):
    order, points = hexahedra.order, hexahedra.points
    names = [(2, group) for group in surfaces[0]] + [(3, group) for group in volumes[0]]
    file.write(f"$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$PhysicalNames\n{len(names)}\n")
    for dimension, group in names:
        file.write('{} {} "{}"\n'.format(dimension, group.id, group.name.replace('"', "'")))
    box = " ".join(f"{x:.17g}" for x in np.concatenate([points.min(0), points.max(0)]))
    file.write(f"$EndPhysicalNames\n$Entities\n0 0 {len(surfaces[1])} {len(volumes[1])}\n")
    for _, parts in (surfaces, volumes):
        for tag, (ids, _) in enumerate(parts, 1):
            file.write(" ".join(map(str, (tag, box, len(ids), *ids, 0))) + "\n")
    n = len(points)
    file.write(f"$EndEntities\n$Nodes\n1 {n} 1 {n}\n3 1 0 {n}\n")
    file.write(("%d\n" * n) % tuple(range(1, n + 1)))
    for i in range(0, n, 100000):
        part = points[i:i + 100000]
        file.write(("%.17g %.17g %.17g\n" * len(part)) % tuple(part.reshape(-1)))
    total = sum(len(part) for _, parts in (surfaces, volumes) for _, part in parts)
    file.write(f"$EndNodes\n$Elements\n{len(surfaces[1]) + len(volumes[1])} {total} 1 {total}\n")
    number = 1
    for dimension, parts, type_, at in ((2, surfaces[1], (3, 10)[order - 1], quadrilateral_order(order)),
                                        (3, volumes[1], (5, 12)[order - 1], hexahedron_order(order))):
        for tag, (_, elements) in enumerate(parts, 1):
            file.write(f"{dimension} {tag} {type_} {len(elements)}\n")
            for i in range(0, len(elements), 20000):
                nodes = elements[i:i + 20000][:, at] + 1
                rows = np.column_stack([number + np.arange(len(nodes)), nodes])
                number += len(nodes)
                file.write((("%d " * rows.shape[1])[:-1] + "\n") * len(rows) % tuple(rows.reshape(-1)))
    file.write("$EndElements\n")
