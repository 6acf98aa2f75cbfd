#!/usr/bin/python3
"""contrib/convert against closed forms, and its messages: convert.py SOURCE_FOLDER [NODUS]

Prints what is measured beside what is expected; exit code 1 where something is not as expected. With NODUS a converted
mesh is also run.
"""

import os
import re
import subprocess
import sys
import tempfile

sys.dont_write_bytecode = True  # no __pycache__ in the sources

import numpy as np

import decks
from harness import SOURCE, TOOL, Result, check, failures, refused


def solid(kind, deck, place, more=""):
    """Text of a deck from nodes and elements, with all elements in ALL."""
    return deck[0].text(place) + decks.elements_text(kind, deck[1], more=", ELSET=ALL") + more


def straight(p):
    return p


def test_boxes():
    """Sets and surfaces in every way to write them, on a box of 3 x 3 x 3."""
    nodes, elements = decks.box("C3D8", 3)
    bottom = [n for n, p in enumerate(nodes.points, 1) if p[2] == 0]
    with open("low.inc", "w", encoding="utf-8") as file:
        file.write("** of another file\n*elset, elset=Row\n 1, 2,\n 3\n")
    elements[4] = [elements[4][i] for i in (4, 5, 6, 7, 0, 1, 2, 3)]  # mirrored as a whole
    text = ("*HEADING\na box, 1, 2\n** comment\n" + nodes.text().replace("*NODE", "*Node , nset=Everything")
            + decks.elements_text("C3D8R", elements, more=",\n Elset = Body") + "*INCLUDE, INPUT=low.inc\n"
            "*ELSET, ELSET=top layer, GENERATE\n 19, 27\n*Elset, elset=Both\nRow, TOP LAYER,\n"
            "*Nset, nset=Floor\n" + ",\n".join(map(str, bottom)) + "\n*NSET, NSET=EDGE\n1, 2\n*NSET, NSET=VOID\n"
            "*SURFACE, NAME=Lid, TYPE=ELEMENT\ntop layer, s2\n*SURFACE, NAME=Front\nrow, S3\n10, S3\n"
            "*SURFACE, NAME=FLOOR_NODES, TYPE=NODE\nFLOOR,\n*MATERIAL, NAME=A\n*ELASTIC\n1., 0.3\n*STEP\n*STATIC\n*END STEP\n")
    result = Result("box", text)
    check("box, exit code", str(result.code) + result.error, "0")
    for name, cells in (("Body", 27), ("Row", 3), ("top layer", 9), ("Both", 12)):
        check(f"box, cells of {name}", result.volumes[name][1], cells)
        check(f"box, volume of {name}", result.volumes[name][2], cells / 27, 1e-5)
    for name, faces in (("Lid", 9), ("Front", 4), ("Floor = FLOOR_NODES", 9), ("(none)", 32)):
        check(f"box, faces of {name}", result.surfaces[name][1], faces)
        check(f"box, area of {name}", result.surfaces[name][2], faces / 9, 1e-5)
    for line in result.log.splitlines():
        if re.match(" +(skipped|warning|1 )", line):
            print(line)
    check("box, mirrored", str("  1 elements were mirrored" in result.log), "True")
    check("box, set without nodes", str("node set VOID is empty" in result.log), "True")
    check("box, set without faces", str("takes places): EDGE" in result.log), "True")
    check("box, skipped", re.search("skipped: .*", result.log).group(),
          "skipped: *ELASTIC 1, *END STEP 1, *MATERIAL 1, *STATIC 1, *STEP 1")
    result.check_fit("box")
    result = Result("box", text, "--refine")
    check("box refined, cells", result.volumes["Body"][1], 216)
    check("box refined, faces of Lid", result.surfaces["Lid"][1], 36)
    result.check_fit("box refined")


