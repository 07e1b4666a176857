"""The oracles against each other: float64 against rationals, and against cases known by hand."""

from __future__ import annotations

import math

import numpy as np
import pytest

from tests.oracles import brute_sat, exact_pair
from tests.oracles.random_shapes import box_corners, moved

CUBE = box_corners((1, 1, 1))

# Both are a handful of roundoffs of a size of about 4 away from the truth.
AGREEMENT = 1e-14


@pytest.mark.parametrize(
    ("offset", "outcome", "distance"),
    [
        ((1.5, 0.25, 0), "penetrating", -0.5),
        ((0, 0, 0), "penetrating", -2.0),
        ((2, 0, 0), "touching", 0.0),
        ((2, 2, 2), "touching", 0.0),
        ((3, 0, 0), "separated", 1.0),
        ((5, 6, 0), "separated", 5.0),
        ((3, 4, 4), "separated", 3.0),
    ],
)
def test_cubes(offset: tuple[float, float, float], outcome: str, distance: float) -> None:
    other = moved(CUBE, *offset)
    assert exact_pair.exact_outcome(CUBE, other) == outcome
    assert brute_sat.signed_distance(CUBE, other).distance == pytest.approx(distance, abs=AGREEMENT)


@pytest.mark.parametrize("seed", range(30))
def test_float_and_rational_agree(seed: int) -> None:
    rng = np.random.default_rng(seed)
    a = rng.normal(size=(int(rng.integers(4, 8)), 3))
    b = rng.normal(size=(int(rng.integers(1, 8)), 3)) + rng.normal(size=3)
    distance = brute_sat.signed_distance(a, b).distance
    if exact_pair.exact_outcome(a, b) == "penetrating":
        truth = -math.sqrt(exact_pair.exact_squared_depth(a, b))
    else:
        truth = math.sqrt(exact_pair.exact_squared_distance(a, b))
    assert distance == pytest.approx(truth, abs=AGREEMENT)


def test_flat_sets_have_no_interior() -> None:
    square = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], float)
    segment = np.array([[0.5, 0.5, 0], [0.5, 0.5, 1]], float)
    for a, b in ((square, square), (square, segment), (segment, segment), (square[:1], square)):
        assert exact_pair.exact_outcome(a, b) == "touching"
        assert exact_pair.exact_squared_depth(a, b) == 0
        assert brute_sat.signed_distance(a, b).distance == 0
