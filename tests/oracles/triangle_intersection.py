"""The common points of two closed triangles, by clipping in rational numbers."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from fractions import Fraction
from itertools import pairwise

Point = tuple[Fraction, Fraction, Fraction]
Triangle = Sequence[Sequence[float]]
_ORIGIN: Point = (Fraction(0), Fraction(0), Fraction(0))


def common_points(a: Triangle, b: Triangle) -> list[Point]:
    """The corners of the intersection: none, one point, two ends, or those of a convex polygon.

    One of the two may be collinear, not both. Polygons come in order; corners are strict.
    """
    sheet, other = [_exact(p) for p in a], [_exact(p) for p in b]
    normal = _cross(_sub(other[1], other[0]), _sub(other[2], other[0]))
    if not any(normal):
        sheet, other = other, sheet
        normal = _cross(_sub(other[1], other[0]), _sub(other[2], other[0]))
    assert any(normal), "two collinear triangles"
    kept = _clip(sheet, _height_over(other[0], normal))
    kept = _clip(kept, _height_over(other[0], _sub(_ORIGIN, normal)))
    for k in range(3):
        inward = _cross(normal, _sub(other[(k + 1) % 3], other[k]))
        kept = _clip(kept, _height_over(other[k], inward))
    return _corners(kept)


def area(corners: Sequence[Point]) -> float:
    """Of a polygon in order."""
    total = _ORIGIN
    for p, q in pairwise(corners[1:]):
        turn = _cross(_sub(p, corners[0]), _sub(q, corners[0]))
        total = (total[0] + turn[0], total[1] + turn[1], total[2] + turn[2])
    return math.sqrt(_dot(total, total)) / 2


def _height_over(origin: Point, normal: Point) -> Callable[[Point], Fraction]:
    return lambda p: _dot(normal, _sub(p, origin))


def _clip(polygon: list[Point], height: Callable[[Point], Fraction]) -> list[Point]:
    """The part with height >= 0."""
    kept = []
    for p, q in zip(polygon, polygon[1:] + polygon[:1], strict=True):
        hp, hq = height(p), height(q)
        if hp >= 0:
            kept.append(p)
        if hp * hq < 0:
            t = hp / (hp - hq)
            step = _sub(q, p)
            kept.append((p[0] + t * step[0], p[1] + t * step[1], p[2] + t * step[2]))
    return kept


def _corners(polygon: list[Point]) -> list[Point]:
    distinct = list(dict.fromkeys(polygon))
    strict = [
        q
        for k, q in enumerate(distinct)
        if any(_cross(_sub(q, distinct[k - 1]), _sub(distinct[(k + 1) % len(distinct)], q)))
    ]
    if strict or not distinct:
        return strict
    return sorted({min(distinct), max(distinct)})


def _exact(p: Sequence[float]) -> Point:
    return (Fraction(p[0]), Fraction(p[1]), Fraction(p[2]))


def _sub(a: Point, b: Point) -> Point:
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def _dot(a: Point, b: Point) -> Fraction:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def _cross(a: Point, b: Point) -> Point:
    return (
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    )
