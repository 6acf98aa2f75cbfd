#!/usr/bin/python3
"""Partial slip (Cattaneo and Mindlin) on uniform and adaptive meshes, and with the mesh refined in mid-path.
Writes cattaneo_mindlin.md, cattaneo_mindlin.png.

    cattaneo_mindlin.py [--report | --paths]     (--report: from the runs that are there; --paths: only the first table is)

First table: errors against unknowns and CPU. Second: a mesh that becomes finer during pressing and shearing against the same
mesh, or one as fine, from the start; loads by forces, and by displacements. Third: the change of the contact force with each
new mesh, and what other meshes would make of it.
"""

import json
import os
import re
import sys

import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.dirname(HERE))
sys.path.insert(0, os.path.join(os.path.dirname(HERE), "schemes"))
import cattaneo_mindlin as theory  # noqa: E402  (that of schemes/)
import common  # noqa: E402

sys.path.insert(0, HERE)
import partial_slip_case as case  # noqa: E402

MERGED = {f"{loop} loop/Mode": "newton" for loop in ("Geometry", "Threshold", "Status")}
NEAR = {"Adaptivity/Contact distance": 0.0075}  # gap at 1.22 contact radii
LEVELS = {"Adaptivity/Interval": 1, "Adaptivity/Refine fraction": 0.6}
KEPT = os.path.join(common.SCRATCH, "adaptivity", "cattaneo_mindlin.json")
FIELDS = ("area", "CSTATUS", "CPRESS", "friction_traction")
HOLD = {"Load stepping/Increments": "2, 12"}
TARGET = {"Adaptivity/Marking": "target error", "Adaptivity/Target error": 1e-9}  # all cells are split


def refined(level):
    return {"Body 1/Global refinement": level, "Body 2/Global refinement": level}


def adaptive(degree, first, level):
    return {"Discretization/Degree": degree, **refined(first), **NEAR, **LEVELS,
            "Adaptivity/Initial cycles": max(0, level - 1), "Adaptivity/Maximum level": level}  # fmt: skip


def series():
    for degree, levels in ((1, (2, 3, 4)), (2, (1, 2))):
        for level in levels:
            yield (f"Q{degree} uniform {level}", "force",
                   {"Discretization/Degree": degree, **refined(level), "Load stepping/Increments": "1, 1"})  # fmt: skip
    for degree, first, levels in ((1, 2, (1, 2, 3, 4)), (2, 1, (1, 2, 3))):
        for level in levels:
            yield (f"Q{degree} adaptive {level}", "force",
                   {**adaptive(degree, first, level), "Load stepping/Increments": "1, 2"})  # fmt: skip


def paths():
    """Name, loads, keys. The reference of "mid-path" is the run of the same loads "from the start"."""
    for loads in ("force", "displacement"):
        for level in (0, 1, 2):
            yield f"split {level} from the start", "graded_" + loads, refined(level)
        for when, interval in (("", 4), (", early", 2)):
            yield ("split 2 in mid-path" + when, "graded_" + loads,
                   {**TARGET, **HOLD, "Adaptivity/Interval": interval, "Adaptivity/Maximum level": 2})  # fmt: skip
        for cycles in (2, 3):
            yield (f"local {cycles} from the start", loads,
                   {**refined(2), **NEAR, "Adaptivity/Initial cycles": cycles, "Adaptivity/Maximum level": cycles})  # fmt: skip
        for cycles in (0, 2):
            yield ("local 3 in mid-path" + (f", {cycles} from the start" if cycles else ""), loads,
                   {**refined(2), **NEAR, **LEVELS, **HOLD, "Adaptivity/Interval": 2, "Adaptivity/Initial cycles": cycles,
                    "Adaptivity/Maximum level": 3})  # fmt: skip


def unknowns(log):
    found = re.findall(r"-> (\d+) unknowns", log) or re.findall(r"(\d+) displacement degrees of freedom", log)
    return int(found[-1])


