"""Partial slip under a tangential force (Cattaneo and Mindlin) for two equal bodies: stick radius and shear traction."""

import os
import sys

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import common
import numpy as np
from manufactured import GAUSS, WEIGHTS, shape, write_hexahedra

HERE = os.path.dirname(os.path.abspath(__file__))
RADIUS, SIZE, YOUNG, FRICTION = 100.0, 8.0, 1000.0, 0.3
APPROACH = 0.0098  # gives a contact radius of about 1
RATIO = 1.6  # growth of the cells away from the contact


def graded(h, end, fine):
    """0 to end: cells of size h up to fine, then growing."""
    points = list(np.linspace(0, fine, round(fine / h) + 1))
    while points[-1] < end:
        points.append(points[-1] + h * RATIO ** (len(points) - round(fine / h)))
    points = np.array(points)
    outer = points > fine + 1e-9
    points[outer] = fine + (points[outer] - fine) * (end - fine) / (points[-1] - fine)
    return points


def with_middles(points, degree):
    return points if degree == 1 else np.interp(np.arange(0, len(points) - 0.9, 0.5), np.arange(len(points)), points)


def meshes(degree, n):
    """Half bodies y > 0; n cells per contact radius on the paraboloid, fewer on the block; ids 1 far, 2 symmetry, 3
    contact, 4 free."""
    for name, h, sign in (("sphere", 1 / n, 1), ("block", 1.25 / n, -1)):
        axis = with_middles(graded(h, SIZE, 1.25), degree)
        depth = with_middles(graded(h, SIZE, h), degree)
        x = np.concatenate([-axis[:0:-1], axis])
        z, y, x = np.meshgrid(depth / SIZE, axis, x, indexing="ij")
        if sign > 0:
            gap = (x**2 + y**2) / (2 * RADIUS)
            points, ids = np.stack([x, y, gap + z * (SIZE - gap)], axis=-1), (4, 4, 2, 4, 3, 1)
        else:
            points, ids = np.stack([x, y, -SIZE * z], axis=-1)[::-1], (4, 4, 2, 4, 1, 3)
        write_hexahedra(f"cattaneo_{name}_{degree}_{n}.msh", degree, points, ids)


def case(degree, n, poisson, shift):
    meshes(degree, n)
    bodies = "".join(
        f"""subsection Body {number}
  set Name      = {name}
  set Mesh file = cattaneo_{name}_{degree}_{n}.msh
  subsection Material
    set Law             = linear elastic
    set Young's modulus = {YOUNG}
    set Poisson's ratio = {poisson}
  end
end
"""
        for number, name in ((1, "sphere"), (2, "block"))
    )
    text = f"""set Title = Partial slip of two equal bodies
subsection Discretization
  set Degree = {degree}
end
{bodies}subsection Boundary condition 1
  set Name         = support
  set Body         = 2
  set Boundary ids = 1
  set Components   = x, y, z
  set Value        = 0
end
subsection Boundary condition 2
  set Name         = approach
  set Body         = 1
  set Boundary ids = 1
  set Components   = x, y, z
  set Value        = {shift}*max(t-1,0); 0; -{APPROACH}*min(t,1)
end
subsection Boundary condition 3
  set Name         = symmetry
  set Boundary ids = 2
  set Components   = y
  set Value        = 0
end
subsection Contact pair 1
  set Name                 = contact
  set Slave body           = 1
  set Slave boundary ids   = 3
  set Slave where          = x^2+y^2<2.5
  set Master body          = 2
  set Master boundary ids  = 3
  set Friction coefficient = {FRICTION}
end
subsection Load stepping
  set Interval ends = 1, 2
  set Increments    = 1, 1
end
subsection Newton
  set Force tolerance   = 1e-6
  set Contact tolerance = 1e-6
end
subsection Linear solver
  set Type      = condensed
  set Tolerance = 1e-8
end
"""
    return common.write_case(f"cattaneo_{degree}_{n}_{poisson}.prm", text)


def exact(force, tangential, poisson):
    """Contact radius, stick radius, largest pressure, and the shear traction over r, of the full model's forces."""
    stiffness = YOUNG / (2 * (1 - poisson**2))
    a = (3 * force * RADIUS / (4 * stiffness)) ** (1 / 3)
    c = a * (1 - tangential / (FRICTION * force)) ** (1 / 3)
    p0 = 3 * force / (2 * np.pi * a**2)

    def pressure(r):
        return p0 * np.sqrt(np.maximum(0, 1 - r**2 / a**2))

    def shear(r):
        return FRICTION * (pressure(r) - p0 * c / a * np.sqrt(np.maximum(0, 1 - r**2 / c**2)))

    return a, c, p0, pressure, shear


