"""Every kind of shape against closed forms, and what a shape refuses."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from satcheck.core import Box, Capsule, Cone, Cylinder, Ellipsoid, Hull, Sphere, check_pair
from tests.core.pair_checks import CURVED, EXACT, IDENTITY, assert_valid, distance_of
from tests.oracles import brute_sat
from tests.oracles.random_shapes import (
    Points,
    apply,
    box_corners,
    compose,
    random_direction,
    random_hull,
    random_pose,
    rotation_matrix,
)

FRUSTUM = np.array(
    [[x, y, -0.5] for x in (-0.8, 0.8) for y in (-0.8, 0.8)]
    + [[x, y, 0.5] for x in (-0.4, 0.4) for y in (-0.4, 0.4)]
)

# One shape of each kind, symmetric about its z axis, and its half height.
STACKED: dict[str, tuple[Any, float]] = {
    "box": (Box((0.5, 0.6, 0.7)), 0.7),
    "hull": (Hull(FRUSTUM), 0.5),
    "sphere": (Sphere(0.6), 0.6),
    "capsule": (Capsule(0.3, 0.5), 0.8),
    "cylinder": (Cylinder(0.5, 0.7), 0.7),
    "cone": (Cone(0.6, 0.8), 0.8),
    "ellipsoid": (Ellipsoid((0.5, 0.8, 0.6)), 0.6),
}
KINDS = sorted(STACKED)


@pytest.mark.parametrize("lower", STACKED)
@pytest.mark.parametrize("upper", STACKED)
@pytest.mark.parametrize("gap", [0.25, 1e-6, -1e-6, -0.05])
def test_stack_of_two(lower: str, upper: str, gap: float) -> None:
    """One above the other: by symmetry the closest way is along z, gap or shallow overlap alike."""
    (a, half_a), (b, half_b) = STACKED[lower], STACKED[upper]
    turn = random_pose(np.random.default_rng(11), 1.0)
    raised = compose(turn, (0.0, 0.0, half_a + half_b + gap, 0.0, 0.0, 0.0, 1.0))
    result = check_pair(a, b, turn, raised)
    assert_valid(result, CURVED)
    assert result.outcome == ("separated" if gap > 0 else "penetrating")
    assert distance_of(result) == pytest.approx(gap, abs=CURVED)
    up = rotation_matrix(np.array(turn[3:]))[:, 2]
    # Away from the best axis a curved contact grows by theta^2 / 2 times a radius.
    assert np.abs(np.array(result.normal) - up).max() <= 10 * math.sqrt(CURVED)


def box_distance(p: Points, half: Points) -> float:
    q = np.abs(p) - half
    return float(np.linalg.norm(np.maximum(q, 0)) + min(q.max(), 0))


def profile_distance(p: Points, profile: list[tuple[float, float]]) -> float:
    """Signed distance of a body of revolution about z with a convex profile (radius, z), given
    from the axis below to the axis above."""
    q = np.array([math.hypot(p[0], p[1]), p[2]])
    nearest, inside = math.inf, True
    for tail, head in zip(np.array(profile[:-1]), np.array(profile[1:]), strict=True):
        along = head - tail
        t = np.clip((q - tail) @ along / (along @ along), 0, 1)
        nearest = min(nearest, float(np.linalg.norm(q - tail - t * along)))
        inside &= along[0] * (q - tail)[1] - along[1] * (q - tail)[0] > 0
    return -nearest if inside else nearest


POINT_DISTANCE: dict[str, tuple[Any, Callable[[Points], float]]] = {
    "sphere": (Sphere(0.7), lambda p: float(np.linalg.norm(p)) - 0.7),
    "box": (Box((0.4, 0.6, 0.8)), lambda p: box_distance(p, np.array([0.4, 0.6, 0.8]))),
    "capsule": (
        Capsule(0.4, 0.6),
        lambda p: float(np.linalg.norm([p[0], p[1], p[2] - np.clip(p[2], -0.6, 0.6)])) - 0.4,
    ),
    "cylinder": (
        Cylinder(0.5, 0.8),
        lambda p: profile_distance(p, [(0, -0.8), (0.5, -0.8), (0.5, 0.8), (0, 0.8)]),
    ),
    "cone": (Cone(0.7, 0.9), lambda p: profile_distance(p, [(0, -0.9), (0.7, -0.9), (0, 0.9)])),
    "hull": (Hull(FRUSTUM), lambda p: brute_sat.signed_distance(FRUSTUM, p[None]).distance),
}


@pytest.mark.parametrize("kind", POINT_DISTANCE)
def test_sphere_against_each_kind(kind: str) -> None:
    """The signed distance of a ball is that of its centre less the radius, outside and inside."""
    shape, point_distance = POINT_DISTANCE[kind]
    rng = np.random.default_rng(2)
    for _ in range(60):
        centre, radius = rng.uniform(-1.2, 1.2, 3), float(rng.uniform(0.05, 0.5))
        truth = point_distance(centre) - radius
        turn = random_pose(rng, 1.0)
        ball = compose(turn, (*centre.tolist(), 0.0, 0.0, 0.0, 1.0))
        result = check_pair(shape, Sphere(radius), turn, ball)
        assert_valid(result, CURVED)
        assert distance_of(result) == pytest.approx(truth, abs=CURVED)


@pytest.mark.parametrize("other", ["capsule", "box", "hull", "point"])
def test_capsule_is_a_thick_segment(other: str) -> None:
    rng = np.random.default_rng(4)
    segment = np.array([[0, 0, -0.5], [0, 0, 0.5]])
    for _ in range(60):
        pose_a, pose_b = random_pose(rng, 0.7), random_pose(rng, 0.7)
        shape, points, radius = {
            "capsule": (Capsule(0.2, 0.5), segment, 0.2),
            "box": (Box((0.3, 0.4, 0.5)), box_corners((0.3, 0.4, 0.5)), 0.0),
            "hull": (Hull(FRUSTUM), FRUSTUM, 0.0),
            "point": (Hull(np.zeros((1, 3))), np.zeros((1, 3)), 0.0),
        }[other]
        truth = brute_sat.signed_distance(apply(pose_a, segment), apply(pose_b, points))
        result = check_pair(Capsule(0.3, 0.5), shape, pose_a, pose_b)
        assert_valid(result, CURVED)
        assert distance_of(result) == pytest.approx(truth.distance - 0.3 - radius, abs=CURVED)


def support_value(kind: str, n: Points) -> float:
    """Support functions in closed form, written down independently of the core."""
    across, along = math.hypot(n[0], n[1]), float(n[2])
    return {
        "box": float(np.abs(n) @ [0.5, 0.6, 0.7]),
        "hull": float((FRUSTUM @ n).max()),
        "sphere": 0.6,
        "capsule": 0.3 + 0.5 * abs(along),
        "cylinder": 0.5 * across + 0.7 * abs(along),
        "cone": max(0.8 * along, 0.6 * across - 0.8 * along),
        "ellipsoid": float(np.linalg.norm(n * [0.5, 0.8, 0.6])),
    }[kind]


@pytest.mark.parametrize("kind", STACKED)
def test_any_shape_above_a_wide_floor(kind: str) -> None:
    """Against a plane the distance is the height less the support value straight down."""
    floor = Box((50.0, 50.0, 2.0))
    rng = np.random.default_rng(6)
    for gap in (0.5, 0.125, -0.125, -0.5):
        for _ in range(12):
            pose_b = random_pose(rng, 1.0)
            down = rotation_matrix(np.array(pose_b[3:])).T @ [0, 0, -1]
            height = 2.0 + support_value(kind, down) + gap
            result = check_pair(floor, STACKED[kind][0], None, (*pose_b[:2], height, *pose_b[3:]))
            assert_valid(result, 50 * CURVED)
            assert distance_of(result) == pytest.approx(gap, abs=50 * CURVED)
            assert result.outcome == ("separated" if gap > 0 else "penetrating")


@settings(max_examples=200, deadline=None, derandomize=True)
@given(
    st.integers(0, 2**32 - 1), st.sampled_from(sorted(STACKED)), st.sampled_from(sorted(STACKED))
)
def test_no_axis_overlaps_less_than_the_bounds_allow(seed: int, kind_a: str, kind_b: str) -> None:
    """The signed penetration is the least support value of A - B: sample it near the answer."""
    rng = np.random.default_rng(seed)
    pose_a, pose_b = random_pose(rng, 0.5), random_pose(rng, 0.5)
    result = check_pair(STACKED[kind_a][0], STACKED[kind_b][0], pose_a, pose_b)
    assert result.outcome != "undecided"
    assert result.lower is not None
    assert result.upper is not None
    to_a, to_b = (rotation_matrix(np.array(p[3:])).T for p in (pose_a, pose_b))
    offset = np.array(pose_a[:3]) - np.array(pose_b[:3])

    def overlap(n: Points) -> float:
        there = support_value(kind_a, to_a @ n) + support_value(kind_b, -(to_b @ n))
        return there + float(offset @ n)

    normal = np.array(result.normal)
    assert -overlap(normal) == pytest.approx(distance_of(result), abs=CURVED)
    for spread in (1e-6, 1e-3, 0.1, 10.0):
        for _ in range(20):
            other = normal + spread * rng.normal(size=3)
            least = overlap(other / np.linalg.norm(other))
            assert least >= -result.upper - EXACT


@pytest.mark.parametrize("gap", [0.3, 1e-7, -1e-7, -0.2])
def test_crossed_cylinders(gap: float) -> None:
    """Two long cylinders with perpendicular axes meet in one point between the axes."""
    quarter = math.sqrt(0.5)
    lying = (1.0 + gap, 0.0, 0.0, quarter, 0.0, 0.0, quarter)
    result = check_pair(Cylinder(0.6, 5.0), Cylinder(0.4, 5.0), IDENTITY, lying)
    assert_valid(result, 5 * CURVED)
    assert distance_of(result) == pytest.approx(gap, abs=5 * CURVED)


@pytest.mark.parametrize("depth", [0.2, 1e-3])
def test_cones_tip_in_tip(depth: float) -> None:
    """The shortest way apart is sideways off the slant: depth times the sine of the half angle."""
    cone, flipped = Cone(0.6, 0.8), (0.0, 0.0, 1.6 - depth, 1.0, 0.0, 0.0, 0.0)
    result = check_pair(cone, cone, IDENTITY, flipped)
    assert_valid(result, CURVED, width=1e-4 * depth)  # a ring of equal ways out: bounds stay open
    assert distance_of(result) == pytest.approx(-depth * 0.6 / math.hypot(0.6, 1.6), abs=CURVED)


def test_hull_takes_points_in_any_order_and_number() -> None:
    rng = np.random.default_rng(8)
    corners = box_corners((1, 1, 1))
    cloud = np.concatenate([rng.uniform(-1, 1, (100, 3)), corners, corners])
    rng.shuffle(cloud)
    direction = random_direction(rng) * 3
    other = Hull(random_hull(rng, 20) + direction)
    expected = distance_of(check_pair(Hull(corners), other))
    assert distance_of(check_pair(Hull(cloud), other)) == pytest.approx(expected, abs=1e-15)


@pytest.mark.parametrize(
    "build",
    [
        lambda: Sphere(0.0),
        lambda: Sphere(-1.0),
        lambda: Sphere(math.nan),
        lambda: Sphere(math.inf),
        lambda: Box((1.0, 0.0, 1.0)),
        lambda: Box((1.0, 1.0, math.nan)),
        lambda: Capsule(1.0, -1.0),
        lambda: Capsule(0.0, 1.0),
        lambda: Cylinder(0.0, 1.0),
        lambda: Cone(1.0, 0.0),
        lambda: Ellipsoid((1.0, 1.0, -1.0)),
        lambda: Hull(np.empty((0, 3))),
        lambda: Hull(np.array([[0.0, 0.0, math.nan]])),
        lambda: Hull(np.array([[0.0, 0.0, math.inf]])),
    ],
)
def test_nonsense_is_refused(build: Callable[[], Any]) -> None:
    with pytest.raises(ValueError, match=r"\w"):
        build()


@pytest.mark.parametrize(
    "pose",
    [
        (math.nan, 0.0, 0.0),
        (math.inf, 0.0, 0.0),
        (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0),
        (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, math.nan),
        (0.0, 0.0),
    ],
)
def test_a_pose_that_is_none_is_refused(pose: tuple[float, ...]) -> None:
    with pytest.raises(ValueError, match=r"\w"):
        check_pair(Sphere(1.0), Sphere(1.0), None, pose)  # type: ignore[arg-type,unused-ignore]
