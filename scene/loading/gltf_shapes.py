"""What moves the vertices of a glTF mesh before its node places it: morph targets and skins."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from satcheck.core.transform import Transform
from satcheck.scene.errors import MeshFileError
from satcheck.scene.loading.gltf_accessors import Columns, Floats


def morphed(positions: Floats, moves: Sequence[tuple[float, Floats]]) -> Floats:
    """positions: (n, 3). moves: a weight, and how far 1.0 moves each vertex."""
    moved = positions.copy()
    for weight, move in moves:
        if len(move) != len(moved):
            raise MeshFileError("count-mismatch", "a morph target has another number of vertices")
        moved += weight * move
    return _finite(moved)


def skinned(
    points: Floats, columns: Columns, joints: Sequence[Transform], bound: Floats | None, where: str
) -> Floats:
    """Each vertex where its joints put it, in world coordinates.

    columns: of the attributes JOINTS_0, WEIGHTS_0, JOINTS_1 and so on. joints: row-major 4x4, from
    each joint to the world. bound: column-major 4x4, from the mesh to each joint. As the last rows
    of matrices and the sums of weights are rounded in many files, what they make is divided by its
    fourth coordinate.
    """
    matrices = np.array(joints, np.float64).reshape(-1, 4, 4)
    if bound is not None:
        matrices = matrices @ bound[: len(joints)].reshape(-1, 4, 4).transpose(0, 2, 1)
    blended = np.zeros((len(points), 4, 4))
    number = 0
    while (indices := columns(f"JOINTS_{number}", "VEC4")) is not None:
        weights = columns(f"WEIGHTS_{number}", "VEC4")
        if weights is None or not len(indices) == len(weights) == len(points):
            raise MeshFileError("count-mismatch", f"{where}: joints and weights are not one each")
        numbers = indices.astype(np.int64)
        if numbers.size and numbers.max() >= len(matrices):
            raise MeshFileError(
                "index-out-of-range", f"{where}: joint {numbers.max()} of {len(matrices)}"
            )
        for k in range(4):
            blended += weights[:, k, None, None] * matrices[numbers[:, k]]
        number += 1
    placed = np.einsum("nij,nj->ni", blended[:, :, :3], points) + blended[:, :, 3]
    if not (placed[:, 3] > 0).all():
        raise MeshFileError("bad-record", f"{where}: a vertex of the skin has no joint")
    return _finite(placed[:, :3] / placed[:, 3:])


def _finite(points: Floats) -> Floats:
    if not np.isfinite(points).all():
        raise MeshFileError("non-finite", "the pose makes non-finite coordinates")
    return points
