"""The candidate axes of the separating axis theorem for two convex hulls, and the shadows on them.

Two disjoint convex polytopes are separated along a face normal of one of them or along the cross
product of an edge of each. If they overlap, the least overlap is along one of these, too
(S. Gottschalk, M. C. Lin, D. Manocha, "OBBTree", 1996). Of the pairs of edges only those count
whose arcs cross on the Gauss map, because only they make a face of the Minkowski difference
(D. Gregorius, "The Separating Axis Test between Convex Polyhedra", GDC 2013).

An axis is a row of four points, p q r s: the line along (q - p) x (s - r). So it is known exactly
although its unit direction is rounded. Float64 with a bound of its error decides most signs of
gaps; integers decide the others, after J. R. Shewchuk's plan (1997).
"""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import numpy as np
from msgspec import Struct
from numpy.typing import NDArray

from satcheck._native.core import Polytope
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
# Pairs of edges, or heights, in memory at a time.
BLOCK = 1 << 20
# In no special position to the axes of any model: projections on it tell most directions apart.
_GENERIC = np.array([0.5384, 0.3217, 0.7789])
# Of a component of a float64 cross product, times both lengths: one rounding in each of the two
# differences, 3 in the product; times the square root of 3 for the vector.
CROSS_ROUNDOFFS = 12
# A direction that is off by more (radians) is computed again, from integers.
TRUSTED_DIRECTION = 1e-12
# Of a unit direction from these: each component, its norm and the quotient are rounded.
EXACT_DIRECTION = 8 * UNIT_ROUNDOFF
# Of a height: a rounded difference from the centre, 3 products, 2 sums; times the root of 3.
HEIGHT_ROUNDOFFS = 16
# Of the gap that follows from integers: quotient, root and product.
VALUE_ROUNDOFFS = 8


class Hull(Struct, frozen=True):
    """Faces and edges of a hull; indices into points that both hulls share.

    points: (n,). triangles: (t, 4), the axes along their normals. normal: (t, 3), outward. face:
    (t,), the flat face that each is part of. face_off: (t,), how far each normal may be off,
    radians. edges: (k, 2), tail and head; those within a face come last, after `sides` others.
    along: (k, 3), unit. edge_off: (k,). left, right: (k, 3), the normals beside each.
    """

    points: Indices
    triangles: Indices
    normal: Floats
    face: Indices
    face_off: Floats
    edges: Indices
    sides: int
    along: Floats
    edge_off: Floats
    left: Floats
    right: Floats

    @property
    def faces(self) -> int:
        return int(self.face.max()) + 1


class Candidates(Struct, frozen=True):
    """In the order of testing: faces of A, faces of B, pairs of edges.

    axes: (m, 4). tolerance: (m,), how far each may be off, radians. index: (m, 2), the face or edge
    of A and of B; -1: none. plain: (m,), not of an edge within a face, nor of edges that are
    parallel within the precision of the input: such an axis means nothing to the eye, and an exact
    proof may need it.
    """

    axes: Indices
    tolerance: Floats
    index: Indices
    plain: Flags

    def where(self, kept: Flags) -> Candidates:
        return Candidates(self.axes[kept], self.tolerance[kept], self.index[kept], self.plain[kept])


class Shadows(Struct, frozen=True):
    """A row for each axis. direction: (m, 3), unit, from A to B. a, b: (m, 2), the least and the
    greatest world coordinate along it. gap: (m,), negative where the shadows overlap, by how much;
    off: (m,), how far it may be from the true one. sign: (m,), of the true gap."""

    direction: Floats
    a: Floats
    b: Floats
    gap: Floats
    off: Floats
    sign: NDArray[np.int8]


def hull_of(polytope: Polytope, first: int, world: Floats, step: float) -> Hull:
    """polytope: a solid, or a polygon in space. first: its first vertex in `world`. step: how
    finely its coordinates are known, in world units."""
    flat = polytope.dimension == 2
    corners = _fans(polytope.vertex_count) if flat else polytope.triangles.astype(np.int64)
    corners += first
    triangles = corners[:, [0, 1, 0, 2]]
    normal, _ = directions(world, triangles)
    ways = np.roll(world[corners], -1, axis=1) - world[corners]
    double_area = np.linalg.norm(np.cross(ways[:, 0], ways[:, 1]), axis=1)
    longest = np.linalg.norm(ways, axis=2).max(axis=1)
    with np.errstate(divide="ignore"):  # of a sliver whose area underflows
        face_off = np.minimum(STEPS_OFF * step * longest / double_area, WORST_TOLERANCE)
    # A hull has one face that looks into a direction.
    _, face = np.unique(first_parallel(normal, face_off, oriented=True), return_inverse=True)
    edges, left, right = _edges(corners)
    within = face[left] == face[right]
    order = np.argsort(within, kind="stable")
    edges, left, right = edges[order], left[order], right[order]
    along = world[edges[:, 1]] - world[edges[:, 0]]
    length = np.linalg.norm(along, axis=1)
    return Hull(
        points=np.arange(first, first + polytope.vertex_count),
        triangles=triangles,
        normal=normal,
        face=face.astype(np.int64),
        face_off=face_off,
        edges=edges,
        sides=int((~within).sum()),
        along=along / length[:, None],
        edge_off=np.minimum(STEPS_OFF * step / length, WORST_TOLERANCE),
        left=normal[left],
        right=normal[right],
    )


