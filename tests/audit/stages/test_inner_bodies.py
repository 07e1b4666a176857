"""The deepest pair of convex bodies within two others."""

from __future__ import annotations

import numpy as np
import pytest

from satcheck import core
from satcheck.audit.stages.parts import Part, deepest_pair

CUBE = np.array([[x, y, z] for x in (0.0, 1.0) for y in (0.0, 1.0) for z in (0.0, 1.0)])


def cube_at(x: float) -> Part:
    moved = CUBE + np.array([x, 0.0, 0.0])
    return Part(core.Hull(moved), (tuple(moved.min(axis=0)), tuple(moved.max(axis=0))))


def test_the_deepest_of_all_pairs_counts() -> None:
    deepest = deepest_pair([cube_at(0.0), cube_at(0.5)], [cube_at(0.75), cube_at(9.0)])
    assert deepest <= 0.75
    assert deepest == pytest.approx(0.75, rel=1e-12)


@pytest.mark.parametrize("others", [[], [cube_at(5.0)]])
def test_no_inner_part_and_none_that_overlaps_bound_nothing(others: list[Part]) -> None:
    assert deepest_pair([cube_at(0.0)], others) == 0.0
    assert deepest_pair(others, []) == 0.0
