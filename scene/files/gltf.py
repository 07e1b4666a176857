"""glTF 2.0 and GLB: the meshes of the default scene, placed by its nodes, as the file stores them.

This reader is our own. A general loader would need checks of chunks, buffers, views, accessors and
the node graph first, which is most of the reading itself, and it would take about a second for each
file. Materials, textures and cameras are not read. Sources: the Khronos glTF 2.0
specification.
"""

from __future__ import annotations

from typing import Any

from msgspec.structs import replace

from satcheck.core import Mesh
from satcheck.core.shapes import Box, Primitive
from satcheck.core.transform import Transform
from satcheck.scene.bodies import IDENTITY
from satcheck.scene.document import (
    NO_SURFACE,
    Document,
    Item,
    RawMesh,
    RawPart,
    RawRule,
    Refusal,
    UniqueNames,
)
from satcheck.scene.errors import Refused
from satcheck.scene.files import limits
from satcheck.scene.files.gltf_accessors import Accessors
from satcheck.scene.files.gltf_buffers import (
    BufferViews,
    Work,
    extension,
    integer,
    items,
    member,
    split_glb,
)
from satcheck.scene.files.gltf_colliders import UPRIGHT, Collider, Colliders, refuse_skew
from satcheck.scene.files.gltf_meshes import Meshes, Shape, Skin
from satcheck.scene.files.gltf_nodes import NodeGraph, parse_document, trs_placement
from satcheck.scene.files.gltf_vocabulary import ANIMATING, EXTENSIONS, INSTANCING, look_at
from satcheck.scene.files.placing import Instance, multiply, raw_scene, tidy_name
from satcheck.scene.files.readers import File
from satcheck.scene.vocabulary import UnknownNames
from satcheck.scene.words import listed

# Extensions that move all of the geometry even where they are optional.
_MOVING = frozenset({"CESIUM_RTC"})
_ANIMATED = ("time-sampled", "the file is animated; checked as stored")


def read_gltf(file: File) -> Document:
    """Return the default scene of a glTF or GLB file: its meshes, and the nodes that have one; for
    the geometry `collision` its colliders, and the nodes that have one.

    Raises Refused without a file name, and NeedsChild if the data need an isolated process
    and this one is not.
    """
    geometry = file.options["geometry"]
    data = memoryview(file.data)
    text, chunk = split_glb(data) if file.format == "glb" else (data, None)
    document = parse_document(text)
    unknown = UnknownNames()
    _check_extensions(document)
    look_at(document, unknown)
    work = Work(isolated=file.isolated)
    views = BufferViews(document, chunk, file.directory, work, file.permitted)
    accessors = Accessors(document, views, work)
    meshes = Meshes(document, accessors, work)
    graph = NodeGraph(document, work)
    colliders = Colliders(document, unknown)
    reader = _Scene(document, accessors, meshes, graph, work)
    if geometry == "collision":
        scene = reader.colliders(colliders)
    else:
        scene = reader.read()
        if colliders.any():
            message = "meshes are checked, and no colliders (--geometry collision checks them)"
            if geometry is None:
                unknown.note(("colliders", ""), message)
            else:
                scene = replace(scene, warnings=(*scene.warnings, ("left-out", message)))
    if graph.unclear_scene():
        unknown.note(
            ("scene", ""), "the file has several scenes and no default: only the first is read"
        )
    animated = items(document, "animations") or ANIMATING & set(_names(document, "extensionsUsed"))
    left_out = graph.left_out()
    warnings = (
        *scene.warnings,
        *unknown.warnings(),
        *([_ANIMATED] if animated else []),
        *([("left-out", left_out)] if left_out else []),
    )
    return replace(scene, warnings=warnings)


def _check_extensions(document: dict[str, Any]) -> None:
    for name in _names(document, "extensionsRequired"):
        if not EXTENSIONS.knows(name):
            raise Refused("unsupported-feature", f"the file requires extension {name!r}")
    for name in _names(document, "extensionsUsed"):
        if name in _MOVING:
            raise Refused("unsupported-feature", f"extension {name!r} is not read")


def _names(document: dict[str, Any], key: str) -> list[str]:
    names = items(document, key)
    if not all(isinstance(name, str) for name in names):
        raise Refused("bad-record", f"glTF: {key} should be a list of texts")
    return names


def _without_surface(mesh: RawMesh | Refusal) -> bool:
    return isinstance(mesh, Refusal) and mesh.code == NO_SURFACE


