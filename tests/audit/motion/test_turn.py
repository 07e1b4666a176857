"""Rotations: exact quarters, whole turns that return, shortest arcs."""

from __future__ import annotations

import math

import pytest

from satcheck.audit.motion.turn import (
    STILL,
    applied,
    between,
    product,
    quaternion_matrix,
    rotation,
    unit,
)

Z = (0.0, 0.0, 1.0)
# Roundings of a turn of a vector of length 1: sine, cosine, axis and nine products.
ERROR = 32 * 2.0**-53


@pytest.mark.parametrize("turns", [-1000, -2, -1, 0, 1, 3, 10**12])
def test_whole_turns_return_exactly(turns: int) -> None:
    assert rotation(unit((1.0, 2.0, 3.0)), 360.0 * turns) == STILL


def test_right_handed() -> None:
    assert applied(rotation(Z, 90.0), (1.0, 0.0, 0.0)) == (0.0, 1.0, 0.0)


def test_between_takes_the_shortest_arc() -> None:
    """From 10 to 350 degrees about z: back by 20, also where the quaternions differ in sign."""

    def about_z(degrees: float, sign: float = 1.0) -> tuple[float, float, float, float]:
        half = math.radians(degrees) / 2
        return 0.0, 0.0, sign * math.sin(half), sign * math.cos(half)

    for sign in (1.0, -1.0):
        axis, degrees = between(about_z(10.0), about_z(350.0, sign))
        assert degrees == pytest.approx(20.0, rel=64 * ERROR)
        assert axis == (0.0, 0.0, -1.0)


def test_the_turn_between_leads_from_one_to_the_other() -> None:
    start, end = (0.1, -0.7, 0.3, 0.5), (-0.4, 0.2, 0.9, 0.1)
    there = product(rotation(*between(start, end)), quaternion_matrix(start))
    for row, expected in zip(there, quaternion_matrix(end), strict=True):
        assert row == pytest.approx(expected, abs=8 * ERROR)
