#!/usr/bin/python3
"""Fields of the VTU files against closed forms, of one and two ranks and of both degrees; their points in both configurations; cells
as meshio, VTK and pyvista read them, as far as they are installed."""

import importlib.util
import os

import numpy as np

from harness import NODUS, SOURCE, below, check, nodus, refused, run

PROGRAM = nodus.Program(NODUS)
E, NU = 1000., 0.3
MU = E / (2 * (1 + NU))
PRINCIPAL = [f"principal_{kind}_{i}" for kind in ("stress", "direction") for i in (1, 2, 3)]


def cube(F, degree=1, **output):
    """The unit cube of eight cells whose surface goes from X to F X."""
    case = nodus.Case("cube", program=PROGRAM)
    case["Discretization/Degree"] = degree
    case["Body 1"] = {"Generator": "hyper_cube", "Generator arguments": [0, 1, True], "Global refinement": 1,
                      "Material": {"Law": "neo-Hookean", "Young's modulus": E, "Poisson's ratio": NU}}  # fmt: skip
    G = F - np.eye(3)
    case["Boundary condition 1"] = {"Boundary ids": list(range(6)), "Components": ["x", "y", "z"],
                                    "Value": [f"t*(({row[0]})*x+({row[1]})*y+({row[2]})*z)" for row in G.tolist()]}  # fmt: skip
    case["Load stepping/Increments"] = 3
    case["Output"] = {"Fields": "all", **output}
    return case


def tensor(mesh, name):
    return mesh.fields[name].reshape(-1, 3, 3)


def error(values, exact):
    """Largest difference, relative to the largest of what it should be, or absolute where that is zero."""
    return np.abs(values - exact).max() / (np.abs(exact).max() or 1.)


# name, F, Green-Lagrange strain, ln V
GAMMA, ANGLE = 0.5, np.pi / 6
LN_STRETCH = np.arcsinh(GAMMA / 2)  # of the principal stretches of simple shear, exp(+-)
C, S = np.cos(ANGLE), np.sin(ANGLE)
HOMOGENEOUS = [
    ("uniaxial stretch", np.diag([1.2, 1., 1.]), np.diag([0.22, 0., 0.]), np.diag([np.log(1.2), 0., 0.])),
    ("simple shear", np.array([[1., GAMMA, 0.], [0., 1., 0.], [0., 0., 1.]]),
     np.array([[0., GAMMA / 2, 0.], [GAMMA / 2, GAMMA**2 / 2, 0.], [0., 0., 0.]]),
     LN_STRETCH / np.hypot(1, GAMMA / 2) * np.array([[GAMMA / 2, 1., 0.], [1., -GAMMA / 2, 0.], [0., 0., 0.]])),
    ("rotation", np.array([[C, -S, 0.], [S, C, 0.], [0., 0., 1.]]), np.zeros((3, 3)), np.zeros((3, 3))),
]  # fmt: skip


def test_strains():
    for name, F, green_lagrange, logarithmic in HOMOGENEOUS:
        for degree, ranks, nodal in ((1, 1, "averaged"), (2, 2, "averaged"), (2, 1, "by cell")):
            what = f"{name}, Q{degree}, {ranks} ranks, {nodal}"
            mesh = cube(F, degree, **{"Nodal values": nodal}).run("results/cube", ranks).bodies()
            below(f"{what}, Green-Lagrange strain", error(tensor(mesh, "green_lagrange_strain"), green_lagrange), 1e-6)
            below(f"{what}, logarithmic strain", error(tensor(mesh, "logarithmic_strain"), logarithmic), 1e-6)
            J = np.linalg.det(F)
            lame = 2 * MU * NU / (1 - 2 * NU)
            stress = (MU * (F @ F.T - np.eye(3)) + lame * np.log(J) * np.eye(3)) / J
            below(f"{what}, Cauchy stress", np.abs(tensor(mesh, "cauchy_stress") - stress).max() / MU, 1e-6)
            below(f"{what}, positions", np.abs(mesh.points - mesh.reference @ F.T).max(), 1e-6)


