"""The narrow phase as a whole: exact verdicts, a second opinion, properties."""

from __future__ import annotations

import math
from fractions import Fraction
from typing import Any

import fcl
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial import ConvexHull

from satcheck.core import Box, Capsule, Cone, Cylinder, Ellipsoid, Hull, Sphere, check_pair
from tests.core.pair_checks import EXACT, IDENTITY, METHODS, Method, assert_valid, distance_of
from tests.oracles import brute_sat, exact_pair
from tests.oracles.random_shapes import (
    Points,
    apply,
    box_corners,
    moved,
    random_hull,
    random_pose,
    rotation_matrix,
)

CUBE = box_corners((1, 1, 1))

# FCL's signed distance against the oracle on the same random hulls: at most 7.3e-16 of a size of
# about 2. Its libccd stop adds nothing on polytopes. Twice the sum with our own bound.
FCL_ERROR = 2 * (EXACT + 1e-15)


# ---- exact verdicts on the float64 coordinates


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("kind", ["hull", "box"])
@pytest.mark.parametrize(
    "offset",
    [(2, 0, 0), (2, 0.5, -0.25), (2, 2, 0), (2, 2, 0.75), (2, 2, 2), (-2, 2, -2), (0, 0, -2)],
)
def test_cubes_that_touch(method: Method, kind: str, offset: tuple[float, ...]) -> None:
    """Faces, edges and corners that meet exactly."""
    shape: Any = Box((1, 1, 1)) if kind == "box" else Hull(CUBE)
    for query in ("overlap", "depth", "distance"):
        result = check_pair(shape, shape, None, offset, query=query, method=method)
        assert result.outcome == "touching"
        if query != "overlap":
            assert_valid(result, EXACT)
            assert distance_of(result) == 0.0


@pytest.mark.parametrize("method", METHODS)
def test_one_ulp_decides(method: Method) -> None:
    for toward, outcome in ((math.inf, "separated"), (-math.inf, "penetrating")):
        step = math.nextafter(1.0, toward)
        above = np.where(CUBE < 0, step, 3.0)
        for axis in range(3):
            other = np.where(np.arange(3) == axis, above, CUBE)
            assert check_pair(Hull(CUBE), Hull(other), method=method).outcome == outcome
            assert exact_pair.exact_outcome(CUBE, other) == outcome


lattice_points = st.lists(
    st.tuples(*[st.integers(-3, 3)] * 3), min_size=1, max_size=7, unique=True
).map(lambda points: np.array(points, float) / 4)


@settings(max_examples=300, deadline=None, derandomize=True)
@given(lattice_points, lattice_points, st.sampled_from(METHODS))
def test_verdicts_on_a_lattice_are_exact(a: Points, b: Points, method: Method) -> None:
    """Small integers touch, coincide and degenerate all the time, in every way there is."""
    truth = exact_pair.exact_outcome(a, b)
    assert check_pair(Hull(a), Hull(b), query="overlap", method=method).outcome == truth
    result = check_pair(Hull(a), Hull(b), method=method)
    assert result.outcome == truth
    assert_valid(result, EXACT)
    if truth == "separated":
        squared = exact_pair.exact_squared_distance(a, b)
        assert distance_of(result) == pytest.approx(math.sqrt(squared), abs=EXACT)
    else:
        squared = exact_pair.exact_squared_depth(a, b)
        assert distance_of(result) == pytest.approx(-math.sqrt(squared), abs=EXACT)


@pytest.mark.parametrize("seed", range(40))
def test_bounds_hold_exactly(seed: int) -> None:
    """lower <= true signed distance <= upper, compared as squares of exact rationals."""
    rng = np.random.default_rng(seed)
    a, b = random_hull(rng, 6), random_hull(rng, 6) + rng.normal(size=3) * 0.7
    result = check_pair(Hull(a), Hull(b))
    assert result.lower is not None
    assert result.upper is not None
    if result.outcome == "penetrating":
        squared = exact_pair.exact_squared_depth(a, b)
        small, large = Fraction(max(-result.upper, 0.0)), Fraction(-result.lower)
    else:
        squared = exact_pair.exact_squared_distance(a, b)
        small, large = Fraction(max(result.lower, 0.0)), Fraction(result.upper)
    assert small**2 <= squared <= large**2


# ---- a second opinion


def fcl_hull(points: Points) -> Any:
    hull = ConvexHull(points)
    faces: list[int] = []
    for triangle, plane in zip(hull.simplices, hull.equations, strict=True):
        p, q, r = points[triangle]
        outward = np.cross(q - p, r - p) @ plane[:3] > 0
        faces += [3, *(int(i) for i in (triangle if outward else triangle[::-1]))]
    return fcl.Convex(points.copy(), len(hull.simplices), np.array(faces))


