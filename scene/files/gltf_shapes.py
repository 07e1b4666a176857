"""Morph targets and skins, which move the vertices of a glTF mesh before its node places it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from satcheck.core.transform import Transform
from satcheck.scene.errors import Refused
from satcheck.scene.files.gltf_accessors import Columns

if TYPE_CHECKING:
    from satcheck.scene.files.gltf_accessors import Floats


def morphed(positions: Floats, moves: Sequence[tuple[float, Floats]]) -> Floats:
    """positions: x, y, z of each vertex. moves: (weight, displacement of each vertex at weight
    1)."""
    moved = np.array(positions)
    for weight, move in moves:
        if len(move) != len(moved):
            raise Refused("count-mismatch", "a morph target has another number of vertices")
        moved += weight * np.array(move)
    return _finite(moved)


def skinned(
    positions: Floats,
    columns: Columns,
    joints: Sequence[Transform],
    bound: Floats | None,
    where: str,
) -> tuple[Floats, float]:
    """Each vertex where its joints put it, in world coordinates, and how far these joints stretch
    a length at most.

    positions: x, y, z of each vertex. columns: of the attributes JOINTS_0, WEIGHTS_0, JOINTS_1 and
    so on. joints: row-major 4x4, from each joint to the world. bound: column-major 4x4, from the
    mesh to each joint. Many files round the last rows of matrices and the sums of weights. Each
    result is therefore divided by its fourth coordinate.
    """
    points = np.array(positions).reshape(-1, 3)
    matrices = np.array(joints, np.float64).reshape(-1, 4, 4)
    if bound is not None:
        matrices = matrices @ np.array(bound).reshape(-1, 4, 4)[: len(joints)].transpose(0, 2, 1)
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
            raise Refused(
                "index-out-of-range", f"{where}: joint {numbers.max()} of {len(matrices)}"
            )
        used[numbers[weights != 0]] = True
        for k in range(4):
            blended += weights[:, k, None, None] * matrices[numbers[:, k]]
        number += 1
    placed = np.einsum("nij,nj->ni", blended[:, :, :3], points) + blended[:, :, 3]
    if not (placed[:, 3] > 0).all():
        raise Refused("bad-record", f"{where}: a vertex of the skin has no joint")
    stretch = np.linalg.norm(matrices[used, :3, :3], 2, axis=(1, 2)).max(initial=0.0)
    return _finite(placed[:, :3] / placed[:, 3:]), float(stretch)


def _finite(points: NDArray[np.float64]) -> Floats:
    if not np.isfinite(points).all():
        raise Refused("non-finite", "the pose makes non-finite coordinates")
    return memoryview(points.tobytes()).cast("d")
