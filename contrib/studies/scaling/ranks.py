#!/usr/bin/python3
"""The case `hertz` on 1 to 16 ranks: the same results, work of the ranks and its balance, messages.

    ranks.py [N]...    (default: 12 24)

Writes ranks.md; sizes that are not named keep their results of ranks.json. mpi_count.c, preloaded, counts messages and
takes the CPU that is spent in MPI, most of it waiting, off.
"""

import os
import subprocess
import sys

import hertz_case
import numpy as np
from hertz_case import common

DEFAULT = [12, 24]
RANKS = [1, 2, 4, 8, 16]
FRICTION = 0.3
SOLVER = "condensed"
# Two runs that differ in Krylov iterations only: what one of these sends.
MESSAGE_RANKS, TOLERANCES = 8, ("1e-10", "1e-3")
COUNTS = ["messages", "messages bytes", "reductions", "gathers", "gathers bytes", "other collectives"]


def nodal(mesh, folder):
    """Displacements of all nodes and pressures at the slave nodes, whatever rank wrote them."""
    body = common.nodus.Results(folder).bodies()
    cells = body.cells.reshape(len(body.cells), -1)
    upper = np.zeros(len(body.points), bool)
    upper[cells] = (body.reference[cells, 2].mean(axis=1) > 0)[:, None]
    displacement = np.full((len(mesh.nodes), 3), np.nan)
    displacement[mesh.numbers_at(body.reference, upper)] = body.fields["displacement"]
    if np.isnan(displacement).any():
        raise SystemExit(f"{folder}: nodes are missing in the results")
    return displacement, hertz_case.pressures(mesh, folder)


def counting_library():
    path = os.path.join(common.SCRATCH, "libmpi_count.so")
    source = os.path.join(hertz_case.HERE, "mpi_count.c")
    subprocess.run(["mpicc", "-O2", "-shared", "-fPIC", "-o", path, source], check=True)
    return path


def counted(folder, ranks):
    """What mpi_count.c wrote: name -> one value for each rank."""
    result = {}
    for rank in range(ranks):
        with open(os.path.join(folder, f"mpi_count.{rank}")) as file:
            for line in file:
                name, value = line.rsplit(" ", 1)
                result.setdefault(name, []).append(float(value))
    return {name: np.array(values) for name, values in result.items()}


def measure(n, library):
    mesh, result = hertz_case.Mesh(n), {}
    for ranks in RANKS:
        run = hertz_case.nodus(n, f"ranks_{n}_{ranks}", SOLVER, FRICTION, ranks, preload=library)
        if run["exit"] != 0:
            result[str(ranks)] = {"converged": False}
            continue
        contact, profile, count = run["contact"], run["profile"], counted(run["folder"], ranks)
        force = np.array([contact[f"slave force {axis}"] for axis in "xyz"])
        displacement, pressure = nodal(mesh, run["folder"])
        if ranks == 1:
            first = force, contact["maximum pressure"], displacement, pressure
        start = next(p["cpu_seconds"] for p in profile["phases"] if p["name"] == "program start") / ranks
        work = count["process cpu"] - count["cpu"] - start
        result[str(ranks)] = {
            "converged": True,
            "cpu": profile["total"]["cpu_seconds"],
            "work": work.sum(),
            "busiest": work.max() / work.mean(),
            "peak": profile["total"]["private_bytes"],
            "peak before": profile["phases"][0]["private_bytes"],
            "Newton": profile["newton_iterations"],
            "Krylov": profile["krylov_iterations"],
            "statuses": [int(contact[f"{name} nodes"]) for name in ("open", "slip", "stick")],
            "force": np.abs(force - first[0]).max() / np.abs(first[0]).max(),
            "largest": abs(contact["maximum pressure"] / first[1] - 1),
            "displacement": np.abs(displacement - first[2]).max() / np.abs(first[2]).max(),
            "pressure": np.abs(pressure - first[3]).max() / first[3].max(),
        }
    runs = []
    for tolerance in TOLERANCES:
        name, sets = f"ranks_{n}_messages", {"Linear solver/Tolerance": tolerance}
        run = hertz_case.nodus(n, name, SOLVER, 0.0, MESSAGE_RANKS, sets, library)
        count = {key: values.mean() for key, values in counted(run["folder"], MESSAGE_RANKS).items()}
        profile = run["profile"]
        set_ups = next(p["calls"] for p in profile["phases"] if p["name"] == "solver set-up")
        runs.append((profile["newton_iterations"], set_ups, profile["krylov_iterations"], count))
    (newton, set_ups, krylov, count), (newton_2, set_ups_2, krylov_2, count_2) = runs
    if (newton, set_ups) == (newton_2, set_ups_2) and krylov > krylov_2:
        per = {name: (count[name] - count_2[name]) / (krylov - krylov_2) for name in COUNTS}
        rest = {name: (count[name] - krylov * per[name]) / newton for name in COUNTS}
        result["sent"] = {"Newton": newton, "Krylov": krylov, "per Krylov": per, "rest per Newton": rest}
    return result


