"""Patch test V1: uniform pressure through two blocks whose meshes do not match. Writes patch.md and patch.png."""

import os
import sys

import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.dirname(HERE))
import common  # noqa: E402

PRESSURE, TOP = 25.0, -0.025
# cells of the lower and of the upper cube
PAIRS = {
    "3x3x2 under 2x2x2": ("3,3,2", "2,2,2"),
    "4x3x2 under 3x5x1": ("4,3,2", "3,5,1"),
    "2x2x1 under 5x4x2": ("2,2,1", "5,4,2"),
}
PRM = os.path.join(common.ROOT, "prm", "patch.prm")


def errors(degree, pair, slave, scheme):
    """Largest relative errors of the nodal pressures and of the displacement of the top."""
    lower, upper = PAIRS[pair]
    sets = {
        "Discretization/Degree": degree,
        "Body 1/Generator arguments": f"{lower} : 0,0,0 : 1,1,1 : true",
        "Body 2/Generator arguments": f"{upper} : 0,0,1 : 1,1,2 : true",
        "Contact pair 1/Initial status": "closed",
    }
    if slave == "lower":
        sets.update({
            "Contact pair 1/Slave body": 1,
            "Contact pair 1/Slave boundary ids": 5,
            "Contact pair 1/Master body": 2,
            "Contact pair 1/Master boundary ids": 4,
        })
    run = common.run(PRM, "patch", sets, common.keys_of(scheme))
    again = not run.converged
    if again:  # the interface bends, the facet normals at an edge make the geometry loop cycle
        run = common.run(PRM, "patch", sets, {**common.keys_of(scheme), "Normal": "averaged"})
    if not run.converged:
        return None
    body = run.bodies()
    top = body.field("displacement z")[body.reference[:, 2] > 2 - 1e-4]  # the files hold single precision
    pressure = run.surface().field("CPRESS")
    return np.max(np.abs(pressure / PRESSURE - 1)), np.max(np.abs(top / TOP - 1)), again


def cell(error):
    if error is None:
        return "no convergence"
    pressure, top = ("< 1e-7" if e < 1e-7 else f"{e:.1e}" for e in error[:2])  # the files hold single precision
    return f"{pressure} / {top}" + (" *" if error[2] else "")


def main():
    found, rows = {}, []
    for degree in (1, 2):
        for pair in PAIRS:
            for slave in ("upper", "lower"):
                row = [f"Q{degree}", pair, slave]
                for scheme in common.SCHEMES:
                    error = errors(degree, pair, slave, scheme)
                    found[degree, pair, slave, scheme] = error
                    row.append("no convergence" if error is None else cell(error))
                rows.append(row)
    text = common.table(
        os.path.join(HERE, "patch.md"), ["degree", "cells", "slave"] + list(common.SCHEMES), rows
    )

    figure, axes = common.figure(7.5, 4.2)
    cases = [key for key in found if key[3] == "nodal"]
    for (scheme, marker) in zip(common.SCHEMES, "osv^"):
        values = [found[key[:3] + (scheme,)] for key in cases]
        axes.semilogy(
            range(len(cases)), [np.nan if v is None else max(v[0], 1e-7) for v in values], marker, label=scheme
        )
    axes.set_xticks(
        range(len(cases)),
        [f"Q{key[0]}, {key[1].split(' under ')[0]}\nunder {key[1].split(' under ')[1]}\nslave {key[2]}" for key in cases],
        fontsize=6.5, rotation=60,
    )
    axes.set_ylabel("largest relative error of the nodal pressure [-]")
    axes.set_xlabel("case")
    axes.grid(True, axis="y", alpha=0.3)
    axes.legend(fontsize=8)
    axes.set_title("1e-7: zero in the single precision of the result files", fontsize=8)
    figure.savefig(os.path.join(HERE, "patch.png"), dpi=150)

    def span(scheme, field):
        values = [error[field] for key, error in found.items() if key[3] == scheme and error is not None]
        return min(values), max(values)

    def percent(scheme, field=0):
        low, high = span(scheme, field)
        return f"{100 * low:.2g} to {100 * high:.2g} %"

    failed = [" ".join(map(str, key)) for key, error in found.items() if error is None]
    words = (
        f"A uniform pressure of 25 must cross the interface unchanged (exact: CPRESS = 25, u_z = -0.025 on top). "
        f"Averaged by segments the scheme "
        + ("passes" if max(span("averaged, segment", 0)[1], span("averaged, segment", 1)[1]) < 1e-7 else "does NOT pass")
        + " on all meshes, for both degrees and slave sides, to the single precision of the result files. "
        f"The largest error of the pressure is {percent('averaged, face')} averaged by faces, {percent('integration point')} "
        f"at integration points and {percent('nodal')} with the nodal scheme: none of these three passes the patch test; "
        f"the top moves wrongly by at most {100 * span('averaged, face', 1)[1]:.2g}, "
        f"{100 * span('integration point', 1)[1]:.2g} and {100 * span('nodal', 1)[1]:.2g} %. "
        "The runs with * cycle in the geometry loop with facet normals (slave nodes that sit on edges of the bent master) and have "
        "averaged normals instead. "
        + (f"No convergence: {'; '.join(failed)}." if failed else "")
    )
    with open(os.path.join(HERE, "patch.md"), "w") as file:
        file.write(
            "## Patch test: uniform pressure across meshes that do not match\n\n" + words
            + "\n\nLargest relative error of the nodal pressure / of the displacement of the top, lower cells under upper cells:\n\n"
            + text + "\n![Largest error of the pressure](patch.png)\n"
        )


if __name__ == "__main__":
    main()