def fcl_signed_distance(a: Any, b: Any, rotation: Points, translation: Points) -> float:
    request = fcl.DistanceRequest(enable_nearest_points=True, enable_signed_distance=True)
    placed = fcl.CollisionObject(b, fcl.Transform(rotation, translation))
    return float(fcl.distance(fcl.CollisionObject(a), placed, request, fcl.DistanceResult()))


@pytest.mark.parametrize("count", [6, 12, 30])
def test_fcl_signed_distance_agrees_on_hulls(count: int) -> None:
    rng = np.random.default_rng(count)
    for _ in range(60):
        a, b, pose_b = random_hull(rng, count), random_hull(rng, count), random_pose(rng, 0.8)
        rotation = rotation_matrix(np.array(pose_b[3:]))
        opinion = fcl_signed_distance(fcl_hull(a), fcl_hull(b), rotation, np.array(pose_b[:3]))
        result = check_pair(Hull(a), Hull(b), None, pose_b)
        assert distance_of(result) == pytest.approx(opinion, abs=FCL_ERROR)


def test_fcl_signed_distance_agrees_on_boxes() -> None:
    rng = np.random.default_rng(1)
    for _ in range(100):
        half_a, half_b = rng.uniform(0.3, 1, 3), rng.uniform(0.3, 1, 3)
        pose_b = random_pose(rng, 0.9)
        hull_a, hull_b = (fcl_hull(box_corners(tuple(half.tolist()))) for half in (half_a, half_b))
        rotation = rotation_matrix(np.array(pose_b[3:]))
        opinion = fcl_signed_distance(hull_a, hull_b, rotation, np.array(pose_b[:3]))
        result = check_pair(Box(tuple(half_a.tolist())), Box(tuple(half_b.tolist())), None, pose_b)
        assert distance_of(result) == pytest.approx(opinion, abs=FCL_ERROR)


# ---- properties


coordinate = st.floats(-1, 1, allow_nan=False, width=32)
clouds = st.lists(st.tuples(coordinate, coordinate, coordinate), min_size=1, max_size=14).map(
    lambda points: np.array(points, float)
)
seeds = st.integers(0, 2**32 - 1)


@settings(max_examples=300, deadline=None, derandomize=True)
@given(clouds, clouds, seeds)
def test_any_two_point_clouds_get_a_consistent_answer(a: Points, b: Points, seed: int) -> None:
    pose_b = random_pose(np.random.default_rng(seed), 0.5)
    result = check_pair(Hull(a), Hull(b), IDENTITY, pose_b)
    assert_valid(result, EXACT)
    overlap = check_pair(Hull(a), Hull(b), IDENTITY, pose_b, query="overlap")
    assert overlap.outcome == result.outcome
    assert distance_of(check_pair(Hull(a), Hull(b), IDENTITY, pose_b, query="distance")) == (
        pytest.approx(distance_of(result), abs=EXACT)
    )


@settings(max_examples=150, deadline=None, derandomize=True)
@given(seeds, st.integers(4, 40), st.sampled_from(METHODS))
def test_random_hulls_match_the_oracle(seed: int, count: int, method: Method) -> None:
    rng = np.random.default_rng(seed)
    a, b, pose_b = random_hull(rng, count), random_hull(rng, count), random_pose(rng, 0.7)
    truth = brute_sat.signed_distance(a, apply(pose_b, b))
    result = check_pair(Hull(a), Hull(b), None, pose_b, method=method)
    assert_valid(result, 10 * EXACT)
    assert distance_of(result) == pytest.approx(truth.distance, abs=10 * EXACT)


def test_undecided_never_comes_without_a_reason() -> None:
    """Nested shells of equal balls are the worst for a loop that must close its bounds."""
    shapes = [Sphere(1.0), Ellipsoid((1, 1, 1)), Cylinder(1, 1), Cone(1, 1), Capsule(1, 1)]
    for a in shapes:
        for b in shapes:
            for offset in (0.0, 1e-12, 1e-9, 1e-3):
                result = check_pair(a, b, None, (offset, 0.0, 0.0))
                assert result.outcome == "penetrating" or result.reason != ""
                assert result.outcome == "penetrating"


def test_needle_far_away() -> None:
    """A pair a thousand sizes from the origin keeps its digits."""
    needle = moved(box_corners((1e-3, 1e-3, 1.0)), 1024.0, -2048.0, 512.0)
    cube = moved(CUBE, 1024.0 + 1.0, -2048.0, 512.0)
    result = check_pair(Hull(needle), Hull(cube))
    width = float(needle[:, 0].max() - cube[:, 0].min())
    assert distance_of(result) == pytest.approx(-width, abs=EXACT)


