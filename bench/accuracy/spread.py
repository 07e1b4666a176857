"""Quartiles of what was measured."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from statistics import quantiles


@dataclass(frozen=True, slots=True)
class Spread:
    """Least, quartiles and most of `count` values, interpolated between them."""

    count: int
    low: float
    first: float
    median: float
    third: float
    high: float


def spread(values: Iterable[float]) -> Spread | None:
    """None where there are no values."""
    known = sorted(values)
    if not known:
        return None
    if len(known) == 1:
        only = known[0]
        return Spread(1, only, only, only, only, only)
    first, middle, third = quantiles(known, n=4, method="inclusive")
    return Spread(len(known), known[0], first, middle, third, known[-1])
