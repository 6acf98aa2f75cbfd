"""The inputs of fuzz.py: small cases of tests/ and prm/, with something wrong, or strange, in each.

`make(number, seed)` gives input `number` of a seed, always the same; its kind follows from the number, so that the kinds have
equal shares. Numbers that stand for sizes (refinement, increments, cells) are small or so large that no run could want them.
"""

import functools
import json
import os
import random
import re

from random_cases import common, prm

ROOT, NODUS = common.ROOT, common.NODUS
KINDS = ("prm", "json", "msh", "checkpoint", "expression", "set")

HOSTILE_NUMBERS = (
    "0", "-1", "-0.0", "0.5", "1e-300", "1e300", "-1e300", "1e308", "1e400", "-1e400", "nan", "-nan", "NaN", "inf", "-inf",
    "infinity", "100000000", "1000000000", "2147483647", "2147483648", "-2147483648", "4294967295", "4294967296",
    "18446744073709551616", "9" * 40, "1." + "3" * 400, "", "abc", "1e", "1,5", "1.5.2", "--1", "+1", "0x10", "1/2", "1 2",
    "true", "1;2", "1:2", "1,2,3,4", "\u0663", "1mm", "1e5e5",
)  # fmt: skip
# These are numbers, so that what refuses them must look at what they mean.
STRANGE_NUMBERS = (
    "0", "-1", "-0.0", "0.5", "1e-300", "1e-20", "1e-9", "1e9", "1e20", "1e300", "-1e300", "1e308", "100000000", "2", "3",
    "7", "1000000000", "2147483647", "0.999999", "-0.999999", "0.49999999", "100", "4294967295",
)  # fmt: skip
# Whole numbers that are sizes of a run stay small where they are meant to be plausible.
SMALL = {"Global refinement": 1, "Local refinement": 1, "Increments": 3, "Repetitions": 1, "Initial cycles": 1,
         "Maximum level": 1, "Interval": 3}  # fmt: skip
TEXTS = {
    "Title": ["a title", "100 %s %n \\ \" <&>", "\u00e9\u4e2d", ""],
    "Name": ["upper", "a/b", "a,b", "\"", "", "lower"],
    "Mesh file": ["no.msh", ".", "case.prm", "", "/dev/null"],
    "Generator": ["hyper_cube", "subdivided_hyper_rectangle", "hyper_ball", "cylinder", "moebius", "hyper_cross", "simplex",
                  ""],
    "Generator arguments": ["0 : 1 : true", "1,1,1 : 0,0,0 : 1,1,1 : true", "1,1,1 : 0,0,0 : 0,1,1 : true", "1:1", "",
                            "-1,0,1 : 0,0,0 : 1,1,1 : true", "1e9,1e9,1e9 : 0,0,0 : 1,1,1 : true",
                            "100000,100000,100000 : 0,0,0 : 1,1,1 : true", "0,0,0 : 1 : false", "nan : 1 : true"],
    "Results folder": ["elsewhere", "a/b/c", "case.prm", "case.prm/below", "/dev/null/below", "x" * 300, ".", "a\tb"],
}  # fmt: skip
EXPRESSIONS_OF_TIME = ("Rigid rotation", "Rigid translation", "Rigid force", "Rigid moment", "Master rotation",
                       "Master translation")
EXPRESSIONS = EXPRESSIONS_OF_TIME + ("Where", "Slave where", "Master where", "Refine where", "Value", "Friction factor")


class Input:
    """Files (path -> bytes, None for a folder), arguments of nodus, and in words what was changed."""

    def __init__(self, number, kind, files, arguments, change):
        self.number, self.kind, self.files, self.arguments, self.change = number, kind, files, arguments, change


def read(*path):
    with open(os.path.join(ROOT, *path), "rb") as file:
        return file.read()


def put(tree, path, value):
    *sections, key = path.split("/")
    for name in sections:
        tree = tree.setdefault(name, {})
    tree[key] = value


BASES = ("two_blocks", "rigid_plane", "driven_plate", "carried_plane", "free_block")


def base(name):
    tree = common.nodus.prm.parse(read("tests", "parameters", name + ".prm").decode())
    if name == "free_block":
        put(tree, "Load stepping/Viscous stabilisation", "1e-2")
    return tree


class Reference:
    """The keys of the program, path -> words for what is allowed, and its generators with an example for each."""

    @classmethod
    @functools.lru_cache(None)
    def keys(cls):
        reference = common.program().reference
        cls.generators = [(name, entry["example"]) for name, entry in reference.generators.items()]
        return {path: key.allowed for path, key in reference.keys.items()}