def measure(run, poisson):
    """Numbers of the table, and r, shear traction of the slave nodes."""
    last = run.contact[-1]
    force, tangential = 2 * abs(last["slave force z"]), 2 * abs(last["slave force x"])
    a, c, p0, pressure, shear = exact(force, tangential, poisson)
    surface = run.surface()
    slave = np.where(np.max(surface.fields["area"][surface.cells], axis=(1, 2)) > 0)[0]  # the master has no areas
    cells = surface.cells[slave]
    n = cells.shape[1]
    value, slope = shape(n, GAUSS)

    def at_points(field, first=value, second=value):
        return np.einsum("qj,ri,cji...->cqr...", first, second, field[cells])

    x, dx, dy = (at_points(surface.reference, *v) for v in ((value, value), (value, slope), (slope, value)))
    area = np.abs(dx[..., 0] * dy[..., 1] - dx[..., 1] * dy[..., 0]) * np.outer(WEIGHTS, WEIGHTS)
    r = np.hypot(x[..., 0], x[..., 1])
    traction = at_points(surface.fields["friction_traction"])
    sign = np.sign(np.sum(area * traction[..., 0]))
    difference = traction - np.stack([sign * shear(r), 0 * r, 0 * r], axis=-1)
    error_shear = np.sqrt(np.sum(area * np.sum(difference**2, axis=-1)) / np.sum(area * shear(r) ** 2))
    error_pressure = at_points(surface.fields["CPRESS"]) - pressure(r)
    error_pressure = np.sqrt(np.sum(area * error_pressure**2) / np.sum(area * pressure(r) ** 2))
    # areas of the nodes: those of their face parts; half model, hence 2
    used, first = np.unique(np.round(surface.reference[np.unique(cells)], 9), axis=0, return_index=True)
    nodes = np.unique(cells)[first]
    areas, status = surface.fields["area"][nodes], surface.fields["CSTATUS"][nodes]
    stick = np.sqrt(2 * np.sum(areas[status > 1.5]) / np.pi)
    closed = np.sqrt(2 * np.sum(areas[status > 0.5]) / np.pi)
    profile = np.hypot(used[:, 0], used[:, 1]), np.linalg.norm(surface.fields["friction_traction"][nodes], axis=1)
    return {
        "ratio": tangential / (FRICTION * force),
        "a": a,
        "c": c,
        "p0": p0,
        "closed": closed,
        "stick": stick,
        "shear": error_shear,
        "pressure": error_pressure,
        "Newton": sum(row["Newton iterations"] for row in run.contact),
    }, profile


HEADER = ["", "n", "ν", "scheme", "Q/(μF)", "a", "closed radius / a", "c/a", "stick radius / a"]
HEADER += ["L2 error of p", "L2 error of q", "Newton", ""]
SHIFT = 0.0012
SOFT = {"Contact pair 1/Normal augmentation factor": "0.1"}
# paths to the same state, tried in this order
PATHS = (("", {}), ("augmentation 0.1", SOFT), ("1 + 4 increments", {"Load stepping/Increments": "1, 4"}))


def line(degree, n, poisson, scheme):
    prm = case(degree, n, poisson, SHIFT)
    name = f"cattaneo_{degree}_{n}_{poisson}_{scheme}".replace(" ", "_").replace(",", "")
    notes = []
    for note, sets in PATHS:
        run = common.run(prm, name, sets=sets, pair=dict(common.keys_of(scheme), Surface="smoothed"))
        if run.converged:
            break
        notes.append((note or "default") + " fails")
        print(run.log.strip().splitlines()[-1], flush=True)
    if not run.converged:
        return [f"Q{degree}", n, poisson, scheme] + [""] * 8 + ["no solution: " + ", ".join(notes)], None, None
    if note:
        notes.append(note)
    values, profile = measure(run, poisson)
    row = [f"Q{degree}", n, poisson, scheme, f"{values['ratio']:.3f}", f"{values['a']:.3f}"]
    row += [f"{values['closed'] / values['a']:.3f}", f"{values['c'] / values['a']:.3f}"]
    row += [f"{values['stick'] / values['a']:.3f}", f"{100 * values['pressure']:.1f} %"]
    row += [f"{100 * values['shear']:.1f} %", f"{values['Newton']:.0f}", ", ".join(notes)]
    print(row, flush=True)
    return row, values, profile


