"""Figures of results, by matplotlib. Each is made without pyplot: it has no window, needs no display, and notebooks show it.

Functions take `axes` (of a figure of the user's) to draw in, or make a figure; both ways they return the figure."""

import io

import matplotlib
import matplotlib.cm
import matplotlib.patches
import numpy as np
from matplotlib.figure import Figure

from .errors import ResultsError
from .formulas import evaluate
from .tables import nearest
from .views import contact_view, contact_zone, coordinates, show_statuses, window_around

STATUSES = (("open", "#c9ced6"), ("slip", "#f0a030"), ("stick", "#2f6db3"))
COLOURS = ("#2f6db3", "#c8452d", "#4f8f4f", "#8a5aa8", "#b08a20", "#555555")
_TITLES = {"CPRESS": "contact pressure", "shear": "shear traction"}


class Picture(Figure):
    """A figure that notebooks show, whatever matplotlib has been told about them."""

    def _repr_png_(self):
        with io.BytesIO() as buffer:
            self.savefig(buffer, format="png")
            return buffer.getvalue()


def _new(axes, width, height):
    """The figure and the axes to draw in."""
    if axes is not None:
        return axes.figure, axes
    figure = Picture(figsize=(width, height), layout="constrained")
    return figure, figure.subplots()


def _finish(axes):
    axes.grid(alpha=0.3)
    axes.spines[["top", "right"]].set_visible(False)
    axes.legend(frameon=False)


def axis_name(variable):
    return {"r": "distance from the z axis", "angle": "angle about the z axis (degrees)"}.get(variable, variable)


def shear(surface):
    """Length of the friction traction (n,)."""
    return np.linalg.norm(surface.fields["friction_traction"], axis=1)


def _condition(where, known):
    """Where a condition holds: a formula such as "abs(y) < 0.01", or a function of a dictionary of x, y, z, r, angle."""
    return np.asarray(evaluate(where, known) if isinstance(where, str) else where(known), bool)


def _draw_curves(axes, curves, line):
    """curves: label -> function of an array, or (x, y), or (x, y, format of matplotlib)."""
    for (label, curve), style in zip((curves or {}).items(), ("k-", "k--", "k-.", "k:") * len(curves or ())):
        if callable(curve):
            curve = (line, curve(line) * np.ones_like(line))
        axes.plot(*(curve if len(curve) == 3 else (*curve, style)), lw=1.2, label=label)


def profile(results, fields=None, over="x", t=None, *, where=None, reference_positions=False, curves=None, axes=None):
    """Fields of the slave surface at its nodes, near where it is in contact.

    fields: names, or "shear" (length of the friction traction); None: CPRESS, and shear with friction. over: x, y, z, r
    (distance from the z axis) or angle (about it, degrees). where: nodes to take, "abs(y) < 0.01". curves: see
    _draw_curves(), functions of `over`. @throws ResultsError"""
    surface = results.surface(t)
    known = coordinates(surface.reference if reference_positions else surface.points)
    chosen = np.ones(len(surface.points), bool) if where is None else _condition(where, known)
    if not chosen.any():
        raise ResultsError(f'no node of the contact surface satisfies "{where}"')
    # the contact, and a little more
    zone = np.zeros(len(chosen), bool)
    zone[contact_zone(surface)[0]] = True
    abscissa = known[over]
    near = abscissa[zone & chosen] if (zone & chosen).any() else abscissa[chosen]
    margin = 0.15 * np.ptp(near)
    low, high = (0 if over == "r" else near.min() - margin), near.max() + margin
    chosen = chosen & (abscissa >= low) & (abscissa <= high)
    chosen = np.flatnonzero(chosen)[np.argsort(abscissa[chosen], kind="stable")]

    if fields is None:
        fields = ["CPRESS"] + ["shear"] * bool(shear(surface).max() > 1e-6 * surface.fields["CPRESS"].max())
    fields = [fields] if isinstance(fields, str) else list(fields)
    figure, axes = _new(axes, 6.4, 4.4)
    for field, colour in zip(fields, COLOURS):
        values = (shear(surface) if field == "shear" else surface.field(field))[chosen]
        axes.plot(abscissa[chosen], values, "o", ms=3.5, mfc="none", color=colour, zorder=3,
                  label=f"{_TITLES.get(field, field)}, nodes")
    _draw_curves(axes, curves, np.linspace(low, high, 600))
    axes.set_xlim(low, high)
    axes.set_xlabel(axis_name(over))
    axes.set_ylabel("traction" if len(fields) > 1 else _TITLES.get(fields[0], fields[0]))
    _finish(axes)
    return figure


