"""Integers instead of float64, the nearest point of a few points, and signs of sums of roots."""

from __future__ import annotations

import random
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from satcheck.verify.exact import (
    ROOT_BITS,
    Rejected,
    dot,
    integers,
    lattice,
    nearest_to_origin,
    root,
    sign_of,
)

SMALL = st.integers(-3, 3)
POINTS = st.lists(st.tuples(SMALL, SMALL, SMALL), min_size=1, max_size=6)
FLOATS = st.floats(-1e45, 1e45)


@given(st.lists(st.tuples(FLOATS, FLOATS, FLOATS), min_size=1, max_size=5))
@settings(max_examples=100, deadline=None, derandomize=True)
def test_a_lattice_holds_its_points_exactly(rows: list[tuple[float, float, float]]) -> None:
    points = np.array(rows)
    k = lattice(points)
    for row, point in zip(rows, integers(points, k), strict=True):
        assert [Fraction(c) * 2**k for c in row] == list(point)


@given(POINTS)
@settings(max_examples=200, deadline=None, derandomize=True)
def test_nothing_of_the_hull_is_nearer(points: list[tuple[int, int, int]]) -> None:
    x, weights = nearest_to_origin(points)
    assert min(weights.values()) >= 0
    assert sum(weights.values()) == 1
    for axis in range(3):
        assert x[axis] == sum(w * points[k][axis] for k, w in weights.items())
    assert all(dot(point, x) >= dot(x, x) for point in points)


def test_roots() -> None:
    assert root(Fraction(49, 16), 8) == (Fraction(7, 4), Fraction(7, 4))
    low, high = root(Fraction(2, 3), 64)
    assert low * low < Fraction(2, 3) < high * high
    assert high - low == Fraction(1, 3 << 64)
    for number in (2, 3, 10**40 + 1):
        value = Fraction(number, 7)
        low, high = root(value)
        assert low**2 < value < high**2
        assert (high - low) * 2**ROOT_BITS <= high


def test_signs() -> None:
    assert sign_of(Fraction(5), [Fraction(4), Fraction(9)]) == 0
    assert sign_of(Fraction(-5), more=[Fraction(4), Fraction(9)]) == 0
    assert sign_of(Fraction(0), [Fraction(2)], [Fraction(2)]) == 0
    assert sign_of(Fraction(0), [Fraction(2)], [Fraction(3)]) == 1
    assert sign_of(Fraction(3), [Fraction(2), Fraction(3)]) == -1


def test_of_terms_that_nearly_cancel() -> None:
    """c - sqrt(c^2 + d): of the sign of -d, however small that is."""
    rng = random.Random(6)
    for _ in range(200):
        c, d = Fraction(rng.getrandbits(60) + 1), Fraction(rng.choice((-1, 0, 1)), 1 << 900)
        assert sign_of(c, [c * c + d]) == (d < 0) - (d > 0)


def test_what_is_closer_than_that_is_not_told() -> None:
    with pytest.raises(Rejected, match="too close"):
        sign_of(Fraction(0), [Fraction(8)], [Fraction(2), Fraction(2)])
