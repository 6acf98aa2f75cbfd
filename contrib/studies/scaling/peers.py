#!/usr/bin/python3
"""nodus beside CalculiX and Kratos on the comparison case `hertz`: CPU, memory, iterations and error of the pressures.

    peers.py [N]...    (default: 6 12 24; 32 takes half an hour)

Writes peers.md; sizes that are not named keep their results of peers.json. Needs ccx and, as KRATOS_PYTHON, a Python
that has KratosMultiphysics; a program that is missing is left out. The programs take turns.
"""

import json
import os
import shutil
import subprocess
import sys

import hertz_case
from hertz_case import common

DEFAULT = [6, 12, 24]
OFF = "nodus, output off"
PEERS = ("CalculiX", "Kratos")
HEADER = ["n", "degrees of freedom", "rounds", "program", "CPU s", "/ nodus", "peak MiB", "bytes per DoF", "private MiB",
          "private bytes per DoF", "Newton iterations", "error of the pressure", "largest / Hertz's"]  # fmt: skip


def rounds(n):
    return 3 if n <= 12 else 2 if n <= 24 else 1


def available(program):
    if program == "CalculiX":
        return shutil.which(os.environ.get("CCX", "ccx")) is not None
    python = os.environ.get("KRATOS_PYTHON", "python3")
    code = "import KratosMultiphysics.ContactStructuralMechanicsApplication"
    return subprocess.run([python, "-c", code], capture_output=True).returncode == 0


def run(program, n, mesh):
    if program in ("nodus", OFF):
        sets = {"Output/Write VTU": "false"} if program == OFF else {}
        found = hertz_case.nodus(n, f"peers_{n}" + ("_off" if sets else ""), sets=sets)
        result = {key: found[key] for key in ("cpu", "peak MiB", "private MiB")}
        result["converged"] = found["exit"] == 0
        if result["converged"]:
            result["Newton"] = found["profile"]["newton_iterations"]
            if program == OFF:
                return result
            force, pressure = found["contact"]["slave force z"], hertz_case.pressures(mesh, found["folder"])
    else:
        command = [sys.executable, os.path.join(hertz_case.HERE, "peers", program.lower() + ".py"), str(n)]
        result = json.loads(subprocess.run(command, check=True, text=True, stdout=subprocess.PIPE).stdout)
        print(f"  {program} {n}: exit {result['exit']}, {result['cpu']:.1f} CPU s, {result['peak MiB']:.0f} MiB", flush=True)
        if result["converged"]:
            force, pressure = result.pop("force"), result.pop("pressure")
    if result["converged"]:
        result["force"] = force
        result["error"], result["largest"] = hertz_case.profile_error(mesh, pressure, force)
    return result


def measure(n, programs, kept):
    """Keeps the round with the least CPU of each program; after each round, should a later one be interrupted."""
    mesh, best = hertz_case.Mesh(n), {}
    for done in range(1, rounds(n) + 1):
        for program in programs:
            result = run(program, n, mesh)
            if program not in best or result["cpu"] < best[program]["cpu"]:
                best[program] = result
        kept[str(n)] = {**best, "rounds": done}


def rows(kept):
    for n in sorted(map(int, kept.values)):
        found, dofs = kept.get(str(n)), hertz_case.dofs(n)
        for program in ("nodus", OFF, *PEERS):
            if program not in found:
                continue
            r = found[program]
            if not r["converged"]:
                yield [n, hertz_case.spaced(dofs), found.get("rounds", ""), program, "stops", *[""] * 8]
                continue
            yield [
                n,
                hertz_case.spaced(dofs),
                found.get("rounds", ""),
                program,
                f"{r['cpu']:.2f}" if r["cpu"] < 10 else f"{r['cpu']:.1f}",
                f"{r['cpu'] / found['nodus']['cpu']:.2f}",
                f"{r['peak MiB']:.0f}",
                hertz_case.spaced(r["peak MiB"] * 2**20 / dofs),
                f"{r['private MiB']:.0f}",
                hertz_case.spaced(r["private MiB"] * 2**20 / dofs),
                r["Newton"],
                f"{100 * r['error']:.1f} %" if "error" in r else "",
                f"{r['largest']:.3f}" if "error" in r else "",
            ]


def main():
    kept = hertz_case.Kept("peers")
    programs = ["nodus", OFF] + [program for program in PEERS if available(program)]
    for n in map(int, sys.argv[1:] or DEFAULT):
        measure(n, programs, kept)
    path = os.path.join(hertz_case.HERE, "peers.md")
    text = common.table(path, HEADER, rows(kept))
    with open(path, "w") as file:
        file.write(f"""## nodus, CalculiX and Kratos on the case hertz

`contrib/studies/scaling/peers.py` on {hertz_case.machine()}; {kept.dates()}. The same mesh (`hertz_case.py`) without
friction in one increment, one process and one thread each; the programs took turns in one run, three rounds up to
n = 12, two at n = 24, one above. CPU is user and system time of the least round, with reading the mesh and writing
results.

- nodus: averaged contact by segment, linear elastic, finite deformation of the contact, condensed solver, Newton to 1e-8;
  *output off*: without the VTU files, which take memory for a copy of the mesh with its fields.
- CalculiX: `peers/calculix.py`, surface-to-surface penalty of 50 E, its own slope for hard contact, with which it
  takes its own tolerances (0.5 % of the force); iterative solver with incomplete Cholesky.
- Kratos: `peers/kratos.py`, mortar by augmented Lagrangian multipliers, linear kinematics, AMG-preconditioned LGMRES
  with the settings of its contact examples, tolerance 1e-6.

*Peak* is the largest resident memory, which counts the pages of shared libraries that were touched; *private* the
largest anonymous part of it (heap and stacks), sampled every 10 ms: what grows with the model.

*Error of the pressure*: nodal pressures p against Hertz's p_H over his contact circle,
sqrt(sum w (p - p_H)^2 / sum w p_H^2), w the area of the slave mesh around each node. p_H and the circle are those of
the force that each program computed: a = (3 F R / 4 E*)^(1/3), p_0 = 3 F / (2 pi a^2). Blocks as small as these (the
circle has 0.45 of their edge) press a little differently from half-spaces, so the error does not go to zero.

Kratos' pressures are its augmented normal pressures at active slave nodes. At n = 12 single values reach 2.4 times
Hertz's while its force agrees with the others; whether that is Kratos, its settings here or the way they are read was
not examined, so its errors are to be taken with care.

{text}""")


if __name__ == "__main__":
    main()
