"""Scaling by powers of two, which change no digit of a float64.

They bring numbers into the range of the core. Proofs about scaled numbers hold for the original
ones.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Iterable

# Limits of exponents; numbers are below 2**exponent. The core accepts coordinates up to 1e45, which
# is more than 2**149, and sizes down to 1e-45. These limits leave room for sums of a few numbers.
_HIGHEST = 146
_LOWEST = -146
# Beyond this exponent, a float64 has too few digits, or cannot hold a sum.
_FARTHEST = 905
_SMALLEST = -1073  # of 2**-1074


def exponent_of(length: float) -> int:
    """The least k with |length| < 2**k; for 0, the k of the smallest float64."""
    return math.frexp(length)[1] if length else _SMALLEST


def exponent_into_range(low: int, high: int) -> int:
    """The k for which lengths with exponents from `low` to `high`, times 2**k, are in the range of
    the core; 0 if they already are, or if no k helps.

    Both ends are then equally far from 1. If they are too far apart, the largest lengths stay in
    the range.
    """
    if (low >= _LOWEST and high <= _HIGHEST) or low < -_FARTHEST or high > _FARTHEST:
        return 0
    return min(-(low + high) // 2, _HIGHEST - high)


def times_power(values: Iterable[float], exponent: int) -> tuple[float, ...] | None:
    """The values times 2**exponent; None if a value would lose digits."""
    given = tuple(values)
    try:
        scaled = tuple(math.ldexp(value, exponent) for value in given)
        back = tuple(math.ldexp(value, -exponent) for value in scaled)
    except OverflowError:
        return None
    return scaled if back == given else None


def limit_times_power(limit: float, exponent: int) -> float:
    """The limit times 2**exponent. On overflow, the largest float64, which no length or volume
    reaches."""
    try:
        return math.ldexp(limit, exponent)
    except OverflowError:
        return sys.float_info.max


def held_times_power(value: float, exponent: int) -> float:
    """The value times 2**exponent; nan if it is beyond float64."""
    try:
        scaled = math.ldexp(value, exponent)
    except OverflowError:
        return math.nan
    return math.nan if value and not scaled else scaled
