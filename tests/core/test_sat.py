"""SAT: boxes on 15 axes, low-poly polytopes on faces and arcs, against the unpruned oracle."""

from __future__ import annotations

import math

import numpy as np
import pytest

from satcheck.core import Box, Hull, check_pair
from tests.core.pair_checks import EXACT, METHODS, Method, assert_valid, distance_of
from tests.oracles import brute_sat
from tests.oracles.random_shapes import apply, box_corners, random_hull, random_pose


@pytest.mark.parametrize("seed", range(200))
def test_boxes_match_the_oracle(seed: int) -> None:
    rng = np.random.default_rng(seed)
    half_a, half_b = (tuple(rng.uniform(0.2, 1.0, 3).tolist()) for _ in "ab")
    pose_a, pose_b = random_pose(rng, 0.6), random_pose(rng, 0.6)
    truth = brute_sat.signed_distance(
        apply(pose_a, box_corners(half_a)), apply(pose_b, box_corners(half_b))
    )
    result = check_pair(Box(half_a), Box(half_b), pose_a, pose_b)
    assert_valid(result, EXACT)
    assert result.outcome == ("penetrating" if truth.distance < 0 else "separated")
    assert distance_of(result) == pytest.approx(truth.distance, abs=EXACT)
    if truth.distance < 0:
        assert result.method == "sat"


@pytest.mark.parametrize("count", [4, 5, 6, 8, 12])
def test_polytopes_match_the_oracle(count: int) -> None:
    rng = np.random.default_rng(count)
    for _ in range(60):
        a, b = random_hull(rng, count), random_hull(rng, count) + rng.normal(size=3) * 0.6
        truth = brute_sat.signed_distance(a, b)
        result = check_pair(Hull(a), Hull(b), method="sat")
        assert_valid(result, EXACT)
        assert distance_of(result) == pytest.approx(truth.distance, abs=EXACT)
        assert (result.outcome == "penetrating") == (truth.distance < 0)


def test_sat_and_gjk_agree() -> None:
    rng = np.random.default_rng(5)
    for _ in range(100):
        a, b = Hull(random_hull(rng, 10)), Hull(random_hull(rng, 10))
        pose_b = random_pose(rng, 0.7)
        by_sat = check_pair(a, b, None, pose_b, method="sat")
        by_gjk = check_pair(a, b, None, pose_b, method="gjk")
        assert by_sat.outcome == by_gjk.outcome
        assert distance_of(by_sat) == pytest.approx(distance_of(by_gjk), abs=EXACT)


def test_mtv_is_the_axis_of_least_overlap() -> None:
    result = check_pair(Box((1, 1, 1)), Box((1, 1, 1)), None, (1.5, 0.25, -0.5))
    assert result.outcome == "penetrating"
    assert result.distance == -0.5
    assert result.normal == (1.0, 0.0, 0.0)
    assert result.method == "sat"


@pytest.mark.parametrize("offset", [0.0, 0.25, -0.25])
def test_containment_leaves_by_the_shorter_way(offset: float) -> None:
    result = check_pair(Box((5, 5, 5)), Box((1, 1, 1)), None, (offset, 0.0, 4.0 - abs(offset)))
    assert distance_of(result) == -(5 + 1 - (4 - abs(offset)))
    assert result.normal == (0.0, 0.0, 1.0)
    inner = check_pair(Box((1, 1, 1)), Box((5, 5, 5)), None, (offset, 0.0, 3.0))
    assert distance_of(inner) == -3.0
    assert inner.normal == (0.0, 0.0, 1.0)


def test_edge_against_edge() -> None:
    """Two cubes, each turned by 45 degrees about its own axis, meet along crossed edges."""
    half_turn = math.sin(math.pi / 8), math.cos(math.pi / 8)
    about_x = (0.0, 0.0, 0.0, half_turn[0], 0.0, 0.0, half_turn[1])
    for gap in (-0.125, 0.125):
        raised = (0.0, 0.0, 2 * math.sqrt(2) + gap, 0.0, half_turn[0], 0.0, half_turn[1])
        result = check_pair(Box((1, 1, 1)), Box((1, 1, 1)), about_x, raised)
        assert distance_of(result) == pytest.approx(gap, abs=EXACT)
        assert result.normal == pytest.approx((0, 0, 1), abs=EXACT)
        if gap < 0:
            assert result.feature == "edge-edge"


