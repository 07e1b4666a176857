"""Exact arithmetic: float64 numbers are dyadic, so scaled by one power of two they are integers."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import chain, combinations
from math import gcd, isqrt, lcm
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
IntVector = tuple[int, int, int]
Point = tuple[Fraction, Fraction, Fraction]
Vector = tuple[Any, Any, Any]  # of integers or rationals
Homogeneous = tuple[int, int, int, int]

Key = TypeVar("Key")
Item = TypeVar("Item")
UNITS = ((1, 0, 0), (0, 1, 0), (0, 0, 1))
ROOT_BITS = 128
# Bits of the roots of a sum, in turn.
BITS = (64, 256, 1024, 4096)


class Rejected(Exception):
    """A claim that its certificate does not prove, in one sentence."""


class TooMany(Rejected):
    """A claim whose check would take too long."""


class NotCertified(Exception):
    """A claim that may be true, but that nothing here proves."""


def lattice(*arrays: Floats) -> int:
    """The least k >= 0 such that all these numbers times 2**k are integers."""
    numbers = (c for array in arrays for c in array.ravel().tolist())
    return max((c.as_integer_ratio()[1] for c in numbers), default=1).bit_length() - 1


def integers(array: Floats, k: int) -> list[IntVector]:
    """The rows of an (n, 3) array times 2**k, for a k that makes them integers."""

    def whole(number: float) -> int:
        over, under = number.as_integer_ratio()
        return (over << k) // under

    return [(whole(x), whole(y), whole(z)) for x, y, z in array.tolist()]


def point(p: Iterable[Any]) -> Point:
    """Three numbers, each exactly."""
    x, y, z = map(Fraction, p)
    return x, y, z


def grouped(pairs: Iterable[tuple[Key, Item]]) -> dict[Key, list[Item]]:
    """The second parts of pairs, by their first ones."""
    groups: dict[Key, list[Item]] = {}
    for key, item in pairs:
        groups.setdefault(key, []).append(item)
    return groups


def sub(p: Vector, q: Vector) -> Vector:
    return p[0] - q[0], p[1] - q[1], p[2] - q[2]


def dot(p: Sequence[Any], q: Sequence[Any]) -> Any:
    return p[0] * q[0] + p[1] * q[1] + p[2] * q[2]


def cross(p: Vector, q: Vector) -> Vector:
    return (
        p[1] * q[2] - p[2] * q[1],
        p[2] * q[0] - p[0] * q[2],
        p[0] * q[1] - p[1] * q[0],
    )


def normal_of(t: Sequence[Vector]) -> Vector:
    """The normal of a triangle, twice as long as its area; 0 where it has none."""
    return cross(sub(t[1], t[0]), sub(t[2], t[0]))


def sign(number: int | Fraction) -> int:
    return int(number > 0) - int(number < 0)


def homogeneous(p: Vector) -> Homogeneous:
    """(X, Y, Z, W) with p = (X, Y, Z) / W, W > 0, without a common divisor."""
    w = lcm(*(c.denominator for c in p))
    return int(p[0] * w), int(p[1] * w), int(p[2] * w), w


def cartesian(p: Homogeneous) -> Point:
    x, y, z, w = p
    return Fraction(x, w), Fraction(y, w), Fraction(z, w)


def half_space(normal: Vector, limit: Any) -> Homogeneous:
    """(n, d) of integers, for the points with n . x <= d."""
    w = lcm(limit.denominator, *(c.denominator for c in normal))
    return int(normal[0] * w), int(normal[1] * w), int(normal[2] * w), int(limit * w)


def opposite(space: Homogeneous) -> Homogeneous:
    x, y, z, limit = space
    return -x, -y, -z, -limit


def height(space: Homogeneous, p: Homogeneous) -> int:
    """Over 0 beyond a half-space."""
    return space[0] * p[0] + space[1] * p[1] + space[2] * p[2] - space[3] * p[3]


def clipped(region: Sequence[Homogeneous], space: Homogeneous) -> list[Homogeneous]:
    """The part of a convex polygon, segment or point in a half-space. I. E. Sutherland, G. W.
    Hodgman, "Reentrant Polygon Clipping" (1974)."""
    heights = [height(space, p) for p in region]
    kept: list[Homogeneous] = []
    for k, (p, h) in enumerate(zip(region, heights, strict=True)):
        q, g = region[k - 1], heights[k - 1]
        if (g < 0 < h) or (h < 0 < g):
            x, y, z, w = (abs(h) * c + abs(g) * d for c, d in zip(q, p, strict=True))
            divisor = gcd(x, y, z, w)
            kept.append((x // divisor, y // divisor, z // divisor, w // divisor))
        if h <= 0:
            kept.append(p)
    return [p for k, p in enumerate(kept) if p != kept[k - 1]] or kept[:1]


def half_spaces(t: Sequence[Vector]) -> list[Homogeneous]:
    """Half-spaces whose intersection is the closed triangle, which may be a segment or a point; of
    one with an area first those of its plane, then those of its edges."""
    n = normal_of(t)
    if any(n):
        planes = [(n, t[0])]
        ends = [(cross(sub(t[(k + 1) % 3], p), n), p) for k, p in enumerate(t)]
    else:
        spans = [(p, q) for p in t for q in t if p != q]
        p, q = max(spans, key=lambda s: dot(sub(*s), sub(*s)), default=(t[0], t[0]))
        along = sub(q, p)
        planes = [(cross(along, u) if any(along) else u, p) for u in UNITS]
        ends = [(along, q), (sub(p, q), p)]
    both = [half_space(v, dot(v, p)) for v, p in planes]
    return [*both, *map(opposite, both), *(half_space(v, dot(v, p)) for v, p in ends)]


def nearest_to_origin(points: Sequence[IntVector]) -> tuple[Point, dict[int, Fraction]]:
    """The point of the hull of a few points nearest to the origin, with its weights.

    By trying every subset of up to four: the nearest point x is a convex combination of one of
    them, and the one for which no point v has v.x < x.x.
    """
    for chosen in chain.from_iterable(combinations(range(len(points)), n) for n in range(1, 5)):
        weights = _foot([points[k] for k in chosen])
        if weights is not None and min(weights) >= 0:
            shares = dict(zip(chosen, weights, strict=True))
            x = point(sum(w * points[k][axis] for k, w in shares.items()) for axis in range(3))
            if all(dot(v, x) >= dot(x, x) for v in points):
                return x, shares
    raise ValueError("the hull of no points has no nearest point")


def _foot(points: Sequence[IntVector]) -> list[Fraction] | None:
    """Weights, of sum 1, of the foot of the origin on the flat through these points; None where
    they do not span it."""
    edges = [sub(p, points[0]) for p in points[1:]]
    gram = [[Fraction(dot(e, f)) for f in edges] + [Fraction(-dot(e, points[0]))] for e in edges]
    n = len(edges)
    for k in range(n):  # the Gram matrix is positive definite, or else some pivot is 0
        if gram[k][k] == 0:
            return None
        for i in range(n):
            if i != k:
                factor = gram[i][k] / gram[k][k]
                gram[i] = [x - factor * y for x, y in zip(gram[i], gram[k], strict=True)]
    rest = [gram[k][n] / gram[k][k] for k in range(n)]
    return [1 - sum(rest, Fraction()), *rest]


def root(square: Fraction, bits: int = ROOT_BITS) -> tuple[Fraction, Fraction]:
    """Bounds of its root, equal if it is rational; else no farther apart than 2**-bits of it."""
    whole = square.numerator * square.denominator
    low = isqrt(whole)
    if low * low == whole:
        exact = Fraction(low, square.denominator)
        return exact, exact
    low = isqrt(whole << 2 * bits)
    below = square.denominator << bits
    return Fraction(low, below), Fraction(low + 1, below)


@dataclass(frozen=True, slots=True)
class Reach:
    """q + sqrt(p), p >= 0."""

    q: Fraction
    p: Fraction = Fraction(0)


def sign_of(c: Fraction, less: Sequence[Fraction] = (), more: Sequence[Fraction] = ()) -> int:
    """The sign of c - the roots of `less` + the roots of `more`. Raises Rejected if it is too close
    to 0.

    A sum of square roots of rationals, all with one sign, is rational only if each root is. So
    narrower bounds find every sign except 0, and 0 comes only from exact roots.
    """
    count = Counter(more)
    count.subtract(less)
    for bits in BITS:
        roots = [(root(p, bits), n) for p, n in count.items()]
        # The lower end of a root that is added, the upper one of a root that is taken away.
        low = c + sum(n * ends[n < 0] for ends, n in roots)
        high = c + sum(n * ends[n > 0] for ends, n in roots)
        if low > 0 or high < 0 or low == high == 0:
            return (low > 0) - (high < 0)
    raise Rejected("a length is too close to another one to be told from it")