def _fans(corners: int) -> Indices:
    """Return the two sides of a polygon, from different corners: no diagonal is on both."""
    front = [(0, k, k + 1) for k in range(1, corners - 1)]
    back = [(1, (k + 2) % corners, (k + 1) % corners) for k in range(1, corners - 1)]
    return np.array(front + back, dtype=np.int64)


def _edges(corners: Indices) -> tuple[Indices, Indices, Indices]:
    """Return the edges of a closed surface, (k, 2), and the triangles left and right of each."""
    tails, heads = corners.ravel(), np.roll(corners, -1, axis=1).ravel()
    owner = np.repeat(np.arange(len(corners)), 3)
    twin = np.empty_like(owner)
    twin[np.lexsort((heads, tails))] = owner[np.lexsort((tails, heads))]
    chosen = tails < heads
    return np.column_stack((tails, heads))[chosen], owner[chosen], twin[chosen]


def candidates(a: Hull, b: Hull) -> Candidates:
    """Return the face normals, and the pairs of edges that can make a face of the difference."""
    rows = _crossing(a, b)
    sine = np.linalg.norm(np.cross(a.along[rows[:, 0]], b.along[rows[:, 1]]), axis=1)
    rows, sine = rows[sine > FLAT], sine[sine > FLAT]
    i, j = rows.T
    off = a.edge_off[i] + b.edge_off[j]
    proper = (i < a.sides) & (j < b.sides) & (sine > off)
    faces = np.full((len(a.face) + len(b.face), 2), -1)
    faces[: len(a.face), 0], faces[len(a.face) :, 1] = a.face, b.face
    worst = np.minimum(off / sine, WORST_TOLERANCE)
    return Candidates(
        axes=np.concatenate((a.triangles, b.triangles, np.hstack((a.edges[i], b.edges[j])))),
        tolerance=np.concatenate((a.face_off, b.face_off, worst)),
        index=np.concatenate((faces, rows)),
        plain=np.concatenate((np.full(len(faces), True), proper)),
    )