# What has a force: the table and its column of names, how its columns begin, and what the force is.
_FORCES = (("reactions.csv", "condition", "force", "reaction force on the bodies"),
           ("rigid_bodies.csv", "body", "force", "force on the rigid body"),
           ("contact.csv", "pair", "slave force", "force on the slave body"))


def _forces(results, names, over, at):
    """(name, rows, how columns begin, what it is): of the named conditions, rigid bodies and pairs, or of all conditions or,
    without any, rigid bodies or pairs. A rigid body may be in the reactions, too, with what holds it."""
    kinds = _FORCES if over == "time" or at is not None else _FORCES[1:2]  # what has a displacement of its own
    found, there = {}, []
    for file, column, begin, meaning in kinds:
        try:
            table = results.table(file)
        except ResultsError:
            continue
        for name in dict.fromkeys(table[column]):
            there.append(name)
            if name not in found and (names is None or name in names):
                found[name] = (name, table.where(**{column: name}), begin, meaning)
        if names is None and found:
            break
    for name in names or ():
        if name not in found:
            whose = "condition, rigid body or pair" if len(kinds) > 1 else "rigid body with free components"
            known = ", ".join(f'"{other}"' for other in there) or "none"
            if len(kinds) == 1:
                known += "; for others, over the displacement of which node? at=(x, y, z), a reference position"
            raise ResultsError(f'no {whose} is called "{name}"; there are {known}')
    if not found:
        raise ResultsError(f"there is no table of such forces in {results.folder}")
    return list(found.values())


def _path(results, rows, over, at):
    """Times (n,) at which the abscissa of force() is known, from 0 on, and the abscissa (n,)."""
    times = np.concatenate([[0.0], rows["time"]])
    if over == "time":
        return times, times
    if at is None:
        return times, np.concatenate([[0.0], rows[f"translation {over}"]])
    known = {0.0: 0.0}
    for t in results.series("bodies"):
        known[t] = results.at_node("bodies", f"displacement {over}", t, **dict(zip("xyz", at)))
    # fields may be written less often than forces
    keep = np.array([any(abs(t - k) < 1e-9 * max(1, t) for k in known) for t in times])
    return times[keep], np.array([known[min(known, key=lambda k: abs(k - t))] for t in times[keep]])


def force(results, names=None, components=None, *, over="time", at=None, curves=None, axes=None):
    """Forces of displacement conditions, rigid bodies or contact pairs (on the slave) over time or a displacement.

    names: None: of all conditions or, without any, rigid bodies or pairs. components: "x", "xz"; None: those that are not
    small. over: "time", or a direction x, y, z: the translation of rigid bodies, for others the displacement of the node at
    the reference position `at`. curves: see _draw_curves(), functions of `over`. @throws ResultsError"""
    found = _forces(results, [names] if isinstance(names, str) else names, over, at)
    largest = max(abs(rows[f"{begin} {c}"]).max() for _, rows, begin, _ in found for c in "xyz")
    figure, axes = _new(axes, 6.4, 4.4)
    drawn, reach = 0, []
    for name, rows, begin, _ in found:
        times, abscissa = _path(results, rows, over, at)
        reach += [abscissa.min(), abscissa.max()]
        own = np.concatenate([[0.0], rows["time"]])
        for component in components or "xyz":
            values = np.concatenate([[0.0], rows[f"{begin} {component}"]])
            if not components and abs(values).max() < 1e-3 * largest:
                continue  # round-off and side effects
            axes.plot(abscissa, values[np.isin(own, times)], "o-", ms=3, lw=1.3, color=COLOURS[drawn % len(COLOURS)],
                      label=f"{name}, force {component}")
            drawn += 1
    _draw_curves(axes, curves, np.linspace(min(reach), max(reach), 600))
    axes.axhline(0, color="0.6", lw=0.8, zorder=0)
    of_node = f" of the node at ({', '.join(f'{x:g}' for x in at)})" if at is not None else ""
    axes.set_xlabel("time" if over == "time" else f"displacement {over}{of_node}")
    meanings = list(dict.fromkeys(meaning for *_, meaning in found))
    axes.set_ylabel(meanings[0] if len(meanings) == 1 else "force")
    _finish(axes)
    return figure


