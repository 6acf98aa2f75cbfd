#!/usr/bin/env python3
"""Holds the source tree against its plan: rooms.py <source folder>

The rooms and the arrows between them stand in contrib/doc/architecture.md, in the table `| room | may use |`. A file may
include headers of its own room and of those that its room may use. Besides, functions have 80 lines at most, the members
of a class stand in two .cc files at most, files have fewer than 400 lines, and an object has no more than 25 data members.
Prints what it counted; exit code 1 where something does not fit.
"""

import collections
import pathlib
import re
import sys

LONGEST_FUNCTION, MOST_FILES, LONGEST_FILE, MOST_MEMBERS = 80, 2, 400, 25


def allowed_arrows(page):
    """Rooms that each room may use, from the table of the page."""
    rows = re.findall(r"^\| `(\w+)/` \|([^|]*)\|", page.read_text(), re.MULTILINE)
    return {room: set(re.findall(r"`(\w+)`", uses)) for room, uses in rows}


def room_of(path):
    """First folder below source/ or include/nodus/."""
    parts = path.parts
    below = parts[parts.index("source") + 1:] if "source" in parts else parts[parts.index("nodus") + 1:]
    return below[0] if len(below) > 1 else None


def functions(lines):
    """(first line, length) of the functions of a file in the layout of .clang-format."""
    start = None
    for number, line in enumerate(lines, 1):
        if re.match(r"^( {2}| {4})\{$", line) and not re.match(r"^ *(namespace|class|struct|enum)\b", lines[number - 2]):
            start = start or (number, len(line) - 1)
        elif start and line == " " * start[1] + "}":
            yield start[0], number - start[0]
            start = None


def classes(text):
    """(name, number of data members) of the classes and structs of a header, nested ones by themselves."""
    open_ones, depth = [], 0
    name, statement = None, ""
    for line in text.splitlines():
        line = re.sub(r"//.*", "", line)
        found = re.match(r"^\s*(?:class|struct) (?:\w+::)*(\w+)[^;]*$", line)
        if found:
            name = found.group(1)
        for character in line:
            if character == "{":
                depth += 1
                if name:
                    open_ones.append([name, depth, 0])
                    name = None
                    statement = ""
            elif character == "}":
                if open_ones and open_ones[-1][1] == depth:
                    closed = open_ones.pop()
                    yield closed[0], closed[2]
                    statement = ""
                depth -= 1
            elif character == ";":
                if open_ones and open_ones[-1][1] == depth:
                    plain = re.sub(r"<[^<>]*>", "", re.sub(r"<[^<>]*>", "", re.sub(r"\{[^}]*\}", "", statement)))
                    if plain.strip() and not re.search(
                            r"\(|\b(using|friend|static|constexpr|class|struct|enum|typedef|public|private)\b", plain.split("=")[0]
                    ) or re.search(r"std::function<", statement) and "(" not in re.sub(r"<.*>", "", statement):
                        open_ones[-1][2] += 1 + plain.split("=")[0].count(",")
                if depth == 0 or open_ones and open_ones[-1][1] == depth:
                    statement = ""
            elif open_ones and open_ones[-1][1] == depth:
                statement += character
                if statement.strip() in ("public:", "private:", "protected:"):
                    statement = ""
        if open_ones and open_ones[-1][1] == depth:
            statement += " "


def main():
    top = pathlib.Path(sys.argv[1])
    allowed = allowed_arrows(top / "contrib" / "doc" / "architecture.md")
    mistakes = []
    arrows, homes = collections.Counter(), collections.defaultdict(set)
    longest_function = longest_file = most_members = 0
    files = [f for folder in ("source", "include") for f in sorted((top / folder).rglob("*")) if f.suffix in (".cc", ".h")]
    for file in files:
        here = file.relative_to(top)
        lines = file.read_text().splitlines()
        room = room_of(here)
        if room is None:
            if str(here) != "source/main.cc":
                mistakes.append(f"{here}: stands in no room")
        elif room not in allowed:
            mistakes.append(f"{here}: room '{room}' is not in contrib/doc/architecture.md")
        for number, line in enumerate(lines, 1):
            include = re.match(r'#\s*include (?:"|<nodus/)(\w+)/[^">]*[">]', line)
            if include and include.group(1) in allowed:
                other = include.group(1)
                if room and other != room:
                    arrows[room, other] += 1
                    if other not in allowed.get(room, ()):
                        mistakes.append(f"{here}:{number}: {room} may not use {other}")
            member = re.match(r"^ {0,2}(?=\S)(?:[\w:<>,&*\s\[\]]+\s)?[*&]?((?:\w+::)*\w+)::~?\w+\(", line)
            if file.suffix == ".cc" and member and not re.match(r"(std|dealii|Nodus|MPI)\b", member.group(1)):
                homes[member.group(1)].add(str(here))
        longest_file = max(longest_file, len(lines))
        if len(lines) >= LONGEST_FILE:
            mistakes.append(f"{here}: {len(lines)} lines")
        for first, length in functions(lines) if file.suffix == ".cc" else ():
            longest_function = max(longest_function, length)
            if length > LONGEST_FUNCTION:
                mistakes.append(f"{here}:{first}: a function of {length} lines")
        for name, count in classes("\n".join(lines)) if "parameters" not in here.parts else ():
            most_members = max(most_members, count)
            if count > MOST_MEMBERS:
                mistakes.append(f"{here}: {name} has {count} data members")
    for name, places in sorted(homes.items()):
        if len(places) > MOST_FILES:
            mistakes.append(f"{name}: members in {len(places)} files: {', '.join(sorted(places))}")
    print(f"{len(files)} files in {len(allowed)} rooms, {len(arrows)} arrows, {sum(arrows.values())} includes across rooms")
    print(f"longest function {longest_function} lines, longest file {longest_file}, most data members {most_members}")
    for mistake in mistakes:
        print(mistake)
    return 1 if mistakes else 0


sys.exit(main())
