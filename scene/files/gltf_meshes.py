"""The meshes of glTF: their primitives as triangles, in the shape that the file stores. Morph
targets and skins move the vertices before a node places the mesh."""

from __future__ import annotations

from array import array
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Self

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
from satcheck.scene.files.gltf_buffers import Accessors, Columns
from satcheck.scene.files.gltf_document import (
    DRACO,
    NONE,
    Attributes,
    Draco,
    GltfDocument,
    Node,
    Primitive,
)
from satcheck.scene.files.nodes import concatenate
from satcheck.scene.files.readers import NeedsChild

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from satcheck.scene.files.gltf_buffers import Floats, Indices

_POINTS, _LINES, _LINE_LOOP, _LINE_STRIP, _TRIANGLES, _STRIP, _FAN = range(7)
NO_TRIANGLES = frozenset({_POINTS, _LINES, _LINE_LOOP, _LINE_STRIP})


class Shape(Struct, frozen=True):
    """A mesh at a node: its number, the weights of its morph targets that the node states, and the
    number of its skin."""

    mesh: int
    weights: tuple[float, ...] = ()
    skin: int = NONE

    @classmethod
    def of(cls, node: Node) -> Self:
        return cls(node.mesh, node.weights, node.skin)


class Skin(Struct, frozen=True):
    """joints: the world matrix of each. bound: the inverse bind matrix of each, from the mesh to
    the joint, 16 numbers column by column; None: the identity."""

    joints: tuple[Transform, ...]
    bound: Floats | None = None


