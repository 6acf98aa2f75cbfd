#!/usr/bin/python3
"""Keys of a case: what is refused at the line that sets it, the same as the program refuses; files that are read and written."""

import glob
import json
import os
import re
import subprocess

import numpy as np

from harness import NODUS, SOURCE, check, nodus, refused, run

PROGRAM = nodus.Program(NODUS)


def put(path, value):
    nodus.Case(program=PROGRAM)[path] = value


def test_reference():
    """The keys are those of contrib/doc/parameters.md, and each takes its own default."""
    with open(os.path.join(SOURCE, "contrib", "doc", "parameters.md"), encoding="utf-8") as file:
        page = file.read()
    rows = re.findall(r"^\| ([^|]*) \| ([^|]*)\| ([^|]*) \| (.*) \|$", page.split("\n## Generators")[0], re.M)
    rows = [[re.sub(r"\\(.)", r"\1", cell.strip()) for cell in row] for row in rows if row[0] != "Key"]
    keys = list(PROGRAM.reference.keys.values())
    check("keys", len(keys), len(rows))
    same = [[key.path.split("/")[-1], key.default, key.allowed, key.meaning] == row for key, row in zip(keys, rows)]
    check("keys as on the page", sum(same), len(rows))
    check("defaults that their keys take", sum(key.text(key.value(key.default)) is not None for key in keys), len(keys))
    kinds = {key.kind["kind"] for key in keys} | {key.kind["of"]["kind"] for key in keys if "of" in key.kind}
    check("kinds", ", ".join(sorted(kinds)), "bool, choice, file, id or name, integer, list, number, text")
    check("unit of Young's modulus", PROGRAM.reference["Body 3/Material/Young's modulus"].unit, "pressure")
    check("choices", PROGRAM.reference["Contact pair 1/Contact law"].choices, ("unilateral", "bilateral", "tied"))
    check("generators", len(PROGRAM.reference.generators), len(re.findall(r"^\| [a-zA-Z_]+ \| .* \| `.*` \|$", page, re.M)))


def test_plug_ins():
    """Keys of a plug-in are known once it is loaded; what is wrong with one is said at the line that sets it."""
    folder = os.path.join(os.path.dirname(NODUS), "tests", "plugins")
    library = os.path.relpath(os.path.join(folder, "libkirchhoff.so"))
    case = nodus.Case(program=PROGRAM)
    modulus = "Body 1/Material/Kirchhoff with moduli/Shear modulus"
    refused("unknown key or section 'Kirchhoff with moduli' in 'Body 1/Material'", case.__setitem__, modulus, 4)
    case["Additional shared libraries"] = [library]
    case[modulus] = 4
    case["Body 1/Material/Law"] = "Kirchhoff with moduli"
    check("unit of its key", case.reference[modulus].unit, "pressure")
    os.makedirs("below", exist_ok=True)
    case.write("below/plug_in.prm")
    again = nodus.Case.read("below/plug_in.prm", program=PROGRAM)
    check("its key in a file elsewhere", again[modulus], 4.)
    check("in a copy", again.copy()[modulus], 4.)
    check("a case without it does not know the key", "Kirchhoff with moduli" in repr(nodus.Case(program=PROGRAM).explain("Law")), False)
    for name, words in (("nowhere.so", "nowhere.so"), (os.path.join(folder, "libnothing.so"), "libnothing.so")):
        refused(words, nodus.Case(program=PROGRAM).__setitem__, "Additional shared libraries", name)
    check("the plug-in's own case", nodus.Case.read(os.path.join(folder, "block.prm"), program=PROGRAM)["Load stepping/Increments"], (4,))


