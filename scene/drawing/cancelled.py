"""Whether the signed triangles of a sheet cover places that its contours leave empty.

The corners of the triangles are corners of the contours. Where contours cross, as in a figure of
eight, triangles therefore reach beyond the filled region, and there the signs of several add up to
0. Nothing is filled in such a place, but the ends of the prism over the sheet would hit what stands
in it. The test is exact, in rational numbers.
"""

from __future__ import annotations

from collections.abc import Iterable
from fractions import Fraction

import numpy as np

from satcheck.scene.planar.polygon import Point, Polygon, exact, left_of, turn
from satcheck.scene.planar.turns import Floats, Indices, turns

# Limit on the pieces of one triangle.
_MOST_PIECES = 1000


def covers_empty_places(points: Floats, triangles: Indices, contours: list[Floats]) -> bool:
    """contours: closed polygons, the boundary of the triangles. True also if the test would take
    too long."""
    signs = turns(points, triangles)
    if (signs >= 0).all() or (signs <= 0).all():
        return False
    rarer = 1 if (signs > 0).sum() < (signs < 0).sum() else -1
    starts = np.concatenate(contours)
    ends = np.concatenate([np.roll(contour, -1, axis=0) for contour in contours])
    edges = [tuple(exact(pair)) for pair in np.stack((starts, ends), axis=1)]
    low, high = np.minimum(starts, ends), np.maximum(starts, ends)
    for triangle in triangles[signs == rarer]:
        corners = points[triangle[::rarer]]
        meets = (low < corners.max(axis=0)).all(axis=1) & (high > corners.min(axis=0)).all(axis=1)
        pieces = _pieces(exact(corners), [edges[k] for k in np.flatnonzero(meets)])
        if pieces is None or any(_winding(edges, _centre(piece)) == 0 for piece in pieces):
            return True
    return False


def _pieces(polygon: Polygon, edges: Iterable[tuple[Point, ...]]) -> list[Polygon] | None:
    """The polygon, cut along the lines of the edges; None: there are too many pieces."""
    pieces = [polygon]
    for start, end in edges:
        halves = [
            left_of(piece, *line) for piece in pieces for line in ((start, end), (end, start))
        ]
        pieces = [half for half in halves if half]
        if len(pieces) > _MOST_PIECES:
            return None
    return pieces


def _centre(polygon: Polygon) -> Point:
    x, y = (sum((p[axis] for p in polygon), Fraction(0)) for axis in range(2))
    return x / len(polygon), y / len(polygon)


def _winding(edges: Iterable[tuple[Point, ...]], point: Point) -> int:
    """Of a point on no edge: the edges that a ray to the right crosses, upwards minus downwards."""
    y: Fraction = point[1]
    count = 0
    for start, end in edges:
        if (start[1] <= y) != (end[1] <= y):
            up = 1 if start[1] <= y else -1
            count += up if up * turn(start, end, point) > 0 else 0
    return count
