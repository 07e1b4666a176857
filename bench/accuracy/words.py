"""Figures as words, and tables of Markdown."""

from __future__ import annotations

from collections.abc import Sequence

from bench.accuracy.spread import Spread
from satcheck.audit.words import duration

NONE = "-"
_MICROSECONDS = 1e6


def time(seconds: float) -> str:
    return duration(_MICROSECONDS * seconds).replace("us", "µs")


def times(one: Spread | None) -> list[str]:
    """Median, most."""
    return [NONE] * 2 if one is None else [time(one.median), time(one.high)]


def percent(share: float) -> str:
    """Two significant digits; 0 is 0 alone."""
    return "0" if share == 0 else f"{100 * share:.2g} %" if share < 1 else f"{100 * share:.0f} %"


def shares(one: Spread | None) -> list[str]:
    """Median, most."""
    return [NONE] * 2 if one is None else [percent(one.median), percent(one.high)]


def factor(value: float) -> str:
    """`1.1 x`, `0.054 x`, `310 x`."""
    return f"{value:.0f} x" if value >= 100 else f"{value:.2g} x"


def times_as_long(value: float) -> str:
    """`13 times`, `0.054 times`."""
    return f"{factor(value).removesuffix(' x')} times"


def table(head: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    first, *others = [f"| {' | '.join(cells)} |" for cells in (head, *rows)]
    return "\n".join([first, f"|{'---|' * len(head)}", *others])