def plausible(rng, key, allowed):
    """A value that the key may have; whether the case goes with it is another question."""
    name = key.split("/")[-1]
    if name in TEXTS:
        return rng.choice(TEXTS[name])
    if name in EXPRESSIONS:
        return expression(rng, "t" if name in EXPRESSIONS_OF_TIME else "x" if "here" in name else "xt")[0]
    if allowed.startswith("one of: "):
        return rng.choice(allowed[len("one of: "):].split(", "))  # fmt: skip
    if allowed == "true or false":
        return rng.choice(("true", "false"))
    entries = re.match(r"(3 entries|a list) separated by '(.)'(?:, each (.*))?", allowed)
    if entries:
        n = 3 if entries[1] == "3 entries" else rng.randint(0, 3)
        return f"{entries[2]} ".join(plausible(rng, key + "s", entries[3] or "a number") if name != "Increments" else
                                     str(rng.randint(1, SMALL[name])) for _ in range(n))  # fmt: skip
    low, high = re.search(r">=? (\S+)", allowed), re.search(r"<= (\S+)", allowed)
    low = float(low[1]) if low else -10.0
    high = float(high[1]) if high else max(low, 0) + rng.choice((1, 10, 1000))
    if "whole number" in allowed:
        return str(rng.randint(int(low), SMALL.get(name, min(int(high), int(low) + 10))))
    return format(rng.choice((low, high, rng.uniform(low, high), low + (high - low) * 10 ** rng.uniform(-9, 0))), ".6g")


def random_setting(rng, tree):
    """A known key with a plausible or a hostile value; numbered sections are those of the case, rarely others."""
    keys = Reference.keys()
    key = rng.choice(sorted(keys))
    allowed = keys[key]
    if "<n>" in key:
        stem = key.split(" <n>")[0]
        numbers = [name.split()[-1] for name in tree if name.startswith(stem)]
        key = key.replace("<n>", rng.choice(numbers) if numbers and rng.random() < 0.95 else rng.choice(("0", "9", "-1")))
    choice = rng.random()
    if choice < 0.75:
        return key, plausible(rng, key, allowed)
    if choice < 0.87:
        value = rng.choice(STRANGE_NUMBERS)
        return key, "100000000" if key.split("/")[-1] in SMALL and value in ("2", "3", "7", "100") else value
    if choice < 0.95 or not re.search(r"\d", allowed + key):
        return key, rng.choice(HOSTILE_NUMBERS)
    return key, ", ".join(rng.choice(HOSTILE_NUMBERS) for _ in range(rng.randint(2, 4)))


def seed_tree(rng):
    """A small right case, sometimes with more of its keys set."""
    name = rng.choice(BASES)
    tree = base(name)
    for _ in range(rng.choice((0, 0, 1, 2))):
        key = rng.choice(sorted(Reference.keys()))
        if "<n>" not in key and not key.startswith(("Output", "Strategy")):
            put(tree, key, plausible(rng, key, Reference.keys()[key]))
    return name, tree


def cut(rng, text, n=None):
    return text[: rng.randrange(len(text)) if n is None else n]


def flip_bytes(rng, data):
    data = bytearray(data)
    for _ in range(rng.choice((1, 1, 3, 20))):
        data[rng.randrange(len(data))] = rng.randrange(256)
    return bytes(data)


def replace_number(rng, text):
    """One number of a text becomes a hostile one."""
    found = list(re.finditer(r"(?<![\w.])-?\d+(?:\.\d*)?(?:e-?\d+)?", text))
    if not found:
        return text, "nothing"
    where = rng.choice(found)
    value = rng.choice(HOSTILE_NUMBERS if rng.random() < 0.4 else STRANGE_NUMBERS)
    line = text[text.rfind("\n", 0, where.start()) + 1 :].split("\n")[0].strip()
    return text[: where.start()] + value + text[where.end() :], f"{where[0]} -> {value[:60]} in '{line[:80]}'"


def change_lines(rng, lines):
    """One of the mutations of lines that parameter and mesh files share."""
    i, j = rng.randrange(len(lines)), rng.randrange(len(lines))
    what = rng.choice(("deleted", "duplicated", "swapped", "moved", "joined"))
    lines = list(lines)
    change = f"line {i + 1} {what}: '{lines[i].strip()[:60]}'"
    if what == "deleted":
        del lines[i]
    elif what == "duplicated":
        lines.insert(j, lines[i])
    elif what == "swapped":
        lines[i], lines[j] = lines[j], lines[i]
    elif what == "moved":
        lines.insert(j, lines.pop(i))
    elif i + 1 < len(lines):
        lines[i] += lines.pop(i + 1)
    return lines, change


