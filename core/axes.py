"""The candidate axes of the separating axis theorem for two convex hulls, and the shadows on them.

Two disjoint convex polytopes are separated along a face normal of one of them or along the cross
product of an edge of each. If they overlap, the least overlap is along one of these, too
(S. Gottschalk, M. C. Lin, D. Manocha, "OBBTree", 1996). Of the pairs of edges only those count
whose arcs cross on the Gauss map, because only they make a face of the Minkowski difference
(D. Gregorius, "The Separating Axis Test between Convex Polyhedra", GDC 2013).

An axis is known exactly, as a normal of integers, although its unit direction is rounded. Float64
finds the corners that may end a shadow; integers decide between them.
"""

from __future__ import annotations

from fractions import Fraction
from functools import cached_property
from typing import Any

import numpy as np
from msgspec import Struct
from numpy.typing import NDArray

from satcheck._native.core import Polytope
from satcheck.core.conventions import Vector
from satcheck.core.rounding import UNIT_ROUNDOFF

Floats = NDArray[np.float64]
Indices = NDArray[np.int64]
Flags = NDArray[np.bool_]
Integers = NDArray[Any]  # of Python, of any size

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
# Of a height, times the largest coordinate: each component of a unit direction is off by 8, and
# 3 products and 2 sums are rounded, for 3 components.
HEIGHT_ROUNDOFFS = 64


class Corners(Struct, frozen=True):
    """Of a body. world: (n, 3). exact: these, times the scale, a power of two."""

    world: Floats
    exact: Integers
    scale: int


class Hull(Struct, frozen=True, dict=True):
    """Faces and edges of a hull. Of an outline in a plane, its sides are the faces, and it has no
    edges.

    normal: (t, 3), outward, of triangles. face: (t,), the flat face that each is part of. face_off:
    (t,), how far each normal may be off, radians. edges: (k, 2), tail and head, corners; those
    within a face come last, after `sides` others. beside: (k, 2), the triangles left and right of
    each. step: how finely coordinates are known, in world units.
    """

    corners: Corners
    normal: Integers
    face: Indices
    face_off: Floats
    edges: Indices
    beside: Indices
    sides: int
    step: float

    @property
    def faces(self) -> int:
        return int(self.face.max()) + 1

    @cached_property
    def unit(self) -> Floats:
        """(t, 3), of the normals."""
        return unit_of(self.normal)

    @cached_property
    def along(self) -> tuple[Floats, Floats]:
        """Of the edges: (k, 3), unit; and (k,), how far each may be off, radians."""
        along = self.corners.world[self.edges[:, 1]] - self.corners.world[self.edges[:, 0]]
        length = np.linalg.norm(along, axis=1)
        off = np.minimum(STEPS_OFF * self.step / length, WORST_TOLERANCE)
        return along / length[:, None], off

    @property
    def directions(self) -> tuple[int, int]:
        """How many of its face normals, and of its edges, are not parallel to each other."""
        along, off = (of_edges[: self.sides] for of_edges in self.along)
        normals = first_parallel(self.unit, self.face_off)
        return len(np.unique(normals)), len(np.unique(first_parallel(along, off)))


class Candidates(Struct, frozen=True):
    """Of faces and of pairs of edges. index: (m, 2), the face or edge of A and of B; -1: none.
    tolerance: (m,), how far each axis may be off, radians. plain: (m,), not of an edge within a
    face, nor of edges that are parallel within the precision of the input: such an axis means
    nothing to the eye, and an exact proof may need it.
    """

    index: Indices
    tolerance: Floats
    plain: Flags

    def where(self, kept: Flags) -> Candidates:
        return Candidates(self.index[kept], self.tolerance[kept], self.plain[kept])


class Shadows(Struct, frozen=True):
    """On one axis. direction: unit, from A to B. a, b: the least and the greatest world coordinate
    along it. gap: negative where the shadows overlap, by how much. sign: of the true gap."""

    direction: Vector
    a: tuple[float, float]
    b: tuple[float, float]
    gap: float
    sign: int


