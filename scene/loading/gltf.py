"""glTF 2.0 and GLB: the meshes of the default scene, placed by its nodes, in their rest shape.

Read here and not by a general loader: everything that has to be checked before such a loader may
be trusted (chunks, buffers, views, accessors, the node graph) is most of the reading itself, and a
scene of fifty GLB files would wait a second for each to be loaded that way. Materials, textures,
cameras, animations are never touched. Sources: the Khronos glTF 2.0 specification.
"""

from __future__ import annotations

import sys
from array import array
from typing import Any, NoReturn

from satcheck.core.frozen import replace
from satcheck.core.transform import of_quaternion, placed
from satcheck.scene._readers import read_json
from satcheck.scene.errors import MeshFileError
from satcheck.scene.loading.flatten import concatenate
from satcheck.scene.loading.gltf_buffers import Accessors, integer, items, member, split_glb
from satcheck.scene.loading.placing import instances, multiply, tidy_name
from satcheck.scene.loading.raw_mesh import Matrix, RawMesh, RawNode, RawPart, RawScene
from satcheck.scene.plain_ids import UniqueNames

_POINTS, _LINES, _LINE_LOOP, _LINE_STRIP, _TRIANGLES, _STRIP, _FAN = range(7)
_VERTEX_BYTES = 24
_NO_TRIANGLES = frozenset({_POINTS, _LINES, _LINE_LOOP, _LINE_STRIP})
# Extensions a file may require without changing where its triangles are.
_HARMLESS_PREFIXES = ("KHR_materials_", "KHR_texture_", "KHR_lights_", "EXT_texture_", "KHR_xmp_")
_HARMLESS = frozenset({"KHR_mesh_quantization"})
# Extensions that add geometry even where they are optional.
_ADDING = frozenset({"EXT_mesh_gpu_instancing"})


def read_gltf(
    data: memoryview, directory: str, *, binary: bool, allow_outside: bool = False
) -> RawScene:
    """The default scene of a glTF file: its meshes, and the nodes that have one.

    directory: where relative buffer URIs start, and what they may not leave unless allow_outside.
    binary: GLB. Raises MeshFileError without a file name.
    """
    text, chunk = split_glb(data) if binary else (data, None)
    document = _parse_json(text)
    _check_extensions(document)
    accessors = Accessors(document, chunk, directory, allow_outside=allow_outside)
    return _Scene(document, accessors).read()


def _parse_json(data: memoryview) -> dict[str, Any]:
    try:
        text = str(data, "utf-8").removeprefix("\ufeff")
    except UnicodeDecodeError:
        raise MeshFileError("bad-encoding", "the JSON is not UTF-8") from None
    document, _ = read_json(text) or (_json_with_reasons(text), False)
    if not isinstance(document, dict) or not isinstance(document.get("asset"), dict):
        raise MeshFileError("not-this-format", "not a glTF file: no asset object")
    version = document["asset"].get("version")
    if not isinstance(version, str) or not version.startswith("2."):
        raise MeshFileError("unsupported-feature", f"glTF version {version!r}: 2.x is read")
    return document


def _json_with_reasons(text: str) -> Any:
    """Of any text: what is wrong with it has a line."""
    import json

    def refuse(token: str) -> NoReturn:
        raise MeshFileError("bad-record", f"JSON: {token} is not a number of glTF")

    try:
        return json.loads(text, parse_constant=refuse)
    except json.JSONDecodeError as error:
        raise MeshFileError(
            "bad-record", f"line {error.lineno}: not well-formed JSON: {error.msg}"
        ) from None
    except RecursionError:
        raise MeshFileError("bad-record", "the JSON is nested too deeply") from None


def _check_extensions(document: dict[str, Any]) -> None:
    for name in items(document, "extensionsRequired"):
        harmless = name in _HARMLESS or str(name).startswith(_HARMLESS_PREFIXES)
        if not harmless:
            raise MeshFileError("unsupported-feature", f"the file requires extension {name!r}")
    for name in items(document, "extensionsUsed"):
        if name in _ADDING:
            raise MeshFileError("unsupported-feature", f"extension {name!r} is not read")