def prm_input(rng):
    name, tree = seed_tree(rng)
    text, change = prm(tree), name
    for _ in range(rng.choice((1, 1, 1, 2, 3))):
        what = rng.choice(("lines", "lines", "number", "number", "number", "value", "value", "key", "section", "cut", "bytes",
                           "long", "deep", "form"))  # fmt: skip
        lines = text.split("\n")
        sets = [n for n, line in enumerate(lines) if "=" in line]
        if what == "lines":
            lines, more = change_lines(rng, lines)
            text = "\n".join(lines)
        elif what == "number":
            text, more = replace_number(rng, text)
        elif what == "value" and sets:
            n, value = rng.choice(sets), rng.choice(HOSTILE_NUMBERS + ("=", "a = b", "\\", "true", "upper", "x, y", ";;", ",,",
                                                                       "::"))
            lines[n] = lines[n].split("=")[0] + "= " + value
            text, more = "\n".join(lines), f"'{lines[n].strip()[:100]}'"
        elif what == "key" and sets:
            n = rng.choice(sets)
            key, value = random_setting(rng, tree)
            lines.insert(n, f"set {rng.choice((key.split('/')[-1], key, rng.choice(('', 'a', key[::-1]))))} = {value}")
            text, more = "\n".join(lines), f"'{lines[n][:100]}' before line {n + 1}"
        elif what == "section":
            names = sorted(set(re.findall(r"subsection (.*)", text)))
            old = rng.choice(names or ["Body 1"])
            new = rng.choice((old + "x", "", "a/b", old[:-1] + "0", old[:-1] + "3", old[:-1] + "1000000", old[:-1] + "9" * 25,
                              old[:-1] + "-1", old.lower(), "Newton", "Material"))  # fmt: skip
            text, more = text.replace("subsection " + old, "subsection " + new), f"subsection '{old}' -> '{new}'"
        elif what == "cut":
            text = cut(rng, text + "\n")
            more = f"cut after {len(text)} characters"
        elif what == "bytes":
            n = rng.randrange(len(text) + 1)
            garbage = rng.choice(("\0", "\0" * 100, "\x1b[2J", "\r", "\x85", "\udcff\udcfe",
                                  "".join(chr(0xDC80 + rng.randrange(128))
                                  for _ in range(50)), "\u00a0", "\ufeff"))  # fmt: skip
            text, more = text[:n] + garbage + text[n:], f"{garbage[:5]!r} after {n} characters"
        elif what == "long":
            n = 10 ** rng.randint(3, 6)
            line = rng.choice(("set Title = {}", "set {} = 1", "subsection {}", "# {}", "{}", "set Title = a \\\n" * 2 + "{}",
                               "subsection Newton\n set Force tolerance = 0.{}\nend",
                               "subsection Body 1\n set Translation = {}\nend"))  # fmt: skip
            text = line.format(rng.choice("a1") * n) + "\n" + text
            more = f"'{line}' with {n} characters first"
        elif what == "deep":
            n = 10 ** rng.randint(2, 4)
            closed = rng.random() < 0.5
            text += "subsection a\n" * n + "end\n" * (n if closed else 0)
            more = f"{n} subsections in each other, {'closed' if closed else 'open'}"
        else:
            more = rng.choice(("CRLF", "CR", "tabs", "UTF-16", "upper case", "empty", "no line end", "all continued"))
            text = {"CRLF": text.replace("\n", "\r\n"), "CR": text.replace("\n", "\r"), "tabs": text.replace(" ", "\t"),
                    "UTF-16": "\ufeff" + "\0".join(text) + "\0", "upper case": text.upper(), "empty": "",
                    "no line end": text.rstrip("\n"), "all continued": text.replace("\n", "\\\n")}[more]  # fmt: skip
        change += "; " + more
        if not text:
            break
    return {"case.prm": text.encode(errors="surrogateescape")}, ["case.prm"], change


def nodes_of(tree, path=()):
    """All places of a tree of dictionaries and lists."""
    items = tree.items() if isinstance(tree, dict) else enumerate(tree) if isinstance(tree, list) else ()
    for key, value in items:
        yield tree, key, path + (str(key),)
        yield from nodes_of(value, path + (str(key),))


