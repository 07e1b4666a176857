"""Numbers of the form q + sqrt(p), and the signs of their sums."""

from __future__ import annotations

import math
from fractions import Fraction

from msgspec import Struct

# Bits beyond its integer part to which an irrational root is taken where a figure is asked for.
ROOT_BITS = 128


class Reach(Struct, frozen=True):
    """q + sqrt(p), p >= 0: how far a body reaches along an axis, lattice units times its length."""

    q: int
    p: int = 0


def sign_of_gap(a: Reach, b: Reach) -> int:
    """Of -(a + b), exactly: of the gap along n, where A reaches a along n and B reaches b along -n.

    c - sqrt(p) - sqrt(s), c > 0, has the sign of c^2 - p - s - 2 sqrt(p s), and so on once more.
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
    """Of a - b, exactly."""
    c = a.q - b.q
    if c < 0:
        return -sign_of_difference(b, a)
    # c + sqrt(p) against sqrt(s): their squares differ by rest + 2 c sqrt(p).
    rest = c * c + a.p - b.p
    twice = 4 * c * c * a.p
    if rest >= 0:
        return int(rest > 0 or twice > 0)
    squares = twice - rest * rest
    return (squares > 0) - (squares < 0)


def gap_bounds(a: Reach, b: Reach) -> tuple[Fraction, Fraction]:
    """Around the same number, -(a + b)."""
    c = Fraction(-(a.q + b.q))
    roots = [root_bounds(a.p), root_bounds(b.p)]
    return c - sum(high for _, high in roots), c - sum(low for low, _ in roots)


def root_bounds(square: int) -> tuple[Fraction, Fraction]:
    """Around its square root; equal where that is an integer."""
    whole = math.isqrt(square)
    if whole * whole == square:
        return Fraction(whole), Fraction(whole)
    low = math.isqrt(square << 2 * ROOT_BITS)
    return Fraction(low, 1 << ROOT_BITS), Fraction(low + 1, 1 << ROOT_BITS)
