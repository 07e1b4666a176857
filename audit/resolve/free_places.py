"""Finds a free place for one body among others that stay, for when pushing does not help.

Each body is taken as a discrete-orientation polytope: Klosowski et al., "Efficient Collision
Detection Using Bounding Volume Hierarchies of k-DOPs" (1998), with 26 planes. Along every ray of
translations two such polytopes overlap in one interval. The first point of a ray outside of all
intervals is certainly free. The result is the shortest such translation over a fan of rays. Beyond
all other bodies one always exists, but a shorter free translation may exist. A half space has no
such polytope: along a ray a body is free of it from one point on, by its least height.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import product

import numpy as np
import numpy.typing as npt
from msgspec import Struct

from satcheck.audit.bodies.placed_body import PlacedBody
from satcheck.core.conventions import Vector
from satcheck.core.half_space import Plane, least_height, plane_of
from satcheck.core.rounding import rounding_pad
from satcheck.scene.half_spaces import is_half_space

Array = npt.NDArray[np.float64]

# Rays spread over the sphere, beside those along the normals of the planes.
SPREAD_RAYS = 100


def _unit_axes() -> Array:
    """13 of the 26 directions to the faces, edges and corners of a cube: one of each opposite
    pair."""
    directions = [v for v in product((-1, 0, 1), repeat=3) if v > (0, 0, 0)]
    return np.array([np.array(v) / math.sqrt(sum(c * c for c in v)) for v in directions])


def _spread(count: int) -> Array:
    """Nearly even on the sphere: the golden spiral."""
    k = np.arange(count) + 0.5
    z = 1.0 - 2.0 * k / count
    turn = math.pi * (1.0 + math.sqrt(5.0)) * k
    flat = np.sqrt(1.0 - z * z)
    return np.stack([flat * np.cos(turn), flat * np.sin(turn), z], axis=1)


AXES = _unit_axes()
RAYS = np.concatenate([AXES, -AXES, _spread(SPREAD_RAYS)])
# A ray that is slower along an axis is level to it.
LEVEL = 1e-12


class _Floor(Struct):
    """A half space. heights: the least heights of bodies, those that were asked for."""

    plane: Plane
    heights: dict[int, float]


class FreePlaces:
    """Free places among these bodies, which are translated from where they are placed here. Half
    spaces are not moved."""

    def __init__(self, bodies: Sequence[PlacedBody]) -> None:
        self._bodies = bodies
        self._extents: tuple[Array, Array] | None = None
        self._floors = {
            k: _Floor(plane_of(body.body.transform), {})
            for k, body in enumerate(bodies)
            if is_half_space(body.body)
        }
        ups = [floor.plane.unit for floor in self._floors.values()]
        self._rays = np.concatenate([RAYS, np.array(ups).reshape(-1, 3)])
        # (rays, 1, axes): how fast a point moves along each axis.
        self._rates = (self._rays @ AXES.T)[:, None]

    def free(
        self,
        body: int,
        others: Sequence[int],
        offsets: Sequence[Vector],
        clearances: Sequence[float],
        longest: float,
    ) -> Vector | None:
        """A translation of the body that keeps its clearance from all others, which are moved by
        their offsets. None: no ray has one of at most `longest`. World units."""
        if not others:
            return (0.0, 0.0, 0.0)
        low, high = self._placed_extents()
        chosen = np.array(others)
        moved = np.array([offsets[other] for other in others])
        shift = moved @ AXES.T
        far = max(np.abs(low).max(), np.abs(high).max()) + np.abs(moved).max()
        pad = np.array(clearances)[:, None] + 2 * rounding_pad(float(far))
        # It overlaps another one at s along a ray while below < s * rate < above on each axis.
        below = low[chosen] + shift - pad - high[body]
        above = high[chosen] + shift + pad - low[body]
        starts, stops = _intervals(below, above, self._rates)
        for k, other in enumerate(others):
            if (floor := self._floors.get(other)) is not None:
                lift = float(pad[k, 0]) - self._height(floor, body)
                starts[:, k], stops[:, k] = _below(lift, self._rays @ np.array(floor.plane.unit))
        best, way = longest, None
        for ray, start, stop in zip(self._rays, starts, stops, strict=True):
            length = _first_free(start, stop)
            if length < best or (way is None and length <= best < math.inf):
                best, way = length, ray
        return None if way is None else _point(way, best)

    def _height(self, floor: _Floor, body: int) -> float:
        if body not in floor.heights:
            placed = self._bodies[body]
            image = None if placed.curved is None else placed.curved.image
            points = np.asarray(placed.mesh.vertices)
            floor.heights[body] = least_height(floor.plane, image, points).value
        return floor.heights[body]

    def _placed_extents(self) -> tuple[Array, Array]:
        """(bodies, axes) each: the lowest and the highest projections on the axes."""
        if self._extents is None:
            along = [body.mesh.vertices @ AXES.T for body in self._bodies]
            self._extents = (
                np.stack([projections.min(axis=0) for projections in along]),
                np.stack([projections.max(axis=0) for projections in along]),
            )
        return self._extents


def _point(ray: Array, length: float) -> Vector:
    x, y, z = (float(length * c) for c in ray)
    return x, y, z


def _intervals(below: Array, above: Array, rates: Array) -> tuple[Array, Array]:
    """(starts, ends), each (rays, bodies): the interval of each ray that a body blocks."""
    level = np.abs(rates) < LEVEL
    with np.errstate(divide="ignore", invalid="ignore"):
        ends = below / rates, above / rates
    inside = (below < 0) & (above > 0)
    start = np.where(level, np.where(inside, -np.inf, np.inf), np.minimum(*ends))
    stop = np.where(level, np.where(inside, np.inf, -np.inf), np.maximum(*ends))
    return start.max(axis=2), stop.min(axis=2)


def _below(lift: float, rates: Array) -> tuple[Array, Array]:
    """(starts, ends) of each ray that a half space blocks. lift: how far the body has to rise;
    rates: how fast it rises along each ray."""
    level = np.abs(rates) < LEVEL
    with np.errstate(divide="ignore", invalid="ignore"):
        turn = lift / rates
    start = np.where(rates > 0, -np.inf, turn)
    stop = np.where(rates > 0, turn, np.inf)
    free = lift <= 0
    start = np.where(level, np.inf if free else -np.inf, start)
    stop = np.where(level, -np.inf if free else np.inf, stop)
    return start, stop


def _first_free(start: Array, stop: Array) -> float:
    """The least s >= 0 outside all intervals; inf: an interval has no end."""
    blocked = (start < stop) & (stop > 0)
    at = 0.0
    for low, high in sorted(zip(start[blocked].tolist(), stop[blocked].tolist(), strict=True)):
        if low >= at:
            break
        at = max(at, high)
    return at
