#!/usr/bin/python3
"""Makes punch.msh and punch_foundation.msh: punch_mesh.py [cells around the quarter, even; default 8]

Quarters of the punch (radius 50, height 100, edge radius 10, flat end on z = 0) and of the foundation (radius 100, z = -200 to 0),
x and y >= 0, hexahedra of second order whose sides are curved around the axis and along the edge. A section in r and z is turned about the z axis from r = 20 on; the core is a square with
two blocks around it.

Volume 1; surfaces: 11 contact (flat end and half of the edge; the upper side), 12 x = 0, 13 y = 0, 14 the other end, 15 the rest.
"""

import math
import os
import sys


def line(a, b, n, growth=1.0):
    """n + 1 numbers from a to b, steps that grow by a factor."""
    steps = [growth**i for i in range(n)]
    return [a + (b - a) * sum(steps[:i]) / sum(steps) for i in range(n + 1)]


def block(bottom, top):
    """Points between two rows of points of the same length; rows: numbers from 0 to 1."""
    return lambda rows: [[tuple(p + t * (q - p) for p, q in zip(a, b)) for a, b in zip(bottom, top)] for t in rows]


def straight(p, q, n):
    return [tuple(a + t * (b - a) for a, b in zip(p, q)) for t in line(0, 1, n)]


def quads(grid):
    return [(a[i], a[i + 1], b[i + 1], b[i]) for a, b in zip(grid, grid[1:]) for i in range(len(a) - 1)]


def punch_section():
    """Quads (r, z) of the punch from r = 20 on, levels of the core."""
    arc = lambda n, begin, end: [(40 + 10 * math.sin(a), 10 - 10 * math.cos(a)) for a in line(begin, end, n)]
    inner, along, deep, up = 10, 6, 3, 8
    o, p, q, r = (40, 10), (40, 5), (44, 6), (45, 10)
    thirds, fine = line(0, 1, deep), line(20, 40, inner, 0.9)
    high = line(10, 100, up, 1.5)
    cells = quads(block(straight(p, q, along), straight(o, r, along))(thirds))
    cells += quads(block(arc(along, 0, math.pi / 4), straight(p, q, along))(thirds))
    cells += quads(block(arc(deep, math.pi / 4, math.pi / 2), straight(q, r, deep))(thirds))
    levels = line(0, 5, deep)[:-1] + line(5, 10, deep)[:-1] + high
    cells += quads([[(x, z) for x in fine] for z in levels])
    cells += quads([[(x, z) for x in line(40, 45, along)[:-1] + line(45, 50, deep)] for z in high])
    return cells, levels


def foundation_section():
    levels = line(-200, 0, 11, 1 / 1.4)
    radii = line(20, 40, 10, 0.9)[:-1] + line(40, 50, 6)[:-1] + line(50, 100, 5, 1.4)
    return quads([[(x, z) for x in radii] for z in levels]), levels


def solid(section, levels, around):
    """Hexahedra as tuples of eight points."""
    turn = lambda p, a: (p[0] * math.cos(a), p[0] * math.sin(a), p[1])
    angles = line(0, math.pi / 2, around)
    cells = [tuple(turn(p, a) for p in quad) + tuple(turn(p, b) for p in quad)
             for quad in section for a, b in zip(angles, angles[1:])]
    half, side = around // 2, 11.0
    corner = (side * 0.92, side * 0.92)
    square = [[(x / half * (side + y / half * (corner[0] - side)), y / half * (side + x / half * (corner[1] - side)))
               for x in range(half + 1)] for y in range(half + 1)]
    plan = quads(square)
    rim = [row[-1] for row in square] + square[-1][-2::-1]
    circle = [(20 * math.cos(a), 20 * math.sin(a)) for a in angles]
    plan += quads(block(circle, rim)(line(0, 1, 3)))
    for below, above in zip(levels, levels[1:]):
        cells += [tuple((*p, below) for p in quad) + tuple((*p, above) for p in quad) for quad in plan]
    return cells


FACES = ((0, 1, 2, 3), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7))
# Of gmsh's hexahedron of 20 nodes and its quadrilateral of 8.
EDGES = ((0, 1), (0, 3), (0, 4), (1, 2), (1, 5), (2, 3), (2, 6), (3, 7), (4, 5), (4, 7), (5, 6), (6, 7))
SIDES = ((0, 1), (1, 2), (2, 3), (3, 0))