def main():
    kept = hertz_case.Kept("ranks")
    os.makedirs(common.SCRATCH, exist_ok=True)
    library = counting_library()
    for n in map(int, sys.argv[1:] or DEFAULT):
        kept[str(n)] = measure(n, library)
    write(kept)


def write(kept):
    rows, work, memory, sent = [], [], [], []
    for n in sorted(map(int, kept.values)):
        found = kept.get(str(n))
        for ranks in RANKS:
            r, first = found[str(ranks)], found["1"]
            if not r["converged"]:
                rows.append([n, ranks, "stops", *[""] * 6])
                continue
            statuses = "/".join(map(str, r["statuses"]))
            differences = [f"{r[name]:.0e}" for name in ("force", "largest", "displacement", "pressure")]
            rows.append([n, ranks, r["Newton"], r["Krylov"], statuses, *(differences if ranks > 1 else [""] * 4)])
            again = f"{100 * (r['work'] / first['work'] - 1) / (ranks - 1):.1f} %" if ranks > 1 else ""
            work.append([n, ranks, f"{r['cpu']:.1f}", f"{r['work']:.2f}", f"{r['work'] / first['work']:.2f}", again,
                         f"{r['busiest']:.2f}"])  # fmt: skip
            peaks = [r["peak before"], r["peak"]]
            memory.append([n, ranks, *[f"{p / 2**20 / ranks:.1f}" for p in peaks]])
        if "sent" in found:
            for what in ("per Krylov", "rest per Newton"):
                values = found["sent"][what]
                sent.append([n, MESSAGE_RANKS, what, *[hertz_case.spaced(values[name]) for name in COUNTS]])
    path = os.path.join(hertz_case.HERE, "ranks.md")
    header = ["n", "ranks", "Newton", "Krylov", "open/slip/stick", "force", "largest pressure", "displacements",
              "pressures"]  # fmt: skip
    text = common.table(path, header, rows)
    header = ["n", "ranks", "CPU s", "work s", "work / 1 rank", "again on each further rank", "busiest / mean"]
    work_text = common.table(path, header, work)
    memory_text = common.table(path, ["n", "ranks", "at start", "whole run"], memory)
    sent_text = common.table(path, ["n", "ranks", "", *COUNTS], sent)
    with open(path, "w") as file:
        file.write(f"""## Ranks

`contrib/studies/scaling/ranks.py` on {hertz_case.machine()}; {kept.dates()}. Case hertz (`hertz_case.py`) with friction
{FRICTION}, {SOLVER} solver. More ranks than cores say nothing about wall time; they are here for results, work, memory
and messages.

### The same results

Differences from one rank, each relative to the largest value there: total contact force, largest pressure (of
`contact.csv`, 12 digits), displacements of all nodes and pressures of all slave nodes (of the VTU files, in single
precision: 1e-7 is their rounding). Newton may stop one iteration earlier or later: the coarse levels depend on the
ranks, and so do the last digits of a correction.

{text}
### Work and its balance

*CPU*: user and system time of all ranks, from `profile.json`. A rank that waits for a message polls in Open MPI, and
that counts as CPU (also with `mpi_yield_when_idle`, used here). *Work* is therefore the CPU outside of MPI calls,
without the start of the program (0.4 s on each rank), summed over the ranks: `mpi_count.c`, preloaded, takes the CPU time
of each MPI call off. *Again on each further rank*: what a rank adds to the work, relative to the work of one rank alone:
work that every rank does for the whole model, on cells around its own (stiffnesses of neighbours' cells are integrated
again), and what ranks that share a core take from each other's cache.

{work_text}
### Private MiB per rank

Heap and stack, mean over ranks, largest at the end of a phase. *At start*: before the parameters are read. The code of the
libraries is not in it: ranks of one machine share those pages.

{memory_text}
### Messages

Calls of MPI by each rank, mean over {MESSAGE_RANKS} ranks, without friction. *Per Krylov*: difference of two runs that
differ in the tolerance of the linear solver, and by it in Krylov iterations only; *rest per Newton*: all the others.
Bytes are those sent. *Other collectives* are nearly all barriers: of ML, of set-up, and those in which ranks without contact sleep.

{sent_text}""")


if __name__ == "__main__":
    main()
