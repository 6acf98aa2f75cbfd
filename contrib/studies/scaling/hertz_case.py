#!/usr/bin/python3
"""The comparison case `hertz`: mesh, input of nodus, Hertz's solution, and how runs of it are measured.

A quarter of a paraboloid z = r^2 / (2 R) of an elastic block is pressed by its flat top onto an elastic block; n cells
along the edges of the upper one, 1.25 n of the lower one, graded towards the contact.

    hertz_case.py N FOLDER [FRICTION]    writes hertz_N.msh and hertz_N.prm
"""

import datetime
import json
import os
import subprocess
import sys
import time

import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.dirname(HERE))
import common  # noqa: E402

R, E, NU, INDENTATION, GRADE = 8.0, 1000.0, 0.3, 0.02, 4.0
E_STAR = E / (2 * (1 - NU**2))

# Corners of gmsh's, Abaqus' and Kratos' hexahedra in the grid (x, y, z), and their faces with outward normals.
CORNERS = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]
SIDES = {"x-": (0, 4, 7, 3), "x+": (1, 2, 6, 5), "y-": (0, 1, 5, 4), "y+": (3, 7, 6, 2), "z-": (0, 3, 2, 1),
         "z+": (4, 5, 6, 7)}  # fmt: skip

PRM = """set Title = hertz, n = {n}
{bodies}subsection Boundary condition 1
  set Name = symmetry x
  set Boundary ids = 10, 16
  set Components = x
  set Value = 0
end
subsection Boundary condition 2
  set Name = symmetry y
  set Boundary ids = 12, 18
  set Components = y
  set Value = 0
end
subsection Boundary condition 3
  set Name = bottom
  set Boundary ids = 20
  set Components = x, y, z
  set Value = 0
end
subsection Boundary condition 4
  set Name = top
  set Boundary ids = 15
  set Components = z
  set Value = -{indentation}*t
end
subsection Contact pair 1
  set Name = contact
  set Slave body = 1
  set Slave boundary ids = 14
  set Master body = 2
  set Master boundary ids = 21
  set Friction coefficient = {friction}
end
"""
BODY = """subsection Body {number}
  set Name = {name}
  set Mesh file = hertz_{n}.msh
  set Volume ids = {number}
  subsection Material
    set Law = linear elastic
    set Young's modulus = {E}
    set Poisson's ratio = {nu}
  end
end
"""


def lines(n):
    """Grid lines on [0, 1], finest at 0."""
    width = GRADE ** (np.arange(n) / max(n - 1, 1))
    return np.concatenate([[0.0], np.cumsum(width) / width.sum()])


def dofs(n):
    return 3 * ((n + 1) ** 3 + (round(1.25 * n) + 1) ** 3)