def radii(surface):
    """Of the half circles with the areas of closed and of sticking nodes."""
    first = surface.nodes(9)
    area, status = surface.fields["area"][first], surface.fields["CSTATUS"][first]
    return [float(np.sqrt(2 * np.sum(area[status > least]) / np.pi)) for least in (0.5, 1.5)]


def jumps(run):
    """Of each new mesh: increment, time, per cent of the log, force and radii before and after: the next increment holds the load."""
    found, rows, increment = [], {int(row["increment"]): row for row in run.contact}, 0
    for line in run.log.splitlines():
        if match := re.match(r"Increment (\d+),", line):
            increment = int(match.group(1))
        elif match := re.search(r"the contact force of contact changes by (\S+) %", line):
            states = []
            for row in (rows[increment], rows[increment + 1]):
                force = [2 * row["slave force " + component] for component in "xyz"]
                states.append(force + radii(run.surface(row["time"])))
            found.append([increment, rows[increment]["time"], float(match.group(1)), states])
    return found


def measure(name, loads, keys):
    folder = re.sub(r"[ ,]+", "_", f"adaptivity/slip {loads} {name}")
    run = common.run(os.path.join(common.SCRATCH, "adaptivity", loads + ".prm"), folder, {**MERGED, **keys})
    found = {"name": name, "loads": loads, "converged": run.converged, "cpu": run.cpu}
    if not run.converged:
        return found
    values, (r, q) = theory.measure(run, 0.0)
    surface = run.surface()
    nodes = {}
    for x, *values_here in zip(surface.reference, *(surface.fields[key] for key in FIELDS)):
        if values_here[0] > 0:  # no master, no hanging node
            nodes["%.4f %.4f" % tuple(x[:2])] = [float(v) for v in values_here[:3]] + [float(values_here[3][0])]
    body = run.bodies()
    top = np.abs(body.reference[:, 2] - case.SIZE) < 1e-6
    found.update(values)
    found.update(
        unknowns=unknowns(run.log), nodes=nodes, r=list(r), q=list(q),
        shift=float(np.mean(body.fields["displacement"][top, 0])),
        force=[[row["time"], row["slave force x"], row["slave force y"], row["slave force z"]] for row in run.contact],
        counts=[int(run.contact[-1][key]) for key in ("open nodes", "slip nodes", "stick nodes")],
        jumps=jumps(run),
        failed=run.log.count("no equilibrium on the new mesh"))  # fmt: skip
    return found


def all_runs():
    theory.RADIUS, theory.YOUNG, theory.FRICTION = case.RADIUS, case.YOUNG, case.FRICTION
    boxes, graded = case.boxes(), case.graded()
    for mesh, prefix in ((boxes, ""), (graded, "graded_")):
        case.write(prefix + "force", mesh, case.BY_FORCE)
        case.write(prefix + "displacement", mesh, case.BY_DISPLACEMENT)
    if "--paths" in sys.argv:
        with open(KEPT) as file:
            return {"series": json.load(file)["series"], "paths": [measure(*keys) for keys in paths()]}
    return {"series": [measure(*keys) for keys in series()], "paths": [measure(*keys) for keys in paths()]}


def percent(value, digits=2):
    return f"{100 * value:.{digits}f} %"


def main():
    if "--report" in sys.argv:
        with open(KEPT) as file:
            found = json.load(file)
    else:
        found = all_runs()
        with open(KEPT, "w") as file:
            json.dump(found, file)
    report(found)


