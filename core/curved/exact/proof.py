"""Proves along an exact axis that two bodies are separated, touching or penetrating.

Candidates for the axis are near an estimated one. Flat faces give their normals. All other contacts
depend on points and straight lines. The axis then connects two points, is perpendicular to two
lines, or connects a line to a point, perpendicular to the line.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from fractions import Fraction
from itertools import product
from typing import Literal

from msgspec import Struct

from satcheck.core.curved.exact.curved_body import CurvedBody
from satcheck.core.curved.exact.faces import Disc, Polygon, common_points
from satcheck.core.curved.exact.lattice import (
    IntVector,
    Point,
    between,
    cross,
    dot,
    gap_bounds,
    negated,
    shifted,
    shortened,
    sign_of_gap,
    sub,
)
from satcheck.core.curved.exact.polytope_body import PolytopeBody

# "free": the axis separates the bodies without a gap, and no common point was found.
Outcome = Literal["separated", "touching", "penetrating", "free"]
Gap = tuple[Fraction, Fraction]

# The number of axes, those with the least overlap, that are searched for a common inner point.
MOST_OVERLAPS = 4
# Steps of a few roundoffs of a coordinate, relative to the size of the body.
PULLS = tuple(Fraction(1, 1 << k) for k in (48, 52, 56, 60, 64))
# A share far larger than the error of a truncated irrational root.
_NEXT_TO = Fraction(1, 1 << 100)
NO_GAP: Gap = (Fraction(0), Fraction(0))


ExactBody = CurvedBody | PolytopeBody


class Proof(Struct, frozen=True):
    """axis: from A to B. gap: its bounds along the axis, in lattice units times the length of the
    axis; < 0: overlap; 0: the axis separates without a gap. point: a common point, on the lattice;
    if the bodies penetrate, it is inside A, and inside B if B has an inside. ends: a point of each
    body, connected by the axis."""

    outcome: Outcome
    axis: IntVector
    gap: Gap
    point: Point | None = None
    ends: tuple[Point, Point] | None = None


def prove(
    a: ExactBody, b: ExactBody, axes: Iterable[IntVector], *, contact: bool = True
) -> Proof | None:
    """The proof by the first axis that proves something; None: no axis does.

    Only B may be flat. contact: search a common point if there is no gap.
    """
    overlaps = []
    free: Proof | None = None
    for n in axes:
        forth, back = a.reach(n), b.reach(negated(n))
        sign = sign_of_gap(forth, back)
        if sign > 0:
            gap = gap_bounds(forth, back)
            return Proof("separated", n, gap, ends=_ends(a, b, n, gap))
        if sign == 0 and free is None:
            free = _contact(a, b, n) if contact else Proof("free", n, NO_GAP)
            if free.outcome != "free" or not contact:
                return free
        elif sign < 0:
            gap = gap_bounds(forth, back)
            overlaps.append((gap[0] * abs(gap[0]) / dot(n, n), n, gap))
    if free is not None:
        return free
    overlaps.sort(reverse=True)
    for _, n, gap in overlaps[:MOST_OVERLAPS]:
        point = _point_inside(a, b, n, gap)
        if point is not None:
            return Proof("penetrating", n, gap, point)
    return None


def _contact(a: ExactBody, b: ExactBody, n: IntVector) -> Proof:
    """Searches a common point. Without a gap every root is rational, so the faces are exact. The
    search is complete except for two discs."""
    f, g = a.face(n), b.face(negated(n))
    for p in common_points(f, g, n):
        if a.side(p) >= 0 and b.side(p) >= 0:
            return Proof("touching", n, NO_GAP, p)
    both_discs = isinstance(f, Disc) and isinstance(g, Disc)
    return Proof("free" if both_discs else "separated", n, NO_GAP)


def _ends(a: ExactBody, b: ExactBody, n: IntVector, gap: Gap) -> tuple[Point, Point] | None:
    """A point of each body, connected by the axis; None: not found. If the coordinates are
    irrational, points next to them."""
    step = gap[0] / dot(n, n)
    middles = a.middle, b.middle
    for p in common_points(a.face(n), b.face(negated(n)).moved(n, -step), n):
        q = shifted(p, n, step)
        for share in (Fraction(0), _NEXT_TO):
            ends = between(p, middles[0], share), between(q, middles[1], share)
            if a.side(ends[0]) >= 0 and b.side(ends[1]) >= 0:
                return ends
    return None


def _point_inside(a: ExactBody, b: ExactBody, n: IntVector, gap: Gap) -> Point | None:
    """A common inner point: half way between the faces, or on B if it is flat."""
    # B's face is moved into the plane of A's face. The way back is along -n.
    step = -gap[0] / dot(n, n)
    back = step if b.flat else step / 2
    for p in common_points(a.face(n), b.face(negated(n)).moved(n, step), n):
        inside = shifted(p, n, -back)
        if _is_inside(a, b, inside):
            return inside
    return next((p for p in _pulled_in(a, b, n) if _is_inside(a, b, p)), None)


def _is_inside(a: ExactBody, b: ExactBody, p: Point) -> bool:
    return a.side(p) > 0 and b.side(p) >= (not b.flat)


def _pulled_in(a: ExactBody, b: ExactBody, n: IntVector) -> Iterator[Point]:
    """Points where one body is deepest in the other, moved a little towards its middle. They help
    if a face is nearly, but not exactly, perpendicular to the axis."""
    for body, face in ((a, a.face(n)), (b, b.face(negated(n)))):
        if isinstance(face, Polygon):
            middle = body.middle
            yield from (
                between(p, middle, share)
                for p, share in product(face.points[:MOST_OVERLAPS], PULLS)
            )


def candidates(a: ExactBody, b: ExactBody, toward: IntVector) -> Iterator[IntVector]:
    """Axes along which the bodies may touch, from A to B, each once."""
    seen: set[IntVector] = set()
    for raw in _raw(a, b, toward):
        n = shortened(raw)
        if dot(n, toward) < 0:
            n = negated(n)
        if any(n) and n not in seen:
            seen.add(n)
            yield n


def _raw(a: ExactBody, b: ExactBody, toward: IntVector) -> Iterator[IntVector]:
    yield from a.normals(toward)
    yield from map(negated, b.normals(negated(toward)))
    largest = max(range(3), key=lambda k: abs(toward[k]))
    yield (int(largest == 0), int(largest == 1), int(largest == 2))
    lines_a, lines_b = a.lines(toward), b.lines(negated(toward))
    points_a, points_b = a.points(toward), b.points(negated(toward))
    for (_, along), (_, across) in product(lines_a, lines_b):
        yield cross(along, across)
    for lines, points in ((lines_a, points_b), (lines_b, points_a)):
        for (p, along), q in product(lines, points):
            yield _across(along, sub(q, p))
    for p, q in product(points_a, points_b):
        yield sub(q, p)
    yield toward


def _across(along: IntVector, step: IntVector) -> IntVector:
    """The part of a step that is perpendicular to a line, times its squared length."""
    square, share = dot(along, along), dot(along, step)
    x, y, z = (square * s - share * d for s, d in zip(step, along, strict=True))
    return x, y, z
