"""Ways out of unions of boxes, where the shortest one is known."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest

from satcheck import core
from satcheck.audit.part_escape import PartPairs, Wall, nearest_point, short_ways_out
from satcheck.audit.parts import Part

AXES = [tuple(float(sign) * (axis == k) for k in range(3)) for axis in range(3) for sign in (-1, 1)]


def part(low, high):
    corners = np.array(list(itertools.product(*zip(low, high, strict=True))), dtype=float)
    return Part(core.Hull(corners), (tuple(map(float, low)), tuple(map(float, high))))


BRACKET = [part((0, 0, 0), (6, 2, 4)), part((0, 2, 0), (2, 6, 4))]


@pytest.mark.parametrize(
    ("peg", "expected"),
    [
        (part((1.5, 3, 1), (3.5, 5, 3)), (-0.5, 0, 0)),
        (part((1.5, 1.75, 1), (3.5, 3.75, 3)), (-0.5, -0.25, 0)),
        (part((0.75, 4, 1), (1.75, 5, 2)), (-1.25, 0, 0)),
        (part((4.75, 0.5, 1), (5.5, 1.5, 2)), (-1.25, 0, 0)),
    ],
    ids=["one arm", "both arms", "inside", "inside near the end"],
)
def test_shortest_way_out_of_a_bracket(peg, expected):
    ways = short_ways_out(PartPairs(BRACKET, [peg], 10.0), AXES, 10.0)
    assert ways[0] == pytest.approx(expected, abs=1e-12)
    assert [math.hypot(*way) for way in ways] == sorted(math.hypot(*way) for way in ways)


def test_every_way_out_is_free():
    peg = part((1.5, 1.75, 1), (3.5, 3.75, 3))
    pairs = PartPairs(BRACKET, [peg], 10.0)
    for way in short_ways_out(pairs, AXES, 10.0):
        assert pairs.wall_at(way) is None


def test_nothing_to_leave():
    far = part((20, 20, 20), (21, 21, 21))
    assert short_ways_out(PartPairs(BRACKET, [far], 10.0), AXES, 10.0) == []


def test_nearest_point_beyond_walls():
    x, y = Wall((1.0, 0.0, 0.0), 2.0), Wall((0.0, 1.0, 0.0), 3.0)
    assert nearest_point([x]) == pytest.approx((2, 0, 0))
    assert nearest_point([x, y]) == pytest.approx((2, 3, 0))
    assert nearest_point([x, Wall((-1.0, 0.0, 0.0), 1.0)]) is None
