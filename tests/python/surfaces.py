#!/usr/bin/python3
"""Faces that are chosen by their place and normal - planes, directions, cylinders, holes, on curved and refined meshes - against
their number and area in closed form; the same forces as with ids; the file and the picture of --validate --surfaces."""

import importlib.util
import os
import struct
import subprocess
import sys

import numpy as np

from harness import NODUS, SOURCE, below, check, nodus, refused, run

from nodus.surfaces import Roles, _normals

PROGRAM = nodus.Program(NODUS)
LAW = {"Law": "linear elastic", "Young's modulus": 2000, "Poisson's ratio": 0.3}
C30 = np.cos(np.pi / 6)


def body_case(body, *places, degree=1, **keys):
    """A body under a pressure on each of the places, and held where the last one is."""
    case = nodus.Case("surfaces", program=PROGRAM)
    case["Discretization/Degree"] = degree
    case["Body 1"] = {**body, "Material": LAW}
    for number, where in enumerate(places, 1):
        case[f"Boundary condition {number}"] = {"Type": "pressure", "Value": "t", "Where": where, **keys}
    case[f"Boundary condition {len(places) + 1}"] = {"Components": ["x", "y", "z"], "Value": 0, "Where": places[-1], **keys}
    return case


def roles(case, ranks=1):
    PROGRAM.validate(case.write("case.prm"), ranks, surfaces="surfaces.vtu")
    return Roles("surfaces.vtu")


def measured(case, ranks=1):
    """(number of faces, area) of each role."""
    found = roles(case, ranks)
    area = np.linalg.norm(_normals(found.mesh), axis=1)
    return [(int(found.faces[name].sum()), area[found.faces[name]].sum()) for name in found.names]


CUBE = {"Generator": "hyper_cube", "Generator arguments": "0 : 1 : true", "Global refinement": 2}
CYLINDER = {"Generator": "cylinder", "Generator arguments": "1 : 1", "Global refinement": 2}


def test_planes_and_normals():
    """A cube of 4 x 4 x 4 cells, as it is and turned by 30 degrees about y."""
    for ranks, degree in ((1, 1), (3, 2)):
        places = ["nz>0.9", "abs(z-1)<1e-6", "nz==1", "nx<-0.9 && z>0.5", "abs(nz)<0.1", "1"]
        found = measured(body_case(CUBE, *places, degree=degree), ranks)
        for where, (n, area), exact in zip(places, found, (16, 16, 16, 8, 64, 96)):
            check(f"cube, Q{degree}, {ranks} ranks, {where}, faces", n, exact)
            below(f"    area for {exact / 16}", abs(area - exact / 16), 1e-5)
        # what was at z = 1 is now the plane through (sin 30, 0, cos 30) with that normal
        turned = {**CUBE, "Rotation axis": [0, 1, 0], "Rotation angle": 30}
        places = [f"nx*0.5+nz*{C30}>cos(5*pi/180)", f"abs((x-0.5)*0.5+(z-{C30})*{C30})<1e-6", "nz>cos(29*pi/180)", "nz>cos(31*pi/180)"]
        places[2:3] = []
        for where, (n, _) in zip(places, measured(body_case(turned, *places, degree=degree), ranks)):
            check(f"turned cube, Q{degree}, {ranks} ranks, {where}, faces", n, 16)
        refused("no face of any body satisfies 'nz>cos(29*pi/180)'", roles, body_case(turned, "nz>cos(29*pi/180)"), ranks)


