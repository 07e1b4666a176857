"""Costs and errors of made-up rungs."""

from __future__ import annotations

import pytest

from bench.accuracy.rungs import cost, depth_widths, hard, labels, step, summary
from tests.bench.made import LABELS, record, row, silent, times

WRONG_HULL = {"hull": row("hull", error=-0.5, cpu=times(2e-3))}
APART = record("apart", relation="separated", bounds=(0.25, 0.25), rows=WRONG_HULL)
TOGETHER = record("together", rows={"parts 0.1": silent("parts 0.1", "not run", "budget")})
EASY = record("easy", picked="hull")
RECORDS = [APART, TOGETHER, EASY]


def test_the_rungs_come_in_the_order_of_the_ladder() -> None:
    assert labels(RECORDS) == LABELS


def test_pairs_that_hulls_settle_are_not_hard() -> None:
    assert hard(RECORDS) == [APART, TOGETHER]


def test_a_summary_counts_every_pair_and_measures_where_the_rung_worked() -> None:
    hull, parts = summary(RECORDS, "hull"), summary(RECORDS, "parts 0.1")
    assert hull.outcomes["right"] == 2
    assert hull.outcomes["false hit"] == hull.false_proofs == 1
    assert hull.judged == hull.pairs == sum(hull.outcomes.values()) == 3
    assert hull.errors.apart is not None
    assert hull.errors.apart.median == 0.25  # 0.5 of a body of size 2
    assert hull.errors.overlapping is not None
    assert hull.errors.overlapping.high == 0.0
    assert hull.steadiness is not None
    assert hull.steadiness.median == pytest.approx(4.0)
    assert parts.outcomes["not run"] == 1
    assert parts.pairs == 2
    assert sum(parts.outcomes.values()) == 3
    assert parts.cached is not None
    assert parts.cached.median == pytest.approx(1e-4)


def test_parts_that_were_not_made_cost_nothing_and_are_not_counted_as_cheap() -> None:
    early = record(rows={"parts 0.5": row("parts 0.5", cached=None, cold=times(1e-6))})
    found = summary([early, TOGETHER], "parts 0.5")
    assert found.outcomes["right"] == 2
    assert found.pairs == 1
    assert found.cold is not None
    assert found.cold.low == pytest.approx(1e-3)


def test_a_step_compares_the_pairs_that_both_rungs_answered() -> None:
    one = step(RECORDS[:2], "hull", "exact")
    assert (one.pairs, one.compared, one.wrong_before, one.wrong_after) == (2, 2, 1, 0)
    assert one.longer is not None
    assert (one.longer.low, one.longer.high) == pytest.approx((0.5, 1.0))
    assert (one.before, one.after) == (0.125, 0.0)
    finer = step(RECORDS[:2], "parts 0.2", "parts 0.1")
    assert finer.pairs == 1
    nothing = step([TOGETHER], "parts 0.2", "parts 0.1")
    assert (nothing.pairs, nothing.longer, nothing.before) == (0, None, None)


def test_a_cost_is_in_multiples_of_the_proof() -> None:
    found = cost([APART], "hull")
    assert found is not None
    assert found.cold.median == pytest.approx(2.0)
    assert found.error.median == 0.25
    assert cost([APART], "boolean") is None
    assert cost([TOGETHER], "parts 0.1") is None


def test_the_width_of_a_depth_is_relative_to_it() -> None:
    found = depth_widths([*RECORDS, record(bounds=None), record(bounds=(-4.0, -2.0))])
    assert found is not None
    assert found.count == 3
    assert found.median == pytest.approx(0.01)
    assert found.high == 0.5
