"""A partition of a box into convex cells by planes, walked leaf by leaf.

The tree is that of H. Fuchs, Z. Kedem, B. Naylor, "On visible surface generation by a priori tree
structures" (1980): each node halves its cell by a plane. So the leaves cover the root, wherever the
planes are. A cell without an inside is left out: the cells beside it hold its points.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import product
from typing import Any

import numpy as np

from satcheck.report import values
from satcheck.report.certificate import Cells
from satcheck.verify.exact import (
    Floats,
    Homogeneous,
    IntVector,
    Point,
    Rejected,
    cartesian,
    clipped,
    dot,
    half_space,
    height,
    homogeneous,
    opposite,
    point,
)
from satcheck.verify.world import Exact, Indices

MOST_CELLS = 100_000
# The kinds of nodes; 0 to 2: halved across this axis.
CUT, OUTSIDE_A, OUTSIDE_B, BOUNDED = 3, 4, 5, 6
# Triangles are looked through for each cell only where there are more than that.
FEW = 32
# The corners of each face of a box, by their places in a product of its ends, each edge run once in
# either direction.
BOX = ((0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3))
UNITS = ((1, 0, 0), (0, 1, 0), (0, 0, 1))
Polygon = list[Homogeneous]
Ends = tuple[Floats, Floats]


class Frame:
    """Coordinates less an origin, world units. On the lattice they are exact."""

    def __init__(self, origin: Sequence[float], k: int) -> None:
        self.scale = 1 << k
        self.floats: Floats = np.array(origin)
        self.origin = point(Fraction(c) * self.scale for c in origin)
        self.is_plain = not any(origin)

    def along(self, axis: int, place: float) -> Fraction:
        """A coordinate on the lattice."""
        return self.origin[axis] + Fraction(place) * self.scale

    def behind(self, normal: Sequence[float], height: float) -> Homogeneous:
        """The points with normal . p <= height."""
        across = point(normal)
        limit = dot(across, self.origin) + Fraction(height) * self.scale
        return half_space(across, limit)

    def box(self, low: Sequence[float], high: Sequence[float]) -> list[Homogeneous]:
        ends = zip(UNITS, low, high, strict=True)
        sides = [(self.behind(n, y), opposite(self.behind(n, x))) for n, x, y in ends]
        return [side for both in sides for side in both]


@dataclass(frozen=True, slots=True)
class Cell:
    """low, high: of a box that it lies in. cuts: half-spaces that it lies in besides, and then its
    faces, convex polygons. near: the triangles of A, and of B, that may enter it."""

    low: values.Vector
    high: values.Vector
    near: tuple[Indices, Indices]
    cuts: tuple[Homogeneous, ...] = ()
    faces: list[Polygon] | None = None

    def corners(self, frame: Frame) -> Polygon:
        if self.faces is None:
            both = enumerate(zip(self.low, self.high, strict=True))
            ends = ((frame.along(k, low), frame.along(k, high)) for k, (low, high) in both)
            return [homogeneous((x, y, z)) for x, y, z in product(*ends)]
        return list(dict.fromkeys(p for face in self.faces for p in face))

    def rounded(self, frame: Frame) -> Floats:
        """Its corners in the world, (n, 3), each coordinate rounded once."""
        if self.faces is None:
            return np.array([*product(*zip(self.low, self.high, strict=True))]) + frame.floats
        corners = self.corners(frame)
        return np.array([[c / (w * frame.scale) for c in p] for *p, w in corners])

    def half_spaces(self, frame: Frame) -> list[Homogeneous]:
        return [*frame.box(self.low, self.high), *self.cuts]

    def middle(self, frame: Frame) -> Point:
        """A point inside: about the middle, of few digits, or exactly."""
        near = point(Fraction(c) * frame.scale for c in self.rounded(frame).mean(axis=0).tolist())
        at = homogeneous(near)
        if all(height(space, at) < 0 for space in self.half_spaces(frame)):
            return near
        corners = [cartesian(p) for p in self.corners(frame)]
        return point(sum(ends) / len(corners) for ends in zip(*corners, strict=True))

    def box(self, frame: Frame) -> tuple[Floats, Floats]:
        """World coordinates that it does not reach beyond."""
        corners = self.rounded(frame)
        low, high = corners.min(axis=0), corners.max(axis=0)
        if self.faces is None and frame.is_plain:
            return low, high
        return np.nextafter(low, -np.inf), np.nextafter(high, np.inf)


class Partition:
    """The leaves are those of one walk."""

    def __init__(self, cells: Cells, a: Exact, b: Exact) -> None:
        if len(cells.cells) > MOST_CELLS:
            raise Rejected(f"a partition has at most {MOST_CELLS:,} cells")
        self.cells, self.bodies, self.frame = cells, (a, b), Frame(cells.origin, a.k)
        if not all(x < y for x, y in zip(cells.low, cells.high, strict=True)):
            raise Rejected("the box of the cells has no inside")

    def holds_common_part(self) -> None:
        """Rejects a root that leaves out a point of the boxes of both bodies."""
        for *n, limit in self.frame.box(self.cells.low, self.cells.high):
            if min(body.extent(n) for body in self.bodies) > limit:
                raise Rejected("the cells leave out a part that the bodies may share")

    def leaves(self) -> Iterator[tuple[int, Cell | None]]:
        """The kind of each leaf, and its cell; None: without an inside."""
        everything = [np.arange(len(body.world.triangles)) for body in self.bodies]
        root = Cell(self.cells.low, self.cells.high, (everything[0], everything[1]))
        pending: list[Cell | None] = [root]
        at, cuts = iter(self.cells.at), iter(self.cells.cuts)
        for kind in self.cells.cells:
            if not pending:
                raise Rejected("there are more cells than the planes make")
            cell = pending.pop()
            if kind < CUT:
                pending += reversed(self._halved(cell, kind, next(at, None)))
            elif kind == CUT:
                pending += reversed(self._cut(cell, next(cuts, None)))
            else:
                yield kind, cell
        if pending or next(at, None) is not None or next(cuts, None) is not None:
            raise Rejected("the cells are not those that the planes make")

    def _halved(self, cell: Cell | None, axis: int, place: float | None) -> list[Cell | None]:
        if place is None:
            raise Rejected("a cell is halved nowhere")
        if cell is None:
            return [None, None]
        if not cell.low[axis] < place < cell.high[axis]:
            raise Rejected("a cell is halved beside it")
        below = replace(cell, high=_with(cell.high, axis, place))
        above = replace(cell, low=_with(cell.low, axis, place))
        return self._clipped(below, above, self.frame.behind(UNITS[axis], place))

    def _cut(self, cell: Cell | None, cut: tuple[values.Vector, float] | None) -> list[Cell | None]:
        """What is behind a plane, and what is in front of it."""
        if cut is None or not any(cut[0]):
            raise Rejected("a cell is cut nowhere")
        if cell is None:
            return [None, None]
        if cell.faces is None:
            corners = cell.corners(self.frame)
            cell = replace(cell, faces=[[corners[v] for v in face] for face in BOX])
        side = self.frame.behind(*cut)
        below, above = (replace(cell, cuts=(*cell.cuts, s)) for s in (side, opposite(side)))
        return self._clipped(below, above, side)

    def _clipped(self, below: Cell, above: Cell, side: Homogeneous) -> list[Cell | None]:
        """The halves of a cell, of whose faces each takes what is on its side."""
        halves: list[Cell | None] = []
        for half, space in ((below, side), (above, opposite(side))):
            if half.faces is None:
                halves.append(self._narrowed(half))
            else:
                faces = clip(half.faces, space)
                part = None if faces is None else replace(half, faces=faces)
                halves.append(part and self._narrowed(part))
        return halves

    def _narrowed(self, cell: Cell) -> Cell:
        """Without triangles that do not enter it any more, if there are many."""
        if max(map(len, cell.near)) <= FEW:
            return cell
        low, high = cell.box(self.frame)
        near = [within(b, t, low, high) for b, t in zip(self.bodies, cell.near, strict=True)]
        return replace(cell, near=(near[0], near[1]))


def _with(ends: values.Vector, axis: int, place: float) -> values.Vector:
    x, y, z = (place if k == axis else end for k, end in enumerate(ends))
    return x, y, z


def within(body: Exact, triangles: Any, low: Floats, high: Floats) -> Indices:
    """Those of the triangles whose boxes have a point inside the box."""
    world = body.world
    meets = (world.low[triangles] < high) & (world.high[triangles] > low)
    near: Indices = triangles[meets.all(axis=1)]
    return near


def clip(faces: list[Polygon], space: Homogeneous) -> list[Polygon] | None:
    """The faces of the part of a convex polyhedron in a half-space; None: it has no inside."""
    heights = {p: height(space, p) for face in faces for p in face}
    if min(heights.values()) >= 0:
        return None
    if max(heights.values()) <= 0:
        return faces
    parts = (clipped(face, space) if max(heights[p] for p in face) > 0 else face for face in faces)
    kept = [part for part in parts if len(part) > 2]
    # The new face runs along the others, in the other direction.
    after = {
        p: q
        for face in kept
        for q, p in zip((face[-1], *face), face, strict=False)
        if heights.get(q, 0) == 0 == heights.get(p, 0)
    }
    cap = [next(iter(after))]
    while (p := after[cap[-1]]) != cap[0]:
        cap.append(p)
    return [*kept, cap]


def enters(triangle: Sequence[IntVector], spaces: Sequence[Homogeneous]) -> bool:
    """Whether a triangle has a point in the open cell that these half-spaces bound."""
    region: Polygon = [(*p, 1) for p in triangle]
    for space in spaces:
        heights = [height(space, p) for p in region]
        if min(heights) >= 0:
            return False
        if max(heights) > 0:
            region = clipped(region, space)
    # The middle of the region is as far in as any of its points.
    return all(any(height(space, p) < 0 for p in region) for space in spaces)


def is_outside(
    body: Exact, triangles: Indices, box: Ends, spaces: Sequence[Homogeneous], p: Point
) -> bool:
    """Whether an open cell lies outside of the body. triangles: that may enter it. box: world
    coordinates that it does not reach beyond. p: a point of it, or at its border."""
    near = within(body, triangles, *box)
    if any(enters(body.corners(t), spaces) for t in near.tolist()):
        return False
    return body.winding(p) == 0
