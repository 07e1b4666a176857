"""Whether convex parts contain a surface, in rational numbers: each part is cut out of each
triangle, by the planes through three of its vertices that have all vertices on one side."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from fractions import Fraction
from itertools import combinations
from typing import Any

Point = tuple[Fraction, Fraction, Fraction]
Plane = tuple[Point, Fraction]  # the part is where normal . x <= offset


def uncovered_triangles(
    triangles: Iterable[Sequence[Sequence[float]]], parts: Iterable[Any]
) -> list[int]:
    """Return the numbers of the triangles (3 points each) of which a part of some area, or a
    corner, lies in none of the parts, which are arrays of vertices."""
    planes = [planes_of(part) for part in parts]
    return [
        number
        for number, triangle in enumerate(triangles)
        if _rest([exact(point) for point in triangle], planes)
    ]


def is_in_a_part(point: Point, planes: Iterable[Sequence[Plane]]) -> bool:
    return any(all(_height(point, plane) <= 0 for plane in own) for own in planes)


def exact(point: Sequence[float]) -> Point:
    x, y, z = (Fraction(float(coordinate)) for coordinate in point)
    return x, y, z


def planes_of(vertices: Any) -> list[Plane]:
    points = [exact(vertex) for vertex in vertices]
    found: dict[Plane, None] = {}
    for a, b, c in combinations(points, 3):
        normal = _cross(_minus(b, a), _minus(c, a))
        largest = max(map(abs, normal))
        if not largest or any(_on(plane, (a, b, c)) for plane in found):
            continue
        unit = normal[0] / largest, normal[1] / largest, normal[2] / largest
        heights = [_dot(unit, _minus(point, a)) for point in points]
        if max(heights) <= 0:
            found[unit, _dot(unit, a)] = None
        elif min(heights) >= 0:
            turned = -unit[0], -unit[1], -unit[2]
            found[turned, _dot(turned, a)] = None
    return list(found)


def _on(plane: Plane, points: Iterable[Point]) -> bool:
    return all(_height(point, plane) == 0 for point in points)


def _rest(triangle: list[Point], planes: Iterable[Sequence[Plane]]) -> bool:
    """Whether a corner, or some area, is in no part."""
    if not all(is_in_a_part(corner, planes) for corner in triangle):
        return True
    rest = [triangle]
    for own in planes:
        rest = [piece for polygon in rest for piece in _beyond(polygon, own)]
    return bool(rest)


def _beyond(polygon: list[Point], planes: Sequence[Plane]) -> list[list[Point]]:
    """Convex pieces of the polygon outside of a part. Those without area are left out."""
    pieces, inside = [], polygon
    for plane in planes:
        heights = [_height(point, plane) for point in inside]
        if min(heights) >= 0 and max(heights) > 0:
            return [polygon]
        if max(heights) <= 0:
            continue
        pieces.append(_cut(inside, [-height for height in heights]))
        inside = _cut(inside, heights)
    return pieces


def _cut(polygon: list[Point], heights: list[Fraction]) -> list[Point]:
    """The part of the polygon below 0."""
    kept = []
    for i, (point, height) in enumerate(zip(polygon, heights, strict=True)):
        before, above = polygon[i - 1], heights[i - 1]
        if above * height < 0:
            t = above / (above - height)
            x, y, z = (p + t * (q - p) for p, q in zip(before, point, strict=True))
            kept.append((x, y, z))
        if height <= 0:
            kept.append(point)
    return kept


def _height(point: Point, plane: Plane) -> Fraction:
    return _dot(plane[0], point) - plane[1]


def _minus(a: Point, b: Point) -> Point:
    return a[0] - b[0], a[1] - b[1], a[2] - b[2]


def _dot(a: Point, b: Point) -> Fraction:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def _cross(a: Point, b: Point) -> Point:
    return (
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    )
