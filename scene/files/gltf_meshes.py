"""The meshes of glTF: their primitives as triangles, in the shape that the file stores."""

from __future__ import annotations

from array import array
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from msgspec import Struct

from satcheck.core.transform import Transform
from satcheck.scene.document import (
    NO_SURFACE,
    Block,
    RawMesh,
    fan_triangles,
    strip_triangles,
)
from satcheck.scene.errors import Refused
from satcheck.scene.files.gltf_accessors import Accessors, Columns
from satcheck.scene.files.gltf_buffers import Work, extension, integer, items, member
from satcheck.scene.files.gltf_vocabulary import DRACO
from satcheck.scene.files.nodes import concatenate
from satcheck.scene.files.readers import NeedsChild

if TYPE_CHECKING:
    from satcheck.scene.files.gltf_accessors import Floats, Indices

_POINTS, _LINES, _LINE_LOOP, _LINE_STRIP, _TRIANGLES, _STRIP, _FAN = range(7)
NO_TRIANGLES = frozenset({_POINTS, _LINES, _LINE_LOOP, _LINE_STRIP})


class Shape(Struct, frozen=True):
    """A mesh with the weights of its morph targets and the number of its skin at a node."""

    mesh: int
    weights: tuple[float, ...] = ()
    skin: int | None = None


class Skin(Struct, frozen=True):
    """joints: the world matrix of each. bound: the inverse bind matrix of each, from the mesh to
    the joint, 16 numbers column by column; None: the identity."""

    joints: tuple[Transform, ...]
    bound: Floats | None = None


