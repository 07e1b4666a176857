"""How thick the overlap of two solids is: twice the most that a point lies deep in both.

A ball in both shows that it is no less. That it is no more, a partition of the common part of their
boxes shows. A cell lies outside of a body, or a sum of distances from convex pieces of either
surface, with weights of sum 1, bounds the lesser depth. Such a sum is convex, so that it is
greatest at a corner of the cell. Bounds are computed in float64 with their rounding; in rationals
where that leaves them open.

A patch of triangles is the hull K of their corners, where seen along an axis the triangles cover
that hull: what is left of their edges where they meet runs along the hull, so they lie over all of
it equally often. A point of K and one of the triangles over the same place are no farther apart
than the `bend`. A patch may also be a plane: where nothing of the body lies in front of it, within
reach of a cell, a ball in the body around a point of the cell stays behind it, unless it is larger
than the reach.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise
from typing import Any

import numpy as np
from msgspec import UnsetType

from satcheck.report.certificate import Cells, Face, Plane, Weighted
from satcheck.verify.exact import (
    Floats,
    Point,
    Rejected,
    cartesian,
    dot,
    height,
    homogeneous,
    normal_of,
    opposite,
    root,
    sub,
)
from satcheck.verify.pairs import index
from satcheck.verify.partition import BOUNDED, OUTSIDE_A, Cell, Frame, Partition, is_outside
from satcheck.verify.surfaces import (
    DISTANCE_ERROR,
    SUM_ERROR,
    TINY,
    comes_within,
    lengths,
    next_points,
    slack,
    squared_distance,
    up,
)
from satcheck.verify.world import Corners, Exact, rounded

Seen = tuple[Any, Any]  # coordinates in a plane


def holds_ball(body: Exact, centre: Sequence[float], radius: Fraction) -> None:
    """Rejects a ball, world units, that does not lie in the solid, apart from its skin."""
    if not body.world.solid:
        raise Rejected("what is not solid has no thickness")
    at = body.at(centre)
    if not body.winding(at):
        raise Rejected("the centre of the ball lies outside of a body")
    if comes_within(body, at, radius, open_=True):
        raise Rejected("the ball reaches beyond the surface of a body")


def at_most(
    cells: Cells, a: Exact, b: Exact, most: Fraction, less: tuple[Fraction, Fraction]
) -> None:
    """Rejects cells that do not show that no point lies deeper than less[0] in A, and than less[1]
    in B, by more than `most`, which is not below 0. World units."""
    if not (a.world.solid and b.world.solid):
        raise Rejected("what is not solid has no thickness")
    partition = Partition(cells, a, b)
    partition.holds_common_part()
    sums = iter(cells.sums)
    bounded: list[tuple[Cell, Weighted]] = []
    for kind, cell in partition.leaves():
        if kind == BOUNDED:
            terms = next(sums, None)
            if terms is None:
                raise Rejected("a cell has no bound")
            if cell is not None:
                bounded.append((cell, terms))
        elif cell is not None:
            side, frame = int(kind != OUTSIDE_A), partition.frame
            around, p = (cell.box(frame), cell.half_spaces(frame)), cell.middle(frame)
            if not is_outside(partition.bodies[side], cell.near[side], *around, p):
                raise Rejected("a cell that should be outside of a body is not")
    if next(sums, None) is not None:
        raise Rejected("there are more bounds than cells")
    _Sums(cells, partition, less).are_at_most(bounded, most)


class _Sums:
    """Of bounds for how deep a point lies, less what is granted to its body."""

    def __init__(self, cells: Cells, partition: Partition, less: tuple[Fraction, Fraction]) -> None:
        self.cells, self.partition, self.frame = cells, partition, partition.frame
        sides = [int(patch.body == "b") for patch in cells.patches]
        self.patches: list[Piece | Side] = [
            patch_of(patch, partition.bodies[side], self.frame)
            for patch, side in zip(cells.patches, sides, strict=True)
        ]
        self.granted = [less[side] for side in sides]

    def are_at_most(self, bounded: list[tuple[Cell, Weighted]], most: Fraction) -> None:
        used: dict[int, list[tuple[int, float]]] = {}  # patch -> the cells, and its weights there
        for number, (_, terms) in enumerate(bounded):
            largest = max((weight for _, weight in terms), default=0)
            if largest <= 0:
                raise Rejected("the weights of a bound are 0")
            for patch, weight in terms:
                n = index(patch, len(self.patches))
                if weight:
                    used.setdefault(n, []).append((number, weight / largest))
        for n, places in used.items():
            side = self.patches[n]
            if isinstance(side, Piece) or side.supports:
                continue
            # Something of the body is in front of the plane. Where that is looked at within reach
            # only, the sum bounds depths up to that: it has to be more than `most`.
            reach = side.reach
            if reach is None or Fraction(reach) - self.granted[n] <= most:
                raise Rejected("a body reaches beyond a plane that should bound it")
            if not all(side.is_clear(bounded[number][0], reach) for number, _ in places):
                raise Rejected("a body reaches beyond a plane next to what it should bound")
        limit = most * self.frame.scale
        for number in self._open(bounded, used, most) if bounded else ():
            cell, terms = bounded[number]
            shares = [(n, Fraction(weight)) for n, weight in terms if weight]
            least = sum(w * (limit + self.granted[n] * self.frame.scale) for n, w in shares)
            for p in map(cartesian, cell.corners(self.frame)):
                if sum(w * self.patches[n].distance(p) for n, w in shares) > least:
                    raise Rejected("a cell is not shown to be as thin as that")

    def _open(
        self,
        bounded: list[tuple[Cell, Weighted]],
        used: dict[int, list[tuple[int, float]]],
        most: Fraction,
    ) -> list[int]:
        """The cells that float64 leaves open. Rounded weights are weights too: the largest is 1, so
        no sum of them is 0 or infinite."""
        corners = [cell.rounded(self.frame) for cell, _ in bounded]
        points = np.concatenate(corners)
        cell_of = np.repeat(np.arange(len(bounded)), [len(p) for p in corners])
        rows_of = np.split(np.arange(len(points)), np.flatnonzero(np.diff(cell_of)) + 1)
        is_exact = self.frame.is_plain and all(cell.faces is None for cell, _ in bounded)
        off = np.zeros(len(points)) if is_exact else 2.0**-51 * lengths(points)
        total, size, share = np.zeros((3, len(points)))
        for n, places in used.items():
            rows = np.concatenate([rows_of[number] for number, _ in places])
            weight = np.repeat([w for _, w in places], [len(rows_of[k]) for k, _ in places])
            above = self.patches[n].above(points[rows])
            terms = weight * (above + off[rows] - float(self.granted[n]) * (1 - SUM_ERROR))
            for sums, more in ((total, terms), (size, np.abs(terms)), (share, weight)):
                np.add.at(sums, rows, more)
        width = np.array([len(terms) for _, terms in bounded])[cell_of]
        error = SUM_ERROR * (1 + width / 32)  # two roundoffs for each term
        holds = total + error * size + TINY <= float(most) * (1 - error) * share
        return np.unique(cell_of[~holds]).tolist()  # type: ignore[no-any-return]


@dataclass(frozen=True, slots=True)
class Piece:
    """A hull of surface points. triangles: that it consists of, on the lattice. bend: how far its
    points may be from the surface, lattice units. scale: of the lattice."""

    triangles: list[Corners]
    bend: Fraction
    scale: int

    def distance(self, p: Point) -> Fraction:
        """On the lattice, no less than it is."""
        return min(root(squared_distance(p, t))[1] for t in self.triangles) + self.bend

    def above(self, points: Floats) -> Floats:
        """At least the distances of points (n, 3) of the world, (n,)."""
        world = np.array([[[c / self.scale for c in p] for p in t] for t in self.triangles])
        spokes = (world - points[:, None, None]).reshape(-1, 3, 3)
        most = lengths(next_points(spokes)) + slack(spokes)
        nearest: Floats = np.fmin.reduce(most.reshape(len(points), -1), axis=1)
        return nearest + up(self.bend / self.scale)


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
    count = len(body.world.triangles)
    corners = [body.corners(index(t, count)) for t in patch.triangles]
    if len(corners) == 1:
        return Piece(corners, Fraction(0), body.scale)
    return joined(corners, body.scale)


def joined(corners: list[Corners], scale: int) -> Piece:
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
    return Piece([(outline[0], p, q) for p, q in pairwise(outline[1:])], bend, scale)


def _seen(p: Any, across: int) -> Seen:
    return p[across - 2], p[across - 1]


def _covers(triangles: list[Corners], hull: list[Seen], across: int) -> None:
    """Rejects triangles that, seen along an axis, do not cover their hull."""
    edges: Counter[tuple[Seen, Seen]] = Counter()
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


def planar_hull(points: Iterable[Seen]) -> list[Seen]:
    """The corners of the convex hull of points of a plane, counterclockwise, each once; fewer than
    three where it has no inside. A. M. Andrew, "Another efficient algorithm for convex hulls in two
    dimensions" (1979)."""
    chains = []
    ordered = sorted(set(points))
    for run in (ordered, ordered[::-1]):
        chain: list[Seen] = []
        for p in run:
            while len(chain) > 1 and turn(chain[-2], chain[-1], p) <= 0:
                chain.pop()
            chain.append(p)
        chains += chain[:-1]
    return chains


def turn(p: Seen, q: Seen, x: Seen) -> Any:
    """Over 0 where x is on the left of the way from p to q."""
    return (q[0] - p[0]) * (x[1] - p[1]) - (q[1] - p[1]) * (x[0] - p[0])
