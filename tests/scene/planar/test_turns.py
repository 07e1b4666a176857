"""Exact signs in the plane."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest

from satcheck.scene.planar.turns import turns

TRIANGLE = np.array([[0, 1, 2]])


@pytest.mark.parametrize("scale", [1.0, 2.0**-500, 2.0**500, 5e-324 * 2**60])
def test_signs(scale: float) -> None:
    points = np.array([(0.0, 0.0), (1.0, 0.0), (0.5, 1.0)]) * scale
    assert turns(points, TRIANGLE).tolist() == [1]
    assert turns(points, TRIANGLE[:, ::-1]).tolist() == [-1]
    assert turns(np.array([(0.0, 0.0), (1.0, 1.0), (3.0, 3.0)]) * scale, TRIANGLE).tolist() == [0]


def test_one_unit_in_the_last_place_decides() -> None:
    """Corners on a line through three floats, one of them a single step off it."""
    rng = np.random.default_rng(7)
    for _ in range(200):
        start, step = rng.uniform(-1, 1, 2), rng.uniform(-1, 1, 2)
        points = np.array([start, start + step, start + 2 * step])
        points[2, 1] = np.nextafter(points[2, 1], rng.choice([-np.inf, np.inf]))
        exact = [[Fraction(x) for x in p] for p in points.tolist()]
        (ax, ay), (bx, by), (cx, cy) = exact
        value = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
        assert turns(points, TRIANGLE).tolist() == [(value > 0) - (value < 0)]
