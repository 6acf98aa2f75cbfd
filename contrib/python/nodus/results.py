"""The results folder of a run: tables, fields and figures."""

import json
import os

from .errors import ResultsError
from .html import table
from .mesh import parse, read_mesh
from .tables import Table, nearest


def _method(name, meaning):
    """A function of nodus.figures as a method; matplotlib is loaded when it is called."""
    def method(self, *arguments, **options):
        from . import figures

        return getattr(figures, name)(self, *arguments, **options)

    method.__name__, method.__doc__ = name, f"{meaning}; arguments: nodus.figures.{name}()."
    return method


class Results:
    """What a run has written (contrib/doc/results.md). Files are read when they are asked for, once: of a run that goes on,
    make a new object. All errors are ResultsError: there is no such file, column, field or time."""

    def __init__(self, folder):
        self.folder = os.fspath(folder)
        self._meshes, self._tables = {}, {}

    def table(self, file):
        """A Table by the name of its file."""
        if file not in self._tables:
            self._tables[file] = Table.read(os.path.join(self.folder, file))
        return self._tables[file]

    @property
    def contact(self):
        """contact.csv: resultants, area, largest pressure, counts, and measures of the judge; one row per increment and pair."""
        return self.table("contact.csv")

    @property
    def masters(self):
        """masters.csv: force and moment of a pair on each of several master bodies; one row per increment, pair and body."""
        return self.table("masters.csv")

    @property
    def reactions(self):
        """reactions.csv: forces of the ground on the bodies; one row per increment and displacement condition."""
        return self.table("reactions.csv")

    @property
    def rigid_bodies(self):
        """rigid_bodies.csv: motion and loads; one row per increment and rigid body with free components."""
        return self.table("rigid_bodies.csv")

    @property
    def preload(self):
        """preload.csv: force and shortening of bolts; one row per increment and pair with a Preload."""
        return self.table("preload.csv")

    @property
    def energy(self):
        """energy.csv: energies since the start; one row per increment."""
        return self.table("energy.csv")

    @property
    def convergence(self):
        """convergence.csv: residuals; one row per Newton iteration, of increments that failed, too."""
        return self.table("convergence.csv")

    @property
    def points(self):
        """points.csv: displacement and stress; one row per increment and output point."""
        return self.table("points.csv")

    @property
    def lines(self):
        """lines.csv: the same along output lines, as often as there are fields."""
        return self.table("lines.csv")

    def series(self, name):
        """Times and files of "bodies" or "contact"."""
        path = os.path.join(self.folder, name + ".pvd")
        return {
            float(entry.get("timestep")): os.path.join(self.folder, entry.get("file")) for entry in parse(path).iter("DataSet")
        }

    @property
    def times(self):
        """Times at which there are fields."""
        return sorted(self.series("bodies"))

    def mesh(self, name, t=None):
        """The Mesh of "bodies" or "contact" at time t, by default the last one."""
        files = self.series(name)
        path = files[nearest(files, t)]
        if path not in self._meshes:
            self._meshes[path] = read_mesh(path)
        return self._meshes[path]

    def bodies(self, t=None):
        """Fields of the bodies: displacement, cauchy_stress, von_mises, body, ..."""
        return self.mesh("bodies", t)

    def surface(self, t=None):
        """Fields of all slave surfaces: CPRESS, COPEN, CSTATUS, friction_traction, normal, area, pair, ..."""
        return self.mesh("contact", t)

    def failed_state(self):
        """Fields of the last iterate of a run that has failed, on the bodies."""
        for ending in ("pvtu", "vtu"):
            path = os.path.join(self.folder, f"failed_state.{ending}")
            if os.path.exists(path):
                return read_mesh(path)
        raise ResultsError(f"there is no failed_state.vtu in {self.folder}: the run has not failed, or writes no fields")

    def at_node(self, mesh, field, t=None, **position):
        """Value of a field of "bodies" or "contact" at the node nearest to a reference position: at_node("contact", "CPRESS",
        x=0, y=0)."""
        mesh = self.mesh(mesh, t)
        return float(mesh.field(field)[mesh.nearest(**position)])

    @property
    def profile(self):
        """profile.json of a run with profile=True: {"phases": [{"name", "cpu_seconds", ...}], ...}"""
        path = os.path.join(self.folder, "profile.json")
        if not os.path.exists(path):
            raise ResultsError(f"there is no {path}: run with profile=True or --profile")
        with open(path, encoding="utf-8") as file:
            return json.load(file)

    plot = _method("overview", "Bodies, contact pressure and a profile in one picture")
    plot_profile = _method("profile", "Pressure and shear over the contact")
    plot_force = _method("force", "Forces over time or a displacement")
    plot_status = _method("status", "Open, slip and stick on the slave surface")
    plot_convergence = _method("convergence", "Residuals of every Newton iteration")
    plot_energy = _method("energy", "Energies over time")

    def animate(self, path, **options):
        """The deformed bodies over the time as a .gif or a .mp4; options: nodus.animation.animate()."""
        from .animation import animate

        animate(self, path, **options)

    def __repr__(self):
        return f"<results in {self.folder}>"

    def _repr_html_(self):
        rows = []
        for file in ("contact.csv", "masters.csv", "reactions.csv", "rigid_bodies.csv", "preload.csv", "points.csv", "lines.csv", "energy.csv", "convergence.csv"):
            if os.path.exists(os.path.join(self.folder, file)):
                there = self.table(file)
                rows.append([file, f"{len(there)} rows: {', '.join(there.names[:12])}" + ", ..." * (len(there.names) > 12)])
        for name in ("bodies", "contact"):
            if os.path.exists(os.path.join(self.folder, name + ".pvd")):
                times = sorted(self.series(name))
                rows.append([name + ".pvd", f"{len(times)} times" + (f", {times[0]:g} to {times[-1]:g}" if times else "")])
        return table([], rows, self.folder)
