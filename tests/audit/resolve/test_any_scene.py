"""What must hold of the answer to any scene: free, whatever the order and the threads."""

from __future__ import annotations

import math
import random

import pytest

from satcheck.audit import Settings, check
from tests.audit.resolve.boxes import after, boxes_scene, moves, overlapping, resolve, unit_at
from tests.audit.shapes import bracket, moved, scene_of


@pytest.mark.parametrize("seed", range(12))
def test_random_boxes_end_free(tmp_path, seed) -> None:
    dice = random.Random(seed)
    boxes = {}
    for k in range(dice.randrange(2, 26)):
        low = tuple(dice.uniform(0, 3) for _ in range(3))
        boxes[f"box{k}"] = (low, tuple(c + dice.uniform(0.2, 1.5) for c in low))
    static = tuple(id_ for id_ in boxes if dice.random() < 0.15)
    scene = boxes_scene(tmp_path, boxes, static=static)
    before = overlapping(scene)
    found = resolve(scene)
    still = {pair for pair in before if set(pair) <= set(static)}
    assert overlapping(after(scene, found)) == still
    assert not set(moves(found)) & set(static)
    assert found.summary.verdict == ("unresolved" if still else "resolved")
    # Scaled about one corner by the largest extent over the least distance of two centres, free
    # boxes would be apart; that is far more than what is needed, so a bound that is easy to keep.
    if not static:
        spread = sum(math.dist(low, (0, 0, 0)) for low, _ in boxes.values())
        assert found.summary.total_motion <= spread * 4


@pytest.mark.parametrize("seed", range(4))
def test_random_brackets_end_free(tmp_path, seed) -> None:
    dice = random.Random(seed)
    meshes = {
        f"bracket{k}": moved(bracket(), *(dice.uniform(0, 9) for _ in range(3))) for k in range(8)
    }
    scene = scene_of(tmp_path, **meshes)
    found = resolve(scene)
    report = check(after(scene, found), Settings(depth=False, tolerance=0.0))
    assert report.summary.verdict == "pass"
    assert found.summary.verdict == "resolved"


def test_the_order_of_the_scene_changes_nothing(tmp_path) -> None:
    boxes = {f"box{k}": unit_at(0.7 * k, 0.1 * k * k, 0.3 * (k % 3)) for k in range(6)}
    one = resolve(boxes_scene(tmp_path, boxes, static=("box2",)))
    other = resolve(boxes_scene(tmp_path, dict(reversed(boxes.items())), static=("box2",)))
    assert moves(one) == moves(other)


def test_threads_change_nothing(tmp_path) -> None:
    meshes = {f"bracket{k}": moved(bracket(), 3.5 * k, 2.5 * (k % 3), k) for k in range(9)}
    scene = scene_of(tmp_path, **meshes)
    one, many = (resolve(scene, Settings(jobs=jobs)) for jobs in (1, 4))
    assert one == many
