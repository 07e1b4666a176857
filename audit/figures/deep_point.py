"""A point deep in two outlines, and the lower bound of the depth that it proves.

A disc around the point lies within a body if it stays farther from the polygon's boundary than the
curve may be off: the curve runs around it as often as the polygon does. Two discs around one point
are only apart once one has moved by both radii, so the depth is at least that.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, cast

import numpy as np

from satcheck.core.conventions import Plane, axes_of, axis_across

if TYPE_CHECKING:
    from collections.abc import Callable

    import numpy.typing as npt

    from satcheck.audit.bodies.placed_body import PlacedBody
    from satcheck.report.report import Vector

    Floats = npt.NDArray[np.float64]

# The point is moved in steps of the depth, halved this often where no step leads deeper.
_HALVINGS = 8
_MOST_STEPS = 64
_MOST_CORNERS = 256
_WAYS = [np.array((np.cos(k * np.pi / 4), np.sin(k * np.pi / 4))) for k in range(8)]


class Outline:
    """The edges of a prism's walls, as they run around the region; ends in the plane, (n, 2)."""

    def __init__(self, body: PlacedBody, plane: Plane) -> None:
        vertices = np.asarray(body.mesh.vertices)
        triangles = np.asarray(body.mesh.triangles, dtype=np.int64)
        on_ground = vertices[triangles][:, :, axis_across(plane)] < 0
        walls = triangles[on_ground.sum(axis=1) == 2]
        ground = on_ground[on_ground.sum(axis=1) == 2]
        first = np.argmin(ground, axis=1) + 1  # the corner after the one on the roof
        rows = np.arange(len(walls))
        flat = vertices[:, axes_of(plane)]
        self.start = cast("Floats", flat[walls[rows, first % 3]])
        self.end = cast("Floats", flat[walls[rows, (first + 1) % 3]])

    def room(self, p: Floats) -> float:
        """How far a point inside is from the nearest edge; 0.0 outside."""
        step, way = self.end - self.start, p - self.start
        length = np.einsum("ij,ij->i", step, step)
        share = np.clip(np.einsum("ij,ij->i", way, step) / length, 0.0, 1.0)
        nearest = np.hypot(*(way - share[:, None] * step).T).min()
        return float(nearest) if self._winding(p) else 0.0

    def deepest_corner(self, other: Outline) -> tuple[Floats, float]:
        """The corner with the most room in the other outline, of so many, and half that room."""
        corners = self.start[:: -(-len(self.start) // _MOST_CORNERS)]
        rooms = [other.room(corner) for corner in corners]
        deepest = int(np.argmax(rooms))
        return corners[deepest], rooms[deepest] / 2

    def _winding(self, p: Floats) -> int:
        (ax, ay), (bx, by) = (self.start - p).T, (self.end - p).T
        left = ax * by - ay * bx
        up, down = (ay <= 0) & (by > 0) & (left > 0), (ay > 0) & (by <= 0) & (left < 0)
        return int(up.sum()) - int(down.sum())


def depth_around(
    bodies: tuple[PlacedBody, PlacedBody],
    off: tuple[float, float],
    near: Vector,
    step: float,
    plane: Plane,
) -> float:
    """A lower bound of the depth by the deepest point that is found; 0.0: none is shown.

    off: how far the curve of either body may be from its polygon. near, step: a point to start
    from, and the first step from there. The other starts are corners deep in the other outline.
    """
    a, b = (Outline(body, plane) for body in bodies)

    def depth(p: Floats) -> float:
        radii = (a.room(p) - off[0], b.room(p) - off[1])
        return sum(radii) if min(radii) > 0 else min(radii)

    start = np.array([near[axis] for axis in axes_of(plane)])
    starts = [(start, step), a.deepest_corner(b), b.deepest_corner(a)]
    return max(0.0, *(_climbed(depth, point, first) for point, first in starts))


def _climbed(depth: Callable[[Floats], float], point: Floats, step: float) -> float:
    """By steps in eight directions to where it is deepest; halved where none leads deeper."""
    best, halvings = depth(point), 0
    for _ in range(_MOST_STEPS):
        points = [point + step * way for way in _WAYS]
        depths = [depth(p) for p in points]
        deepest = int(np.argmax(depths))
        if depths[deepest] > best:
            best, point = depths[deepest], points[deepest]
        elif halvings < _HALVINGS:
            step, halvings = step / 2, halvings + 1
        else:
            break
    return best
