"""Cuts convex polygons in space by planes.

Ivan Sutherland, Gary Hodgman, "Reentrant Polygon Clipping" (1974), for both sides of a plane. A
polygon has few corners, so lists are several times faster than array operations.
"""

from __future__ import annotations

from collections.abc import Iterable

Point = tuple[float, float, float]
Polygon = list[Point]
Plane = tuple[Point, float]  # (unit normal, offset); below: normal . x <= offset


def heights(polygon: Polygon, plane: Plane) -> list[float]:
    """The height of each corner above the plane."""
    (nx, ny, nz), offset = plane
    return [nx * x + ny * y + nz * z - offset for x, y, z in polygon]


def halves(polygon: Polygon, above: list[float]) -> tuple[Polygon, Polygon]:
    """(below, above) of a polygon by the heights of its corners; the two share their cut points."""
    lower: Polygon = []
    upper: Polygon = []
    for index, (point, height) in enumerate(zip(polygon, above, strict=True)):
        before = above[index - 1]
        if (before < 0.0 < height) or (height < 0.0 < before):
            share = before / (before - height)
            (ax, ay, az), (bx, by, bz) = polygon[index - 1], point
            cut = ax + share * (bx - ax), ay + share * (by - ay), az + share * (bz - az)
            lower.append(cut)
            upper.append(cut)
        if height <= 0.0:
            lower.append(point)
        if height >= 0.0:
            upper.append(point)
    return lower, upper


def without(
    polygon: Polygon, planes: Iterable[Plane], slack: float
) -> tuple[Polygon, list[Polygon]]:
    """(the part at most `slack` above every plane, the rest in convex pieces).

    If the whole polygon is above some plane, the first is empty and the rest is the polygon.
    """
    rest = []
    inside = polygon
    for plane in planes:
        above = [height - slack for height in heights(inside, plane)]
        if min(above) >= 0.0:
            return [], [polygon]
        if max(above) > 0.0:
            inside, beyond = halves(inside, above)
            rest.append(beyond)
    return inside, rest
