"""Axis-aligned world boxes: their sizes, and the shortest way out."""

from __future__ import annotations

import math

from satcheck.core.conventions import Vector
from satcheck.core.rounding import UNIT_ROUNDOFF

Box = tuple[Vector, Vector]


def largest_coordinate(*boxes: Box) -> float:
    """The largest |coordinate|."""
    return max(max(-x, -y, -z, u, v, w) for (x, y, z), (u, v, w) in boxes)


def corners(box: Box) -> list[Vector]:
    (x, y, z), (u, v, w) = box
    return [(i, j, k) for i in (x, u) for j in (y, v) for k in (z, w)]


def around_both(a: Box, b: Box) -> Box:
    (x, y, z), (u, v, w) = a
    (p, q, r), (f, g, h) = b
    return (min(x, p), min(y, q), min(z, r)), (max(u, f), max(v, g), max(w, h))


def diagonal(box: Box, axes: tuple[int, ...] = (0, 1, 2)) -> float:
    return math.hypot(*(box[1][axis] - box[0][axis] for axis in axes))


def box_escape(a: Box, b: Box) -> tuple[float, Vector]:
    """The shortest translation of A after which the boxes have no common interior.

    Returns its length and the unit normal from A to B; the translation is -length * normal. The
    length is rounded outward, and 0.0 if the boxes do not overlap. Ties go to the first axis,
    negative side first.
    """
    best, normal = math.inf, (1.0, 0.0, 0.0)
    for axis in range(3):
        for sign, reach in (
            (1.0, a[1][axis] - b[0][axis]),
            (-1.0, b[1][axis] - a[0][axis]),
        ):
            if reach < best:
                best = reach
                normal = tuple(sign if k == axis else 0.0 for k in range(3))  # type: ignore[assignment]
    return max(best, 0.0) * (1 + 2 * UNIT_ROUNDOFF), normal
