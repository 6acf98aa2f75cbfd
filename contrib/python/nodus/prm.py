"""Parameter files as nested dictionaries of texts, as they are: what the keys mean is not looked at."""

import json
import os

from .errors import InputError


def to_text(tree, indent="", written=str):
    """The .prm file of nested dictionaries; written: makes a text of a value."""
    text = ""
    for name, value in tree.items():
        if isinstance(value, dict):
            text += f"{indent}subsection {name}\n{to_text(value, indent + '  ', written)}{indent}end\n"
        else:
            text += f"{indent}set {name} = {written(value)}\n"
    return text


def _statements(text):
    """(number of the line, statement) without comments, with continued lines joined."""
    lines = enumerate(text.splitlines(), 1)
    for number, line in lines:
        line = line.split("#")[0].strip()
        while line.endswith("\\"):
            line = line[:-1].strip() + " " + next(lines, (0, ""))[1].split("#")[0].strip()
        if line:
            yield number, line


def parse(text, file="text"):
    """Nested dictionaries of the text of a .prm file. @throws InputError with the line that is no statement"""
    sections = [{}]
    for number, line in _statements(text):
        word, rest = (line.split(None, 1) + [""])[:2]
        if word == "subsection" and rest:
            if rest in sections[-1]:
                raise InputError(f"{file}:{number}: subsection '{rest}' is there twice")
            sections[-1][rest] = {}
            sections.append(sections[-1][rest])
        elif line == "end" and len(sections) > 1:
            sections.pop()
        elif word == "set" and "=" in rest:
            key, _, value = rest.partition("=")
            if key.strip() in sections[-1]:
                raise InputError(f"{file}:{number}: '{key.strip()}' is there twice")
            sections[-1][key.strip()] = value.strip()
        else:
            raise InputError(f"{file}:{number}: cannot understand '{line}'")
    if len(sections) > 1:
        raise InputError(f"{file}: a subsection has no 'end'")
    return sections[0]


def read(path):
    """Nested dictionaries of a .prm or .json file."""
    with open(path, encoding="utf-8-sig") as file:
        text = file.read()
    if not os.fspath(path).endswith(".json"):
        return parse(text, path)
    try:
        tree = json.loads(text)
    except json.JSONDecodeError as error:
        raise InputError(f"{path}:{error.lineno}: this is no JSON: {error.msg}") from None
    if not isinstance(tree, dict):
        raise InputError(f"{path}: the file must be one object")
    return _values(tree)


def _values(tree):
    """deal.II's ParameterHandler writes {"value": ..., "default_value": ...} for a key."""
    if not isinstance(tree, dict):
        return tree
    if "value" in tree and "default_value" in tree:
        return tree["value"]
    return {name: _values(value) for name, value in tree.items()}


def results_folder(path, overrides=()):
    """Where nodus puts the results of a file: as its `Output/Results folder` or an override says, or results/<name>."""
    folder = dict(overrides).get("Output/Results folder")
    if not folder:
        folder = read(path).get("Output", {}).get("Results folder")
    if not folder:
        folder = os.path.join("results", os.path.splitext(os.path.basename(path))[0])
    return str(folder)


def write_complete(path, text):
    """A file that appears complete or not at all."""
    folder = os.path.dirname(path)
    if folder:
        os.makedirs(folder, exist_ok=True)
    with open(f"{path}.incomplete", "w", encoding="utf-8") as file:
        file.write(text)
    os.replace(f"{path}.incomplete", path)