def json_input(rng):
    if rng.random() < 0.4:
        name, tree = "two_blocks.json", json.loads(read("tests", "parameters", "two_blocks.json"))
    else:
        name, tree = seed_tree(rng)
    change = name
    raw = {}  # what json.dumps cannot write, by the word that stands for it
    if rng.random() < 0.65:
        for _ in range(rng.choice((1, 1, 2))):
            holder, key, path = rng.choice(list(nodes_of(tree)))
            values = {"null": None, "true": True, "[]": [], "{}": {}, "nested list": [[[1, [2]]]], "object": {"a": {"b": 1}},
                      "\"\"": "", "list of mixed": [1, "a", None, {}, [True]], "@huge": "1e999", "@nan": "NaN",
                      "@inf": "-Infinity",
                      "@digits": "9" * 1000, "@deep list": "[" * 20000 + "]" * 20000,
                      "@deep object": "{\"a\":" * 20000 + "1" + "}" * 20000,
                      "@hex": "0x10", "@minus": "-", "@zeros": "007", "@surrogate": "\"\\ud800\"", "@nul": "\"a\\u0000b\"",
                      "@long": "\"" + "a" * 1000000 + "\"", "@wide": "[" + "1," * 100000 + "1]"}  # fmt: skip
            values.update((f"'{value[:40]}'", value) for value in rng.sample(HOSTILE_NUMBERS, 6))
            values.update((number, float(number)) for number in ("1e300", "-1", "0", "1e-300"))
            what = rng.choice(("value", "value", "value", "deleted", "renamed", "copied"))
            if what == "deleted":
                del holder[key]
            elif what == "renamed" and isinstance(holder, dict):
                holder[rng.choice((str(key) + "x", "", "a/b", "Body 3", "\n", "Material"))] = holder.pop(key)
            elif what == "copied" and isinstance(holder, dict):
                other, where, _ = rng.choice(list(nodes_of(tree)))
                other[where] = json.loads(json.dumps(holder[key]))
            else:
                what = rng.choice(sorted(values))
                holder[key] = values[what]
                if what.startswith("@"):
                    raw[what], holder[key] = values[what], what
            change += f"; {'/'.join(path)}: {what}"
    text = json.dumps(tree, indent=rng.choice((None, 2)))
    for word, value in raw.items():
        text = text.replace(f'"{word}"', value)
    data = text.encode()
    if rng.random() < 0.45 or change == name:
        what = rng.choice(("cut", "cut", "bytes", "character removed", "character doubled", "number", "comment", "comma",
                           "twice",
                           "top level", "BOM", "quotes", "escape"))  # fmt: skip
        n = rng.randrange(len(text))
        data = {"cut": data[:n], "bytes": flip_bytes(rng, data), "character removed": data[:n] + data[n + 1 :],
                "character doubled": data[:n] + data[n : n + 1] + data[n:], "number": replace_number(rng, text)[0].encode(),
                "comment": b"// a comment\n" + data, "comma": data[:-1] + b",}", "twice": data + data,
                "top level": rng.choice((b"", b" ", b"null", b"[]", b"[1, 2]", b"3", b"\"a\"", b"{}", b"{\"\": {}}",
                                         b"[" * 100000,
                                         b"{\"a\":" * 100000, b"true")),
                "BOM": b"\xef\xbb\xbf" + data, "quotes": data.replace(b'"', b"'"),
                "escape": data[:n] + rng.choice((b"\\", b"\\u", b"\\x", b"\0", b"\xff")) + data[n:]}[what]  # fmt: skip
        change += f"; {what} at {n}"
    return {"case.json": data}, ["case.json"], change


def mesh_case(mesh):
    """A case that takes the mesh file mesh.msh, which is a copy of this one."""
    if mesh.startswith("cylinder"):  # surfaces 1 bottom, 2 top, 3 mantle
        tree = base("rigid_plane")
        tree["Body 1"] = {"Mesh file": "mesh.msh", "Material": {"Young's modulus": "1000"}}
        tree["Boundary condition 1"]["Boundary ids"] = "2"
        tree["Contact pair 1"].update({"Slave boundary ids": "1", "Master point": "0, 0, 0", "Master axis": "0, 0, 1",
                                       "Master translation": "0; 0; 0.01*t"})  # fmt: skip
    elif mesh == "inclined.msh":
        tree = common.nodus.prm.parse(read("prm", "inclined_interface.prm").decode())
        for body in ("Body 1", "Body 2"):
            tree[body]["Mesh file"] = "mesh.msh"
    else:
        tree = base("two_blocks")
        for key in ("Generator", "Generator arguments"):
            del tree["Body 1"][key]
        tree["Body 1"]["Mesh file"] = "mesh.msh"
    return tree


MESHES = (
    *(("tests", "meshes", f"cylinder_{name}.msh") for name in ("8_2", "20_2", "20_2_format_22", "27_1", "27_2_format_22")),
    *(("tests", "parameters", name + ".msh") for name in ("one_cell", "one_cell", "one_cell", "tetrahedra", "third_order",
                                                          "inverted")),
    ("meshes", "inclined.msh"),
)


