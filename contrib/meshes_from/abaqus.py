"""Abaqus and CalculiX decks: nodes, solid elements, sets and surfaces, also of parts and their instances."""

import numpy as np

from .abaqus_lines import read_keywords
from .abaqus_scope import NONE, Scope
from .mesh import Block, Faces, Mesh, MeshError, face_rows

# These make or move nodes and elements: without them the mesh would be another one.
REFUSED = {"NGEN", "NFILL", "NCOPY", "NMAP", "ELGEN", "ELCOPY", "SYSTEM", "MESH", "PARAMETER"}


class Deck:
    """A deck as it is read, keyword after keyword."""

    def __init__(self, path):
        self.path, self.root, self.parts, self.skipped = path, Scope(""), {}, {}
        self.places = {}  # number of an instance -> (name, rotation, translation)
        current = self.root
        for keyword in read_keywords(path):
            if keyword.name in REFUSED:
                raise MeshError(f"{keyword.where()}: *{keyword.name} is not read; let the preprocessor write all nodes and "
                                "elements")
            if keyword.name == "PART":
                current = self.parts.setdefault(keyword.need("NAME").upper(), Scope(keyword.need("NAME")))
            elif keyword.name == "INSTANCE":
                current = self._add_instance(keyword)
            elif keyword.name in ("END PART", "END INSTANCE"):
                current = self.root
            elif keyword.name == "NODE":
                current.add_nodes(keyword)
            elif keyword.name == "ELEMENT":
                current.add_elements(keyword)
            elif keyword.name in ("NSET", "ELSET"):
                current.add_set(keyword)
            elif keyword.name not in ("ASSEMBLY", "END ASSEMBLY", "HEADING") and not (
                    keyword.name == "SURFACE" and current.add_surface(keyword)):
                self.skipped["*" + keyword.name] = self.skipped.get("*" + keyword.name, 0) + 1

    def _add_instance(self, keyword):
        name, part = keyword.need("NAME"), keyword.need("PART")
        if "LIBRARY" in keyword.parameters or part.upper() not in self.parts:
            raise MeshError(f"{keyword.where()}: there is no part {part} in this deck")
        if name.upper() in self.root.instances:
            raise MeshError(f"{keyword.where()}: instance {name} is there already")
        try:
            rows = [[float(entry) for entry in line.rstrip(", ").split(",")] for line in keyword.lines]
            shift = np.array(rows[0] if rows else [0., 0., 0.]).reshape(3)
            rotation, fixed = _rotation(*np.array(rows[1]).reshape(7)) if len(rows) > 1 else (np.eye(3), np.zeros(3))
        except ValueError:
            raise MeshError(f"{keyword.where()}: an instance is placed by a line with a shift (3 numbers) and one with two "
                            "points of an axis and an angle (7 numbers)") from None
        number = len(self.root.instances) + 1
        scope = Scope(name, self.parts[part.upper()])
        self.root.instances[name.upper()] = (number, scope)
        # first the shift, then the rotation about an axis that is where the deck says
        self.places[number] = (name, rotation, rotation @ (shift - fixed) + fixed)
        return scope

    def scopes(self):
        """(number, scope, rotation, translation) of all that have elements; the deck itself has number 0."""
        yield 0, self.root, np.eye(3), np.zeros(3)
        for number, scope in self.root.instances.values():
            yield (number, scope) + self.places[number][1:]


def _rotation(*numbers):
    """Matrix of a right-handed rotation in degrees about the axis from a to b, and the fixed point a."""
    a, b, angle = np.array(numbers[:3]), np.array(numbers[3:6]), np.radians(numbers[6])
    axis = (b - a) / np.linalg.norm(b - a)
    if not np.isfinite(axis).all():
        raise ValueError
    cross = np.cross(np.eye(3), axis)
    return np.cos(angle) * np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * np.outer(axis, axis), a


class _Lookup:
    """Positions of numbers in the mesh."""

    def __init__(self, labels):
        self.order = np.argsort(labels)
        self.sorted = labels[self.order]

    def __call__(self, wanted):
        """Position of each, -1 where there is none."""
        if not len(self.sorted):
            return np.full(len(wanted), -1)
        at = np.minimum(np.searchsorted(self.sorted, wanted), len(self.sorted) - 1)
        return np.where(self.sorted[at] == wanted, self.order[at], -1)


def read_abaqus(path):
    """The mesh of a deck. @raises MeshError with file and line of what is wrong."""
    deck = Deck(path)
    node_labels, points, blocks, skin_labels, skin_nodes = [NONE], [np.zeros((0, 3))], {}, [NONE], [np.zeros((0, 4), int)]
    for number, scope, rotation, translation in deck.scopes():
        scope.check()
        offset = number * Mesh.INSTANCE
        for labels, positions, _, _ in scope.all("nodes"):
            node_labels.append(labels + offset)
            points.append(positions @ rotation.T + translation if number else positions)
        for kind, labels, nodes, _, _ in scope.all("elements"):
            blocks.setdefault(kind, []).append((labels + offset, nodes + offset))
        for labels, nodes in scope.all("skins"):
            skin_labels.append(labels + offset)
            skin_nodes.append(np.pad(nodes + offset, ((0, 0), (0, 4 - nodes.shape[1])), constant_values=-1))
        for name, count in scope.skipped.items():
            deck.skipped[name] = deck.skipped.get(name, 0) + count
    if not any(len(labels) for found in blocks.values() for labels, _ in found):
        raise MeshError(f"{path}: there are no solid elements"
                        + (", or no instance of the parts" if deck.parts and not deck.root.instances else ""))
    find_node = _Lookup(np.concatenate(node_labels))
    mesh = Mesh(path, np.concatenate(points), [
        Block(kind, find_node(np.concatenate([nodes for _, nodes in found]).reshape(-1)),
              np.concatenate([labels for labels, _ in found])) for kind, found in blocks.items()])
    mesh.instances = [scope.name for _, scope in deck.root.instances.values()]
    mesh.skipped = deck.skipped
    _add_sets(deck, mesh, find_node, np.concatenate(skin_labels), np.concatenate(skin_nodes))
    return mesh


