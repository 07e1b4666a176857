"""The region that a mesh covers, seen along an axis: triangles in the plane, and the prism over it.

All prisms of a check reach farther above and below the plane than any of them is wide. Two prisms
therefore overlap or touch exactly if their regions do. They also have the same depth as the
regions: a translation that separates them separates the regions or is as long as the prisms are
high, and a translation that separates the regions needs no third component. All heights differ, so
only walls can touch, never the ends.

A fill of a hole lies within the convex hull of its boundary loop, so its outline lies within the
outline of that hull. If the region covers that outline, no fill changes the region. The test is
exact: it subtracts one triangle after another from the polygon, in rational numbers, until nothing
remains.
"""

from __future__ import annotations

from collections import Counter
from fractions import Fraction

import numpy as np
import numpy.typing as npt
from msgspec import Struct

from satcheck.core import Mesh
from satcheck.core.conventions import Plane, axes_of

Floats = npt.NDArray[np.float64]
Indices = npt.NDArray[np.int64]

# Rounding of the 2 x 2 determinant of coordinate differences: Shewchuk, "Adaptive Precision
# Floating-Point Arithmetic and Fast Robust Geometric Predicates" (1997), the bound ccwerrboundA.
_FILTER = (3 + 16 * 2.0**-53) * 2.0**-53
# Products below this may have lost digits to underflow.
_TINY = 2.0**-960
Point = tuple[Fraction, Fraction]
Polygon = list[Point]  # convex, counter-clockwise

# Limit on the triangles over one hole. With more triangles, the answer is unknown.
_MOST_TRIANGLES = 1000


class Region(Struct, frozen=True):
    """All points that triangles cover. points: (n, 2), each once, and each a corner; triangles:
    (m, 3), counter-clockwise."""

    points: Floats
    triangles: Indices


def region_of(mesh: Mesh, solid: bool, plane: Plane) -> Region:
    """The outline of a mesh, exactly: dropping one coordinate rounds nothing.

    For a solid, only the triangles that face the viewer: a line of sight enters the solid as often
    as it leaves it, so these triangles cover the whole outline. For other meshes, all triangles.
    """
    points, triangles = _merged(np.asarray(mesh.vertices)[:, axes_of(plane)], mesh.triangles)
    signs = turns(points, triangles)
    if solid:
        return _of_corners(points, triangles[signs > 0])
    turned = np.where(signs[:, None] < 0, triangles[:, ::-1], triangles)
    return _of_corners(points, turned[signs != 0])


def _of_corners(points: Floats, triangles: Indices) -> Region:
    """Without the points of no triangle, as the end of a spike that has no area."""
    corners, index = np.unique(triangles, return_inverse=True)
    return Region(points[corners], index.reshape(-1, 3))


def _merged(points: Floats, triangles: object) -> tuple[Floats, Indices]:
    """Merges points that coincide in the plane, so that walls between neighbours cancel."""
    unique, index = np.unique(points + 0.0, axis=0, return_inverse=True)
    return unique, index.reshape(-1)[np.asarray(triangles, dtype=np.int64)]


def convex_corners(region: Region) -> Floats | None:
    """The corners, counter-clockwise, of a region that is a convex polygon covered exactly once;
    None for any other region."""
    if not len(region.triangles):
        return None
    mesh = prism(region.points, region.triangles, 1.0).welded()
    if not mesh.topology().solid or mesh.convexity_defect(0.0) != 0.0:
        return None
    return _outermost(region.points)


def convex_region(mesh: Mesh, plane: Plane) -> Region:
    """The outline of a convex mesh: the convex hull of its corners."""
    points = np.unique(np.asarray(mesh.vertices)[:, axes_of(plane)] + 0.0, axis=0)
    corners = _outermost(points)
    if corners is None:
        return Region(points, fan_of(0))
    return Region(corners, fan_of(len(corners)))


def _outermost(points: Floats) -> Floats | None:
    """The corners of the convex hull, counter-clockwise; None for points on a line."""
    flat = np.column_stack((points, np.zeros(len(points))))
    hull = Mesh(flat, np.array([(0, 0, 0)], dtype=np.uint32)).convex_hull()
    corners = np.array(hull.vertices)[:, :2]
    signs = turns(corners, fan_of(len(corners)))
    if not len(signs):
        return None
    if (signs < 0).all():
        return corners[::-1].copy()
    return corners if (signs > 0).all() else None


def fan_of(corners: int) -> Indices:
    """The triangles of a convex polygon, as a fan around its first corner."""
    return np.array([(0, k, k + 1) for k in range(1, corners - 1)], dtype=np.int64).reshape(-1, 3)


def prism(points: Floats, triangles: Indices, height: float) -> Mesh:
    """The closed mesh, |z| <= height, over signed triangles in the plane, (n, 2) and (m, 3).

    Its winding number at a point between its ends is the sum of the signs of the triangles below
    that point. Walls stand on the boundary edges. They are not welded.
    """
    count = len(points)
    ground = np.column_stack((points, np.full(count, -height)))
    roof = np.column_stack((points, np.full(count, height)))
    walls = _walls(triangles, count)
    faces = np.concatenate((triangles[:, ::-1], triangles + count, walls))
    return Mesh(np.concatenate((ground, roof)), faces.astype(np.uint32))


def _walls(triangles: Indices, roof: int) -> Indices:
    edges: Counter[tuple[int, int]] = Counter()
    for a, b, c in triangles.tolist():
        edges.update(((a, b), (b, c), (c, a)))
    walls = [
        face
        for (a, b), times in edges.items()
        for _ in range(times - edges.get((b, a), 0))
        for face in ((a, b, b + roof), (a, b + roof, a + roof))
    ]
    return np.array(walls, dtype=np.int64).reshape(-1, 3)


def turns(points: Floats, triangles: Indices) -> npt.NDArray[np.int8]:
    """The exact orientation of each triangle: +1 counter-clockwise, -1 clockwise, 0 on a line.

    points: (n, 2); triangles: (m, 3).
    """
    a, b, c = (points[triangles[:, k]] for k in range(3))
    with np.errstate(over="ignore", invalid="ignore", under="ignore"):
        left = (a[:, 0] - c[:, 0]) * (b[:, 1] - c[:, 1])
        right = (a[:, 1] - c[:, 1]) * (b[:, 0] - c[:, 0])
        value, size = left - right, np.abs(left) + np.abs(right)
        certain = (np.abs(value) > _FILTER * size) & (size > _TINY) & np.isfinite(size)
    signs = np.sign(np.where(certain, value, 0.0)).astype(np.int8)
    for k in np.flatnonzero(~certain):
        signs[k] = _exact_turn(points[triangles[k]].tolist())
    return signs


def _exact_turn(corners: list[list[float]]) -> int:
    (ax, ay), (bx, by), (cx, cy) = ([Fraction(x) for x in corner] for corner in corners)
    value = (ax - cx) * (by - cy) - (ay - cy) * (bx - cx)
    return (value > 0) - (value < 0)


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