def change_mesh(rng, lines):
    """What leaves a mesh file readable: other nodes or groups of an element, elements twice or missing, nodes moved."""
    begin = {line: n for n, line in enumerate(lines)}
    n_words = 4 if any(line.startswith("2.2") for line in lines[:3]) else 3
    nodes = [n for n in range(begin.get("$Nodes", 0) + 1, begin.get("$EndNodes", 0)) if len(lines[n].split()) == n_words]
    first = begin.get("$Elements", 0) + 2
    elements = [n for n in range(first, begin.get("$EndElements", 0)) if len(lines[n].split()) > 5]
    what = rng.choice(("node", "nodes", "scale", "flat", "element", "order", "doubled", "group"))
    lines, n = list(lines), rng.choice(elements or [0])
    words = lines[n].split()
    if what in ("node", "nodes", "scale", "flat") or len(words) < 6:
        size = 10.0 ** rng.randint(-12, 0)
        factor = rng.choice((1e-300, 1e-150, 1e-30, 1e-12, 1e12, 1e100, 1e150, -1.0))
        axis = rng.randint(1, 3)
        for n in rng.sample(nodes, 1) if what == "node" and nodes else nodes:
            words = lines[n].split()
            for d in (-3, -2, -1):
                try:
                    x = float(words[d])
                except ValueError:
                    continue  # changed before
                words[d] = repr(x + rng.uniform(-size, size) if what in ("node", "nodes") else
                                x * factor if what == "scale" or d == -axis else x)  # fmt: skip
            lines[n] = " ".join(words)
        return lines, f"{what} " + (f"moved by up to {size:g}" if what in ("node", "nodes") else f"times {factor:g}")
    old = lines[n]
    if what == "element":
        words[-rng.randint(1, 4)] = words[-rng.randint(1, 4)]
    elif what == "order":
        tail = words[-4:]
        rng.shuffle(tail)
        words[-4:] = tail
    elif what == "group":
        words[3] = rng.choice(("0", "-1", "2", "4", "5", "7", "255", "256", "4294967294", "2147483647", "-2147483648"))
    else:
        lines.insert(n, old)
        lines[first - 1] = str(int(lines[first - 1]) + 1) if lines[first - 1].isdigit() else lines[first - 1]
    lines[n] = " ".join(words)
    return lines, f"{what} in line {n + 1}: '{old[:60]}' -> '{lines[n][:60]}'"


def change_inner_count(rng, lines):
    """How many nodes, elements, groups or tags a line says that there are."""
    section, found = "", []
    for n, line in enumerate(lines):
        words = line.split()
        section = line.strip() if line.startswith("$") else section
        place = {("$Entities", 5): 4, ("$Entities", 10): 7, ("$Nodes", 4): 3, ("$Elements", 4): 3}.get((section, len(words)))
        if place and lines[n - 1] != section:
            found.append((n, place))
        elif section == "$Elements" and len(words) > 5:
            found.append((n, 2))
    if not found:
        return lines, "no inner count"
    lines, (n, place) = list(lines), rng.choice(found)
    words = lines[n].split()
    words[place] = rng.choice(("-1", "0", "1", "2", "1000", "4000000000", "99999999999", "9" * 18, "18446744073709551615"))
    old, lines[n] = lines[n], " ".join(words)
    return lines, f"line {n + 1}: '{old[:60]}' -> '{lines[n][:60]}'"


def msh_input(rng):
    path = rng.choice(MESHES)
    text, change = read(*path).decode(), path[-1]
    tree = mesh_case(path[-1])
    if rng.random() < 0.1:
        tree["Discretization"] = {"Degree": "2"}
    for _ in range(rng.choice((1, 1, 1, 2))):
        lines = text.split("\n")
        what = rng.choice(("cut", "lines", "lines", "number", "number", "coordinate", "id", "id", "shuffled", "section",
                           "count", "inner count", "inner count", "format", "bytes", "form")
                          + ("mesh",) * 9)  # fmt: skip
        inside = [n for n, line in enumerate(lines) if line and line[0] in "-0123456789"] or [0]
        n = rng.choice(inside)
        words = lines[n].split() or ["0"]
        if what == "cut":
            text = cut(rng, text + "\n")
            more = f"cut after {len(text)} characters"
        elif what == "lines":
            lines, more = change_lines(rng, lines)
            text = "\n".join(lines)
        elif what == "mesh":
            lines, more = change_mesh(rng, lines)
            text = "\n".join(lines)
        elif what == "number":
            text, more = replace_number(rng, text)
        elif what in ("coordinate", "id", "shuffled"):
            old = lines[n]
            if what == "shuffled":
                rng.shuffle(words)
            else:
                value = rng.choice(("nan", "inf", "1e308", "-1e308", "0", "1e-320", "0.5") if what == "coordinate" else
                                   ("0", "-1", "1", "5", "999999", "2147483647", "4294967296", "99999999999", "9" * 18,
                                    "9" * 20))  # fmt: skip
                words[rng.randrange(len(words)) if what == "id" else -1] = value
            lines[n] = " ".join(words)
            text, more = "\n".join(lines), f"line {n + 1}: '{old[:60]}' -> '{lines[n][:60]}'"
        elif what == "section":
            name = rng.choice(re.findall(r"^\$(?!End)(\w+)", text, re.M) or ["Nodes"])
            whole = re.compile(rf"\${name}\n.*?\$End{name}\n?", re.S)
            more = rng.choice(("removed", "doubled", "without end", "without begin", "emptied", "moved to the end", "renamed"))
            found = whole.search(text)
            part = found[0] if found else ""
            text = {"removed": whole.sub("", text), "doubled": text + "\n" + part,
                    "without end": text.replace(f"$End{name}", ""),
                    "without begin": text.replace(f"${name}\n", ""),
                    "emptied": text.replace(part, f"${name}\n$End{name}\n") if part else text,
                    "moved to the end": text.replace(part, "") + "\n" + part if part else text,
                    "renamed": text.replace(f"${name}", "$Other")}[more]  # fmt: skip
            more = f"section {name} {more}"
        elif what == "inner count":
            lines, more = change_inner_count(rng, lines)
            text = "\n".join(lines)
        elif what == "count":
            heads = [m for m in re.finditer(r"^\$(?:Nodes|Elements|Entities|PhysicalNames)\n(.*)$", text, re.M)]
            if not heads:
                continue
            head = rng.choice(heads)
            counts = head[1].split() or ["0"]
            counts[rng.randrange(len(counts))] = rng.choice(("0", "-1", "1", "1000000", "1000000000", "9000000000000000000",
                                                             "9" * 20, "nan", ""))
            text = text[: head.start(1)] + " ".join(counts) + text[head.end(1) :]
            more = f"counts '{head[1][:60]}' -> '{' '.join(counts)}'"
        elif what == "format":
            new = rng.choice(("2.2 1 8", "4.1 1 8", "2.2 0 8", "4.1 0 8", "4.0 0 8", "9.9 0 8", "1.0 0 8", "2.2 0 4", "",
                              "nan 0 8", "2.2"))
            text, more = re.sub(r"(\$MeshFormat\n).*", lambda m: m[1] + new, text), f"format '{new}'"
        elif what == "bytes":
            data = flip_bytes(rng, text.encode(errors="surrogateescape"))
            text, more = data.decode(errors="surrogateescape"), "bytes changed"
        else:
            more = rng.choice(("CRLF", "CR", "one line", "blank lines", "empty", "only blanks", "decimal commas",
                               "a long line"))
            text = {"CRLF": text.replace("\n", "\r\n"), "CR": text.replace("\n", "\r"), "one line": text.replace("\n", " "),
                    "blank lines": text.replace("\n", "\n\n"), "empty": "", "only blanks": " \n" * 1000,
                    "decimal commas": text.replace(".", ","), "a long line": "1" * 1000000 + "\n" + text}[more]  # fmt: skip
        change += "; " + more
        if not text:
            break
    return {"case.prm": prm(tree).encode(), "mesh.msh": text.encode(errors="surrogateescape")}, ["case.prm"], change


