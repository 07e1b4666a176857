"""The face of a body along an axis: its points that are farthest along the axis, usually one.

If an axis separates two bodies without a gap, their faces lie in one plane, and the common points
of the faces are those of the bodies. This module proposes candidates, and the caller tests each
against both bodies.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from fractions import Fraction

from msgspec import Struct
from msgspec.structs import replace

from satcheck.core.curved.exact.lattice import (
    IntVector,
    Point,
    between,
    dot,
    from_rational,
    shifted,
)

Flat = tuple[Fraction, Fraction]
# Shares by which a point on the border of a polygon is moved towards its middle, tried in order.
SHARES = tuple(Fraction(1, 4**k) for k in range(1, 12))


class Polygon(Struct, frozen=True):
    """The hull of points in a plane, in any order: a point, a segment, a polygon."""

    points: tuple[Point, ...]

    def moved(self, along: IntVector, by: Fraction) -> Polygon:
        return Polygon(tuple(shifted(p, along, by) for p in self.points))

    @property
    def middle(self) -> Point:
        w = math.lcm(*(p[3] for p in self.points))
        x, y, z = (sum(p[k] * (w // p[3]) for p in self.points) for k in range(3))
        return x, y, z, w * len(self.points)


class Disc(Struct, frozen=True):
    """The image of a disc. radius: approximate, in lattice units. inverse: rows that map an offset
    from the centre to two coordinates in the frame of the shape, up to a common factor."""

    centre: Point
    radius: int
    inverse: tuple[IntVector, IntVector]

    def moved(self, along: IntVector, by: Fraction) -> Disc:
        return replace(self, centre=shifted(self.centre, along, by))

    @property
    def middle(self) -> Point:
        return self.centre

    def local(self, p: Point) -> Flat:
        c = self.centre
        step = tuple(p[k] * c[3] - c[k] * p[3] for k in range(3))
        x, y = (Fraction(dot(row, step), p[3] * c[3]) for row in self.inverse)
        return x, y


Face = Polygon | Disc


def common_points(f: Face, g: Face, axis: IntVector) -> Iterator[Point]:
    """Candidates for a common point of two faces in one plane across the axis, cheap ones first.

    If a common point exists, one candidate is common. This holds for two polygons, for a polygon
    and a disc, and for two circular discs.
    """
    yield f.middle
    yield g.middle
    if isinstance(f, Polygon) and isinstance(g, Polygon):
        yield from _of_polygons(f, g, axis)
    elif isinstance(f, Polygon):
        yield from _of_disc(g, f)  # type: ignore[arg-type]
    elif isinstance(g, Polygon):
        yield from _of_disc(f, g)
    else:
        yield between(f.centre, g.centre, Fraction(f.radius, f.radius + g.radius))


def _of_disc(disc: Disc, polygon: Polygon) -> Iterator[Point]:
    """The point of a polygon's border nearest to the middle of the disc, and points farther
    inside."""
    flat = {disc.local(p): p for p in polygon.points}
    loop = outline(flat)
    if len(loop) < 2:
        return
    feet = ((_foot(p, q), p, q) for p, q in zip(loop, loop[1:] + loop[:1], strict=True))
    _, share, p, q = min((square, share, p, q) for (square, share), p, q in feet)
    nearest = between(flat[p], flat[q], share)
    yield nearest
    yield from (between(nearest, polygon.middle, s) for s in SHARES)


def _foot(p: Flat, q: Flat) -> tuple[Fraction, Fraction]:
    """(squared distance, share of q) of the point of segment pq that is nearest to the origin."""
    x, y = q[0] - p[0], q[1] - p[1]
    share = min(max(-(p[0] * x + p[1] * y) / (x * x + y * y), Fraction(0)), Fraction(1))
    foot = p[0] + share * x, p[1] + share * y
    return foot[0] * foot[0] + foot[1] * foot[1], share


def outline(points: Iterator[Flat] | dict[Flat, Point] | list[Flat]) -> list[Flat]:
    """The corners of the convex hull of points in a plane, counter-clockwise.

    Method: A. M. Andrew, "Another Efficient Algorithm for Convex Hulls in Two Dimensions" (1979).
    """
    ordered = sorted(set(points))
    if len(ordered) < 3:
        return ordered
    chains: list[list[Flat]] = []
    for order in (ordered, ordered[::-1]):
        chain: list[Flat] = []
        for p in order:
            while len(chain) > 1 and turn(chain[-2], chain[-1], p) <= 0:
                chain.pop()
            chain.append(p)
        chains.append(chain[:-1])
    return chains[0] + chains[1]


def turn(p: Flat, q: Flat, r: Flat) -> Fraction:
    """> 0: r lies to the left of the line from p to q; 0: on it."""
    return (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])


def _of_polygons(f: Polygon, g: Polygon, axis: IntVector) -> Iterator[Point]:
    """The middle of the intersection of two polygons. One is clipped at the sides of the other."""
    high = max(range(3), key=lambda k: abs(axis[k]))
    i, j = (high + 1) % 3, (high + 2) % 3
    loops = [
        outline([(Fraction(p[i], p[3]), Fraction(p[j], p[3])) for p in h.points]) for h in (f, g)
    ]
    left, clip = sorted(loops, key=len)
    for p, q in sides(clip):
        left = _left_of(left, p, q)
    if not left:
        return
    x, y = (sum((p[k] for p in left), Fraction(0)) / len(left) for k in range(2))
    base = f.points[0]
    height = Fraction(dot(axis, base), base[3])
    rational = [x, x, x]
    rational[i], rational[j] = x, y
    rational[high] = (height - axis[i] * x - axis[j] * y) / axis[high]
    yield from_rational((rational[0], rational[1], rational[2]))


def sides(loop: list[Flat]) -> Iterator[tuple[Flat, Flat]]:
    """Lines with the polygon on their left. For a segment: the line in both directions, and the
    lines across its ends."""
    if len(loop) == 2:
        p, q = loop
        x, y = q[0] - p[0], q[1] - p[1]
        yield q, (q[0] - y, q[1] + x)
        yield p, (p[0] + y, p[1] - x)
    if len(loop) > 1:
        yield from zip(loop, loop[1:] + loop[:1], strict=True)


def _left_of(loop: list[Flat], p: Flat, q: Flat) -> list[Flat]:
    """The part of a polygon on the left of a line. I. E. Sutherland, G. W. Hodgman, "Reentrant
    Polygon Clipping" (1974)."""
    kept: list[Flat] = []
    for start, end in zip(loop, loop[1:] + loop[:1], strict=True):
        before, after = turn(p, q, start), turn(p, q, end)
        if before >= 0:
            kept.append(start)
        if (before > 0 > after) or (before < 0 < after):
            share = before / (before - after)
            kept.append(
                (start[0] + share * (end[0] - start[0]), start[1] + share * (end[1] - start[1]))
            )
    return list(dict.fromkeys(kept))