class Meshes:
    def __init__(self, document: GltfDocument, accessors: Accessors) -> None:
        self._meshes = document.meshes
        self._accessors = accessors
        self._requires_draco = DRACO in document.stated.extensions_required

    def read(self, shape: Shape, skin: Skin | None) -> RawMesh:
        """All primitives with triangles, as one mesh.

        skin: of the shape. Raises Refused; its code is `NO_SURFACE` if there are no
        triangles.
        """
        warnings: dict[str, str] = {}
        where = f"mesh {shape.mesh}"
        parts: list[tuple[Block, Block, None]] = []
        rounding = 0.0
        mesh = self._meshes[shape.mesh]
        weights = shape.weights or mesh.weights
        for primitive in mesh.primitives:
            if primitive.mode in NO_TRIANGLES:
                warnings["ignored-geometry"] = f"{where}: points or lines are ignored"
                continue
            positions, triangles, off = self._primitive(primitive, weights, skin, where, warnings)
            parts.append((positions.cast("B"), triangles.cast("B"), None))
            rounding = max(rounding, off)
        vertices, triangles_ = concatenate(parts)
        if not triangles_:
            raise Refused(NO_SURFACE, f"{where} has no triangles, only lines or points")
        return RawMesh(
            vertices=vertices,
            triangles=triangles_,
            number_format="float32",
            units="meter",
            warnings=tuple(warnings.items()),
            rounding=rounding,
        )

    def _primitive(
        self,
        primitive: Primitive,
        weights: tuple[float, ...],
        skin: Skin | None,
        where: str,
        warnings: dict[str, str],
    ) -> tuple[Floats, Indices, float]:
        """x, y, z of each vertex, the corners of each triangle, and how far integers and packed
        data may put a vertex off."""
        attributes = primitive.attributes
        if "POSITION" not in attributes:
            raise Refused("bad-record", f"{where}: a primitive without positions")
        has_data = self._accessors.has_data(attributes["POSITION"]) and (
            primitive.indices == NONE or self._accessors.has_data(primitive.indices)
        )
        packed = primitive.extension(DRACO, Draco, where)
        if packed is not None and (self._requires_draco or not has_data):
            if not self._accessors.work.isolated:
                raise NeedsChild
            from satcheck.scene.files.gltf_draco import Unpacked

            unpacked = Unpacked(self._accessors, packed, attributes)
            positions, triangles = unpacked.positions(), unpacked.triangles
            rounding = unpacked.rounding(positions)
            columns: Columns = unpacked.columns
        elif has_data:
            number = attributes["POSITION"]
            positions = self._accessors.positions(number)
            rounding = self._accessors.rounding(number)
            triangles = self._triangles(primitive, len(positions) // 3, where)
            columns = self._accessors.columns(attributes)
        else:
            # The values would all be 0. Most likely an extension that is not read has them.
            message = f"{where}: the positions or indices are not in the file"
            raise Refused("unsupported-feature", message)
        if primitive.targets:
            warnings["rest-shape"] = "morph targets have the weights that the file stores"
            if any(weights):
                positions, off = self._morphed(positions, primitive.targets, weights)
                rounding += off
        if skin is not None:
            warnings["rest-shape"] = "the joints of the skin stand as the file stores them"
            positions, stretch = _skinned(positions, columns, skin, where)
            rounding *= stretch
        return positions, triangles, rounding

    def _triangles(self, primitive: Primitive, count: int, where: str) -> Indices:
        """The corners of each triangle. count: of the vertices."""
        if primitive.indices == NONE:
            corners, largest = memoryview(array("I", range(count))), count - 1
        else:
            corners, largest = self._accessors.indices(primitive.indices)
        if largest >= count:
            message = f"{where}: index out of range: {largest} of {count} vertices"
            raise Refused("index-out-of-range", message)
        if primitive.mode == _TRIANGLES:
            if len(corners) % 3:
                raise Refused("count-mismatch", f"{where}: {len(corners)} corners, not 3 each")
            return corners
        split = fan_triangles if primitive.mode == _FAN else strip_triangles
        return memoryview(array("I", split(corners)))

    def _morphed(
        self, positions: Floats, targets: Sequence[Attributes], weights: Sequence[float]
    ) -> tuple[Floats, float]:
        """The moved positions, and how far integers and packed data may put their moves off."""
        import numpy as np

        if len(targets) != len(weights):
            raise Refused("count-mismatch", f"{len(weights)} weights, {len(targets)} targets")
        moved, off = np.array(positions), 0.0
        for weight, target in zip(weights, targets, strict=True):
            if weight and "POSITION" in target:
                move = self._accessors.positions(target["POSITION"])
                if len(move) != len(moved):
                    message = "a morph target has another number of vertices"
                    raise Refused("count-mismatch", message)
                moved += weight * np.array(move)
                off += abs(weight) * self._accessors.rounding(target["POSITION"])
        return _finite(moved), off


def _skinned(positions: Floats, columns: Columns, skin: Skin, where: str) -> tuple[Floats, float]:
    """Each vertex where its joints put it, in world coordinates, and how far these joints stretch
    a length at most.

    positions: x, y, z of each vertex. columns: of the attributes JOINTS_0, WEIGHTS_0, JOINTS_1 and
    so on. Many files round the last rows of matrices and the sums of weights. Each result is
    therefore divided by its fourth coordinate.
    """
    import numpy as np

    points = np.array(positions).reshape(-1, 3)
    matrices = np.array(skin.joints, np.float64).reshape(-1, 4, 4)
    if skin.bound is not None:
        bound = np.array(skin.bound).reshape(-1, 4, 4)[: len(matrices)]
        matrices = matrices @ bound.transpose(0, 2, 1)
    blended = np.zeros((len(points), 4, 4))
    used = np.zeros(len(matrices), bool)
    number = 0
    while (indices := columns(f"JOINTS_{number}", "VEC4")) is not None:
        shares = columns(f"WEIGHTS_{number}", "VEC4")
        if shares is None or not len(indices) == len(shares) == 4 * len(points):
            raise Refused("count-mismatch", f"{where}: joints and weights are not one each")
        numbers = np.array(indices).astype(np.int64).reshape(-1, 4)
        weights = np.array(shares).reshape(-1, 4)
        if numbers.size and numbers.max() >= len(matrices):
            message = f"{where}: joint {numbers.max()} of {len(matrices)}"
            raise Refused("index-out-of-range", message)
        used[numbers[weights != 0]] = True
        for k in range(4):
            blended += weights[:, k, None, None] * matrices[numbers[:, k]]
        number += 1
    placed = np.einsum("nij,nj->ni", blended[:, :, :3], points) + blended[:, :, 3]
    if not (placed[:, 3] > 0).all():
        raise Refused("bad-record", f"{where}: a vertex of the skin has no joint")
    stretch = np.linalg.norm(matrices[used, :3, :3], 2, axis=(1, 2)).max(initial=0.0)
    return _finite(placed[:, :3] / placed[:, 3:]), float(stretch)


def _finite(points: NDArray[np.floating[Any]]) -> Floats:
    import numpy as np

    if not np.isfinite(points).all():
        raise Refused("non-finite", "the pose makes non-finite coordinates")
    return memoryview(points.tobytes()).cast("d")