def test_round():
    """Curved sides are kept: errors are those of second-order geometry, of fourth order."""
    last = {}
    for n in (2, 4):
        for name, kind, make, place, volume, area in (
                ("ball", "C3D10", decks.ball, decks.round_out, 4 / 3 * np.pi, 4 * np.pi),
                ("rod", "C3D15", decks.rod, decks.round_about_z, np.pi, 4 * np.pi)):
            result = Result(name, solid(kind, make(kind, n), place))
            error = result.volumes["ALL"][2] / volume - 1, result.surfaces["(none)"][2] / area - 1
            print(f"{name}, n = {n}: {result.volumes['ALL'][1]} cells, errors of volume {error[0]:.2e}, area {error[1]:.2e}")
            if n == 4:
                check(f"{name}, volume", result.volumes["ALL"][2], volume, 2e-3)
                check(f"{name}, area", result.surfaces["(none)"][2], area, 1e-3)
                check(f"{name}, order of the volume above 3", str(np.log2(last[name] / error[0]) > 3), "True")
                check(f"{name}, nodes of a cell", re.search(r"hexahedra of (\d+) nodes, ", result.log).group(1), "27")
                result.check_fit(name)
            last[name] = error[0]
    result = Result("ring", solid("C3D20", decks.box("C3D20", 3), lambda p: np.array(
        [(1 + p[0]) * np.cos(p[1]), (1 + p[0]) * np.sin(p[1]), p[2]]), "*SURFACE, NAME=OUT\nALL, S4\n"), "--pieces")
    check("ring of 20 nodes, volume", result.volumes["ALL"][2], 1.5, 5e-5)
    result = Result("ring", open("ring.inp", encoding="utf-8").read(), "--straight", "--refine", "--first")
    check("ring, straight and refined, volume", result.volumes["ALL"][2], 1.5 * 6 * np.sin(1 / 6), 1e-4)
    check("ring, straight and refined, cells", result.volumes["ALL"][1], 216)


def test_kinds():
    """A cube of every kind, with its least scaled Jacobian; middles that are straight are not written."""
    for kind, cells, quality in (("C3D8", 8, 1.), ("C3D20", 8, 1.), ("C3D4", 192, None), ("C3D10", 192, None),
                                 ("C3D6", 48, None), ("C3D15", 48, None)):
        result = Result("cube", solid(kind, decks.box(kind, 2), straight))
        check(f"cube of {kind}, cells", result.volumes["ALL"][1], cells)
        check(f"cube of {kind}, volume", result.volumes["ALL"][2], 1, 1e-5)
        check(f"cube of {kind}, area", result.surfaces["(none)"][2], 6, 1e-5)
        result.check_fit(f"cube of {kind}")
        least = float(re.search(r"scaled Jacobian: (\S+)", result.log).group(1))
        check(f"cube of {kind}, least scaled Jacobian {least} positive", str(least > 0.3), "True")
        check(f"cube of {kind}, nodes of a cell", re.search(r"hexahedra of (\d+) nodes, ", result.log).group(1), "8")
    nodes, elements = decks.box("C3D20", 1)
    nodes.points[nodes.number((0.5, 0, 0)) - 1] = (0.5, -0.1, 0)
    for kind, order in (("C3D20", range(20)), ("C3D27", range(27))):
        whole = elements[0] if kind == "C3D20" else elements[0] + [nodes.number(p) for p in (
            (.5, .475, .5), (.5, .45, 0), (.5, .5, 1), (.5, -.05, .5), (1, .5, .5), (.5, 1, .5), (0, .5, .5))]
        result = Result("one", nodes.text() + decks.elements_text(kind, [[whole[i] for i in order]], more=", ELSET=ALL"))
        check(f"one {kind}, its side bulges by 0.1 at an edge", result.volumes["ALL"][2], 1 + 2 / 3 * 0.1 / 2, 1e-5)


def test_mixtures():
    """Hexahedra beside wedges beside tetrahedra are divided so that they fit."""
    for kinds in (("C3D8", "C3D6", "C3D4"), ("C3D20", "C3D15", "C3D10"), ("C3D20", "C3D6", "C3D10")):
        name = " ".join(kinds)
        result = Result("mixture", decks.mixture(kinds))
        for group, cells, volume in (("BLOCK", 48, 6), ("WEDGES", 12, 1), ("ROOF", 8, 1 / 3)):
            check(f"{name}, cells of {group}", result.volumes[group][1], cells)
            check(f"{name}, volume of {group}", result.volumes[group][2], volume, 1e-5)
        check(f"{name}, area below", result.surfaces["BELOW"][2], 7, 1e-5)
        check(f"{name}, area far off", result.surfaces["FAR"][2], 1, 1e-5)
        result.check_fit(name)


