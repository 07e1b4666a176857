"""Exact relation and signed distance of two convex hulls of any size, in integers and fractions.

The float64 coordinates are scaled to integers by one power of two. Then two loops that rounding
cannot break, because there is none:

- the nearest point of A - B to the origin by P. Wolfe, "Finding the Nearest Point in a Polytope"
  (1976), which ends with v.w >= v.v for every vertex w: a proof of its own result;
- the facet of A - B nearest to an origin inside it by growing an inner polytope (G. van den Bergen,
  "Proximity Queries and Penetration Depth Computation on 3D Game Objects", 2001), which ends when
  its nearest facet supports A - B: a proof likewise. A face counts as seen by the new vertex where
  that lies on its plane too, so that no face ever has area 0.

Both ask A - B for support points alone; no hull is computed. `exact_pair` finds the same by
exhaustion, for small sets.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import combinations

Integers = tuple[int, int, int]
Rational = tuple[Fraction, Fraction, Fraction]

# An irrational root is enclosed to this many bits: far below every float64 it is compared with.
ROOT_BITS = 256


@dataclass(frozen=True, slots=True)
class Truth:
    """outcome as `core.PairResult` names it. The signed distance lies in [low, high]: a gap > 0,
    minus the depth < 0. The ends are equal where it is rational, else relatively 2^-250 apart."""

    outcome: str
    low: Fraction
    high: Fraction

    @property
    def depth(self) -> Fraction:
        """Upper end."""
        return max(-self.low, Fraction(0))

    def error_of(self, distance: float) -> float:
        """|distance - truth|, rounded once."""
        return float(abs(Fraction(distance) - self.low))


def exact_truth(points_a: Iterable[Sequence[float]], points_b: Iterable[Sequence[float]]) -> Truth:
    """The relation of the hulls of two point sets (n, 3), (m, 3), float64 taken as they are.

    "touching": a common point, but no common interior; a flat A - B has no interior.
    """
    difference = Difference(points_a, points_b)
    squared_depth = difference.squared_depth()
    if squared_depth > 0:
        low, high = root(squared_depth)
        return Truth("penetrating", -high, -low)
    squared = difference.squared_distance()
    return Truth("separated" if squared > 0 else "touching", *root(squared))


def root(square: Fraction) -> tuple[Fraction, Fraction]:
    """Bounds of the square root: equal where it is rational."""
    n, d = square.numerator, square.denominator
    shift = max(0, ROOT_BITS + (d.bit_length() - n.bit_length()) // 2)
    scaled = n * d << 2 * shift
    below = math.isqrt(scaled)
    above = below if below * below == scaled else below + 1
    return Fraction(below, d << shift), Fraction(above, d << shift)


class Difference:
    """The Minkowski difference A - B by its vertices, all integers over one power of two."""

    def __init__(
        self, points_a: Iterable[Sequence[float]], points_b: Iterable[Sequence[float]]
    ) -> None:
        a, b = ({tuple(float(c) for c in p) for p in points} for points in (points_a, points_b))
        self.scale = max(c.as_integer_ratio()[1] for p in a | b for c in p)
        self._a, self._b = ([self._integers(p) for p in sorted(points)] for points in (a, b))

    def _integers(self, point: tuple[float, ...]) -> Integers:
        x, y, z = (n * (self.scale // d) for n, d in (c.as_integer_ratio() for c in point))
        return x, y, z

    def support(self, n: Integers) -> Integers:
        """The vertex farthest along n."""
        return sub(max(self._a, key=lambda p: dot(n, p)), min(self._b, key=lambda p: dot(n, p)))

    def squared_distance(self) -> Fraction:
        """Square of the distance of A and B; 0 where they have a common point."""
        nearest = nearest_point(self)
        return inner(nearest, nearest) / self.scale**2

    def squared_depth(self) -> Fraction:
        """Square of the penetration depth; 0 where A and B have no common interior."""
        start = self._tetrahedron()
        return nearest_facet(self, start) / self.scale**2 if start else Fraction(0)

    def _tetrahedron(self) -> list[Integers]:
        """Four points of A - B that span a volume; empty where it is flat."""
        first = sub(self._a[0], self._b[0])
        others = [sub(p, self._b[0]) for p in self._a] + [sub(self._a[0], p) for p in self._b]
        corners = [first]
        for p in others:
            edges = [sub(q, first) for q in (*corners[1:], p)]
            if len(edges) == 1:
                spans = any(edges[0])
            elif len(edges) == 2:
                spans = any(cross(edges[0], edges[1]))
            else:
                spans = dot(cross(edges[0], edges[1]), edges[2]) != 0
            if spans:
                corners.append(p)
            if len(corners) == 4:
                return corners
        return []


def nearest_point(difference: Difference) -> Rational:
    """The point of A - B nearest to the origin."""
    corral = [difference.support((1, 0, 0))]
    weights = [Fraction(1)]
    while True:
        v = combination(corral, weights)
        w = difference.support(direction_against(v))
        if not any(v) or inner(v, w) >= inner(v, v):
            return v
        corral.append(w)
        weights.append(Fraction(0))
        corral, weights = settle(corral, weights)


def settle(
    corral: list[Integers], weights: list[Fraction]
) -> tuple[list[Integers], list[Fraction]]:
    """Wolfe's minor cycle: towards the affine optimum, dropping vertices whose weight vanishes."""
    while True:
        aim = affine_optimum(corral)
        if all(a > 0 for a in aim):
            return corral, aim
        step = min(w / (w - a) for w, a in zip(weights, aim, strict=True) if a <= 0 and w > a)
        weights = [w + step * (a - w) for w, a in zip(weights, aim, strict=True)]
        # A vertex of weight 0 that the optimum wants stays.
        kept = [w > 0 or a > 0 for w, a in zip(weights, aim, strict=True)]
        corral = [p for p, keep in zip(corral, kept, strict=True) if keep]
        weights = [w for w, keep in zip(weights, kept, strict=True) if keep]


