"""The scene decides what is computed: nothing runs that was not asked for, and the report says so.

Each counter is also seen to count where its effect is asked for.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from msgspec import UNSET
from msgspec.structs import replace

from satcheck import core, decompose
from satcheck.audit import Report, Settings, check
from satcheck.scene import Rule, Scene, Selector, load_scene
from tests.audit.shapes import (
    bracket,
    moved,
    open_box,
    placed_scene,
    pose,
    scene_of,
    unit_box,
    write,
)


def rule(a: str = "*", b: str = "*", **keys: Any) -> Rule:
    return Rule(a=Selector(a), b=Selector(b), where="cell.toml:5", **keys)


def ran(report: Report) -> dict[str, int]:
    return {one.effect: one.pairs for one in report.effects if one.pairs}


def stages(report: Report) -> set[str]:
    return {stage.stage for finding in report.findings for stage in finding.plan}


class Counter:
    """Counts the calls of a function of a module, and lets them through."""

    def __init__(self, patch: pytest.MonkeyPatch, owner: Any, name: str) -> None:
        self.calls = 0
        original = getattr(owner, name)

        def counted(*args: Any, **keys: Any) -> Any:
            self.calls += 1
            return original(*args, **keys)

        patch.setattr(owner, name, counted)


def climbs_of(patch: pytest.MonkeyPatch) -> list[core.Climb | None]:
    """What all climbs find, of many pairs and of a lone one, as they find it."""
    kept: list[core.Climb | None] = []
    original, alone = core.Climbing, core.climb

    def climb(*args: Any) -> core.Climb:
        found = alone(*args)
        kept.append(found)
        return found

    class Climbing:
        def __init__(self, *args: Any, **keys: Any) -> None:
            self._climbing = original(*args, **keys)

        def results(self) -> list[core.Climb | None]:
            climbs = self._climbing.results()
            kept.extend(climbs)
            return climbs

    patch.setattr(core, "climb", climb)
    patch.setattr(core, "Climbing", Climbing)
    return kept


def brackets(folder: Path, count: int = 3) -> Scene:
    """Instances of one concave file, each overlapping the next."""
    write(folder, bracket=bracket())
    return placed_scene(folder, [(f"b{k}", "bracket.obj", pose(1.5 * k)) for k in range(count)])


def concave(folder: Path) -> Scene:
    return scene_of(folder, a=bracket(), b=unit_box(1.5, 3, 1, edge=2.0))


def notched(folder: Path) -> Scene:
    """A box in the notch of a bracket, 1 from its walls: only triangles tell how far."""
    return scene_of(folder, a=bracket(), b=unit_box(3, 3, 1))


@pytest.mark.parametrize(("depth", "calls"), [(False, 0), (True, 1)])
def test_depth_not_asked_no_depth_search(tmp_path, monkeypatch, depth, calls):
    search = Counter(monkeypatch, core, "search_depth")
    report = check(concave(tmp_path), Settings(depth=depth))
    assert search.calls == calls == ran(report).get("depth", 0)
    (finding,) = report.findings
    assert (finding.depth is not None) == depth
    assert finding.relation == "penetrating"


@pytest.mark.parametrize(("clearance", "calls"), [(None, 0), (3.0, 1)])
def test_no_clearance_no_distance(tmp_path, monkeypatch, clearance, calls):
    """With a touch band of no width the gap is of no interest at all."""
    climbs = climbs_of(monkeypatch)
    report = check(notched(tmp_path), Settings(tolerance=0.0, clearance=clearance))
    measured = sum(one.gap is not None for one in climbs if one is not None)
    assert measured == calls == ran(report).get("distance", 0)
    assert (report.findings[0].distance is not None) == (clearance is not None)


def test_the_touch_band_is_no_distance(tmp_path):
    report = check(notched(tmp_path))
    assert "touch-band" in stages(report)
    assert "distance" not in ran(report)


@pytest.mark.parametrize("asked", [False, True])
def test_a_clearance_of_a_rule_asks_for_the_distance_of_its_pairs(tmp_path, asked):
    write(tmp_path, box=unit_box())
    scene = placed_scene(tmp_path, [(k, "box.obj", pose(1.5 * i)) for i, k in enumerate("abc")])
    rules = (rule("a", "b", clearance=1.0),) if asked else ()
    report = check(replace(scene, rules=rules))
    assert ran(report).get("distance", 0) == int(asked)


@pytest.mark.parametrize(("convex", "calls"), [(True, 0), (False, 1)])
def test_all_convex_no_convex_parts(tmp_path, monkeypatch, convex, calls):
    parts = Counter(monkeypatch, decompose, "decompose")
    scene = scene_of(tmp_path, a=unit_box(), b=unit_box(0.5)) if convex else concave(tmp_path)
    check(scene, Settings(accuracy="parts", cache=False))
    assert parts.calls == calls


def test_instances_are_decomposed_once(tmp_path, monkeypatch):
    parts = Counter(monkeypatch, decompose, "decompose")
    report = check(brackets(tmp_path), Settings(accuracy="parts", cache=False, list_pruned=False))
    assert ran(report)["overlap"] >= 2
    assert parts.calls == 1


@pytest.mark.parametrize("allowed", [True, False])
def test_allowed_pairs_have_no_narrow_phase(tmp_path, monkeypatch, allowed):
    counters = [Counter(monkeypatch, core, name) for name in ("climb", "Climbing")]
    scene = concave(tmp_path)
    report = check(replace(scene, rules=(rule("a", "b", allowed=allowed),)))
    assert (sum(one.calls for one in counters) == 0) == allowed
    assert (ran(report) == {}) == allowed
    assert report.effects[0].not_run == ({"allowed": 1} if allowed else {})


EFFECTS_ASKED = {
    "volume": Settings(volume=True),
    "contacts": Settings(contacts=True),
    "certificate": Settings(certificate=True),
}


@pytest.mark.parametrize("effect", EFFECTS_ASKED)
def test_the_rest_runs_where_it_is_asked_for(tmp_path, effect):
    scene = concave(tmp_path)
    assert effect not in ran(check(scene, Settings(depth=False)))
    assert ran(check(scene, EFFECTS_ASKED[effect]))[effect] == 1


def test_a_certificate_takes_the_crossing_from_the_verdict(tmp_path, monkeypatch):
    relations = Counter(monkeypatch, core, "mesh_relation")
    report = check(concave(tmp_path), Settings(certificate=True, depth=False))
    assert report.findings[0].certificate is not None
    assert relations.calls == 0


def test_a_certificate_takes_the_nearest_triangles_from_the_verdict(tmp_path, monkeypatch):
    distances = Counter(monkeypatch, core, "mesh_distance")
    report = check(notched(tmp_path), Settings(certificate=True, clearance=3.0))
    (finding,) = report.findings
    assert finding.distance is not None
    assert finding.certificate is not UNSET  # verify finds the nearest triangles again
    assert distances.calls == 0


def test_who_asked_and_why_not(tmp_path):
    meshes = {f"b{k}": unit_box(0.75 * k) for k in range(3)} | {"l": moved(bracket(), 20, 0, 0)}
    scene = scene_of(tmp_path, **meshes)
    scene = replace(
        scene,
        composed=True,
        rules=(rule("b1", "b2", max_depth=0.5), rule("b0", "b1", allowed=True)),
    )
    report = check(scene, Settings(contacts=True))
    found = {one.effect: one for one in report.effects}
    assert found["overlap"].asked_by == ("always",)
    assert (found["overlap"].pairs, found["overlap"].not_run) == (
        1,
        {"allowed": 1, "boxes apart": 4},
    )
    assert found["depth"].asked_by == ("cell.toml:5",)
    assert found["depth"].pairs == 1
    assert found["contacts"].asked_by == ("--contacts",)
    assert found["volume"].asked_by == ()
    assert found["volume"].not_run == {"allowed": 1, "not asked": 5}


@pytest.mark.parametrize("settings", [Settings(), Settings(clearance=2.0, contacts=True)])
def test_all_pairs_of_every_effect(tmp_path, settings):
    broken = tmp_path / "broken.obj"
    broken.write_text("v 0 0 nan\nf 1 1 1\n", encoding="utf-8")
    meshes = {f"b{k}": unit_box(1.5 * k) for k in range(5)}
    scene = load_scene([*write(tmp_path, **meshes), broken])
    scene = replace(scene, rules=(rule("b0", "*", allowed=True), rule("b3", "b4", max_volume=1)))
    report = check(scene, settings)
    for one in report.effects:
        assert one.pairs + sum(one.not_run.values()) == report.summary.pairs.total


def test_what_was_refused_did_not_run(tmp_path):
    scene = scene_of(tmp_path, a=open_box(), b=unit_box(3.5))
    (volume,) = (
        one for one in check(scene, Settings(volume=True)).effects if one.effect == "volume"
    )
    assert (volume.pairs, volume.not_run) == (0, {"no answer": 1})
    assert volume.microseconds > 0


def test_no_timings_no_microseconds(tmp_path):
    report = check(concave(tmp_path))
    assert all("microseconds" in one for one in report.to_dict()["effects"])
    assert all("microseconds" not in one for one in report.to_dict(timings=False)["effects"])