@pytest.mark.parametrize("angle", [1e-3, 1e-6, 1e-9, 1e-12, 1e-15])
def test_nearly_parallel_edges(angle: float) -> None:
    """Cross products of nearly parallel edges are noise; the answer must not be."""
    pose_b = (1.75, 0.0, 0.0, 0.0, 0.0, math.sin(angle / 2), math.cos(angle / 2))
    corners = box_corners((1, 1, 1))
    truth = brute_sat.signed_distance(corners, apply(pose_b, corners))
    result = check_pair(Box((1, 1, 1)), Box((1, 1, 1)), None, pose_b)
    assert distance_of(result) == pytest.approx(truth.distance, abs=EXACT)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("width", [1.0, 0.05])
@pytest.mark.parametrize("angle", [1e-3, 9e-7, 3e-8, 1e-10])
@pytest.mark.parametrize("share", [0.3, 0.05, -0.1])
def test_nearly_parallel_edges_that_cross(
    method: Method, width: float, angle: float, share: float
) -> None:
    """Two bars on edge, one over the other and turned a little: the cross product of those edges
    alone tells how far they are apart, when that is less than the angle times their length."""
    gap = share * angle
    half_roll = math.sin(math.pi / 8), math.cos(math.pi / 8)
    half_turn = math.sin(angle / 2), math.cos(angle / 2)
    below = (0.0, 0.0, 0.0, half_roll[0], 0.0, 0.0, half_roll[1])
    turned = (
        half_turn[1] * half_roll[0],
        half_turn[0] * half_roll[0],
        half_turn[0] * half_roll[1],
        half_turn[1] * half_roll[1],
    )
    above = (0.0, 0.0, 2 * math.sqrt(2) * width + gap, *turned)
    bar = Box((1, width, width))
    for query in ("overlap", "depth", "distance"):
        result = check_pair(bar, bar, below, above, query=query, method=method)
        assert result.outcome == ("separated" if gap > 0 else "penetrating")
        if query != "overlap":
            assert distance_of(result) == pytest.approx(gap, abs=EXACT)


@pytest.mark.parametrize("method", METHODS)
def test_identical_and_concentric_shapes_break_ties_the_same_way(method: Method) -> None:
    cube = Box((1, 1, 1))
    for other, depth in ((cube, 2.0), (Box((0.5, 0.5, 0.5)), 1.5), (Box((1, 1, 3)), 2.0)):
        results = [check_pair(cube, other, method=method) for _ in range(3)]
        assert distance_of(results[0]) == -depth
        assert results[0].normal == results[1].normal == results[2].normal
        assert results[0].witness_a == results[1].witness_a == results[2].witness_a


def test_early_out_needs_fewer_axes() -> None:
    far = check_pair(Box((1, 1, 1)), Box((1, 1, 1)), None, (3.0, 0.0, 0.0), query="overlap")
    deep = check_pair(Box((1, 1, 1)), Box((1, 1, 1)), None, (0.5, 0.0, 0.0), query="overlap")
    assert (far.outcome, deep.outcome) == ("separated", "penetrating")
    assert far.axes_tested < deep.axes_tested
    assert far.distance is None
    assert deep.distance is None


def test_slivers_between_faces_back_to_back() -> None:
    """Coplanar but for rounding: the arcs of the edges around are half circles, on either side."""
    rng = np.random.default_rng(6)
    quad = np.array([(2.0, 0, 0), (0, 2, 0), (-2, 0, 0), (0, -2, 0)])
    overlaps = 0
    for _ in range(200):
        sliver, other = Hull(apply(random_pose(rng, 0.5), quad)), Hull(random_hull(rng, 4))
        by_sat = check_pair(sliver, other, method="sat")
        by_gjk = check_pair(sliver, other, method="gjk")
        assert by_sat.outcome == by_gjk.outcome
        assert by_sat.lower is not None
        assert by_sat.upper is not None
        assert by_gjk.lower is not None
        assert by_gjk.upper is not None
        assert by_sat.lower <= by_gjk.upper
        assert by_gjk.lower <= by_sat.upper
        overlaps += by_sat.outcome == "penetrating" and by_sat.method == "sat"
    assert overlaps > 50
