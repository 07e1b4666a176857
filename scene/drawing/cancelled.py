"""Whether the signed triangles of a sheet cover places that its contours leave empty.

The corners of the triangles are corners of the contours. Where contours cross, as in a figure of
eight, triangles therefore reach beyond the filled region, and there the signs of several add up to
0. Nothing is filled in such a place, but the ends of the prism over the sheet would hit what stands
in it. The test is exact, in rational numbers.
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from satcheck.scene.planar.polygon import Point, Polygon, exact, left_of, turn
from satcheck.scene.planar.turns import Floats, Indices, turns

# Limit on the cuts of pieces by lines, for one shape: about a second.
_MOST_CUTS = 20_000


def covers_empty_places(points: Floats, triangles: Indices, contours: list[Floats]) -> bool:
    """contours: closed polygons, the boundary of the triangles. True also if the test would take
    too long, or if a piece is too thin to hold a point in float64."""
    signs = turns(points, triangles)
    if (signs >= 0).all() or (signs <= 0).all():
        return False
    rarer = 1 if (signs > 0).sum() < (signs < 0).sum() else -1
    mixed = points[triangles[signs == rarer][:, ::rarer]]
    starts = np.concatenate(contours)
    ends = np.concatenate([np.roll(contour, -1, axis=0) for contour in contours])
    low, high = np.minimum(starts, ends), np.maximum(starts, ends)
    if any(_is_empty(exact(corners), starts, ends) for corners in mixed):
        return True
    cuts = 0
    for corners in mixed:
        meets = (low < corners.max(axis=0)).all(axis=1) & (high > corners.min(axis=0)).all(axis=1)
        pieces = [exact(corners)]
        for start, end in zip(exact(starts[meets]), exact(ends[meets]), strict=True):
            cuts += len(pieces)
            if cuts > _MOST_CUTS:
                return True
            pieces = _halves(pieces, start, end)
        if any(_is_empty(piece, starts, ends) for piece in pieces):
            return True
    return False


def _halves(pieces: Iterable[Polygon], start: Point, end: Point) -> list[Polygon]:
    """The parts of the pieces to the left and to the right of a line."""
    halves = (left_of(piece, *line) for piece in pieces for line in ((start, end), (end, start)))
    return [half for half in halves if half]


def _is_empty(piece: Polygon, starts: Floats, ends: Floats) -> bool:
    """Whether the edges wind around the middle of the piece as often in one direction as in the
    other. Where no edge crosses the piece, that holds for all of it."""
    middle = tuple(sum(corner[axis] for corner in piece) / len(piece) for axis in range(2))
    point = np.array([float(c) for c in middle])
    corner = exact(point[None])[0]
    sides = zip(piece, piece[1:] + piece[:1], strict=True)
    return not all(turn(*side, corner) > 0 for side in sides) or _winding(point, starts, ends) == 0


def _winding(point: Floats, starts: Floats, ends: Floats) -> int:
    """Of a point on no edge: the edges that a ray to the right crosses, upwards minus downwards."""
    up = (starts[:, 1] <= point[1]) & (ends[:, 1] > point[1])
    down = (ends[:, 1] <= point[1]) & (starts[:, 1] > point[1])
    crossed = np.flatnonzero(up | down)
    corners = np.concatenate((starts[crossed], ends[crossed], point[None]))
    count = len(crossed)
    edges = np.arange(count)
    of_point = np.full(count, 2 * count)
    signs = turns(corners, np.column_stack((edges, edges + count, of_point)))
    return int((up[crossed] & (signs > 0)).sum() - (down[crossed] & (signs < 0)).sum())
