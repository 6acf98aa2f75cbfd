"""The tables that a run writes (contact.csv and others)."""

import csv
import difflib
import io
import os
import re

import numpy as np

from .errors import ResultsError
from .html import table

TEXTS = ("pair", "condition", "body", "point", "line")  # columns of names; all others are numbers


def nearest(times, t=None):
    """The last time (t = None), or the one asked for. @throws ResultsError where there is none"""
    times = list(times)
    if not times:
        raise ResultsError("there is no time in the results")
    if t is None:
        return max(times)
    best = min(times, key=lambda time: abs(time - t))
    if abs(best - t) > 1e-6 * max(1.0, abs(t)):
        raise ResultsError(f"there is no time {t:.8g}; the nearest is {best:.8g}")
    return best


class Table:
    """Rows of columns: table["force z"] is the column (n,), table[0] or table[-1] a row as a dictionary, table[mask] or
    table[1:] the rows chosen; `names` of the columns, `units` by name, which are in square brackets in the file. Iterating
    gives rows."""

    def __init__(self, name, columns, units):
        self.name, self.columns, self.units = name, columns, units

    @classmethod
    def read(cls, path):
        """@throws ResultsError where there is no such file, no row in it, or a row that is not complete"""
        if not os.path.exists(path):
            raise ResultsError(f"there is no {path}")
        with open(path, newline="", encoding="utf-8") as stream:
            text = stream.read()
        if text and not text.endswith("\n"):
            raise ResultsError(f"{path} ends in the middle of a line")
        rows = list(csv.reader(io.StringIO(text, newline="")))
        if len(rows) < 2:
            raise ResultsError(f"{path} has no rows")
        header = [re.fullmatch(r"(.*?)(?: \[(.*)\])?", name).groups() for name in rows[0]]
        for number, row in enumerate(rows[1:], 2):
            if len(row) != len(header):
                raise ResultsError(f"{path}:{number}: {len(row)} entries instead of {len(header)}")
        columns = {}
        for (name, _), entries in zip(header, zip(*rows[1:])):
            try:
                columns[name] = np.array(entries, dtype=object if name in TEXTS else float)
            except ValueError:
                raise ResultsError(f"{path}: column '{name}' has an entry that is no number") from None
        return cls(os.path.basename(path), columns, {name: unit or "" for name, unit in header})

    @property
    def names(self):
        return list(self.columns)

    def __len__(self):
        return len(next(iter(self.columns.values()), ()))

    def __getitem__(self, which):
        if isinstance(which, str):
            if which not in self.columns:
                near = [name for name in self.columns if which in name] or difflib.get_close_matches(which, self.columns, 3)
                near = near or [*list(self.columns)[:12], f"... ({len(self.columns)} in all)"]
                raise ResultsError(f'{self.name} has no column "{which}"; it has {", ".join(near)}')
            return self.columns[which]
        if isinstance(which, (int, np.integer)):
            return {name: column[which] if name in TEXTS else float(column[which]) for name, column in self.columns.items()}
        return Table(self.name, {name: column[which] for name, column in self.columns.items()}, self.units)

    def __iter__(self):
        return (self[i] for i in range(len(self)))

    def where(self, **names):
        """The rows of a pair, condition, body, point or line: table.where(pair="ring"). @throws ResultsError where there is none"""
        chosen = np.ones(len(self), bool)
        for column, wanted in names.items():
            there = self[column]
            chosen &= there == wanted
            if not chosen.any():
                known = ", ".join(f'"{name}"' for name in dict.fromkeys(there))
                raise ResultsError(f'{self.name} has no {column} "{wanted}"; it has {known}')
        return self[chosen]

    def value(self, column, t=None, **names):
        """A number at the last time, or at time t, of a pair, condition, body, point or line. @throws ResultsError"""
        rows = self.where(**names)
        return float(rows[column][rows["time"] == nearest(rows["time"], t)][-1])

    def frame(self):
        """As a pandas.DataFrame."""
        return _pandas().DataFrame(self.columns)

    def __repr__(self):
        return f"<{self.name}: {len(self)} rows of {len(self.columns)} columns>"

    def _repr_html_(self, most=12):
        rows = list(range(len(self)))
        shown = rows if len(rows) <= most else rows[: most // 2] + rows[-most // 2:]
        header = [name + (f" [{self.units[name]}]" if self.units[name] else "") for name in self.columns]
        cells = [[value if isinstance(value, str) else f"{value:.6g}" for value in self[i].values()] for i in shown]
        if len(shown) < len(rows):
            cells.insert(most // 2, ["..."] * len(header))
        return table(header, cells, f"{self.name}, {len(rows)} rows")


def _pandas():
    try:
        import pandas
    except ImportError:
        raise ImportError("frame() needs pandas: pip install pandas") from None
    return pandas
