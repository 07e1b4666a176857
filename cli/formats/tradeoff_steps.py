"""What the next factor of accuracy costs, in words: along the Pareto front, rung by rung."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING

from satcheck.cli.formats.numbers import DIGITS

if TYPE_CHECKING:
    from satcheck.audit.tradeoff import PairTradeoff, Row

_DIGITS = range(3, DIGITS + 1)
STANDING = {0: "proven", 1: "not proven", 2: "wrong"}


def steps(pair: PairTradeoff) -> list[str]:
    """`hull to exact: 1.3 times the time, error 2.41 to 0, wrong to proven`: a line a step, from
    the fastest rung on. Where there is but one rung, that nothing is gained beyond it."""
    worth = sorted((row for row in pair.rows if row.on_front), key=_time)
    if len(worth) == 1:
        return [f"{worth[0].rung.label}: no slower rung is nearer or more sure"]
    return [_step(faster, slower) for faster, slower in pairwise(worth)]


def _time(row: Row) -> float:
    assert row.cold is not None
    return row.cold.median


def _step(faster: Row, slower: Row) -> str:
    factor = _time(slower) / _time(faster)
    longer = f"{factor:.2g}" if factor < 10 else f"{factor:,.0f}"
    won = [
        *_change("error ", *_errors(faster.size_of_error or 0.0, slower.size_of_error or 0.0)),
        *_verdict(STANDING[faster.standing], STANDING[slower.standing]),
    ]
    changes = ", ".join([f"{longer} times the time", *won])
    return f"{faster.rung.label} to {slower.rung.label}: {changes}"


def _errors(before: float, after: float) -> tuple[str, str]:
    """In as many digits as tell them apart."""
    said = [tuple(f"{size:.{digits}g}" for size in (before, after)) for digits in _DIGITS]
    smaller, other = next((both for both in said if len({*both}) > 1), said[0])
    return smaller, other


def _verdict(before: str, after: str) -> list[str]:
    """What is wrong or unproven and stays so is said, lest a smaller error read as an answer."""
    if before == after and before != STANDING[0]:
        return [f"still {before}"]
    return _change("", before, after)


def _change(what: str, before: str, after: str) -> list[str]:
    return [] if before == after else [f"{what}{before} to {after}"]