def middle(p, q):
    """Of an edge: on the circle around the axis or on that of the punch's edge where its ends are."""
    point = [(a + b) / 2 for a, b in zip(p, q)]
    r = [math.hypot(*x[:2]) for x in (p, q)]
    if abs(p[2] - q[2]) < 1e-6 and abs(r[0] - r[1]) < 1e-6 and r[0] > 19.99:
        scale = r[0] / math.hypot(*point[:2])
        return point[0] * scale, point[1] * scale, point[2]
    if all(abs(math.hypot(a - 40, x[2] - 10) - 10) < 1e-6 and a > 39.99 and x[2] < 10.01 for a, x in zip(r, (p, q))):
        a, z = math.hypot(*point[:2]) - 40, point[2] - 10
        to_arc, scale = 10 / math.hypot(a, z), 1 / math.hypot(*point[:2])
        return point[0] * scale * (40 + a * to_arc), point[1] * scale * (40 + a * to_arc), 10 + z * to_arc
    return tuple(point)


def write(path, cells, contact, end):
    """A gmsh file of format 2.2; contact and end: functions of the corners of a face."""
    numbers, points, solids, faces = {}, [], [], {}

    def number(p):
        key = tuple(round(c, 6) for c in p)
        if key not in numbers:
            numbers[key] = len(points) + 1
            points.append(tuple(p))
        return numbers[key]

    for cell in cells:
        e = [[cell[i][c] - cell[0][c] for c in range(3)] for i in (1, 3, 4)]
        volume = sum(e[0][i] * (e[1][i - 2] * e[2][i - 1] - e[1][i - 1] * e[2][i - 2]) for i in range(3))
        if volume < 0:
            cell = cell[4:] + cell[:4]
        solids.append([number(p) for p in cell] + [number(middle(cell[a], cell[b])) for a, b in EDGES])
        for face in FACES:
            at = [cell[i] for i in face]
            nodes = [number(p) for p in at]
            faces.setdefault(tuple(sorted(nodes)), []).append((at, nodes + [number(middle(at[a], at[b])) for a, b in SIDES]))
    names = {11: "contact", 12: "x0", 13: "y0", 14: "end", 15: "rest"}
    sides = []
    for ((at, nodes), *others) in faces.values():
        if others:
            continue
        tests = ((12, all(abs(p[0]) < 1e-5 for p in at)), (13, all(abs(p[1]) < 1e-5 for p in at)), (11, contact(at)), (14, end(at)))
        sides.append((next((tag for tag, holds in tests if holds), 15), nodes))
    with open(path, "w", encoding="ascii") as out:
        out.write("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n6\n3 1 \"body\"\n")
        out.writelines(f'2 {tag} "{name}"\n' for tag, name in names.items())
        out.write(f"$EndPhysicalNames\n$Nodes\n{len(points)}\n")
        out.writelines(f"{n} {p[0]:.7g} {p[1]:.7g} {p[2]:.7g}\n" for n, p in enumerate(points, 1))
        out.write(f"$EndNodes\n$Elements\n{len(sides) + len(solids)}\n")
        out.writelines(f"{n} 16 2 {tag} {tag} {' '.join(map(str, nodes))}\n" for n, (tag, nodes) in enumerate(sides, 1))
        out.writelines(f"{n} 17 2 1 1 {' '.join(map(str, ids))}\n" for n, ids in enumerate(solids, len(sides) + 1))
        out.write("$EndElements\n")


def main():
    around = int(sys.argv[1]) if len(sys.argv) > 1 else 8
    folder = sys.argv[2] if len(sys.argv) > 2 else os.path.dirname(os.path.abspath(__file__))
    low = 10 - 10 * math.cos(math.pi / 4) + 1e-5
    on_arc = lambda p: (math.hypot(p[0], p[1]) - 40) ** 2 + (p[2] - 10) ** 2 > 99.9
    write(os.path.join(folder, "punch.msh"), solid(*punch_section(), around),
          lambda at: all(p[2] < low and (p[2] < 1e-5 or on_arc(p)) for p in at), lambda at: all(p[2] > 99.99 for p in at))
    write(os.path.join(folder, "punch_foundation.msh"), solid(*foundation_section(), around + 2),
          lambda at: all(p[2] > -1e-5 for p in at), lambda at: all(p[2] < -199.99 for p in at))


if __name__ == "__main__":
    main()
