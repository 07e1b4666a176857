"""Decides whether an outline is the same for every fill of the holes of its mesh.

A fill lies within the convex hull of its boundary loop, so its outline lies within the outline of
that hull. If triangles of the mesh cover that outline, no fill changes the outline. The test is
exact: it subtracts one triangle after another from the polygon, in rational numbers, until nothing
remains.
"""

from __future__ import annotations

from satcheck.scene.planar.polygon import Polygon, exact, left_of
from satcheck.scene.planar.region import Region
from satcheck.scene.planar.turns import Floats

# Limit on the triangles over one hole. With more triangles, the answer is unknown.
_MOST_TRIANGLES = 1000


def covers(region: Region, outline: Floats) -> bool:
    """Whether the triangles of the region cover a convex polygon; their signs do not matter.
    outline: its corners, counter-clockwise, (n, 2). False if the test would take too long."""
    corners = region.points[region.triangles]
    low, high = outline.min(axis=0), outline.max(axis=0)
    meets = (corners.min(axis=1) < high).all(axis=1) & (corners.max(axis=1) > low).all(axis=1)
    if meets.sum() > _MOST_TRIANGLES:
        return False
    left = [exact(outline)]
    for triangle in corners[meets]:
        left = [piece for polygon in left for piece in _outside(polygon, exact(triangle))]
    return not left


def _outside(polygon: Polygon, triangle: Polygon) -> list[Polygon]:
    """The pieces of a convex polygon outside of a counter-clockwise triangle."""
    pieces = []
    for k in range(3):
        start, end = triangle[k], triangle[(k + 1) % 3]
        pieces.append(left_of(polygon, end, start))
        polygon = left_of(polygon, start, end)
    return [piece for piece in pieces if piece]
