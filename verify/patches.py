"""Convex pieces of a surface, and how far points are from them: bounds from above.

A patch of triangles is the hull K of their corners, where seen along an axis the triangles cover
that hull: what is left of their edges where they meet runs along the hull, so they lie over all of
it equally often. A point of K and one of the triangles over the same place are no farther apart
than the `bend`. A patch may also be a plane: where nothing of the body lies in front of it, within
reach of a cell, a ball in the body around a point of the cell stays behind it, unless it is larger
than the reach.
"""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise
from typing import Any

import numpy as np
from msgspec import UnsetType

from satcheck.report.certificate import Face, Plane
from satcheck.verify.exact import (
    Floats,
    Pair,
    Point,
    Rejected,
    dot,
    height,
    homogeneous,
    integers,
    nearest_to_origin,
    normal_of,
    opposite,
    planar_hull,
    root,
    sub,
    turn,
)
from satcheck.verify.pairs import index
from satcheck.verify.partition import Cell, Frame, is_outside
from satcheck.verify.surfaces import up
from satcheck.verify.world import Corners, Exact, rounded

# How far rounding takes the distance of a point and a triangle, or a plane, of the longest line
# from the point to a corner: fewer than 60 roundings in the point next to it and in its length.
DISTANCE_ERROR = 2.0**-46
TINY = 2.0**-1000  # more than what underflow takes
# How far rounding takes a weighted sum, of the sum of its terms without their signs.
SUM_ERROR = 2.0**-46


@dataclass(frozen=True, slots=True)
class Piece:
    """A hull of surface points. triangles: that it consists of, on the lattice. bend: how far its
    points may be from the surface, lattice units. floats: the triangles in the world, (n, 3, 3)."""

    triangles: list[Corners]
    bend: Fraction
    floats: Floats
    k: int

    def distance(self, p: Point) -> Fraction:
        """On the lattice, no less than it is."""
        return min(root(squared_distance(p, t))[1] for t in self.triangles) + self.bend

    def above(self, points: Floats) -> Floats:
        """At least the distances of points (n, 3) of the world, (n,)."""
        spokes = (self.floats - points[:, None, None]).reshape(-1, 3, 3)
        most = lengths(next_points(spokes)) + slack(spokes)
        nearest: Floats = np.fmin.reduce(most.reshape(len(points), -1), axis=1)
        return nearest + up(self.bend / (1 << self.k))


class Side:
    """A plane, and what is behind it: normal . p <= height, in the coordinates of the frame."""

    def __init__(self, plane: Plane, body: Exact, frame: Frame) -> None:
        if not any(plane.normal):
            raise Rejected("a plane has a normal")
        self.body, self.frame = body, frame
        self.space = frame.behind(plane.normal, plane.height)
        *self.normal, self.limit = self.space
        self.reach = None if isinstance(plane.reach, UnsetType) else plane.reach
        direction = rounded(plane.normal)
        length = float(np.linalg.norm(direction))
        self.direction: Floats = direction / length
        largest = max(abs(c) for c in plane.normal)
        self.height = float(Fraction(plane.height) / Fraction(largest) / Fraction(length))

    def distance(self, p: Point) -> Fraction:
        """How far behind the plane, on the lattice, no less than it is; below 0 in front of it."""
        behind = self.limit - dot(self.normal, p)
        squared = Fraction(behind) ** 2 / dot(self.normal, self.normal)
        return root(squared)[1] if behind >= 0 else -root(squared)[0]

    def above(self, points: Floats) -> Floats:
        """At least how far points (n, 3) of the world are behind the plane, (n,)."""
        local = points - self.frame.floats
        heights: Floats = self.height - local @ self.direction
        return heights + slack(local[:, None]) + DISTANCE_ERROR * abs(self.height)

    @property
    def supports(self) -> bool:
        """Whether nothing of the body lies in front of the plane."""
        return bool(self.body.extent(self.normal) <= self.limit)

    def is_clear(self, cell: Cell, reach: float) -> bool:
        """Whether nothing of the body lies in front of the plane and within reach of the box of the
        cell."""
        low, high = cell.box(self.frame)
        low, high = np.nextafter(low - reach, -np.inf), np.nextafter(high + reach, np.inf)
        lattice = [[Fraction(c) * self.frame.scale for c in end.tolist()] for end in (low, high)]
        x, y, z = (lattice[c > 0][k] for k, c in enumerate(self.normal))
        if height(self.space, homogeneous((x, y, z))) <= 0:
            return True
        world = Frame((0.0, 0.0, 0.0), self.body.k)
        spaces = [opposite(self.space), *world.box(low.tolist(), high.tolist())]
        everything = np.arange(len(self.body.world.triangles))
        return is_outside(self.body, everything, (low, high), spaces, (x, y, z))


def patch_of(patch: Face | Plane, body: Exact, frame: Frame) -> Piece | Side:
    if isinstance(patch, Plane):
        return Side(patch, body, frame)
    if not patch.triangles:
        raise Rejected("a patch has a triangle")
    numbers = [index(t, len(body.world.triangles)) for t in patch.triangles]
    corners = [body.corners(t) for t in numbers]
    if len(corners) == 1:
        floats = body.world.vertices[body.world.triangles[numbers]]
        return Piece(corners, Fraction(0), floats, body.k)
    return joined(numbers, corners, body)


