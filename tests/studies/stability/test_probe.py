"""Answers that stay, and changes that are seen: the probe against pairs of known kind."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from msgspec import to_builtins
from msgspec.structs import replace

from satcheck.audit import Settings
from satcheck.core.errors import SatcheckError
from satcheck.scene import load_scene
from satcheck.studies.stability import FAMILIES, probe
from satcheck.studies.stability import answer as answer_module
from tests.audit.shapes import bracket, moved, open_box, placed_scene, pose, scene_of, unit_box

IDENTICAL = ("scale", "order")
NO_DEPTH = Settings(depth=False)

# Shapes, and the relation of the first to the second.
PAIRS = {
    "apart": (unit_box(), unit_box(3.0), "separated"),
    "flush": (unit_box(), unit_box(1.0, 0.25), "touching"),
    "pushed": (unit_box(), unit_box(0.75, 0.25), "penetrating"),
    "odd coordinates": (unit_box(0.1, 0.7, -0.3), unit_box(0.9, 0.3, 0.1), "penetrating"),
    "within": (unit_box(edge=4.0), unit_box(1.0, 1.25, 1.5), "contains"),
    "in the notch": (bracket(), unit_box(3.0, 3.0, 1.0), "separated"),
    "in the arm": (bracket(), moved(unit_box(), 4.5, 1.5, 1.0), "penetrating"),
    "on the arm": (bracket(), unit_box(3.0, 2.0, 1.0), "touching"),
    "over the rim": (open_box(), unit_box(3.5, 1.0, 1.0), "penetrating"),
}


@pytest.mark.parametrize("name", PAIRS)
def test_no_answer_changes_beyond_its_bound(name: str, tmp_path: Path) -> None:
    a, b, relation = PAIRS[name]
    found = probe(scene_of(tmp_path, a=a, b=b), samples=3, settings=NO_DEPTH)
    assert found.answer.relation == relation
    assert found.verdict == "stable", found.document()
    assert [family.family for family in found.families] == list(FAMILIES)
    for family in found.families:
        if family.family in IDENTICAL:
            assert family.judgement == "same"
        if family.family not in ("motion", "noise") and family.samples:
            assert set(family.relations) == {relation}


def test_depths_stay_too(tmp_path: Path) -> None:
    settings = Settings(cache_directory=str(tmp_path))
    scene = scene_of(tmp_path, a=bracket(), b=moved(unit_box(), 4.5, 1.5, 1.0))
    found = probe(scene, samples=1, settings=settings)
    assert found.verdict == "stable", found.document()
    assert found.answer.depth_bounds is not None
    assert found.answer.depth_bounds[0] <= 0.5 <= found.answer.depth_bounds[1]
    order = next(family for family in found.families if family.family == "order")
    assert order.samples[0].answer.depth_bounds == found.answer.depth_bounds


def test_a_contact_may_open_or_close(tmp_path: Path) -> None:
    """Turned faces are rounded, so two that lay in each other no longer do."""
    found = probe(scene_of(tmp_path, a=unit_box(), b=unit_box(1.0, 0.25)), samples=6)
    motion = next(family for family in found.families if family.family == "motion")
    assert set(motion.relations) - {"touching"}
    assert motion.judgement == "within"


def test_the_same_seed_asks_the_same(tmp_path: Path) -> None:
    scene = scene_of(tmp_path, a=unit_box(), b=unit_box(0.75, 0.25))
    one, again, other = (probe(scene, samples=2, seed=seed).document() for seed in (5, 5, 6))
    assert one == again
    assert one != other


def test_a_wrong_answer_is_seen(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A check that calls every swapped pair separated, and every other depth twice as deep."""
    ask = answer_module.check
    asked = []

    def faulty(scene, settings):
        asked.append(scene)
        report = ask(scene, settings)
        (finding,) = report.findings
        if len(asked) > 1:
            low, high = finding.depth_bounds
            finding = replace(finding, depth_bounds=(2 * low, 2 * high))
        if scene.bodies[0].id == "b":
            finding = replace(finding, exact_relation="separated")
        return replace(report, findings=(finding,))

    monkeypatch.setattr(answer_module, "check", faulty)
    found = probe(scene_of(tmp_path, a=unit_box(), b=unit_box(0.75, 0.25)), samples=1)
    assert found.verdict == "changed"
    beyond = {family.family: family.samples[0].comparison.beyond for family in found.families}
    assert all("depth" in changes for changes in beyond.values())
    assert [name for name, changes in beyond.items() if "relation" in changes] == ["swap"]


def test_what_is_not_decided_is_said(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    ask = answer_module.check

    def undecided(scene, settings):
        report = ask(scene, settings)
        (finding,) = report.findings
        return replace(report, findings=(replace(finding, exact_relation=None),))

    monkeypatch.setattr(answer_module, "check", undecided)
    found = probe(scene_of(tmp_path, a=unit_box(), b=unit_box(3.0)), samples=1)
    assert found.verdict == "undecided"


def test_progress_reaches_its_total(tmp_path: Path) -> None:
    told: list[tuple[int, int]] = []
    scene = scene_of(tmp_path, a=unit_box(), b=unit_box(3.0))
    found = probe(scene, samples=2, progress=lambda done, total: told.append((done, total)))
    assert told[-1] == (found.sample_count + 1, found.sample_count + 1)


def test_only_two_mesh_files_in_place_are_a_pair(tmp_path: Path) -> None:
    one = scene_of(tmp_path, a=unit_box())
    with pytest.raises(SatcheckError, match="two mesh files"):
        probe(one)
    bodies = [("p", "a.obj", pose(1.0)), ("q", "a.obj", pose(5.0))]
    with pytest.raises(SatcheckError, match="two mesh files"):
        probe(placed_scene(tmp_path, bodies))


def test_documents_hold_finite_numbers(tmp_path: Path) -> None:
    found = probe(scene_of(tmp_path, a=unit_box(), b=unit_box(0.5)), samples=1)
    json.dumps(to_builtins(found.document()), allow_nan=False)


def test_two_names_of_one_file_are_a_pair(tmp_path: Path) -> None:
    scene_of(tmp_path, a=unit_box(0.1))
    scene = load_scene([tmp_path / "a.obj", tmp_path / "a.obj"])
    found = probe(scene, samples=1, families=("scale", "order", "axes", "swap", "motion"))
    assert found.answer.relation == "coincident"
    assert found.verdict == "stable", found.document()
