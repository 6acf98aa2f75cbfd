#!/usr/bin/python3
"""Runs from Python and what they write, against closed forms: tables, fields of all ranks and degrees, figures, failures."""

import glob
import importlib.util
import os
import subprocess
import sys
import warnings
from xml.etree import ElementTree

import numpy as np
from PIL import Image

from harness import NODUS, SOURCE, below, check, nodus, refused, run

PROGRAM = nodus.Program(NODUS)
PNG = b"\x89PNG"


def patch(degree):
    """prm/patch.prm with the default scheme, which passes: pressure 25, u_z = -0.025 (1 - ... ) linear over the height."""
    case = nodus.Case.read(os.path.join(SOURCE, "prm", "patch.prm"), program=PROGRAM)
    case["Title"], case["Discretization/Degree"] = "patch", degree
    del case["Contact pair 1/Scheme"], case["Contact pair 1/Surface"], case["Contact pair 1/Normal"], case["Geometry loop"]
    case["Load stepping/Increments"] = 2
    return case


def straight(mesh):
    """Largest distance of the points of the cells from where those of boxes are between their corners."""
    x, n = mesh.reference[mesh.cells], mesh.cells.shape[1]
    s = np.linspace(0, 1, n)
    weights = np.stack([1 - s, s])
    corners = x[:, ::n - 1, ::n - 1, ::n - 1] if mesh.cells.ndim == 4 else x[:, ::n - 1, ::n - 1]
    form = "ak,bj,ci,nabcd->nkjid" if mesh.cells.ndim == 4 else "bj,ci,nbcd->njid"
    return np.abs(np.einsum(form, *[weights] * (mesh.cells.ndim - 1), corners) - x).max()


def volume(mesh):
    """Of the deformed cells, by Gauss points."""
    n = mesh.cells.shape[1]
    x, w = np.polynomial.legendre.leggauss(n + 1)
    powers = np.linalg.inv(np.vander(np.linspace(-1, 1, n), increasing=True))
    value = np.vander(x, n, increasing=True) @ powers
    slope = np.stack([k * x ** max(k - 1, 0) for k in range(n)], 1) @ powers
    jacobian = np.stack([np.einsum("pk,qj,ri,nkjid->npqrd", *(slope if axis == d else value for axis in range(3)),
                                   mesh.points[mesh.cells]) for d in (2, 1, 0)], axis=-1)  # fmt: skip
    return np.einsum("npqr,p,q,r->", np.linalg.det(jacobian), w, w, w)


def test_patch():
    """Every file of one to three ranks, of both degrees."""
    for degree, ranks in ((1, 1), (1, 3), (2, 2)):
        name = f"Q{degree}, {ranks} ranks"
        results = patch(degree).run(f"results/{degree}_{ranks}", ranks)
        check(f"{name}, exit code", results.code, 0)
        last = results.contact[-1]
        check(f"{name}, slave force z", last["slave force z"], 25., 1e-9)
        half = results.contact.value("maximum pressure", 0.5, pair="interface")
        check(f"{name}, largest pressure at t = 0.5", half, 12.5, 1e-9)
        check(f"{name}, support", results.reactions.value("force z", condition="support"), 25., 1e-9)
        check(f"{name}, work", results.energy["external work"][-1], 0.3125, 1e-9)
        check(f"{name}, increments", results.contact["increment"].tolist(), [1., 2.])
        bodies, surface = results.bodies(), results.surface()
        below(f"{name}, pressures", np.abs(surface.field("CPRESS") / 25 - 1).max(), 1e-6)
        exact = -25 / 2000 * bodies.reference[:, 2]
        below(f"{name}, displacements z", np.abs(bodies.field("displacement z") - exact).max() / 0.025, 1e-6)
        below(f"{name}, cauchy_stress zz", np.abs(bodies.field("cauchy_stress zz") / -25 - 1).max(), 1e-6)
        check(f"{name}, at a node", results.at_node("bodies", "displacement z", x=1, y=1, z=2), -0.025, 1e-6)
        nodes = [np.prod([degree * n + 1 for n in cells]) for cells in ((3, 3, 2), (2, 2, 2))]
        check(f"{name}, nodes", len(bodies.nodes()), int(sum(nodes)))
        check(f"{name}, volume", volume(nodus.Mesh(bodies.reference, {}, bodies.cells)), 2., 1e-6)
        below(f"{name}, order of the points in cells", max(straight(bodies), straight(surface)), 1e-6)
        check(f"{name}, pieces", len(glob.glob(f"results/{degree}_{ranks}/bodies_0002*.vtu")), ranks)
        check(f"{name}, times", results.times, [0., 0.5, 1.])


