"""The worst pose: closed forms, and never better than what sampling finds."""

from __future__ import annotations

import math

import numpy as np
import pytest

from satcheck.audit.motion.worst import WIDTH, deepest_pose, least_distance
from satcheck.audit.pair import STEPS_OF_SWEEP
from satcheck.scene.motion import Rotation, Translation
from tests.audit.motion.pairs import hull_of, moving
from tests.audit.shapes import box, bracket, unit_box
from tests.oracles.random_shapes import random_hull

Z = (0.0, 0.0, 1.0)


def assert_bounds(worst, truth, pad):
    assert worst.lower - pad <= truth <= worst.upper + pad
    assert worst.upper - worst.lower <= WIDTH * abs(truth) * (1 + WIDTH) + 4 * pad


@pytest.mark.parametrize("concave", [False, True])
def test_passing_by(concave):
    """Past a corner at a distance of 1, half way."""
    points, faces = bracket()
    turned = [(-x, -y, z) for x, y, z in points], faces
    a = turned if concave else box((-6, -6, 0), (0, 0, 4))
    pair = moving(a, Translation((4.0, 0.0, 0.0)), unit_box(2, 1, 1))
    worst = least_distance(pair)
    assert_bounds(worst, 1.0, pair.pad)


def test_the_corner_of_a_turning_square():
    """Its corner comes to within 1 of the wall, at 45 degrees; elsewhere it is farther."""
    square = box((-1, -1, 0), (1, 1, 1))
    reach = math.sqrt(2.0)
    wall = box((reach + 1.0, -5, 0), (reach + 2.0, 5, 1))
    pair = moving(square, Rotation((0.0, 0.0, 0.0), Z, 90.0), wall)
    worst = least_distance(pair)
    assert_bounds(worst, 1.0, pair.pad)
    # Off by an angle, the corner falls short by 1 - cos of it: as much as the width allows.
    assert abs(worst.time - 0.5) * math.radians(90.0) <= math.acos(1 - 2 * WIDTH / reach)


def test_the_depth_of_a_turning_square():
    square = box((-1, -1, -9), (1, 1, 9))
    wall = box((math.sqrt(2.0) - 0.25, -5, 0), (9.0, 5, 1))
    pair = moving(square, Rotation((0.0, 0.0, 0.0), Z, 90.0), wall)
    worst = least_distance(pair)
    assert_bounds(worst, -0.25, pair.pad)


def test_the_ends_count():
    pair = moving(unit_box(), Translation((1.0, 0.0, 0.0)), unit_box(4.0))
    worst = least_distance(pair)
    assert worst.time == 1.0
    assert_bounds(worst, 2.0, pair.pad)


@pytest.mark.parametrize("clearance", [0.5, 1.0 - 1e-6, 1.0 + 1e-6, 2.0])
def test_a_clearance_is_decided(clearance):
    """The interval is narrow if the clearance is broken: then somebody has to move a body."""
    pair = moving(unit_box(), Translation((2.0, 0.5, 0.25)), unit_box(2, 2.5, 0.5))
    worst = least_distance(pair, (clearance,))
    assert worst.lower <= 1.0 <= worst.upper
    if clearance > 1.0:
        assert_bounds(worst, 1.0, pair.pad)
    assert (worst.upper < clearance) is (clearance > 1.0)
    assert (worst.lower >= clearance) is (clearance < 1.0)


def test_the_deepest_pose_of_a_bracket():
    """A box is pushed into an arm of the L, 2 thick, from its notch, 0.75 deep in the end."""
    pair = moving(unit_box(3, 2, 1), Translation((0.0, -0.75, 0.0)), bracket())
    worst = deepest_pose(pair, 0.1)
    assert worst.time == 1.0
    assert worst.lower <= -0.75
    assert worst.upper == pytest.approx(-0.75, rel=0.01)
    assert worst.upper >= -0.75 - pair.pad


def test_a_deepest_pose_takes_no_more_steps_than_the_sweep_may():
    pair = moving(unit_box(3, 2, 1), Translation((0.0, -0.75, 0.0)), bracket())
    assert deepest_pose(pair, 0.1) is not None
    taken = pair.pair.sweep_steps
    few = moving(unit_box(3, 2, 1), Translation((0.0, -0.75, 0.0)), bracket())
    few.pair.steps, few.pair.sweep_steps = taken // 100, STEPS_OF_SWEEP
    assert deepest_pose(few, 0.1) is None


@pytest.mark.parametrize("seed", range(8))
def test_no_sample_is_worse(seed):
    rng = np.random.default_rng(seed)
    a, b = hull_of(random_hull(rng, 9)), hull_of(random_hull(rng, 9) + rng.normal(size=3))
    path = Rotation((*map(float, rng.normal(size=3)),), (0.3, 0.5, 1.0), 200.0)
    pair = moving(a, path, b)
    worst = least_distance(pair)
    assert worst.lower <= worst.upper
    for k in range(101):
        assert worst.lower <= pair.least_gap(k / 100, k / 100)[1] + pair.pad
