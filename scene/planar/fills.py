"""Decides whether an outline is the same for every fill of the holes of its mesh.

A fill lies within the convex hull of its boundary loop, so its outline lies within the outline of
that hull. If triangles of the mesh cover that outline, no fill changes the outline. The test is
exact: it subtracts one triangle after another from the polygon, in rational numbers, until nothing
remains.
"""

from __future__ import annotations

from fractions import Fraction

from satcheck.scene.planar.region import Floats, Region

Point = tuple[Fraction, Fraction]
Polygon = list[Point]  # convex, counter-clockwise

# Limit on the triangles over one hole. With more triangles, the answer is unknown.
_MOST_TRIANGLES = 1000


def covers(region: Region, outline: Floats) -> bool:
    """Return whether the region covers a convex polygon. outline: its corners, counter-clockwise,
    (n, 2). False if the test would take too long."""
    corners = region.points[region.triangles]
    low, high = outline.min(axis=0), outline.max(axis=0)
    meets = (corners.min(axis=1) < high).all(axis=1) & (corners.max(axis=1) > low).all(axis=1)
    if meets.sum() > _MOST_TRIANGLES:
        return False
    left = [_exact(outline)]
    for triangle in corners[meets]:
        left = [piece for polygon in left for piece in _outside(polygon, _exact(triangle))]
    return not left


def _outside(polygon: Polygon, triangle: Polygon) -> list[Polygon]:
    """The pieces of a convex polygon outside of a counter-clockwise triangle."""
    pieces = []
    for k in range(3):
        start, end = triangle[k], triangle[(k + 1) % 3]
        pieces.append(_left_of(polygon, end, start))
        polygon = _left_of(polygon, start, end)
    return [piece for piece in pieces if piece]


def _exact(corners: Floats) -> Polygon:
    """The corners as rational numbers. corners: (n, 2)."""
    return [(Fraction(x), Fraction(y)) for x, y in corners.tolist()]


def _left_of(polygon: Polygon, start: Point, end: Point) -> Polygon:
    """The part to the left of a line; empty if it has no area."""
    sides = [_turn(start, end, point) for point in polygon]
    if not any(side > 0 for side in sides):
        return []
    kept = []
    for k, (point, side) in enumerate(zip(polygon, sides, strict=True)):
        before, side_before = polygon[k - 1], sides[k - 1]
        if side * side_before < 0:
            share = side_before / (side_before - side)
            kept.append(
                (
                    before[0] + share * (point[0] - before[0]),
                    before[1] + share * (point[1] - before[1]),
                )
            )
        if side >= 0:
            kept.append(point)
    return kept


def _turn(start: Point, end: Point, point: Point) -> Fraction:
    """Positive to the left of the line."""
    return (end[0] - start[0]) * (point[1] - start[1]) - (end[1] - start[1]) * (point[0] - start[0])
