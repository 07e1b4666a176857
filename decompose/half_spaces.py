"""Converts convex bodies to intersections of half-spaces normal . x <= offset, and back."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np
from msgspec import Struct

from satcheck.core import Mesh

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

NOISE: Final = 1e-9  # of a body's size: points closer to a plane count as on it
# Limit on points times planes, and on points: at most 32 MiB.
_ENTRIES_AT_ONCE: Final = 1 << 22
_POINTS_AT_ONCE: Final = 1 << 12
_CENTRE_STEPS: Final = 200
_CENTRE_STEP_RATIO: Final = 0.95  # ratio of successive steps; the last is 4e-5 of the size


class HalfSpaces(Struct, frozen=True):
    """normals: (f, 3), unit, outward; offsets: (f,); size: of the body, the unit of NOISE."""

    normals: Floats
    offsets: Floats
    size: float

    @property
    def points_at_once(self) -> int:
        """The number of points that can be compared with all planes in little memory."""
        return max(1, min(_POINTS_AT_ONCE, _ENTRIES_AT_ONCE // len(self.offsets)))

    def slack(self, points: Floats) -> Floats:
        """(n, f): the distance of each point (n, 3) below each plane; negative outside."""
        slack: Floats = self.offsets - points @ self.normals.T
        return slack

    def heights(self, points: Floats) -> Floats:
        """(n,): the height of each point (n, 3) above the highest plane; at most 0 inside."""
        chunks = [
            -self.slack(points[first : first + self.points_at_once]).min(axis=1)
            for first in range(0, len(points), self.points_at_once)
        ]
        return np.concatenate(chunks)

    def cut(self, normals: Floats, offsets: Floats) -> HalfSpaces:
        return HalfSpaces(
            np.concatenate([self.normals, normals]),
            np.concatenate([self.offsets, offsets]),
            self.size,
        )


def around(corners: Floats, triangles: NDArray[np.integer]) -> HalfSpaces:
    """The half-spaces of a convex body with vertices (n, 3) and outward triangles (m, 3)."""
    a, b, c = np.moveaxis(corners[triangles], 1, 0)
    normals = np.cross(b - a, c - a)
    lengths = np.linalg.norm(normals, axis=1)
    normals = normals[lengths > 0.0] / lengths[lengths > 0.0, None]
    size = float((corners.max(axis=0) - corners.min(axis=0)).max())
    return HalfSpaces(normals, (normals @ corners.T).max(axis=1), size)


def vertices_of(body: HalfSpaces, start: Floats) -> Floats:
    """Vertices (n, 3) of the intersection, rounded; none if it has no inner point.

    start: (3,), near an inner point. The vertices are the faces of the convex hull of the dual
    points normal / slack about an inner point.
    """
    nothing: Floats = np.empty((0, 3))
    centre = _deep_point(body, start)
    slack = body.slack(centre[None])[0]
    if slack.min() <= NOISE * body.size:
        return nothing
    dual = points_as_mesh(body.normals / slack[:, None]).convex_hull()
    if dual.dimension < 3:
        return nothing
    a, b, c = np.moveaxis(np.asarray(dual.vertices)[np.asarray(dual.triangles)], 1, 0)
    faces = np.cross(b - a, c - a)
    heights = (faces * a).sum(axis=1)
    # Slivers of the dual hull give wrong points. The half-spaces reject them.
    usable = heights > 0.0
    points = centre + faces[usable] / heights[usable, None]
    fits = (body.slack(points) >= -NOISE * body.size).all(axis=1)
    vertices: Floats = np.unique(points[fits], axis=0)
    return vertices


def points_as_mesh(points: Floats) -> Mesh:
    """A mesh that refers to every point (n >= 3, 3). Only its convex hull is used."""
    first = np.arange(len(points) - 2, dtype=np.uint32)
    return Mesh(np.ascontiguousarray(points), np.column_stack([first, first + 1, first + 2]))


def _deep_point(body: HalfSpaces, start: Floats) -> Floats:
    """A point near the maximum of the least slack, by subgradient steps of decreasing length."""
    best = point = start
    best_slack = -np.inf
    step = body.size
    for _ in range(_CENTRE_STEPS):
        slack = body.slack(point[None])[0]
        nearest = int(np.argmin(slack))
        if slack[nearest] > best_slack:
            best, best_slack = point, slack[nearest]
        step *= _CENTRE_STEP_RATIO
        point = point - step * body.normals[nearest]
    return best
