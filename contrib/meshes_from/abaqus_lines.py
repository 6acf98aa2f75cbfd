"""The lines of an Abaqus or CalculiX deck: keywords with their parameters and data lines, included files in their place."""

import os

from .mesh import MeshError

DEEPEST = 20  # files that include files


class Keyword:
    """One keyword with its data: `lines` without comments, `numbers` their files and line numbers."""

    def __init__(self, name, parameters, file, number):
        self.name, self.parameters, self.file, self.number = name, parameters, file, number
        self.lines, self.numbers = [], []

    def add(self, file, data):
        """Data lines, as (number, text)."""
        for number, text in data:
            self.lines.append(text)
            self.numbers.append((file, number))

    def where(self, i=None):
        """Place of the keyword, or of its i-th data line, for messages."""
        if i is None:
            return f"{self.file}:{self.number}"
        file, number = self.numbers[i]
        return f"{file}:{number}"

    def get(self, parameter, default=None):
        """Value of a parameter, "" where it has none."""
        return self.parameters.get(parameter, default)

    def need(self, parameter):
        """@raises MeshError where it is not given"""
        if not self.parameters.get(parameter):
            raise MeshError(f"{self.where()}: *{self.name} without {parameter}=")
        return self.parameters[parameter]


def read_keywords(path, depth=0):
    """All keywords of a file in order."""
    found = []
    for number, text in _logical_lines(path):
        if not text.startswith("*"):
            if found:
                found[-1].add(path, [(number, text)])
            continue
        keyword = _keyword(text, path, number)
        source = keyword.get("INPUT")
        if keyword.name == "INCLUDE":
            if depth == DEEPEST:
                raise MeshError(f"{keyword.where()}: files include each other {DEEPEST} deep")
            included = _beside(path, keyword.need("INPUT"), keyword)
            if found:  # data that go on from the keyword before
                found[-1].add(included, _leading_data(included))
            found += read_keywords(included, depth + 1)
        else:
            found.append(keyword)
            if source and keyword.name in ("NODE", "ELEMENT", "NSET", "ELSET"):
                other = _beside(path, source, keyword)
                keyword.add(other, _leading_data(other))
    return found


def _beside(path, name, keyword):
    other = os.path.join(os.path.dirname(path), name.strip('"'))
    if not os.path.isfile(other):
        raise MeshError(f"{keyword.where()}: there is no file {other}")
    return other


def _open(path):
    try:
        return open(path, encoding="utf-8", errors="replace")
    except OSError as error:
        raise MeshError(f"{path}: {error.strerror}")


def _leading_data(path):
    """(number, text) of the data lines before the first keyword."""
    for number, text in _logical_lines(path):
        if text.startswith("*"):
            return
        yield number, text


def _logical_lines(path):
    """(number, text) without comments and blank lines; keyword lines that end in a comma go on in the next one."""
    with _open(path) as file:
        pending, first = "", 0
        for number, line in enumerate(file, 1):
            text = line.strip()
            if not text or text.startswith("**"):
                continue
            if pending:
                text, number = pending + " " + text, first
                pending = ""
            if text.startswith("*") and text.endswith(","):
                pending, first = text, number
                continue
            yield number, text
        if pending:
            yield first, pending


def _keyword(text, path, number):
    name, *rest = split(text[1:])
    parameters = {}
    for entry in rest:
        key, _, value = entry.partition("=")
        parameters["".join(key.split()).upper()] = value.strip()
    return Keyword(" ".join(name.split()).upper(), parameters, path, number)


def split(text):
    """Entries between commas that are not in quotation marks."""
    if '"' not in text:
        return [entry.strip() for entry in text.split(",")]
    entries, quoted = [""], False
    for character in text:
        if character == '"':
            quoted = not quoted
        elif character == "," and not quoted:
            entries.append("")
        else:
            entries[-1] += character
    return [entry.strip() for entry in entries]
