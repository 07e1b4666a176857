"""Numbers for people."""

from __future__ import annotations

from fractions import Fraction

import pytest
from hypothesis import given
from hypothesis import strategies as st

from satcheck.audit.words import (
    ROUNDOFF,
    about,
    at_least,
    at_most,
    bounds,
    duration,
    interval,
    number,
    stated,
    vector,
)
from satcheck.report.judge import EXACT_WIDTH

LENGTHS = st.floats(min_value=1e-30, max_value=1e30)


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (1.0, "1"),
        (0.1 + 0.2, "0.3"),
        (0.32684, "0.327"),
        (9.3e-9, "9.3e-09"),
        (-0.0, "0"),
        (999.4, "999"),
        (999.6, "1000"),
        (12345.6, "12346"),
        (1234567.0, "1.23e+06"),
    ],
)
def test_three_digits_and_all_before_the_point(value: float, text: str) -> None:
    assert number(value) == text


def test_what_a_person_stated_keeps_its_digits() -> None:
    assert [stated(v) for v in (0.12345, 45.0, 1e-7, 0.1 + 0.2)] == [
        "0.12345",
        "45",
        "1e-07",
        "0.3",
    ]


def test_bounds_that_meet_are_one_number() -> None:
    assert bounds(0.25, 0.25) == "0.25"


@pytest.mark.parametrize(
    ("low", "high", "text"),
    [
        (0.501573, 0.506552, "0.504 ±0.003"),
        (1.24123, 1.25001, "1.25 ±0.01"),
        (0.0024976, 0.00250153, "0.00250 ±0.00001"),
        (99.96, 100.02, "100.0 ±0.1"),
        (12345.0, 12399.0, "12372 ±27"),
        (1.0, 10.0, "5.50 ±4.50"),
        (9.3e-9, 9.4e-9, "9.35e-09 ±5e-11"),
        (1.2499988, 1.2500000000000488, "1.25 ±0.01"),
        (0.9999999999998315, 1.0000000000000222, "1"),
    ],
)
def test_an_interval_has_a_middle_and_a_half_width(low: float, high: float, text: str) -> None:
    assert bounds(low, high) == text


@given(LENGTHS, LENGTHS)
def test_what_is_shown_contains_the_interval(first: float, second: float) -> None:
    low, high = sorted((first, second))
    shown = bounds(low, high).split(" ±")
    if len(shown) == 1:
        assert high - low <= EXACT_WIDTH * high
        return
    middle, half = map(Fraction, shown)
    assert middle - half <= Fraction(low) * (1 + Fraction(ROUNDOFF))
    assert middle + half >= Fraction(high) * (1 - Fraction(ROUNDOFF))


@given(LENGTHS)
def test_a_bound_alone_is_rounded_outward(value: float) -> None:
    assert float(at_least(value)) <= value * (1 + ROUNDOFF)
    assert float(at_most(value)) >= value * (1 - ROUNDOFF)


def test_a_figure_without_a_lower_bound_is_at_most_so_large() -> None:
    assert interval((0.0, 11.98)) == "<= 12"


@pytest.mark.parametrize(
    ("values", "text"),
    [
        ((-1.0, 3e-17, 0.0), "(-1, 0, 0)"),
        ((0.0, 0.0, 0.0), "(0, 0, 0)"),
        ((1e-9, -2e-9, 0.0), "(1e-09, -2e-09, 0)"),
        ((-0.141727, 0.032249, -0.470968), "(-0.142, 0.032, -0.471)"),
        ((123456789.0, 1.0, -1.0), "(1.23e+08, 0, 0)"),
    ],
)
def test_vectors_are_rounded_as_a_whole(values: tuple[float, float, float], text: str) -> None:
    assert vector(values) == text


@pytest.mark.parametrize(
    ("values", "said"),
    [
        ((0.0, 0.0, 0.0), ""),
        ((-0.5, 0.0, 1e-3), ""),
        ((1 / 3, 0.0, 0.0), "about "),
        ((1.0, 1e-17, 0.0), "about "),
        (None, ""),
    ],
)
def test_a_vector_that_is_not_as_shown_is_named(
    values: tuple[float, float, float] | None, said: str
) -> None:
    assert about(values) == said


@pytest.mark.parametrize(
    ("microseconds", "text"), [(0.25, "0.25 us"), (1234.5, "1.23 ms"), (2.5e6, "2.5 s")]
)
def test_durations(microseconds: float, text: str) -> None:
    assert duration(microseconds) == text
