"""From sets to what nodus knows: volumes, which may overlap, and surfaces, of which a face has one."""

import numpy as np

from .mesh import Faces, MeshError


class Group:
    """A row of the table: `members` are elements or numbers of faces, `names` all sets that are the same ones."""

    def __init__(self, name, members, source):
        self.names, self.members, self.source, self.id = [name], np.unique(members), source, None

    @property
    def name(self):
        """The first one."""
        return self.names[0]


def volume_groups(mesh):
    """Every set of elements, and the solids that no union of sets is."""
    groups = [Group(name, elements, "element set") for name, elements in mesh.element_sets.items() if len(elements)]
    solid, n_solids = mesh.solids()
    covered, sizes = np.zeros(mesh.n_elements, bool), np.bincount(solid, minlength=n_solids)
    for group in groups:
        if len(np.unique(solid[group.members])) == 1:
            covered[group.members] = True
    whole = np.bincount(solid[covered], minlength=n_solids) == sizes
    for number in np.flatnonzero(~whole):
        members = np.flatnonzero(solid == number)
        if n_solids == 1 and any(len(group.members) == len(members) for group in groups):
            continue
        groups.append(Group(f"solid {number + 1}", members, "connected elements"))
    return _numbered(_merged(groups), mesh.volume_ids)


def surface_groups(mesh, overlap="refuse"):
    """(groups, faces) of the sets of faces and of nodes. overlap: what happens to faces in several: "refuse", the "first"
    has them, or "pieces" become groups of their own."""
    faces, groups = Faces(mesh), []
    faces.check()
    for name, rows in mesh.face_sets.items():
        found = faces.find(rows)
        if (found < 0).any():
            mesh.notes.append(f"surface {name}: {(found < 0).sum()} of {len(found)} faces belong to no solid element, left out")
        inside = (faces.count[found[found >= 0]] > 1).sum()
        if inside:
            mesh.notes.append(f"surface {name}: {inside} of {len(found)} faces are between elements; nodus has these only "
                              "where the elements are of two bodies")
        groups.append(Group(name, found[found >= 0], "surface"))
    wholes = [np.unique(np.concatenate([np.unique(b.nodes) for b in mesh.blocks]))] + [
        _nodes(mesh, elements) for elements in mesh.element_sets.values() if len(elements)]
    for name, nodes in mesh.node_sets.items():
        if any(len(nodes) >= len(whole) and np.isin(whole, nodes).all() for whole in wholes):
            mesh.notes.append(f"node set {name} has all nodes of a set of elements, so that it is no surface")
            continue
        groups.append(Group(name, np.flatnonzero(faces.inside(nodes)), "node set"))
    empty = [group.name for group in groups if not len(group.members)]
    if empty:
        mesh.notes.append(f"no face, so no boundary id (`Where` of nodus takes places): {', '.join(empty)}")
    groups = _merged([group for group in groups if len(group.members)])
    return _numbered(_apart(mesh, groups, len(faces.rows), overlap), mesh.surface_ids), faces


def _nodes(mesh, elements):
    chosen = np.zeros(mesh.n_elements, bool)
    chosen[elements] = True
    return np.unique(np.concatenate([block.nodes[chosen[start:start + len(block.nodes)]].reshape(-1)
                                     for block, start in zip(mesh.blocks, mesh.starts())]))


def _merged(groups):
    """Sets of the same faces are one group."""
    result = {}
    for group in groups:
        same = result.setdefault(group.members.tobytes(), group)
        if same is not group:
            same.names += group.names
            if group.source != same.source and group.source not in same.source:
                same.source += " and " + group.source
    return list(result.values())


def _apart(mesh, groups, n_faces, overlap):
    owners = np.zeros(n_faces, int)
    for group in groups:
        owners[group.members] += 1
    several = np.flatnonzero(owners > 1)
    if not len(several):
        return groups
    pairs = [(len(np.intersect1d(a.members, b.members)), a.name, b.name) for i, a in enumerate(groups) for b in groups[:i]]
    pairs = sorted((pair for pair in pairs if pair[0]), key=lambda pair: -pair[0])
    verb = "faces are" if len(several) > 1 else "face is"
    text = (f"{len(several)} {verb} in more than one surface: " + ", ".join(f"{b} and {a} share {n}" for n, a, b in pairs[:6])
            + (", ..." if len(pairs) > 6 else ""))
    if overlap == "refuse":
        raise MeshError(f"{mesh.file}: {text}; a face of nodus has one boundary id: --pieces gives ids to the parts, --first "
                        "leaves such faces to the set that comes first, --without NAME passes a set over")
    mesh.notes.append(text + (", which the first has" if overlap == "first" else ", which are groups of their own"))
    return _first(groups, n_faces) if overlap == "first" else _pieces(groups, n_faces)


def _first(groups, n_faces):
    taken, result = np.zeros(n_faces, bool), []
    for group in groups:
        group.members = group.members[~taken[group.members]]
        taken[group.members] = True
        if len(group.members):
            result.append(group)
    return result


def _pieces(groups, n_faces):
    """A group for each combination of sets that faces are in."""
    names = [[] for _ in range(n_faces)]
    for i, group in enumerate(groups):
        for face in group.members:
            names[face].append(i)
    pieces = {}
    for face, combination in enumerate(names):
        if combination:
            pieces.setdefault(tuple(combination), []).append(face)
    result = []
    for combination, members in sorted(pieces.items(), key=lambda item: (len(item[0]), item[0])):
        piece = Group(" + ".join(groups[i].name for i in combination), members, groups[combination[0]].source)
        if len(combination) > 1:
            piece.source = "faces in several sets"
        result.append(piece)
    return result


def _numbered(groups, ids):
    """Ids of the file are kept, others follow."""
    used = set(ids.values())
    following = (number for number in range(1, 10**9) if number not in used)
    for group in groups:
        known = [ids[name] for name in group.names if name in ids]
        group.id = known[0] if known else next(following)
    return groups