def affine_optimum(points: list[Integers]) -> list[Fraction]:
    """Weights, of sum 1, of the point of the affine hull of `points` nearest to the origin."""
    first = points[0]
    edges = [sub(p, first) for p in points[1:]]
    rows = [[Fraction(dot(e, f)) for f in edges] + [Fraction(-dot(e, first))] for e in edges]
    for i in range(len(rows)):  # Gram matrices of independent edges: no pivot is 0
        for j in range(len(rows)):
            if i != j:
                factor = rows[j][i] / rows[i][i]
                rows[j] = [x - factor * y for x, y in zip(rows[j], rows[i], strict=True)]
    rest = [row[-1] / row[i] for i, row in enumerate(rows)]
    return [1 - sum(rest, Fraction(0)), *rest]


def combination(points: list[Integers], weights: list[Fraction]) -> Rational:
    x, y, z = (
        sum((w * p[i] for p, w in zip(points, weights, strict=True)), Fraction(0)) for i in range(3)
    )
    return x, y, z


def direction_against(v: Rational) -> Integers:
    """An integer vector along -v."""
    common = math.lcm(*(c.denominator for c in v))
    x, y, z = (-int(c * common) for c in v)
    return x, y, z


@dataclass(frozen=True, slots=True)
class Facet:
    """corners counter-clockwise from outside; normal . p = height on its plane."""

    corners: tuple[Integers, Integers, Integers]
    normal: Integers
    height: int

    @property
    def edges(self) -> tuple[tuple[Integers, Integers], ...]:
        p, q, r = self.corners
        return (p, q), (q, r), (r, p)


def facet(p: Integers, q: Integers, r: Integers) -> Facet:
    normal = cross(sub(q, p), sub(r, p))
    return Facet((p, q, r), normal, dot(normal, p))


def nearest_facet(difference: Difference, corners: list[Integers]) -> Fraction:
    """Square of the distance from the origin to the boundary of A - B, 0 where it is not inside."""
    facets = {}
    for p, q, r in combinations(corners, 3):
        (opposite,) = (c for c in corners if c not in (p, q, r))
        f = facet(p, q, r)
        if dot(f.normal, opposite) > f.height:
            f = facet(p, r, q)
        facets[f] = signed_square(f)
    while True:
        nearest = min(facets, key=facets.__getitem__)
        w = difference.support(nearest.normal)
        reach = dot(nearest.normal, w)
        if reach <= 0:
            return Fraction(0)
        if reach == nearest.height:
            return facets[nearest]
        seen = [f for f in facets if dot(f.normal, w) >= f.height]
        edges = {edge for f in seen for edge in f.edges}
        for f in seen:
            del facets[f]
        for tail, head in edges:
            if (head, tail) not in edges:
                f = facet(tail, head, w)
                facets[f] = signed_square(f)


def signed_square(f: Facet) -> Fraction:
    """Square of the signed distance of the plane from the origin, with its sign."""
    return Fraction(f.height * abs(f.height), dot(f.normal, f.normal))


def sub(a: Integers, b: Integers) -> Integers:
    return a[0] - b[0], a[1] - b[1], a[2] - b[2]


def dot(a: Integers, b: Integers) -> int:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def inner(a: Rational, b: Rational | Integers) -> Fraction:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a: Integers, b: Integers) -> Integers:
    return (
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    )
