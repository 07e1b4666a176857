"""What moves the vertices of a glTF mesh before its node places it: morph targets and skins."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from satcheck.scene.errors import MeshFileError
from satcheck.scene.loading.gltf_accessors import Columns
from satcheck.scene.loading.raw_mesh import Block, Matrix


def morphed(positions: Block, moves: Sequence[tuple[float, Block]]) -> bytes:
    """positions: float64 x, y, z of each vertex. moves: a weight, and how far 1.0 moves each."""
    moved = np.frombuffer(positions, "<f8").copy()
    for weight, move in moves:
        by = np.frombuffer(move, "<f8")
        if len(by) != len(moved):
            raise MeshFileError("count-mismatch", "a morph target has another number of vertices")
        moved += weight * by
    return _finite(moved)


def skinned(
    positions: Block,
    columns: Columns,
    joints: Sequence[Matrix],
    bound: Sequence[Sequence[float]] | None,
    where: str,
) -> bytes:
    """Each vertex where its joints put it, in world coordinates.

    columns: of the attributes JOINTS_0, WEIGHTS_0, JOINTS_1 and so on. joints: row-major 4x4, from
    each joint to the world. bound: column-major 4x4, from the mesh to each joint. As the last rows
    of matrices and the sums of weights are rounded in many files, what they make is divided by its
    fourth coordinate.
    """
    points = np.frombuffer(positions, "<f8").reshape(-1, 3)
    matrices = np.array(joints, "<f8").reshape(-1, 4, 4)
    if bound is not None:
        inverse = np.array(bound[: len(joints)], "<f8").reshape(-1, 4, 4)
        matrices = matrices @ inverse.transpose(0, 2, 1)
    blended = np.zeros((len(points), 4, 4))
    number = 0
    while (of_joints := columns(f"JOINTS_{number}", "VEC4")) is not None:
        indices = np.array(of_joints).reshape(-1, 4).astype(np.int64)
        weights = np.array(columns(f"WEIGHTS_{number}", "VEC4") or ()).reshape(-1, 4)
        if len(indices) != len(points) or len(weights) != len(points):
            raise MeshFileError("count-mismatch", f"{where}: joints and weights are not one each")
        if indices.size and indices.max() >= len(matrices):
            raise MeshFileError(
                "index-out-of-range", f"{where}: joint {indices.max()} of {len(matrices)}"
            )
        for k in range(4):
            blended += weights[:, k, None, None] * matrices[indices[:, k]]
        number += 1
    placed = np.einsum("nij,nj->ni", blended[:, :, :3], points) + blended[:, :, 3]
    if not (placed[:, 3] > 0).all():
        raise MeshFileError("bad-record", f"{where}: a vertex of the skin has no joint")
    return _finite(placed[:, :3] / placed[:, 3:])


def _finite(points: np.ndarray) -> bytes:
    if not np.isfinite(points).all():
        raise MeshFileError("non-finite", "the pose makes non-finite coordinates")
    return points.astype("<f8").tobytes()
