"""The faces and edges of a convex hull, as the separating axis theorem needs them."""

from __future__ import annotations

import numpy as np
from msgspec import Struct
from numpy.typing import NDArray

from satcheck._native.core import Polytope
from satcheck.core.axes.shadows import Axes, ExactPoints, Floats, Indices, directions

# How far the corners of two triangles of one flat face may be off each other's planes, in steps of
# the coordinates: the plane through three of four corners is extrapolated to the fourth.
STEPS_OFF = 8.0
# A direction known no better than this (radians, 0.003 degrees) is still told from others.
WORST_TOLERANCE = 2.0**-14
# Radians. Float64 normals of triangles in one plane differ by less; for others integers decide.
ALMOST_FLAT = 1e-6


class Features(Struct, frozen=True):
    """Of one hull; indices into the points that both hulls share.

    points: (n,). triangles: (t, 4), the normal is the axis of these corners. face: (t,), the flat
    face that each is part of. face_off: (t,), how far each normal may be off, radians.
    edges: (k, 2), tail and head; those within a face that is only nearly flat come last.
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


def features_of(
    hull: Polytope, first: int, points: Floats, exact: ExactPoints, step: float
) -> Features:
    """hull: a solid, or a polygon in space. first: its first vertex in `points`. step: how finely
    its coordinates are known, in world units."""
    triangles = _corners(hull) + first
    normal, _ = directions(Axes(points, triangles), exact)
    u, v = Axes(points, triangles).vectors()
    longest = np.linalg.norm(v - u, axis=1)
    height = np.linalg.norm(np.cross(u, v), axis=1) / longest
    with np.errstate(divide="ignore"):  # of a sliver whose height underflows
        face_off = np.minimum(STEPS_OFF * step / height, WORST_TOLERANCE)
    edges, left, right = _edges(triangles)
    folded = _folded(triangles, left, right, normal, exact)
    sine = np.linalg.norm(np.cross(normal[left], normal[right]), axis=1)
    is_flat = sine <= face_off[left] + face_off[right]
    is_flat &= (normal[left] * normal[right]).sum(axis=1) > 0
    order = np.argsort(is_flat, kind="stable")
    order = order[folded[order]]
    along = points[edges[order, 1]] - points[edges[order, 0]]
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
    """(t, 4): two edges of each triangle that meet opposite its longest one. Their cross product is
    the outward normal."""
    triangles = _fans(hull.vertex_count) if hull.dimension == 2 else np.asarray(hull.triangles)
    triangles = triangles.astype(np.int64)
    corners = np.asarray(hull.vertices)[triangles]
    opposite = np.linalg.norm(np.roll(corners, -1, 1) - np.roll(corners, -2, 1), axis=2)
    turn = opposite.argmax(axis=1)[:, None]
    p, q, r = np.take_along_axis(triangles, (turn + np.arange(3)) % 3, axis=1).T
    return np.column_stack((p, q, p, r))


def _fans(corners: int) -> Indices:
    """The two sides of a polygon, from different corners: no diagonal is on both."""
    front = [(0, k, k + 1) for k in range(1, corners - 1)]
    back = [(1, (k + 2) % corners, (k + 1) % corners) for k in range(1, corners - 1)]
    return np.array(front + back, dtype=np.int64)


def _edges(triangles: Indices) -> tuple[Indices, Indices, Indices]:
    """(k, 2), and the triangles left and right of each, of a closed surface."""
    loops = triangles[:, [0, 1, 3]]
    tails, heads = loops.ravel(), np.roll(loops, -1, axis=1).ravel()
    owner = np.repeat(np.arange(len(loops)), 3)
    there = np.lexsort((heads, tails))
    back = np.lexsort((tails, heads))
    twin = np.empty(len(tails), dtype=np.int64)
    twin[there] = owner[back]
    chosen = tails < heads
    edges = np.column_stack((tails[chosen], heads[chosen]))
    return edges, owner[chosen], twin[chosen]


def _folded(
    triangles: Indices, left: Indices, right: Indices, normal: Floats, exact: ExactPoints
) -> NDArray[np.bool_]:
    """Whether the two triangles of each edge lie in different planes, exactly: others are no edge
    of the hull. The two sides of a polygon meet in a fold."""
    sine = np.linalg.norm(np.cross(normal[left], normal[right]), axis=1)
    folded = (sine > ALMOST_FLAT) | ((normal[left] * normal[right]).sum(axis=1) < 0)
    for k in np.flatnonzero(~folded):
        folded[k] = not exact.in_plane(triangles[left[k]], triangles[right[k]])
    return np.asarray(folded)


def _joined(count: int, left: Indices, right: Indices) -> Indices:
    """The number of the flat face of each triangle; neighbours across a flat edge share it."""
    label: NDArray[np.int64] = np.arange(count)
    while (label[left] != label[right]).any():
        least = np.minimum(label[left], label[right])
        np.minimum.at(label, left, least)
        np.minimum.at(label, right, least)
    return np.unique(label, return_inverse=True)[1].astype(np.int64)
