"""The comments of a .prm file that tools read, and what their formulas may call."""

import os
import re
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.realpath(__file__)), "..", "python"))
import nodus  # noqa: E402


def functions(results):
    """What the formulas of `# Check:` lines may call."""
    return {
        "reaction": lambda name, column, t=None: results.reactions.value(column, t, condition=name),
        "rigid": lambda name, column, t=None: results.rigid_bodies.value(column, t, body=name),
        "contact": lambda name, column, t=None: results.contact.value(column, t, pair=name),
        "surface": lambda field, t=None, **position: results.at_node("contact", field, t, **position),
        "body": lambda field, t=None, **position: results.at_node("bodies", field, t, **position),
    }


class Comments:
    """title, checks [(formula, value, tolerance, source)], profile (as nodus.overview takes it), view and cut of a .prm file,
    which may be None; prm/README.md describes them."""

    def __init__(self, path=None):
        self.title, self.checks, self.profile, self.view, self.cut = None, [], None, None, None
        if path is None:
            return
        with open(path, encoding="utf-8") as stream:
            text = stream.read()
        title = re.search(r"^set Title\s*=\s*(.*?)\s*$", text, re.M) or re.search(r'"Title"\s*:\s*"([^"]*)"', text)
        self.title = title.group(1) if title else None
        for kind, content in re.findall(r"^#\s*(Check|Plot):\s*(.*?)\s*$", text, re.M):
            self.add(kind, content)

    def add(self, kind, content):
        number = r"[-+]?[0-9.]+(?:[eE][-+]?[0-9]+)?"
        check = re.fullmatch(rf"(.*\S)\s+=\s+({number})\s+\+-\s+({number})(\s*%)?\s*\((.*)\)", content)
        profile = re.fullmatch(
            r"profile\s+(\S+)\s+over\s+(x|y|z|r|angle)(?:\s+where\s+(.*?))?(?:\s+=\s+(.*\S)\s+\(([^()]*)\))?", content
        )
        view = re.fullmatch(rf"view\s+({number})\s+({number})", content)
        cut = re.fullmatch(r"cut\s+(.*)", content)
        if kind == "Check" and check:
            expression, value, tolerance, percent, source = check.groups()
            allowed = float(tolerance) * (abs(float(value)) / 100 if percent else 1)
            self.checks.append((expression, float(value), allowed, source))
        elif kind == "Plot" and profile:
            field, variable, where, formula, source = profile.groups()
            curves = {source: lambda values: nodus.evaluate(formula, {variable: values})} if formula else None
            self.profile = field, variable, where, curves
        elif kind == "Plot" and view:
            self.view = tuple(float(angle) for angle in view.groups())
        elif kind == "Plot" and cut:
            self.cut = cut.group(1)
        else:
            raise nodus.InputError(f"cannot read the comment '# {kind}: {content}'; prm/README.md has the forms")