def _crossing(a: Hull, b: Hull) -> Indices:
    """Return (k, 2), all pairs of edges but for those whose arcs are surely apart on the Gauss map,
    that of B mirrored."""
    out_a = np.cross(a.left + a.right, a.along)
    out_b = np.cross(b.along, b.left + b.right)
    blocks = []
    step = max(1, BLOCK // len(b.edges))
    for first in range(0, len(a.edges), step):
        some = slice(first, first + step)
        along = a.along[some]
        on_b = along @ b.left.T, along @ b.right.T
        on_a = a.left[some] @ b.along.T, a.right[some] @ b.along.T
        apart = _alike(*on_b) | _alike(*on_a)
        # Great circles cross twice: arcs that cross both on different halves do not meet.
        clear = np.min([np.abs(side) for side in (*on_a, *on_b)], axis=0) > ARC_UNCERTAIN
        apart |= clear & _alike(out_a[some] @ b.along.T, along @ out_b.T)
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


def direction_count(unit: Floats, tolerance: Floats) -> int:
    """Return how many of these are not parallel to each other."""
    return len(np.unique(first_parallel(unit, tolerance)))


def integers(world: Floats) -> tuple[Integers, int]:
    """Return the coordinates times a power of two, and this."""
    ratios = [value.as_integer_ratio() for value in world.ravel().tolist()]
    scale = max(divisor for _, divisor in ratios)
    whole = [number * (scale // divisor) for number, divisor in ratios]
    return np.array(whole, dtype=object).reshape(world.shape), scale


def exact_normal(corners: Integers) -> Integers:
    p, q, r, s = corners
    (ux, uy, uz), (vx, vy, vz) = q - p, s - r
    return np.array([uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx], dtype=object)


def directions(world: Floats, axes: Indices) -> tuple[Floats, Floats]:
    """Return unit vectors along the axes, and how far each may be off (radians): a zero vector, and
    infinity, where the two differences are parallel."""
    p, q, r, s = (world[column] for column in axes.T)
    across = np.cross(q - p, s - r)
    length = np.linalg.norm(across, axis=1)
    room = np.linalg.norm(q - p, axis=1) * np.linalg.norm(s - r, axis=1)
    with np.errstate(divide="ignore", invalid="ignore"):
        off = np.where(length > 0, CROSS_ROUNDOFFS * UNIT_ROUNDOFF * room / length, np.inf)
        unit = np.where(length[:, None] > 0, across / length[:, None], 0.0)
    for k in np.flatnonzero(~(off <= TRUSTED_DIRECTION)):
        normal = exact_normal(integers(world[axes[k]])[0])
        largest = abs(normal).max()
        scaled = (normal / (largest or 1)).astype(float)
        unit[k] = scaled / np.linalg.norm(scaled) if largest else 0.0
        off[k] = EXACT_DIRECTION if largest else np.inf
    return unit, off


def shadows(world: Floats, axes: Indices, a: Indices, b: Indices) -> Shadows:
    """Return those of the points `a` and the points `b`; an axis has to have a direction."""
    unit, off = directions(world, axes)
    used = world[np.concatenate((a, b))]
    centre = 0.5 * (used.min(axis=0) + used.max(axis=0))
    local = world - centre
    reach = float(np.linalg.norm(used - centre, axis=1).max())
    heights_off = (HEIGHT_ROUNDOFFS * UNIT_ROUNDOFF + off) * reach
    ends = np.empty((len(unit), 4))
    step = max(1, BLOCK // len(used))
    for first in range(0, len(unit), step):
        rows = slice(first, first + step)
        on_a, on_b = _heights(unit[rows], local[a]), _heights(unit[rows], local[b])
        ends[rows] = np.column_stack((on_a.min(1), on_a.max(1), on_b.min(1), on_b.max(1)))
    turned = _points_back(unit, ends, heights_off)
    unit[turned] *= -1.0
    ends[turned] = -ends[turned][:, [1, 0, 3, 2]]
    gap, bound = ends[:, 2] - ends[:, 1], 2 * heights_off
    sign = np.sign(gap).astype(np.int8)
    unsure = np.flatnonzero(np.abs(gap) <= bound)
    exact, scale = integers(world) if len(unsure) else (world, 1)
    for k in unsure:
        ends_of = (side[_may_end(local[side] @ unit[k], bound[k])] for side in (a, b))
        sign[k], gap[k] = exact_gap(exact, scale, axes[k], *ends_of)
        bound[k] = VALUE_ROUNDOFFS * UNIT_ROUNDOFF * abs(gap[k])
    places = _heights(unit, centre[None, :])
    return Shadows(unit, ends[:, :2] + places, ends[:, 2:] + places, gap, bound, sign)


def _may_end(heights: Floats, off: float) -> Flags:
    """Return whether each point may be the lowest or the highest. off: of a difference of two."""
    return np.asarray((heights <= heights.min() + off) | (heights >= heights.max() - off))


def exact_gap(
    exact: Integers, scale: int, axis: Indices, a: Indices, b: Indices
) -> tuple[int, float]:
    """Return sign and value of the larger of the two gaps along an axis, B beyond A and A beyond
    B."""
    normal = exact_normal(exact[axis])
    on_a, on_b = ((exact[side] * normal).sum(axis=1) for side in (a, b))
    gap = max(on_b.min() - on_a.max(), on_a.min() - on_b.max())
    largest = abs(normal).max()
    length = float(np.linalg.norm((normal / largest).astype(float)))
    return (gap > 0) - (gap < 0), float(Fraction(gap, largest * scale)) / length


def _points_back(unit: Floats, ends: Floats, off: Floats) -> Flags:
    """Return whether an axis leads from B to A. Where both ways are as good, its largest component
    is positive."""
    forward, backward = ends[:, 2] - ends[:, 1], ends[:, 0] - ends[:, 3]
    largest = np.take_along_axis(unit, np.abs(unit).argmax(axis=1)[:, None], axis=1)[:, 0]
    alike = np.abs(forward - backward) <= 4 * off
    return np.where(alike, largest < 0, backward > forward)


def _heights(unit: Floats, points: Floats) -> Floats:
    """Return (m, n), along each axis. Not by a matrix product: BLAS rounds differently on each
    machine."""
    x, y, z = (np.multiply.outer(unit[:, k], points[:, k]) for k in range(3))
    return np.asarray((x + y) + z)