def test_round():
    """A cylinder of curved cells in homogeneous strain: volume, stresses of linear elasticity."""
    case = nodus.Case("rod", program=PROGRAM)
    case["Discretization/Degree"] = 2
    case["Body 1"] = {"Generator": "cylinder", "Generator arguments": [1, 1], "Global refinement": 1,
                      "Material": {"Law": "linear elastic", "Young's modulus": 1000, "Poisson's ratio": 0.25}}  # fmt: skip
    strain = np.array([0.02, -0.01, 0.005])
    case["Boundary condition 1"] = {"Boundary ids": [0, 1, 2], "Components": ["x", "y", "z"],
                                    "Value": [f"{e}*{x}" for e, x in zip(strain, "xyz")]}  # fmt: skip
    bodies = case.run("results/rod").bodies()
    reference = nodus.Mesh(bodies.reference, {}, bodies.cells)
    check("rod, volume", volume(reference), 2 * np.pi, 1e-3)
    check("rod, change of the volume", volume(bodies) / volume(reference), float(np.prod(1 + strain)), 1e-6)
    stress = 1000 / 1.25 * strain + 1000 * 0.25 / (1.25 * 0.5) * strain.sum()
    for axis, exact in zip("xyz", stress):
        below(f"rod, cauchy_stress {axis}{axis}", np.abs(bodies.field(f"cauchy_stress {axis}{axis}") / exact - 1).max(), 1e-4)
    below("rod, cauchy_stress xy", np.abs(bodies.field("cauchy_stress xy")).max() / 1000, 1e-6)