def report(found):
    rows = []
    for run in found["series"]:
        if not run["converged"]:
            rows.append([run["name"], "", f"{run['cpu']:.1f}", "did not converge"] + [""] * 5)
            continue
        force = run["force"][-1]
        rows.append([run["name"], run["unknowns"], f"{run['cpu']:.1f}", percent(run["pressure"], 1), percent(run["shear"], 1),
                     f"{run['closed'] / run['a']:.3f}", f"{run['stick'] / run['c']:.3f}",
                     f"{2 * abs(force[3]) / case.FORCE:.6f}", f"{run['shift']:.6f}"])  # fmt: skip
    header = ["mesh", "unknowns", "CPU s", "L2 error of p", "L2 error of q", "closed radius / a", "stick radius / c"]
    first = common.table(os.path.join(common.SCRATCH, "part.md"), header + ["F / applied", "shift"], rows)

    rows, changes = [], []
    start = {(run["loads"], run["name"]): run for run in found["paths"] if "mid-path" not in run["name"]}
    for run in found["paths"]:
        if not run["converged"]:
            rows.append([run["loads"], run["name"], "", f"{run['cpu']:.1f}", "did not converge"] + [""] * 10)
            continue
        force = run["force"][-1]
        rows.append([run["loads"].replace("graded_", ""), run["name"], run["unknowns"], f"{run['cpu']:.1f}",
                     f"{2 * force[3]:.4f}", f"{-2 * force[1]:.4f}", f"{run['shift']:.6f}",
                     percent(run["pressure"], 1), percent(run["shear"], 1), f"{run['closed']:.3f}", f"{run['stick']:.3f}",
                     " / ".join(map(str, run["counts"])), *against_start(run, start)])  # fmt: skip
        for increment, time, logged, states in run["jumps"]:
            (x, y, z, closed, stick), (x2, y2, z2, closed2, stick2) = states
            line = [run["loads"].replace("graded_", ""), run["name"], f"{max(0, time - 1):.3f}", f"{logged:.3g} %"]
            line += [percent((z2 - z) / z, 3), percent((x2 - x) / x, 3) if time > 1 else "", percent((y2 - y) / z, 2)]
            line += [f"{closed:.3f} -> {closed2:.3f}", other_meshes(run, start, time, states)]
            changes.append(line)
    header = ["loads", "mesh", "unknowns", "CPU s", "F", "Q", "shift", "L2 error of p", "L2 error of q", "closed radius"]
    second = common.table(os.path.join(common.SCRATCH, "part.md"), header +
                          ["stick radius", "open / slip / stick", "p differs", "q differs", "statuses differ"], rows)  # fmt: skip
    header = ["loads", "mesh", "t - 1", "log", "of F", "of Q", "of the reaction of the symmetry plane / F"]
    third = common.table(os.path.join(common.SCRATCH, "part.md"),
                         header + ["closed radius", "F, Q against the new mesh from the start"], changes)  # fmt: skip
    with open(os.path.join(HERE, "cattaneo_mindlin.md"), "w") as file:
        file.write(TEXT.format(approach=case.APPROACH, shift=case.SHIFT, first=first, second=second, third=third))

    figure, axes = common.figure(10.0, 4.0)
    figure.clear()
    left, right = figure.subplots(1, 2)
    for axis, key, label in ((left, "unknowns", "unknowns"), (right, "cpu", "CPU s")):
        for kind, style in (("Q1 uniform", "o--"), ("Q1 adaptive", "o-"), ("Q2 uniform", "s--"), ("Q2 adaptive", "s-")):
            runs = [run for run in found["series"] if run["converged"] and run["name"].startswith(kind)]
            axis.loglog([run[key] for run in runs], [run["shear"] for run in runs], style, label=kind)
        axis.set_xlabel(label)
        axis.set_ylabel("L2 error of the shear traction")
        axis.grid(True, which="both", alpha=0.3)
    left.legend()
    figure.savefig(os.path.join(HERE, "cattaneo_mindlin.png"), dpi=120)


def against_start(run, start):
    """At the nodes that it shares with the finest mesh from the start: differences of p and q, of the norm of these, and
    nodes that differ in status."""
    kind = "split 2" if "split" in run["name"] else "local 3"
    other = start.get((run["loads"], kind + " from the start"))
    if other is None or other is run:
        return ["", "", ""]
    both = [(run["nodes"][n], other["nodes"][n]) for n in run["nodes"] if n in other["nodes"]]
    here, there = (np.array(values) for values in zip(*both))
    area = np.minimum(here[:, :1], there[:, :1])
    apart = np.sqrt(np.sum(area * (here - there) ** 2, axis=0) / np.sum(area * there**2, axis=0))
    return [percent(apart[2], 1), percent(apart[3], 1), f"{np.sum(here[:, 1] != there[:, 1])} of {len(both)}"]


