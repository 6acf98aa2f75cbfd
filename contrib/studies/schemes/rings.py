"""Two rings under external pressure (V6): contradicting statuses and errors of the contact pressure, per scheme.

Writes rings.md and rings.png.
"""

import os
import sys

import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.dirname(HERE))
import common  # noqa: E402

EXACT = 9259259.26
TRACTION = "-1e7*{load}*t*x/sqrt(x^2+y^2); -1e7*{load}*t*y/sqrt(x^2+y^2)"
LEVELS = {1: (0, 1, 2, 3, 4), 2: (0, 1, 2, 3, 4)}
# cells of the quarter on the coarsest mesh: inner ring (slave) and outer ring around
MESHES = {"non-matching": (6, 4), "matching": (6, 6)}

PRM = """# A quarter of two concentric rings under external pressure, plane strain; Lame's solution
set Title = Concentric rings, quarter

{bodies}
subsection Boundary condition 1
  set Boundary ids = 13, 23
  set Components   = x
  set Value        = 0
end
subsection Boundary condition 2
  set Boundary ids = 12, 22
  set Components   = y
  set Value        = 0
end
subsection Boundary condition 3
  set Boundary ids = 14, 15, 24, 25
  set Components   = z
  set Value        = 0
end
subsection Boundary condition 4
  set Type         = traction
  set Body         = 2
  set Boundary ids = 21
  set Components   = x, y
  set Value        = 0
end
subsection Contact pair 1
  set Name                = interface
  set Slave body          = 1
  set Slave boundary ids  = 11
  set Master body         = 2
  set Master boundary ids = 20
  set Surface measure     = reference
  set Normal              = averaged
  set Initial status      = closed
end
"""
BODY = """subsection Body {number}
  set Mesh file  = {mesh}
  set Volume ids = {number}
  subsection Material
    set Law             = linear elastic
    set Young's modulus = 1e9
    set Poisson's ratio = 0.2
  end
end
"""


def ring(inside, outside, n_around, n_radial):
    r, angle, z = np.meshgrid(
        np.linspace(inside, outside, 2 * n_radial + 1),
        np.linspace(0, np.pi / 2, 2 * n_around + 1),
        np.linspace(0, 0.1, 3),
        indexing="ij",
    )
    return np.stack([r * np.cos(angle), r * np.sin(angle), z], axis=-1)


def case(mesh, level):
    n_slave, n_master = (n * 2**level for n in MESHES[mesh])
    name = f"rings_{mesh}_{level}"
    path = common.write_mesh(name, [ring(0.2, 0.6, n_slave, 2**level), ring(0.6, 1.0, n_master, 2**level)])
    return common.write_case(name, PRM.format(bodies="".join(BODY.format(number=b, mesh=path) for b in (1, 2))))


def evaluate(run, load):
    """Open sites, all sites, relative L2 error of CPRESS, largest relative error."""
    if not run.converged:
        return None
    contact, surface = run.contact[-1], run.surface()
    first = surface.nodes(5)
    area, error = surface.field("area")[first], surface.field("CPRESS")[first] / (load * EXACT) - 1
    n_open = int(contact["open nodes"])
    return n_open, n_open + int(contact["slip nodes"]), np.sqrt(area @ error**2 / area.sum()), np.max(np.abs(error))


def series():
    """(mesh, degree, surface, load) of what is compared."""
    for load in (1.0, 0.01):
        for mesh in MESHES:
            for degree in LEVELS:
                for surface in ("faceted", "smoothed") if degree == 1 else ("faceted",):
                    if load == 1.0 or mesh == "non-matching":
                        yield mesh, degree, surface, load