def test_what_is_not_there():
    results = patch(1).run("results/patch")
    refused('contact.csv has no pair "face"; it has "interface"', results.contact.where, pair="face", kind=nodus.ResultsError)
    refused('contact.csv has no column "force z"; it has slave force z, master force z', lambda: results.contact["force z"], kind=nodus.ResultsError)
    refused("there is no time 0.3; the nearest is 0.5", results.surface, 0.3, kind=nodus.ResultsError)
    refused("there is no results/patch/rigid_bodies.csv", lambda: results.rigid_bodies, kind=nodus.ResultsError)
    refused("run with profile=True", lambda: results.profile, kind=nodus.ResultsError)
    refused('there is no field "pressure"; there are', results.surface().field, "pressure", kind=nodus.ResultsError)
    refused('"displacement" has components', results.surface().field, "displacement", kind=nodus.ResultsError)
    refused('"displacement" has no component "xx"', results.surface().field, "displacement xx", kind=nodus.ResultsError)
    refused("the run has not failed", results.failed_state, kind=nodus.ResultsError)
    for name, damage, expected in (
            ("energy.csv", lambda data: data[:-20], "energy.csv ends in the middle of a line"),
            ("energy.csv", lambda data: data[:-20] + b"\n", "energy.csv:3: "),
            ("energy.csv", lambda data: data.split(b"\n")[0] + b"\n", "no rows"),
            ("energy.csv", lambda data: data.replace(b"0.5", b"half"), "column 'time' has an entry that is no number"),
            ("bodies_0002.vtu", lambda data: data[: len(data) // 2], "bodies_0002.vtu is damaged"),
            ("bodies.pvd", lambda data: data[:-30], "bodies.pvd is damaged")):
        path = os.path.join(results.folder, name)
        with open(path, "rb") as file:
            data = file.read()
        with open(path, "wb") as file:
            file.write(damage(data))
        again = nodus.Results(results.folder)
        refused(expected, lambda again=again: (again.energy, again.bodies()), kind=nodus.ResultsError)
        with open(path, "wb") as file:
            file.write(data)
    if importlib.util.find_spec("pandas"):
        check("pandas, rows and columns", results.contact.frame().shape, (2, len(results.contact.names)))
        check("pandas, fields", results.bodies().frame()["cauchy_stress zz"].mean(), -25., 1e-6)
    else:
        refused("frame() needs pandas: pip install pandas", results.contact.frame, kind=ImportError)


def test_figures():
    """What is drawn is what is in the files; no figure of pyplot, no other state that is left behind."""
    before = dict(os.environ)
    results = patch(1).run("results/patch", profile=True)
    figure = results.plot_force(["support"], "z", over="z", at=(1, 1, 2), curves={"exact": lambda d: -1000 * d})
    drawn = {line.get_label(): line.get_xydata() for line in figure.axes[0].lines}
    below("force over displacement", np.abs(drawn["support, force z"] - [[0, 0], [-0.0125, 12.5], [-0.025, 25]]).max(), 1e-6)
    below("curve", np.abs(drawn["exact"][:, 1] + 1000 * drawn["exact"][:, 0]).max(), 1e-12)
    figure = results.plot_profile(over="y", where="abs(x) < 0.01")
    drawn = {line.get_label(): line.get_xydata() for line in figure.axes[0].lines}
    check("nodes of the profile", len(np.unique(drawn["contact pressure, nodes"][:, 0].round(3))), 3)
    below("pressure over the contact", np.abs(drawn["contact pressure, nodes"][:, 1] - 25).max() / 25, 1e-6)
    refused('no node of the contact surface satisfies "x > 5"', results.plot_profile, where="x > 5", kind=nodus.ResultsError)
    refused('no condition, rigid body or pair is called "lid"; there are', results.plot_force, "lid",
            kind=nodus.ResultsError)
    refused("over the displacement of which node?", results.plot_force, "support", over="z", kind=nodus.ResultsError)
    others = [results.plot(), results.plot_force(), results.plot_status(), results.plot_convergence(), results.plot_energy()]
    check("pictures of notebooks", [one._repr_png_()[:4] == PNG for one in others + [figure]], [True] * 6)
    shown = (results, results.contact, results.surface(), patch(1), PROGRAM.reference, PROGRAM.reference.find("scheme"))
    check("tables of notebooks", [ElementTree.fromstring(f"<p>{one._repr_html_()}</p>").tag for one in shown], ["p"] * 6)
    check("phases of the profile", len(results.profile["phases"]) > 5, True)
    check("pyplot is loaded", "matplotlib.pyplot" in sys.modules, False)
    check("environment", dict(os.environ) == before, True)
    plot = os.path.join(SOURCE, "contrib", "plot")
    for command in (["figure", "all", results.folder], ["plot", results.folder, "--profile", "CPRESS over x = 25 + 0*x (exact)"],
                    ["figure", "force", results.folder, "--condition", "interface", "--output", "pair.png"]):  # fmt: skip
        done = subprocess.run([os.path.join(plot, command[0]), *command[1:]], stdout=subprocess.PIPE, text=True, check=False)
        files = done.stdout.split()
        pictures = [open(file, "rb").read(4) == PNG for file in files]  # noqa: SIM115
        check(" ".join(command[:2]), (done.returncode, [os.path.basename(file) for file in files], all(pictures)),
              (0, [f"{kind}.png" for kind in {"all": ("profile", "force", "status", "convergence", "energy"), "force": ("pair",)}
                   .get(command[1], ("picture",))], True))  # fmt: skip


def test_animation():
    """A picture for each time, the last of which stands for a second; Pillow joins pictures that are the same."""
    results = patch(1).run("results/patch")
    results.animate("films.gif", field="displacement z", frames_per_second=4)
    with Image.open("films.gif") as film:
        pictures, lasts = [], []
        for frame in range(film.n_frames):
            film.seek(frame)
            pictures.append(np.asarray(film.convert("RGB"), float))
            lasts.append(film.info["duration"])
    check("film, milliseconds", sum(lasts), (2 + 4) * 250)
    check("film, pictures that differ from the one before", [np.abs(b - a).max() > 50 for a, b in zip(pictures, pictures[1:])], [True] * 2)
    refused("an animation is a .gif or a .mp4", results.animate, "film.avi", kind=nodus.ResultsError)
    refused('there is no field "pressure"', results.animate, "film.gif", field="pressure", kind=nodus.ResultsError)
    refused('no cell is left by the cut "x > 5"', results.animate, "film.gif", cut="x > 5", kind=nodus.ResultsError)
    check("files of films", glob.glob("film*"), ["films.gif"])
    command = [os.path.join(SOURCE, "contrib", "plot", "animate"), results.folder, "--case", os.path.join(SOURCE, "prm", "patch.prm")]
    done = subprocess.run(command, stdout=subprocess.PIPE, text=True, check=False)
    check("contrib/plot/animate", (done.returncode, done.stdout), (0, "results/patch/animation.gif\n"))
    check("animation.gif", os.path.getsize("results/patch/animation.gif") > 10000, True)


def test_failures():
    """A run that is refused, one that has no solution, one that is killed."""
    parameters = os.path.join(SOURCE, "tests", "parameters")
    case = nodus.Case.read(os.path.join(parameters, "free_block.prm"), program=PROGRAM)
    error = refused("no solution: increment 1", case.run, "results/free", kind=nodus.RunError)
    check("exit code", error.code, 1)
    check("the diagnosis knows why", "is free" in error.diagnosis and "## " in error.diagnosis, True)
    check("its log", nodus.Results(error.folder).folder == "results/free" and error.log.count("Increment 1") > 0, True)
    with open("results/free/log", encoding="utf-8") as file:
        check("log in the results", file.read() == error.log, True)
    check("fields of the failed state", "residual_force" in nodus.Results("results/free").failed_state().fields, True)
    run_of = case.run("results/free", check=False)
    check("without exception", (run_of.code, run_of.converged, run_of.message == str(error)), (1, False, True))
    case["Contact pair 1/Slave boundary ids"] = 77
    refused("boundary id 77", case.run, "results/refused")
    refused("boundary id 77", case.check)
    check("results of what is refused", os.path.exists("results/refused"), False)
    del case["Contact pair 1/Slave boundary ids"]
    refused("where to? run(folder)", case.run)
    with open("killed", "w", encoding="utf-8") as file:
        file.write("#!/bin/sh\n[ \"$1\" = --version ] && echo build type Debug && exit 0\necho at work\nkill -9 $$\n")
    os.chmod("killed", 0o755)
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        refused("ended by SIGKILL after: at work", nodus.run, os.path.join(parameters, "free_block.prm"), program="./killed",
                kind=nodus.RunError)
    check("warned of", [str(one.message).split(" is built as ")[1] for one in caught],
          ["Debug, which is some ten times slower than Release"])


class Interrupting:
    """A terminal on which somebody presses Ctrl-C when a text appears."""

    def __init__(self, text):
        self.text = text

    def write(self, line):
        if self.text in line:
            raise KeyboardInterrupt

    def flush(self):
        pass


def test_interruption():
    """A run that is interrupted leaves a checkpoint, from which another one goes on to the same end."""
    case = nodus.Case.read(os.path.join(SOURCE, "tests", "parameters", "two_blocks.prm"), program=PROGRAM)
    case["Load stepping/Increments"] = [40, 60]
    case["Output/Checkpoint interval"] = 0  # only where a signal asks for one
    whole = case.run("results/whole")
    for ranks in (1, 2):
        terminal, sys.stdout = sys.stdout, Interrupting("Increment 4,")
        try:
            case.run("results/parts", ranks, echo=True)
            interrupted = False
        except KeyboardInterrupt:
            interrupted = True
        finally:
            sys.stdout = terminal
        check(f"{ranks} ranks, interrupted", interrupted, True)
        done = len(nodus.Results("results/parts").contact)
        check("some of the increments are done", 3 <= done < 100, True)
        parts = case.run("results/parts", restart=True)
        check("goes on", "Continues after increment" in parts.log, True)
        check("increments", len(parts.contact), 100)
        force = parts.contact["slave force z"] / whole.contact["slave force z"]
        below("forces", float(np.abs(force - 1).max()), 1e-9)


run(test_patch, test_round, test_what_is_not_there, test_figures, test_animation, test_failures, test_interruption)
