"""The pieces of a mesh's surface inside a convex body, and their points nearest to a place."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import compress, pairwise
from typing import TYPE_CHECKING

import numpy as np

from satcheck.decompose.half_spaces import NOISE, HalfSpaces

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

Point = tuple[float, float, float]
Plane = tuple[Point, float]  # unit normal, offset


def surface_inside(triangles: Floats, body: HalfSpaces) -> Floats:
    """Triangles (m, 3, 3) clipped to the inside of the body, as triangles (k, 3, 3).

    What only lies on the body's boundary, within rounding, is left out.
    """
    noise = NOISE * body.size
    above = np.stack([-body.slack(triangles[:, corner]) for corner in range(3)], axis=1)
    entering = (above.min(axis=1) < -noise).all(axis=1)
    planes = list(zip(body.normals.tolist(), body.offsets.tolist(), strict=True))
    pieces: list[tuple[Point, Point, Point]] = []
    for triangle, crossed in zip(
        triangles[entering].tolist(), above[entering].max(axis=1) > 0.0, strict=True
    ):
        polygon = _clipped(triangle, compress(planes, crossed), noise)
        pieces += [(polygon[0], a, b) for a, b in pairwise(polygon[1:])]
    return np.array(pieces, dtype=np.float64).reshape(-1, 3, 3)


def nearest_points(triangles: Floats) -> Floats:
    """The point of each triangle (n, 3, 3) that is nearest to the origin, (n, 3)."""
    a, b, c = np.moveaxis(triangles, 1, 0)
    normal = np.cross(b - a, c - a)
    square = (normal * normal).sum(axis=1)
    flat = square <= 0.0
    foot = normal * ((normal * a).sum(axis=1) / np.where(flat, 1.0, square))[:, None]
    on_triangle = ~flat
    for tail, head in ((a, b), (b, c), (c, a)):
        on_triangle &= (np.cross(head - tail, foot - tail) * normal).sum(axis=1) >= 0.0
    edges = np.stack([_nearest_on_segment(p, q) for p, q in ((a, b), (b, c), (c, a))])
    best = np.argmin((edges * edges).sum(axis=2), axis=0)
    points: Floats = np.where(on_triangle[:, None], foot, edges[best, np.arange(len(best))])
    return points


def _clipped(polygon: list[Point], planes: Iterable[Plane], noise: float) -> list[Point]:
    """The convex polygon below all planes; empty when it does not reach `noise` below one.

    Ivan Sutherland, Gary Hodgman, "Reentrant Polygon Clipping" (1974). In plain Python: for
    polygons of a few corners it is several times faster than array operations.
    """
    for (nx, ny, nz), offset in planes:
        above = [nx * x + ny * y + nz * z - offset for x, y, z in polygon]
        if min(above) >= -noise:
            return []
        if max(above) <= 0.0:
            continue
        kept = []
        for index, point in enumerate(polygon):
            before = above[index - 1]
            if (before <= 0.0) != (above[index] <= 0.0):
                share = before / (before - above[index])
                kept.append(_between(polygon[index - 1], point, share))
            if above[index] <= 0.0:
                kept.append(point)
        polygon = kept
    return polygon


def _between(tail: Point, head: Point, share: float) -> Point:
    (ax, ay, az), (bx, by, bz) = tail, head
    return ax + share * (bx - ax), ay + share * (by - ay), az + share * (bz - az)


def _nearest_on_segment(tail: Floats, head: Floats) -> Floats:
    """Of each segment (n, 3)-(n, 3) the point nearest to the origin."""
    along = head - tail
    square = (along * along).sum(axis=1)
    share = -(tail * along).sum(axis=1) / np.where(square > 0.0, square, 1.0)
    points: Floats = tail + np.clip(share, 0.0, 1.0)[:, None] * along
    return points