class _Scene:
    def __init__(
        self,
        document: dict[str, Any],
        accessors: Accessors,
        meshes: Meshes,
        graph: NodeGraph,
        work: Work,
    ) -> None:
        self._work = work
        self._document = document
        self._accessors = accessors
        self._nodes = items(document, "nodes")
        self._graph = graph
        self._meshes = meshes
        self._copied = 0

    def read(self) -> Document:
        paths = UniqueNames()
        placed = [
            Instance(self._shape(node.key), matrix, paths.unique(path))
            for node in self._graph.drawn()
            for path, matrix in self._copies(node)
        ]
        meshes = {shape: self._mesh(shape) for shape in dict.fromkeys(one.key for one in placed)}
        solid = [one for one in placed if not _without_surface(meshes[one.key])]
        if not solid:
            raise Refused("empty-mesh", "empty mesh: the scene has no triangles")
        scene = raw_scene(solid, lambda shape: self._mesh_name(shape.mesh), meshes.__getitem__)
        bare = [one.path for one in placed if _without_surface(meshes[one.key])]
        if not bare:
            return scene
        message = f"{listed(bare)} without triangles: lines, points or nothing"
        return replace(scene, warnings=(("left-out", message),))

    def colliders(self, colliders: Colliders) -> Document:
        """The colliders of the nodes. Those of one rigid body may touch each other."""
        placed = self._graph.placed(colliders.has)
        if not placed:
            raise Refused("empty-mesh", "no node of the scene has a collider")
        parts, nodes = [], []
        for number, one in enumerate(placed):
            collider = colliders.of(one.key)
            content, matrix = self._content(collider, one.matrix)
            body = self._graph.nearest(one.key, colliders.moves)
            parts.append(RawPart(f"collider{number}", content))
            groups = () if body is None else (f"rigid body {body}",)
            nodes.append(Item(number, one.path, matrix, groups=groups))
        bodies = dict.fromkeys(group for node in nodes for group in node.groups)
        rules = [
            RawRule(name, name, "colliders of one rigid body", of_groups=True) for name in bodies
        ]
        note = "left-out", "colliders are checked: meshes that are no collider have no body"
        return Document(tuple(parts), tuple(nodes), (note,), "meter", tuple(rules))

    def _content(
        self, collider: Collider, matrix: Transform | None
    ) -> tuple[RawMesh | Primitive | Refusal, Transform | None]:
        """The mesh or shape of a collider, and its placement."""
        shape = collider.shape
        try:
            if isinstance(shape, Refusal):
                return shape, matrix
            if isinstance(shape, int):
                key = Shape(shape) if collider.node is None else self._shape(collider.node)
                mesh = self._mesh(key)
                if collider.hull and isinstance(mesh, RawMesh):
                    hull = Mesh.from_bytes(mesh.vertices, mesh.triangles).convex_hull().to_mesh()
                    vertices, triangles = hull.to_bytes()
                    mesh = replace(mesh, vertices=vertices, triangles=triangles)
                return mesh, None if key.skin is not None else matrix
            if not isinstance(shape, Box):
                matrix = multiply(matrix, UPRIGHT)
                refuse_skew(shape, matrix)
            return shape, matrix
        except Refused as error:
            return Refusal(error.code, error.message), matrix
        except (OverflowError, ValueError) as error:
            return Refusal("bad-record", f"convex hull: {error}"), matrix

    def _shape(self, number: int) -> Shape:
        node, mesh = self._nodes[number], self._graph.mesh_of(number)
        skin = integer(node, "skin", -1) if "skin" in node else None
        return Shape(mesh, self._meshes.weights(mesh, node), skin)

    def _mesh(self, shape: Shape) -> RawMesh | Refusal:
        """Returns a Refusal for a mesh that cannot be used, so that its nodes stay in the scene."""
        try:
            skin = None if shape.skin is None else self._skin(shape.skin)
            return self._meshes.read(shape, skin)
        except Refused as error:
            return Refusal(error.code, error.message)

    def _copies(self, node: Instance[int]) -> list[tuple[str, Transform | None]]:
        """(path, matrix) of a node, or of each GPU instance of the node."""
        instancing = extension(self._nodes[node.key], INSTANCING)
        if "skin" in self._nodes[node.key]:  # its joints place it
            return [(node.path, None)]
        if instancing is None:
            return [(node.path, node.matrix)]
        attributes = instancing.get("attributes")
        if not isinstance(attributes, dict):
            raise Refused("bad-record", f"node {node.key}: instances without attributes")
        columns = self._accessors.columns(attributes)
        translations = columns("TRANSLATION", "VEC3")
        rotations = columns("ROTATION", "VEC4")
        scales = columns("SCALE", "VEC3")
        given = ((translations, 3), (rotations, 4), (scales, 3))
        counts = {len(rows) // width for rows, width in given if rows is not None}
        if len(counts) != 1 or 0 in counts:
            raise Refused("count-mismatch", f"node {node.key}: unclear count of instances")
        (count,) = counts
        self._copied += count
        if self._copied > limits.MAX_PLACEMENTS:
            message = f"more than {limits.MAX_PLACEMENTS} instances: split the file"
            raise Refused("too-large", message)
        copies = []
        for i in range(count):
            parts = (
                None if rows is None else rows[width * i : width * (i + 1)] for rows, width in given
            )
            copies.append((f"{node.path}[{i}]", multiply(node.matrix, trs_placement(*parts))))
        return copies

    def _skin(self, number: int) -> Skin:
        skin = member(items(self._document, "skins"), number, "skin")
        joints = [self._graph.number(joint) for joint in items(skin, "joints")]
        bound = None
        if "inverseBindMatrices" in skin:
            bound = self._accessors.numbers(integer(skin, "inverseBindMatrices", -1), "MAT4")
            if len(bound) < 16 * len(joints):
                raise Refused("count-mismatch", f"skin {number}: a joint lacks its matrix")
        return Skin(tuple(self._graph.world(joint) or IDENTITY for joint in joints), bound)

    def _mesh_name(self, number: int) -> str:
        return tidy_name(self._meshes.name(number), f"mesh{number}")
