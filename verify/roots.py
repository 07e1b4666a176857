"""Signs of sums of square roots.

A sum of square roots of rationals, all with one sign, is rational only if each root is. So narrower
bounds find every sign except 0, and 0 comes only from exact roots.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from math import isqrt

from satcheck.verify.exact import Rejected

# Bits of the roots, in turn.
BITS = (64, 256, 1024, 4096)


@dataclass(frozen=True, slots=True)
class Reach:
    """q + sqrt(p), p >= 0."""

    q: Fraction
    p: Fraction = Fraction(0)


def root(square: Fraction, bits: int) -> tuple[Fraction, Fraction]:
    """Bounds of its root, equal if it is rational, with this many bits more than the square."""
    whole = square.numerator * square.denominator
    low = isqrt(whole)
    if low * low == whole:
        exact = Fraction(low, square.denominator)
        return exact, exact
    low = isqrt(whole << 2 * bits)
    below = square.denominator << bits
    return Fraction(low, below), Fraction(low + 1, below)


def sign_of(c: Fraction, less: Sequence[Fraction] = (), more: Sequence[Fraction] = ()) -> int:
    """The sign of c - the roots of `less` + the roots of `more`. Raises Rejected if it is too close
    to 0."""
    less, more = list(less), list(more)
    for p in [p for p in less if p in more]:
        if p in more:
            less.remove(p)
            more.remove(p)
    for bits in BITS:
        low = high = c
        for p in less:
            below, above = root(p, bits)
            low, high = low - above, high - below
        for p in more:
            below, above = root(p, bits)
            low, high = low + below, high + above
        if low > 0 or high < 0 or low == high == 0:
            return (low > 0) - (high < 0)
    raise Rejected("a length is too close to another one to be told from it")
