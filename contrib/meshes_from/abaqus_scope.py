"""What belongs to a deck, to a part or to an instance of it: nodes, elements, sets and surfaces by their own numbers."""

import re

import numpy as np

from .abaqus_data import check_once, element_table, node_table, place_of, solid_kind
from .abaqus_lines import split
from .mesh import Mesh, MeshError

NONE = np.zeros(0, int)


class Set:
    """A set of nodes or elements: entries are arrays of numbers, or (name, keyword, line) of another set."""

    def __init__(self, name, internal=False):
        self.name, self.internal, self.entries = name, internal, []


class Surface:
    """Entries are (text, face or None, keyword, line)."""

    def __init__(self, name, of_nodes):
        self.name, self.of_nodes, self.entries = name, of_nodes, []


class Scope:
    """`base` is the part that an instance is of; `instances` are those of an assembly: name -> (number, scope)."""

    def __init__(self, name, base=None):
        self.name, self.base, self.instances, self.skipped = name, base, {}, {}
        self.nodes, self.elements, self.skins = [], [], []  # tuples that end with (keyword, data lines)
        self.sets = {"NSET": {}, "ELSET": {}}
        self.surfaces = {}

    # reading

    def add_nodes(self, keyword):
        """*NODE"""
        labels, positions = node_table(keyword)
        self.nodes.append((labels, positions, keyword, np.arange(len(labels))))
        if keyword.get("NSET"):
            self._set("NSET", keyword.get("NSET")).entries.append(labels)

    def add_elements(self, keyword):
        """*ELEMENT"""
        kind = solid_kind(keyword)
        elset = keyword.get("ELSET")
        if kind is None:
            name = f"*ELEMENT, TYPE={keyword.get('TYPE').upper()}"
            self.skipped[name] = self.skipped.get(name, 0) + 1
            labels = np.array([int(line.split(",")[0]) for line in keyword.lines if re.match(r"\d+\s*,", line)], int)
        elif isinstance(kind, int):
            labels, nodes, _ = element_table(keyword, kind)
            self.skins.append((labels, nodes[:, :3 if kind in (3, 6) else 4]))
        else:
            n_nodes = int(kind[3:])
            labels, nodes, lines = element_table(keyword, n_nodes)
            if kind == "C3D27":  # the centre is the 21st node
                nodes = nodes[:, list(range(20)) + list(range(21, 27)) + [20]]
            self.elements.append((kind, labels, nodes, keyword, lines))
        if elset:
            self._set("ELSET", elset).entries.append(labels)

    def add_set(self, keyword):
        """*NSET or *ELSET"""
        chosen = self._set(keyword.name, keyword.need(keyword.name), "INTERNAL" in keyword.parameters)
        prefix = keyword.get("INSTANCE")
        if keyword.name == "NSET" and keyword.get("ELSET"):
            chosen.entries.append(("nodes of", keyword.get("ELSET"), keyword, None))
        for i, line in enumerate(keyword.lines):
            entries = [entry for entry in split(line) if entry]
            if "GENERATE" in keyword.parameters:
                chosen.entries.append(self._generate(keyword, i, entries, prefix))
                continue
            numbers = [int(entry) for entry in entries if entry.isdigit()]
            if numbers:
                chosen.entries.append(np.array(numbers, int) + self._offset(prefix, keyword, i))
            chosen.entries += [((prefix + "." if prefix else "") + entry, keyword, i) for entry in entries
                               if not entry.isdigit()]

    def _generate(self, keyword, i, entries, prefix):
        try:
            first, last, step = [int(entry) for entry in entries] + [1] * (3 - len(entries))
            return np.arange(first, last + 1, step) + self._offset(prefix, keyword, i)
        except ValueError:
            raise MeshError(f"{keyword.where(i)}: '{keyword.lines[i]}' is no range: first, last, step") from None

    def add_surface(self, keyword):
        """*SURFACE; whether it is one that is read."""
        of_nodes = keyword.get("TYPE", "ELEMENT").upper() == "NODE"
        if not of_nodes and keyword.get("TYPE", "ELEMENT").upper() != "ELEMENT" or "COMBINE" in keyword.parameters:
            return False
        name = keyword.need("NAME")
        surface = self.surfaces.setdefault(name.upper(), Surface(name, of_nodes))
        for i, line in enumerate(keyword.lines):
            entries = split(line)
            face = entries[1].upper() if len(entries) > 1 and entries[1] and not of_nodes else None
            surface.entries.append((entries[0], face, keyword, i))
        return True

    def _set(self, kind, name, internal=False):
        return self.sets[kind].setdefault(name.upper(), Set(name, internal or name.startswith("_")))

    def _offset(self, instance, keyword, line):
        if not instance:
            return 0
        if instance.upper() not in self.instances:
            raise MeshError(f"{keyword.where(line)}: there is no instance {instance}")
        return self.instances[instance.upper()][0] * Mesh.INSTANCE

    # looking up

    def labels(self, kind, name, keyword, line, trail=()):
        """Numbers of a set; those of instances with their offset. @raises MeshError where there is no such set."""
        key = name.upper()
        if key in trail:
            raise MeshError(f"{keyword.where(line)}: set {name} contains itself")
        found = self.sets[kind].get(key)
        parts = []
        if self.base and key in self.base.sets[kind]:
            parts.append(self.base.labels(kind, name, keyword, line, trail))
        if found:
            parts += [self._entry(kind, entry, trail + (key,)) for entry in found.entries]
        elif not parts:
            instance, dot, rest = name.partition(".")
            if dot and instance.upper() in self.instances:
                number, scope = self.instances[instance.upper()]
                own = np.array([int(rest)]) if rest.isdigit() else scope.labels(kind, rest, keyword, line)
                return own + number * Mesh.INSTANCE
            raise MeshError(f"{keyword.where(line)}: there is no {'node' if kind == 'NSET' else 'element'} set {name}")
        return np.unique(np.concatenate(parts)) if parts else NONE

    def _entry(self, kind, entry, trail):
        if isinstance(entry, np.ndarray):
            return entry
        if entry[0] == "nodes of":
            elements = self.labels("ELSET", entry[1], entry[2], entry[3])
            return np.concatenate([NONE] + [nodes[np.isin(labels, elements)].reshape(-1)
                                            for _, labels, nodes, _, _ in self.all("elements")])
        name, keyword, line = entry
        return self.labels(kind, name, keyword, line, trail)

    def all(self, what):
        """Of an instance, what its part has comes first."""
        return (getattr(self.base, what) if self.base else []) + getattr(self, what)

    def every(self, kind):
        """{key: set} of sets of this scope and of its part"""
        return {**(self.base.sets[kind] if self.base else {}), **self.sets[kind]}

    def check(self):
        """Numbers are unique, and elements have nodes that are there."""
        nodes, elements = self.all("nodes"), self.all("elements")
        labels = np.concatenate([NONE] + [entry[0] for entry in nodes])
        check_once("node", labels, [entry[-2:] for entry in nodes])
        check_once("element", np.concatenate([NONE] + [entry[1] for entry in elements]), [entry[-2:] for entry in elements])
        for _, own, of_element, keyword, lines in elements:
            unknown = np.argwhere(~np.isin(of_element, labels))
            if len(unknown):
                i, j = unknown[0]
                more = f" ({len(np.unique(unknown[:, 0]))} elements like this)" if len(unknown) > 1 else ""
                raise MeshError(f"{place_of([(keyword, lines)], i)}: element {own[i]} has node {of_element[i, j]}, which is "
                                f"not there{more}")
