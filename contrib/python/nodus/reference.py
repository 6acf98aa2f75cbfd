"""The keys of a parameter file as the program describes them (`nodus --document-json`), and what values they take."""

import difflib
import json
import numbers
import os
import re

import numpy as np

from .errors import InputError
from .html import table

_NUMBER = re.compile(r"[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?")
_INTEGER = re.compile(r"[-+]?\d+")
_NO_NAMES = ("inf", "-inf", "+inf", "infinity", "-infinity", "nan", "-nan")  # numbers to the program, too


class _Refused(Exception):
    """With a reason, where there is one beside what is allowed."""


def _is_list(value):
    return isinstance(value, (list, tuple)) or (isinstance(value, np.ndarray) and value.ndim > 0)


def _joined(value, separators=(";", ",")):
    """Lists inside of the entry of a list: [0, 0, 1] is "0,0,1", a list of such lists "0,0,1; 0,1,1"."""
    if not _is_list(value):
        return _text_of(value)
    deeper = any(_is_list(item) for item in value)
    if deeper and len(separators) < 2:
        raise _Refused
    separator = separators[0] + " " if deeper else separators[-1]
    return separator.join(_joined(item, separators[1:]) for item in value)


def _text_of(value):
    """A text, number or truth value as it is written in a parameter file."""
    if isinstance(value, (bool, np.bool_)):
        return "true" if value else "false"
    if isinstance(value, numbers.Integral):
        return str(int(value))
    if isinstance(value, numbers.Real) and np.isfinite(value):
        return repr(float(value))
    if isinstance(value, os.PathLike):
        value = os.fspath(value)
    if not isinstance(value, str):
        raise _Refused
    value = value.strip()
    if "#" in value or "\n" in value or value.endswith("\\"):
        raise _Refused("in one line, without '#' and '\\' at its end")
    return value


def _number_text(value, pattern):
    if isinstance(value, (bool, np.bool_)):
        raise _Refused
    text = _text_of(value)
    if not pattern.fullmatch(text):
        raise _Refused
    return text


def _in_range(number, kind):
    return kind.get("least", number) <= number <= kind.get("most", number) and not number <= kind.get("above", number - 1)


def _checked(value, kind):
    """The text of a value, or _Refused."""
    name = kind["kind"]
    if name == "list":
        return _checked_list(value, kind)
    if _is_list(value):
        raise _Refused
    if name in ("text", "file"):
        return _text_of(value)
    if name in ("number", "integer"):
        text = _number_text(value, _NUMBER if name == "number" else _INTEGER)
        if not np.isfinite(float(text)) or not _in_range(float(text), kind):
            raise _Refused
        return text
    if name == "id or name":
        text = _number_text(value, re.compile(".+"))
        if not (text.isdecimal() and int(text) < 2**31) and (_NUMBER.fullmatch(text) or text.lower() in _NO_NAMES):
            raise _Refused
        return text
    text = _text_of(value)
    if text not in (("true", "false") if name == "bool" else kind["choices"]):
        raise _Refused
    return text


def _checked_list(value, kind):
    """A list, or a text of entries between separators, or one entry."""
    separator, of = kind["separator"], kind["of"]
    if isinstance(value, str):
        items = [item.strip() for item in _text_of(value).split(separator)]
        items = items if items != [""] else []
    else:
        items = list(value) if _is_list(value) else [value]
        if of["kind"] == "text":
            items = [_joined(item) for item in items]
        if any(separator in item for item in items if isinstance(item, str)):
            raise _Refused(f"no entry of which holds a '{separator}'")
    if not kind.get("least", 0) <= len(items) <= kind.get("most", len(items)):
        raise _Refused
    return (f" {separator} " if separator == ":" else f"{separator} ").join(_checked(item, of) for item in items)


