"""Openings of a mesh that colliders close: balls that pass straight through the mesh, and not
through the colliders.

A ball passes along a line if no triangle of the mesh is nearer to the line than its radius. The
colliders stop all of it if each parallel line within the radius meets them. So both are questions
about shadows along the line. A point is deep in the shadow of a mesh if it lies in it, and if the
outline is far: the edges between triangles that face opposite ways, whose shadows hold the border
of the shadow. The ball has to lie in the shadow of the convex hull of the mesh, too.

What is found is proven. The search is not complete: it tries some directions, a grid of lines in
each, and climbs from the best of these.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
from msgspec import Struct
from numpy.typing import NDArray

from satcheck.core import Mesh, Surface
from satcheck.report.colliders import Opening

Floats = NDArray[np.float64]

# Lines across the mesh in each of both ways, the starts of climbs among them, and their steps.
_GRID = 40
_STARTS = 6
_CLIMB = 24
# The most directions, and the triangles of a mesh that is seen along so many of them.
_MOST_DIRECTIONS = 12
_TRIANGLES = 2_000_000
_ALIKE = 0.999  # the cosine of directions that are not told apart
# A disc is cut into squares at most so often, until a collider shadows each.
_CUTS = 5
# Of the size of the mesh: the smallest ball, and more than all rounding of a shadow.
SMALLEST = 5e-3
_MARGIN = 1e-9


class _Shadow:
    """The shadow of a mesh on a plane. axes: two unit vectors in the plane, (2, 3)."""

    def __init__(self, surface: Surface, axes: Floats, margin: float) -> None:
        self._surface, self._axes, self._margin = surface, axes, margin
        mesh = surface.mesh
        points = np.asarray(mesh.vertices) @ axes.T
        self._ends = points[_outline(points, np.asarray(mesh.triangles), margin)]

    def distances(self, points: Floats) -> Floats:
        """(n,): how far the lines at these points, (n, 2), pass from the mesh."""
        u, v = map(tuple, self._axes.tolist())
        return np.array(self._surface.line_distances(u, v, list(map(tuple, points.tolist()))))

    def depths(self, points: Floats) -> Floats:
        """(n,): how deep these points surely lie in the shadow; 0 outside."""
        depths = np.zeros(len(points))
        for k in np.flatnonzero(self.distances(points) <= self._margin):
            depths[k] = max(_least_distance(points[k], self._ends) - 2 * self._margin, 0.0)
        return depths


def _outline(points: Floats, triangles: NDArray[np.uint32], margin: float) -> NDArray[np.int64]:
    """(n, 2): the edges between triangles that do not surely face the same way."""
    a, b, c = np.moveaxis(points[triangles], 1, 0)
    (px, py), (qx, qy) = (b - a).T, (c - a).T
    area = px * qy - py * qx
    facing = np.sign(area) * (np.abs(area) > margin * np.abs(points).max())
    edges = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    turned = edges[:, 0] > edges[:, 1]
    keys, which, counts = np.unique(
        np.sort(edges.astype(np.int64), axis=1), axis=0, return_inverse=True, return_counts=True
    )
    which = which.ravel()
    faces, ways = np.zeros(len(keys)), np.zeros(len(keys))
    np.add.at(faces, which, np.tile(facing, 3))
    np.add.at(ways, which, np.where(turned, -1, 1))
    plain = (counts == 2) & (ways == 0) & (np.abs(faces) == 2)
    found: NDArray[np.int64] = keys[~plain]
    return found


def _least_distance(point: Floats, ends: Floats) -> float:
    """The distance of a point, (2,), from the nearest of the segments, (n, 2, 2)."""
    start, way = ends[:, 0], ends[:, 1] - ends[:, 0]
    squares = np.maximum((way * way).sum(axis=1), np.finfo(float).tiny)
    along = np.clip(((point - start) * way).sum(axis=1) / squares, 0.0, 1.0)
    offsets = point - start - along[:, None] * way
    return float(np.sqrt((offsets * offsets).sum(axis=1).min(initial=np.inf)))


def largest_opening(mesh: Mesh, sag: float, colliders: Sequence[Surface]) -> Opening | None:
    """The largest opening of the mesh that was found to be closed by the colliders.

    sag: how far the drawn surface may be off its triangles. colliders: closed, and within the true
    ones.
    """
    low, high = map(np.array, mesh.bounds)
    size = float(np.linalg.norm(high - low))
    margin = _MARGIN * (size + float(np.abs([low, high]).max()))
    try:
        hull = mesh.convex_hull().to_mesh()
    except ValueError:  # it is flat
        return None
    drawn, around = Surface(mesh, False), Surface(hull, True)
    best = None
    for direction in _directions(mesh):
        least = SMALLEST * size if best is None else best.diameter / 2
        view = _View(drawn, sag, around, colliders, direction, margin)
        best = view.opening(least, (low + high) / 2) or best
    return best


class _View:
    """All of it, as seen along a direction."""

    def __init__(
        self,
        drawn: Surface,
        sag: float,
        around: Surface,
        colliders: Sequence[Surface],
        direction: Floats,
        margin: float,
    ) -> None:
        least = np.eye(3)[np.abs(direction).argmin()]
        u = np.cross(least, direction)
        u /= np.linalg.norm(u)
        self._axes = np.stack([u, np.cross(direction, u)])
        self._direction, self._spare = direction, sag + 4 * margin
        self._drawn = _Shadow(drawn, self._axes, margin)
        self._around = _Shadow(around, self._axes, margin)
        self._colliders = [_Shadow(each, self._axes, margin) for each in colliders]
        corners = np.asarray(around.mesh.vertices) @ self._axes.T
        self._low, self._high = corners.min(axis=0), corners.max(axis=0)

    def opening(self, least: float, middle: Floats) -> Opening | None:
        """The largest with a radius of more than `least`. middle: near which its point is."""
        for radius, at in self._candidates(least):
            if self._stop(at, radius):
                along = float(middle @ self._direction) * self._direction
                point = tuple((at @ self._axes + along).tolist())
                way = tuple(self._direction.tolist())
                return Opening(diameter=2 * radius, point=point, direction=way)
        return None

    def _candidates(self, least: float) -> Iterator[tuple[float, Floats]]:
        """(radius, point) of balls that pass through the mesh, the largest first."""
        steps = (np.arange(_GRID) + 0.5) / _GRID
        cells = np.stack(np.meshgrid(steps, steps), axis=-1).reshape(-1, 2)
        points = self._low + cells * (self._high - self._low)
        stopped = np.zeros(len(points), dtype=bool)
        for each in self._colliders:
            stopped |= each.distances(points) == 0.0
        points = points[stopped]
        radii = self._radii(points)
        starts: list[Floats] = []
        for k in np.argsort(-radii, kind="stable"):
            if radii[k] <= 0 or len(starts) == _STARTS:
                break
            if all(np.linalg.norm(points[k] - other) > radii[k] for other in starts):
                starts.append(points[k])
        found = [self._climbed(start) for start in starts]
        yield from (each for each in sorted(found, key=lambda one: -one[0]) if each[0] > least)

    def _climbed(self, point: Floats) -> tuple[float, Floats]:
        step = (self._high - self._low) / _GRID
        around = np.stack(np.meshgrid([-1.0, 0.0, 1.0], [-1.0, 0.0, 1.0]), axis=-1).reshape(-1, 2)
        radius = 0.0
        for _ in range(_CLIMB):
            points = point + np.concatenate([[[0.0, 0.0]], around]) * step
            radii = self._radii(points)
            best = int(radii.argmax())
            radius = float(radii[best])
            if best == 0:
                step = step / 2
            point = points[best]
        return radius, point

    def _radii(self, points: Floats) -> Floats:
        """(n,): of the largest ball that passes there, within the shadow of the hull."""
        free = self._drawn.distances(points) - self._spare
        some = free > 0
        free[some] = np.minimum(free[some], self._around.depths(points[some]))
        return np.maximum(free, 0.0)

    def _stop(self, centre: Floats, radius: float) -> bool:
        """Whether the colliders shadow the whole disc."""
        half, squares = radius, centre[None]
        for _ in range(_CUTS + 1):
            reach = np.minimum(half * np.sqrt(2.0), radius) * np.ones(len(squares))
            is_open = np.ones(len(squares), dtype=bool)
            for each in self._colliders:
                is_open[is_open] = each.depths(squares[is_open]) < reach[is_open]
            if not is_open.any():
                return True
            half /= 2
            corners = np.array([(-half, -half), (-half, half), (half, -half), (half, half)])
            squares = (squares[is_open][:, None] + corners).reshape(-1, 2)
            near = np.maximum(np.abs(squares - centre) - half, 0.0)
            squares = squares[(near * near).sum(axis=1) < radius * radius]
        return False


def _directions(mesh: Mesh) -> list[Floats]:
    """Unit vectors: the axes of the world, those of the mesh, and normals of large faces."""
    points = np.asarray(mesh.vertices)
    _, main = np.linalg.eigh(np.cov(points.T))
    a, b, c = np.moveaxis(points[np.asarray(mesh.triangles)], 1, 0)
    normals = np.cross(b - a, c - a)
    kinds: dict[tuple[float, ...], float] = {}
    areas = np.linalg.norm(normals, axis=1)
    normals = normals[areas > 0] / areas[areas > 0, None]
    normals *= np.where(normals[:, :1] < 0, -1.0, 1.0)
    for key, area in zip(map(tuple, normals.round(3).tolist()), areas[areas > 0], strict=True):
        kinds[key] = kinds.get(key, 0.0) + float(area)
    frequent = sorted(kinds, key=lambda key: (-kinds[key], key))[:_MOST_DIRECTIONS]
    directions: list[Floats] = []
    most = min(max(_TRIANGLES // mesh.triangle_count, 3), _MOST_DIRECTIONS)
    for way in (*np.eye(3), *main.T, *map(np.array, frequent)):
        unit = way / np.linalg.norm(way)
        if len(directions) < most and all(abs(unit @ other) < _ALIKE for other in directions):
            directions.append(unit)
    return directions
