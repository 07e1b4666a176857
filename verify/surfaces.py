"""Which triangles of two surfaces meet: all pairs with near boxes, each decided exactly; and how
far points are from triangles."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

from satcheck.verify.exact import (
    Floats,
    Point,
    TooMany,
    cartesian,
    clipped,
    dot,
    half_spaces,
    homogeneous,
    integers,
    nearest_to_origin,
    normal_of,
    sub,
)
from satcheck.verify.world import Corners, Exact, Indices

BLOCK = 4096  # pairs compared at once
MOST_PAIRS = 50_000_000  # with more pairs a check would take too long
Mask = NDArray[np.bool_]
# How far rounding takes the distance of a point and a triangle, or a plane, of the longest line
# from the point to a corner: fewer than 60 roundings in the point next to it and in its length.
DISTANCE_ERROR = 2.0**-46
TINY = 2.0**-1000  # more than what underflow takes
# How far rounding takes a weighted sum, of the sum of its terms without their signs.
SUM_ERROR = 2.0**-46


def near_pairs(
    a: Exact, b: Exact, reach: float, most: int = MOST_PAIRS
) -> Iterator[tuple[Indices, Indices]]:
    """In blocks, all pairs of triangles with boxes within reach of each other, and a few other
    pairs. Rejects surfaces with more than `most` of them.

    Rounding a difference is monotonic, so no pair is missed: x <= reach implies fl(x) <= reach.
    """
    boxes = [(e.world.low, e.world.high) for e in (a, b)]
    (low_a, high_a), (low_b, high_b) = boxes
    pending = [(np.arange(len(low_a)), np.arange(len(low_b)))]
    total = 0
    while pending:
        i, j = pending.pop()
        i = i[_near(low_a[i], high_a[i], low_b[j].min(axis=0), high_b[j].max(axis=0), reach)]
        if i.size == 0:
            continue
        j = j[_near(low_b[j], high_b[j], low_a[i].min(axis=0), high_a[i].max(axis=0), reach)]
        if j.size == 0:
            continue
        if i.size * j.size <= BLOCK:
            near = _near(low_a[i][:, None], high_a[i][:, None], low_b[j], high_b[j], reach)
            k, m = np.nonzero(near)
            total += len(k)
            if total > most:
                raise TooMany(f"more than {most:,} pairs of triangles lie close together")
            if k.size:
                yield i[k], j[m]
        elif i.size >= j.size:
            pending += [(half, j) for half in _halves(i, low_a[i] + high_a[i])]
        else:
            pending += [(i, half) for half in _halves(j, low_b[j] + high_b[j])]


def _near(low: Floats, high: Floats, other_low: Floats, other_high: Floats, reach: float) -> Mask:
    gaps = np.maximum(low - other_high, other_low - high)
    if reach == 0:
        return np.asarray((gaps <= 0).all(axis=-1))
    apart = np.maximum(gaps / reach, 0.0)
    # Three quotients, three products and two sums, each rounded once.
    return np.asarray(np.einsum("...k,...k->...", apart, apart) <= 1 + 2.0**-48)


def _halves(index: Indices, centres: Floats) -> list[Indices]:
    axis = int(np.argmax(centres.max(axis=0) - centres.min(axis=0)))
    order = np.argsort(centres[:, axis], kind="stable")
    middle = len(index) // 2
    return [index[order[:middle]], index[order[middle:]]]


def close_pairs(
    a: Exact, b: Exact, reach: Fraction, most: int = MOST_PAIRS
) -> Iterator[tuple[int, int, Fraction]]:
    """The pairs of triangles within reach of each other, with the square of their distance; 0 if
    they meet. World units."""
    for i, j in near_pairs(a, b, up(reach), most):
        p, q = a.world.vertices[a.world.triangles[i]], b.world.vertices[b.world.triangles[j]]
        left = ~_apart(p, q, up(reach))
        for s, t in zip(i[left].tolist(), j[left].tolist(), strict=True):
            ca, cb = a.corners(s), b.corners(t)
            if common(ca, cb):
                yield s, t, Fraction(0)
            elif reach > 0:
                x, _ = nearest_to_origin([sub(q, p) for p in ca for q in cb])
                squared = dot(x, x) / a.scale**2
                if squared <= reach * reach:
                    yield s, t, squared


def meeting(a: Exact, b: Exact) -> list[tuple[int, int]]:
    """The pairs of triangles that meet."""
    return [(s, t) for s, t, _ in close_pairs(a, b, Fraction(0))]


def up(value: Fraction) -> float:
    return float(np.nextafter(float(value), np.inf)) if value else 0.0


def _apart(p: Floats, q: Floats, reach: float) -> Mask:
    """Whether one of these directions proves that triangles (n, 3, 3) are more than reach apart:
    normals, products of edges, edges projected onto either face, lines between corners."""
    done = np.zeros(len(p), dtype=bool)
    with np.errstate(all="ignore"):
        for axes in _directions(p, q):
            left = ~done
            if not left.any():
                break
            done[left] = _separates(axes[left], p[left], q[left], reach)
    return done


def _directions(p: Floats, q: Floats) -> Iterator[Floats]:
    e, f = np.roll(p, -1, axis=1) - p, np.roll(q, -1, axis=1) - q
    n, m = np.cross(e[:, 0], e[:, 1]), np.cross(f[:, 0], f[:, 1])
    yield n
    yield m
    yield from (np.cross(e[:, i], f[:, j]) for i in range(3) for j in range(3))
    for i in range(3):
        yield np.cross(n, e[:, i])
        yield np.cross(m, f[:, i])
    yield from (q[:, j] - p[:, i] for i in range(3) for j in range(3))


def _separates(axes: Floats, p: Floats, q: Floats, reach: float) -> Mask:
    """The gap along each axis is bounded with its rounding, so the axes need not be exact."""
    largest = np.abs(axes).max(axis=1, keepdims=True)
    axes = np.where((largest > 0) & np.isfinite(largest), axes / largest, 0.0)
    on_p, on_q = np.einsum("kij,kj->ki", p, axes), np.einsum("kij,kj->ki", q, axes)
    size = np.maximum(np.abs(p).max(axis=1), np.abs(q).max(axis=1))
    # Three products and two sums on either side, one difference, and as much to spare.
    error = 16 * 2.0**-53 * np.einsum("ki,ki->k", size, np.abs(axes)) + 2.0**-1000
    gap = np.maximum(on_q.min(axis=1) - on_p.max(axis=1), on_p.min(axis=1) - on_q.max(axis=1))
    longest = np.sqrt(np.einsum("ki,ki->k", axes, axes)) * (1 + 2.0**-50)
    return gap - error > reach * longest  # type: ignore[no-any-return]


def common(a: Corners, b: Corners) -> list[Point]:
    """The corners of the convex set that two closed triangles share: none, one, two or more.

    One is clipped by half-spaces whose common region is the other. A triangle may be a segment or a
    point.
    """
    if not any(normal_of(a)):
        a, b = b, a
    region = [homogeneous(p) for p in b]
    for space in half_spaces(a):
        region = clipped(region, space)
        if not region:
            break
    return [cartesian(p) for p in region]


def comes_within(body: Exact, p: Point, length: Fraction, *, open_: bool) -> bool:
    """Whether the surface of a body comes within a length, world units, of a point of the lattice.
    open_: or nearer than that."""
    world, scale = body.world, body.scale
    at = np.array([float(Fraction(c) / scale) for c in p])
    radius = up(length) + float(lengths(np.spacing(np.abs(at))))
    gaps = np.maximum(np.maximum(world.low - at, at - world.high), 0.0)
    near = np.flatnonzero(~(lengths(gaps) > radius * (1 + SUM_ERROR)))
    least, _ = distances(at, world.vertices[world.triangles[near]])
    most = (length * scale) ** 2
    for t in near[least < radius].tolist():
        i, j, k = integers(world.vertices[world.triangles[t]], body.k)
        squared = squared_distance(p, (i, j, k))
        if squared < most or (squared == most and not open_):
            return True
    return False


def squared_distance(p: Point, triangle: Corners) -> Fraction:
    """Exactly."""
    x, y, z, w = homogeneous(p)
    spokes = [(v[0] * w - x, v[1] * w - y, v[2] * w - z) for v in triangle]
    foot, _ = nearest_to_origin(spokes)
    return Fraction(dot(foot, foot)) / (w * w)


def next_points(spokes: Floats) -> Floats:
    """Points of triangles (n, 3, 3) that are about next to the origin, (n, 3): on the nearest edge,
    or the foot of the perpendicular."""
    heads = np.roll(spokes, -1, axis=1)
    along = heads - spokes
    with np.errstate(all="ignore"):
        share = -_dots(spokes, along) / _dots(along, along)
        share = np.clip(np.nan_to_num(share), 0.0, 1.0)
        feet = spokes + share[..., None] * along
        nearest = _dots(feet, feet).argmin(axis=1)
        best = np.take_along_axis(feet, nearest[:, None, None], axis=1)[:, 0]
        normal = np.cross(along[:, 0], along[:, 1])
        # The part of each triangle that the origin and an edge span, seen along the normal.
        parts = _dots(np.cross(spokes, heads), normal[:, None])
        inside = np.asarray((parts > 0).all(axis=1))
        weights = np.roll(parts, -1, axis=1) / parts.sum(axis=1, keepdims=True)
        foot = np.einsum("nk,nkj->nj", weights, spokes)
    chosen: Floats = np.where(inside[:, None], foot, best)
    return chosen


def distances(point: Floats, triangles: Floats) -> tuple[Floats, Floats]:
    """Bounds of the distances of a point (3,) from triangles (n, 3, 3), (n,)."""
    spokes = triangles - point
    nearest, error = next_points(spokes), slack(spokes)
    most = lengths(nearest)
    with np.errstate(all="ignore"):
        heights = np.einsum("nkj,nj->nk", spokes, nearest / most[:, None]).min(axis=1)
    least = np.nan_to_num(heights - error, nan=0.0)
    return np.maximum(least, 0.0), most + error


def slack(spokes: Floats) -> Floats:
    """How far rounding takes a length that is computed from lines to corners, (n, m, 3), (n,)."""
    longest: Floats = lengths(spokes).max(axis=1)
    return DISTANCE_ERROR * longest + TINY


def lengths(p: Floats) -> Floats:
    """The lengths of vectors (..., 3), a few roundoffs off. Their squares may be no floats."""
    lengths: Floats = np.hypot(np.hypot(p[..., 0], p[..., 1]), p[..., 2])
    return lengths


def _dots(p: Floats, q: Floats) -> Floats:
    products: Floats = np.einsum("...k,...k->...", p, q)
    return products
