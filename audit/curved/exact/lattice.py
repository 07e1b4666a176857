"""Vectors and points of two bodies as integers.

float64 numbers are dyadic: coordinates times one power of two are integers, for which Python has no
limit. A point between them is homogeneous: (X, Y, Z, W), W > 0, stands for (X, Y, Z) / W.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from fractions import Fraction

Vector = tuple[int, int, int]
Point = tuple[int, int, int, int]
Rational = tuple[Fraction, Fraction, Fraction]


def bits_of(numbers: Iterable[float]) -> int:
    """The least k >= 0 such that all of them times 2**k are integers."""
    return max((n.as_integer_ratio()[1].bit_length() - 1 for n in numbers), default=0)


def integer(number: float, bits: int) -> int:
    """The number times 2**bits, which is one."""
    numerator, denominator = number.as_integer_ratio()
    return (numerator << bits) // denominator


def dot(p: tuple[int, ...], q: tuple[int, ...]) -> int:
    """Of the first three components."""
    return p[0] * q[0] + p[1] * q[1] + p[2] * q[2]


def cross(p: Vector, q: Vector) -> Vector:
    return p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]


def sub(p: Vector, q: Vector) -> Vector:
    return p[0] - q[0], p[1] - q[1], p[2] - q[2]


def negated(v: Vector) -> Vector:
    return -v[0], -v[1], -v[2]


def combined(vectors: Iterable[Vector], factors: Iterable[int]) -> Vector:
    x = y = z = 0
    for v, f in zip(vectors, factors, strict=True):
        x, y, z = x + f * v[0], y + f * v[1], z + f * v[2]
    return x, y, z


def shortened(v: Vector) -> Vector:
    """The same direction in the smallest integers."""
    divisor = math.gcd(*v) or 1
    return v[0] // divisor, v[1] // divisor, v[2] // divisor


def shifted(p: Point, along: Vector, by: Fraction) -> Point:
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


def of_rational(p: Rational) -> Point:
    w = math.lcm(*(c.denominator for c in p))
    return int(p[0] * w), int(p[1] * w), int(p[2] * w), w


def direction_of(v: Iterable[float]) -> Vector:
    """Integers along a finite vector."""
    numbers = tuple(v)
    bits = bits_of(numbers)
    x, y, z = (integer(c, bits) for c in numbers)
    return shortened((x, y, z))