class Key:
    """A key: `path` ("Body <n>/Material/Law"), `default` (text), `allowed` (in words), `kind` (the same for programs),
    `unit` ("pressure", "-"), `meaning`."""

    def __init__(self, entry):
        self.path, self.default, self.allowed = entry["path"], entry["default"], entry["allowed"]
        self.kind, self.unit, self.meaning = entry["type"], entry["unit"], entry["meaning"]

    @property
    def choices(self):
        """Allowed texts of a choice or of the entries of a list of choices; () without."""
        return tuple(self.kind.get("choices") or self.kind.get("of", {}).get("choices", ()))

    def text(self, value, path=None):
        """What is written in the file for a value of the key, which errors call by its path. @throws InputError where the key
        does not take it"""
        try:
            return _checked(value, self.kind)
        except _Refused as refused:
            reason = f", {refused}" if refused.args else ""
        items = value if isinstance(value, (list, tuple)) else [value]
        for item in items:
            if isinstance(item, str) and item not in self.choices:
                reason += _did_you_mean(item, self.choices)
        raise InputError(f"{value!r} is no value of '{path or self.path}': give {self.allowed}{reason}")

    def value(self, text):
        """The text of a file as a number, a truth value or a tuple of these; as it is for texts, choices and expressions."""
        self.text(text)
        of = self.kind.get("of", self.kind)["kind"]
        read = {"number": float, "integer": int, "bool": lambda item: item == "true"}.get(of)
        if read is None:
            return text
        if self.kind["kind"] != "list":
            return read(text)
        return tuple(read(item) for item in text.split(self.kind["separator"])) if text.strip() else ()

    def __repr__(self):
        return (f"{self.path}\n  default  {self.default or '(empty)'}\n  allowed  {self.allowed}\n  unit     {self.unit}\n"
                f"  meaning  {self.meaning}")


def _nearest(name, names, n=3):
    folded = {other.lower(): other for other in names}
    return [folded[found] for found in difflib.get_close_matches(name.lower(), list(folded), n, 0.7)]


def _or(names):
    return "; did you mean " + " or ".join(f"'{name}'" for name in names) + "?" if names else ""


def _did_you_mean(name, names):
    return _or(_nearest(name, names))


class Reference:
    """All keys by path, with `<n>` for the number of a body, boundary condition, contact pair, output point or line."""

    def __init__(self, text):
        content = json.loads(text)
        self.keys = {entry["path"]: Key(entry) for entry in content["keys"]}
        self.generators = {entry["name"]: entry for entry in content["generators"]}
        self._numbered = re.compile("(" + "|".join(content["numbered"]) + r") [1-9]\d{0,8}(?=/|$)")
        self._names = {}  # section -> names of its sections and keys
        for path in self.keys:
            parts = path.split("/")
            for i, name in enumerate(parts):
                names = self._names.setdefault("/".join(parts[:i]), [])
                if name not in names:
                    names.append(name)

    def __getitem__(self, path):
        """The key at "Body 1/Name" or "Body <n>/Name". @throws InputError, with the nearest names, without one"""
        self.require(path)
        if self.is_section(path):
            raise InputError(f"'{path}' is a section; its keys are {', '.join(self._names[self._general(path)])}")
        return self.keys[self._general(path)]

    def _general(self, path):
        return self._numbered.sub(r"\1 <n>", path, count=1)

    def is_section(self, path):
        return self._general(path) in self._names

    def require(self, path):
        """@throws InputError, with the nearest names, unless the path is one of a section or key."""
        if self._general(path) in self.keys or self.is_section(path):
            return
        parts, known = path.split("/"), ""
        while self.is_section("/".join([known, parts[0]]) if known else parts[0]):
            known += ("/" if known else "") + parts.pop(0)
        name, names = parts[0], self._names[self._general(known)]
        if name in names and len(parts) > 1:
            raise InputError(f"'{name}' in '{known}' is a key and has no '{parts[1]}'")
        near = _nearest(name, names)
        if not near:  # the right name in the wrong place, or one like it
            last = {key: key.split("/")[-1] for key in self.keys}
            near = [key for key in last if last[key] == name]
            near = near or [key for key in last if last[key] in _nearest(name, last.values())]
        place = f"in '{known}'" if known else "at the top level"
        raise InputError(f"unknown key or section '{name}' {place}" + _or(near[:3]))

    def check(self, path, value):
        """The text of a value for the key at a path. @throws InputError where there is no such key, or it does not take it"""
        key = self[path]
        text = key.text(value, path)
        if key.path.endswith("/Generator") and text and text not in self.generators:
            raise InputError(f"{value!r} is no generator" + (_did_you_mean(text, self.generators) or
                                                             "; there are " + ", ".join(self.generators)))
        return text

    def find(self, words):
        """The keys with all words in their path, or else in their meaning."""
        words = words.lower().split()
        for where in ("path", "meaning"):
            found = [key for key in self.keys.values() if all(word in getattr(key, where).lower() for word in words)]
            if found:
                return Keys(found)
        raise InputError(f"there is no key like '{' '.join(words)}'"
                         + _did_you_mean(" ".join(words), [path.split("/")[-1] for path in self.keys]))

    def _repr_html_(self):
        return Keys(self.keys.values())._repr_html_()


class Keys(list):
    """Some keys, as text or as a table of a notebook."""

    def __repr__(self):
        return "\n".join(map(repr, self))

    def _repr_html_(self):
        return table(["key", "default", "allowed", "unit", "meaning"],
                     [[key.path, key.default, key.allowed, key.unit, key.meaning] for key in self])
