"""How thick the overlap of two solids is: twice the most that a point lies deep in both.

A ball in both shows that it is no less. That it is no more, a partition of the common part of their
boxes shows. A cell lies outside of a body, or a sum of distances from convex pieces of either
surface, with weights of sum 1, bounds the lesser depth. Such a sum is convex, so that it is
greatest at a corner of the cell. Bounds are computed in float64 with their rounding; in rationals
where that leaves them open.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction

import numpy as np

from satcheck.report.certificate import Cells, Weighted
from satcheck.verify.exact import Point, Rejected, cartesian
from satcheck.verify.pairs import index
from satcheck.verify.partition import (
    BOUNDED,
    OUTSIDE_A,
    Cell,
    Partition,
    is_outside,
)
from satcheck.verify.patches import (
    SUM_ERROR,
    TINY,
    Piece,
    Side,
    comes_within,
    lengths,
    patch_of,
)
from satcheck.verify.world import Exact


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
            self._is_clear(n, [bounded[number][0] for number, _ in places], most)
        limit = most * self.frame.scale
        for number in self._open(bounded, used, most) if bounded else ():
            cell, terms = bounded[number]
            corners = map(cartesian, cell.corners(self.frame))
            if any(self._exceeds(p, terms, limit) for p in corners):
                raise Rejected("a cell is not shown to be as thin as that")

    def _is_clear(self, n: int, cells: list[Cell], most: Fraction) -> None:
        """Rejects a plane with something of its body in front of it. Where that is looked at within
        reach only, the sum bounds depths up to that: it has to be more than `most`."""
        side = self.patches[n]
        if isinstance(side, Piece) or side.supports:
            return
        reach = side.reach
        if reach is None or Fraction(reach) - self.granted[n] <= most:
            raise Rejected("a body reaches beyond a plane that should bound it")
        if not all(side.is_clear(cell, reach) for cell in cells):
            raise Rejected("a body reaches beyond a plane next to what it should bound")

    def _exceeds(self, p: Point, terms: Weighted, limit: Fraction) -> bool:
        shares = [(patch, Fraction(weight)) for patch, weight in terms if weight]
        less = [granted * self.frame.scale for granted in self.granted]
        bounds = (w * (self.patches[n].distance(p) - less[n]) for n, w in shares)
        return sum(bounds) > limit * sum(w for _, w in shares)

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
