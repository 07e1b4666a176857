"""Whether surfaces that may be off by a little explain the overlap of two solids.

The surface of each body may be off by half of the touch band, or by its surface tolerance where
that is more. An overlap is explained where no point lies deeper than that in both. Nothing is
explained where one body passes through the other. A surface tolerance also explains nothing where a
body is no thicker than that, and where the surface of one body reaches deep into the other.

A solid passes through another one if it enters it in one place, and leaves it in another. Each body
bounds what both have in common by pieces of its surface. A passes through B where a piece of A
meets two pieces of B. Both surfaces are cut along all that they share (`cells.py`). Next to a cell
that bounds the common part, this lies on one side only. Around a stretch of an edge two such cells
follow each other: those of one surface belong to one piece, and where they are of both, a piece of
A meets one of B. Whatever is not as simple as that is rejected.

How deep a surface reaches: its triangles are halved into pieces until each shows that it is
shallow. Let a piece lie within r of a point c, and the surface of the solid be s from c. No point
of the piece is deeper than

    max |v - T|    v its corners, T a triangle of the solid: the distance to T is convex
    s + r          the distance to the surface changes by no more than the way
    r - s          where c is outside: the way to a point inside leads through the surface

nor than the length, where all corners are no farther than that from one side of the solid's box, or
beyond it. Lengths are bounded in float64 with their rounding; whether c is outside is decided in
rationals.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise
from math import gcd, lcm
from typing import Any

import numpy as np

from satcheck.report.certificate import Excuse
from satcheck.verify.cells import Cell, Contacts, chosen, sides_of
from satcheck.verify.exact import Floats, Point, Rejected, cross, dot, sub
from satcheck.verify.figures import EXACT_WIDTH
from satcheck.verify.pairs import Pair
from satcheck.verify.surfaces import (
    SUM_ERROR,
    TINY,
    Mask,
    distances,
    lengths,
    meeting,
    next_points,
    slack,
)
from satcheck.verify.thickness import at_most, holds_ball
from satcheck.verify.world import Exact, Indices, connected

# No surface may reach deeper into the other body than this, times what both may be off.
MOST_REACH = 4


def is_explained(excuse: Excuse, pair: Pair, tolerance: Fraction) -> None:
    """Rejects an excuse that does not explain the overlap. tolerance: of the touch band."""
    off_a, off_b = (max(tolerance / 2, Fraction(body.surface_tolerance)) for body in pair.placed)
    excuses = max(off_a, off_b) > tolerance / 2
    for ball, off, body in ((excuse.a, off_a, pair.a), (excuse.b, off_b, pair.b)):
        radius = Fraction(ball.radius)
        if excuses and radius <= off:
            raise Rejected("a body is not shown to be thicker than its surface may be off")
        holds_ball(body, ball.centre, radius)
    at_most(excuse.cells, pair.a, pair.b, EXACT_WIDTH * max(off_a, off_b) / 2, (off_a, off_b))
    contacts = meeting(pair.a, pair.b)
    neither_passes(pair, contacts)
    if not excuses:
        return
    most = MOST_REACH * (off_a + off_b) * (1 + EXACT_WIDTH)
    reaches_no_deeper(pair.a, pair.b, contacts, most)
    reaches_no_deeper(pair.b, pair.a, [(t, s) for s, t in contacts], most)


MOST_CELLS = 10_000
Line = tuple[Any, Any]


@dataclass(frozen=True, slots=True)
class Face:
    """A cell that bounds the common part. body: 0 or 1. shared: it lies in both surfaces; then each
    of them has such a cell there."""

    body: int
    number: int
    shared: bool


Stretch = tuple[Fraction, Fraction, Face]  # where along a line its edge starts and ends


def neither_passes(pair: Pair, contacts: Contacts) -> None:
    """Rejects two solids unless it is proven that neither passes through the other: whether faces
    that lie in both surfaces belong to both, or to none. contacts: all pairs of triangles that
    meet."""
    lines: dict[Line, list[Stretch]] = {}
    has_shared = False
    for face, polygon in _bounding(pair, contacts):
        has_shared |= face.shared
        for k, p in enumerate(polygon):
            line, *ends = _on_line(polygon[k - 1], p)
            lines.setdefault(line, []).append((min(ends), max(ends), face))
    around = [faces for stretches in lines.values() for faces in _side_by_side(stretches)]
    _no_piece_joins_two(around)
    if has_shared:
        _no_piece_joins_two([[f for f in faces if not f.shared] for faces in around])


def _no_piece_joins_two(around: list[list[Face]]) -> None:
    """around: faces next to each other."""
    by_body = [[[f.number for f in faces if f.body == body] for body in (0, 1)] for faces in around]
    beside = [pair for of_both in by_body for faces in of_both for pair in pairwise(faces)]
    joints = np.array([(one, other, other) for one, other in beside]).reshape(-1, 3).astype(int)
    piece = connected(joints, 1 + max((f.number for faces in around for f in faces), default=0))
    met: dict[int, int] = {}
    for of_a, of_b in by_body:
        if of_a and of_b:
            a, b = int(piece[of_a[0]]), int(piece[of_b[0]])
            if met.setdefault(a, b) != b or met.setdefault(b, a) != a:
                raise Rejected("one body passes through the other")


def _bounding(pair: Pair, contacts: Contacts) -> Iterator[tuple[Face, Cell]]:
    """With the corners of each."""
    views = (pair.a, pair.b, contacts), (pair.b, pair.a, [(t, s) for s, t in contacts])
    count = 0
    for body, (x, y, pairs) in enumerate(views):
        for sides in sides_of(chosen(x, y, pairs, lambda inside: inside), x, y, pairs):
            (in_front, front), (behind, back) = sides.front, sides.back
            if (front or back) and in_front == behind:
                raise Rejected("a face that bounds no material lies in the other body")
            if (True, True) not in (sides.front, sides.back):
                continue
            count += 1
            if count > MOST_CELLS:
                raise Rejected(f"the overlap has more than {MOST_CELLS:,} pieces of surface")
            yield Face(body, count, sides.front[1] != sides.back[1]), sides.cell


def _on_line(p: Point, q: Point) -> tuple[Line, Fraction, Fraction]:
    """The line through two points, which has one form only, and where they are along it."""
    step = sub(q, p)
    scale = lcm(*(c.denominator for c in step))
    whole = [int(c * scale) for c in step]
    shortest = gcd(*whole) * (1 if tuple(whole) > (0, 0, 0) else -1)
    x, y, z = (c // shortest for c in whole)
    along = x, y, z
    return (along, cross(p, along)), dot(p, along), dot(q, along)


def _side_by_side(stretches: list[Stretch]) -> Iterator[list[Face]]:
    """The faces at each stretch of a line: two, or as many places of shared ones."""
    ends = sorted({end for *both, _ in stretches for end in both})
    for start, end in pairwise(ends):
        here = [face for low, high, face in stretches if low <= start and end <= high]
        shared = [sum(face.shared and face.body == body for face in here) for body in (0, 1)]
        if len(here) - sum(shared) + max(shared) > 2:
            raise Rejected("the common part meets itself in an edge")
        yield here


MOST_PIECES = 50_000
MOST_HALVINGS = 64
# How far all halvings together round a corner, of the largest coordinate.
MIDDLE_ERROR = 2.0**-45


def reaches_no_deeper(body: Exact, solid: Exact, contacts: Contacts, length: Fraction) -> None:
    """Rejects a body unless it is proven that no point of its surface lies deeper than the length,
    world units, in the solid. contacts: all pairs of triangles that meet."""
    reach = _Reach(body, solid, float(length) * (1 - SUM_ERROR))
    inside = chosen(body, solid, contacts, lambda inside: inside)
    triangles = body.world.vertices[body.world.triangles[inside]]
    for triangle in triangles[~reach.is_shallow(triangles)]:
        reach.is_kept(triangle)


class _Reach:
    """Pieces are (3, 3) float64, no farther than `off` from the exact ones."""

    def __init__(self, body: Exact, solid: Exact, length: float) -> None:
        self.solid, self.length, self.pieces = solid, length, 0
        self.triangles: Floats = solid.world.vertices[solid.world.triangles]
        self.low, self.high = solid.world.bounds
        largest = max(np.abs(end).max() for e in (body, solid) for end in e.world.bounds)
        self.off = float(MIDDLE_ERROR * largest + TINY)

    def is_shallow(self, pieces: Floats) -> Mask:
        """Whether the box of the solid shows it, of pieces (n, 3, 3)."""
        beyond = pieces.min(axis=1) - (self.high - self.length)
        before = (self.low + self.length) - pieces.max(axis=1)
        return np.asarray((np.maximum(beyond, before) >= 2 * self.off).any(axis=1))

    def is_kept(self, triangle: Floats) -> None:
        """Rejects a triangle with a deeper point, and one that is not decided."""
        pending = [(triangle, self._near(triangle), 0)]
        while pending:
            piece, near, halvings = pending.pop()
            self.pieces += 1
            if self.pieces > MOST_PIECES or halvings > MOST_HALVINGS:
                raise Rejected(f"how deep a surface reaches is open after {self.pieces:,} pieces")
            closest = self._closest(piece, near)
            if closest is not None:
                # Across the longest edge.
                k = int(lengths(np.roll(piece, -1, axis=0) - piece).argmax())
                p, q, apex = np.roll(piece, -k, axis=0)
                middle = 0.5 * p + 0.5 * q
                halves = np.array([[p, middle, apex], [middle, q, apex]])
                left = halves[~self.is_shallow(halves)]
                pending += [(half, closest, halvings + 1) for half in left]

    def _near(self, piece: Floats) -> Indices:
        """The triangles whose boxes may be next to a point of the piece."""
        centre, radius = self._ball(piece)
        world = self.solid.world
        gaps = lengths(np.maximum(np.maximum(world.low - centre, centre - world.high), 0.0))
        surface = lengths(self.triangles[:, 0] - centre).min()
        return np.flatnonzero(gaps <= (surface + 2 * radius) * (1 + SUM_ERROR))

    def _ball(self, piece: Floats) -> tuple[Floats, float]:
        """A centre, and a radius that holds the exact piece."""
        centre = piece.mean(axis=0)
        return centre, float(lengths(piece - centre).max()) * (1 + SUM_ERROR) + 2 * self.off

    def _closest(self, piece: Floats, near: Indices) -> Indices | None:
        """The triangles that may be next to a point of the piece, of those near it; None: no point
        of the piece is deeper than the length."""
        centre, radius = self._ball(piece)
        least, most = distances(centre, self.triangles[near])
        nearest = int(most.argmin())
        surface, at_least = float(most[nearest]), float(least.min())
        if surface + radius <= self.length:
            return None
        spokes = self.triangles[near[nearest]] - piece[:, None]
        if (lengths(next_points(spokes)) + slack(spokes)).max() + self.off <= self.length:
            return None
        if at_least > self.length or radius - at_least <= self.length:
            outside = self.solid.winding(self.solid.at(centre.tolist())) == 0
            if not outside and at_least > self.length:
                raise Rejected("a thin part of a body reaches deep into the other one")
            if outside and radius - at_least <= self.length:
                return None
        kept: Indices = near[least <= (surface + 2 * radius) * (1 + SUM_ERROR)]
        return kept