def test_principal_stresses():
    """Simple shear: sigma = mu (b - 1), whose axes are those of b."""
    F = HOMOGENEOUS[1][1]
    mesh = cube(F).run("results/cube").bodies()
    stretch = np.exp(LN_STRETCH)
    angle = np.arctan2(1., GAMMA / 2) / 2
    axes = [[np.cos(angle), np.sin(angle), 0.], [0., 0., 1.], [-np.sin(angle), np.cos(angle), 0.]]
    for i, (stress, axis) in enumerate(zip((MU * (stretch**2 - 1), 0., MU * (stretch**-2 - 1)), axes), 1):
        below(f"principal stress {i}", np.abs(mesh.field(f"principal_stress_{i}") - stress).max() / MU, 1e-6)
        along = np.abs(mesh.fields[f"principal_direction_{i}"] @ axis)
        below(f"principal direction {i}", np.abs(along - 1).max(), 1e-6)


def test_jump():
    """Two cells of a linear elastic body without Poisson's effect, stretched by 0.1 and 0.2: stresses of 100 and 200, whose mean is
    at the nodes between them."""
    case = cube(np.eye(3))
    case["Body 1"] = {"Generator": "subdivided_hyper_rectangle", "Generator arguments": "2,1,1 : 0,0,0 : 2,1,1 : true",
                      "Global refinement": 0,
                      "Material": {"Law": "linear elastic", "Young's modulus": E, "Poisson's ratio": 0}}  # fmt: skip
    case["Boundary condition 1/Value"] = ["if(x<1, 0.1*x, 0.2*x-0.1)", "0", "0"]
    for nodal, points, between in (("averaged", 12, [150.] * 4), ("by cell", 16, [100.] * 4 + [200.] * 4)):
        case["Output/Nodal values"] = nodal
        mesh = case.run("results/jump").bodies()
        check(f"{nodal}, points", len(mesh.points), points)
        check(f"{nodal}, nodes", len(mesh.nodes()), 12)
        check(f"{nodal}, different node_id", len(set(mesh.field("node_id"))), 12)
        stress = mesh.field("cauchy_stress xx")
        below(f"{nodal}, between the cells", error(np.sort(stress[np.abs(mesh.reference[:, 0] - 1) < 1e-6]), np.array(between)), 1e-6)
        below(f"{nodal}, at the left end", error(stress[mesh.reference[:, 0] < 0.5], 100. * np.ones(4)), 1e-6)
    bent = bar(1)  # a stress of 0.1 E y, linear in each cell
    bent["Output/Nodal values"] = "by cell"
    mesh = bent.run("results/bent").bodies()
    own = mesh.field("body") == 1
    below("by cell, linear stress", error(mesh.field("cauchy_stress xx")[own], 0.1 * E * mesh.reference[own, 1]), 1e-6)


def patch(**output):
    case = nodus.Case.read(os.path.join(SOURCE, "prm", "patch.prm"), program=PROGRAM)
    del case["Contact pair 1/Scheme"], case["Contact pair 1/Surface"], case["Contact pair 1/Normal"], case["Geometry loop"]
    case["Output"] = output
    return case


def test_contact():
    """The traction is the pressure of 25 against the normal; times the areas of the nodes it is the force on the slave surface; nodes
    of the contact surface are those of the bodies."""
    for ranks in (1, 3):
        results = patch().run("results/patch", ranks)
        bodies, surface = results.bodies(), results.surface()
        nodes = surface.nodes()
        traction = surface.fields["contact_traction"]
        below(f"{ranks} ranks, traction along the normal", error(traction, -25 * surface.fields["normal"]), 1e-6)
        force = (surface.fields["area"][nodes, None] * traction[nodes]).sum(0)
        below(f"{ranks} ranks, force", error(force, [results.contact[-1][f"slave force {c}"] for c in "xyz"]), 1e-6)
        position = dict(zip(bodies.fields["node_id"], bodies.reference))
        check(f"{ranks} ranks, node_id", len(set(surface.fields["node_id"][nodes])), len(nodes))
        below(f"{ranks} ranks, positions of the nodes",
              max(np.abs(position[n] - X).max() for n, X in zip(surface.fields["node_id"], surface.reference)), 1e-6)
        check(f"{ranks} ranks, cell_id", np.sort(bodies.cell_fields["cell_id"]).tolist(), list(range(26)))


