"""Parallel axes are one axis, whatever their sign, and no others are."""

from __future__ import annotations

import numpy as np

from satcheck.core.axes import first_parallel
from tests.oracles.random_shapes import random_direction

TOLERANCE = 1e-9


def test_each_axis_leads_to_the_first_one_parallel_to_it() -> None:
    rng = np.random.default_rng(2)
    some = np.array([random_direction(rng) for _ in range(50)])
    picked = rng.integers(0, 50, 400)
    copies = some[picked] * rng.choice([-1.0, 1.0], 400)[:, None]
    copies += rng.normal(size=copies.shape) * TOLERANCE / 20
    copies /= np.linalg.norm(copies, axis=1)[:, None]
    first = first_parallel(copies, np.full(400, TOLERANCE))
    expected = [int(np.flatnonzero(picked == k)[0]) for k in picked]
    assert first.tolist() == expected


def test_axes_that_differ_by_more_than_their_tolerances_stay_apart() -> None:
    angles = np.array([0.0, 3.0, 6.0]) * TOLERANCE
    axes = np.column_stack((np.cos(angles), np.sin(angles), np.zeros(3)))
    assert first_parallel(axes, np.full(3, TOLERANCE)).tolist() == [0, 1, 2]
    assert first_parallel(axes, np.full(3, 2 * TOLERANCE)).tolist() == [0, 0, 2]


def test_none_is_none() -> None:
    assert first_parallel(np.empty((0, 3)), np.empty(0)).tolist() == []
