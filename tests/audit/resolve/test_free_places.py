"""Free places: free, where there is one, and near."""

from __future__ import annotations

import math
import random

import pytest

from satcheck.audit import Settings
from satcheck.audit.bodies.placed_bodies import place
from satcheck.audit.resolve.free_places import FreePlaces
from tests.audit.resolve.boxes import boxes_scene, unit_at


def slots(tmp_path, boxes) -> FreePlaces:
    return FreePlaces(list(place(boxes_scene(tmp_path, boxes), Settings()).placed.values()))


def free(found: FreePlaces, count: int, offsets=None, gap: float = 0.0, longest: float = math.inf):
    others = range(1, count)
    still = [(0.0, 0.0, 0.0)] * count
    return found.free(0, others, offsets or still, [gap] * len(others), longest)


def test_the_nearest_side_of_a_box(tmp_path) -> None:
    found = slots(tmp_path, {"a": unit_at(0), "b": unit_at(0.75, 0.25, 0.25)})
    assert free(found, 2) == pytest.approx((-0.25, 0, 0), abs=1e-12)
    assert free(found, 2, gap=0.5) == pytest.approx((-0.75, 0, 0), abs=1e-12)
    assert free(found, 2, longest=0.2) is None


def test_others_count_where_they_were_moved_to(tmp_path) -> None:
    found = slots(tmp_path, {"a": unit_at(0), "b": unit_at(9)})
    assert free(found, 2) == (0, 0, 0)
    offsets = [(0.0, 0.0, 0.0), (-8.5, 0.0, 0.0)]
    assert free(found, 2, offsets) == pytest.approx((-0.5, 0, 0), abs=1e-12)


@pytest.mark.parametrize("seed", range(6))
def test_the_place_is_free_of_all(tmp_path, seed) -> None:
    dice = random.Random(seed)
    boxes = {f"b{k}": unit_at(*(dice.uniform(0, 3) for _ in range(3))) for k in range(20)}
    way = free(slots(tmp_path, boxes), 20)
    low = [p + t for p, t in zip(boxes["b0"][0], way, strict=True)]
    for corner, _ in list(boxes.values())[1:]:
        assert any(abs(p - q) >= 1 for p, q in zip(low, corner, strict=True))