def test_choice():
    always = {"displacement", "body", "node_id"}
    plastic = cube(np.diag([1.01, 1., 1.]))
    plastic["Body 1/Material"].update({"Law": "J2 plasticity", "Yield stress": 1.})
    for fields, names in (("default", {"cauchy_stress", "von_mises", "PEEQ"}), ("CPRESS", set()),
                          ("default, principal_stress_1", {"cauchy_stress", "von_mises", "PEEQ", "principal_stress_1"}),
                          ("all", {"cauchy_stress", "von_mises", "PEEQ", "green_lagrange_strain", "logarithmic_strain", *PRINCIPAL})):  # fmt: skip
        plastic["Output/Fields"] = fields
        check(f"fields of bodies, {fields}", set(plastic.run("results/choice").bodies().fields), names | always)
    contact = patch(Fields="CPRESS, contact_traction").run("results/patch").surface()
    check("fields of the surface", set(contact.fields), {"displacement", "pair", "node_id", "CPRESS", "contact_traction"})
    known = set(PROGRAM.reference["Output/Fields"].choices) - {"default", "all"}
    results = patch(Fields="all").run("results/patch")
    check("names of the key, names in the files", known - {"PEEQ"},
          (set(results.bodies().fields) | set(results.surface().fields)) - {"pair"} - always)
    refused("did you mean 'von_mises'", patch, Fields=["default", "von_mise"])


def bar(ranks, **sections):
    """A bar of two trilinear cells around x = 1 whose displacement is (0.1 t x y, 0, 0), and a block above it at rest."""
    case = nodus.Case("bar", program=PROGRAM)
    law = {"Law": "linear elastic", "Young's modulus": E, "Poisson's ratio": 0}
    case["Body 1"] = {"Name": "bar", "Generator": "subdivided_hyper_rectangle",
                      "Generator arguments": "2,1,1 : 0,0,0 : 2,1,1 : true", "Material": law}  # fmt: skip
    case["Body 2"] = {"Name": "block", "Generator": "hyper_cube", "Generator arguments": "0 : 1 : true",
                      "Translation": [0, 0, 1], "Material": law}  # fmt: skip
    case["Boundary condition 1"] = {"Body": 1, "Boundary ids": list(range(6)), "Components": ["x", "y", "z"],
                                    "Value": ["0.1*t*x*y", "0", "0"]}  # fmt: skip
    case["Boundary condition 2"] = {"Body": 2, "Boundary ids": 5, "Components": ["x", "y", "z"], "Value": 0}
    case["Load stepping/Increments"] = 4
    case["Output"] = {"VTU interval": 2}
    for name, keys in sections.items():
        case[name.replace("_", " ")] = keys
    return case