def checkpoint_cases():
    """Cases whose last checkpoint has an increment after it: name -> tree."""
    cases = {}
    for name in ("two_blocks", "driven_plate"):
        tree = base(name)
        put(tree, "Output/Checkpoint interval", "2")
        put(tree, "Load stepping/Interval ends", "1, 2")
        put(tree, "Load stepping/Increments", "1, 4")
        cases[name] = tree
    put(cases["driven_plate"], "Body 2/Rigid free", "z")
    put(cases["driven_plate"], "Contact pair 1/Scheme", "integration point")
    put(cases["driven_plate"], "Body 1/Material", {"Law": "J2 plasticity", "Young's modulus": "1000", "Yield stress": "1",
                                                   "Hardening modulus": "100"})  # fmt: skip
    return cases


def checkpoint_input(rng, finished):
    """finished: name of a checkpoint_cases() -> its files after the run."""
    name = rng.choice(sorted(finished))
    files = dict(finished[name])
    inside = sorted(path for path in files if "/checkpoints/" in path)
    arguments, change = ["case.prm", "--restart"], name
    for _ in range(rng.choice((1, 1, 2, 4))):
        if not inside:
            break
        path = rng.choice(inside)
        short = "/".join(path.split("/")[-2:])
        what = rng.choice(("cut", "cut", "bytes", "bytes", "removed", "removed", "swapped", "emptied", "folder", "index",
                           "index", "index",
                           "index", "extra", "renamed", "checkpoints", "tables", "setting", "setting", "case"))  # fmt: skip
        more = f"{short} {what}"
        data = files.get(path) or b"x"
        if what == "cut":
            files[path] = cut(rng, data)
        elif what == "bytes":
            files[path] = flip_bytes(rng, data)
        elif what == "removed":
            files.pop(path, None)
        elif what == "swapped":
            other = rng.choice(inside)
            files[path], files[other] = files.get(other) or b"", data
            more += " with " + "/".join(other.split("/")[-2:])
        elif what == "emptied":
            files[path] = b""
        elif what == "folder":
            files[path] = None
        elif what == "index":
            path = os.path.join(os.path.dirname(path), "index")
            text = (files.get(path) or b"x").decode(errors="replace")
            if rng.random() < 0.6:
                lines, how = change_lines(rng, text.split("\n"))
                text = "\n".join(lines)
            else:
                text, how = replace_number(rng, text)
            files[path] = text.encode()
            more = f"{'/'.join(path.split('/')[-2:])}: {how}"
        elif what == "extra":
            extra = rng.choice(("piece.9999", "piece.0000~", "piece.0001", "common.old", "000001/index", "000007",
                                "x.incomplete"))
            files[os.path.join(os.path.dirname(path), extra)] = rng.choice((b"", b"garbage", data))
            more = f"{os.path.dirname(short)}/{extra} added"
        elif what == "renamed":
            files[path + "x"] = files.pop(path, b"")
        elif what == "checkpoints":
            old = path.split("/")[-2]
            new = rng.choice(("000001", "000009", "999999999", "9999999999999", "0", "7", "-1"))
            files = {p.replace(f"/checkpoints/{old}/", f"/checkpoints/{new}/"): d for p, d in files.items()}
            inside = sorted(p for p in files if "/checkpoints/" in p)
            more = f"checkpoint {old} is called {new}"
        elif what == "tables":
            names = sorted(p for p in files if p.endswith((".csv", ".pvd", ".vtu")))
            if not names:
                continue
            path = rng.choice(names)
            files[path] = rng.choice((b"", cut(rng, files[path] or b"x"), b"garbage\n", None))
            more = f"{os.path.basename(path)} changed"
        elif what == "setting":
            key, value = random_setting(rng, common.nodus.prm.parse(files["case.prm"].decode()))
            arguments += ["--set", f"{key}={value}"[:100000]]
            more = f"--set {key}={value[:60]}"
        else:
            text, more = replace_number(rng, files["case.prm"].decode())
            files["case.prm"] = text.encode()
        change += "; " + more
    return files, arguments, change