def main():
    found = {}
    for mesh, degree, surface, load in series():
        for level in LEVELS[degree]:
            prm = case(mesh, level)
            sets = {"Discretization/Degree": degree, "Boundary condition 4/Value": TRACTION.format(load=load)}
            for scheme, keys in common.SCHEMES.items():
                run = common.run(prm, "rings", sets, {**keys, "Surface": surface})
                found[mesh, degree, surface, load, scheme, level] = evaluate(run, load)
                if not run.converged:
                    print(run.log.strip().split("\n")[0][:300])

    def cells(level):
        return 6 * 2**level

    def cell(key):
        if found[key] is None:
            return "no convergence"
        n_open, n_sites, error, _ = found[key]
        return f"{n_open}/{n_sites}, {percent(error)}"

    def percent(value):
        return f"{100 * value:.2g} %" if value < 10 else f"{100 * value:.0e} %"

    def order(head, scheme):
        """From the last levels only: the coarsest meshes are not in the asymptotic range."""
        levels = [level for level in LEVELS[head[1]] if found[(*head, scheme, level)] is not None]
        levels = levels[-4:] if head[1] == 1 else levels[-3:]
        errors = [found[(*head, scheme, level)][2] for level in levels]
        if len(levels) < 3:
            return "-"
        value, deviation = common.fitted_order([1 / cells(level) for level in levels], errors)
        return f"{value:.2f} ± {deviation:.2f}"

    text = {}
    for load in (1.0, 0.01):
        rows = []
        for head in series():
            if head[3] != load:
                continue
            for scheme in common.SCHEMES:
                row = [head[0], f"Q{head[1]}", head[2] if head[1] == 1 else "curved", scheme]
                row += [cell((*head, scheme, level)) if level in LEVELS[head[1]] else "" for level in LEVELS[1]]
                rows.append(row + [order(head, scheme)])
        header = ["meshes", "degree", "surface", "scheme"] + [f"{cells(level)} faces" for level in LEVELS[1]] + ["order"]
        text[load] = common.table(os.path.join(HERE, "rings.md"), header, rows)

    figure, axes = common.figure(7.0, 4.6)
    for (scheme, marker), color in zip(zip(common.SCHEMES, "osv^"), ("C0", "C1", "C2", "C3")):
        for head, line, face in (
            (("non-matching", 1, "faceted", 1.0), ":", "none"),
            (("non-matching", 1, "smoothed", 1.0), "-", color),
            (("non-matching", 2, "faceted", 1.0), "--", "white"),
        ):
            values = [found[(*head, scheme, level)] for level in LEVELS[head[1]]]
            axes.loglog(
                [cells(level) for level in LEVELS[head[1]]],
                [np.nan if v is None else 100 * v[2] for v in values],
                line + marker,
                color=color,
                markerfacecolor=face,
                label=f"{scheme}, Q{head[1]} {head[2] if head[1] == 1 else 'curved'}",
            )
    axes.set_xticks([cells(level) for level in LEVELS[1]], [str(cells(level)) for level in LEVELS[1]])
    axes.minorticks_off()
    axes.set_xlabel("slave faces on the quarter circle [-]")
    axes.set_ylabel("relative L2 error of the contact pressure [%]")
    axes.grid(True, alpha=0.3)
    axes.legend(fontsize=6.5, ncol=1, loc="center left", bbox_to_anchor=(1.01, 0.5))
    figure.savefig(os.path.join(HERE, "rings.png"), dpi=150)

    def open_sites(scheme, mesh, surface, load):
        """Per level, Q1 then Q2."""
        counts = []
        for degree, chosen in ((1, surface), (2, "faceted")):
            results = [found[mesh, degree, chosen, load, scheme, level] for level in LEVELS[degree]]
            counts.append(" ".join("x" if value is None else str(value[0]) for value in results))
        return f"{counts[0]} and {counts[1]}"

    def claims():
        lines = []
        for mesh, surface, load in (
            ("matching", "faceted", 1.0),
            ("non-matching", "smoothed", 1.0),
            ("non-matching", "smoothed", 0.01),
            ("non-matching", "faceted", 1.0),
            ("non-matching", "faceted", 0.01),
        ):
            counts = "; ".join(f"{scheme} {open_sites(scheme, mesh, surface, load)}" for scheme in common.SCHEMES)
            lines.append(f"- {mesh}, {surface}, {'full load' if load == 1 else 'a hundredth of the load'}: {counts}")
        zero = all(
            value is not None and value[0] == 0
            for key, value in found.items()
            if key[3] == 1.0 and key[4] != "integration point"
            and (key[0] == "matching" or key[2] == "smoothed" or key[1] == 2)
        )
        held = "holds at the full load" if zero else "does NOT hold even at the full load"
        few = [
            f"{key[4]}, Q{key[1]}, {cells(key[5])} faces: {'no convergence' if value is None else value[0]}"
            for key, value in found.items()
            if key[3] != 1.0 and (key[2] == "smoothed" or key[1] == 2) and (value is None or value[0] > 0)
        ]
        lines.append(
            "\nClaim: no contradicting node for the nodal and the averaged schemes on matching meshes and, smoothed or with "
            f"quadratic cells, on non-matching ones at every level. It {held}; at a hundredth of it, there are exceptions on "
            f"the coarsest meshes ({'; '.join(few) or 'none'})."
        )
        return "\n".join(lines)

    def last(degree, surface, scheme):
        value = found["non-matching", degree, surface, 1.0, scheme, LEVELS[degree][-1]]
        return "no convergence" if value is None else percent(value[2])

    words = (
        "Every node of the interface is in contact and carries 9259259.26 (Lamé). A site that is open contradicts that. "
        "Open sites on the levels from coarse to fine, Q1 on five and Q2 (always curved) on four, x = no convergence:\n\n"
        + claims()
        + "\n\nOn non-matching facets (3 slave faces to 2 master faces) the sagitta of the facets is taken for a gap. At the full "
        "load only the coarsest meshes open there; at a hundredth of it every level does, and the pressures are wrong by 50 % "
        "and more. `Surface = smoothed` or quadratic cells remove that, except where the load is so small that even the "
        "fourth-order misfit of the smooth surfaces counts (first columns of the second table). There averages by "
        "faces and by segments err alike. "
        f"What is left on the finest non-matching meshes, Q1 smoothed / Q2: nodal {last(1, 'smoothed', 'nodal')} / "
        f"{last(2, 'faceted', 'nodal')}, integration point {last(1, 'smoothed', 'integration point')} / "
        f"{last(2, 'faceted', 'integration point')}, averaged by faces {last(1, 'smoothed', 'averaged, face')} / "
        f"{last(2, 'faceted', 'averaged, face')}, averaged by segments {last(1, 'smoothed', 'averaged, segment')} / "
        f"{last(2, 'faceted', 'averaged, segment')}: the pressures of the schemes that fail the patch test do not converge "
        "(order about 0), nor do those averaged by faces below the error of the rule (about 0.1 to 0.2 %); those averaged by "
        "segments do. On matching meshes all schemes agree for Q1; for Q2 the nodal pressures are of higher order."
    )
    with open(os.path.join(HERE, "rings.md"), "w") as file:
        file.write(
            "## Concentric rings: contradicting statuses and contact pressure on curved surfaces\n\n"
            + words
            + "\n\nOpen sites / all sites (nodes; integration points for that scheme) and relative L2 error of CPRESS. Columns: slave faces "
            "on the quarter circle. Order: fit over the last four (Q1) or three (Q2) levels with its standard deviation. External "
            "pressure 1e7 (largest displacement 0.8 % of the radius):\n\n"
            + text[1.0]
            + "\nExternal pressure 1e5, error relative to the hundredth of the pressure:\n\n"
            + text[0.01]
            + "\n![Error of the contact pressure](rings.png)\n"
        )


if __name__ == "__main__":
    main()