class Mesh:
    """nodes (n, 3); cells: body -> (n, 8); faces: (body, side) -> (numbers of the cells in all bodies, (n, 4) nodes)."""

    def __init__(self, n, layers=None):
        """layers: cells over the height of each body, if not as along the other edges."""
        upper, lower = lines(n), lines(round(1.25 * n))
        heights = [lines(layers)] * 2 if layers else [upper, lower]
        self.n, self.cells, self.faces, nodes, before, cells_before = n, {}, {}, [], 0, 0
        for body, (x, z) in enumerate([(upper, heights[0]), (lower, -heights[1][::-1])], 1):
            grid = np.stack(np.meshgrid(z, x, x, indexing="ij")[::-1], axis=-1)  # index z, y, x
            if body == 1:
                rise = (grid[..., 0] ** 2 + grid[..., 1] ** 2) / (2 * R)
                grid[..., 2] += (1 - grid[..., 2]) * rise
            number = before + np.arange(grid[..., 0].size).reshape(grid.shape[:3])
            m, m_z = len(x) - 1, len(z) - 1
            cells = np.stack([number[k : m_z + k, j : m + j, i : m + i] for i, j, k in CORNERS], axis=-1)
            for side, corners in SIDES.items():
                axis, layer = 2 - "xyz".index(side[0]), -1 if side[1] == "+" else 0
                numbers = np.arange(m_z * m * m).reshape(m_z, m, m).take(layer, axis).ravel()
                self.faces[body, side] = (cells_before + numbers, cells.reshape(-1, 8)[numbers][:, corners])
            self.cells[body] = cells.reshape(-1, 8)
            nodes.append(grid.reshape(-1, 3))
            before += number.size
            cells_before += m_z * m * m
        self.nodes = np.concatenate(nodes)
        self.slave, self.master = self.faces[1, "z-"], self.faces[2, "z+"]
        self.slave_nodes = np.unique(self.slave[1])

    def nodes_of(self, *sides):
        return np.unique(np.concatenate([self.faces[side][1].ravel() for side in sides]))

    def weights(self):
        """Area around each slave node: a quarter of each of its faces."""
        x = self.nodes[self.slave[1]]
        area = 0.5 * np.linalg.norm(np.cross(x[:, 2] - x[:, 0], x[:, 3] - x[:, 1]), axis=1)
        return np.bincount(self.slave[1].ravel(), np.repeat(area / 4, 4), len(self.nodes))[self.slave_nodes]

    def numbers_at(self, reference, upper):
        """Numbers of the nodes at reference positions; `upper`: whether each is in the upper body. From rounded
        positions, as VTU files have them."""
        result = np.empty(len(reference), int)
        start = 0
        for body, grid in ((1, lines(self.n)), (2, lines(round(1.25 * self.n)))):
            chosen = upper if body == 1 else ~upper
            x = reference[chosen].copy()
            if body == 1:
                rise = (x[:, 0] ** 2 + x[:, 1] ** 2) / (2 * R)
                x[:, 2] = (x[:, 2] - rise) / (1 - rise)
            middle = 0.5 * (grid[1:] + grid[:-1])
            i, j, k = (np.searchsorted(middle, np.abs(x[:, d])) for d in range(3))
            m = len(grid)
            if body == 2:
                k = m - 1 - k
            result[chosen] = start + (k * m + j) * m + i
            start += m**3
        return result

    def write(self, path):
        """gmsh 2.2; bodies 1 and 2, the sides of body 1 are the surfaces 10 ... 15, those of body 2 16 ... 21."""
        with open(path, "w") as file:
            file.write(f"$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n{len(self.nodes)}\n")
            file.writelines(f"{i} {x:.16g} {y:.16g} {z:.16g}\n" for i, (x, y, z) in enumerate(self.nodes.tolist(), 1))
            elements = [(3, 10 + t, nodes) for t, (_, faces) in enumerate(self.faces.values()) for nodes in faces + 1]
            elements += [(5, body, nodes) for body, cells in self.cells.items() for nodes in cells + 1]
            file.write(f"$EndNodes\n$Elements\n{len(elements)}\n")
            for number, (kind, tag, nodes) in enumerate(elements, 1):
                file.write(f"{number} {kind} 2 {tag} {tag} {' '.join(map(str, nodes.tolist()))}\n")
            file.write("$EndElements\n")


def write(n, folder, friction=0.0):
    """Writes mesh (unless it is there) and .prm; returns the path of the latter."""
    os.makedirs(folder, exist_ok=True)
    mesh = os.path.join(folder, f"hertz_{n}.msh")
    if not os.path.exists(mesh):
        Mesh(n).write(mesh + ".part")
        os.replace(mesh + ".part", mesh)
    bodies = "".join(BODY.format(number=b, name=name, n=n, E=E, nu=NU) for b, name in ((1, "upper"), (2, "lower")))
    prm = os.path.join(folder, f"hertz_{n}.prm")
    with open(prm, "w") as file:
        file.write(PRM.format(n=n, bodies=bodies, indentation=INDENTATION, friction=friction))
    return prm


def hertz(force):
    """Contact radius and largest pressure from the force on the quarter."""
    radius = (3 * 4 * force * R / (4 * E_STAR)) ** (1 / 3)
    return radius, 3 * 4 * force / (2 * np.pi * radius**2)


def profile_error(mesh, pressure, force):
    """Error of the pressures at the slave nodes over the contact circle, relative, in L2; largest pressure over
    Hertz's. The circle is that of the force that was computed with."""
    radius, largest = hertz(force)
    r, w = np.hypot(*mesh.nodes[mesh.slave_nodes, :2].T), mesh.weights()
    inside = r <= radius
    exact = largest * np.sqrt(1 - (r[inside] / radius) ** 2)
    pressure = np.asarray(pressure)
    error = np.sqrt(np.sum(w[inside] * (pressure[inside] - exact) ** 2) / np.sum(w[inside] * exact**2))
    return float(error), float(pressure.max() / largest)


