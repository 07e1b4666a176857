"""Powers of two: the scales that change no digit of a float64.

Numbers that the core cannot hold are brought into its range by one of them. What is proven of the
scaled numbers holds for those as given.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Iterable

# Numbers below 2**exponent. The core takes coordinates up to 1e45, which is more than 2**149, and
# sizes down to 1e-45: this leaves room for the sum of a few.
_HIGHEST = 146
_LOWEST = -146
# Beyond this a float64 has too few digits left, or cannot hold a sum.
_FARTHEST = 905
_SMALLEST = -1073  # of 2**-1074


def exponent_of(length: float) -> int:
    """The least k with |length| < 2**k; of 0 that of the smallest float64."""
    return math.frexp(length)[1] if length else _SMALLEST


def exponent_into_range(low: int, high: int) -> int:
    """The k for which lengths with exponents from `low` to `high`, times 2**k, suit the core; 0 for
    those that do, or that nothing helps.

    Both ends come to lie equally far from 1. Where they are too far apart for that, the largest
    ones are kept in the range.
    """
    if (low >= _LOWEST and high <= _HIGHEST) or low < -_FARTHEST or high > _FARTHEST:
        return 0
    return min(-(low + high) // 2, _HIGHEST - high)


def times_power(values: Iterable[float], exponent: int) -> tuple[float, ...] | None:
    """The values times 2**exponent; None where one of them loses digits by that."""
    given = tuple(values)
    try:
        scaled = tuple(math.ldexp(value, exponent) for value in given)
        back = tuple(math.ldexp(value, -exponent) for value in scaled)
    except OverflowError:
        return None
    return scaled if back == given else None


def limit_times_power(limit: float, exponent: int) -> float:
    """The limit times 2**exponent, or what no length or volume of the core reaches."""
    try:
        return math.ldexp(limit, exponent)
    except OverflowError:
        return sys.float_info.max


def held_times_power(value: float, exponent: int) -> float:
    """The value times 2**exponent; not a number where float64 cannot hold that."""
    try:
        scaled = math.ldexp(value, exponent)
    except OverflowError:
        return math.nan
    return math.nan if value and not scaled else scaled