ASSEMBLY = """*PART, NAME=Brick
*NODE
1, 0, 0, 0
2, 2, 0, 0
3, 2, 1, 0
4, 0, 1, 0
5, 0, 0, 1
6, 2, 0, 1
7, 2, 1, 1
8, 0, 1, 1
*ELEMENT, TYPE=C3D8
1, 1, 2, 3, 4, 5, 6, 7, 8
*NSET, NSET="left side"
1, 4, 5, 8
*END PART
*ASSEMBLY, NAME=A
*INSTANCE, NAME=Lower, PART=Brick
*END INSTANCE
*INSTANCE, NAME=Upper, PART=brick
0, 0, 3
0, 0, 3, 0, 0, 4, 90
*END INSTANCE
*ELSET, ELSET=_Touch_S1, INTERNAL, INSTANCE=Upper
1
*SURFACE, NAME=Touch
_Touch_S1, S1
*NSET, NSET=Foot, INSTANCE=Lower
1, 2, 3, 4
*END ASSEMBLY
"""


def test_assembly():
    """Two instances of a part, one shifted and turned."""
    result = Result("assembly", ASSEMBLY)
    check("assembly, names of volumes", ", ".join(result.volumes), "Lower, Upper")
    check("assembly, names of surfaces", ", ".join(result.surfaces), "Touch, Foot, Lower.left side, Upper.left side, (none)")
    check("assembly, areas", str([row[2] for row in result.surfaces.values()]), "[2.0, 2.0, 1.0, 1.0, 14.0]")
    points = result.mesh()[0]
    check("assembly, lower corner of the one that is turned", str(points[8:].min(0).round(12) + 0.), "[-1.  0.  3.]")
    check("assembly, its upper corner", str(points[8:].max(0).round(12) + 0.), "[0. 2. 4.]")
    check("assembly, touched nodes", str(points[result.mesh()[1][0][1]][0, :, 2]), "[3. 3. 3. 3.]")


GMSH = """$MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
3
2 17 "base of it"
3 4 "wedge"
3 5 "tetrahedron"
$EndPhysicalNames
$Nodes
7
1 0 0 0
2 1 0 0
30 0 1 0
4 0 0 1
5 1 0 1
6 0 1 1
7 0 0 2
$EndNodes
$Elements
4
1 2 2 17 1 1 2 30
2 15 2 0 1 1
3 6 2 4 1 1 2 30 4 5 6
4 4 2 5 1 4 5 6 7
$EndElements
"""


def test_gmsh():
    """Physical groups of gmsh keep their names and ids."""
    result = Result("tetrahedron", GMSH, ending=".msh")
    check("gmsh, volumes", str(result.volumes), "{'wedge': (4, 3, 0.5), 'tetrahedron': (5, 4, 0.166667)}")
    check("gmsh, surfaces", str(result.surfaces), "{'base of it': (17, 3, 0.5), '(none)': (0, 15, 5.28024)}")
    result.check_fit("gmsh")
    text = open(result.file, encoding="utf-8").read()
    again = Result("again", text.replace("$Nodes\n1 ", "$Nodes\n2 ").replace("\n3 1 0 ", "\n2 1 0 0\n3 1 0 ", 1), ending=".msh")
    check("gmsh 4.1, what was written is read", str((again.volumes, again.surfaces)), str((result.volumes, result.surfaces)))


def test_cylinders():
    """27 and 20 nodes in gmsh's order, both versions of the format: the cylinders that nodus itself is tested with."""
    for name in ("cylinder_27_2", "cylinder_20_2", "cylinder_27_2_format_22"):
        with open(os.path.join(SOURCE, "tests", "meshes", name + ".msh"), encoding="utf-8") as file:
            result = Result("cylinder", file.read(), ending=".msh")
        check(f"{name}, volume", result.volumes["physical volume 1"][2], np.pi, 1e-3)
        check(f"{name}, hull", result.surfaces["physical surface 3"][2], 2 * np.pi, 1e-3)
        result.check_fit(name)


