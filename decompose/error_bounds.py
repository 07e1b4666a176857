"""How far convex parts and their mesh stick out of each other: proven upper bounds.

`outside_error`: how far the parts stick out of the mesh, by `core.deviation`.

`missing_error`: how far the mesh sticks out of the parts. The distance to a convex body is a convex
function, so it is largest at a corner of a polygon. The triangles of the mesh are cut along the
parts into polygons, and each polygon is assigned to one part. The largest distance of a corner to
its part bounds the distance of the mesh to the union of the parts. Every cut and every assignment
give a valid bound; cuts at the borders of the parts make it tight. So the cuts may be rounded, and
only the distances must be right. Polygons are cut after Ivan Sutherland, Gary Hodgman, "Reentrant
Polygon Clipping" (1974), for both sides of a plane. They have few corners, so lists are several
times faster than array operations.

Parts leave slits between them. So each part is first widened by a slack: nearly the least slack at
which the widened parts contain the triangle.

Branch and bound on the deviation from the union needs thousands of times more pieces for the same
width, because faces of the parts lie in faces of the mesh.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from typing import TYPE_CHECKING, Final

import numpy as np

from satcheck.core import Mesh, Polytope, Surface, deviation
from satcheck.decompose.components import diagonal
from satcheck.decompose.errors import NEVER, Deadline

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

# The first slack, relative to the diagonal, and to the largest coordinate (for meshes far away).
_FIRST_SLACK: Final = 1e-6
_FIRST_SLACK_FAR: Final = 1e-13
_SLACK_GROWTH: Final = 1.5
# Roundings of a distance and of a cut point, in units of the largest coordinate.
ROUNDINGS: Final = 64.0 * 2.0**-53
# A plane cuts a piece at most once. A cut point is off the edge by its own roundings, below this,
# and by no more than the ends of the edge are.
_CUT_ROUNDINGS: Final = 16.0 * 2.0**-53
# Slack of the bound, in diagonals of the mesh's bounding box for a threshold of 1. Parts stick out
# by about 0.3 * threshold. The first slack is small against that. The second is for parts that
# hardly stick out.
_SLACKS: Final = (0.02, 0.005)
_WIDE: Final = 1.25  # the finer slack is used only above this ratio of upper to lower bound
_ENTRIES_AT_ONCE: Final = 1 << 22  # heights of points above planes: at most 32 MiB
Point = tuple[float, float, float]
Polygon = list[Point]
Plane = tuple[Point, float]  # (unit normal, offset); below: normal . x <= offset


def outside_error(parts: Sequence[Polytope], surface: Surface, threshold: float) -> float:
    """An upper bound of the largest distance of a part's surface from the mesh."""
    unit = threshold * diagonal(surface.mesh)
    meshes = [part.to_mesh() for part in parts]
    bounds = [deviation(mesh, [surface], _SLACKS[0] * unit)[:2] for mesh in meshes]
    for slack in _SLACKS[1:]:
        enough = _WIDE * max(lower for lower, _ in bounds)
        bounds = [
            deviation(mesh, [surface], slack * unit)[:2] if bound[1] > enough else bound
            for mesh, bound in zip(meshes, bounds, strict=True)
        ]
    return max(upper for _, upper in bounds)


def missing_error(mesh: Mesh, parts: Sequence[Polytope], deadline: Deadline = NEVER) -> float:
    """An upper bound of the largest distance of the mesh's surface from the union of the parts.

    At most about twice that distance, or 1e-6 of the mesh's diagonal above it. Raises
    DecompositionError at the deadline.
    """
    bodies = Bodies(parts, deadline)
    pieces = bodies.assigned(mesh)
    error = max((bodies.largest_distance(piece, part) for part, piece, _ in pieces), default=0.0)
    return error + ROUNDINGS * mesh.largest_coordinate if error > 0.0 else 0.0