OPERATORS = ("+", "-", "*", "/", "^", "<", ">", "<=", ">=", "==", "!=", "&&", "||")
FUNCTIONS = (
    "sin", "cos", "tan", "sqrt", "exp", "log", "log10", "abs", "sign", "rint", "erfc", "asin", "acosh", "cot", "floor",
    "ceil", "int", "atan2", "min", "max", "pow", "if", "sum", "avg",
)  # fmt: skip
SPECIAL_EXPRESSIONS = (
    "0/0", "1/0", "-1/0", "if(t>0.5, 0/0, 0)", "if(t>0.5, 1/0, 0)", "if(x>0.5, 0/0, 0)", "sqrt(x-0.5)", "sqrt(0.7-t)",
    "log(t)", "log(-1)", "1/(t-0.75)", "1e308*10", "1e308*t", "-1e300", "1e300", "1e-320", "1e999", "t^1000", "exp(1000*t)",
    "10^(300*t)", "(-1)^0.5", "0^-1", "", " ", "(", ")", "()", "1 +", "+", "* 2", "1 2", "2 x", "2x", "x = 1", "t = 2",
    "x += 1", "pi = 3", "1;2;3;4", ";", ";;", "0;0;0", "0; 0; -0.01*t; 0", "foo(x)", "foo", "sin", "sin()", "sin(1,2)",
    "if(1,2)", "min()", "sum()", "pi()", "x?y:z", "1 ? 2", "1 : 2", "x^^2", "x**2", "!x", "~x", "\"a\"", "'a'", "\"a",
    "0x10", "#1", "$x", "x[0]", "a.b", "x,y", "\u03c0", "\u00e9", "\u22121", "x\u00a0+1", "\\", "v", "n", "y", "X", "e",
    "_pi", "_e", "rand()", "rand_seed(1)", "1//2", "1e", "1e+", ".", ".5", "5.", "--1", "-(-(-t))", "nan", "inf",
    "t>1e308 || 0/0", "min(t, 0/0)", "max(0/0, 1)", "0*(1/0)", "1e200*1e200-1e200*1e200", "if(t<0, foo, 1)", "asin(2*t)",
    "erfc(-1e300)",
)  # fmt: skip


def random_expression(rng, variables, depth):
    if depth == 0 or rng.random() < 0.15:
        return rng.choice(tuple(variables) + ("0", "1", "2", "0.01", "-0.01", "pi", "1e-3", "1e3", "1e30", "1e300"))
    parts = [random_expression(rng, variables, depth - 1) for _ in range(3)]
    choice = rng.random()
    if choice < 0.5:
        return f"({parts[0]} {rng.choice(OPERATORS)} {parts[1]})"
    if choice < 0.6:
        return f"({parts[0]} ? {parts[1]} : {parts[2]})"
    if choice < 0.65:
        return "-" + parts[0]
    function = rng.choice(FUNCTIONS)
    n = {"if": 3, "atan2": 2, "min": 2, "max": 2, "pow": 2, "sum": 3, "avg": 2}.get(function, 1)
    if rng.random() < 0.03:
        n = rng.randint(0, 3)
    return f"{function}({', '.join(parts[:n])})"


