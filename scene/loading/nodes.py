"""Makes the bodies of a file that is read: one of all of it, one for each node, or one for each
connected component of these."""

from __future__ import annotations

from array import array
from collections.abc import Iterator, Mapping
from typing import Literal

from msgspec import Struct
from msgspec.structs import replace

from satcheck.core import Mesh
from satcheck.core.shapes import Primitive
from satcheck.core.transform import Transform
from satcheck.scene.bodies import MeshFile
from satcheck.scene.errors import Refused
from satcheck.scene.health import CRACK_WIDTH
from satcheck.scene.inspect import errors_of, mesh_file, resolution_of, shape_file
from satcheck.scene.issue import Issue, issue
from satcheck.scene.loading import limits
from satcheck.scene.loading.flatten import flattened
from satcheck.scene.loading.raw_mesh import (
    RawJoint,
    RawMesh,
    RawNode,
    RawPart,
    RawRule,
    RawScene,
    Refusal,
)
from satcheck.scene.loading.readers import File
from satcheck.scene.plain_ids import COMPONENT_MARK, UniqueNames
from satcheck.scene.planar.outline import Shape
from satcheck.scene.rules import Rule, Selector

# "none": the whole file is one body.
Split = Literal["nodes", "components", "none"]
Marked = list[tuple[str, MeshFile | Refused]]  # (the end of the path of a node, its mesh)

_ONLY_DEGENERATE = "only-degenerate"
CORNER = Mesh.from_bytes(
    array("d", (0, 0, 0, 1, 0, 0, 0, 1, 0)).tobytes(), array("I", (0, 1, 2)).tobytes()
)


class Node(Struct, frozen=True):
    """A mesh with its placement, or the error if it cannot be used.

    path: unique in the file; it ends in "#3" for the third component. None: all of the file. Nodes
    with one mesh share the MeshFile. transform: as in Body. shape: the exact shape whose mesh is
    `file`. title, groups, static, link: as in RawNode. pinned, units, surface_tolerance: as in
    `BodyEntry`.
    """

    path: str | None
    file: MeshFile | Refused
    transform: Transform | None = None
    shape: Shape | None = None
    title: str | None = None
    groups: tuple[str, ...] = ()
    static: bool = False
    link: str | None = None
    pinned: bool = False
    units: str | None = None
    surface_tolerance: float | None = None


class Nodes(Struct, frozen=True):
    """All nodes of a file by their paths, in file order, the warnings that concern no single node,
    and the rules and joints of a document."""

    nodes: Mapping[str | None, Node]
    issues: tuple[Issue, ...] = ()
    rules: tuple[RawRule, ...] = ()
    joints: tuple[RawJoint, ...] = ()


def nodes_of(file: File, scene: RawScene, split: Split) -> Nodes:
    """Return the bodies of a file.

    Components are edge-connected, after cracks are closed. They are numbered by their lowest
    corners, so that the order of the triangles in the file does not matter. Raises Refused if
    nothing can be used.
    """
    if split == "none":
        return Nodes({None: Node(None, mesh_file(file, flattened(scene)))})
    said = list(scene.warnings)
    meshes = [
        _meshes_of(file, part, scene.units, said, apart=split == "components")
        for part in scene.parts
    ]
    _refuse_too_many(sum(len(meshes[node.part]) for node in scene.nodes))
    nodes = {
        path: _placed(path, mesh, node, scene.parts[node.part].mesh)
        for node in scene.nodes
        for mark, mesh in meshes[node.part]
        for path in [f"{node.path or ''}{mark}" or None]
    }
    errors = [node.file for node in nodes.values() if isinstance(node.file, Refused)]
    if len(errors) == len(nodes):
        raise errors[0]
    issues = tuple(issue(code, message, file=file.path) for code, message in said)
    return Nodes(nodes, issues, scene.rules, scene.joints)


def _refuse_too_many(bodies: int) -> None:
    if bodies > limits.MAX_PLACEMENTS:
        message = f"{bodies} bodies exceed {limits.MAX_PLACEMENTS}: split the file"
        raise Refused("too-large", message)


