"""Openings of a mesh that colliders close: balls that pass straight through the mesh, and not
through the colliders.

A ball passes along a line if no triangle of the mesh is nearer to the line than its radius. It has
to pass between the ends of the mesh, in each of 64 directions across the line. Colliders close its
way if parallel lines within it meet them that lie so close together that every ball of a twentieth
of its diameter, which passes the same way within it, holds one of them.

What is found is proven. The search is not complete: it tries some directions, a grid of lines in
each, and climbs from the best of these.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from satcheck.core import Mesh, Surface
from satcheck.report.colliders import Opening

Floats = NDArray[np.float64]

# Lines across the mesh in each of both ways, the starts of climbs among them, and their steps.
_GRID = 40
_STARTS = 6
_CLIMB = 24
# Smaller radii that are tried until the colliders close the way, and the ratio of two of them.
_RADII, _LESS = 6, 0.9
# The most directions, and the triangles of a mesh that is seen along so many of them.
_MOST_DIRECTIONS = 12
_TRIANGLES = 2_000_000
_ALIKE = 0.999  # the cosine of directions that are not told apart
# The step of a square grid of lines, as a share of the radius. A disc of radius r holds a point of
# a grid whose step is r sqrt(2).
_FINE = 0.07
# (2, n): unit vectors in the plane across a line.
_AROUND = np.array([(np.cos(a), np.sin(a)) for a in np.arange(64) * np.pi / 32]).T
# Of the size of the mesh: the smallest ball, and more than all rounding.
SMALLEST = 5e-3
_MARGIN = 1e-9


def largest_opening(
    mesh: Mesh, sag: float, colliders: Sequence[Surface], share: float
) -> Opening | None:
    """The largest opening of the mesh that was found to be closed by the colliders.

    sag: how far the drawn surface may be off its triangles. colliders: within the true ones. share:
    of the effort of a run, for this mesh.
    """
    low, high = map(np.array, mesh.bounds)
    size = float(np.linalg.norm(high - low))
    drawn, best = Surface(mesh, False), None
    for direction in _directions(mesh, share):
        least = SMALLEST * size if best is None else best.diameter / 2
        view = _View(drawn, sag, colliders, direction)
        best = view.opening(least, (low + high) / 2) or best
    return best


class _View:
    """All of it, as seen along a direction."""

    def __init__(
        self, drawn: Surface, sag: float, colliders: Sequence[Surface], direction: Floats
    ) -> None:
        u = np.cross(np.eye(3)[np.abs(direction).argmin()], direction)
        u /= np.linalg.norm(u)
        self._axes, self._direction = np.stack([u, np.cross(direction, u)]), direction
        self._drawn, self._colliders = drawn, colliders
        points = np.asarray(drawn.mesh.vertices) @ self._axes.T
        self._low, self._high = points.min(axis=0), points.max(axis=0)
        self._ends = (points @ _AROUND).max(axis=0)
        self._rounded = _MARGIN * drawn.mesh.largest_coordinate
        self._spare = sag + self._rounded

    def opening(self, least: float, middle: Floats) -> Opening | None:
        """The largest with a radius of more than `least`. middle: near which its point is."""
        best, at = least, None
        for most, point in self._candidates(least):
            radius = most
            for _ in range(_RADII):
                if radius > best and self._closes(point, radius):
                    best, at = radius, point
                    break
                radius *= _LESS
        if at is None:
            return None
        along = float(middle @ self._direction) * self._direction
        place, way = (tuple(v.tolist()) for v in (at @ self._axes + along, self._direction))
        return Opening(diameter=2 * best, point=place, direction=way)

    def _candidates(self, least: float) -> Iterator[tuple[float, Floats]]:
        """(radius, point) of balls that pass through the mesh, where lines meet colliders."""
        steps = (np.arange(_GRID) + 0.5) / _GRID
        cells = np.stack(np.meshgrid(steps, steps), axis=-1).reshape(-1, 2)
        points = self._low + cells * (self._high - self._low)
        closed = self._meet(points)
        passing, points = points[~closed], points[closed]
        radii = self._radii(points, passing)
        reach = 2 * float(np.linalg.norm(self._high - self._low)) / _GRID  # of most climbs
        starts: list[Floats] = []
        for k in np.argsort(-radii, kind="stable"):
            if radii[k] + reach <= least or len(starts) == _STARTS:
                break
            if all(np.linalg.norm(points[k] - other) > radii[k] for other in starts):
                starts.append(points[k])
                yield self._climbed(points[k], passing)

    def _climbed(self, point: Floats, passing: Floats) -> tuple[float, Floats]:
        step = (self._high - self._low) / _GRID
        around = np.stack(np.meshgrid([0.0, -1.0, 1.0], [0.0, -1.0, 1.0]), axis=-1).reshape(-1, 2)
        radius = 0.0
        for _ in range(_CLIMB):
            points = point + around * step
            radii = self._radii(points, passing)
            best = int(radii.argmax())
            radius, point = float(radii[best]), points[best]
            if best == 0:  # the point itself
                step = step / 2
        return radius, point

    def _radii(self, points: Floats, passing: Floats) -> Floats:
        """(n,): of the largest ball that passes there, and holds none of these lines that pass."""
        radii = self._distances(self._drawn, points) - self._spare
        radii = np.minimum(radii, (self._ends - points @ _AROUND).min(axis=1) - self._spare)
        for k in np.flatnonzero(radii > 0) if len(passing) else ():
            radii[k] = min(radii[k], np.linalg.norm(passing - points[k], axis=1).min())
        held: Floats = np.maximum(radii, 0.0)
        return held

    def _closes(self, centre: Floats, radius: float) -> bool:
        """Whether the colliders close the way of the ball."""
        count = int(1 / _FINE)
        steps = np.arange(-count, count + 1) * (_FINE * radius)
        points = np.stack(np.meshgrid(steps, steps), axis=-1).reshape(-1, 2)
        return bool(self._meet(centre + points[np.linalg.norm(points, axis=1) <= radius]).all())

    def _meet(self, points: Floats) -> NDArray[np.bool_]:
        """(n,): whether the line meets a collider, to rounding."""
        meets = np.zeros(len(points), dtype=bool)
        for each in self._colliders:
            meets[~meets] = self._distances(each, points[~meets]) <= self._rounded
        return meets

    def _distances(self, surface: Surface, points: Floats) -> Floats:
        """(n,): how far the lines at these points, (n, 2), pass from the surface."""
        u, v = map(tuple, self._axes.tolist())
        found: Floats = np.array(surface.line_distances(u, v, list(map(tuple, points.tolist()))))
        return found


def _directions(mesh: Mesh, share: float) -> list[Floats]:
    """Unit vectors: the axes of the world, those of the mesh, and normals of large faces."""
    points = np.asarray(mesh.vertices)
    _, main = np.linalg.eigh(np.cov(points.T))
    a, b, c = np.moveaxis(points[np.asarray(mesh.triangles)], 1, 0)
    normals = np.cross(b - a, c - a)
    areas = np.linalg.norm(normals, axis=1)
    normals, areas = normals[areas > 0] / areas[areas > 0, None], areas[areas > 0]
    normals *= np.where(normals[:, :1] < 0, -1.0, 1.0)
    kinds: dict[tuple[float, ...], float] = {}
    for key, area in zip(map(tuple, normals.round(3).tolist()), areas.tolist(), strict=True):
        kinds[key] = kinds.get(key, 0.0) + area
    frequent = sorted(kinds, key=lambda key: (-kinds[key], key))[:_MOST_DIRECTIONS]
    directions: list[Floats] = []
    most = min(max(int(share * _TRIANGLES / mesh.triangle_count), 3), _MOST_DIRECTIONS)
    for way in (*np.eye(3), *main.T, *map(np.array, frequent)):
        unit = way / np.linalg.norm(way)
        if len(directions) < most and all(abs(unit @ other) < _ALIKE for other in directions):
            directions.append(unit)
    return directions