def expression(rng, variables):
    """An expression, and in words what kind it is."""
    choice = rng.random()
    if choice < 0.35:
        of_slip = ("1/v", "-v", "1e300*v", "if(v>1e-9, 0/0, 1)", "if(v>1e-3, -1, 1)") if "v" in variables else ()
        return rng.choice(SPECIAL_EXPRESSIONS + 8 * of_slip), "special"
    if choice < 0.75:
        return random_expression(rng, variables, rng.randint(1, 5)), "random"
    if choice < 0.8:
        text = random_expression(rng, variables, 3)
        n = rng.randrange(len(text))
        return rng.choice((text[:n], text[:n] + text[n + 1 :],
                           text[:n] + rng.choice("()+*/=;,!\"'{}[]x5e.") + text[n:])), "damaged"
    n = rng.choice((200, 200, 2000, 20000))
    forms = ("(" * n + "t" + ")" * n, "sin(" * n + "t" + ")" * n, "-" * n + "t", "(" * n, "+".join(["t"] * n),
             "^".join(["t"] * n), "if(t>0," * n + "1" + ",0)" * n, "t" * n, "1" * n,
             "max(" + "t," * n + "t)", "t>0?" * n + "1" + ":0" * n, "0.01*(1+" * n + "t" + ")" * n)  # fmt: skip
    form = rng.randrange(len(forms))
    return forms[form], f"form {form} {n} times"


EXPRESSION_KEYS = (
    ("two_blocks", "Boundary condition 2/Value", "xt"), ("two_blocks", "Boundary condition 2/Value", "xt"),
    ("two_blocks", "Boundary condition 2/Where", "x"), ("two_blocks", "Boundary condition 1/Where", "x"),
    ("two_blocks", "Contact pair 1/Slave where", "x"), ("two_blocks", "Contact pair 1/Master where", "x"),
    ("two_blocks", "Contact pair 1/Friction factor", "xv"), ("two_blocks", "Contact pair 1/Friction factor", "xv"),
    ("two_blocks", "Body 1/Refine where", "x"), ("rigid_plane", "Contact pair 1/Master translation", "t"),
    ("rigid_plane", "Contact pair 1/Master rotation", "t"), ("driven_plate", "Body 2/Rigid force", "t"),
    ("driven_plate", "Body 2/Rigid moment", "t"), ("driven_plate", "Body 2/Rigid translation", "t"),
    ("driven_plate", "Body 2/Rigid rotation", "t"), ("driven_plate", "Boundary condition 2/Value", "xt"),
    ("carried_plane", "Body 2/Rigid force", "t"), ("free_block", "Boundary condition 2/Value", "xt"),
)  # fmt: skip


def expression_input(rng):
    name, key, variables = rng.choice(EXPRESSION_KEYS)
    tree = base(name)
    text, what = expression(rng, variables)
    components = 1
    if key.endswith(("translation", "force", "moment")) or (key.endswith("Value") and name == "two_blocks"):
        components = 3
    if components == 3 and ";" not in text and rng.random() < 0.9:
        text = "0; 0; " + text if rng.random() < 0.7 else text + "; 0; 0"
    put(tree, key, text)
    if rng.random() < 0.6:
        steps = str(rng.randint(1, 4))
        put(tree, "Load stepping/Increments", "1, " + steps if name == "two_blocks" else steps)
    if key.endswith("Refine where"):
        put(tree, "Body 1/Local refinement", "1")
    if name == "two_blocks" and key.endswith("Value") and rng.random() < 0.4:
        put(tree, "Boundary condition 2/Type", rng.choice(("traction", "body force", "spring", "pressure")))
    if key.endswith("rotation") and name == "driven_plate":
        put(tree, "Body 2/Rigid rotation axis", "0, 0, 1")
        put(tree, "Body 2/Rigid free", rng.choice(("z", "")))
    if key.endswith("Rigid translation"):
        put(tree, "Body 2/Rigid free", "rx")
    return {"case.prm": prm(tree).encode()}, ["case.prm"], f"{name}; {key} = {text[:120]} ({what})"


def set_input(rng):
    Reference.keys()
    name = rng.choice(BASES)
    tree, arguments = base(name), []
    for _ in range(rng.choice((1, 1, 1, 2, 3, 4))):
        key, value = random_setting(rng, tree)
        form = rng.random()
        text = f"{key}={value}" if form < 0.95 else rng.choice((key, "=" + value, f"/{key}={value}", f"{key}//={value}",
                                                                f"{value}={key}"))
        arguments += ["--set", text[:100000]]  # the system takes no more
    if rng.random() < 0.3:
        name_of_generator, values = rng.choice(Reference.generators)
        for _ in range(rng.choice((0, 1, 1, 2))):
            values, _ = replace_number(rng, values)
        arguments = ["--set", f"Body 1/Generator={name_of_generator}", "--set", f"Body 1/Generator arguments={values}"]
    change = " ".join(argument[:120] for argument in arguments[1::2])
    return {"case.prm": prm(tree).encode()}, ["case.prm"] + arguments, f"{name}; {change}"


def make(number, seed, finished):
    """Input `number`, 1, 2, ... of a seed."""
    kind = KINDS[(number - 1) % len(KINDS)]
    rng = random.Random(f"{seed} {number}")
    if kind == "checkpoint":
        files, arguments, change = checkpoint_input(rng, finished())
    else:
        makers = {"prm": prm_input, "json": json_input, "msh": msh_input, "expression": expression_input, "set": set_input}
        files, arguments, change = makers[kind](rng)
    return Input(number, kind, files, arguments, change)
