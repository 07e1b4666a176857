"""What the rules of a scene ask for is resolved, and no more."""

from __future__ import annotations

import pytest
from msgspec.structs import replace

from satcheck.audit import Settings
from satcheck.audit.resolve.resolve import ONLY_MOVING
from satcheck.scene import Rule, Scene, Selector
from satcheck.scene.motion import Motion, Translation
from tests.audit.resolve.boxes import boxes_scene, moves, resolve, unit_at
from tests.audit.shapes import bracket, scene_of, unit_box


def with_rules(scene: Scene, *rules: dict[str, object]) -> Scene:
    """The scene with rules about all pairs, or about those that a rule names."""
    made = [
        Rule(**{"a": Selector("*"), "b": Selector("*")} | keys)  # type: ignore[arg-type]
        for keys in rules
    ]
    return replace(scene, rules=tuple(made))


def test_rules_decide_what_is_resolved(tmp_path) -> None:
    scene = boxes_scene(tmp_path, {"a": unit_at(0), "b": unit_at(0.75), "c": unit_at(5)})
    for keys in ({"max_depth": 0.5}, {"severity": "note"}, {"severity": "warning"}):
        assert resolve(with_rules(scene, keys)).moves == ()
    assert len(resolve(with_rules(scene, {"max_depth": 0.1})).moves) == 2
    apart = resolve(with_rules(scene, {"clearance": 0.5}))
    assert moves(apart)["b"] == pytest.approx((0.375, 0, 0), abs=1e-12)


def test_what_no_check_fails_on_is_left_alone(tmp_path) -> None:
    """Below a clearance, but a warning is no failure, unless somebody says so."""
    scene = boxes_scene(tmp_path, {"a": unit_at(0), "b": unit_at(1.25)})
    scene = with_rules(scene, {"clearance": 0.5, "severity": "warning"})
    assert resolve(scene).moves == ()
    resolution = resolve(scene, Settings(fail_on="warning"))
    summary = resolution.summary
    assert (summary.conflicts, summary.gaps, summary.verdict) == (1, 1, "resolved")
    assert resolution.summary.total_motion == pytest.approx(0.25, abs=1e-12)


def test_an_overlap_is_only_reduced_to_its_limit(tmp_path) -> None:
    scene = boxes_scene(tmp_path, {"a": unit_at(0), "b": unit_at(0.75, 0.125)})
    resolution = resolve(with_rules(scene, {"max_depth": 0.125}))
    assert resolution.summary.total_motion == pytest.approx(0.125, abs=1e-9)
    assert resolution.summary.verdict == "resolved"


def test_an_overlap_of_concave_bodies_is_reduced_to_its_limit(tmp_path) -> None:
    """Up to the width of the interval of their depth."""
    scene = scene_of(tmp_path, bracket=bracket(), box=unit_box(1.5, 2, 1))
    resolution = resolve(with_rules(scene, {"max_depth": 0.25}), pins=["bracket"])
    assert resolution.summary.verdict == "resolved"
    assert 0.25 * (1 - 1e-9) <= resolution.summary.total_motion <= 0.25 * 1.02


def test_pushing_others_keeps_an_overlap_within_its_limit(tmp_path) -> None:
    """b gives way to c by s, and a by what is more than 0.5 of it: s^2 + (2 - s)^2 + (s - 0.5)^2 is
    least at 5/6. The moves come close to that."""
    boxes = {name: ((x, 0, 0), (x + 10, 10, 10)) for name, x in (("a", 0), ("b", 9), ("c", 17))}
    scene = boxes_scene(tmp_path, boxes)
    resolution = resolve(
        with_rules(scene, {"a": Selector("a"), "b": Selector("b"), "max_depth": 1.5})
    )
    assert resolution.summary.verdict == "resolved"
    ways = {"a": -1 / 3, "b": -5 / 6, "c": 7 / 6}
    for body, way in ways.items():
        assert moves(resolution)[body] == pytest.approx((way, 0, 0), abs=0.02)


def test_an_overlap_beyond_its_limit_of_volume_ends(tmp_path) -> None:
    scene = boxes_scene(tmp_path, {"a": unit_at(0), "b": unit_at(0.75)})
    assert resolve(with_rules(scene, {"max_volume": 0.5})).moves == ()
    assert resolve(with_rules(scene, {"max_volume": 0.1})).summary.verdict == "resolved"


def test_a_hit_on_the_way_is_none_of_its_business(tmp_path) -> None:
    boxes = {"door": unit_at(0), "post": unit_at(0, 3)}
    scene = boxes_scene(tmp_path, boxes)
    motion = Motion(("door",), Translation((0.0, 5.0, 0.0)))
    resolution = resolve(replace(scene, motions=(motion,)))
    assert (resolution.summary.conflicts, resolution.moves) == (0, ())
    assert [(one.relation, one.reason) for one in resolution.left] == [("penetrating", ONLY_MOVING)]


def test_an_overlap_that_the_touch_band_excuses_stays_when_a_body_is_pushed(tmp_path) -> None:
    """c pushes b along y, and b stays a hundredth deep in a."""
    boxes = {"a": unit_at(0), "b": unit_at(0.99), "c": unit_at(0.99, 0.5)}
    resolution = resolve(boxes_scene(tmp_path, boxes, static=("a",)), Settings(tolerance=0.05))
    assert resolution.summary.verdict == "resolved"
    assert set(moves(resolution)) == {"b", "c"}
    assert moves(resolution)["b"][0] == 0.0