def _add_sets(deck, mesh, find_node, skin_labels, skin_nodes):
    find_element, find_skin = _Lookup(mesh.labels), _Lookup(skin_labels)
    skin_rows = np.sort(np.where(skin_nodes < 0, -1, find_node(skin_nodes.reshape(-1)).reshape(-1, 4)), axis=1)
    for number, scope, _, _ in deck.scopes():
        offset, prefix = number * Mesh.INSTANCE, scope.name + "." if number else ""
        if number:
            own = np.flatnonzero(mesh.labels // Mesh.INSTANCE == number)
            if len(own):
                mesh.element_sets[scope.name] = own
        for key, found in scope.every("ELSET").items():
            labels = scope.labels("ELSET", key, None, None) + offset
            elements, skins = find_element(labels), find_skin(labels)
            _note_missing(mesh, f"element set {prefix}{found.name}", labels, (elements < 0) & (skins < 0), deck.skipped)
            if (elements >= 0).any() and not found.internal:
                mesh.element_sets[prefix + found.name] = elements[elements >= 0]
            if (skins >= 0).any():
                mesh.face_sets[prefix + found.name] = skin_rows[skins[skins >= 0]]
        for key, found in scope.every("NSET").items():
            _add_node_set(mesh, prefix + found.name, scope.labels("NSET", key, None, None) + offset, find_node, found.internal)
        surfaces = {**(scope.base.surfaces if scope.base else {}), **scope.surfaces}
        for surface in surfaces.values():
            if surface.of_nodes:
                labels = [_numbers(scope, "NSET", *entry) for entry in surface.entries]
                _add_node_set(mesh, prefix + surface.name, np.concatenate([NONE] + labels) + offset, find_node, False)
            else:
                mesh.face_sets[prefix + surface.name] = _surface(mesh, scope, surface, find_element, offset)


def _add_node_set(mesh, name, labels, find_node, internal):
    found = find_node(np.unique(labels))
    _note_missing(mesh, f"node set {name}", np.unique(labels), found < 0, {})
    if not internal and (found >= 0).any():
        mesh.node_sets[name] = found[found >= 0]


def _note_missing(mesh, what, labels, missing, passed_over):
    """What sets name need not be there: Abaqus warns, too."""
    if not len(labels):
        mesh.notes.append(f"{what} is empty")
    elif missing.any() and not any(name.startswith("*ELEMENT") for name in passed_over):
        kind = what.split()[0]
        mesh.notes.append(f"{what} names {missing.sum()} {kind}s that are not there, the first "
                          f"{labels[missing][0] % Mesh.INSTANCE}")


def _numbers(scope, kind, text, face, keyword, line):
    return np.array([int(text)]) if text.isdigit() else scope.labels(kind, text, keyword, line)


def _surface(mesh, scope, surface, find_element, offset):
    """Rows of the faces of *SURFACE, TYPE=ELEMENT."""
    rows = [np.zeros((0, 4), int)]
    for entry in surface.entries:
        _, face, keyword, line = entry
        elements = find_element(_numbers(scope, "ELSET", *entry) + offset)
        if (elements < 0).any():
            mesh.notes.append(f"surface {surface.name}: {(elements < 0).sum()} elements ({keyword.where(line)}) are no solids "
                              "that are there, left out")
        if face is not None and not (len(face) == 2 and face[0] == "S" and face[1] in "123456"):
            mesh.notes.append(f"surface {surface.name}: side {face} ({keyword.where(line)}) is none of a solid, left out")
            continue
        for block, start in zip(mesh.blocks, mesh.starts()):
            own = elements[(elements >= start) & (elements < start + len(block.nodes))] - start
            sides = block.kind.shape.faces
            if face is not None and len(own) and int(face[1]) > len(sides):
                raise MeshError(f"{keyword.where(line)}: {mesh.name(start + own[0])} has {len(sides)} faces, no {face}")
            chosen = sides if face is None else sides[int(face[1]) - 1:int(face[1])]
            found = [face_rows(block.nodes[own][:, side]) for side in chosen]
            rows += found if face is not None else [_outer(mesh, np.concatenate(found))]
    return np.concatenate(rows)


def _outer(mesh, rows):
    """Without a side, *SURFACE means all faces of the elements that are on the outside."""
    faces = Faces(mesh)
    return rows[faces.outer[faces.find(rows)]]