def test_program():
    """By argument, by NODUS, in PATH."""
    os.symlink(NODUS, "nodus")
    here, path = os.path.join(os.getcwd(), "nodus"), os.environ["PATH"]
    check("argument", nodus.Program("./nodus").path, here)
    os.environ["PATH"] = os.getcwd() + os.pathsep + path
    os.environ.pop("NODUS", None)
    check("PATH", nodus.Program().path, here)
    os.environ["NODUS"] = NODUS
    check("NODUS", nodus.Program().path, NODUS)
    os.environ["NODUS"] = "nowhere"
    refused("there is no program 'nowhere', which the environment variable NODUS names", nodus.Case)
    os.environ["PATH"] = path
    del os.environ["NODUS"]
    refused("there is no program 'nowhere', which program names", nodus.Case, program="nowhere")
    refused("does not know --document-json: it is no nodus", nodus.Case, program="/bin/false")


def test_errors_at_the_line():
    refused("unknown key or section 'Materail' in 'Body 1'; did you mean 'Material'?", put, "Body 1/Materail/Law", "Ogden")
    refused("unknown key or section 'Young modulus' in 'Body 2/Material'; did you mean 'Young's modulus'?",
            put, "Body 2", {"Name": "block", "Material": {"Young modulus": 1}})
    refused("'Friction coefficient' at the top level; did you mean 'Contact pair <n>/Friction coefficient'?",
            put, "Friction coefficient", 0.3)
    refused("unknown key or section 'Body 0' at the top level; did you mean 'Body <n>'?", put, "Body 0/Name", "block")
    refused("'Increments' in 'Load stepping' is a key and has no 'first'", put, "Load stepping/Increments/first", 1)
    refused("'neo-Hokean' is no value of 'Body 1/Material/Law'", put, "Body 1/Material/Law", "neo-Hokean")
    refused("did you mean 'neo-Hookean'?", put, "Body 1/Material/Law", "neo-Hokean")
    modulus = "Body 1/Material/Young's modulus"
    for value in ("soft", -1, True, float("nan"), float("inf"), [1, 2], None, {}, "1e", "0x10", "1_000", 1j):
        refused(f"{value!r} is no value of '{modulus}': give a number >= 0", put, modulus, value)
    refused("0 is no value of 'Body 1/Scale': give a number > 0", put, "Body 1/Scale", 0)
    refused("2.5 is no value of 'Load stepping/Increments': give a list separated by ',', each a whole number >= 1", put,
            "Load stepping/Increments", 2.5)
    refused("3 is no value of 'Discretization/Degree': give a whole number >= 1 and <= 2", put, "Discretization/Degree", 3)
    refused("[1, 2] is no value of 'Body 1/Translation': give 3 entries", put, "Body 1/Translation", [1, 2])
    refused("no entry of which holds a ';'", put, "Boundary condition 1/Value", ["0; 1", 2])
    refused("1 is no value of 'Output/Write VTU': give true or false", put, "Output/Write VTU", 1)
    for value in (-1, 1.5, [1, -2], True, "nan", 2**31):
        refused("give a list separated by ',', each a whole number >= 0 or a name", put, "Body 1/Volume ids", value)
    refused("in one line, without '#'", put, "Title", "case # 3")
    refused("'hyper_ractangle' is no generator; did you mean 'hyper_rectangle'?", put, "Body 1/Generator", "hyper_ractangle")
    refused("'Newton' is a section: give a dictionary of its keys", put, "Newton", 3)
    refused("'Newton' is a section; its keys are", lambda: PROGRAM.reference["Newton"])
    refused("there is no key like 'frictoin'; did you mean 'Friction law'?", PROGRAM.reference.find, "frictoin")

    case = nodus.Case(program=PROGRAM)
    refused("'Matreial'", case.__setitem__, "Body 1", {"Name": "block", "Matreial": {}})
    check("nothing is changed by what is refused", (len(case), "Body 1" in case, case.get("Body 1/Name")), (0, False, None))
    refused("did you mean 'Name'?", case.get, "Body 1/Nmae")
    refused("'Body 1/Name' is not set; the default is ''", lambda: case["Body 1/Name"], kind=KeyError)
    case["Body 2/Name"] = "block"
    refused("there is a 'Body 2' but no 'Body 1'", case.text)