class Bodies:
    """The parts, prepared for many queries."""

    def __init__(self, parts: Sequence[Polytope], deadline: Deadline) -> None:
        self._deadline = deadline
        self._planes = [planes_of(part, deadline) for part in parts]
        self._surfaces = [Surface(part.to_mesh(), True) for part in parts]
        bounds = np.array([surface.mesh.bounds for surface in self._surfaces])
        self._low, self._high = bounds[:, 0], bounds[:, 1]

    def assigned(self, mesh: Mesh) -> Iterator[tuple[int, Polygon, float]]:
        """Cut the surface of a mesh into pieces near the parts.

        Yield (part, piece, error). A point of a triangle is within the error of the pieces that it
        was cut into; 0: it is whole. Raises DecompositionError at the deadline.
        """
        vertices = np.asarray(mesh.vertices)
        triangles = np.asarray(mesh.triangles)
        above = self.heights(vertices)[triangles].max(axis=1)  # (triangles, parts)
        nearest = above.argmin(axis=1)
        least = above[np.arange(len(above)), nearest]
        planes = sum(len(normals) for normals, _ in self._planes)
        error = _CUT_ROUNDINGS * planes * mesh.largest_coordinate
        slack = _FIRST_SLACK * diagonal(mesh) + _FIRST_SLACK_FAR * mesh.largest_coordinate
        order = np.argsort(least, kind="stable")
        for polygon, part, height in zip(
            vertices[triangles[order]].tolist(),
            nearest[order].tolist(),
            least[order].tolist(),
            strict=True,
        ):
            self._deadline.check()
            if height <= slack:
                yield part, polygon, 0.0
                continue
            while (pieces := self.cover(polygon, slack)) is None:
                slack *= _SLACK_GROWTH
            for number, piece in pieces:
                yield number, piece, error

    def heights(self, points: Floats) -> Floats:
        """(points, parts): the height above the highest plane of each part; at most 0 inside."""
        return np.stack([highest(points, *each, self._deadline) for each in self._planes], axis=1)

    def distance(self, point: Point, part: int) -> float:
        """The distance to the solid part; 0.0 inside, decided by exact signs."""
        surface = self._surfaces[part]
        distance = surface.nearest(point)[0]
        return 0.0 if distance == 0.0 or surface.winding_number(point) != 0 else distance

    def largest_distance(self, polygon: Polygon, part: int) -> float:
        """The largest distance of a point of the polygon to one part."""
        return max((self.distance(point, part) for point in polygon), default=0.0)

    def cover(self, polygon: Polygon, slack: float) -> list[tuple[int, Polygon]] | None:
        """Pieces of the polygon, each with the part that contains it; None: the widened parts do
        not contain the whole polygon."""
        corners = np.array(polygon)
        near = (corners.max(axis=0) >= self._low - slack).all(axis=1)
        near &= (corners.min(axis=0) <= self._high + slack).all(axis=1)
        covered: list[tuple[int, Polygon]] = []
        rest = [polygon]
        for part in np.flatnonzero(near).tolist():
            pieces = rest
            rest = []
            for piece in pieces:
                crossing = self._crossing(piece, part, slack)
                if crossing is None:
                    rest.append(piece)
                    continue
                inside, beyond = without(piece, crossing, slack)
                if inside:
                    covered.append((part, inside))
                rest += beyond
            if not rest:
                return covered
        return None

    def _crossing(self, polygon: Polygon, part: int, slack: float) -> list[Plane] | None:
        """The planes of the widened part that cut the polygon; None: the polygon is completely
        above a plane."""
        normals, offsets = self._planes[part]
        above = np.array(polygon) @ normals.T - offsets - slack
        if above.min(axis=0).max() >= 0.0:
            return None
        cutting = above.max(axis=0) > 0.0
        return list(zip(normals[cutting].tolist(), offsets[cutting].tolist(), strict=True))


def planes_of(part: Polytope, deadline: Deadline) -> tuple[Floats, Floats]:
    """((f, 3), (f,)): the part is where normal . x <= offset for each unit normal. A triangle
    without area limits nothing: its normal is 0, its offset infinite."""
    corners = np.asarray(part.vertices)
    a, b, c = np.moveaxis(corners[np.asarray(part.triangles)], 1, 0)
    normals = np.cross(b - a, c - a)
    lengths = np.linalg.norm(normals, axis=1)
    normals = normals / np.where(lengths > 0.0, lengths, np.inf)[:, None]
    offsets = highest(normals, corners, np.zeros(len(corners)), deadline)
    return normals, np.where(lengths > 0.0, offsets, np.inf)


def highest(points: Floats, normals: Floats, offsets: Floats, deadline: Deadline) -> Floats:
    """(n,): the height of each point (n, 3) above the highest plane."""
    at_once, found = max(1, _ENTRIES_AT_ONCE // len(offsets)), []
    for first in range(0, len(points), at_once):
        deadline.check()
        found.append((points[first : first + at_once] @ normals.T - offsets).max(axis=1))
    return np.concatenate(found)


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