def other_meshes(run, start, time, states):
    """By how much F and Q after the change differ from those of a run from the start on the same mesh."""
    if "split" not in run["name"]:
        return ""
    level = [jump[1] for jump in run["jumps"]].index(time) + 1
    other = start[run["loads"], f"split {level} from the start"]["force"]
    _, x, _, z = min(other, key=lambda row: abs(row[0] - time))
    after = states[1]
    return f"{percent(after[2] / (2 * z) - 1, 3)}, " + (percent(after[0] / (2 * x) - 1, 2) if time > 1 else "")


TEXT = """## Partial slip on adaptive meshes

A paraboloid (R = 100) on a block of the same material (E = 1000, ν = 0, where the theory is exact), half model, bodies of size
8 and 9, friction coefficient 0.3, F = 20/3 (a = 1), Q half of the limit (stick radius c = 0.794). By force: tractions on the far
sides, which cannot tilt (the paraboloid's far side is a plane of symmetry, the sides of the block are guided). By displacement:
approach {approach}, shift {shift}.

### Uniform and adaptive

By force; uniform in one increment each for pressing and shearing, adaptive in one and two, with Initial cycles one less than the
level and a change of the mesh after each of the first two increments. L2 errors of pressure and shear traction over the slave
surface against the theory for the computed forces. The adaptive Q1 mesh of level 3 has half of the error of the uniform one with 26 times
the unknowns, for less than a tenth of its CPU. Q2 does worse at equal unknowns while ten or fewer nodes are in contact (all but the last mesh). Q2
uniform 3 was stopped after three CPU minutes in its first increment, where the bodies hang on one sticking node and the linear
solver needed 512 iterations once. The finest adaptive runs spend most of their CPU on that first increment, too; with "Initial
status = closed" and slave faces for r < 2.5 only it takes a third of the time in Q2 adaptive 3.

{first}
### Refined in mid-path

Six steps of shearing, after pressing; a held increment after each step shows what the new mesh has changed. "split": all cells
of a graded mesh are split in eight, twice, after steps 1 and 3 (early: after pressing and step 1), so that the last mesh is
*the same* as that of "split 2 from the start". "local": the cubes of the first table, h = 1, refined by the estimated error three times at most.
p, q and statuses are compared with the finest mesh from the start, at the nodes that both have (norm of the difference over norm).

{second}
At the end the resultants, the radii, the statuses of nearly all nodes and the tractions are those of the same mesh from the start, nearer
than those of the next coarser mesh from the start: pressures to 0.1 % (2.5 to 6 %), shear tractions to 1.6 and 2 % when the mesh was changed
early and to 7 and 10 % when it was changed at half of the shear (10 and 13 %). What is carried over of sites that stick is the jump of
the displacement: when the interpolated displacement was (new nodes stuck where that had put them), shear tractions differed by 16
to 22 %, alternating in sign from node to node.

### Jumps at the transfer

{third}
- **By force F and Q do not change** (below 0.001 %). The 0.4 to 1.1 % in the log are the reaction of the symmetry plane:
  the log has the norm of the change of the whole vector, and the y component of the force on half a contact is a matter of the mesh.
- **By displacement** F changes by the stiffness of the mesh alone: afterwards it is that of the new mesh from the start to 0.004 %.
  Above 0.5 % it is discretisation: 4.4 and 2.0 % with these meshes, 0.3 % and less once cells are small.
- By displacement Q changes by the mesh, too (the meshes from the start differ by 3 % at these times), and is 3 to 4 % below the new mesh
  from the start after the first change, 2 % after the second: nodes that are in contact on the new mesh only, at the rim, have no
  friction of their own yet. It comes with the load that follows: at the end Q is that of the mesh from the start to 0.3 % (early: to 0.001 %).
  With the cells it shrinks: 0.3, 0.1 and 0.02 % in the last steps of the local meshes.

![Errors](cattaneo_mindlin.png)
"""

if __name__ == "__main__":
    main()
