"""The meshes of a file as one, each where the file places it."""

from __future__ import annotations

import numpy as np

from satcheck.core import Mesh
from satcheck.core.transform import Transform
from satcheck.scene.errors import MeshFileError
from satcheck.scene.loading import limits
from satcheck.scene.loading.raw_mesh import NO_SURFACE, Block, RawMesh, RawScene


def flattened(scene: RawScene) -> RawMesh:
    """One mesh of all nodes; one of lines or points alone adds nothing but a warning.

    Raises MeshFileError when another one cannot be used, and when all together exceed the triangle
    limit.
    """
    warnings = dict(scene.warnings)
    placed = []
    for node in scene.nodes:
        mesh = scene.parts[node.part].mesh
        if isinstance(mesh, RawMesh):
            placed.append((mesh, node.matrix))
        elif mesh.code == NO_SURFACE:
            warnings["ignored-geometry"] = mesh.message
        else:
            raise MeshFileError(mesh.code, mesh.message)
    total = sum(len(mesh.triangles) // 12 for mesh, _ in placed)
    if total > limits.MAX_TRIANGLES:
        raise MeshFileError(
            "too-large", f"{total} triangles in all instances exceed {limits.MAX_TRIANGLES}"
        )
    meshes = [mesh for mesh, _ in placed]
    vertices, triangles = concatenate(
        [(mesh.vertices, mesh.triangles, matrix) for mesh, matrix in placed]
    )
    for mesh in meshes:
        warnings |= dict(mesh.warnings)
    return RawMesh(
        vertices=vertices,
        triangles=triangles,
        precision=meshes[0].precision,
        decimals=max(mesh.decimals for mesh in meshes),
        significant=max(mesh.significant for mesh in meshes),
        units=meshes[0].units,
        warnings=tuple(warnings.items()),
    )


def concatenate(parts: list[tuple[Block, Block, Transform | None]]) -> tuple[Block, Block]:
    """(vertices, triangles) of all parts together, each at its matrix.

    parts: float64 vertices and uint32 triangles as in RawMesh. A mirroring matrix flips the
    winding.
    """
    if len(parts) == 1 and parts[0][2] is None:
        return parts[0][:2]
    placed = [
        (vertices, triangles) if matrix is None else _placed(vertices, triangles, matrix)
        for vertices, triangles, matrix in parts
    ]
    offsets = np.cumsum([0, *(len(vertices) // 24 for vertices, _ in placed)], dtype=np.uint32)
    corners = [
        np.frombuffer(triangles, "<u4") + offset
        for (_, triangles), offset in zip(placed, offsets, strict=False)
    ]
    return b"".join(vertices for vertices, _ in placed), b"".join(c.tobytes() for c in corners)


def _placed(vertices: Block, triangles: Block, matrix: Transform) -> tuple[Block, Block]:
    try:
        return Mesh.from_bytes(vertices, triangles).transformed(matrix).to_bytes()
    except ValueError as error:
        raise MeshFileError("singular-transform", f"a part cannot be placed: {error}") from None
    except OverflowError as error:
        raise MeshFileError("out-of-range", f"a part cannot be placed: {error}") from None
