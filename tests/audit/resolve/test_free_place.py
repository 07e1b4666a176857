"""Free places: free, where there is one, and near."""

from __future__ import annotations

import math
import random

import numpy as np
import pytest

from satcheck.audit import Settings
from satcheck.audit.bodies import place
from satcheck.audit.resolve.pushing import AXES, extents, free_place
from tests.audit.resolve.boxes import boxes_scene, unit_at


def free(tmp_path, boxes, shift=(0.0, 0.0, 0.0), gap: float = 0.0, longest: float = math.inf):
    """A place for the first box beside the others, which are moved by `shift`."""
    bodies = place(boxes_scene(tmp_path, boxes), Settings()).placed.values()
    body, *others = map(extents, bodies)
    there = np.stack(others) + AXES @ np.array(shift)
    return free_place(body, there, np.full(len(others), gap), longest)


def test_the_nearest_side_of_a_box(tmp_path) -> None:
    boxes = {"a": unit_at(0), "b": unit_at(0.75, 0.25, 0.25)}
    assert free(tmp_path, boxes) == pytest.approx((-0.25, 0, 0), abs=1e-12)
    assert free(tmp_path, boxes, gap=0.5) == pytest.approx((-0.75, 0, 0), abs=1e-12)
    assert free(tmp_path, boxes, longest=0.2) is None


def test_others_count_where_they_were_moved_to(tmp_path) -> None:
    boxes = {"a": unit_at(0), "b": unit_at(9)}
    assert free(tmp_path, boxes) == (0, 0, 0)
    assert free(tmp_path, boxes, (-8.5, 0.0, 0.0)) == pytest.approx((-0.5, 0, 0), abs=1e-12)


@pytest.mark.parametrize("seed", range(6))
def test_the_place_is_free_of_all(tmp_path, seed) -> None:
    dice = random.Random(seed)
    boxes = {f"b{k}": unit_at(*(dice.uniform(0, 3) for _ in range(3))) for k in range(20)}
    way = free(tmp_path, boxes)
    low = [p + t for p, t in zip(boxes["b0"][0], way, strict=True)]
    for corner, _ in list(boxes.values())[1:]:
        assert any(abs(p - q) >= 1 for p, q in zip(low, corner, strict=True))
