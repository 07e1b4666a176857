"""The oracles against each other: float64 against rationals, and against cases known by hand."""

from __future__ import annotations

import math
from fractions import Fraction

import numpy as np
import pytest

from tests.oracles import brute_sat, exact_distance, exact_pair
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


@pytest.mark.parametrize("seed", range(150))
def test_both_rational_oracles_agree(seed: int) -> None:
    """On generic sets, and on a lattice where everything is degenerate."""
    rng = np.random.default_rng(seed)
    counts = rng.integers(1, 8, size=2)
    a, b = (rng.integers(-3, 4, size=(n, 3)) / 4 for n in counts)
    if seed % 2:
        a, b = (rng.normal(size=(n, 3)) for n in counts)
    truth = exact_distance.exact_truth(a, b)
    assert truth.outcome == exact_pair.exact_outcome(a, b)
    if truth.outcome == "penetrating":
        low, high = exact_distance.root(exact_pair.exact_squared_depth(a, b))
        assert (truth.low, truth.high) == (-high, -low)
    else:
        square = exact_pair.exact_squared_distance(a, b)
        assert (truth.low, truth.high) == exact_distance.root(square)


def test_roots_are_enclosed() -> None:
    for square in (Fraction(9, 4), Fraction(2), Fraction(1, 3**200), Fraction(7**150)):
        low, high = exact_distance.root(square)
        assert low**2 <= square <= high**2
        assert (high - low) * 2**250 <= high
    assert exact_distance.root(Fraction(9, 4)) == (Fraction(3, 2), Fraction(3, 2))


def test_flat_sets_have_no_interior() -> None:
    square = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], float)
    segment = np.array([[0.5, 0.5, 0], [0.5, 0.5, 1]], float)
    for a, b in ((square, square), (square, segment), (segment, segment), (square[:1], square)):
        assert exact_pair.exact_outcome(a, b) == "touching"
        assert exact_pair.exact_squared_depth(a, b) == 0
        assert brute_sat.signed_distance(a, b).distance == 0