class _Scene:
    def __init__(self, document: dict[str, Any], accessors: Accessors) -> None:
        self._document = document
        self._accessors = accessors
        self._nodes = items(document, "nodes")
        self._all_meshes = items(document, "meshes")
        self._meshes: dict[int, RawMesh | MeshFileError] = {}
        self._skinned: set[int] = set()
        self._ignored: dict[str, str] = {}  # warnings about meshes that have no triangles

    def read(self) -> RawScene:
        nodes = instances(
            [(root, self._matrix(root)) for root in self._roots()],
            children=self._children,
            has_mesh=self._has_triangles,
            name=self._name,
            kind="node",
        )
        if not nodes:
            raise MeshFileError("empty-mesh", "empty mesh: the scene has no triangles")
        meshes = [self._mesh_of(node.key) for node in nodes]
        used = {mesh: place for place, mesh in enumerate(dict.fromkeys(meshes))}
        names = UniqueNames()
        return RawScene(
            parts=tuple(RawPart(names.unique(self._mesh_name(n)), self._found(n)) for n in used),
            nodes=tuple(
                RawNode(node.path, used[mesh], node.matrix)
                for node, mesh in zip(nodes, meshes, strict=True)
            ),
            warnings=tuple(self._ignored.items()),
        )

    def _roots(self) -> list[int]:
        scenes = items(self._document, "scenes")
        if scenes:
            chosen = member(scenes, integer(self._document, "scene", 0), "scene")
            return [self._node_number(number) for number in items(chosen, "nodes")]
        placed = {child for node in range(len(self._nodes)) for child, _ in self._children(node)}
        roots = [node for node in range(len(self._nodes)) if node not in placed]
        if self._nodes and not roots:
            raise MeshFileError("reference-cycle", "every node is a child of another: a cycle")
        return roots

    def _node_number(self, number: object) -> int:
        if type(number) is not int:
            raise MeshFileError("bad-record", f"node {number!r} is not a number")
        member(self._nodes, number, "node")
        return number

    def _children(self, node: int) -> list[tuple[int, Matrix | None]]:
        numbers = items(member(self._nodes, node, "node"), "children")
        return [(child := self._node_number(n), self._matrix(child)) for n in numbers]

    def _name(self, number: int) -> str:
        """A node's own, or that of its mesh, or its number."""
        name = tidy_name(self._nodes[number].get("name"), "")
        mesh = self._mesh_of(number)
        if not name and mesh >= 0:
            name = tidy_name(self._all_meshes[mesh].get("name"), "")
        return name or f"node{number}"

    def _mesh_name(self, number: int) -> str:
        return tidy_name(self._all_meshes[number].get("name"), f"mesh{number}")

    def _matrix(self, number: int) -> Matrix | None:
        node = member(self._nodes, number, "node")
        if "matrix" in node:
            columns = _numbers(node, "matrix", 16, number)
            if columns[3:16:4] != [0.0, 0.0, 0.0, 1.0]:
                raise MeshFileError("bad-record", f"node {number}: the matrix is not affine")
            return tuple(columns[4 * column + row] for row in range(4) for column in range(4))
        placement: Matrix | None = None
        if "translation" in node:
            x, y, z = _numbers(node, "translation", 3, number)
            placement = (1, 0, 0, x, 0, 1, 0, y, 0, 0, 1, z, 0, 0, 0, 1)
        if "rotation" in node:
            placement = multiply(placement, _rotation(_numbers(node, "rotation", 4, number)))
        if "scale" in node:
            x, y, z = _numbers(node, "scale", 3, number)
            scale = (x, 0, 0, 0, 0, y, 0, 0, 0, 0, z, 0, 0, 0, 0, 1)
            placement = multiply(placement, scale)
        return placement

    def _mesh_of(self, number: int) -> int:
        """The number of a node's mesh, -1 for none."""
        mesh = integer(member(self._nodes, number, "node"), "mesh", -1)
        if mesh >= 0:
            member(self._all_meshes, mesh, "mesh")
        return mesh

    def _has_triangles(self, number: int) -> bool:
        """A mesh that cannot be used counts: its nodes must not get lost."""
        mesh = self._mesh_of(number)
        if mesh < 0:
            return False
        if "skin" in self._nodes[number]:
            self._skinned.add(mesh)
        if mesh not in self._meshes:
            try:
                self._meshes[mesh] = self._mesh(mesh)
            except MeshFileError as error:
                self._meshes[mesh] = error
        found = self._meshes[mesh]
        return isinstance(found, MeshFileError) or bool(found.triangles)

    def _found(self, number: int) -> RawMesh | MeshFileError:
        found = self._meshes[number]
        if isinstance(found, MeshFileError) or number not in self._skinned:
            return found
        skinned = ("rest-shape", "skinning is ignored: the rest shape is used")
        return replace(found, warnings=(*found.warnings, skinned))

    def _mesh(self, number: int) -> RawMesh:
        """All primitives that have triangles, as one."""
        warnings: dict[str, str] = {}
        primitives = (
            self._primitive(primitive, f"mesh {number}", warnings)
            for primitive in items(self._all_meshes[number], "primitives")
        )
        vertices, triangles = concatenate(
            [(*primitive, None) for primitive in primitives if primitive is not None]
        )
        if not triangles:
            self._ignored |= warnings
        return RawMesh(
            vertices=vertices,
            triangles=triangles,
            precision="float32",
            units="meter",
            warnings=tuple(warnings.items()),
        )

    def _primitive(
        self, primitive: Any, where: str, warnings: dict[str, str]
    ) -> tuple[bytes, bytes] | None:
        """(float64 vertices, uint32 triangles), None where it has no triangles."""
        mode = integer(primitive, "mode", _TRIANGLES)
        if mode in _NO_TRIANGLES:
            warnings["ignored-geometry"] = f"{where}: points or lines are ignored"
            return None
        attributes = primitive.get("attributes")
        if mode > _FAN or not isinstance(attributes, dict) or "POSITION" not in attributes:
            raise MeshFileError("bad-record", f"{where}: a primitive without positions or mode")
        if primitive.get("targets"):
            warnings["rest-shape"] = "morphing is ignored: the rest shape is used"
        positions = self._accessors.positions(integer(attributes, "POSITION", -1))
        count = len(positions) // _VERTEX_BYTES
        if "indices" in primitive:
            corners, largest = self._accessors.indices(integer(primitive, "indices", -1))
        else:
            corners, largest = array("I", range(count)).tobytes(), count - 1
        if corners and largest >= count:
            raise MeshFileError(
                "index-out-of-range",
                f"{where}: index out of range: {largest} of {count} vertices",
            )
        return positions, _triangles(corners, mode, where)


