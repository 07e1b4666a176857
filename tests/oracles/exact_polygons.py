"""Two convex polygons in rational numbers: outcome and squared signed distance, feature by feature.

Overlap: the least squared height over every edge of both. Gap: the least squared distance of every
corner from every edge. O(n m), without filters.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

Point = tuple[Fraction, Fraction]
Edge = tuple[Point, Point]


def signed_square(a: NDArray[np.float64], b: NDArray[np.float64]) -> Fraction:
    """The squared gap; 0: touching; < 0: minus the squared depth. a, b: (n, 2) corners."""
    first, second = _exact(a), _exact(b)
    overlaps = [
        min(_height(edge, p) for p in other)
        for one, other in ((first, second), (second, first))
        for edge in _edges(one)
    ]
    if max(overlaps) < 0:
        return max(overlaps)
    return min(
        _squared_distance(edge, p)
        for one, other in ((first, second), (second, first))
        for edge in _edges(one)
        for p in other
    )


def convex(corners: Sequence[tuple[float, float]]) -> bool:
    """Return whether each turn of the polygon is to the left, exactly."""
    points = _exact(np.array(corners))
    ahead, behind = [*points[1:], points[0]], [points[-1], *points[:-1]]
    return all(_height((p, q), r) < 0 for p, q, r in zip(behind, points, ahead, strict=True))


def _exact(corners: NDArray[np.float64]) -> list[Point]:
    return [(Fraction(x), Fraction(y)) for x, y in corners.tolist()]


def _edges(corners: list[Point]) -> list[Edge]:
    return [edge for edge in pairwise([*corners, corners[0]]) if edge[0] != edge[1]]


def _height(edge: Edge, p: Point) -> Fraction:
    """The squared height above an edge, with its sign: positive outside."""
    (ax, ay), (bx, by) = edge
    along = (bx - ax, by - ay)
    cross = along[1] * (p[0] - ax) - along[0] * (p[1] - ay)
    return cross * abs(cross) / (along[0] ** 2 + along[1] ** 2)


def _squared_distance(edge: Edge, p: Point) -> Fraction:
    (ax, ay), (bx, by) = edge
    along, to = (bx - ax, by - ay), (p[0] - ax, p[1] - ay)
    length = along[0] ** 2 + along[1] ** 2
    share = min(max((along[0] * to[0] + along[1] * to[1]) / length, Fraction(0)), Fraction(1))
    x, y = to[0] - share * along[0], to[1] - share * along[1]
    return x * x + y * y
