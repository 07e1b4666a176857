"""How far bodies move, beside the least there is."""

from __future__ import annotations

import math
import random
from itertools import combinations, product

import pytest

from satcheck.audit import Settings, check
from satcheck.audit.resolve import resolve
from satcheck.audit.resolve.walls import Wall, least_motion
from satcheck.audit.vectors import dot, scaled
from satcheck.scene import load_scene
from tests.audit.resolve.boxes import boxes_scene, moves
from tests.audit.test_samples import SAMPLES

AXES = [(1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)]


def least_squares_of(boxes) -> float:
    """The least sum of squares that parts three boxes: over all choices of a side for each pair."""
    names = list(boxes)
    pairs = list(combinations(range(len(names)), 2))
    sides = []
    for a, b in pairs:
        (a_low, a_high), (b_low, b_high) = boxes[names[a]], boxes[names[b]]
        sides.append(
            [(axis, b_high[k] - a_low[k]) for k, axis in enumerate(AXES)]
            + [(scaled(axis, -1.0), a_high[k] - b_low[k]) for k, axis in enumerate(AXES)]
        )
    best = math.inf
    for chosen in product(*sides):
        walls = [Wall(a, b, n, d) for (a, b), (n, d) in zip(pairs, chosen, strict=True)]
        found = least_motion(walls, {})
        if not found.broken:
            best = min(best, sum(dot(t, t) for t in found.offsets.values()))
    return best


@pytest.mark.parametrize("seed", range(7))
def test_three_boxes_move_little_more_than_they_have_to(tmp_path, seed) -> None:
    """No promise, but what is reached: mostly the least, and here never a fifth above it."""
    dice = random.Random(seed)
    boxes = {}
    for k in range(3):
        low = tuple(dice.uniform(0, 1) for _ in range(3))
        boxes[f"b{k}"] = (low, tuple(c + dice.uniform(0.5, 1.2) for c in low))
    found = resolve(boxes_scene(tmp_path, boxes))
    reached = sum(dot(move.translation, move.translation) for move in found.moves)
    least = least_squares_of(boxes)
    assert least * (1 - 1e-9) <= reached <= least * 1.2


@pytest.mark.parametrize(
    "names", [("ring.glb", "link_b.glb"), ("kettle.obj", "snowflake.obj")], ids="-".join
)
@pytest.mark.parametrize("pinned", [0, 1])
def test_a_pair_alone_moves_by_its_depth(names, pinned) -> None:
    """As far as a check says that one of them has to, together or one alone."""
    scene = load_scene([SAMPLES / name for name in names], split="none")
    (pair,) = check(scene, Settings(depth=True)).findings
    found = resolve(scene, pins=[body.id for body in scene.bodies[:pinned]])
    assert found.verdict == "resolved"
    assert len(found.moves) == 2 - pinned
    assert pair.depth_bounds is not None
    low, high = pair.depth_bounds
    assert low * (1 - 1e-9) <= found.total_motion <= high * (1 + 1e-9)


def test_a_finger_leaves_what_it_presses_and_the_others_make_room() -> None:
    """The left finger is 0.25 in the payload, which touches the right one: s^2 for the left and
    twice (0.25 - s)^2 for the others is least at 1/6. The palm touches both, and stays."""
    found = resolve(load_scene([SAMPLES / "gripper.glb"]))
    reached = moves(found)
    assert set(reached) == {"gripper/left", "gripper/right", "payload"}
    assert reached["gripper/left"] == pytest.approx((-1 / 6, 0, 0), abs=1e-6)
    assert reached["payload"] == pytest.approx((1 / 12, 0, 0), abs=1e-6)
