"""The axes that the separating axis theorem names for two convex hulls.

Two disjoint convex polytopes are separated along a face normal of one of them or along the cross
product of an edge of each. If they overlap, the least overlap is along one of these, too
(S. Gottschalk, M. C. Lin, D. Manocha, "OBBTree", 1996). Of the pairs of edges only those count
whose arcs cross on the Gauss map, because only they make a face of the Minkowski difference
(D. Gregorius, "The Separating Axis Test between Convex Polyhedra", GDC 2013).
"""

from __future__ import annotations

import numpy as np
from msgspec import Struct
from numpy.typing import NDArray

from satcheck._native.core import Polytope
from satcheck.core.axes.shadows import Floats, Indices, Points

# How far the corners of two triangles of one flat face may be off each other's planes, in steps of
# the coordinates: the plane through three of four corners is extrapolated to the fourth.
STEPS_OFF = 8.0
# A direction known no better than this (radians, 0.003 degrees) is still told from others.
WORST_TOLERANCE = 2.0**-14
# Arcs that come this close on the Gauss map may cross. The rounding of their normals is smaller.
ARC_UNCERTAIN = 1e-7
# Edges closer to parallel than this (radians) have a cross product without a direction:
# 64 roundoffs, as in core/native/base/rounding.hpp.
FLAT = 2.0**-47
# Pairs of edges in memory at a time.
BLOCK = 1 << 20
# In no special position to the axes of any model: projections on it tell most directions apart.
_GENERIC = np.array([0.5384, 0.3217, 0.7789])


class Features(Struct, frozen=True):
    """Of one hull; indices into the points that both hulls share.

    points: (n,). triangles: (t, 4), the normal is the axis of these corners. face: (t,), the flat
    face that each is part of. face_off: (t,), how far each normal may be off, radians.
    edges: (k, 2), tail and head; those within a face that is flat, or nearly so, come last.
    edge_off: (k,). left, right: (k, 3), outward unit normals of the triangles beside each.
    sides: how many edges lie between two flat faces.
    """

    points: Indices
    triangles: Indices
    face: Indices
    normal: Floats
    face_off: Floats
    edges: Indices
    direction: Floats
    edge_off: Floats
    left: Floats
    right: Floats
    sides: int

    @property
    def faces(self) -> int:
        return int(self.face.max()) + 1


class EdgePairs(Struct, frozen=True):
    """rows: (k, 2), pairs that can make a face of the Minkowski difference. noise: (k,), edges that
    are parallel within the precision of the input."""

    rows: Indices
    sine: Floats
    noise: NDArray[np.bool_]


class Candidates(Struct, frozen=True):
    """In the order of testing: faces of A, faces of B, pairs of edges.

    axes: (m, 4), see Points. tolerance: (m,), how far each may be off, radians. index: (m, 2), the
    face or edge of A and of B; -1: none. counted: (m,), not of an edge within a face.
    """

    axes: Indices
    tolerance: Floats
    index: Indices
    counted: NDArray[np.bool_]


def features_of(hull: Polytope, first: int, points: Points, step: float) -> Features:
    """hull: a solid, or a polygon in space. first: its first vertex in `points`. step: how finely
    its coordinates are known, in world units."""
    corners = _corners(hull) + first
    triangles = corners[:, [0, 1, 0, 2]]
    normal, _ = points.directions(triangles)
    p, q, r = (points.world[column] for column in corners.T)
    height = np.linalg.norm(np.cross(q - p, r - p), axis=1) / np.linalg.norm(r - q, axis=1)
    with np.errstate(divide="ignore"):  # of a sliver whose height underflows
        face_off = np.minimum(STEPS_OFF * step / height, WORST_TOLERANCE)
    edges, left, right = _edges(corners)
    sine = np.linalg.norm(np.cross(normal[left], normal[right]), axis=1)
    is_flat = sine <= face_off[left] + face_off[right]
    is_flat &= (normal[left] * normal[right]).sum(axis=1) > 0
    order = np.argsort(is_flat, kind="stable")
    along = points.world[edges[order, 1]] - points.world[edges[order, 0]]
    length = np.linalg.norm(along, axis=1)
    return Features(
        points=np.arange(first, first + hull.vertex_count),
        triangles=triangles,
        face=_joined(len(triangles), left[is_flat], right[is_flat]),
        normal=normal,
        face_off=face_off,
        edges=edges[order],
        direction=along / length[:, None],
        edge_off=np.minimum(STEPS_OFF * step / length, WORST_TOLERANCE),
        left=normal[left[order]],
        right=normal[right[order]],
        sides=int((~is_flat).sum()),
    )


def _corners(hull: Polytope) -> Indices:
    """(t, 3): the corners of each triangle, that opposite its longest edge first."""
    triangles = _fans(hull.vertex_count) if hull.dimension == 2 else hull.triangles
    corners = np.asarray(hull.vertices)[triangles]
    opposite = np.linalg.norm(np.roll(corners, -1, 1) - np.roll(corners, -2, 1), axis=2)
    turn = opposite.argmax(axis=1)[:, None]
    return np.take_along_axis(triangles, (turn + np.arange(3)) % 3, axis=1).astype(np.int64)