# Two splinters 2.7e-14 apart: GJK ends around the origin, EPA then finds a gap.
SPLINTER = (
    (-0.2916226806406031, -0.6817073229871919, 0.6709928002010347),
    (-0.29162268064060565, -0.6817073229852073, 0.67099280020305),
    (0.2916226806392516, 0.6817073229864927, -0.6709928002023325),
    (0.2916226806419571, 0.6817073229859065, -0.6709928002017521),
)
SPLINTER_BESIDE = (
    (-0.18244449134203333, -0.4264885896842243, 0.4197853879490403),
    (-0.18244449134031449, -0.4264885896841034, 0.4197853879512832),
    (1.395446119902908, -0.26387175483155223, -0.7983348786780129),
    (1.395446119903164, -0.26387175483436875, -0.7983348786780571),
)


@pytest.mark.parametrize("power", [0, -1, -2, -9, 7])
def test_witness_points_of_splinters_go_along_with_the_scale(power: int) -> None:
    def found(factor: float) -> Any:
        a, b = (
            Hull([[x * factor for x in point] for point in points])
            for points in (SPLINTER, SPLINTER_BESIDE)
        )
        return check_pair(a, b)

    factor = 2.0**power
    one, scaled = found(1.0), found(factor)
    assert scaled.distance == one.distance * factor
    for mine, theirs in ((scaled.witness_a, one.witness_a), (scaled.witness_b, one.witness_b)):
        assert mine == tuple(x * factor for x in theirs)
    # On both needles, which are 1e-11 wide at most.
    for witness, points in ((one.witness_a, SPLINTER), (one.witness_b, SPLINTER_BESIDE)):
        start, end = np.array(points[0]), np.array(points[2])
        share = np.dot(np.subtract(witness, start), end - start) / np.dot(end - start, end - start)
        assert 0 <= share <= 1
        assert np.linalg.norm(start + share * (end - start) - witness) < 1e-11


# ---- hulls far from their own origin


def test_a_translation_that_undoes_the_place_of_a_hull() -> None:
    """A point where a segment's pose rounds its end to: they touch, whatever cancels on the way."""
    rng = np.random.default_rng(2)
    for _ in range(300):
        start, way = rng.uniform(-30, 30, 3), rng.uniform(-1, 1, 3) * 2.0**31
        still, moving = Hull([start + way]), Hull([start, start + rng.normal(size=3)])
        for query in ("overlap", "distance"):
            assert check_pair(still, moving, None, tuple(way), query=query).outcome == "touching"
            assert check_pair(moving, still, tuple(way), None, query=query).outcome == "touching"


def test_bounds_hold_for_a_turned_point_above_a_cylinder() -> None:
    rng = np.random.default_rng(3)
    for _ in range(200):
        point, q = rng.uniform(-1e9, 1e9, 3), rng.normal(size=4)
        turned = rotation_matrix(q) @ point
        place = -turned + rng.uniform(-0.3, 0.3, 3) + [0, 0, 1.0 + 1e-5]
        x, y, z, w = (Fraction(c) for c in q)
        row = (2 * (x * z - y * w), 2 * (y * z + x * w), w * w + z * z - x * x - y * y)
        up = sum((r * Fraction(c) for r, c in zip(row, point, strict=True)), Fraction(0))
        height = up / (x * x + y * y + z * z + w * w) + Fraction(place[2])
        result = check_pair(Cylinder(1, 1), Hull([point]), None, (*place, *q), query="distance")
        assert result.lower is not None
        assert result.upper is not None
        if height > 1:
            assert Fraction(result.lower) <= height - 1 <= Fraction(result.upper)
        assert result.outcome != ("penetrating" if height > 1 else "separated")
        place[2] -= result.distance
        at_touch = check_pair(Cylinder(1, 1), Hull([point]), None, (*place, *q), query="distance")
        assert at_touch.outcome == "undecided"
        assert at_touch.reason == "bounds-not-closed"


# A triangle 5e-7 wide, 0.5 long: no tetrahedron of it and a point is thick enough for a polytope.
NEEDLE = (
    (-0.06579076084277101, 0.2669132830999158, -0.21491994897139222),
    (-0.15845738704110598, 0.6428602779427403, -0.5176336556509573),
    (-0.09027607758531953, 0.3662486135034199, -0.2949045546719163),
)


@pytest.mark.parametrize("query", ["depth", "distance"])
def test_what_lies_on_a_needle_is_measured(query: Any) -> None:
    rng = np.random.default_rng(4)
    for _ in range(50):
        point = rng.dirichlet([1, 1, 1]) @ np.array(NEEDLE)
        alone = check_pair(Hull([point]), Hull(NEEDLE), query=query)
        assert alone.distance is not None
        assert 0 <= alone.distance < 1e-15
        ball = check_pair(Sphere(0.1), Hull(NEEDLE), tuple(point), query=query)
        assert ball.lower is not None
        assert ball.upper is not None
        assert ball.lower - 1e-15 <= -0.1 <= ball.upper + 1e-15
        assert ball.upper - ball.lower < 1e-11