class Meshes:
    def __init__(self, document: dict[str, Any], accessors: Accessors, work: Work) -> None:
        self._meshes = items(document, "meshes")
        self._accessors = accessors
        self._work = work
        self._requires_draco = DRACO in items(document, "extensionsRequired")

    def name(self, number: int) -> object:
        return member(self._meshes, number, "mesh").get("name")

    def weights(self, number: int, node: dict[str, Any]) -> tuple[float, ...]:
        """Weights of the morph targets of a mesh at a node; () if all are 0."""
        mesh = member(self._meshes, number, "mesh")
        values = items(node if "weights" in node else mesh, "weights")
        self._work.spend(len(values))
        if not all(type(value) in (int, float) for value in values):
            raise Refused("bad-record", f"mesh {number}: weights should be numbers")
        return tuple(map(float, values)) if any(values) else ()

    def read(self, shape: Shape, skin: Skin | None) -> RawMesh:
        """All primitives with triangles, as one mesh.

        skin: of the shape. Raises Refused; its code is `NO_SURFACE` if there are no
        triangles.
        """
        warnings: dict[str, str] = {}
        where = f"mesh {shape.mesh}"
        parts: list[tuple[Block, Block, None]] = []
        rounding = 0.0
        mesh = member(self._meshes, shape.mesh, "mesh")
        if "primitives" not in mesh:
            raise Refused("bad-record", f"{where} has no primitives")
        for primitive in items(mesh, "primitives"):
            part = self._primitive(primitive, shape, skin, where, warnings)
            if part is not None:
                parts.append((part[0].cast("B"), part[1].cast("B"), None))
                rounding = max(rounding, part[2])
        vertices, triangles = concatenate(parts)
        if not triangles:
            raise Refused(NO_SURFACE, f"{where} has no triangles, only lines or points")
        return RawMesh(
            vertices=vertices,
            triangles=triangles,
            number_format="float32",
            units="meter",
            warnings=tuple(warnings.items()),
            rounding=rounding,
        )

    def _primitive(
        self,
        primitive: Any,
        shape: Shape,
        skin: Skin | None,
        where: str,
        warnings: dict[str, str],
    ) -> tuple[Floats, Indices, float] | None:
        """x, y, z of each vertex, the corners of each triangle, and how far integers and packed
        data may put a vertex off; None without triangles."""
        mode = integer(primitive, "mode", _TRIANGLES)
        if mode in NO_TRIANGLES:
            warnings["ignored-geometry"] = f"{where}: points or lines are ignored"
            return None
        attributes = primitive.get("attributes")
        if mode > _FAN or not isinstance(attributes, dict) or "POSITION" not in attributes:
            raise Refused("bad-record", f"{where}: a primitive without positions or mode")
        packed = self._packed(primitive, attributes)
        if packed is not None:
            if not self._work.isolated:
                raise NeedsChild
            from satcheck.scene.files.gltf_draco import Unpacked

            unpacked = Unpacked(self._accessors, packed, attributes)
            positions, triangles = unpacked.positions(), unpacked.triangles
            rounding = unpacked.rounding(positions)
            columns: Columns = unpacked.columns
        else:
            self._refuse_unread(primitive, attributes, where)
            number = integer(attributes, "POSITION", -1)
            positions = self._accessors.positions(number)
            rounding = self._accessors.rounding(number)
            triangles = self._triangles(primitive, mode, len(positions) // 3, where)
            columns = self._accessors.columns(attributes)
        if primitive.get("targets"):
            warnings["rest-shape"] = "morph targets have the weights that the file stores"
            if shape.weights:
                targets = self._targets(items(primitive, "targets"), shape.weights)
                positions, off = self._morphed(positions, targets)
                rounding += off
        if skin is not None:
            from satcheck.scene.files.gltf_shapes import skinned

            warnings["rest-shape"] = "the joints of the skin stand as the file stores them"
            positions, stretch = skinned(positions, columns, skin.joints, skin.bound, where)
            rounding *= stretch
        return positions, triangles, rounding

    def _packed(
        self, primitive: dict[str, Any], attributes: dict[str, Any]
    ) -> dict[str, Any] | None:
        """The Draco data; None if the file also has the data without compression."""
        packed = extension(primitive, DRACO)
        plain = all(map(self._accessors.has_data, _needed(primitive, attributes)))
        return None if plain and not self._requires_draco else packed

    def _refuse_unread(
        self, primitive: dict[str, Any], attributes: dict[str, Any], where: str
    ) -> None:
        """Refuses accessors without data. Their values would all be 0, and the geometry is most
        likely in an extension that is not read."""
        if not all(map(self._accessors.has_data, _needed(primitive, attributes))):
            raise Refused(
                "unsupported-feature", f"{where}: the positions or indices are not in the file"
            )

    def _triangles(self, primitive: dict[str, Any], mode: int, count: int, where: str) -> Indices:
        """The corners of each triangle. count: of the vertices."""
        if "indices" not in primitive:
            return _as_list(memoryview(array("I", range(count))), mode, where)
        corners, largest = self._accessors.indices(integer(primitive, "indices", -1))
        if largest >= count:
            raise Refused(
                "index-out-of-range",
                f"{where}: index out of range: {largest} of {count} vertices",
            )
        return _as_list(corners, mode, where)

    @staticmethod
    def _targets(targets: list[Any], weights: Sequence[float]) -> list[tuple[float, int]]:
        """(weight, number of the accessor of the displacements) of each target that counts."""
        if len(targets) != len(weights):
            raise Refused("count-mismatch", f"{len(weights)} weights, {len(targets)} targets")
        return [
            (weight, integer(target, "POSITION", -1))
            for weight, target in zip(weights, targets, strict=True)
            if weight and isinstance(target, dict) and "POSITION" in target
        ]

    def _morphed(self, positions: Floats, targets: list[tuple[float, int]]) -> tuple[Floats, float]:
        """The moved positions, and how far integers and packed data may put their moves off."""
        from satcheck.scene.files.gltf_shapes import morphed

        moves = [(weight, self._accessors.positions(number)) for weight, number in targets]
        off = sum(abs(weight) * self._accessors.rounding(number) for weight, number in targets)
        return morphed(positions, moves), off


def _needed(primitive: dict[str, Any], attributes: dict[str, Any]) -> list[int]:
    """The accessors that the triangles need."""
    owners = ((attributes, "POSITION"), (primitive, "indices"))
    return [integer(owner, key, -1) for owner, key in owners if key in owner]


def _as_list(corners: Indices, mode: int, where: str) -> Indices:
    """The corners of strips and fans, three a triangle."""
    if mode == _TRIANGLES:
        if len(corners) % 3:
            raise Refused("count-mismatch", f"{where}: {len(corners)} corners, not 3 each")
        return corners
    made = fan_triangles(corners) if mode == _FAN else strip_triangles(corners)
    return memoryview(array("I", made))
