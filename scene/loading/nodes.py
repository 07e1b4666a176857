"""Splits a mesh file into one body for each node, or for each connected component of a node."""

from __future__ import annotations

from array import array
from pathlib import Path

from msgspec import Struct
from msgspec.structs import replace

from satcheck.core import Mesh
from satcheck.core.shapes import Primitive
from satcheck.core.transform import Transform
from satcheck.scene.bodies import MeshFile
from satcheck.scene.errors import MeshFileError
from satcheck.scene.health import CRACK_WIDTH
from satcheck.scene.issue import Issue, issue
from satcheck.scene.loading import (
    ReadLimits,
    limits,
    mesh_file,
    mesh_of,
    open_source,
    read_scene,
    resolution_of,
)
from satcheck.scene.loading.raw_mesh import (
    RawJoint,
    RawMesh,
    RawNode,
    RawPart,
    RawRule,
    RawScene,
    Refusal,
)
from satcheck.scene.loading.reading_children import ReadingChildren
from satcheck.scene.loading.source import Source
from satcheck.scene.plain_ids import COMPONENT_MARK
from satcheck.scene.shape_file import shape_file

_ONLY_DEGENERATE = "only-degenerate"
CORNER = Mesh.from_bytes(
    array("d", (0, 0, 0, 1, 0, 0, 0, 1, 0)).tobytes(), array("I", (0, 1, 2)).tobytes()
)


class Node(Struct, frozen=True):
    """A mesh of a file with its placement, or the error if it cannot be used.

    path: unique in the file; it ends in "#3" for the third component. None: the file has no parts.
    Nodes with one mesh share the MeshFile. transform: as in Body. shape: the exact shape whose mesh
    is `file`. title, groups, static, link: as in RawNode.
    """

    path: str | None
    file: MeshFile | MeshFileError
    transform: Transform | None = None
    shape: Primitive | None = None
    title: str | None = None
    groups: tuple[str, ...] = ()
    static: bool = False
    link: str | None = None


class Nodes(Struct, frozen=True):
    """All nodes of a file, in file order, the warnings that concern no single node, and the rules
    and joints of a document."""

    nodes: tuple[Node, ...]
    issues: tuple[Issue, ...] = ()
    rules: tuple[RawRule, ...] = ()
    joints: tuple[RawJoint, ...] = ()


def load_nodes(
    path: str,
    location: Path,
    allowed: ReadLimits,
    children: ReadingChildren,
    *,
    components: bool,
) -> Nodes:
    """Reads one mesh file and splits it.

    components: also split each node into edge-connected parts, after cracks are closed. Parts are
    numbered by their lowest corners, so that the order of the triangles in the file does not
    matter. Raises MeshFileError if no node can be used.
    """
    source = open_source(path, location, allowed)
    scene = read_scene(source, allowed, children, flat=False)
    return nodes_of(source, scene, components=components)


def nodes_of(source: Source, scene: RawScene, *, components: bool) -> Nodes:
    """As `load_nodes`, of a file that is read."""
    path = source.path
    splitter = _Splitter(source, components, scene.units)
    meshes = [splitter.split(part) for part in scene.parts]
    _refuse_too_many(sum(len(meshes[node.part]) for node in scene.nodes), path)
    nodes = tuple(
        _placed(f"{node.path or ''}{mark}" or None, file, node, scene.parts[node.part].mesh)
        for node in scene.nodes
        for mark, file in meshes[node.part]
    )
    if all(isinstance(node.file, MeshFileError) for node in nodes):
        raise next(node.file for node in nodes if isinstance(node.file, MeshFileError))
    issues = (issue(code, message, file=path) for code, message in scene.warnings)
    return Nodes(nodes, (*issues, *splitter.issues), scene.rules, scene.joints)


def _refuse_too_many(bodies: int, path: str) -> None:
    if bodies > limits.MAX_PLACEMENTS:
        message = f"{bodies} bodies exceed {limits.MAX_PLACEMENTS}: split the file"
        raise MeshFileError("too-large", message, file=path)


def _placed(
    path: str | None,
    file: MeshFile | MeshFileError,
    raw: RawNode,
    mesh: RawMesh | Primitive | Refusal,
) -> Node:
    matrix = raw.matrix
    if matrix is not None and isinstance(file, MeshFile):
        try:
            CORNER.transformed(matrix)
        except ValueError as error:
            file = MeshFileError("singular-transform", f"{path}: {error}", file=file.path)
        except OverflowError:  # of this corner; placing the mesh reports its overflow
            pass
    shape = None if isinstance(mesh, RawMesh | Refusal) else mesh
    return Node(path, file, matrix, shape, raw.title, raw.groups, raw.static, raw.link)


class _Splitter:
    """units: of exact shapes."""

    def __init__(self, source: Source, components: bool, units: str | None) -> None:
        self._source = source
        self._components = components
        self._units = units
        self.issues: list[Issue] = []

    def split(self, part: RawPart) -> list[tuple[str, MeshFile | MeshFileError]]:
        """(suffix of the node's path, mesh) for each body."""
        raw = part.mesh
        if isinstance(raw, Refusal):
            return [("", self._named(part, raw))]
        try:
            if not isinstance(raw, RawMesh):
                return [("", replace(shape_file(raw, self._source.path), units=self._units))]
            mesh = mesh_of(self._source, raw)
            pieces = self._connected(raw, mesh) if self._components else []
            bodies = self._pieces(part, raw, pieces) if len(pieces) > 1 else []
            return bodies or [("", self._file(part, raw, mesh))]
        except MeshFileError as error:
            return [("", self._named(part, error))]

    @staticmethod
    def _connected(raw: RawMesh, mesh: Mesh) -> list[Mesh]:
        return mesh.welded().sorted().components(CRACK_WIDTH * resolution_of(raw, mesh))

    def _pieces(
        self, part: RawPart, raw: RawMesh, pieces: list[Mesh]
    ) -> list[tuple[str, MeshFile | MeshFileError]]:
        """The components with an area. Those of area 0 cause one warning."""
        _refuse_too_many(len(pieces), self._source.path)
        bodies: list[tuple[str, MeshFile | MeshFileError]] = []
        flat = 0
        for piece in pieces:
            mark = f"{COMPONENT_MARK}{len(bodies) + 1}"
            try:
                bodies.append((mark, self._file(part, replace(raw, warnings=()), piece, mark)))
            except MeshFileError as error:
                if error.code != _ONLY_DEGENERATE:
                    raise
                flat += 1
        if bodies:
            for code, message in raw.warnings:
                self._warn(code, part, message)
        if bodies and flat:
            self._warn("degenerate-triangles", part, f"{flat} loose pieces of area 0 are left out")
        return bodies

    def _file(self, part: RawPart, raw: RawMesh, mesh: Mesh, mark: str = "") -> MeshFile:
        name = f"{part.name}{mark}" or None
        return mesh_file(self._source, raw, mesh, name, placed=bool(part.name))

    def _warn(self, code: str, part: RawPart, message: str) -> None:
        self.issues.append(issue(code, self._where(part) + message, file=self._source.path))

    def _named(self, part: RawPart, error: MeshFileError | Refusal) -> MeshFileError:
        return MeshFileError(error.code, self._where(part) + error.message, file=self._source.path)

    @staticmethod
    def _where(part: RawPart) -> str:
        return f"mesh {part.name!r}: " if part.name else ""