def measured(command, log, folder=None, environment=None):
    """Runs a program. CPU seconds (user and system), peak resident MiB, and the largest anonymous part of it (heap and
    stacks, without program and libraries) seen in samples 10 ms apart."""
    with open(log, "w") as file:
        child = subprocess.Popen(command, stdout=file, stderr=subprocess.STDOUT, cwd=folder, env=environment)
    private = 0
    while True:
        pid, status, usage = os.wait4(child.pid, os.WNOHANG)
        if pid:
            break
        try:
            with open(f"/proc/{child.pid}/status") as file:
                private = max([private] + [int(line.split()[1]) for line in file if line.startswith("RssAnon")])
        except OSError:
            pass
        time.sleep(0.01)
    child.returncode = os.waitstatus_to_exitcode(status)
    return {
        "exit": child.returncode,
        "cpu": usage.ru_utime + usage.ru_stime,
        "peak MiB": usage.ru_maxrss / 1024,
        "private MiB": private / 1024,
    }


def nodus(n, name, solver="condensed", friction=0.0, ranks=1, sets=None, preload=None):
    """One run of nodus: what measured() returns, "profile" (profile.json), "contact" (row of contact.csv), "folder".
    preload: a library that nodus, not mpirun, is to load first."""
    folder = os.path.join(common.SCRATCH, "hertz", name)
    os.makedirs(folder, exist_ok=True)
    prm = write(n, os.path.dirname(folder))
    keys = {
        "Linear solver/Type": solver,
        "Contact pair 1/Friction coefficient": friction,
        "Output/Results folder": folder,
        "Output/VTU interval": 0,
        **(sets or {}),
    }
    command = [common.NODUS, prm, "--profile"] + [x for key in keys.items() for x in ("--set", "{}={}".format(*key))]
    variables = environment()
    if ranks > 1:
        loaded = ["-x", "LD_PRELOAD=" + preload, "-x", "MPI_COUNT"] if preload else []
        command = ["mpirun", *loaded, "-n", str(ranks)] + command
    elif preload:
        variables["LD_PRELOAD"] = preload
    variables["MPI_COUNT"] = os.path.join(folder, "mpi_count")
    for old in ("profile.json", "contact.csv"):
        if os.path.exists(os.path.join(folder, old)):
            os.remove(os.path.join(folder, old))
    result = measured(command, os.path.join(folder, "log"), environment=variables)
    result["folder"] = folder
    if result["exit"] == 0:
        found = common.nodus.Results(folder)
        result["profile"], result["contact"] = found.profile, found.contact[-1]
    print(f"  {name}: exit {result['exit']}, {result['cpu']:.1f} CPU s, {result['peak MiB']:.0f} MiB", flush=True)
    return result


def pressures(mesh, folder):
    """CPRESS at the slave nodes of a run of nodus."""
    surface = common.nodus.Results(folder).surface()
    numbers = mesh.numbers_at(surface.reference, np.ones(len(surface.points), bool))
    result = np.zeros(len(mesh.nodes))
    result[numbers] = surface.field("CPRESS")
    return result[mesh.slave_nodes]


def environment():
    """One thread each; more ranks than cores and a machine of one's own (root) are no error for Open MPI."""
    one = {name: "1" for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "CCX_NPROC_EQUATION_SOLVER",
                                  "CCX_NPROC_STIFFNESS", "CCX_NPROC_RESULTS")}  # fmt: skip
    mpi = {name: "1" for name in ("OMPI_ALLOW_RUN_AS_ROOT", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM",
                                  "OMPI_MCA_mpi_yield_when_idle", "OMPI_MCA_rmaps_base_oversubscribe")}  # fmt: skip
    return {**mpi, **os.environ, **one}


def machine():
    with open("/proc/cpuinfo") as file:
        names = [line.split(":")[1].strip() for line in file if line.startswith("model name")]
    return f"{names[0]}, {len(names)} cores"


def today():
    return datetime.date.today().isoformat()


def spaced(value):
    """Thousands apart."""
    return f"{value:,.0f}".replace(",", " ")


class Kept:
    """Results by key, kept in a .json file beside the study between its runs."""

    def __init__(self, name):
        self.path = os.path.join(HERE, name + ".json")
        self.values = {}
        if os.path.exists(self.path):
            with open(self.path) as file:
                self.values = json.load(file)

    def __setitem__(self, key, value):
        self.values[key] = {**value, "date": today()}
        with open(self.path, "w") as file:
            json.dump(self.values, file, indent=1, sort_keys=True)
            file.write("\n")

    def get(self, key):
        return self.values.get(key)

    def dates(self):
        found = sorted({value["date"] for value in self.values.values()})
        return " to ".join(dict.fromkeys([found[0], found[-1]])) if found else ""


if __name__ == "__main__":
    if len(sys.argv) not in (3, 4):
        sys.exit(__doc__)
    print(write(int(sys.argv[1]), sys.argv[2], *map(float, sys.argv[3:])))
