"""Convex polygons in the plane, in rational numbers."""

from __future__ import annotations

from fractions import Fraction

from satcheck.scene.planar.turns import Floats

Point = tuple[Fraction, Fraction]
Polygon = list[Point]  # convex, counter-clockwise


def exact(corners: Floats) -> Polygon:
    """The corners as rational numbers. corners: (n, 2)."""
    return [(Fraction(x), Fraction(y)) for x, y in corners.tolist()]


def left_of(polygon: Polygon, start: Point, end: Point) -> Polygon:
    """The part to the left of a line; empty if it has no area."""
    sides = [turn(start, end, point) for point in polygon]
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


def turn(start: Point, end: Point, point: Point) -> Fraction:
    """Positive to the left of the line."""
    return (end[0] - start[0]) * (point[1] - start[1]) - (end[1] - start[1]) * (point[0] - start[0])