def _triangles(numbers: bytes, mode: int, where: str) -> bytes:
    corners = array("I", numbers)
    if mode == _TRIANGLES:
        if len(corners) % 3:
            raise MeshFileError("count-mismatch", f"{where}: {len(corners)} corners, not 3 each")
        return numbers
    triangles = array("I")
    for i in range(len(corners) - 2):
        if mode == _FAN:
            triangles.extend((corners[i + 1], corners[i + 2], corners[0]))
        else:  # in a strip, every other triangle runs backwards
            triangles.extend((corners[i], corners[i + 1 + i % 2], corners[i + 2 - i % 2]))
    return triangles.tobytes()


def _numbers(node: dict[str, Any], key: str, count: int, number: int) -> list[float]:
    values = items(node, key)
    good = len(values) == count and all(
        type(value) in (int, float) and abs(value) <= sys.float_info.max for value in values
    )
    if not good:
        raise MeshFileError("bad-record", f"node {number}: {key} needs {count} finite numbers")
    return [float(value) for value in values]


def _rotation(quaternion: list[float]) -> Matrix:
    if not any(quaternion):
        raise MeshFileError("bad-record", "a rotation quaternion is zero")
    x, y, z, w = quaternion
    return placed(of_quaternion(x, y, z, w), (0.0, 0.0, 0.0))
