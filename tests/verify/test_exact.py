"""Integers instead of float64, and the nearest point of a few points."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from satcheck.verify.exact import dot, integers, lattice, nearest_to_origin

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