def test_cylinders():
    """A cylinder along x of radius 1 and length 2, 16 faces around and 8 along; the inside and the outside of a tube. The chords of
    first-order faces lie 1 - cos(pi/16) inside, their quarter has the area of a polygon, curved ones that of an arc to 1e-4."""
    for ranks, degree in ((1, 1), (2, 2)):
        inside = 1 - np.cos(np.pi / 16) if degree == 1 else 1e-4
        places = [f"abs(sqrt(y^2+z^2)-1)<{inside + 1e-3} && abs(nx)<0.5", "nz>cos(45*pi/180)", "abs(nx)<0.5", "nx>0.5",
                  "ny*y+nz*z>0.5",
                  f"abs(sqrt((x-1)^2+(y-0)^2+(z-0)^2 - ((x-1)*1+(y-0)*0+(z-0)*0)^2) - 1) < {inside + 1e-3} && abs(nx)<0.5"]  # fmt: skip
        side = 2 * 32 * np.sin(np.pi / 16) if degree == 1 else 4 * np.pi
        found = measured(body_case(CYLINDER, *places, degree=degree), ranks)
        for where, (n, area), exact in zip(places, found, ((128, side), (32, side / 4), (128, side), (80, side / 4), (128, side),
                                                      (128, side))):
            check(f"cylinder, Q{degree}, {ranks} ranks, {where}, faces", n, exact[0])
            if "nx>" not in where and degree == 1:
                below(f"    area for {exact[1]:.4f}", abs(area - exact[1]), 1e-5)
    tube = {"Generator": "cylinder_shell", "Generator arguments": "1 : 0.5 : 1 : 12 : 3"}
    places = ["nx*x+ny*y<-0.2", "nx*x+ny*y>0.5", "abs(sqrt(x^2+y^2)-0.5)<0.03 && abs(nz)<0.1"]
    for where, (n, area), r in zip(places, measured(body_case(tube, *places)), (0.5, 1, 0.5)):
        check(f"tube, {where}, faces", n, 36)
        below(f"    area for {24 * r * np.sin(np.pi / 12):.4f}", abs(area - 24 * r * np.sin(np.pi / 12)), 1e-5)


def test_sphere():
    """A ball of radius 1 with 96 faces, its lower half."""
    ball = {"Generator": "hyper_ball", "Generator arguments": "0,0,0 : 1 : false", "Global refinement": 2}
    found = measured(body_case(ball, "abs(sqrt(x^2+y^2+z^2) - 1) < 0.1 && nz < 0", "1"))
    check("faces", [n for n, _ in found], [48, 96, 96])


def test_refined():
    """The corner of a cube is refined: the top has 15 faces of 1/4 x 1/4 and 4 of half the size, and hanging nodes."""
    body = {**CUBE, "Local refinement": 1, "Refine where": "x<0.25 && y<0.25 && z>0.75"}
    for ranks in (1, 3):
        case = body_case(body, "nz>0.9", "nx<-0.9")
        (top, area), (left, _), (held, _) = measured(case, ranks)
        check(f"{ranks} ranks, faces", [top, left, held], [19, 19, 19])
        below("    area for 1", abs(area - 1), 1e-5)
        found = roles(case, ranks)
        name = next(name for name in found.names if "displacement" in name)
        nodes = found.mesh.fields[name] > 0.5
        check(f"{ranks} ranks, nodes held", int(nodes.sum()), 25 + 5)
        below("    their x", np.abs(found.mesh.points[nodes, 0]).max(), 1e-6)


def test_rigid_masters():
    """The lower side of a cube, 16 faces, on a rigid ball below it: the part of the ball that is opposite, looking at the cube; and on a
    plane that a rigid body carries."""
    for ranks, degree in ((1, 1), (3, 2)):
        case = body_case(CUBE, "nz>0.9", degree=degree)
        case["Contact pair 1"] = {"Slave body": 1, "Slave where": "nz<-0.9", "Master surface": "sphere", "Master radius": 2,
                                  "Master point": [0.5, 0.5, -2]}  # fmt: skip
        found = roles(case, ranks)
        check(f"Q{degree}, {ranks} ranks, roles", found.names[:2], ["contact pair 1, slave", "contact pair 1, master"])
        ball = found.faces["contact pair 1, master"]
        check("    faces", [int(found.faces[name].sum()) for name in found.names[:2]], [16, 16])
        check("    body and boundary id", [set(found.mesh.cell_fields[name][ball]) for name in ("body", "boundary_id")], [{0}, {-1}])
        from_centre = found.mesh.points[found.mesh.cells[ball]] - [0.5, 0.5, -2]
        below("    distance from the centre for 2", np.abs(np.linalg.norm(from_centre, axis=-1) - 2).max(), 1e-5)
        outward = np.einsum("ij,ij->i", _normals(found.mesh)[ball], from_centre.mean((1, 2)))
        check("    faces that look out of the ball", int((outward > 0).sum()), 16)
        check("    what is said of them", found.text("contact pair 1, master").split("\n")[1], "master, rigid, opposite to 16 faces")
        case["Body 2"] = {"Rigid": True}
        case["Contact pair 1"].update({"Master surface": "plane", "Master radius": 0, "Master point": [0, 0, -0.5], "Master axis": [0, 0, 1],
                                       "Master body": 2})  # fmt: skip
        found = roles(case, ranks)
        plane = found.faces["contact pair 1, master"]
        check("plane: body", set(found.mesh.cell_fields["body"][plane]), {2})
        below("    z for -0.5", np.abs(found.mesh.points[found.mesh.cells[plane]][..., 2] + 0.5).max(), 1e-6)


