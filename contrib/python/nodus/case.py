"""A case: the keys of a parameter file, checked as they are set."""

import json
import os
import re
import tempfile
from collections.abc import Mapping, MutableMapping

import numpy as np

from . import prm
from .errors import InputError
from .html import table
from .program import LIBRARIES, Program


def _kept(value):
    """What cannot be changed behind our back."""
    if isinstance(value, np.ndarray):
        value = value.tolist()
    return tuple(map(_kept, value)) if isinstance(value, (list, tuple)) else value


class Section(MutableMapping):
    """Keys and sections below a path. Names may be paths: section["Material/Law"]. Setting an unknown key, or a value that
    the key does not take, is an InputError and changes nothing; a section is set from a dictionary, which replaces it."""

    def __init__(self, case, path):
        self._case, self._path = case, path

    def _full(self, name):
        if not isinstance(name, str):
            raise InputError(f"{name!r} is no name of a key or section")
        full = f"{self._path}/{name}" if self._path else name
        self._case.reference.require(full)
        return full

    def _holder(self, full, create=False):
        """The dictionary that holds the last name of a path (None: there is none), and that name."""
        *sections, name = full.split("/")
        holder = self._case._tree
        for section in sections:
            if section not in holder and not create:
                return None, name
            holder = holder.setdefault(section, {})
        return holder, name

    def __getitem__(self, name):
        full = self._full(name)
        if self._case.reference.is_section(full):
            return Section(self._case, full)
        holder, last = self._holder(full)
        if not holder or last not in holder:
            raise KeyError(f"'{full}' is not set; the default is '{self._case.reference[full].default}'")
        return holder[last]

    def __setitem__(self, name, value):
        full = self._full(name)
        if self._case.reference.is_section(full):
            value = self._case._checked_section(full, value)
        else:
            self._case.reference.check(full, value)
            value = _kept(value)
        holder, last = self._holder(full, create=True)
        holder[last] = value
        if full == LIBRARIES:
            self._case._load()

    def __contains__(self, name):
        """Whether a key or anything in a section is set."""
        holder, last = self._holder(self._full(name))
        return bool(holder) and last in holder

    def __delitem__(self, name):
        full = self._full(name)
        holder, last = self._holder(full)
        if not holder or last not in holder:
            raise KeyError(f"'{full}' is not set")
        del holder[last]
        if full == LIBRARIES:
            self._case._load()

    def _names(self):
        holder, last = self._holder(self._path) if self._path else ({"": self._case._tree}, "")
        return (holder or {}).get(last, {})

    def __iter__(self):
        return iter(tuple(self._names()))

    def __len__(self):
        return len(self._names())

    def __repr__(self):
        return prm.to_text(self._case._texts(self._path)).rstrip() or "(nothing is set)"

    def _repr_html_(self):
        rows = []

        def collect(tree, path):
            for name, value in tree.items():
                full = f"{path}/{name}" if path else name
                if isinstance(value, dict):
                    collect(value, full)
                else:
                    rows.append([full, value, self._case.reference[full].unit])

        collect(self._case._texts(self._path), self._path)
        return table(["key", "value", "unit"], rows)