def test_values():
    """Every form of a value becomes the text that the program reads."""
    for path, value, text in (
            ("Body 1/Generator arguments", [[3, 3, 2], [0, 0, 0], np.array([1, 1, 0.5]), True],
             "3,3,2 : 0,0,0 : 1.0,1.0,0.5 : true"),
            ("Body 1/Generator arguments", [[[0, 0, 0], [1, 0, 0]], False], "0,0,0; 1,0,0 : false"),
            ("Body 1/Translation", (0, 0.25, 1e-7), "0, 0.25, 1e-07"), ("Body 1/Translation", np.arange(3), "0, 1, 2"),
            ("Body 1/Rigid", np.bool_(True), "true"), ("Body 1/Volume ids", 4, "4"), ("Body 1/Volume ids", [], ""),
            ("Boundary condition 1/Value", [0, "-0.1*t", 1.5], "0; -0.1*t; 1.5"), ("Boundary condition 1/Value", 0, "0"),
            ("Boundary condition 1/Components", "x, z", "x, z"), ("Boundary condition 1/Components", ["y"], "y"),
            ("Boundary condition 1/Boundary ids", [4, "upper ring"], "4, upper ring"),
            ("Contact pair 1/Slave boundary ids", "seal_outer", "seal_outer"),
            ("Contact pair 1/Friction coefficient", np.float32(0.5), "0.5"), ("Newton/Force tolerance", "1e-9", "1e-9"),
            ("Body 1/Material/Young's modulus", 0.1 + 0.2, "0.30000000000000004")):
        check(f"{path} = {value!r}".replace("\n", ""), PROGRAM.reference[path].text(value), text)
    case = nodus.Case("a block", program=PROGRAM)
    numbers = [1, 2]
    case["Body 1/Volume ids"] = numbers
    numbers.append(-3)
    case["Body 1"].update({"Material/Law": "Ogden", "Material/Ogden moduli": [1.5, 2]})
    check("text", case.text(), "set Title = a block\nsubsection Body 1\n  set Volume ids = 1, 2\n  subsection Material\n"
                               "    set Law = Ogden\n    set Ogden moduli = 1.5, 2\n  end\nend\n")
    other = case.copy()
    del other["Body 1/Material"]
    other["Body 1/Name"] = "other"
    check("a copy is another case", (len(case["Body 1"]), sorted(other["Body 1"])), (2, ["Name", "Volume ids"]))
    check("notebooks", case._repr_html_().count("<tr>"), 5)
    check("explained", len(case.explain("friction coefficient")), 2)


def test_verdict_of_the_program():
    """For one key of each kind: what is refused here is what the program refuses, for the same reason."""
    prm = os.path.join(SOURCE, "tests", "parameters", "every_key.prm")
    chosen = {key.allowed: key for key in PROGRAM.reference.keys.values()}
    numbers = ("-1", "0.5", "3", "1e9", "x")
    values = {"number": numbers, "integer": numbers, "bool": ("true", "yes", "1"), "choice": ("no such", ""), "text": ("a b", ""),
              "file": ("a b",), "id or name": ("2", "lid", "-1", "0.5", ""), "list": ("", "0.5", "1, 2, 3", "-1; x", "x", "1,,2", "4, upper ring", "inf")}
    here = {}
    for key in chosen.values():
        first = key.choices[:1] if key.kind["kind"] != "list" else (", ".join(key.choices[:2]),) if key.choices else ()
        for value in (*first, *values[key.kind["kind"]]):
            try:
                key.text(value)
                taken = True
            except nodus.InputError:
                taken = False
            here[f"{key.path.replace('<n>', '1')}={value}"] = taken
    program = os.path.join(os.path.dirname(NODUS), "tests", "python", "verdicts")
    done = subprocess.run([program, prm], input="\n".join(here) + "\n", stdout=subprocess.PIPE, text=True, check=True,
                          env=nodus.program.environment())
    there = done.stdout.splitlines()
    check("verdicts", len(there), len(here))
    different = [f"{assignment}: {'taken' if taken else 'refused'} here   NO: {verdict}"
                 for (assignment, taken), verdict in zip(here.items(), there)
                 if taken != (f"is '{assignment.split('=', 1)[1]}'; give " not in verdict)]
    if different:
        print(*different, sep="\n")
    check(f"values of {len(chosen)} keys with the same verdict", len(here) - len(different), len(here))


