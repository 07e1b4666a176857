"""Which made-up rungs are worth their time, and when one is faster by more than chance."""

from __future__ import annotations

from dataclasses import dataclass

import pytest

from satcheck.audit.tradeoff import Times
from satcheck.audit.tradeoff.pareto import front

PAD = 1e-9


@dataclass(frozen=True)
class Made:
    runs: tuple[float, ...]
    size_of_error: float | None
    standing: int = 0

    @property
    def cold(self) -> Times | None:
        return Times(self.runs) if self.runs else None


def at(seconds: float, error: float | None, standing: int = 0) -> Made:
    """Of runs that all took the same time."""
    return Made((seconds,) * 3, error, standing)


@pytest.mark.parametrize(
    ("points", "expected"),
    [
        ([], []),
        ([at(1.0, 2.0)], [True]),
        ([at(1.0, 4.0), at(2.0, 1.0), at(3.0, 2.0)], [True, True, False]),
        ([at(1.0, 0.0), at(2.0, 0.0)], [True, False]),
        ([at(2.0, 0.0), at(1.0, 0.0)], [False, True]),
        ([at(1.0, 1.0), at(1.0, 1.0)], [True, False]),
    ],
)
def test_what_is_slower_and_no_nearer_is_not_on_the_front(
    points: list[Made], expected: list[bool]
) -> None:
    assert front(points, PAD) == expected


def test_a_guess_takes_no_proof_off_the_front() -> None:
    assert front([at(1.0, 0.0, 1), at(2.0, 0.0)], PAD) == [True, True]
    assert front([at(1.0, 0.0, 2), at(2.0, 0.0, 1)], PAD) == [True, True]
    assert front([at(1.0, 0.0), at(2.0, 0.0, 1)], PAD) == [True, False]


def test_what_has_no_error_or_no_time_is_not_compared() -> None:
    assert front([at(1.0, None), Made((), 0.0), at(5.0, 5.0)], PAD) == [False, False, True]


def test_times_within_the_spread_of_each_other_decide_nothing() -> None:
    first, second = (1.0, 1.1, 1.3, 1.5, 9.0), (0.9, 1.0, 1.2, 1.4, 1.6)
    assert front([Made(first, 2.0), Made(second, 2.0)], PAD) == [True, False]
    # As fast, and nearer: the error decides.
    assert front([Made(second, 2.0), Made(first, 1.0)], PAD) == [False, True]
    # As fast, and proven.
    assert front([Made(second, 2.0, 1), Made(first, 2.0)], PAD) == [False, True]


def test_errors_that_rounding_tells_apart_are_the_same() -> None:
    steps = [at(1.0, 2.0 + 0.8 * PAD), at(2.0, 2.0), at(3.0, 2.0 - 0.8 * PAD)]
    assert front(steps, PAD) == [True, False, False]
    assert front(steps, 0.5 * PAD) == [True, True, True]


def test_faster_is_what_lies_below_the_middle_half_of_the_other() -> None:
    quick, slow = Times((1.0, 1.1, 1.2, 1.3, 9.0)), Times((2.0, 1.9, 2.2, 0.1, 2.1))
    assert quick.is_below(slow)  # one slow run of the one, one fast run of the other
    assert not slow.is_below(quick)


def test_what_overlaps_is_neither() -> None:
    one, other = Times((1.0, 1.1, 1.2, 1.3, 1.4)), Times((1.1, 1.2, 1.3, 1.4, 1.5))
    assert not one.is_below(other)
    assert not other.is_below(one)
    assert not one.is_below(one)


def test_single_runs_are_compared_as_they_are() -> None:
    assert Times((1.0,)).is_below(Times((1.1,)))
    assert not Times((1.1,)).is_below(Times((1.0,)))


def test_the_document_has_microseconds() -> None:
    found = Times((0.5, 0.25, 1.0)).to_dict()
    assert found == {"median": 5e5, "low": 2.5e5, "high": 1e6, "runs": 3}
