"""What the next factor of accuracy costs, in words: along the Pareto front, rung by rung."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING

from satcheck.cli.report.numbers import DIGITS

if TYPE_CHECKING:
    from satcheck.audit.tradeoff import PairTradeoff, Row

STANDING = {0: "proven", 1: "not proven", 2: "wrong"}


def steps(pair: PairTradeoff) -> list[str]:
    """`hull to exact: 1.3 times the time, error 2.41 to 0, wrong to proven`: a line a step, from
    the fastest rung on. Where there is but one rung, that nothing is gained beyond it."""
    worth = sorted((row for row in pair.rows if row.on_front), key=_time)
    if len(worth) == 1:
        return [f"{worth[0].rung.label}: no slower rung is nearer or more sure"]
    return [_step(one, other) for one, other in pairwise(worth)]


def error(row: Row) -> str:
    """Without its sign; empty: not known."""
    size = row.size_of_error
    return "" if size is None else f"{size:.{DIGITS - 3}g}"


def _time(row: Row) -> float:
    assert row.cold is not None
    return row.cold.median


def _step(one: Row, other: Row) -> str:
    factor = _time(other) / _time(one)
    longer = f"{factor:.2g}" if factor < 10 else f"{factor:,.0f}"
    gains = [
        ("error ", error(one), error(other)),
        ("", STANDING[one.standing], STANDING[other.standing]),
    ]
    won = [f"{what}{before} to {after}" for what, before, after in gains if before != after]
    return (
        f"{one.rung.label} to {other.rung.label}: {', '.join([f'{longer} times the time', *won])}"
    )