def test_points():
    """Displacements between the nodes, where the two bodies touch, and on an edge that both cells share; on all ranks."""
    sections = {
        "Output_point_1": {"Name": "inside", "Body": 1, "Position": [0.3, 0.6, 0.9]},
        "Output_point_2": {"Name": "node", "Body": 1, "Position": [1, 1, 1]},
        "Output_point_3": {"Body": 2, "Position": [1, 1, 1]},
        "Output_line_1": {"Name": "edge, upper", "Body": 1, "From": [0, 1, 0.5], "To": [2, 1, 0.5], "Points": 9},
    }
    for ranks in (1, 3):
        results = bar(ranks, **sections).run("results/bar", ranks)
        points, lines = results.points, results.lines
        check(f"{ranks} ranks, names", list(points["point"][:3]), ["inside", "node", "point 3"])
        check(f"{ranks} ranks, increments", points.where(point="node")["increment"].tolist(), [1., 2., 3., 4.])
        t = points.where(point="node")["time"]
        for name, factor in (("inside", 0.018), ("node", 0.1), ("point 3", 0.)):
            below(f"{ranks} ranks, {name}, displacement x", np.abs(points.where(point=name)["displacement x"] - factor * t).max(), 1e-12)
        check(f"{ranks} ranks, lines at", sorted(set(lines["time"])), [0.5, 1.])
        last = lines.where(line="edge, upper")
        last = last[last["time"] == 1]
        below(f"{ranks} ranks, distances", np.abs(last["distance"] - np.linspace(0, 2, 9)).max(), 1e-12)
        below(f"{ranks} ranks, line, displacement x", np.abs(last["displacement x"] - 0.1 * last["distance"]).max(), 1e-12)
        # the stress of E 0.1 y at y = 1 as the lumped averages of the nodes have it: a third and two thirds are the means over
        # shape functions of y
        below(f"{ranks} ranks, line, stress xx", np.abs(last["stress xx"] - 0.1 * E * 2 / 3).max() / E, 1e-12)
    half = bar(2, **sections)
    half["Load stepping"] = {"Interval ends": [0.5], "Increments": [2]}
    half["Output/Checkpoint interval"] = 1
    half.run("results/bar", 2)
    whole = bar(2, **sections)
    whole["Load stepping"] = {"Interval ends": [0.5, 1], "Increments": [2, 2]}
    after = whole.run("results/bar", 2, restart=True)
    below("after a restart", np.abs(after.points.where(point="node")["displacement x"] - 0.1 * t).max(), 1e-12)
    check("lines after a restart", sorted(set(after.lines["time"])), [0.5, 1.])
    outside = {"Output_point_1": {"Name": "tip", "Body": 1, "Position": [0.5, 0.5, 1.25]}}
    refused("Output point 1 ('tip') at (0.5 0.5 1.25) is outside of body 1 (bar); the nearest body is 2 (block), at a distance of 0",
            bar(1, **outside).run, "results/refused")
    outside["Output_point_1"]["Position"] = [3.5, 0.5, 0.5]
    refused("is outside of body 1 (bar), at a distance of 1.5", bar(1, **outside).run, "results/refused", 2)
    refused("at a distance of 1.5", bar(1, **outside).check)
    check("results of what is refused", os.path.exists("results/refused"), False)


def test_folder_again():
    """A run that begins anew in a folder leaves nothing of the one before but its checkpoints, with which that one continues; files
    of others stay."""
    F = HOMOGENEOUS[0][1]
    case = cube(F, **{"Checkpoint interval": 1})
    case.run("results/again", 2, profile=True)
    with open("results/again/bodies_notes.vtu", "w", encoding="utf-8") as file:
        file.write("mine")
    short = cube(F, **{"Checkpoint interval": 1})
    short["Load stepping/Increments"] = 1
    done = short.run("results/again")
    check("files", sorted(os.listdir("results/again")),
          ["bodies.pvd", "bodies_0000.vtu", "bodies_0001.vtu", "bodies_notes.vtu", "checkpoints", "checkpoints.before", "contact.csv",
           "convergence.csv", "energy.csv", "log", "reactions.csv", "status.json"])  # fmt: skip
    check("told", "Files of an earlier run are removed: 19" in done.log, True)
    os.rename("results/again/checkpoints", "results/again/other")
    os.rename("results/again/checkpoints.before", "results/again/checkpoints")
    after = case.run("results/again", restart=True)
    check("times of the fields that are there", [os.path.exists(file) for file in after.series("bodies").values()], [True] * len(after.series("bodies")))
    check("increments of the first run", after.reactions["increment"].tolist(), [1., 2., 3.])


EDGES = [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7)]
FACES = [(0, 4, 7, 3), (1, 2, 6, 5), (0, 1, 5, 4), (3, 7, 6, 2), (0, 3, 2, 1), (4, 5, 6, 7)]