def test_overlaps():
    """A face has one id."""
    cube = solid("C3D8", decks.box("C3D8", 2), straight)
    text = cube + "*SURFACE, NAME=A\nALL, S1\n*SURFACE, NAME=B\n1, S1\n1, S3\n"
    refused("overlap", "wrong.inp: 1 face is in more than one surface: A and B share 1; a face of nodus has one boundary "
            "id: --pieces gives ids to the parts, --first leaves such faces to the set that comes first, --without NAME "
            "passes a set over", text.replace("ALL, S1", "1, S1\n2, S1"))
    for option, expected in ((("--first",), "{'A': 2, 'B': 1, '(none)': 21}"),
                             (("--pieces",), "{'A': 1, 'B': 1, 'A + B': 1, '(none)': 21}"),
                             (("--without", "a"), "{'B': 2, '(none)': 22}")):
        result = Result("overlap", text.replace("ALL, S1", "1, S1\n2, S1"), *option)
        check(f"overlap with {option[0]}", str({name: row[1] for name, row in result.surfaces.items()}), expected)


def test_refusals():
    """What is wrong is said with its place."""
    nodes, elements = decks.box("C3D8", 2)
    cube = nodes.text() + decks.elements_text("C3D8", elements)
    at = len(nodes.points) + 1
    refused("node that is not there", f"wrong.inp:{at + 3}: element 2 has node 99, which is not there",
            cube.replace(f"2, {elements[1][0]},", "2, 99,"))
    refused("node twice", "wrong.inp:3: node 1 is there already, wrong.inp:2", cube.replace("\n2, 0.5", "\n1, 0.5"))
    refused("element twice", f"wrong.inp:{at + 3}: element 1 is there already, wrong.inp:{at + 2}",
            cube.replace(f"\n2, {elements[1][0]},", f"\n1, {elements[1][0]},"))
    refused("unknown type", f"wrong.inp:{at + 1}: element type C4D8 is unknown; solids are C3D4, C3D10, C3D6, C3D15, C3D8, C3D20, "
            "C3D27 and their variants (C3D8R, C3D8I, C3D10M, ...)", cube.replace("C3D8", "C4D8"))
    refused("pyramid", f"wrong.inp:{at + 1}: element type C3D5: pyramids cannot be divided into hexahedra; mesh this place with "
            "tetrahedra, wedges or hexahedra", cube.replace("C3D8", "C3D5"))
    refused("cut off", f"wrong.inp:{at + 9}: an element of type C3D8 has 8 nodes, here are 2; is a line cut off?",
            ",".join(cube.split(",")[:-6]) + "\n")
    end = cube.count("\n")
    refused("unknown set in a set", f"wrong.inp:{end + 2}: there is no element set NOWHERE", cube + "*ELSET, ELSET=A\nNOWHERE\n")
    refused("unknown set in a surface", f"wrong.inp:{end + 2}: there is no element set NOWHERE",
            cube + "*SURFACE, NAME=A\nNOWHERE, S1\n")
    refused("set of itself", f"wrong.inp:{end + 2}: set A contains itself", cube + "*ELSET, ELSET=A\nA\n")
    refused("nodes that are made", f"wrong.inp:{end + 1}: *NGEN is not read; let the preprocessor write all nodes and elements",
            cube + "*NGEN\n1, 2\n")
    refused("instance of nothing", "wrong.inp:14: there is no part Stone in this deck", ASSEMBLY.replace("PART=Brick\n*END", (
        "PART=Stone\n*END")).replace("*NSET, NSET=\"left side\"\n1, 4, 5, 8\n*END PART\n", "*END PART\n").replace(
            "*ASSEMBLY, NAME=A\n", ""))
    bad = elements[3]
    twisted = cube.replace("4, " + ", ".join(map(str, bad)), "4, " + ", ".join(map(str, [bad[1], bad[0]] + bad[2:])))
    refused("twisted element", "wrong.inp: 1 element turned inside out or collapsed, at a corner or along curved sides: element 4; "
            "mesh this place anew", twisted)
    refused("included file", f"wrong.inp:{end + 1}: there is no file beside.inp", cube + "*INCLUDE, INPUT=beside.inp\n")
    refused("no solids", "wrong.inp: there are no solid elements", nodes.text())
    refused("pyramid of gmsh", "wrong.msh: element 3 is a pyramid, which cannot be divided into hexahedra; mesh this place with "
            "tetrahedra, wedges or hexahedra", GMSH.replace("3 6 2 4 1 1 2 30 4 5 6", "3 7 2 4 1 1 2 30 4 5"), ending=".msh")
    missing = subprocess.run([TOOL, "nowhere.inp", "x.msh"], stderr=subprocess.PIPE, text=True, check=False)
    check("missing file", f"{missing.returncode} {missing.stderr.strip()}", "1 convert: nowhere.inp: there is no such file")


