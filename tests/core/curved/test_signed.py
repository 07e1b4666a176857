"""Signed distances of balls, for which they are known, widened by what placing them rounds."""

from __future__ import annotations

import math

import pytest

from satcheck import core
from satcheck.core.curved.signed import compare, convex_pair, signed
from satcheck.core.shapes import Sphere
from tests.core.curved.worlds import at

BALL = at(Sphere(1.0), (0.0, 0.0, 0.0))


@pytest.mark.parametrize(
    ("slack", "outcome", "exact"),
    [(0.0, "separated", True), (0.5, "separated", True), (2.0, "touching", False)],
)
def test_slack_widens_the_bounds(slack: float, outcome: str, exact: bool) -> None:
    balls = core.Sphere(1.0), core.Sphere(1.0)
    result = core.check_pair(*balls, None, (3.0, 0.0, 0.0), query="depth")
    distance = signed(result, slack)
    assert distance is not None
    assert (distance.outcome, distance.exact) == (outcome, exact)
    assert distance.lower <= 1.0 - slack <= 1.0 + slack <= distance.upper


def test_a_swapped_distance_is_that_of_the_swapped_pair() -> None:
    other = at(Sphere(0.5), (0.0, 3.0, 4.0))
    forth, back = convex_pair(BALL, other), convex_pair(other, BALL)
    assert forth is not None
    assert back is not None
    assert forth.lower <= 3.5 <= forth.upper
    swapped = forth.swapped()
    assert swapped.normal == back.normal
    assert (swapped.witness_a, swapped.witness_b) == (back.witness_a, back.witness_b)


def test_a_length_is_compared_to_the_last_digit() -> None:
    other = at(Sphere(0.5), (0.0, 3.0, 4.0))
    assert compare(BALL, other, 3.5) == 0
    assert compare(BALL, other, math.nextafter(3.5, 4.0)) == -1
    assert compare(BALL, other, math.nextafter(3.5, 3.0)) == 1
