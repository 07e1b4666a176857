"""Numbers and axes in the form that certificates have, and what stands where there is none."""

from __future__ import annotations

from collections.abc import Iterable
from fractions import Fraction
from typing import Any, TypeVar

from msgspec import UNSET, Struct, UnsetType

from satcheck.report.certificate import Exact, ExactVector

T = TypeVar("T")
# The candidates to try first, along and against each coordinate.
AXES: tuple[ExactVector, ...] = (
    (1.0, 0.0, 0.0),
    (-1.0, 0.0, 0.0),
    (0.0, 1.0, 0.0),
    (0.0, -1.0, 0.0),
    (0.0, 0.0, 1.0),
    (0.0, 0.0, -1.0),
)


class NoCertificate(Struct, frozen=True):
    reason: str


def exact_number(value: Fraction) -> Exact:
    """A float where that is exact, else text."""
    rounded = float(value)
    exact = Fraction(rounded) == value
    return rounded if exact else f"{value.numerator}/{value.denominator}"


def exact_point(p: Iterable[Fraction]) -> ExactVector:
    x, y, z = map(exact_number, p)
    return x, y, z


def integer_axis(n: Iterable[Any]) -> ExactVector:
    """Integers of any length, as text."""
    x, y, z = map(str, n)
    return x, y, z


def or_unset(value: T | None) -> T | UnsetType:
    return UNSET if value is None else value


def leading_axes(
    leads: Iterable[tuple[ExactVector, float | Fraction]],
) -> tuple[ExactVector, ExactVector] | None:
    """An axis along which A reaches at least as far as B, and one along which B does; along one of
    them farther. leads: axes, each with the sign of what A reaches beyond B."""
    a = b = even = None
    for axis, lead in leads:
        if lead > 0:
            a = a or axis
        elif lead < 0:
            b = b or axis
        else:
            even = even or axis
    if a is None and b is None:
        return None
    a, b = a or even, b or even
    return None if a is None or b is None else (a, b)
