"""World boxes: analytic ways out."""

from __future__ import annotations

import pytest
from hypothesis import strategies as st

from satcheck.audit.body import box_escape

UNIT = ((0.0, 0.0, 0.0), (1.0, 1.0, 1.0))
COORDINATE = st.floats(-1e6, 1e6, allow_subnormal=False)
CORNERS = st.tuples(COORDINATE, COORDINATE, COORDINATE)


def shifted(box, x, y, z):
    return tuple(tuple(c + d for c, d in zip(corner, (x, y, z), strict=True)) for corner in box)


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
