"""Whatever meshio reads: VTU, VTK, Exodus, MED, Nastran and more."""

import numpy as np

from .elements import KINDS
from .mesh import Block, Mesh, MeshError, face_rows

_VTK_FACES = ((0, 3, 4, 7), (1, 2, 5, 6), (0, 1, 4, 5), (2, 3, 6, 7), (0, 1, 2, 3), (4, 5, 6, 7))  # of 27-node hexahedra
SOLIDS = {"tetra": "C3D4", "tetra10": "C3D10", "wedge": "C3D6", "wedge15": "C3D15", "wedge18": "C3D18", "hexahedron": "C3D8",
          "hexahedron20": "C3D20", "hexahedron27": "C3D27"}
SKINS = {"triangle": 3, "triangle6": 3, "triangle7": 3, "quad": 4, "quad8": 4, "quad9": 4}
# data of cells that number bodies and surfaces, by the programs that write them
NUMBERS = ("gmsh:physical", "cell_tags", "medit:ref", "nastran:ref", "ElementBlockIds", "material", "MaterialIds")


def read_other(path):
    """The mesh with the sets and numbers of cells and the sets of points that meshio finds."""
    try:
        import meshio
    except ImportError:
        raise MeshError(f"{path}: formats other than .inp and .msh are read by meshio; install it (apt-get install "
                        "python3-meshio, or pip install meshio)") from None
    try:
        found = meshio.read(path)
    except (Exception, SystemExit) as error:  # meshio ends the process for endings that it does not know
        raise MeshError(f"{path}: meshio cannot read it: {str(error).strip() or 'unknown ending'}") from None
    points = np.asarray(found.points, float)
    if points.shape[1] != 3:
        raise MeshError(f"{path}: the points have {points.shape[1]} coordinates, not 3")
    return _mesh(path, found, points)


def _mesh(path, found, points):
    blocks, where, faces, start = {}, {}, {}, 1
    for i, cells in enumerate(found.cells):
        if cells.type.startswith("pyramid"):
            raise MeshError(f"{path}: there are pyramids, which cannot be divided into hexahedra; mesh this place with "
                            "tetrahedra, wedges or hexahedra")
        labels, start = start + np.arange(len(cells.data)), start + len(cells.data)
        if cells.type in SOLIDS:
            name = SOLIDS[cells.type]
            nodes = np.asarray(cells.data)[:, _order(name)]
            blocks.setdefault(name, []).append((i, nodes, labels))
        elif cells.type in SKINS:
            faces[i] = face_rows(np.asarray(cells.data)[:, :SKINS[cells.type]])
    if not blocks:
        raise MeshError(f"{path}: there are no solid elements among {sorted({cells.type for cells in found.cells})}")
    mesh = Mesh(path, points, [Block(name, np.concatenate([nodes for _, nodes, _ in parts]),
                                     np.concatenate([labels for _, _, labels in parts])) for name, parts in blocks.items()])
    at = 0
    for block in mesh.blocks:
        for i, nodes, _ in blocks[block.name]:
            where[i] = at + np.arange(len(nodes))
            at += len(nodes)
    _add_sets(mesh, found, where, faces)
    return mesh


def _order(name):
    if name != "C3D27":
        return range(len(KINDS[name].nodes))
    own = [sorted(face) for face in KINDS[name].shape.faces]
    return list(range(20)) + [20 + _VTK_FACES.index(tuple(face)) for face in own] + [26]


def _add_sets(mesh, found, where, faces):
    def add(name, i, chosen):
        for sets, source in ((mesh.element_sets, where), (mesh.face_sets, faces)):
            if i in source and len(source[i][chosen]):
                before = [sets[name]] if name in sets else []
                sets[name] = np.concatenate(before + [source[i][chosen]])

    for name, per_block in found.cell_sets.items():
        for i, chosen in enumerate(per_block):
            if chosen is not None and not name.startswith("gmsh:"):
                add(name, i, np.asarray(chosen, int))
    for key in NUMBERS:
        for i, numbers in enumerate(found.cell_data.get(key, [])):
            for number in np.unique(numbers):
                add(_number_name(found, key, number), i, np.flatnonzero(np.asarray(numbers).reshape(-1) == number))
    for name, chosen in found.point_sets.items():
        chosen = np.asarray(chosen)
        mesh.node_sets[name] = np.flatnonzero(chosen) if chosen.dtype == bool else chosen.astype(int)


def _number_name(found, key, number):
    """The name that the file has for a number, else the number itself."""
    for name, (tag, _) in (found.field_data or {}).items():
        if tag == number and key == "gmsh:physical":
            return name
    names = getattr(found, "cell_tags", {}).get(number)  # MED: names of the families
    return "_".join(names) if names else f"{key.split(':')[0]} {number}"
