"""COLLADA through pycollada. Its result must have every triangle that the file lists."""

from __future__ import annotations

import io
import re
from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from satcheck.scene._readers import ReadError, cut_polygons
from satcheck.scene.errors import MeshFileError
from satcheck.scene.loading.collada_nodes import IDENTITY, Floats, mirrors, placed, walk
from satcheck.scene.loading.collada_outline import read_outline
from satcheck.scene.loading.raw_mesh import RawMesh

Triangles = NDArray[np.int64]

_NAME = rb"(?:[\w.-]+:)?bind_material"
_MATERIALS = re.compile(rb"<%b(?:\s[^>]*)?(?<!/)>.*?</%b\s*>" % (_NAME, _NAME), re.DOTALL)


def read_collada(data: bytes) -> RawMesh:
    """The visual scene of a COLLADA file, flattened; raises MeshFileError without a file name.

    pycollada keeps coordinates and transforms as float32, hence the precision.
    """
    outline = read_outline(data)
    promised = outline.promised_triangles()
    if promised == 0:
        raise MeshFileError("empty-mesh", "empty mesh: the scene has no triangles")

    import collada

    # It leaves out what it cannot read, such as lights, or a mesh with an unreadable material. The
    # count of triangles shows that no mesh is missing.
    bare = _MATERIALS.sub(b"", data)
    document: Any = collada.Collada(io.BytesIO(bare), ignore=[collada.common.DaeError])
    meshes = list(_scene_meshes(document)) if document.scene is not None else []
    read = sum(len(triangles) for _, triangles in meshes)
    if read != promised:
        raise MeshFileError(
            "count-mismatch", f"the file promises {promised} triangles, {read} could be read"
        )
    offsets = np.cumsum([0, *(len(points) for points, _ in meshes)])
    points = np.concatenate([points for points, _ in meshes])
    triangles = np.concatenate(
        [corners + offset for (_, corners), offset in zip(meshes, offsets, strict=False)]
    )
    if not np.isfinite(points).all():
        raise MeshFileError("non-finite", "non-finite coordinates")
    return RawMesh(
        vertices=points.astype("<f8").tobytes(),
        triangles=triangles.astype("<u4").tobytes(),
        precision="float32",
        units=_units(document.assetInfo.unitmeter),
        warnings=tuple(outline.warnings.items()),
    )


def _units(metres: float | None) -> str:
    return "meters" if metres is None or metres == 1.0 else f"{metres} * meters"


def _scene_meshes(document: Any) -> Iterator[tuple[Floats, Triangles]]:
    """Vertices in the world and triangles, once for each instance."""
    from collada.scene import ControllerNode, GeometryNode

    scene = list(walk([(node, IDENTITY) for node in document.scene.nodes]))
    for node, matrix in scene:
        if isinstance(node, GeometryNode):
            mirrored = mirrors(matrix)
            for points, triangles in _primitives(node.geometry):
                yield placed(points, matrix), triangles[:, ::-1] if mirrored else triangles
        elif isinstance(node, ControllerNode):
            from satcheck.scene.loading.collada_shapes import shaped

            geometry, shape, mirrored = shaped(node, matrix, scene)
            for points, triangles in _primitives(geometry):
                yield shape(points), triangles[:, ::-1] if mirrored else triangles


def _primitives(geometry: Any) -> Iterator[tuple[Floats, Triangles]]:
    """Vertices as the file has them, and triangles, of each group of polygons."""
    from collada.polylist import Polylist
    from collada.triangleset import TriangleSet

    for primitive in geometry.primitives:
        if not isinstance(primitive, Polylist | TriangleSet) or primitive.vertex_index is None:
            continue
        points = np.asarray(primitive.vertex, dtype=np.float64)
        corners = np.asarray(primitive.vertex_index, dtype=np.int64).ravel()
        if corners.size and (corners.min() < 0 or corners.max() >= len(points)):
            name = geometry.id
            raise MeshFileError("index-out-of-range", f"geometry {name!r}: index out of range")
        if isinstance(primitive, Polylist):
            corners = _cut(points, corners, np.asarray(primitive.vcounts))
        yield points, corners.reshape(-1, 3)


def _cut(points: Floats, corners: Triangles, lengths: Triangles) -> Triangles:
    """The triangles of polygons of these lengths."""
    triangles = cut_polygons(
        points.astype("<f8").tobytes(),
        corners.astype("<u4").tobytes(),
        lengths.astype("<u4").tobytes(),
    )
    if isinstance(triangles, ReadError):
        raise MeshFileError(triangles.code, triangles.message)
    return np.frombuffer(triangles, "<u4").astype(np.int64)