def patch(by_place, **sections):
    """Two blocks that press on each other with 25; all faces by their normals, or by ids."""
    case = nodus.Case.read(os.path.join(SOURCE, "prm", "patch.prm"), program=PROGRAM)
    del case["Contact pair 1/Scheme"], case["Contact pair 1/Surface"], case["Contact pair 1/Normal"], case["Geometry loop"]
    if by_place:
        for number, where in enumerate(("nx<-0.9", "ny<-0.9", "nz<-0.9", "nz>0.9"), 1):
            case[f"Boundary condition {number}"].update({"Boundary ids": [], "Where": where})
        case["Contact pair 1"].update({"Slave boundary ids": [], "Slave where": "nz<-0.9", "Master boundary ids": [],
                                       "Master where": "abs(z-1)<1e-6 && nz>0.9"})  # fmt: skip
    for name, keys in sections.items():
        case[name.replace("_", " ")].update(keys)
    return case


def test_forces():
    """Forces, pressures and a mesh that is refined on the way: what is chosen by normals is what ids choose."""
    refined = {"Body_2": {"Local refinement": 1, "Refine where": "x<0.5 && y<0.5 && z<1.5"}}
    adapted = {"Adaptivity": {"Interval": 1, "Maximum level": 1}, "Load_stepping": {"Increments": 2}}
    for what, ranks, sections in (("as it is", 3, {}), ("hanging nodes", 3, refined), ("adapted", 2, adapted)):
        both = [patch(by_place, **sections).run(f"results/{by_place}", ranks) for by_place in (True, False)]
        for name in ("bodies", "surface"):
            # ranks may divide the mesh otherwise: nodes are compared by their places
            table = [np.hstack([mesh.reference.round(6), mesh.fields["displacement"]])[mesh.nodes(6)]
                     for mesh in (getattr(results, name)() for results in both)]  # fmt: skip
            check(f"{what}, {ranks} ranks, nodes of the {name}", len(table[0]), len(table[1]))
            below("    displacements", np.abs(table[0] - table[1]).max(), 1e-8)
        below("    pressure for 25", np.abs(both[0].surface().field("CPRESS") - 25).max(), 1e-3)
    half = patch(True, Load_stepping={"Interval ends": [0.5], "Increments": [1]}, Output={"Checkpoint interval": 1})
    half.run("results/half")
    whole = patch(True, Load_stepping={"Interval ends": [0.5, 1], "Increments": [1, 1]})
    below("pressure for 25 after a restart", np.abs(whole.run("results/half", 2, restart=True).surface().field("CPRESS") - 25).max(), 1e-3)


def test_refusals():
    refused("no face of any body satisfies 'nz>2'", roles, body_case(CUBE, "nz>2", "nz>0.9"), 2)
    refused("the slave side has no face; check 'Slave boundary ids' and 'Slave where'", roles,
            patch(True, Contact_pair_1={"Slave where": "nz<-2"}))
    refused("'Where' in 'Boundary condition 1' asks for a normal, which the cells", roles,
            body_case(CUBE, "nz>0.9", Type="body force", Components=["z"]))
    refused("'nm>0.9' that does not parse", roles, body_case(CUBE, "nm>0.9"))
    refused("is not a number at (0 0 0) with the normal (0 0 -1)", roles, body_case(CUBE, "sqrt(nz)"))
    refused("'Boundary ids' in 'Boundary condition 1' is missing; give the ids or names of the faces", roles, body_case(CUBE, ""))
    refused("'Slave boundary ids' in 'Contact pair 1' is missing", roles, patch(True, Contact_pair_1={"Slave where": ""}))


