"""How far bodies move, beside the least there is."""

from __future__ import annotations

import math
import random
from itertools import combinations, product

import numpy as np
import pytest

from satcheck.audit import Settings, check
from satcheck.audit.vectors import dot
from satcheck.scene import load_scene
from tests.audit.resolve.boxes import boxes_scene, moves, resolve
from tests.audit.test_samples import SAMPLES


def least_squares_of(boxes) -> float:
    """The least sum of squares that parts three boxes: over all choices of a side for each pair.
    The sides of one axis are a problem of their own."""
    names = list(boxes)
    pairs = list(combinations(range(len(names)), 2))
    sides = [(axis, side) for axis in range(3) for side in (-1, 1)]
    best = math.inf
    for chosen in product(sides, repeat=len(pairs)):
        total = 0.0
        for axis in range(3):
            walls = [
                (b, a, boxes[names[a]][1][axis] - boxes[names[b]][0][axis])
                if side < 0
                else (a, b, boxes[names[b]][1][axis] - boxes[names[a]][0][axis])
                for (a, b), (way, side) in zip(pairs, chosen, strict=True)
                if way == axis
            ]
            total += least_on_a_line(walls)
        best = min(best, total)
    return best


def least_on_a_line(walls: list[tuple[int, int, float]]) -> float:
    """The least sum of squares of t with t[a] - t[b] >= least for each (a, b, least), by the walls
    that are kept as equations; inf: they exclude each other. With three bodies at most two are."""
    best = math.inf
    for count in range(min(len(walls), 2) + 1):
        for tight in combinations(walls, count):
            rows = np.array([[(k == a) - (k == b) for k in range(3)] for a, b, _ in tight])
            rows = rows.reshape(count, 3).astype(float)
            t = np.linalg.pinv(rows) @ [least for *_, least in tight]
            if all(t[a] - t[b] >= least - 1e-9 for a, b, least in walls):
                best = min(best, float(t @ t))
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
    assert found.summary.verdict == "resolved"
    assert len(found.moves) == 2 - pinned
    assert pair.depth_bounds is not None
    low, high = pair.depth_bounds
    assert low * (1 - 1e-9) <= found.summary.total_motion <= high * (1 + 1e-9)


def test_a_finger_leaves_what_it_presses_and_the_others_make_room() -> None:
    """The left finger is 0.25 in the payload, which touches the right one: s^2 for the left and
    twice (0.25 - s)^2 for the others is least at 1/6. The moves come close to that. The palm
    touches both, and stays."""
    found = resolve(load_scene([SAMPLES / "gripper.glb"]))
    reached = moves(found)
    assert set(reached) == {"gripper/left", "gripper/right", "payload"}
    assert reached["gripper/left"] == pytest.approx((-1 / 6, 0, 0), abs=0.005)
    assert reached["payload"] == pytest.approx((1 / 12, 0, 0), abs=0.005)
