"""What the next factor of accuracy costs, said of made-up rungs."""

from __future__ import annotations

from satcheck.audit.tradeoff import RUNGS, PairTradeoff, Row, Times, Truth
from satcheck.cli.formats.tradeoff_steps import steps

BY_NAME = {rung.name: rung for rung in RUNGS}


def pair(*rows: Row) -> PairTradeoff:
    return PairTradeoff("a", "b", Truth("separated", None, 0.0), None, rows)


def row(name: str, seconds: float, error: float, *, right: bool, proven: bool = False) -> Row:
    return Row(
        rung=BY_NAME[name],
        state="answered",
        right=right,
        proven=proven,
        error=error,
        cold=Times((seconds,)),
        on_front=True,
    )


def test_each_step_has_its_price_and_what_it_buys() -> None:
    found = pair(
        row("exact", 0.5, 0.0, right=True, proven=True),
        row("aabb", 1e-4, -4.0, right=False),
        row("hull", 2e-4, -2.414213, right=False),
        row("obb", 1.5e-4, -4.0, right=True),
        Row(rung=BY_NAME["boolean"], state="failed", reason="made up"),
    )
    assert steps(found) == [
        "aabb to obb: 1.5 times the time, wrong to not proven",
        "obb to hull: 1.3 times the time, error 4 to 2.41, not proven to wrong",
        "hull to exact: 2,500 times the time, error 2.41 to 0, wrong to proven",
    ]


def test_errors_have_as_many_digits_as_tell_them_apart() -> None:
    found = pair(row("aabb", 1e-3, -0.110828, right=True), row("hull", 0.1, -0.110693, right=True))
    assert steps(found) == [
        "aabb to hull: 100 times the time, error 0.1108 to 0.1107, still not proven"
    ]


def test_a_nearer_wrong_answer_is_still_called_wrong() -> None:
    found = pair(row("aabb", 1e-4, -4.0, right=False), row("hull", 2e-4, -2.0, right=False))
    assert steps(found) == ["aabb to hull: 2 times the time, error 4 to 2, still wrong"]


def test_where_the_cheapest_is_the_best_that_is_said() -> None:
    (only,) = steps(pair(row("aabb", 1e-4, 0.0, right=True, proven=True)))
    assert only == "aabb: no slower rung is nearer or more sure"


def test_nothing_is_said_where_nothing_is_known() -> None:
    assert steps(pair(Row(rung=BY_NAME["aabb"], state="not run", reason="budget"))) == []