def _placed(
    path: str | None,
    file: MeshFile | Refused,
    raw: RawNode,
    mesh: RawMesh | Primitive | Refusal,
) -> Node:
    if raw.matrix is not None and isinstance(file, MeshFile):
        try:
            CORNER.transformed(raw.matrix)
        except ValueError as error:
            file = Refused("singular-transform", f"{path}: {error}", file=file.path)
        except OverflowError:  # of this corner; placing the mesh reports its overflow
            pass
    shape = None if isinstance(mesh, RawMesh | Refusal) else mesh
    return Node(path, file, raw.matrix, shape, raw.title, raw.groups, raw.static, raw.link)


def _meshes_of(
    file: File, part: RawPart, units: str | None, said: list[tuple[str, str]], *, apart: bool
) -> Marked:
    """Return the mesh of a part, or its components. units: of exact shapes. said: of the file; this
    call adds to it."""
    raw = part.mesh
    where = f"mesh {part.name!r}: " if part.name else ""
    if isinstance(raw, Refusal):
        return [("", Refused(raw.code, where + raw.message, file=file.path))]
    try:
        with errors_of(file.path):
            if not isinstance(raw, RawMesh):
                return [("", replace(shape_file(raw, file.path), units=units))]
            mesh = Mesh.from_bytes(raw.vertices, raw.triangles)
            bodies = _components(file, part, raw, mesh) if apart else []
            if not bodies:
                whole = mesh_file(file, raw, mesh, part.name or None, placed=bool(part.name))
                return [("", whole)]
    except Refused as error:
        return [("", Refused(error.code, where + error.message, file=file.path))]
    said += [(code, where + message) for code, message in raw.warnings]
    if flat := sum(isinstance(body, Refused) for _, body in bodies):
        message = f"{where}{flat} loose pieces of area 0 are left out"
        said.append(("degenerate-triangles", message))
    return [body for body in bodies if isinstance(body[1], MeshFile)]


def _components(file: File, part: RawPart, raw: RawMesh, mesh: Mesh) -> Marked:
    """Return the components of a mesh if it has several, and an error for each of area 0; nothing
    if all are."""
    pieces = mesh.welded().sorted().components(CRACK_WIDTH * resolution_of(raw, mesh))
    if len(pieces) < 2:
        return []
    _refuse_too_many(len(pieces))
    raw = replace(raw, warnings=())
    bodies: Marked = []
    flat: Marked = []
    for piece in pieces:
        mark = f"{COMPONENT_MARK}{len(bodies) + 1}"
        name = f"{part.name}{mark}"
        try:
            bodies.append((mark, mesh_file(file, raw, piece, name, placed=bool(part.name))))
        except Refused as error:
            if error.code != _ONLY_DEGENERATE:
                raise
            flat.append(("", error))
    return [*bodies, *flat] if bodies else []


def groups_of(nodes: Nodes, names: UniqueNames, shared: dict[str, str]) -> dict[str, str]:
    """Return the groups of a document -> their names in the check.

    Groups of several documents that have one name are one group, unless rules of a document name
    the group. names: of all groups in the check. shared: of these documents; this call adds to it.
    """
    ruled = {group for rule in nodes.rules if rule.of_groups for group in (rule.a, rule.b)}
    groups: dict[str, str] = {}
    for group in dict.fromkeys(group for node in nodes.nodes.values() for group in node.groups):
        if group not in ruled and group not in shared:
            shared[group] = names.unique(group)
        groups[group] = names.unique(group) if group in ruled else shared[group]
    return groups


def document_rules(
    nodes: Nodes, ids: Mapping[str | None, str], groups: Mapping[str, str], path: str
) -> Iterator[Rule]:
    """The rules of the document at `path`. ids, groups: of its nodes -> their names in
    the check."""
    for rule in nodes.rules:
        select = Selector.exactly_group if rule.of_groups else Selector.exactly
        names = groups if rule.of_groups else ids
        if rule.a in names and rule.b in names:
            yield Rule(
                a=select(names[rule.a]),
                b=select(names[rule.b]),
                allowed=True if rule.severity is None else None,
                severity=rule.severity,
                reason=rule.reason,
                where=f"{path}: {rule.reason}",
                file=path,
            )