SCHEMES = ("nodal", "integration point", "averaged, segment")
CASES = [(1, n, 0.0, scheme) for n in (3, 4, 5, 6, 8) for scheme in SCHEMES]
CASES += [(1, 6, 0.3, "averaged, segment")]
CASES += [(2, n, 0.0, scheme) for n in (1.5, 2, 2.5, 3, 4) for scheme in SCHEMES]


def main():
    cases = [c for c in CASES if c[1] == 4] if "--quick" in sys.argv else CASES
    finest = {degree: max(c[1] for c in cases if c[0] == degree) for degree in {c[0] for c in cases}}
    rows, curves = [], []
    for degree, n, poisson, scheme in cases:
        row, values, profile = line(degree, n, poisson, scheme)
        rows.append(row)
        if values and poisson == 0 and n == finest[degree]:
            curves.append((f"Q{degree}, n = {n}, {scheme}", values, profile))
    part = os.path.join(common.SCRATCH, "cattaneo_part.md")
    with open(os.path.join(HERE, "cattaneo_mindlin.md"), "w") as file:
        file.write(TEXT.format(table=common.table(part, HEADER, rows)))
    figure, axes = common.figure(7.0, 4.2)
    for (label, values, (r, q)), marker in zip(curves, "os^xvd"):
        axes.plot(r / values["a"], q / (FRICTION * values["p0"]), marker, fillstyle="none", ms=4, label=label)
    values = curves[-1][1]
    r = np.linspace(0, 1.3, 500)
    c = values["c"] / values["a"]
    root = [np.sqrt(np.maximum(0, 1 - r**2)), np.sqrt(np.maximum(0, 1 - r**2 / c**2))]
    axes.plot(r, root[0] - c * root[1], "k-", lw=1, label=f"Cattaneo-Mindlin, Q/(μF) = {values['ratio']:.3f}")
    axes.plot(r, root[0], "k:", lw=1, label="Coulomb's bound, Hertz")
    axes.set_xlim(0, 1.3)
    axes.set_xlabel("r / a")
    axes.set_ylabel("shear traction / (μ p0)")
    axes.grid(alpha=0.3)
    axes.legend(fontsize=8)
    figure.savefig(os.path.join(HERE, "cattaneo_mindlin.png"), dpi=150)


TEXT = """## Partial slip: Cattaneo and Mindlin

A paraboloid (R = 100, contact radius about 1) is pressed on a block of the same material, then moved sideways with Q
about half of μF: half models with n cells per unit length on the paraboloid and 0.8 n on the block, bodies of size 8,
small strain, `Surface = smoothed`. a, c and the tractions of the theory are those of the computed forces F and Q. The
theory supposes equal elastic constants and slip along Q only, which is exact for ν = 0; the row with ν = 0.3 shows the
discretization and that approximation together. Closed and stick radius are those of circles with the area of the nodes
of that CSTATUS. L2 errors are relative, over the slave surface, q with the vector of the friction traction.

All schemes find a solution at every level with the default settings. With Q1 the averaged scheme comes within 3.5 % of the stick
radius at n = 3 and 1.5 % at n = 8, and its shear traction errs by 40, 31, 21, 19 and 15 %; the nodal scheme is as good in the stick
radius and worse in the traction (50, 38, 26, 24 and 18 %); integration points are within 3.1 % of the stick radius and between the two
in the traction (45, 32, 24, 20 and 15 %), for two to three times the CPU. Q2 needs n = 3 to see the slip annulus; from there the
averaged scheme has 17 and 12 %, less than Q1 with twice the faces, integration points 17 and 17 %, and the nodal scheme gets worse
(17 and 27 %), as on the Hertz problem.

Until November 2026 this page said that integration points cycle and miss the stick radius by 10 % and more. That was a mistake of ours,
not of the scheme: rows that hold friction multipliers at zero had the weight of eq. (47), which has another unit than the rows of
friction, and held those of the points that stick back (theory.md, Q4).

{table}
![Shear traction over the radius](cattaneo_mindlin.png)
"""

if __name__ == "__main__":
    main()
