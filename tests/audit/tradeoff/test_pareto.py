"""Which made-up rungs are worth their time."""

from __future__ import annotations

from dataclasses import dataclass

import pytest

from satcheck.audit.tradeoff.pareto import front


@dataclass(frozen=True)
class Made:
    time: float | None
    size_of_error: float | None
    standing: int = 0


@pytest.mark.parametrize(
    ("points", "expected"),
    [
        ([], []),
        ([Made(1.0, 2.0)], [True]),
        ([Made(1.0, 4.0), Made(2.0, 1.0), Made(3.0, 2.0)], [True, True, False]),
        ([Made(1.0, 0.0), Made(2.0, 0.0)], [True, False]),
        ([Made(1.0, 1.0), Made(1.0, 1.0)], [True, True]),
    ],
)
def test_what_is_slower_and_no_nearer_is_not_on_the_front(
    points: list[Made], expected: list[bool]
) -> None:
    assert front(points) == expected


def test_a_guess_takes_no_proof_off_the_front() -> None:
    assert front([Made(1.0, 0.0, standing=1), Made(2.0, 0.0)]) == [True, True]
    assert front([Made(1.0, 0.0, standing=2), Made(2.0, 0.0, standing=1)]) == [True, True]
    assert front([Made(1.0, 0.0), Made(2.0, 0.0, standing=1)]) == [True, False]


def test_what_has_no_error_or_no_time_is_not_compared() -> None:
    assert front([Made(1.0, None), Made(None, 0.0), Made(5.0, 5.0)]) == [False, False, True]