def test_file():
    """Roles of the patch test; of hanging nodes, of edges alone, of a body force, with names that XML would stumble over."""
    for degree, ranks in ((1, 1), (2, 3)):
        case = patch(False, Discretization={"Degree": degree})
        case["Boundary condition 3/Name"] = 'held < "here" & there'
        found = roles(case, ranks)
        check(f"Q{degree}, {ranks} ranks, faces by role", {name: int(found.faces[name].sum()) for name in found.names},
              {"contact pair 1 (interface), slave": 4, "contact pair 1 (interface), master": 9,
               "boundary condition 1 (symmetry x), displacement": 10, "boundary condition 2 (symmetry y), displacement": 10,
               'boundary condition 3 (held < "here" & there), displacement': 9, "boundary condition 4 (load), traction": 4})  # fmt: skip
        mesh = found.mesh
        check("faces of all bodies", [len(mesh.cells), *np.bincount(mesh.cell_fields["body"].astype(int))], [66, 0, 42, 24])
        check("    by boundary_id", np.bincount(mesh.cell_fields["boundary_id"].astype(int)).tolist(), [10, 10, 10, 10, 13, 13])
        normals = _normals(mesh)
        below("    they look outwards", np.abs(normals.sum(0)).max(), 1e-6)
        below("    volume for 2", abs(np.einsum("nd,nd", normals, mesh.points[mesh.cells].mean((1, 2))) / 3 - 2), 1e-5)
        if importlib.util.find_spec("meshio"):
            import meshio

            read = meshio.read("surfaces.vtu")
            check("    the same as meshio reads it", {name: int(np.concatenate(read.cell_data[name]).sum()) for name in found.names},
                  {name: int(found.faces[name].sum()) for name in found.names})  # fmt: skip
    case = body_case(CUBE, "nz>0.9")
    case["Boundary condition 2/Where"] = "x<1e-9 && y<1e-9"
    edge = roles(case)
    check("nodes of an edge, no face", [(int(edge.faces[name].sum()), len(edge.nodes[name])) for name in edge.names[-1:]], [(0, 5)])


def test_picture():
    """It appears, with faces in the colours of the legend; where the case is refused after all, too."""
    patch(False).write("patch.prm")
    environment = {**os.environ, "NODUS": NODUS}
    script = [sys.executable, os.path.join(SOURCE, "contrib", "plot", "surfaces")]
    done = subprocess.run([*script, "patch.prm"], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False, env=environment)
    check("exit code", done.returncode, 0)
    check("told", done.stdout.splitlines()[-1:], ["patch_surfaces.png"])
    with open("patch_surfaces.png", "rb") as file:
        width, height = struct.unpack(">II", file.read(24)[16:24])
    check("at least 1000 x 500 pixels", [width >= 1000, height >= 500], [True, True])
    import matplotlib.colors
    import matplotlib.image

    image = matplotlib.image.imread("patch_surfaces.png")[..., :3].reshape(-1, 3)
    PROGRAM.validate("patch.prm", surfaces="surfaces.vtu")
    for name, colour in Roles("surfaces.vtu").colours.items():
        rgb = np.array(matplotlib.colors.to_rgb(colour))  # shading makes it darker
        near = image @ rgb > 0.9995 * np.linalg.norm(image, axis=1) * np.linalg.norm(rgb)
        below(f"pixels to each of {name}", len(image) / max((near & (np.linalg.norm(image, axis=1) > 0.5 * np.linalg.norm(rgb))).sum(), 1), 150)
    overlapping = [*script, "patch.prm", "--set", "Body 2/Translation=0,0,-0.3", "--output", "overlap.png"]
    done = subprocess.run(overlapping, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False, env=environment)
    check("bodies overlap, exit code and picture", [done.returncode, os.path.exists("overlap.png")], [1, True])
    print(done.stdout.splitlines()[-1])
    done = subprocess.run([*script, "patch.prm", "--set", "Body 2/Generator=cube"], stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                          text=True, check=False, env=environment)
    check("refused", [done.returncode, "\nsurfaces: " in "\n" + done.stdout, "Traceback" in done.stdout], [1, True, False])


run(test_planes_and_normals, test_cylinders, test_sphere, test_refined, test_rigid_masters, test_forces, test_refusals, test_file, test_picture)
