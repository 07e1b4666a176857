"""glTF 2.0 and GLB: the meshes of the default scene, placed by its nodes, as the file stores them.

This reader is our own. A general loader would need checks of chunks, buffers, views, accessors and
the node graph first, which is most of the reading itself, and it would take about a second for each
file. Materials, textures and cameras are not read. Sources: the Khronos glTF 2.0
specification.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from functools import cached_property

from msgspec.structs import replace

from satcheck.core.shapes import Box, Primitive
from satcheck.core.transform import Transform, placed, quaternion_matrix
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
from satcheck.scene.files.gltf_buffers import Accessors, Work, split_glb
from satcheck.scene.files.gltf_colliders import UPRIGHT, Collider, Colliders, refuse_skew
from satcheck.scene.files.gltf_document import (
    ANIMATING,
    INSTANCING,
    NONE,
    GltfDocument,
    Instancing,
    read_document,
)
from satcheck.scene.files.gltf_meshes import Meshes, Shape, Skin
from satcheck.scene.files.nodes import hull_of
from satcheck.scene.files.placing import Instance, instances, multiply, raw_scene, tidy_name
from satcheck.scene.files.readers import File
from satcheck.scene.vocabulary import UnknownNames
from satcheck.scene.words import listed


def read_gltf(file: File) -> Document:
    """Return the default scene of a glTF or GLB file: its meshes, and the nodes that have one; for
    the geometry `collision` its colliders, and the nodes that have one.

    Raises Refused without a file name, and NeedsChild if the data need an isolated process
    and this one is not.
    """
    geometry = file.options["geometry"]
    data = memoryview(file.data)
    text, chunk = split_glb(data) if file.format == "glb" else (data, None)
    unknown = UnknownNames()
    document = read_document(text, unknown)
    work = Work(isolated=file.isolated)
    reader = GltfScene(document, Accessors(document, chunk, file.context, work))
    colliders = Colliders(document, unknown)
    warnings: list[tuple[str, str]] = []
    if geometry == "collision":
        scene = reader.colliders(colliders)
    else:
        scene = reader.read()
        if colliders:
            scene = reader.linked(scene, colliders)
            message = "meshes are checked, and no colliders (--geometry collision checks them)"
            if geometry is None:
                unknown.note(("colliders", ""), message)
            else:
                warnings.append(("left-out", message))
    if document.stated.scene == NONE and len(document.scenes) > 1:
        message = "the file has several scenes and no default: only the first is read"
        unknown.note(("scene", ""), message)
    left_out = reader.left_out(unknown)
    warnings += unknown.warnings()
    if document.stated.animations or ANIMATING.intersection(document.stated.extensions_used):
        warnings.append(("time-sampled", "the file is animated; checked as stored"))
    warnings += [("left-out", left_out)] if left_out else []
    return replace(scene, warnings=(*scene.warnings, *warnings))


class GltfScene:
    """The default scene of a document. Its methods raise Refused. kind: the noun for a node in
    messages."""

    kind = "node"

    def __init__(self, document: GltfDocument, accessors: Accessors) -> None:
        self.document = document
        self.accessors = accessors
        self.nodes = document.nodes
        self.meshes = Meshes(document, accessors)
        self._copied = 0
        self._matrices: dict[int, Transform | None] = {}

    def read(self) -> Document:
        names = UniqueNames()
        placed = [
            Instance(Shape.of(self.nodes[node.key]), matrix, names.unique(path))
            for node in self._drawn
            for path, matrix in self._copies(node)
        ]
        meshes = {shape: self.mesh(shape) for shape in dict.fromkeys(one.key for one in placed)}
        bare = {
            shape
            for shape, mesh in meshes.items()
            if isinstance(mesh, Refusal) and mesh.code == NO_SURFACE
        }
        scene = raw_scene(
            [one for one in placed if one.key not in bare],
            lambda shape: self._mesh_name(shape.mesh),
            meshes.__getitem__,
        )
        if not bare:
            return scene
        paths = [one.path for one in placed if one.key in bare]
        message = f"{listed(paths)} without triangles: lines, points or nothing"
        return replace(scene, warnings=(("left-out", message),))

    def colliders(self, colliders: Colliders) -> Document:
        """The colliders of the nodes. Those of one rigid body may touch each other."""
        placed = self.placed(colliders.has)
        if not placed:
            raise Refused("empty-mesh", "no node of the scene has a collider")
        parts, nodes = [], []
        for number, one in enumerate(placed):
            content, matrix = self._content(colliders.of(one.key), one.matrix)
            link = self._link(one.key, colliders)
            parts.append(RawPart(f"collider{number}", content))
            groups = () if link is None else (link,)
            nodes.append(Item(number, one.path, matrix, groups=groups, link=link))
        bodies = dict.fromkeys(group for node in nodes for group in node.groups)
        rules = [RawRule.within(name, "colliders of one rigid body") for name in bodies]
        note = "left-out", "colliders are checked: meshes that are no collider have no body"
        return Document(tuple(parts), tuple(nodes), (note,), "meter", tuple(rules))

    def linked(self, drawn: Document, colliders: Colliders) -> Document:
        """Return the drawn meshes with the rigid bodies that they are part of."""
        links = {node.path: self._link(node.key, colliders) for node in self._drawn}
        items = (replace(item, link=links.get(item.path or "")) for item in drawn.items)
        return replace(drawn, items=tuple(items))

    def _link(self, number: int, colliders: Colliders) -> str | None:
        """The rigid body that a node is part of."""
        body = next(filter(colliders.moves, (number, *self._above(number))), None)
        return None if body is None else f"rigid body {body}"

    def left_out(self, unknown: UnknownNames) -> str:
        """Name the nodes with a mesh that the scene lacks, and count meshes without a node."""
        drawn = {node.key for node in self._drawn}
        used, lost = set(), []
        for number, node in enumerate(self.nodes):
            used.add(node.mesh)
            if node.mesh != NONE and number not in drawn:
                lost.append(f"node {number}")
            if node.mesh == NONE and INSTANCING in node.extensions:
                message = f"node {number}: {INSTANCING} is not read on a node without a mesh"
                unknown.note((INSTANCING, "mesh"), message)
        meshes = range(len(self.document.meshes))
        unused = [f"mesh {number}" for number in meshes if number not in used]
        said = [f"{listed(lost)} outside of the scene"] if lost else []
        said += [f"{listed(unused)} without a node"] if unused else []
        return "; ".join(said)

    @cached_property
    def _drawn(self) -> list[Instance[int]]:
        """The nodes of the scene with a mesh."""
        return self.placed(lambda number: self.nodes[number].mesh != NONE)

    def placed(self, chosen: Callable[[int], bool]) -> list[Instance[int]]:
        """The chosen nodes of the scene, by their numbers, with world matrix and path."""
        return instances(
            [(root, self.matrix(root)) for root in self._roots()],
            children=lambda number: [
                (child, self.matrix(child)) for child in self.nodes[number].children
            ],
            has_mesh=chosen,
            name=self.name,
            kind=self.kind,
        )

    def matrix(self, number: int) -> Transform | None:
        """The placement of a node in its parent."""
        if number not in self._matrices:
            node = self.nodes[number]
            columns = node.matrix
            if columns and columns[3::4] != (0.0, 0.0, 0.0, 1.0):
                raise Refused("bad-record", f"node {number}: the matrix is not affine")
            self._matrices[number] = (
                tuple(columns[4 * column + row] for row in range(4) for column in range(4))
                if columns
                else _trs_placement(node.translation, node.rotation, node.scale)
            )
        return self._matrices[number]

    def _roots(self) -> list[int]:
        """Of the default scene; without scenes, the nodes that are no children."""
        document = self.document
        if document.scenes:
            return list(document.scenes[max(document.stated.scene, 0)].nodes)
        roots = [number for number in range(len(self.nodes)) if number not in self._parents]
        if self.nodes and not roots:
            raise Refused("reference-cycle", "every node is a child of another: a cycle")
        return roots

    def name(self, number: int) -> str:
        """The name of a node, else of its mesh, else its number."""
        node = self.nodes[number]
        name = tidy_name(node.name, "")
        if not name and node.mesh != NONE:
            name = tidy_name(self.document.meshes.name(node.mesh), "")
        return name or f"node{number}"

    def _mesh_name(self, number: int) -> str:
        return tidy_name(self.document.meshes.name(number), f"mesh{number}")

    def _content(
        self, collider: Collider, matrix: Transform | None
    ) -> tuple[RawMesh | Primitive | Refusal, Transform | None]:
        """The mesh or shape of a collider, and its placement."""
        shape = collider.shape
        try:
            if isinstance(shape, Refusal):
                return shape, matrix
            if isinstance(shape, Shape):
                mesh = self.mesh(shape)
                if collider.hull and isinstance(mesh, RawMesh):
                    mesh = hull_of(mesh)
                return mesh, matrix if shape.skin == NONE else None
            if not isinstance(shape, Box):
                matrix = multiply(matrix, UPRIGHT)
                refuse_skew(shape, matrix)
            return shape, matrix
        except Refused as error:
            return Refusal(error.code, error.message), matrix

    def mesh(self, shape: Shape) -> RawMesh | Refusal:
        """Returns a Refusal for a mesh that cannot be used, so that its nodes stay in the scene."""
        try:
            skin = None if shape.skin == NONE else self._skin(shape.skin)
            return self.meshes.read(shape, skin)
        except Refused as error:
            return Refusal(error.code, error.message)

    def _copies(self, node: Instance[int]) -> Iterator[tuple[str, Transform | None]]:
        """(path, matrix) of a node, or of each GPU instance of the node."""
        where, stated = f"node {node.key}", self.nodes[node.key]
        if stated.skin != NONE:  # its joints place it
            yield node.path, None
            return
        instancing = stated.extension(INSTANCING, Instancing, where)
        if instancing is None:
            yield node.path, node.matrix
            return
        columns = self.accessors.columns(instancing.attributes)
        kinds = {"TRANSLATION": 3, "ROTATION": 4, "SCALE": 3}
        given = [(columns(name, f"VEC{width}"), width) for name, width in kinds.items()]
        counts = {len(rows) // width for rows, width in given if rows is not None}
        if len(counts) != 1 or 0 in counts:
            raise Refused("count-mismatch", f"{where}: unclear count of instances")
        (count,) = counts
        self._copied += count
        limits.refuse_many(self._copied, "instances")
        for i in range(count):
            parts = (
                () if rows is None else rows[width * i : width * (i + 1)] for rows, width in given
            )
            yield f"{node.path}[{i}]", multiply(node.matrix, _trs_placement(*parts))

    def _skin(self, number: int) -> Skin:
        skin = self.document.skins[number]
        bound = None
        if skin.inverse_bind_matrices != NONE:
            bound = self.accessors.numbers(skin.inverse_bind_matrices, "MAT4")
            if len(bound) < 16 * len(skin.joints):
                raise Refused("count-mismatch", f"skin {number}: a joint lacks its matrix")
        return Skin(tuple(self._world(joint) or IDENTITY for joint in skin.joints), bound)

    def _world(self, node: int) -> Transform | None:
        """The world matrix of a node; None: the identity."""
        matrix = self.matrix(node)
        for parent in self._above(node):
            self.accessors.work.spend(8 * len(IDENTITY))
            matrix = multiply(self.matrix(parent), matrix)
        return matrix

    @cached_property
    def _parents(self) -> dict[int, int]:
        return {child: parent for parent, node in enumerate(self.nodes) for child in node.children}

    def _above(self, node: int) -> Iterator[int]:
        """The nodes around a node, from the inside."""
        seen = {node}
        while (parent := self._parents.get(node)) is not None:
            if parent in seen:
                raise Refused("reference-cycle", f"node {parent} contains itself: a cycle")
            seen.add(parent)
            yield parent
            node = parent


def _trs_placement(
    translation: Sequence[float], rotation: Sequence[float], scale: Sequence[float]
) -> Transform | None:
    """Scales, then rotates by a quaternion x, y, z, w, then translates; empty: it does not."""
    placement: Transform | None = None
    if translation:
        x, y, z = translation
        placement = (1, 0, 0, x, 0, 1, 0, y, 0, 0, 1, z, 0, 0, 0, 1)
    if rotation:
        if not any(rotation):
            raise Refused("bad-record", "a rotation quaternion is zero")
        turn = quaternion_matrix(*rotation)
        placement = multiply(placement, placed(turn, (0.0, 0.0, 0.0)))
    if scale:
        x, y, z = scale
        placement = multiply(placement, (x, 0, 0, 0, 0, y, 0, 0, 0, 0, z, 0, 0, 0, 0, 1))
    return placement
