"""The gap of boxes in rational arithmetic."""

from __future__ import annotations

import math
from fractions import Fraction

import pytest
from hypothesis import given
from hypothesis import strategies as st

from satcheck.core import box_gap

Point = tuple[float, float, float]
Box = tuple[Point, Point]

UNIT: Box = ((0.0, 0.0, 0.0), (1.0, 1.0, 1.0))
COORDINATE = st.floats(-1e6, 1e6, allow_subnormal=False)
CORNERS = st.tuples(COORDINATE, COORDINATE, COORDINATE)


def moved(box: Box, step: Point) -> Box:
    (x, y, z), (u, v, w) = box
    return (x + step[0], y + step[1], z + step[2]), (u + step[0], v + step[1], w + step[2])


@pytest.mark.parametrize(
    ("shift", "gap"),
    [
        ((0, 0, 0), 0),
        ((1, 0, 0), 0),
        ((1, 1, 1), 0),
        ((3, 0, 0), 2),
        ((4, 5, 0), 5),
        ((-3, -3, -2), 3),
    ],
)
def test_gap_of_unit_boxes(shift: Point, gap: float) -> None:
    found = box_gap(UNIT, moved(UNIT, shift))
    assert found <= gap
    assert found == pytest.approx(gap, rel=1e-14)


def test_smallest_gap_is_not_lost() -> None:
    above = math.nextafter(1.0, 2.0)
    assert box_gap(UNIT, ((above, 0, 0), (2, 1, 1))) > 0


@given(CORNERS, CORNERS, CORNERS, CORNERS)
def test_gap_never_exceeds_the_truth(p: Point, q: Point, r: Point, s: Point) -> None:
    a, b = between(p, q), between(r, s)
    gaps = [
        max(Fraction(b[0][k]) - Fraction(a[1][k]), Fraction(a[0][k]) - Fraction(b[1][k]))
        for k in range(3)
    ]
    squares = sum(gap**2 for gap in gaps if gap > 0)
    gap = box_gap(a, b)
    assert Fraction(gap) ** 2 <= squares
    assert (gap > 0) == (squares > 0)


def between(p: Point, q: Point) -> Box:
    low, high = zip(*(sorted(pair) for pair in zip(p, q, strict=True)), strict=True)
    return (low[0], low[1], low[2]), (high[0], high[1], high[2])