def joined(numbers: list[int], corners: list[Corners], body: Exact) -> Piece:
    """The hull of triangles that fill one. Rejects others."""
    normal = next((n for t in corners if any(n := normal_of(t))), (0, 0, 0))
    across = max(range(3), key=lambda k: abs(normal[k]))
    if normal[across] == 0:
        raise Rejected("a patch has an area")
    place = {_seen(p, across): p for t in corners for p in t}
    hull = planar_hull(place)
    _covers(corners, hull, across)
    heights = [dot(normal, sub(p, corners[0][0])) for t in corners for p in t]
    bend = Fraction(max(heights) - min(heights), abs(normal[across]))
    outline = [place[p] for p in hull]
    fan = [(outline[0], p, q) for p, q in pairwise(outline[1:])]
    row = {
        p: v
        for t, n in zip(corners, numbers, strict=True)
        for p, v in zip(t, body.world.triangles[n].tolist(), strict=True)
    }
    floats = body.world.vertices[[[row[p] for p in t] for t in fan]]
    return Piece(fan, bend, floats, body.k)


def _seen(p: Any, across: int) -> Pair:
    return p[across - 2], p[across - 1]


def _covers(triangles: list[Corners], hull: list[Pair], across: int) -> None:
    """Rejects triangles that, seen along an axis, do not cover their hull."""
    edges: Counter[tuple[Pair, Pair]] = Counter()
    area = 0
    for t in triangles:
        p, q, r = (_seen(c, across) for c in t)
        area += turn(p, q, r)
        edges.update(((p, q), (q, r), (r, p)))
    sides = [(hull[k - 1], p) for k, p in enumerate(hull)]
    for (p, q), count in edges.items():
        if count != edges[q, p] and not any(turn(*s, p) == 0 == turn(*s, q) for s in sides):
            raise Rejected("the triangles of a patch do not fill a convex polygon")
    if area == 0:
        raise Rejected("the triangles of a patch cover nothing")


def comes_within(body: Exact, p: Point, length: Fraction, *, open_: bool) -> bool:
    """Whether the surface of a body comes within a length, world units, of a point of the lattice.
    open_: or nearer than that."""
    world, scale = body.world, body.scale
    at = np.array([float(Fraction(c) / scale) for c in p])
    radius = up(length) + float(lengths(np.spacing(np.abs(at))))
    gaps = np.maximum(np.maximum(world.low - at, at - world.high), 0.0)
    near = np.flatnonzero(~(lengths(gaps) > radius * (1 + SUM_ERROR)))
    least, _ = distances(at, world.vertices[world.triangles[near]])
    most = (length * scale) ** 2
    for t in near[least < radius].tolist():
        i, j, k = integers(world.vertices[world.triangles[t]], body.k)
        squared = squared_distance(p, (i, j, k))
        if squared < most or (squared == most and not open_):
            return True
    return False


def squared_distance(p: Point, triangle: Corners) -> Fraction:
    """Exactly."""
    x, y, z, w = homogeneous(p)
    spokes = [(v[0] * w - x, v[1] * w - y, v[2] * w - z) for v in triangle]
    foot, _ = nearest_to_origin(spokes)
    return Fraction(dot(foot, foot)) / (w * w)


def next_points(spokes: Floats) -> Floats:
    """Points of triangles (n, 3, 3) that are about next to the origin, (n, 3): on the nearest edge,
    or the foot of the perpendicular."""
    heads = np.roll(spokes, -1, axis=1)
    along = heads - spokes
    with np.errstate(all="ignore"):
        share = -_dots(spokes, along) / _dots(along, along)
        share = np.clip(np.nan_to_num(share), 0.0, 1.0)
        feet = spokes + share[..., None] * along
        nearest = _dots(feet, feet).argmin(axis=1)
        best = np.take_along_axis(feet, nearest[:, None, None], axis=1)[:, 0]
        normal = np.cross(along[:, 0], along[:, 1])
        # The part of each triangle that the origin and an edge span, seen along the normal.
        parts = _dots(np.cross(spokes, heads), normal[:, None])
        inside = np.asarray((parts > 0).all(axis=1))
        weights = np.roll(parts, -1, axis=1) / parts.sum(axis=1, keepdims=True)
        foot = np.einsum("nk,nkj->nj", weights, spokes)
    chosen: Floats = np.where(inside[:, None], foot, best)
    return chosen


def distances(point: Floats, triangles: Floats) -> tuple[Floats, Floats]:
    """Bounds of the distances of a point (3,) from triangles (n, 3, 3), (n,)."""
    spokes = triangles - point
    nearest, error = next_points(spokes), slack(spokes)
    most = lengths(nearest)
    with np.errstate(all="ignore"):
        heights = np.einsum("nkj,nj->nk", spokes, nearest / most[:, None]).min(axis=1)
    least = np.nan_to_num(heights - error, nan=0.0)
    return np.maximum(least, 0.0), most + error


def slack(spokes: Floats) -> Floats:
    """How far rounding takes a length that is computed from lines to corners, (n, m, 3), (n,)."""
    longest: Floats = lengths(spokes).max(axis=1)
    return DISTANCE_ERROR * longest + TINY


def lengths(p: Floats) -> Floats:
    """The lengths of vectors (..., 3), a few roundoffs off. Their squares may be no floats."""
    lengths: Floats = np.hypot(np.hypot(p[..., 0], p[..., 1]), p[..., 2])
    return lengths


def _dots(p: Floats, q: Floats) -> Floats:
    products: Floats = np.einsum("...k,...k->...", p, q)
    return products