def status(results, times=None, *, whole=False):
    """Open, slip and stick on the slave surface at some times, by default the last one; whole: not only around the contact."""
    times = [nearest(results.series("contact"), t) for t in (times if np.iterable(times) else [times])]
    surfaces = [results.surface(t) for t in times]
    zones = [contact_zone(surface) for surface in surfaces]
    surface, (zone, faces) = surfaces[-1], zones[-1]
    if whole:
        zone, faces = np.arange(len(surface.points)), surface.cells
    axes = contact_view(surface, zone, faces)
    window = window_around(surface.points[np.unique(faces)] @ axes.T, 0.03, narrowest=0.1)
    for other in surfaces:  # one window for all times
        box = window_around(other.points[np.unique(faces)] @ axes.T, 0.03, narrowest=0.1)
        window = tuple(choose(a, b) for choose, a, b in zip((min, max, min, max), window, box))
    aspect = (window[3] - window[2]) / (window[1] - window[0])
    columns = 1 if aspect < 0.6 else min(2, len(times))
    rows = -(-len(times) // columns)
    height = rows * (6.0 / columns * aspect + 0.55) + 0.6
    figure = Picture(figsize=(6.4, height), layout="constrained")
    axis = figure.subplots(rows, columns, squeeze=False, sharex=True, sharey=True)
    figure.get_layout_engine().set(rect=(0, 0.35 / height, 1, 1 - 0.35 / height))  # room for the legend
    for unused in axis.ravel()[len(times):]:
        unused.set_axis_off()
    for one, surface, t in zip(axis.ravel(), surfaces, times):
        show_statuses(one, surface, faces, axes, window, [colour for _, colour in STATUSES])
        # each rank has its own copy of a node
        nodes = np.unique(surface.points, axis=0, return_index=True)[1]
        count = np.bincount(surface.fields["CSTATUS"][nodes].round().astype(int), minlength=3)
        one.set_title(f"t = {t:g}: " + ", ".join(f"{n} {name}" for n, (name, _) in zip(count, STATUSES) if n > 0),
                      fontsize="medium", loc="left")
        one.label_outer()
    patches = [matplotlib.patches.Patch(color=colour, label=name) for name, colour in STATUSES]
    figure.legend(handles=patches, loc="lower center", ncols=3, frameon=False)
    return figure


def convergence(results, *, axes=None):
    """Residuals of every Newton iteration."""
    table = results.convergence
    steps = np.arange(len(table))
    figure, axes = _new(axes, 7.2, 4.2)
    starts = np.flatnonzero(np.diff(table["increment"], prepend=0))
    many = len(starts) > 12
    for start, end in zip(starts, [*starts[1:], len(table)]):
        for name, colour in (("force residual", COLOURS[0]), ("contact residual", COLOURS[1])):
            values = np.maximum(table[name][start:end], 1e-17)  # zero is drawn at round-off
            axes.semilogy(steps[start:end], values, "-" if many else "o-", ms=3, lw=1.1, color=colour,
                          label=name if start == 0 else None)
        if start > 0:
            axes.axvline(start - 0.5, color="0.75", lw=0.7, zorder=0)
    changed = table["statuses changed"] > 0
    if changed.any():
        axes.semilogy(steps[changed], np.maximum(table["contact residual"][changed], 1e-17), "s", ms=7, mfc="none",
                      color="0.3", label="statuses changed")
    again = np.flatnonzero((np.diff(table["attempt"], prepend=1) > 0) & (np.diff(table["increment"], prepend=1) == 0))
    for k, position in enumerate(again):
        axes.axvline(position - 0.5, color=COLOURS[1], ls=":", lw=1, label="started again with loops" if k == 0 else None)
    place = 0.5 * (starts + np.array([*starts[1:], len(table)]) - 1)
    stride = -(-len(starts) // 12)
    axes.set_xticks(place[::stride], [f"{int(i)}" for i in table["increment"][starts][::stride]])
    axes.tick_params(axis="x", length=0)
    axes.set_xlabel(f"increment ({len(table) - len(starts)} Newton iterations in all)")
    axes.set_ylabel("relative residual")
    _finish(axes)
    return figure


def energy(results, *, axes=None):
    """Energies since the start over time, and their imbalance."""
    table = results.energy
    names = [name for name in table.names if name not in ("increment", "time", "imbalance")]
    largest = max(abs(table[name]).max() for name in names)
    figure, axes = _new(axes, 6.4, 4.4)
    for name, colour in zip(names, COLOURS):
        if abs(table[name]).max() > 1e-9 * largest:  # others do not take part
            axes.plot([0.0, *table["time"]], [0.0, *table[name]], "o-", ms=3, lw=1.3, color=colour, label=name)
    axes.plot(table["time"], table["imbalance"], "k--", lw=1, label=f"imbalance, at most {abs(table['imbalance']).max():.2g}")
    axes.set_xlabel("time")
    axes.set_ylabel("energy")
    _finish(axes)
    return figure


def overview(results, t=None, *, title=None, view=None, cut=None, profile=None):
    """The deformed bodies, the contact pressure and a profile of it, in one picture: see nodus.overview."""
    from .overview import picture

    return picture(results, t, title, view, cut, profile)
