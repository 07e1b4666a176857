"""Vectors and points of two bodies as integers, and numbers of the form q + sqrt(p).

float64 numbers are dyadic: coordinates times one power of two are integers, and Python integers
have no limit. Other points are homogeneous: (X, Y, Z, W) with W > 0 means (X, Y, Z) / W.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from fractions import Fraction

from msgspec import Struct

IntVector = tuple[int, int, int]
Point = tuple[int, int, int, int]
Rational = tuple[Fraction, Fraction, Fraction]

# Fractional bits of an irrational root when a figure is computed.
ROOT_BITS = 128


def bits_of(numbers: Iterable[float]) -> int:
    """The least k >= 0 such that all of them times 2**k are integers."""
    return max((n.as_integer_ratio()[1].bit_length() - 1 for n in numbers), default=0)


def integer(number: float, bits: int) -> int:
    """The number times 2**bits, which has to be an integer."""
    numerator, denominator = number.as_integer_ratio()
    return (numerator << bits) // denominator


def dot(p: tuple[int, ...], q: tuple[int, ...]) -> int:
    """The dot product of the first three components."""
    return p[0] * q[0] + p[1] * q[1] + p[2] * q[2]


def cross(p: IntVector, q: IntVector) -> IntVector:
    return p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]


def sub(p: IntVector, q: IntVector) -> IntVector:
    return p[0] - q[0], p[1] - q[1], p[2] - q[2]


def negated(v: IntVector) -> IntVector:
    return -v[0], -v[1], -v[2]


def combined(vectors: Iterable[IntVector], factors: Iterable[int]) -> IntVector:
    x = y = z = 0
    for v, f in zip(vectors, factors, strict=True):
        x, y, z = x + f * v[0], y + f * v[1], z + f * v[2]
    return x, y, z


def shortened(v: IntVector) -> IntVector:
    """The same direction in the smallest integers."""
    divisor = math.gcd(*v) or 1
    return v[0] // divisor, v[1] // divisor, v[2] // divisor


def shifted(p: Point, along: IntVector, by: Fraction) -> Point:
    """p + by * along."""
    u, v = by.numerator, by.denominator
    w = p[3]
    return (
        p[0] * v + along[0] * u * w,
        p[1] * v + along[1] * u * w,
        p[2] * v + along[2] * u * w,
        w * v,
    )


def between(p: Point, q: Point, share: Fraction) -> Point:
    """(1 - share) p + share q."""
    u, v = share.numerator, share.denominator
    s, t = (v - u) * q[3], u * p[3]
    return p[0] * s + q[0] * t, p[1] * s + q[1] * t, p[2] * s + q[2] * t, p[3] * q[3] * v


def from_rational(p: Rational) -> Point:
    w = math.lcm(*(c.denominator for c in p))
    return int(p[0] * w), int(p[1] * w), int(p[2] * w), w


def direction_of(v: Iterable[float]) -> IntVector:
    """Integers along a finite vector."""
    numbers = tuple(v)
    bits = bits_of(numbers)
    x, y, z = (integer(c, bits) for c in numbers)
    return shortened((x, y, z))


class Reach(Struct, frozen=True):
    """The support q + sqrt(p), p >= 0, of a body along an axis, in lattice units times the length
    of the axis."""

    q: int
    p: int = 0


def sign_of_gap(a: Reach, b: Reach) -> int:
    """The exact sign of the gap -(a + b) along n. a: the support of A along n; b: of B along -n.

    For c > 0, c - sqrt(p) - sqrt(s) has the sign of c^2 - p - s - 2 sqrt(p s). Squaring once more
    removes the last root.
    """
    c = -(a.q + b.q)
    if c < 0:
        return -1
    rest = c * c - a.p - b.p
    if rest < 0:
        return -1
    squares = rest * rest - 4 * a.p * b.p
    return (squares > 0) - (squares < 0)


def sign_of_difference(a: Reach, b: Reach) -> int:
    """The exact sign of a - b."""
    c = a.q - b.q
    if c < 0:
        return -sign_of_difference(b, a)
    # The squares of c + sqrt(p) and sqrt(s) differ by rest + 2 c sqrt(p).
    rest = c * c + a.p - b.p
    twice = 4 * c * c * a.p
    if rest >= 0:
        return int(rest > 0 or twice > 0)
    squares = twice - rest * rest
    return (squares > 0) - (squares < 0)


def gap_bounds(a: Reach, b: Reach) -> tuple[Fraction, Fraction]:
    """Bounds of the gap -(a + b)."""
    c = Fraction(-(a.q + b.q))
    roots = [root_bounds(a.p), root_bounds(b.p)]
    return c - sum(high for _, high in roots), c - sum(low for low, _ in roots)


def root_bounds(square: int) -> tuple[Fraction, Fraction]:
    """Bounds of the square root; equal if the root is an integer."""
    whole = math.isqrt(square)
    if whole * whole == square:
        return Fraction(whole), Fraction(whole)
    low = math.isqrt(square << 2 * ROOT_BITS)
    return Fraction(low, 1 << ROOT_BITS), Fraction(low + 1, 1 << ROOT_BITS)
