"""A pair that fails has figures, the worst first, within a budget of counted steps."""

from __future__ import annotations

from pathlib import Path

import pytest
from msgspec.structs import replace

from satcheck.audit import Report, Settings, check, figures
from satcheck.audit.samples import check_poses
from satcheck.report.report import BEYOND_BUDGET, Finding
from satcheck.scene import Rule, Scene, Selector, load_scene
from satcheck.scene.robot import posed, read_path, read_poses, with_joint_path
from tests.audit.shapes import bracket, placed_scene, pose, unit_box, write
from tests.cli.process import SAMPLES

SHIFTS = (0.0, 0.9, 1.6, 1.7)  # of boxes of edge 1: overlaps of 0.1, 0.3 and 0.9


def boxes(folder: Path, shifts: tuple[float, ...] = SHIFTS) -> Scene:
    write(folder, box=unit_box(0.0))
    return placed_scene(folder, [(f"b{k}", "box.obj", pose(x)) for k, x in enumerate(shifts)])


def brackets(folder: Path, count: int = 4) -> Scene:
    """Each overlaps the others, and none is convex."""
    write(folder, bracket=bracket())
    return placed_scene(folder, [(f"b{k}", "bracket.obj", pose(1.5 * k)) for k in range(count)])


def overlaps(report: Report) -> list[Finding]:
    return [finding for finding in report.findings if finding.relation == "penetrating"]


def measured(report: Report) -> set[str]:
    return {f"{f.a} {f.b}" for f in report.findings if f.depth is not None}


def depth_of(report: Report) -> dict[str, int]:
    (effect,) = (effect for effect in report.effects if effect.effect == "depth")
    return dict(effect.not_run)


def test_failing_pairs_have_the_figures_that_depth_gives_them(tmp_path: Path) -> None:
    scene = brackets(tmp_path)
    by_default, asked = (check(scene, Settings(depth=depth, jobs=1)) for depth in (None, True))
    assert len(overlaps(by_default)) == 6
    for one, other in zip(by_default.findings, asked.findings, strict=True):
        without_trace = [replace(finding, plan=()) for finding in (one, other)]
        assert without_trace[0] == without_trace[1]
    assert all(f.depth is not None and f.thickness is not None for f in overlaps(by_default))
    assert measured(check(scene, Settings(depth=False))) == set()


def test_what_passes_is_not_measured(tmp_path: Path) -> None:
    scene = boxes(tmp_path)
    mild = Rule(a=Selector("b0"), b=Selector("b1"), severity="note")
    allowed = Rule(a=Selector("b1"), b=Selector("b2"), allowed=True)
    report = check(replace(scene, rules=(mild, allowed)))
    assert measured(report) == {"b1 b3", "b2 b3"}
    assert depth_of(report)["not asked"] == 1


def test_the_deepest_boxes_are_measured_before_the_budget_ends(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    scene = boxes(tmp_path)
    budget = Settings().work
    monkeypatch.setattr(figures, "UNCOUNTED_OF_PAIR", budget)
    report = check(scene)
    assert measured(report) == {"b2 b3"}
    assert depth_of(report)[BEYOND_BUDGET] == 3
    assert "worst: b2 and b3 overlap (thickness 0.9," in report.message
    assert "Figures of the worst of 4 failing pairs; --depth measures all." in report.message
    every = check(scene, Settings(depth=True))
    assert len(measured(every)) == 4
    assert "--depth measures all" not in every.message
    assert report.summary == every.summary


def test_the_budget_is_counted_and_shared(tmp_path: Path) -> None:
    scene = brackets(tmp_path, 12)
    small = Settings(budget=0.002, jobs=1)
    one, other = check(scene, small), check(scene, replace(small, jobs=3))
    assert 0 < len(measured(one)) < len(overlaps(one))
    assert one.to_dict(timings=False) == other.to_dict(timings=False)
    wider = next(f for f in overlaps(one) if f.depth is not None)
    exact = check(scene, Settings(depth=True)).findings
    narrow = next(f for f in exact if f.id == wider.id)
    assert wider.depth_bounds is not None
    assert narrow.depth_bounds is not None
    assert wider.depth_bounds[0] <= narrow.depth_bounds[1]
    assert narrow.depth_bounds[0] <= wider.depth_bounds[1]


def test_evidence_and_sweeps_come_after_the_figures(tmp_path: Path) -> None:
    report = check(brackets(tmp_path, 2), Settings(certificate=True))
    (finding,) = overlaps(report)
    assert finding.certificate is not None
    assert finding.certificate.thickness
    assert finding.plan[-1].stage == "certificate"


def test_a_coarse_accuracy_stays_fast(tmp_path: Path) -> None:
    assert measured(check(boxes(tmp_path), Settings(accuracy="hull"))) == set()


def test_many_poses_are_measured_on_request_only() -> None:
    arm = load_scene([str(SAMPLES / "arm.urdf")])
    poses = read_poses(str(SAMPLES / "arm_poses.json"))
    assert isinstance(poses, list)
    assert measured(check(posed(arm, poses[0])))
    samples = check_poses(arm, poses)
    assert all(f.depth is None for sample in samples.samples for f in sample.findings)
    deep = check_poses(arm, poses, Settings(depth=True))
    assert any(f.depth is not None for sample in deep.samples for f in sample.findings)
    path = with_joint_path(arm, read_path(str(SAMPLES / "arm_poses.json")), {})
    assert overlaps(check(path))
    assert not measured(check(path))


def test_a_failure_of_a_measurement_leaves_what_is_proven_and_the_other_pairs(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    original = figures.measure

    def failing(draft: figures.Draft) -> Finding:
        if draft.pair.a.id == "b2":
            raise RuntimeError("a fault")
        return original(draft)

    monkeypatch.setattr(figures, "measure", failing)
    report = check(boxes(tmp_path))
    assert measured(report) == {"b0 b1", "b1 b2", "b1 b3"}
    assert (report.summary.verdict, len(overlaps(report))) == ("fail", 4)
    assert any(issue.code == "internal-error" for issue in report.issues)