def _fans(corners: int) -> Indices:
    """The two sides of a polygon, from different corners: no diagonal is on both."""
    front = [(0, k, k + 1) for k in range(1, corners - 1)]
    back = [(1, (k + 2) % corners, (k + 1) % corners) for k in range(1, corners - 1)]
    return np.array(front + back, dtype=np.int64)


def _edges(corners: Indices) -> tuple[Indices, Indices, Indices]:
    """(k, 2), and the triangles left and right of each, of a closed surface."""
    tails, heads = corners.ravel(), np.roll(corners, -1, axis=1).ravel()
    owner = np.repeat(np.arange(len(corners)), 3)
    twin = np.empty(len(tails), dtype=np.int64)
    twin[np.lexsort((heads, tails))] = owner[np.lexsort((tails, heads))]
    chosen = tails < heads
    return np.column_stack((tails[chosen], heads[chosen])), owner[chosen], twin[chosen]


def _joined(count: int, left: Indices, right: Indices) -> Indices:
    """The number of the flat face of each triangle; neighbours across a flat edge share it."""
    label: NDArray[np.int64] = np.arange(count)
    while (label[left] != label[right]).any():
        least = np.minimum(label[left], label[right])
        np.minimum.at(label, left, least)
        np.minimum.at(label, right, least)
    return np.unique(label, return_inverse=True)[1].astype(np.int64)


def edge_pairs(a: Features, b: Features) -> EdgePairs:
    """All pairs, but for those whose arcs are surely apart on the Gauss map, that of B mirrored."""
    out_a = np.cross(a.left + a.right, a.direction)
    out_b = np.cross(b.direction, b.left + b.right)
    blocks = []
    step = max(1, BLOCK // max(1, len(b.edges)))
    for first in range(0, len(a.edges), step):
        some = slice(first, first + step)
        along = a.direction[some]
        on_b = along @ b.left.T, along @ b.right.T
        on_a = a.left[some] @ b.direction.T, a.right[some] @ b.direction.T
        apart = _alike(*on_b) | _alike(*on_a)
        # Great circles cross twice: arcs that cross both on different halves do not meet.
        clear = np.min([np.abs(side) for side in (*on_a, *on_b)], axis=0) > ARC_UNCERTAIN
        apart |= clear & _alike(out_a[some] @ b.direction.T, along @ out_b.T)
        i, j = np.nonzero(~apart)
        blocks.append(np.column_stack((first + i, j)))
    rows = np.concatenate(blocks)
    sine = np.linalg.norm(np.cross(a.direction[rows[:, 0]], b.direction[rows[:, 1]]), axis=1)
    rows, sine = rows[sine > FLAT], sine[sine > FLAT]
    noise = sine <= a.edge_off[rows[:, 0]] + b.edge_off[rows[:, 1]]
    return EdgePairs(rows, sine, noise)


def _alike(one: Floats, other: Floats) -> NDArray[np.bool_]:
    """Whether they surely have the same sign."""
    sure = np.minimum(np.abs(one), np.abs(other)) > ARC_UNCERTAIN
    return np.asarray(sure & ((one > 0) == (other > 0)))


def candidates(a: Features, b: Features, pairs: EdgePairs, *, noise: bool) -> Candidates:
    """noise: with pairs of edges that are parallel within the precision of the input. Their axes
    mean nothing to the eye, and an exact proof may need them."""
    kept = slice(None) if noise else ~pairs.noise
    rows, sine = pairs.rows[kept], pairs.sine[kept]
    i, j = rows.T
    off = np.minimum((a.edge_off[i] + b.edge_off[j]) / sine, WORST_TOLERANCE)
    faces_a = np.column_stack((a.face, np.full(len(a.face), -1)))
    faces_b = np.column_stack((np.full(len(b.face), -1), b.face))
    index = np.concatenate((faces_a, faces_b, rows))
    counted = np.full(len(index), True)
    counted[len(a.face) + len(b.face) :] = (rows < (a.sides, b.sides)).all(axis=1)
    return Candidates(
        axes=np.concatenate((a.triangles, b.triangles, np.column_stack((a.edges[i], b.edges[j])))),
        tolerance=np.concatenate((a.face_off, b.face_off, off)),
        index=index,
        counted=counted,
    )


def first_parallel(unit: Floats, tolerance: Floats) -> Indices:
    """For each axis the first one to which it is parallel, itself if there is none before it.

    unit: (n, 3). tolerance: (n,), radians: how far each may be off. A direction and its opposite
    are one axis.
    """
    key = (unit * (_GENERIC / np.linalg.norm(_GENERIC))).sum(axis=1) ** 2
    order = np.argsort(key, kind="stable")
    # The square of a cosine changes by at most twice the angle.
    reach = 2 * (tolerance + tolerance.max(initial=0.0)) + 1e-15
    low = np.searchsorted(key[order], key - reach, side="left")
    high = np.searchsorted(key[order], key + reach, side="right")
    first: NDArray[np.int64] = np.full(len(unit), -1)
    for k in range(len(unit)):
        if first[k] >= 0:
            continue
        near = order[low[k] : high[k]]
        near = near[first[near] < 0]
        sine = np.linalg.norm(np.cross(unit[near], unit[k]), axis=1)
        first[near[sine <= tolerance[near] + tolerance[k]]] = k
        first[k] = k
    return first


def direction_count(unit: Floats, tolerance: Floats) -> int:
    """How many of these are not parallel to each other."""
    return len(np.unique(first_parallel(unit, tolerance)))
