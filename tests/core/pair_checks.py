"""What every pair result has to satisfy, whatever the shapes: shared by the narrow-phase tests."""

from __future__ import annotations

from typing import Literal

import numpy as np

from satcheck import core

Method = Literal["auto", "sat", "gjk"]
METHODS: tuple[Method, ...] = ("auto", "sat", "gjk")

# Signed distances of polytopes whose facets are no thinner than a thousandth of their size, as a
# part of the size. Core: 40 unit roundoffs for a support value and 16 for the stop, over a scale of
# up to 6 sizes: 4e-14. Oracle: qhull's plane normals, 2 roundoffs over the thinness, 2e-13.
EXACT = 1e-12

# Curved shapes: EPA stops at a gap of 1e-9 of the scale, which is up to 6 sizes.
CURVED = 1e-8

# The length of a normal after one square root and one division per coordinate.
UNIT = 1e-15

IDENTITY = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0)


def assert_valid(result: core.PairResult, tolerance: float, width: float | None = None) -> None:
    """The promises of a query for depth or distance; `tolerance` is a length.

    The bounds are at most `width` apart: twice the tolerance unless said otherwise.
    """
    assert result.outcome != "undecided", result.reason
    assert result.distance is not None
    assert result.lower is not None
    assert result.upper is not None
    assert result.lower <= result.distance <= result.upper
    assert result.upper - result.lower <= (2 * tolerance if width is None else width)
    if result.outcome == "penetrating":
        assert result.distance <= 0
    if result.outcome == "separated":
        assert result.distance >= 0
    normal = np.array(result.normal)
    assert abs(np.linalg.norm(normal) - 1) <= 4 * UNIT
    between = np.array(result.witness_b) - np.array(result.witness_a)
    assert np.abs(result.distance * normal - between).max() <= tolerance


def distance_of(result: core.PairResult) -> float:
    """The signed distance, which was asked for."""
    assert result.distance is not None, result.reason
    return result.distance
