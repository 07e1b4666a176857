"""Which triangles of two surfaces meet: all pairs with near boxes, each decided exactly."""

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
    nearest_to_origin,
    normal_of,
    sub,
)
from satcheck.verify.world import Corners, Exact, Indices

BLOCK = 4096  # pairs compared at once
MOST_PAIRS = 50_000_000  # with more pairs a check would take too long
Mask = NDArray[np.bool_]


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
    e, f = np.roll(p, -1, axis=1) - p, np.roll(q, -1, axis=1) - q
    with np.errstate(all="ignore"):
        n, m = np.cross(e[:, 0], e[:, 1]), np.cross(f[:, 0], f[:, 1])
        for axes in _directions(p, q, e, f, n, m):
            left = ~done
            if not left.any():
                break
            done[left] = _separates(axes[left], p[left], q[left], reach)
    return done


def _directions(
    p: Floats, q: Floats, e: Floats, f: Floats, n: Floats, m: Floats
) -> Iterator[Floats]:
    yield n
    yield m
    for i in range(3):
        for j in range(3):
            yield np.cross(e[:, i], f[:, j])
    for i in range(3):
        yield np.cross(n, e[:, i])
        yield np.cross(m, f[:, i])
    for i in range(3):
        for j in range(3):
            yield q[:, j] - p[:, i]


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
