"""COLLADA through trimesh (pycollada), which must deliver every triangle that the file promises."""

from __future__ import annotations

import io
from typing import Any

from satcheck.scene.errors import MeshFileError
from satcheck.scene.loading.collada_outline import read_outline
from satcheck.scene.loading.raw_mesh import RawMesh


def read_collada(data: memoryview) -> RawMesh:
    """The visual scene of a COLLADA file, flattened; raises MeshFileError without a file name.

    pycollada keeps coordinates and transforms as float32, hence the precision.
    """
    content = bytes(data)
    outline = read_outline(content)
    promised = outline.promised_triangles()
    if promised == 0:
        raise MeshFileError("empty-mesh", "empty mesh: the scene has no triangles")

    import numpy as np
    import trimesh

    scene: Any = trimesh.load_scene(
        io.BytesIO(content), file_type="dae", process=False, skip_materials=True
    )
    vertices, triangles, offset = [], [], 0
    for node in scene.graph.nodes_geometry:
        matrix, name = scene.graph[node]
        mesh = scene.geometry[name]
        placed = np.asarray(mesh.vertices, dtype="<f8") @ matrix[:3, :3].T + matrix[:3, 3]
        faces = np.asarray(mesh.faces, dtype=np.int64)
        if np.linalg.det(matrix[:3, :3]) < 0:
            faces = faces[:, ::-1]
        if faces.size and (faces.min() < 0 or faces.max() >= len(placed)):
            raise MeshFileError("index-out-of-range", f"geometry {name!r}: index out of range")
        vertices.append(placed)
        triangles.append(faces + offset)
        offset += len(placed)
    read = sum(len(faces) for faces in triangles)
    if read != promised:
        raise MeshFileError(
            "count-mismatch", f"the file promises {promised} triangles, {read} could be read"
        )
    points = np.concatenate(vertices)
    if not np.isfinite(points).all():
        raise MeshFileError("non-finite", "non-finite coordinates")
    return RawMesh(
        vertices=points.astype("<f8").tobytes(),
        triangles=np.concatenate(triangles).astype("<u4").tobytes(),
        precision="float32",
        units=str(scene.units) if scene.units else None,
        warnings=tuple(outline.warnings.items()),
    )
