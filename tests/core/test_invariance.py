"""What must not change an answer, or must change it in step: sweeps, swaps, motions, scale, MTV."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from satcheck.core import Box, Capsule, Cone, Cylinder, Ellipsoid, Hull, Sphere, check_pair
from tests.core.pair_checks import CURVED, EXACT, UNIT, assert_valid, distance_of
from tests.oracles.random_shapes import (
    box_corners,
    compose,
    random_direction,
    random_hull,
    random_pose,
    rotation_matrix,
)

# ---- sweeps through contact


def test_face_contact_has_slope_one() -> None:
    base, mover = Box((3, 3, 1)), Hull(box_corners((0.5, 0.5, 0.5)))
    heights = np.linspace(1.0, 3.0, 129)  # dyadic: every signed distance is a float64
    for height in heights:
        result = check_pair(base, mover, None, (0.25, -0.5, float(height)))
        assert distance_of(result) == pytest.approx(height - 1.5, abs=4 * UNIT)
        assert result.normal == pytest.approx((0, 0, 1), abs=4 * UNIT)
        expected = "touching" if height == 1.5 else "separated" if height > 1.5 else "penetrating"
        assert result.outcome == expected


SWEPT: dict[str, tuple[Any, Any, float]] = {
    "hulls": (
        Hull(random_hull(np.random.default_rng(1), 24)),
        Hull(random_hull(np.random.default_rng(2), 24)),
        EXACT,
    ),
    "boxes": (Box((0.7, 0.5, 0.9)), Box((0.4, 0.8, 0.6)), EXACT),
    "hull and capsule": (
        Hull(random_hull(np.random.default_rng(3), 12)),
        Capsule(0.3, 0.4),
        CURVED,
    ),
    "cylinder and cone": (Cylinder(0.5, 0.6), Cone(0.6, 0.5), CURVED),
    "ellipsoid and box": (Ellipsoid((0.4, 0.7, 0.9)), Box((0.5, 0.5, 0.5)), CURVED),
    "spheres": (Sphere(0.6), Sphere(0.4), CURVED),
}


@pytest.mark.parametrize("name", SWEPT)
@pytest.mark.parametrize("seed", range(4))
def test_sweep_is_continuous_and_crosses_zero_twice(name: str, seed: int) -> None:
    """Along a straight line the overlap is one interval, and the signed distance, a distance to a
    convex set seen from a moving point, changes by at most the step."""
    a, b, tolerance = SWEPT[name]
    rng = np.random.default_rng(seed)
    turned, direction = random_pose(rng, 0.0), random_direction(rng)
    offset = np.cross(direction, random_direction(rng)) * 0.2
    times = np.linspace(-3, 3, 241)
    distances = []
    for time in times:
        position = offset + direction * time
        result = check_pair(a, b, None, (*position.tolist(), *turned[3:]))
        assert_valid(result, tolerance)
        distances.append(distance_of(result))
    values = np.array(distances)
    assert np.abs(np.diff(values)).max() <= times[1] - times[0] + 2 * tolerance
    inside = values < 0
    assert int((inside[1:] != inside[:-1]).sum()) == 2
    # A signed distance to a convex set is convex: no dip between two points of the line.
    assert (values[2:] - 2 * values[1:-1] + values[:-2]).min() >= -4 * tolerance


# ---- symmetries


PAIRS: dict[str, tuple[Any, Any, float]] = SWEPT | {
    "hull and sphere": (Hull(random_hull(np.random.default_rng(5), 40)), Sphere(0.5), CURVED),
    "low-poly hulls": (
        Hull(random_hull(np.random.default_rng(6), 5)),
        Hull(random_hull(np.random.default_rng(7), 5)),
        EXACT,
    ),
}


@pytest.mark.parametrize("name", PAIRS)
@pytest.mark.parametrize("seed", range(6))
def test_swap_negates_the_normal(name: str, seed: int) -> None:
    a, b, tolerance = PAIRS[name]
    rng = np.random.default_rng(seed)
    pose_a, pose_b = random_pose(rng, 0.6), random_pose(rng, 0.6)
    one, other = check_pair(a, b, pose_a, pose_b), check_pair(b, a, pose_b, pose_a)
    assert one.outcome == other.outcome
    assert distance_of(one) == pytest.approx(distance_of(other), abs=tolerance)
    loose = math.sqrt(tolerance)
    assert np.array(one.normal) == pytest.approx(-np.array(other.normal), abs=10 * loose)
    for mine, yours in ((one.witness_a, other.witness_b), (one.witness_b, other.witness_a)):
        assert np.array(mine) == pytest.approx(np.array(yours), abs=10 * loose)


@pytest.mark.parametrize("name", PAIRS)
@pytest.mark.parametrize("spread", [1.0, 1000.0])
def test_rigid_motion_moves_the_answer_along(name: str, spread: float) -> None:
    a, b, tolerance = PAIRS[name]
    rng = np.random.default_rng(17)
    # Placing the pair far away rounds its coordinates: 4 roundoffs of the largest one.
    allowed = tolerance + 4 * spread * 2.0**-52
    for _ in range(6):
        pose_a, pose_b, motion = (random_pose(rng, s) for s in (0.6, 0.6, spread))
        here = check_pair(a, b, pose_a, pose_b)
        there = check_pair(a, b, compose(motion, pose_a), compose(motion, pose_b))
        assert here.outcome == there.outcome
        assert distance_of(here) == pytest.approx(distance_of(there), abs=allowed)
        turned = rotation_matrix(np.array(motion[3:])) @ np.array(here.normal)
        assert np.array(there.normal) == pytest.approx(turned, abs=10 * math.sqrt(allowed))


@pytest.mark.parametrize("exponent", [-40, -3, 1, 10, 40])
@pytest.mark.parametrize("count", [5, 24])
def test_powers_of_two_scale_bitwise(exponent: int, count: int) -> None:
    rng = np.random.default_rng(exponent + 100)
    factor = 2.0**exponent
    for _ in range(20):
        a, b, offset = random_hull(rng, count), random_hull(rng, count), rng.normal(size=3) * 0.8
        small = check_pair(Hull(a), Hull(b), None, tuple(offset.tolist()))
        large = check_pair(
            Hull(a * factor), Hull(b * factor), None, tuple((offset * factor).tolist())
        )
        assert (small.outcome, small.method, small.feature) == (
            (large.outcome, large.method, large.feature)
        )
        assert distance_of(small) * factor == large.distance
        assert small.normal == large.normal
        assert small.witness_a is not None
        assert small.witness_b is not None
        assert tuple(factor * c for c in small.witness_a) == large.witness_a
        assert tuple(factor * c for c in small.witness_b) == large.witness_b


# ---- the way out


@settings(max_examples=150, deadline=None, derandomize=True)
@given(st.integers(0, 2**32 - 1), st.sampled_from(sorted(PAIRS)))
def test_the_mtv_leaves_no_depth(seed: int, name: str) -> None:
    a, b, tolerance = PAIRS[name]
    rng = np.random.default_rng(seed)
    pose_a, pose_b = random_pose(rng, 0.2), random_pose(rng, 0.2)
    result = check_pair(a, b, pose_a, pose_b)
    depth = max(0.0, -distance_of(result))
    for extra, outcome in ((0.0, None), (4 * tolerance, "separated")):
        mtv = -(depth + extra) * np.array(result.normal)
        away = (*(np.array(pose_a[:3]) + mtv).tolist(), *pose_a[3:])
        after = check_pair(a, b, away, pose_b)
        assert distance_of(after) >= -2 * tolerance
        if outcome and depth > 0:
            assert after.outcome == outcome
