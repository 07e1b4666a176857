"""The pieces of a mesh's surface inside a convex body, and their points nearest to the origin."""

from __future__ import annotations

from itertools import compress, pairwise
from typing import TYPE_CHECKING

import numpy as np

from satcheck.decompose.errors import NEVER, Deadline
from satcheck.decompose.half_spaces import NOISE, HalfSpaces
from satcheck.decompose.polygons import Point, common_part

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]


def surface_inside(triangles: Floats, body: HalfSpaces, deadline: Deadline = NEVER) -> Floats:
    """Triangles (m, 3, 3) clipped to the inside of the body, as triangles (k, 3, 3).

    Pieces on the body's boundary, up to rounding, are left out. Raises DecompositionError at the
    deadline.
    """
    noise = NOISE * body.size
    planes = list(zip(body.normals.tolist(), body.offsets.tolist(), strict=True))
    pieces: list[tuple[Point, Point, Point]] = []
    for first in range(0, len(triangles), body.points_at_once):
        deadline.check()
        chunk = triangles[first : first + body.points_at_once]
        above = np.stack([-body.slack(chunk[:, corner]) for corner in range(3)], axis=1)
        entering = (above.min(axis=1) < -noise).all(axis=1)
        crossing = above[entering].max(axis=1) > 0.0
        for triangle, crossed in zip(chunk[entering].tolist(), crossing, strict=True):
            polygon = common_part(triangle, compress(planes, crossed), noise)
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


def _nearest_on_segment(tail: Floats, head: Floats) -> Floats:
    """The point of each segment (n, 3)-(n, 3) that is nearest to the origin."""
    along = head - tail
    square = (along * along).sum(axis=1)
    share = -(tail * along).sum(axis=1) / np.where(square > 0.0, square, 1.0)
    points: Floats = tail + np.clip(share, 0.0, 1.0)[:, None] * along
    return points
