"""Where a picture is seen from, the page and the image alike: across the way out or the gap, from a
side from which neither another body nor one of the pair hides the place."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import cache
from itertools import product
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from satcheck.cli.formats.picture.moments import boxes_of, sphere_around
from satcheck.cli.formats.picture.packing import simplified

if TYPE_CHECKING:
    import numpy.typing as npt

    from satcheck.core import Mesh
    from satcheck.scene import Body

    Floats = npt.NDArray[np.float64]

YAW, PITCH = -0.7, 0.5  # of the first choice, in radians; z is up
_YAWS = [YAW + np.pi * k / 8 for k in range(16)]
_PITCHES = (PITCH, 0.25, 0.0, 0.8, 1.2, -0.3)
_ACROSS = 0.26  # the cosine of an angle to the way that is still across it
_TESTED = 16  # directions, the best first, along which rays tell what hides the place
# What a direction costs: a surface of the pair, or of another body, before the place; one body of
# the pair right behind the other; to be half a turn from the first choice; to look up from below;
# to see a hole from its edge.
_SURFACE, _OTHER, _BEHIND, _UNUSUAL, _BELOW, _EDGEWAYS = 1.0, 0.4, 1.0, 0.3, 1.0, 2.0
_FACING = 0.4  # the cosine of an angle to the normal of a hole, of which not only the edge is seen
_MOST_OTHERS = 4  # surfaces of other bodies that count: they are faint
_BESIDE = 0.12  # of the radius: rays also start so far beside the place
_MOST_TRIANGLES, _CELLS = 4000, 32  # a finer mesh hides what its cells hide


class Viewpoint(NamedTuple):
    """target: a point in the middle of the picture. radius: of what is seen around it. towards: the
    unit vector to the eye. clear: beyond this distance from the target the eye is in neither body
    of the pair."""

    target: Floats
    radius: float
    towards: Floats
    clear: float = 0.0

    def rows(self, up: str) -> Floats:
        """(3, 3): right, up, and towards the eye."""
        right = np.cross(np.eye(3)[1 if up == "y" else 2], self.towards)
        right /= np.linalg.norm(right)
        return np.stack([right, np.cross(self.towards, right), self.towards])


def directions(up: str) -> Floats:
    """Unit vectors to the eye, the first choice first."""
    angles = np.array([(yaw, pitch) for pitch, yaw in product(_PITCHES, _YAWS)])
    yaw, pitch = angles.T
    flat = np.cos(pitch)
    towards = np.stack([flat * np.cos(yaw), flat * np.sin(yaw), np.sin(pitch)], axis=1)
    return np.roll(towards, -1, axis=1) if up == "y" else towards


def of_all(bodies: Sequence[Body], up: str) -> Viewpoint:
    target, radius = sphere_around(bodies)
    return Viewpoint(target, radius, directions(up)[0])


class Viewpoints:
    """Viewpoints of pairs of a scene. Coarser meshes of its bodies are kept for further pairs."""

    def __init__(self, up: str) -> None:
        self._up, self._directions = up, directions(up)
        self._coarse = cache(_coarser)

    def of_pair(
        self,
        bodies: Iterable[Body],
        pair: Sequence[Body],
        place: Floats,
        way: Floats | None,
        *,
        through: Floats | None = None,
        also: Sequence[Floats] = (),
        tested: bool = True,
    ) -> Viewpoint:
        """bodies: of the scene. place: that is to be seen. way: to look across; None: there is
        none. through: the normal of a hole, to look at it. also: further points that are to be
        seen. tested: rays tell what hides the place."""
        target, radius = _around(pair, [place, *also])
        centres = [sphere_around([body])[0] for body in pair]
        costs = self._costs(way, centres[1] - centres[0])
        if through is not None:
            costs += _EDGEWAYS * (np.abs(self._directions @ _unit(through)) < _FACING)
        order = np.argsort(costs, kind="stable")[:_TESTED]
        if not tested:
            return Viewpoint(target, radius, self._directions[order[0]], 2.0 * radius)
        ids = {body.id for body in pair}
        others = [body for body in bodies if body.id not in ids]
        best, last = self._seen(order, costs, pair, others, place, radius)
        clear = last + float(np.linalg.norm(place - target))
        return Viewpoint(target, radius, self._directions[best], clear)

    def _costs(self, way: Floats | None, between: Floats) -> Floats:
        towards = self._directions
        costs: Floats = _UNUSUAL * (1.0 - towards @ towards[0])
        costs += _BEHIND * np.abs(towards @ _unit(between))
        costs += _BELOW * (towards[:, 1 if self._up == "y" else 2] < 0.0)
        if way is None or not way.any():
            return costs
        along = np.abs(towards @ _unit(way))
        costs[along > max(_ACROSS, along.min())] = np.inf
        return costs

    def _seen(
        self,
        order: npt.NDArray[np.int64],
        costs: Floats,
        pair: Sequence[Body],
        others: Sequence[Body],
        place: Floats,
        radius: float,
    ) -> tuple[int, float]:
        """The number of the best direction, and how far the last surface of the pair is on it."""
        boxes = boxes_of(others)
        found: list[tuple[float, int, float]] = []
        for number in order[np.isfinite(costs[order])].tolist():
            rows = Viewpoint(place, radius, self._directions[number]).rows(self._up)
            beside = _BESIDE * radius * np.array([[0, 0], [1, 0], [-1, 0], [0, 1], [0, -1]])
            starts = place + beside @ rows[:2]
            own = [_crossings(self._corners(body), starts, rows) for body in pair]
            hiding = 0.0
            for k in np.flatnonzero(_on_ray(boxes, starts, rows)).tolist():
                if hiding < _MOST_OTHERS:
                    hiding += _crossings(self._corners(others[k]), starts, rows)[0]
            cost = costs[number] + _SURFACE * sum(count for count, _ in own)
            cost += _OTHER * min(hiding, _MOST_OTHERS)
            found.append((float(cost), number, max(last for _, last in own)))
        _, number, last = min(found, key=lambda each: each[0])
        return number, last

    def _corners(self, body: Body) -> Floats:
        """Of the triangles, in the world, (n, 3, 3)."""
        coarse = self._coarse(body.file.mesh)
        placed = coarse if body.transform is None else coarse.transformed(body.transform)
        return np.asarray(placed.vertices)[np.asarray(placed.triangles)]


def _coarser(mesh: Mesh) -> Mesh:
    return simplified(mesh, _CELLS) if mesh.triangle_count > _MOST_TRIANGLES else mesh


def _around(pair: Sequence[Body], points: Sequence[Floats]) -> tuple[Floats, float]:
    """Centre and radius of what is to be seen. Beside a large body the small one says where to
    look."""
    target, radius = sphere_around(pair)
    least, size = min((sphere_around([body]) for body in pair), key=lambda each: each[1])
    if 4.0 * size < radius:
        target, radius = least, 2.0 * size
    farthest = max(float(np.linalg.norm(point - target)) for point in points)
    return target, max(radius, farthest)


def _unit(vector: Floats) -> Floats:
    length = float(np.linalg.norm(vector))
    return vector / length if length > 0.0 else vector


def _on_ray(boxes: Floats, starts: Floats, rows: Floats) -> npt.NDArray[np.bool_]:
    """Which boxes may be before one of the starts, as seen along the last of the rows."""
    middles, halves = boxes.mean(axis=1) @ rows.T, np.diff(boxes, axis=1)[:, 0] / 2 @ np.abs(rows.T)
    seen = starts @ rows.T
    low, high = seen.min(axis=0), seen.max(axis=0)
    meets = (middles - halves <= high) & (middles + halves >= low)
    before = middles[:, 2] + halves[:, 2] >= low[2]
    met: npt.NDArray[np.bool_] = meets[:, 0] & meets[:, 1] & before
    return met


def _crossings(corners: Floats, starts: Floats, rows: Floats) -> tuple[float, float]:
    """How many triangles lie between a start and the eye, in the mean of all starts, and how far
    from the start the last one is."""
    (a, b, c), seen = np.moveaxis(corners @ rows.T, 1, 0), starts @ rows.T
    sides = [_side(p, q, seen) for p, q in ((a, b), (b, c), (c, a))]
    inside = np.all([s > 0 for s in sides], axis=0) | np.all([s < 0 for s in sides], axis=0)
    triangle, start = np.nonzero(inside)
    if not len(triangle):
        return 0.0, 0.0
    weights = np.stack([sides[1], sides[2], sides[0]])[:, triangle, start]
    depths = np.stack([a[triangle, 2], b[triangle, 2], c[triangle, 2]])
    ahead = (weights * depths).sum(axis=0) / weights.sum(axis=0) - seen[start, 2]
    return float((ahead > 0.0).sum()) / len(starts), float(max(ahead.max(), 0.0))


def _side(p: Floats, q: Floats, seen: Floats) -> Floats:
    """(triangles, starts): positive to the left of the edge from p to q, as seen."""
    along, to = (q - p)[:, None, :2], seen[None, :, :2] - p[:, None, :2]
    side: Floats = along[..., 0] * to[..., 1] - along[..., 1] * to[..., 0]
    return side
