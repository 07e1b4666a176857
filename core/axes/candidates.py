"""The axes that the separating axis theorem names for two convex hulls.

Two disjoint convex polytopes are separated along a face normal of one of them or along the cross
product of an edge of each. If they overlap, the least overlap is along one of these, too
(S. Gottschalk, M. C. Lin, D. Manocha, "OBBTree", 1996). Of the pairs of edges only those count
whose arcs cross on the Gauss map, because only they make a face of the Minkowski difference
(D. Gregorius, "The Separating Axis Test between Convex Polyhedra", GDC 2013).
"""

from __future__ import annotations

from typing import Literal

import numpy as np
from msgspec import Struct
from numpy.typing import NDArray

from satcheck.core.axes.features import WORST_TOLERANCE, Features
from satcheck.core.axes.parallel import first_parallel
from satcheck.core.axes.shadows import Floats, Indices

AxisKind = Literal["face-a", "face-b", "edge-edge", "edge-a", "edge-b"]

# Arcs that come this close on the Gauss map may cross. The rounding of their normals is smaller.
ARC_UNCERTAIN = 1e-7
# Edges closer to parallel than this (radians) have a cross product without a direction:
# 64 roundoffs, as in core/native/base/rounding.hpp.
FLAT = 2.0**-47
# Pairs of edges in memory at a time.
BLOCK = 1 << 20


class Candidates(Struct, frozen=True):
    """In the order of testing: faces of A, faces of B, pairs of edges.

    corners: (m, 4), the axis is (q - p) x (s - r). tolerance: (m,), how far each may be off,
    radians. kind: (m,). index_a, index_b: (m,), the face or edge of each body; -1: none. counted:
    (m,), not of an edge within a flat face.
    """

    corners: Indices
    tolerance: Floats
    kind: tuple[AxisKind, ...]
    index_a: Indices
    index_b: Indices
    counted: NDArray[np.bool_]


class EdgePairs(Struct, frozen=True):
    """rows: (k, 2), pairs that can make a face of the Minkowski difference. noise: (k,), edges that
    are parallel within the precision of the input."""

    rows: Indices
    sine: Floats
    noise: NDArray[np.bool_]


def edge_pairs(a: Features, b: Features) -> EdgePairs:
    step = max(1, BLOCK // max(1, len(b.edges)))
    blocks = [
        _crossing(a, b, np.arange(first, min(first + step, len(a.edges))))
        for first in range(0, len(a.edges), step)
    ]
    rows = np.concatenate(blocks)
    sine = np.linalg.norm(np.cross(a.direction[rows[:, 0]], b.direction[rows[:, 1]]), axis=1)
    rows, sine = rows[sine > FLAT], sine[sine > FLAT]
    noise = sine <= a.edge_off[rows[:, 0]] + b.edge_off[rows[:, 1]]
    return EdgePairs(rows, sine, noise)


def _crossing(a: Features, b: Features, some: Indices) -> Indices:
    """Pairs of some edges of A and all of B, but for those whose arcs are surely apart."""
    b_left, b_right = -(a.direction[some] @ b.left.T), -(a.direction[some] @ b.right.T)
    a_left, a_right = a.left[some] @ b.direction.T, a.right[some] @ b.direction.T
    near_b = np.minimum(np.abs(b_left), np.abs(b_right))
    near_a = np.minimum(np.abs(a_left), np.abs(a_right))
    apart = (b_left * b_right > 0) & (near_b > ARC_UNCERTAIN)
    apart |= (a_left * a_right > 0) & (near_a > ARC_UNCERTAIN)
    rows = np.argwhere(~apart)
    sure = np.minimum(near_a, near_b)[~apart] > ARC_UNCERTAIN
    rows[:, 0] = some[rows[:, 0]]
    return rows[~(sure & _on_opposite_sides(a, b, rows))]


def _on_opposite_sides(a: Features, b: Features, rows: Indices) -> NDArray[np.bool_]:
    """Of arcs that cross each other's great circles: whether they do so on opposite sides."""
    i, j = rows.T
    across = np.cross(a.direction[i], b.direction[j])
    on_a = (across * (a.left[i] + a.right[i])).sum(axis=1)
    on_b = -(across * (b.left[j] + b.right[j])).sum(axis=1)
    least = np.minimum(np.abs(on_a), np.abs(on_b))
    sure = least > ARC_UNCERTAIN * np.linalg.norm(across, axis=1)
    return np.asarray(sure & ((on_a > 0) != (on_b > 0)))


def candidates(a: Features, b: Features, pairs: EdgePairs, *, noise: bool) -> Candidates:
    """noise: with pairs of edges that are parallel within the precision of the input. Their axes
    mean nothing to the eye, and an exact proof may need them."""
    kept = slice(None) if noise else ~pairs.noise
    (i, j), sine = pairs.rows[kept].T, pairs.sine[kept]
    of_edges = np.column_stack((a.edges[i], b.edges[j]))
    off = (a.edge_off[i] + b.edge_off[j]) / sine
    sides = (i < a.sides) & (j < b.sides)
    none_a, none_b = np.full(len(a.face), -1), np.full(len(b.face), -1)
    kinds: tuple[tuple[AxisKind, int], ...] = (
        ("face-a", len(a.face)),
        ("face-b", len(b.face)),
        ("edge-edge", len(i)),
    )
    return Candidates(
        corners=np.concatenate((a.triangles, b.triangles, of_edges)),
        tolerance=np.concatenate((a.face_off, b.face_off, np.minimum(off, WORST_TOLERANCE))),
        kind=tuple(kind for kind, count in kinds for _ in range(count)),
        index_a=np.concatenate((a.face, none_b, i)),
        index_b=np.concatenate((none_a, b.face, j)),
        counted=np.concatenate((none_a < 0, none_b < 0, sides)),
    )


def direction_count(unit: Floats, tolerance: Floats) -> int:
    """How many of these are not parallel to each other."""
    return len(np.unique(first_parallel(unit, tolerance)))
