#!/usr/bin/python3
"""The case `hertz` on 1 to 16 ranks: CPU and its balance on 1 and 2, the same results on all.

    ranks.py [N]...    (default: 12 24)

Writes ranks.md; sizes that are not named keep their results of ranks.json.
"""

import os
import sys

import hertz_case
import numpy as np
from hertz_case import common

DEFAULT = [12, 24]
RANKS = [1, 2, 4, 8, 16]
FRICTION = 0.3
SOLVER = "condensed"


def nodal(mesh, folder):
    """Displacements of all nodes and pressures at the slave nodes, whatever rank wrote them."""
    body = common.results.Results(folder).mesh("bodies")
    cells = body.cells.reshape(len(body.cells), -1)
    upper = np.zeros(len(body.points), bool)
    upper[cells] = (body.reference[cells, 2].mean(axis=1) > 0)[:, None]
    displacement = np.full((len(mesh.nodes), 3), np.nan)
    displacement[mesh.numbers_at(body.reference, upper)] = body.fields["displacement"]
    if np.isnan(displacement).any():
        raise SystemExit(f"{folder}: nodes are missing in the results")
    return displacement, hertz_case.pressures(mesh, folder)


def measure(n):
    mesh, result = hertz_case.Mesh(n), {}
    for ranks in RANKS:
        run = hertz_case.nodus(n, f"ranks_{n}_{ranks}", SOLVER, FRICTION, ranks)
        if run["exit"] != 0:
            result[str(ranks)] = {"converged": False}
            continue
        contact, profile = run["contact"], run["profile"]
        force = np.array([contact[f"slave force {axis}"] for axis in "xyz"])
        statuses = [int(contact[f"{name} nodes"]) for name in ("open", "slip", "stick")]
        displacement, pressure = nodal(mesh, run["folder"])
        if ranks == 1:
            first = force, contact["maximum pressure"], displacement, pressure
        result[str(ranks)] = {
            "converged": True,
            "cpu": profile["total"]["cpu_seconds"],
            "busiest": profile["total"]["cpu_seconds_maximum"] / profile["total"]["cpu_seconds_mean"],
            "phases": {
                p["name"]: [p["cpu_seconds"], p["cpu_seconds_maximum"] / max(p["cpu_seconds_mean"], 1e-9)]
                for p in profile["phases"]
            },
            "peak": profile["total"]["peak_resident_bytes"],
            "Newton": profile["newton_iterations"],
            "Krylov": profile["krylov_iterations"],
            "statuses": statuses,
            "force": np.abs(force - first[0]).max() / np.abs(first[0]).max(),
            "largest": abs(contact["maximum pressure"] / first[1] - 1),
            "displacement": np.abs(displacement - first[2]).max() / np.abs(first[2]).max(),
            "pressure": np.abs(pressure - first[3]).max() / first[3].max(),
        }
    return result


def main():
    kept = hertz_case.Kept("ranks")
    for n in map(int, sys.argv[1:] or DEFAULT):
        kept[str(n)] = measure(n)
    rows, cpu = [], []
    for n in sorted(map(int, kept.values)):
        for ranks in RANKS:
            r = kept.get(str(n))[str(ranks)]
            if not r["converged"]:
                rows.append([n, ranks, "stops", *[""] * 6])
                continue
            statuses = "/".join(map(str, r["statuses"]))
            differences = [f"{r[name]:.0e}" for name in ("force", "largest", "displacement", "pressure")]
            rows.append([n, ranks, r["Newton"], r["Krylov"], statuses, *(differences if ranks > 1 else [""] * 4)])
            if ranks <= 2:
                for name in [*r["phases"], "total"]:
                    total, busiest = r["phases"][name] if name != "total" else (r["cpu"], r["busiest"])
                    if total > 0.005 * r["cpu"]:
                        cpu.append((n, ranks, name, total, busiest))
    path = os.path.join(hertz_case.HERE, "ranks.md")
    balance = []
    for n, ranks, name, total, busiest in cpu:
        if ranks == 2:
            alone = sum(c[3] for c in cpu if c[:3] == (n, 1, name))
            ratio = f"{total / alone:.2f}" if alone > 0 else ""
            balance.append([n, name, f"{alone:.2f}", f"{total:.2f}", ratio, f"{busiest:.2f}"])
    header = ["n", "phase", "CPU s, 1 rank", "2 ranks together", "ratio", "busier / mean"]
    balance_text = common.table(path, header, balance)
    memory = []
    for n in sorted(map(int, kept.values)):
        peaks = [kept.get(str(n))[str(ranks)].get("peak", 0.0) for ranks in RANKS]
        memory.append([n, *[f"{p / 2**20 / ranks:.0f}" for p, ranks in zip(peaks, RANKS)]])
    memory_text = common.table(path, ["n", *[f"{r} rank{'s' * (r > 1)}" for r in RANKS]], memory)
    header = ["n", "ranks", "Newton", "Krylov", "open/slip/stick", "force", "largest pressure", "displacements",
              "pressures"]  # fmt: skip
    text = common.table(path, header, rows)
    with open(path, "w") as file:
        file.write(f"""## Ranks

`contrib/studies/scaling/ranks.py` on {hertz_case.machine()}; {kept.dates()}. Case hertz (`hertz_case.py`) with friction
{FRICTION}, {SOLVER} solver. More ranks than cores say nothing about speed; they are here for the results only.

### The same results

Differences from one rank, each relative to the largest value there: total contact force, largest pressure (of
`contact.csv`, 12 digits), displacements of all nodes and pressures of all slave nodes (of the VTU files, in single
precision: 1e-7 is their rounding).

{text}
### CPU on two ranks

CPU of `profile.json`: user and system time of the processes, summed over ranks, and of the busier rank over the mean.
A rank that waits for a message polls in Open MPI, and that counts as CPU of the phase it is in (also with
`mpi_yield_when_idle`, used here): a ratio above 1 is work done twice, waiting, or both, and waiting makes the two ranks
look equally busy. With other programs on the two cores the ranks also wait for each other's turns.

{balance_text}
### Peak resident MiB per rank

Mean over ranks, with the code of all libraries (some 145 MiB), which ranks of one machine share.

{memory_text}""")


if __name__ == "__main__":
    main()