def test_other_formats():
    """meshio is needed for them alone, and missed in one sentence."""
    os.mkdir("hidden")
    for name, text in (("hidden/meshio.py", "raise ImportError\n"), ("part.vtu", ""), ("part.msh", "kept")):
        with open(name, "w", encoding="utf-8") as file:
            file.write(text)
    for given, expected in (("part.vtu", "part.vtu: formats other than .inp and .msh are read by meshio; install it (apt-get "
                             "install python3-meshio, or pip install meshio)"),
                            ("part.msh", "part.msh: is the input itself; give the result another name")):
        done = subprocess.run([TOOL, given, "part.msh"], stderr=subprocess.PIPE, text=True, check=False,
                              env={**os.environ, "PYTHONPATH": "hidden"})
        check(given, f"{done.returncode} {done.stderr.strip()}", "1 convert: " + expected)
    check("file that was there before", open("part.msh", encoding="utf-8").read(), "kept")


CASE = """subsection Body 1
  set Mesh file = {file}
  subsection Material
    set Law = linear elastic
    set Young's modulus = 100
    set Poisson's ratio = 0.25
  end
end
""" + "".join(f"""subsection Boundary condition {i + 1}
  set Boundary ids = {{{name}}}
  set Components = {'xyz'[i % 3]}
  set Value = {0.01 if i == 3 else 0}
  set Name = {name}
end
""" for i, name in enumerate(("X", "Y", "Z", "END"))) + """subsection Contact pair 1
  set Slave body = 1
  set Slave boundary ids = {TOP}
  set Master surface = plane
  set Master point = 0, 0, 2
  set Master axis = 0, 0, -1
end
"""


def test_nodus(nodus):
    """Tetrahedra in uniaxial tension: hexahedra of any shape give the force exactly, E strain area = 1."""
    for kind in ("C3D4", "C3D15", "C3D10"):
        nodes, elements = decks.box(kind, 2)
        sides = "".join(f"*NSET, NSET={name}\n" + "\n".join(str(n) for n, p in enumerate(nodes.points, 1) if p[d] == at) + "\n"
                        for name, d, at in (("X", 0, 0), ("Y", 1, 0), ("Z", 2, 0), ("END", 0, 1), ("TOP", 2, 1)))
        result = Result("bar", nodes.text() + decks.elements_text(kind, elements, more=", ELSET=ALL") + sides)
        with open("bar.prm", "w", encoding="utf-8") as file:
            file.write(CASE.format(file=result.file, **{name: row[0] for name, row in result.surfaces.items()}))
        done = subprocess.run([nodus, "bar.prm"], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
        if done.returncode:
            print(done.stdout)
        check(f"nodus, bar of {kind}, exit code", done.returncode, 0)
        with open("results/bar/reactions.csv", encoding="utf-8") as file:
            rows = [line.strip().split(",") for line in file]
        last = [dict(zip(rows[0], row)) for row in rows[1:]][-1]
        force = [float(value) for key, value in last.items() if "force x" in key]
        check(f"nodus, bar of {kind}, force", abs(force[0]), 1, 1e-8)


def main():
    nodus = os.path.abspath(sys.argv[2]) if len(sys.argv) > 2 else None
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        for test in (test_boxes, test_kinds, test_round, test_mixtures, test_assembly, test_gmsh, test_cylinders, test_overlaps,
                     test_refusals, test_other_formats):
            test()
        if nodus:
            test_nodus(nodus)
        os.chdir("/")
    print(f"{len(failures)} not as expected" + (": " + "; ".join(failures) if failures else ""))
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