def test_configurations():
    """Warped by the displacement, points of the undeformed configuration are those of the deformed one."""
    F = np.array([[1.2, 0.5, 0.], [0., 1., 0.1], [0., 0., 1.]])
    files = {kind: cube(F, 2, Configuration=kind).run(f"results/{kind}", 2) for kind in ("undeformed", "deformed")}
    same = [results.bodies() for results in files.values()]
    below("both as read here", np.abs(same[0].points - same[1].points).max(), 1e-6)
    for degree, solid, plane in ((1, "hexahedron", "quad"), (2, "hexahedron27", "quad9")):
        files = {kind: cube(F, degree, Configuration=kind).run(f"results/{kind}") for kind in ("undeformed", "deformed")}
        raw = {kind: os.path.join(results.folder, "bodies_0003.vtu") for kind, results in files.items()}
        contact = patch()
        contact["Discretization/Degree"] = degree
        surface = os.path.join(contact.run("results/patch").folder, "contact_0001.vtu")
        if importlib.util.find_spec("meshio"):
            with_meshio(raw, surface, F, solid, plane)
        if importlib.util.find_spec("vtkmodules"):
            with_vtk(raw, F)


def with_meshio(raw, surface, F, solid, plane):
    import meshio

    mesh, deformed = meshio.read(raw["undeformed"]), meshio.read(raw["deformed"])
    warped = mesh.points + mesh.point_data["displacement"]
    below(f"meshio, {solid}, warped and deformed", np.abs(warped - deformed.points).max(), 1e-6)
    below(f"meshio, {solid}, closed form", np.abs(warped - mesh.points @ F.T).max(), 1e-6)
    check(f"meshio, {solid}, cells", [(block.type, len(block.data)) for block in mesh.cells], [(solid, 8)])
    check(f"meshio, {solid}, values of cells", np.sort(np.concatenate(mesh.cell_data["cell_id"])).tolist(), list(range(8)))
    check(f"meshio, {solid}, tensors", mesh.point_data["cauchy_stress"].shape, (len(mesh.points), 9))
    x = mesh.points[mesh.cells[0].data]
    below(f"meshio, {solid}, volume", abs(np.einsum("ei,ei", x[:, 1] - x[:, 0], np.cross(x[:, 3] - x[:, 0], x[:, 4] - x[:, 0])) - 1), 1e-6)
    for number, corners in enumerate([*EDGES, *FACES, range(8)] if solid == "hexahedron27" else [], 8):
        middle = x[:, list(corners)].mean(1)
        if not np.abs(x[:, number] - middle).max() < 1e-6:
            check(f"node {number}", "elsewhere", "in the middle of its corners")
    check(f"meshio, surface of {solid}", [block.type for block in meshio.read(surface).cells], [plane])


def volume(grid):
    """Of the cells as VTK maps them from their unit cubes; vtkCellSizeFilter of VTK 9.6 has -0.02 for a unit cube of 27
    nodes."""
    from vtkmodules.vtkCommonCore import mutable

    h = 0.5 / np.sqrt(3)
    total = 0.
    for c in range(grid.GetNumberOfCells()):
        cell = grid.GetCell(c)

        def at(p):
            x = [0.] * 3
            cell.EvaluateLocation(mutable(0), list(p), x, [0.] * cell.GetNumberOfPoints())
            return np.array(x)

        for corner in np.ndindex(2, 2, 2):
            p = 0.5 + h * (2 * np.array(corner) - 1)
            total += np.linalg.det([(at(p + 0.1 * e) - at(p - 0.1 * e)) / 0.2 for e in np.eye(3)]) / 8
    return total


def with_vtk(raw, F):
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkCommonDataModel import vtkDataObject
    from vtkmodules.vtkFiltersGeneral import vtkWarpVector
    from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

    points = {}
    for kind, file in raw.items():
        reader = vtkXMLUnstructuredGridReader()
        reader.SetFileName(file)
        warp = vtkWarpVector()
        warp.SetInputConnection(reader.GetOutputPort())
        warp.SetInputArrayToProcess(0, 0, 0, vtkDataObject.FIELD_ASSOCIATION_POINTS, "displacement")
        last = warp if kind == "undeformed" else reader
        last.Update()
        points[kind] = vtk_to_numpy(last.GetOutput().GetPoints().GetData())
        check(f"VTK, {kind}, volume", volume(last.GetOutput()), float(np.linalg.det(F)), 1e-5)
    below("VTK, warped and deformed", np.abs(points["undeformed"] - points["deformed"]).max(), 1e-6)


