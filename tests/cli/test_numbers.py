"""Numbers for people."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from satcheck.audit.words import ROUNDOFF, after_rounding, bounds, duration, number, vector

LENGTHS = st.floats(min_value=1e-30, max_value=1e30)


@pytest.mark.parametrize(
    ("value", "text"),
    [(1.0, "1"), (0.1 + 0.2, "0.3"), (9.3e-9, "9.3e-09"), (-0.0, "0"), (1234567.0, "1.23457e+06")],
)
def test_six_digits(value: float, text: str) -> None:
    assert number(value) == text


def test_bounds_that_meet_are_one_number() -> None:
    assert bounds(0.25, 0.25) == "0.25"


@given(LENGTHS, LENGTHS)
def test_shown_bounds_are_still_bounds(first: float, second: float) -> None:
    low, high = sorted((first, second))
    shown = bounds(low, high).split(" .. ")
    assert float(shown[0]) <= low * (1 + ROUNDOFF)
    assert high * (1 - ROUNDOFF) <= float(shown[-1])


def test_rounding_errors_are_not_shown() -> None:
    assert bounds(1.2499988, 1.2500000000000488) == "1.24999 .. 1.25"
    assert bounds(0.9999999999998315, 1.0000000000000222) == "1"


@pytest.mark.parametrize(
    ("values", "text"),
    [
        ((-1.0, 3e-17, 0.0), "(-1, 0, 0)"),
        ((0.0, 0.0, 0.0), "(0, 0, 0)"),
        ((1e-9, -2e-9, 0.0), "(1e-09, -2e-09, 0)"),
        ((123456789.0, 1.0, -1.0), "(1.23457e+08, 0, 0)"),
    ],
)
def test_vectors_are_rounded_as_a_whole(values: tuple[float, float, float], text: str) -> None:
    assert vector(values) == text


@pytest.mark.parametrize(
    ("values", "said"),
    [
        ((0.0, 0.0, 0.0), ""),
        ((-0.5, 0.0, 1e-3), ""),
        ((1 / 3, 0.0, 0.0), " after rounding"),
        ((1.0, 1e-17, 0.0), " after rounding"),
        (None, ""),
    ],
)
def test_a_vector_that_is_not_as_shown_is_named(
    values: tuple[float, float, float] | None, said: str
) -> None:
    assert after_rounding(values) == said


@pytest.mark.parametrize(
    ("microseconds", "text"), [(0.25, "0.25 us"), (1234.5, "1.23 ms"), (2.5e6, "2.5 s")]
)
def test_durations(microseconds: float, text: str) -> None:
    assert duration(microseconds) == text
