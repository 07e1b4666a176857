"""EPA on signed face distances: depth with bounds, also where the classical start breaks."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from satcheck.core import Box, Cone, Cylinder, Ellipsoid, Hull, Sphere, check_pair
from tests.core.pair_checks import CURVED, EXACT, assert_valid, distance_of
from tests.oracles import brute_sat
from tests.oracles.random_shapes import box_corners, moved, random_hull, random_pose

# The thinnest shape below is a thousandth as wide as long.
SLENDER = 1e3

# Bounds of a ball-like overlap of curved shapes, after the expansions that it is granted.
OPEN = 2e-2

# Expansions of one query on polytopes; medians are 5 to 26.
MANY_EXPANSIONS = 400


@pytest.mark.parametrize("count", [4, 8, 16, 32, 64])
def test_depth_matches_the_oracle(count: int) -> None:
    rng = np.random.default_rng(count)
    for _ in range(30):
        a, b = random_hull(rng, count), random_hull(rng, count) + rng.normal(size=3) * 0.3
        truth = brute_sat.signed_distance(a, b)
        result = check_pair(Hull(a), Hull(b), method="gjk")
        assert_valid(result, EXACT)
        assert distance_of(result) == pytest.approx(truth.distance, abs=EXACT)
        assert result.epa_iterations < MANY_EXPANSIONS


def octahedron(radius: float) -> np.ndarray[tuple[int, int], np.dtype[np.float64]]:
    return np.concatenate([np.eye(3), -np.eye(3)]) * radius


ORIGIN_ON_A_FEATURE = {
    "identical cubes": (box_corners((1, 1, 1)), box_corners((1, 1, 1))),
    "concentric cubes": (box_corners((1, 1, 1)), box_corners((0.5, 0.5, 0.5))),
    "identical octahedra": (octahedron(1.0), octahedron(1.0)),
    "concentric octahedra": (octahedron(1.0), octahedron(0.25)),
    "cube on an axis": (box_corners((1, 1, 1)), moved(box_corners((1, 1, 1)), 0.5, 0, 0)),
    "cube on a diagonal": (box_corners((1, 1, 1)), moved(box_corners((1, 1, 1)), 0.5, 0.5, 0.5)),
    "needle in a cube": (box_corners((1, 1, 1)), box_corners((1e-3, 1e-3, 3))),
    "plate in a cube": (box_corners((1, 1, 1)), box_corners((3, 3, 1e-3))),
    "octahedron tip in a face": (box_corners((1, 1, 1)), moved(octahedron(1.0), 0, 0, 1.75)),
}


@pytest.mark.parametrize("name", ORIGIN_ON_A_FEATURE)
@pytest.mark.parametrize("turn", [False, True])
def test_origin_on_a_feature_of_the_first_simplex(name: str, turn: bool) -> None:
    a, b = ORIGIN_ON_A_FEATURE[name]
    pose = random_pose(np.random.default_rng(3), 1.0) if turn else None
    truth = brute_sat.signed_distance(a, b)
    result = check_pair(Hull(a), Hull(b), pose, pose, method="gjk")
    # The proof grants a facet that is w wide an error of 40 roundoffs of the scale over w.
    assert_valid(result, EXACT, width=SLENDER * EXACT)
    assert result.outcome == "penetrating"
    assert distance_of(result) == pytest.approx(truth.distance, rel=EXACT)


@pytest.mark.parametrize("size", [1e-9, 1e-3, 1e3, 1e9])
def test_bounds_have_no_absolute_epsilon(size: float) -> None:
    rng = np.random.default_rng(7)
    a, b = random_hull(rng, 20), moved(random_hull(rng, 20), 0.5, 0.3, 0.1)
    truth = brute_sat.signed_distance(a, b)
    result = check_pair(Hull(a * size), Hull(b * size), method="gjk")
    assert_valid(result, EXACT * size)
    assert distance_of(result) == pytest.approx(truth.distance * size, rel=100 * EXACT)


CONCENTRIC = [
    (Sphere(1.0), Sphere(1.0), 2.0),
    (Sphere(1.0), Sphere(0.25), 1.25),
    (Ellipsoid((1.0, 2.0, 3.0)), Ellipsoid((1.0, 2.0, 3.0)), 2.0),
    (Ellipsoid((1.0, 1.0, 1.0)), Ellipsoid((1.0, 1.0, 1.0)), 2.0),
    (Cylinder(1.0, 2.0), Cylinder(1.0, 2.0), 2.0),
    (Cylinder(1.0, 3.0), Sphere(0.5), 1.5),
    (Cylinder(1.0, 2.0), Box((3.0, 3.0, 0.5)), 2.5),
    (Cone(1.0, 1.0), Cone(1.0, 1.0), 4 / math.sqrt(5)),
]


@pytest.mark.parametrize(("a", "b", "depth"), CONCENTRIC)
def test_concentric_curved_shapes(a: Any, b: Any, depth: float) -> None:
    """Where all ways out are equally long the bounds close slowly: they stay open, and honest."""
    result = check_pair(a, b)
    assert_valid(result, CURVED, width=OPEN * depth)
    assert result.outcome == "penetrating"
    assert distance_of(result) == pytest.approx(-depth, abs=OPEN * depth)
    assert result.lower is not None
    assert result.upper is not None
    assert result.lower <= -depth <= result.upper


def test_containment_leaves_by_the_shorter_way() -> None:
    for shape, tolerance in (
        (Sphere(0.5), CURVED),
        (Ellipsoid((0.5, 0.5, 0.5)), CURVED),
        (Box((0.5, 0.5, 0.5)), EXACT),
        (Hull(box_corners((0.5, 0.5, 0.5))), EXACT),
    ):
        result = check_pair(Box((2, 3, 4)), shape, None, (-1.0, 0.5, 0.25))
        assert_valid(result, tolerance)
        assert distance_of(result) == pytest.approx(-1.5, abs=tolerance)
        assert result.normal == pytest.approx((-1, 0, 0), abs=CURVED)
