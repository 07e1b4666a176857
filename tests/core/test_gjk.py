"""GJK: distance and witness points against closed forms and against all feature pairs."""

from __future__ import annotations

from typing import Literal

import numpy as np
import pytest

from satcheck.core import Hull, Sphere, check_pair
from tests.core.pair_checks import EXACT, assert_valid, distance_of
from tests.oracles import brute_sat
from tests.oracles.random_shapes import moved, random_direction, random_hull

# Rounds of one query: each keeps a simplex never seen before. Random hulls need 5 as a median.
MANY_ROUNDS = 60


@pytest.mark.parametrize("count", [4, 8, 16, 32, 100])
def test_distance_matches_the_oracle(count: int) -> None:
    rng = np.random.default_rng(count)
    for _ in range(40):
        a, b = random_hull(rng, count), random_hull(rng, count)
        b = b + random_direction(rng) * rng.uniform(2.0, 4.0)
        gap, on_a, on_b = brute_sat.distance(brute_sat.features(a), brute_sat.features(b))
        result = check_pair(Hull(a), Hull(b), query="distance", method="gjk")
        assert_valid(result, EXACT)
        assert result.outcome == "separated"
        assert distance_of(result) == pytest.approx(gap, abs=EXACT)
        assert 0 < result.gjk_iterations < MANY_ROUNDS
        # The closest points are unique here: no two faces are parallel. They are as good as the
        # square root of the distance's own error, per unit of size.
        assert np.abs(np.array(result.witness_a) - on_a).max() <= np.sqrt(EXACT)
        assert np.abs(np.array(result.witness_b) - on_b).max() <= np.sqrt(EXACT)


@pytest.mark.parametrize(
    ("a", "b", "gap"),
    [
        ([[0, 0, 0]], [[3, 4, 0]], 5.0),  # point, point
        ([[0, 0, 0]], [[-1, 2, 0], [1, 2, 0]], 2.0),  # point, segment
        ([[-1, 0, 0], [1, 0, 0]], [[0, -1, 3], [0, 1, 3]], 3.0),  # crossed segments
        ([[-1, 0, 0], [1, 0, 0]], [[-1, 1, 0], [1, 1, 0]], 1.0),  # parallel segments
        ([[0, 0, 0], [1, 0, 0]], [[3, 0, 0], [4, 0, 0]], 2.0),  # on one line
        ([[0.25, 0.25, 2]], [[0, 0, 0], [1, 0, 0], [0, 1, 0]], 2.0),  # point over a triangle
        ([[2, 2, 0]], [[0, 0, 0], [2, 0, 0], [0, 2, 0]], np.sqrt(2)),  # beside it, in its plane
        # parallel squares, one above the other; coplanar squares, side by side
        ([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], [[0, 0, 1], [1, 0, 1], [0, 1, 1]], 1.0),
        ([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], [[3, 0, 0], [4, 0, 0], [4, 1, 0]], 2.0),
    ],
)
def test_flat_hulls(a: list[list[float]], b: list[list[float]], gap: float) -> None:
    first, second = Hull(np.array(a, float)), Hull(np.array(b, float))
    for one, other in ((first, second), (second, first)):
        result = check_pair(one, other, query="distance")
        assert_valid(result, EXACT)
        assert result.outcome == "separated"
        assert distance_of(result) == pytest.approx(gap, rel=EXACT)


def test_touching_flat_hulls() -> None:
    square = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], float)
    segment = np.array([[0.5, 0.5, 0], [0.5, 0.5, 1]], float)
    cases = [
        (square, square),
        (square, moved(square, 0.5, 0, 0)),
        (square, moved(square, 1, 0, 0)),
        (square, segment),
        (segment, segment),
        (segment[:1], segment[:1]),
        (segment[:1], square),
    ]
    for a, b in cases:
        for method in ("auto", "gjk"):
            result = check_pair(Hull(a), Hull(b), method=method)
            assert result.outcome == "touching"
            assert distance_of(result) == pytest.approx(0.0, abs=EXACT)


def test_segment_through_a_polygon_penetrates() -> None:
    """Crossing flat shapes have a solid Minkowski difference: the way out is sideways."""
    square = np.array([[-2, -2, 0], [2, -2, 0], [2, 2, 0], [-2, 2, 0]], float)
    segment = np.array([[0.5, 1.5, -3], [0.5, 1.5, 3]], float)
    result = check_pair(Hull(square), Hull(segment))
    assert result.outcome == "penetrating"
    assert distance_of(result) == pytest.approx(-0.5, abs=EXACT)
    assert result.normal == pytest.approx((0, 1, 0), abs=EXACT)


def test_spheres_need_no_round() -> None:
    result = check_pair(Sphere(1.0), Sphere(0.5), None, (3.0, 0.0, 4.0), query="distance")
    assert distance_of(result) == pytest.approx(3.5, abs=EXACT)
    assert result.normal == pytest.approx((0.6, 0.0, 0.8), abs=EXACT)
    assert result.witness_a == pytest.approx((0.6, 0.0, 0.8), abs=EXACT)
    assert result.witness_b == pytest.approx((2.7, 0.0, 3.6), abs=EXACT)


def test_overlap_query_stops_at_the_first_separating_axis() -> None:
    rng = np.random.default_rng(9)
    a, b = Hull(random_hull(rng, 64)), Hull(random_hull(rng, 64))
    overlap = check_pair(a, b, None, (3.0, 1.0, 0.0), query="overlap")
    distance = check_pair(a, b, None, (3.0, 1.0, 0.0), query="distance")
    assert overlap.outcome == distance.outcome == "separated"
    # No point is farther than 1 from its origin: the line between the origins separates.
    assert overlap.portal_rounds == 1
    assert overlap.gjk_iterations == 0 < distance.gjk_iterations
    assert overlap.distance is None


def test_many_queries_change_no_bit() -> None:
    """A hull of many vertices that is asked often finds its supports another way."""
    rng = np.random.default_rng(10)
    a, b = Hull(random_hull(rng, 200)), Hull(random_hull(rng, 90))
    offsets = [tuple(random_direction(rng) * length) for length in rng.uniform(0.2, 2.5, 300)]
    queries: tuple[Literal["overlap", "depth", "distance"], ...] = ("overlap", "depth", "distance")

    def answers(offset: tuple[float, ...]) -> list[str]:
        results = [check_pair(a, b, None, offset, query=q) for q in queries]
        fields = ("outcome", "distance", "lower", "upper", "normal", "witness_a", "witness_b")
        return [repr([getattr(result, field) for field in fields]) for result in results]

    first = [answers(offset) for offset in offsets[:20]]
    for offset in offsets:
        check_pair(a, b, None, offset, query="overlap")
    assert [answers(offset) for offset in offsets[:20]] == first