def test_files():
    """All cases of the project are read; written and read again they are the same."""
    folders = [os.path.join(SOURCE, *names) for names in (("prm",), ("prm", "gallery"), ("contrib", "examples", "own_program"))]
    paths = [path for folder in folders for path in sorted(glob.glob(os.path.join(folder, "*.prm")))]
    paths.append(os.path.join(SOURCE, "tests", "parameters", "every_key.prm"))
    same = 0
    for path in paths:
        case = nodus.Case.read(path, program=PROGRAM)
        again = [nodus.Case.read(case.write("again" + ending), program=PROGRAM) for ending in (".prm", ".json")]
        same += all(dict_of(other, ".") == dict_of(case, ".") for other in again)
    check("cases of the project", same, len(paths))
    parameters = os.path.join(SOURCE, "tests", "parameters")
    two = [nodus.Case.read(os.path.join(parameters, "two_blocks" + ending), program=PROGRAM) for ending in (".prm", ".json")]
    check("two_blocks.json as two_blocks.prm", [case.check() for case in two][0] == two[1].check(), True)
    with open(os.path.join(parameters, "two_blocks.summary"), encoding="utf-8") as file:
        summary = file.read()
    case = two[0].copy()
    case["Contact pair 1/Friction coefficient"] = 0.3
    lines = set(case.check().splitlines()) ^ set(summary.splitlines())
    check("summary of the program, lines that differ", sorted(line.split(":")[0].strip() for line in lines), ["results", "results"])
    case["Body 1/Material/Poisson's ratio"] = 0.5
    refused("'Poisson's ratio' in 'Body 1/Material'", case.check)
    refused("unknown_key.prm: unknown key", nodus.Case.read, os.path.join(parameters, "unknown_key.prm"), program=PROGRAM)
    refused("not_a_statement.prm:", nodus.Case.read, os.path.join(parameters, "not_a_statement.prm"), program=PROGRAM)
    refused("missing_end.prm: a subsection has no 'end'", nodus.Case.read, os.path.join(parameters, "missing_end.prm"),
            program=PROGRAM)
    refused("json_missing_comma.json:", nodus.Case.read, os.path.join(parameters, "json_missing_comma.json"),
            program=PROGRAM)

    os.makedirs("cases/meshes")
    here = nodus.Case(program=PROGRAM)
    here["Body 1/Mesh file"] = "part.msh"
    here.write("cases/deep.prm")
    check("a mesh file, as the case in another folder names it", nodus.prm.read("cases/deep.prm")["Body 1"]["Mesh file"],
          os.path.join("..", "part.msh"))
    nodus.Case.read("cases/deep.prm", program=PROGRAM).write("cases/meshes/deeper.json")
    with open("cases/meshes/deeper.json", encoding="utf-8") as file:
        check("... and in a third one", json.load(file)["Body 1"]["Mesh file"], os.path.join("..", "..", "part.msh"))
    check("files that are left incomplete", glob.glob("**/*.incomplete", recursive=True), [])


def dict_of(case, folder):
    return nodus.prm.parse(case.text(folder))


run(test_reference, test_plug_ins, test_program, test_errors_at_the_line, test_values, test_verdict_of_the_program, test_files)
