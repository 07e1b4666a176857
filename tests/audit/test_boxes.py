"""World boxes: analytic gaps and ways out."""

from __future__ import annotations

import math
from fractions import Fraction

import pytest
from hypothesis import given
from hypothesis import strategies as st

from satcheck.audit.boxes import box_escape, box_gap, holds

UNIT = ((0.0, 0.0, 0.0), (1.0, 1.0, 1.0))
COORDINATE = st.floats(-1e6, 1e6, allow_subnormal=False)
CORNERS = st.tuples(COORDINATE, COORDINATE, COORDINATE)


def shifted(box, x, y, z):
    return tuple(tuple(c + d for c, d in zip(corner, (x, y, z), strict=True)) for corner in box)


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
def test_gap_of_unit_boxes(shift, gap):
    found = box_gap(UNIT, shifted(UNIT, *shift))
    assert found <= gap
    assert found == pytest.approx(gap, rel=1e-14)


def test_smallest_gap_is_not_lost():
    above = math.nextafter(1.0, 2.0)
    assert box_gap(UNIT, ((above, 0, 0), (2, 1, 1))) > 0


@given(CORNERS, CORNERS, CORNERS, CORNERS)
def test_gap_never_exceeds_the_truth(p, q, r, s):
    a = (tuple(map(min, p, q)), tuple(map(max, p, q)))
    b = (tuple(map(min, r, s)), tuple(map(max, r, s)))
    squares = [
        max(Fraction(b[0][k]) - Fraction(a[1][k]), Fraction(a[0][k]) - Fraction(b[1][k]), 0) ** 2
        for k in range(3)
    ]
    gap = box_gap(a, b)
    assert Fraction(gap) ** 2 <= sum(squares)
    assert (gap > 0) == (sum(squares) > 0)


@pytest.mark.parametrize(
    ("shift", "length", "normal"),
    [
        ((0.75, 0, 0), 0.25, (1, 0, 0)),
        ((-0.75, 0, 0), 0.25, (-1, 0, 0)),
        ((0, 0.5, 0.9), 0.1, (0, 0, 1)),
        ((1, 0, 0), 0, (1, 0, 0)),
    ],
)
def test_escape(shift, length, normal):
    found, direction = box_escape(UNIT, shifted(UNIT, *shift))
    assert found == pytest.approx(length, abs=1e-15)
    assert direction == normal


def test_escape_of_apart_boxes_is_zero():
    assert box_escape(UNIT, shifted(UNIT, 5, 0, 0))[0] == 0


def test_holds_is_closed():
    assert holds(UNIT, UNIT)
    assert holds(UNIT, ((0.5, 0.5, 0.5), (1.0, 0.6, 0.6)))
    assert not holds(UNIT, ((0.5, 0.5, 0.5), (1.1, 0.6, 0.6)))