class Case(Section):
    """A case of nodus as nested keys, those of contrib/doc/parameters.md:

        case = Case("a block on a plane")
        case["Body 1"] = {"Generator": "hyper_cube", "Generator arguments": [0, 1, True]}
        case["Body 1/Material/Young's modulus"] = 1000

    Units are the user's, N, mm and MPa or any other that are consistent: nothing is converted. Files that a key names are
    relative to the working folder, those of a case that was read to its file. Laws and keys of plug-ins are known once
    `Additional shared libraries` is set."""

    def __init__(self, title=None, *, program=None):
        """program: path of nodus or a Program; without: see Program. @throws InputError where there is none"""
        super().__init__(self, "")
        self.program = program if isinstance(program, Program) else Program(program)
        self.reference = self.program.reference
        self._tree, self._folder = {}, os.getcwd()
        if title is not None:
            self["Title"] = title

    @classmethod
    def read(cls, path, *, program=None):
        """The case of a .prm or .json file. @throws InputError"""
        case = cls(program=program)
        case._folder = os.path.dirname(os.path.abspath(path))
        tree = prm.read(path)

        def values(tree, section):
            for name, value in tree.items():
                full = f"{section}/{name}" if section else name
                case.reference.require(full)
                yield name, (dict(values(value, full)) if isinstance(value, dict) else
                             case.reference[full].value(value) if isinstance(value, str) else value)

        try:
            if LIBRARIES in tree:  # first: other keys are theirs
                case[LIBRARIES] = tree.pop(LIBRARIES)
            case.update(values(tree, ""))
        except InputError as error:
            raise InputError(str(error) if str(error).startswith(str(path)) else f"{path}: {error}") from None
        return case

    def copy(self):
        """A case of its own with the same keys."""
        case = Case(program=self.program)
        case._folder, case.reference = self._folder, self.reference
        case.update(self._tree)
        return case

    def _load(self):
        """Knows the keys of the plug-ins that are set from here on."""
        names = self.reference[LIBRARIES].text(self._tree.get(LIBRARIES, ())).split(",")
        try:
            self.reference = self.program.reference_with([os.path.join(self._folder, n.strip()) for n in names if n.strip()])
        except InputError:
            del self._tree[LIBRARIES]
            raise

    def _checked_section(self, path, values):
        """The content of a section, all of it checked."""
        if not isinstance(values, Mapping):
            raise InputError(f"'{path}' is a section: give a dictionary of its keys")
        content = {}
        for name, value in values.items():
            if not isinstance(name, str):
                raise InputError(f"{name!r} is no name of a key or section")
            full = f"{path}/{name}"
            self.reference.require(full)
            if self.reference.is_section(full):
                value = self._checked_section(full, value)
            else:
                self.reference.check(full, value)
                value = _kept(value)
            *sections, last = name.split("/")
            holder = content
            for section in sections:
                holder = holder.setdefault(section, {})
            holder[last] = value
        return content

    def _texts(self, path="", folder=None):
        """Nested dictionaries of texts below a path; names of files as they are, or relative to a folder."""
        def texts(tree, section):
            found = {}
            for name, value in tree.items():
                full = f"{section}/{name}" if section else name
                if isinstance(value, dict):
                    found[name] = texts(value, full)
                    continue
                key = self.reference[full]
                found[name] = key.text(value)
                if folder is not None and found[name] and "file" in (key.kind["kind"], key.kind.get("of", {}).get("kind")):
                    files = found[name].split(key.kind["separator"]) if key.kind["kind"] == "list" else [found[name]]
                    found[name] = ", ".join(os.path.relpath(os.path.join(self._folder, file.strip()), folder) for file in files)
            return found

        tree = self._tree
        for name in path.split("/") if path else ():
            tree = tree.get(name, {})
        return texts(tree, path)

    def text(self, folder=None):
        """The .prm file that says this case, as it stands in a folder, by default the one that files are relative to.
        @throws InputError where numbers of bodies, conditions or pairs have gaps"""
        return prm.to_text(self._complete(self._folder if folder is None else folder))

    def _complete(self, folder):
        numbers = {}
        for name in self._tree:
            found = re.fullmatch(r"(.*) (\d+)", name)
            if found and self.reference.is_section(name):
                numbers.setdefault(found.group(1), []).append(int(found.group(2)))
        for name, present in numbers.items():
            for i, number in enumerate(sorted(present), 1):
                if number != i:
                    raise InputError(f"there is a '{name} {number}' but no '{name} {i}'; number them 1, 2, 3, ... without gaps")
        return self._texts(folder=os.path.abspath(folder))

    def write(self, path):
        """Writes a .prm file, or a .json file where the name ends so; returns the path. @throws InputError, see text()"""
        path = os.fspath(path)
        tree = self._complete(os.path.dirname(path) or ".")
        prm.write_complete(path, json.dumps(tree, indent=2) + "\n" if path.endswith(".json") else prm.to_text(tree))
        return path

    def check(self, ranks=1):
        """Lets the program read the case, mesh and all, and pair the surfaces (`nodus --validate`): what a run would start
        from. @throws InputError with what is wrong"""
        with tempfile.TemporaryDirectory() as folder:
            path = self.write(os.path.join(folder, "case.prm"))
            try:
                return Text(self.program.validate(path, ranks))
            except InputError as error:
                raise InputError(re.sub(re.escape(path) + r"(:\d+)?: ", "", str(error))) from None

    def plot_surfaces(self, ranks=1):
        """A figure of what the case makes of the surfaces of its bodies: sides of contact pairs, boundary conditions.
        @throws InputError"""
        from .surfaces import picture  # needs matplotlib

        with tempfile.TemporaryDirectory() as folder:
            path, file = self.write(os.path.join(folder, "case.prm")), os.path.join(folder, "surfaces.vtu")
            try:
                self.program.validate(path, ranks, surfaces=file)
            except InputError as error:
                if not os.path.exists(file):  # bodies that overlap are drawn
                    raise InputError(re.sub(re.escape(path) + r"(:\d+)?: ", "", str(error))) from None
            return picture(file, self.get("Title", ""))

    def run(self, folder=None, ranks=1, **options):
        """Runs the case, on several ranks by mpirun, with results in a folder (by default that of `Output/Results folder`)
        and the case beside it in <folder>.prm. options: see Program.run(). Returns a Run, which is Results. @throws InputError
        or RunError"""
        folder = os.fspath(folder or self.get("Output/Results folder", ""))
        if not folder:
            raise InputError("where to? run(folder), or set 'Output/Results folder'")
        folder = os.path.normpath(folder)
        copy = self.copy()
        copy["Output/Results folder"] = folder
        return self.program.run(copy.write(folder + ".prm"), ranks, **options)

    def explain(self, words):
        """The keys with these words in their path, or else in their meaning."""
        return self.reference.find(words)


class Text(str):
    """A text that notebooks show as it is, line by line."""

    def __repr__(self):
        return str(self)