class Vtk:
    """What VTK reads of a file, and where its points are, warped by the displacement."""

    name, module = "VTK", "vtkmodules"

    def __init__(self, file):
        from vtkmodules.util.numpy_support import vtk_to_numpy
        from vtkmodules.vtkCommonDataModel import vtkDataObject
        from vtkmodules.vtkFiltersGeneral import vtkWarpVector
        from vtkmodules.vtkIOXML import vtkXMLPUnstructuredGridReader, vtkXMLUnstructuredGridReader

        reader = vtkXMLPUnstructuredGridReader() if file.endswith(".pvtu") else vtkXMLUnstructuredGridReader()
        reader.SetFileName(file)
        warp = vtkWarpVector()
        warp.SetInputConnection(reader.GetOutputPort())
        warp.SetInputArrayToProcess(0, 0, 0, vtkDataObject.FIELD_ASSOCIATION_POINTS, "displacement")
        warp.Update()
        grid, values = reader.GetOutput(), reader.GetOutput().GetPointData()
        self.points, self.warped = (vtk_to_numpy(one.GetPoints().GetData()) for one in (grid, warp.GetOutput()))
        self.n_cells, self.names = grid.GetNumberOfCells(), {values.GetArrayName(i) for i in range(values.GetNumberOfArrays())}


class Pyvista:
    """The same by pyvista, which Debian 12 does not have: `pip install pyvista`, 600 MB."""

    name = module = "pyvista"

    def __init__(self, file):
        import pyvista

        mesh = pyvista.read(file)
        self.points, self.warped = mesh.points, mesh.warp_by_vector("displacement").points
        self.n_cells, self.names = mesh.n_cells, set(mesh.point_data.keys())


def test_other_readers():
    """VTK and pyvista, if they are installed, read every file of fields, of any number of ranks; what they warp is what is written
    deformed."""
    readers = [reader for reader in (Vtk, Pyvista) if importlib.util.find_spec(reader.module)]
    print("installed:", ", ".join(reader.name for reader in readers))
    F = np.array([[1.2, 0.5, 0.], [0., 1., 0.1], [0., 0., 1.]])
    for degree, ranks in ((1, 1), (2, 1), (1, 2), (2, 3)) if readers else ():
        for what, make, series in (("cube", lambda **output: cube(F, **output), ["bodies"]), ("patch", patch, ["bodies", "contact"])):
            pair = []
            for kind in ("undeformed", "deformed"):
                case = make(Configuration=kind, Fields="all")
                case["Discretization/Degree"] = degree
                pair.append(case.run(f"results/{what}_{kind}", ranks))
            for reader, name in ((reader, name) for reader in readers for name in series):
                title = f"{reader.name}, Q{degree}, {ranks} ranks, {what}, {name}"
                for t, file in pair[0].series(name).items():
                    file, deformed, ours = reader(file), reader(pair[1].series(name)[t]), pair[0].mesh(name, t)
                    read = file.n_cells, file.names, bool(t == 0 or np.abs(file.warped - file.points).max() > 1e-3)
                    if read != (len(ours.cells), set(ours.fields), True):
                        check(f"{title}, t = {t:g}, cells, fields, it moves", read, (len(ours.cells), set(ours.fields), True))
                    if not np.abs(file.warped - ours.points).max() < 1e-6:
                        check(f"{title}, t = {t:g}, warped points", "elsewhere", "where they are as read here")
                below(f"{title}, {len(pair[0].series(name))} files, warped and deformed",
                      np.abs(file.warped - deformed.points).max(), 1e-6)


run(test_strains, test_principal_stresses, test_jump, test_contact, test_choice, test_configurations, test_points,
    test_folder_again, test_other_readers)