def corners_of(*worlds: Floats) -> list[Corners]:
    """Return the corners of each body, on one scale."""
    ratios = [[c.as_integer_ratio() for c in world.ravel().tolist()] for world in worlds]
    scale = max(under for of_one in ratios for _, under in of_one)
    bodies = []
    for world, of_one in zip(worlds, ratios, strict=True):
        exact = np.array([over * (scale // under) for over, under in of_one], dtype=object)
        bodies.append(Corners(world, exact.reshape(world.shape), scale))
    return bodies


def hull_of(polytope: Polytope, corners: Corners, step: float) -> Hull:
    """polytope: a solid, or a polygon in space. corners: its vertices. step: how finely their
    coordinates are known, in world units."""
    flat, world = polytope.dimension == 2, corners.world
    triangles = _fans(len(world)) if flat else polytope.triangles.astype(np.int64)
    p, q, r = (corners.exact[column] for column in triangles.T)
    normal = np.cross(q - p, r - p)
    ways = np.roll(world[triangles], -1, axis=1) - world[triangles]
    double_area = np.linalg.norm(np.cross(ways[:, 0], ways[:, 1]), axis=1)
    longest = np.linalg.norm(ways, axis=2).max(axis=1)
    with np.errstate(divide="ignore"):  # of a sliver whose area underflows
        off = np.minimum(STEPS_OFF * step * longest / double_area, WORST_TOLERANCE)
    # A hull has one face that looks into a direction.
    _, face = np.unique(first_parallel(unit_of(normal), off, oriented=True), return_inverse=True)
    edges, beside = _edges(triangles)
    within = face[beside[:, 0]] == face[beside[:, 1]]
    order, sides = np.argsort(within, kind="stable"), int((~within).sum())
    return Hull(corners, normal, face, off, edges[order], beside[order], sides, step)


def outline_of(corners: Corners, across: int, step: float) -> Hull:
    """corners: of a convex polygon, in order. across: the axis normal to its plane."""
    ways = np.roll(corners.exact, -1, axis=0) - corners.exact
    length = np.linalg.norm(np.roll(corners.world, -1, axis=0) - corners.world, axis=1)
    normal = np.cross(ways, np.eye(3, dtype=np.int64)[across].astype(object))
    off = np.minimum(STEPS_OFF * step / length, WORST_TOLERANCE)
    none: Indices = np.empty((0, 2), dtype=np.int64)
    return Hull(corners, normal, np.arange(len(normal)), off, none, none, 0, step)


def unit_of(normal: Integers) -> Floats:
    """Return (m, 3) unit directions. ZeroDivisionError: a normal is 0."""
    scaled = (normal / abs(normal).max(axis=1, keepdims=True)).astype(np.float64)
    unit: Floats = scaled / np.linalg.norm(scaled, axis=1)[:, None]
    return unit


def _fans(corners: int) -> Indices:
    """Return the two sides of a polygon, from different corners: no diagonal is on both."""
    front = [(0, k, k + 1) for k in range(1, corners - 1)]
    back = [(1, (k + 2) % corners, (k + 1) % corners) for k in range(1, corners - 1)]
    return np.array(front + back, dtype=np.int64)


def _edges(corners: Indices) -> tuple[Indices, Indices]:
    """Return the edges of a closed surface, (k, 2), and the triangles left and right of each."""
    tails, heads = corners.ravel(), np.roll(corners, -1, axis=1).ravel()
    owner = np.repeat(np.arange(len(corners)), 3)
    twin = np.empty_like(owner)
    twin[np.lexsort((heads, tails))] = owner[np.lexsort((tails, heads))]
    chosen = tails < heads
    return np.column_stack((tails, heads))[chosen], np.column_stack((owner, twin))[chosen]


def edge_pairs(a: Hull, b: Hull) -> Candidates:
    """Return the pairs of edges that can make a face of the difference."""
    index = _crossing(a, b)
    (along_a, off_a), (along_b, off_b) = a.along, b.along
    sine = np.linalg.norm(np.cross(along_a[index[:, 0]], along_b[index[:, 1]]), axis=1)
    index, sine = index[sine > FLAT], sine[sine > FLAT]
    i, j = index.T
    off = off_a[i] + off_b[j]
    plain = (i < a.sides) & (j < b.sides) & (sine > off)
    return Candidates(index, np.minimum(off / sine, WORST_TOLERANCE), plain)


def with_faces(a: Hull, b: Hull, pairs: Candidates) -> tuple[Integers, Candidates]:
    """Return the normals, (m, 3), of the faces of A, the faces of B and pairs of edges, which is
    the order of testing, and these candidates."""
    faces = np.full((len(a.face) + len(b.face), 2), -1)
    faces[: len(a.face), 0], faces[len(a.face) :, 1] = a.face, b.face
    ends = (
        side.corners.exact[side.edges[k]] for side, k in zip((a, b), pairs.index.T, strict=True)
    )
    across = np.cross(*(of_edges[:, 1] - of_edges[:, 0] for of_edges in ends))
    return np.concatenate((a.normal, b.normal, across)), Candidates(
        index=np.concatenate((faces, pairs.index)),
        tolerance=np.concatenate((a.face_off, b.face_off, pairs.tolerance)),
        plain=np.concatenate((np.full(len(faces), True), pairs.plain)),
    )


def _crossing(a: Hull, b: Hull) -> Indices:
    """Return (k, 2), all pairs of edges but for those whose arcs are surely apart on the Gauss map,
    that of B mirrored."""
    (left_a, right_a), (left_b, right_b) = (side.unit[side.beside.T] for side in (a, b))
    (along_a, _), (along_b, _) = a.along, b.along
    out_a, out_b = np.cross(left_a + right_a, along_a), np.cross(along_b, left_b + right_b)
    blocks: list[Indices] = [np.empty((0, 2), dtype=np.int64)]
    step = max(1, BLOCK // max(1, len(b.edges)))
    for first in range(0, len(a.edges), step):
        some = slice(first, first + step)
        along = along_a[some]
        on_b = along @ left_b.T, along @ right_b.T
        on_a = left_a[some] @ along_b.T, right_a[some] @ along_b.T
        apart = _alike(*on_b) | _alike(*on_a)
        # Great circles cross twice: arcs that cross both on different halves do not meet.
        clear = np.min([np.abs(side) for side in (*on_a, *on_b)], axis=0) > ARC_UNCERTAIN
        apart |= clear & _alike(out_a[some] @ along_b.T, along @ out_b.T)
        i, j = np.nonzero(~apart)
        blocks.append(np.column_stack((first + i, j)))
    return np.concatenate(blocks)


def _alike(one: Floats, other: Floats) -> Flags:
    """Return whether they surely have the same sign."""
    sure = np.minimum(np.abs(one), np.abs(other)) > ARC_UNCERTAIN
    return np.asarray(sure & ((one > 0) == (other > 0)))


def first_parallel(unit: Floats, tolerance: Floats, *, oriented: bool = False) -> Indices:
    """Return for each axis the first one to which it is parallel, itself if none before it is.

    unit: (n, 3). tolerance: (n,), radians: how far each may be off. oriented: otherwise a direction
    and its opposite are one axis.
    """
    key = (unit * (_GENERIC / np.linalg.norm(_GENERIC))).sum(axis=1) ** 2
    order = np.argsort(key, kind="stable")
    # The square of a cosine changes by at most twice the angle.
    reach = 2 * (tolerance + tolerance.max(initial=0.0)) + 1e-15
    low = np.searchsorted(key[order], key - reach, side="left")
    high = np.searchsorted(key[order], key + reach, side="right")
    first: Indices = np.full(len(unit), -1)
    for k in range(len(unit)):
        if first[k] >= 0:
            continue
        near = order[low[k] : high[k]]
        near = near[first[near] < 0]
        if oriented:
            near = near[unit[near] @ unit[k] > 0]
        sine = np.linalg.norm(np.cross(unit[near], unit[k]), axis=1)
        first[near[sine <= tolerance[near] + tolerance[k]]] = k
        first[k] = k
    return first


def shadows(normal: Integers, unit: Floats, a: Corners, b: Corners) -> Shadows:
    """Return those on one axis, (3,). unit: its direction."""
    (low_a, high_a), (low_b, high_b) = (_ends(side, normal, unit) for side in (a, b))
    forward, backward = low_b - high_a, low_a - high_b
    largest = max(normal.tolist(), key=abs)
    # The axis leads from A to B. Where both ways are as good, its largest component is positive.
    if backward > forward or (backward == forward and largest < 0):
        return shadows(-normal, -unit, a, b)
    size = float(np.linalg.norm((normal / largest).astype(np.float64)))

    def along(height: int) -> float:
        return float(Fraction(height, abs(largest) * a.scale)) / size

    x, y, z = (unit + 0.0).tolist()
    on_a, on_b = (along(low_a), along(high_a)), (along(low_b), along(high_b))
    return Shadows((x, y, z), on_a, on_b, along(forward), (forward > 0) - (forward < 0))


def _ends(corners: Corners, normal: Integers, unit: Floats) -> tuple[int, int]:
    """Return the least and the greatest exact height of corners along a normal."""
    heights = corners.world @ unit
    off = HEIGHT_ROUNDOFFS * UNIT_ROUNDOFF * float(np.abs(corners.world).max())
    lowest = corners.exact[heights <= heights.min() + off]
    highest = corners.exact[heights >= heights.max() - off]
    return (lowest * normal).sum(axis=1).min(), (highest * normal).sum(axis=1).max()
