"""Cuts a mesh into pieces that can be decomposed separately, without changing the solid."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from satcheck.core import Mesh

Bounds = tuple[tuple[float, float, float], tuple[float, float, float]]


def independent_pieces(mesh: Mesh) -> list[Mesh]:
    """Pieces of a solid mesh whose union, as solids, is that solid.

    Each outward shell is a piece, together with the cavities that may lie in it, because a cavity
    alone would be filled. Bounding boxes decide this. Two shells may therefore stay together
    needlessly, but a cavity is never separated from its shell.
    """
    components = mesh.components()
    if len(components) < 2:
        return [mesh]
    cavities = [part for part in components if part.topology().volume < 0.0]
    groups = [[part] for part in components if part.topology().volume >= 0.0]
    for cavity in cavities:
        around = [group for group in groups if any(_encloses(shell, cavity) for shell in group)]
        joined = [shell for group in around for shell in group]
        groups = [group for group in groups if group not in around]
        groups.append([*joined, cavity])
    return [merged(group) for group in groups]


def merged(meshes: Sequence[Mesh]) -> Mesh:
    """All triangles in one mesh; nothing is welded."""
    if len(meshes) == 1:
        return meshes[0]
    offsets = np.cumsum([0] + [mesh.vertex_count for mesh in meshes[:-1]])
    return Mesh(
        np.concatenate([mesh.vertices for mesh in meshes]),
        np.concatenate(
            [mesh.triangles + offset for mesh, offset in zip(meshes, offsets, strict=True)]
        ).astype(np.uint32),
    )


def oriented(mesh: Mesh) -> Mesh:
    """Return the mesh welded, and wound outward if it is a closed manifold."""
    mesh = mesh.welded()
    return mesh.oriented() if mesh.topology().manifold else mesh


def diagonal(mesh: Mesh) -> float:
    """The diagonal of the bounding box."""
    low, high = mesh.bounds
    return math.dist(low, high)


def _encloses(outer: Mesh, inner: Mesh) -> bool:
    """Compares bounding boxes. False: `inner` certainly does not lie in `outer`."""
    (outer_low, outer_high), (inner_low, inner_high) = outer.bounds, inner.bounds
    return all(
        low <= inner_low[axis] and inner_high[axis] <= high
        for axis, (low, high) in enumerate(zip(outer_low, outer_high, strict=True))
    )
