"""Floating bodies fall until they lie on something; the distances are known by hand."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from satcheck.audit import Settings
from satcheck.audit.resolve import Resolution, resolve
from satcheck.core.errors import SatcheckError
from tests.audit.statics.scenes import ball, box, floor, loaded

Json = dict[str, Any]


def dropped(folder: Path, bodies: list[Json], rules: list[Json] | None = None, **more: Any):
    scene = loaded(folder, bodies, rules or [], **{"gravity": [0, 0, -1], **more.pop("terms", {})})
    return resolve(scene, Settings(jobs=1), dropping=True, **more)


def heights(result: Resolution) -> dict[str, float]:
    return {move.body: move.translation[2] for move in result.moves}


def test_a_body_falls_onto_what_is_below_it(tmp_path):
    shelf = box("shelf", [1, 1, 0.001], [0, 0, 1], static=True)
    bodies = [
        floor(),
        shelf,
        box("on shelf", [1, 1, 1], [0, 0, 3]),
        ball("on floor", 0.5, [2, 2, 2]),
    ]
    result = dropped(tmp_path, bodies)
    assert heights(result) == pytest.approx({"on shelf": -1.4995, "on floor": -1.5}, abs=1e-9)
    assert {drop.body: drop.onto for drop in result.drops} == {
        "on shelf": "shelf",
        "on floor": "floor",
    }
    assert result.verdict == "resolved"


def test_bodies_that_touch_fall_together(tmp_path):
    bodies = [
        floor(),
        box("table", [1, 1, 1], [0, 0, 1.5]),
        box("cup", [0.1, 0.1, 0.1], [0.3, 0, 2.05]),
    ]
    assert heights(dropped(tmp_path, bodies)) == {"table": -1.0, "cup": -1.0}


def test_the_lowest_falls_first(tmp_path):
    bodies = [floor(), box("upper", [1, 1, 1], [0, 0, 9]), box("lower", [1, 1, 1], [0, 0, 3])]
    assert heights(dropped(tmp_path, bodies)) == {"upper": -7.5, "lower": -2.5}


def test_a_body_with_nothing_below_it_still_floats(tmp_path):
    result = dropped(tmp_path, [floor(), box("lost", [1, 1, 1], [9, 0, 3])])
    assert not result.moves
    assert [(drop.body, drop.reason) for drop in result.drops] == [("lost", "nothing is below it")]
    assert result.verdict == "unresolved"
    assert result.document().summary.verdict == "unresolved"


def test_what_is_pinned_or_far_stays(tmp_path):
    bodies = [floor(), box("a", [1, 1, 1], [0, 0, 3]), box("b", [1, 1, 1], [2, 0, 2])]
    result = dropped(tmp_path, bodies, pins=["b"], max_motion=2.0)
    assert not result.moves
    assert [drop.reason for drop in result.drops] == [
        "it would move farther than the longest motion",
        "it is pinned, or touches a body that is",
    ]


def test_a_standing_or_mounted_body_stays(tmp_path):
    bodies = [floor(), box("a", [1, 1, 1], [0, 0, 0.5]), box("lamp", [1, 1, 1], [2, 0, 2])]
    result = dropped(tmp_path, bodies, [{"bodies": "lamp", "mounted": True}])
    assert not result.moves
    assert not result.drops
    assert result.verdict == "resolved"


def test_a_body_falls_through_what_it_may_overlap(tmp_path):
    curtain = box("curtain", [1, 1, 0.1], [0, 0, 1], static=True)
    rules = [{"a": "curtain", "b": "*", "allowed": True, "reason": "cloth"}]
    bodies = [floor(), curtain, box("a", [0.5, 0.5, 0.5], [0, 0, 3])]
    assert heights(dropped(tmp_path, bodies, rules)) == {"a": -2.75}


def test_gravity_may_point_anywhere(tmp_path):
    wall = box("wall", [0.2, 6, 6], [5, 0, 0], static=True)
    scene = [wall, box("a", [1, 1, 1], [0, 0, 0])]
    result = dropped(tmp_path, scene, terms={"gravity": [2, 0, 0]})
    assert [move.translation for move in result.moves] == [pytest.approx((4.4, 0, 0), abs=1e-9)]


def test_without_a_fixed_body_nothing_can_hold_the_others(tmp_path):
    with pytest.raises(SatcheckError, match="call the floor static") as error:
        dropped(tmp_path, [box("a", [1, 1, 1], [0, 0, 0]), box("b", [1, 1, 1], [3, 0, 0])])
    assert error.value.code == "nothing-fixed"


def test_overlaps_end_before_bodies_fall(tmp_path):
    bodies = [
        floor(),
        box("a", [1, 1, 1], [0, 0, 2]),
        box("b", [1, 1, 1], [0.9, 0, 2]),
    ]
    result = dropped(tmp_path, bodies)
    assert result.overlaps == 1
    assert heights(result) == {"a": -1.5, "b": -1.5}
    assert result.verdict == "resolved"
