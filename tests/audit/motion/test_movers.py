"""Scenes whose bodies move: which pairs are swept, and what that makes of the report."""

from __future__ import annotations

import json
import math
import sys
from pathlib import Path

import pytest
from msgspec.structs import replace

from satcheck.audit import Settings, check, pair
from satcheck.audit.motion import worst
from satcheck.cli.formats import table
from satcheck.cli.output import Page
from satcheck.scene.motion import Motion, PosePath, Rotation, Translation, Waypoint
from satcheck.scene.rules import Rule, Selector
from satcheck.verify import verify
from tests.audit.shapes import box, bracket, moved, scene_of, unit_box, write
from tests.cli.process import VALIDATOR

RIGHT = Translation((5.0, 0.0, 0.0))


def checked(folder, motions, rules=(), settings=None, **meshes):
    scene = replace(scene_of(folder, **meshes), motions=tuple(motions), rules=tuple(rules))
    report = check(scene, settings or Settings())
    VALIDATOR.validate(json.loads(json.dumps(report.to_dict())))
    return report


def test_what_hits_on_the_way_fails(tmp_path: Path) -> None:
    report = checked(tmp_path, [Motion(("a",), RIGHT)], a=unit_box(), b=unit_box(3.0))
    (finding,) = report.findings
    assert (finding.relation, finding.severity) == ("penetrating", "error")
    assert (finding.placed_relation, finding.exact_relation) == ("separated", "separated")
    assert finding.motion.relation == "penetrating"
    assert finding.plan[-1].stage == "sweep"
    assert report.summary.verdict == "fail"
    assert report.summary.pairs.pruned == 0
    (effect,) = (one for one in report.effects if one.effect == "sweep")
    assert (effect.asked_by, effect.pairs) == (("the motions of the scene",), 1)


def test_bodies_far_from_the_path_are_not_swept(tmp_path: Path) -> None:
    """The box over the whole diagonal holds all of the grid. Bodies meet if they are on it: unit
    boxes on multiples of 4, where x + y is that of the mover."""
    grid = {f"g{k}": unit_box(4.0 * (k % 8), 4.0 * (k // 8), 0.0) for k in range(64)}
    movers = {"a": unit_box(-6.0, 26.0, 0.0), "c": unit_box(-6.0, 30.0, 0.0)}
    along = Motion(("a", "c"), Translation((40.0, -40.0, 0.0)))
    report = checked(tmp_path, [along], settings=Settings(depth=False), **movers, **grid)
    swept = [finding for finding in report.findings if finding.motion]
    hits = {(f.a, f.b) for f in swept if f.relation == "penetrating"}
    on_it = {("a", f"g{k}") for k in range(64) if k % 8 + k // 8 == 5}
    assert hits == on_it | {("c", f"g{k}") for k in range(64) if k % 8 + k // 8 == 6}
    assert len(swept) <= 2 * len(hits)


@pytest.mark.parametrize("accuracy", ["aabb", "obb", "hull", "parts", "exact"])
@pytest.mark.parametrize("shape", [unit_box(), moved(bracket(), -3.0, 0.0, 0.0)])
def test_a_hit_fails_as_the_same_overlap_at_rest_does(tmp_path: Path, accuracy: str, shape) -> None:
    """Below exact both may be none: the quality says so."""
    settings = Settings(accuracy=accuracy, depth=False, cache=False)
    pair = {"a": shape, "b": moved(bracket(), 4.0, 0.5, 0.5)}
    (resting,) = checked(
        tmp_path, [], [], settings, a=moved(shape, 3.5, 0, 0), b=pair["b"]
    ).findings
    report = checked(tmp_path, [Motion(("a",), RIGHT)], [], settings, **pair)
    (finding,) = report.findings
    assert (finding.relation, finding.severity) == (resting.relation, "error")
    assert finding.quality == resting.quality
    assert report.summary.verdict == "fail"
    assert finding.motion.time_of_impact is not None


def test_boxes_that_meet_in_no_pose_that_was_tried_pass_nothing(tmp_path: Path) -> None:
    """The box of the part from 45 degrees on meets the other body, that of no pose does."""
    turn = Motion(("a",), Rotation((0.0, 0.0, 0.0), (0.0, 0.0, 1.0), 90.0))
    meshes = {"a": box((4, 0, 0), (5, 0.5, 1)), "b": box((3.53, 3.9, 0), (5, 5, 1))}
    report = checked(tmp_path, [turn], [], Settings(accuracy="aabb"), **meshes)
    (finding,) = report.findings
    assert (finding.relation, finding.undecided) == ("indeterminate", "motion")
    assert "not swept at --accuracy aabb" in finding.reason
    assert report.summary.verdict == "incomplete"


def test_what_passes_passes(tmp_path: Path) -> None:
    report = checked(tmp_path, [Motion(("a",), RIGHT)], a=unit_box(), b=unit_box(3.0, 0, 1.5))
    (finding,) = report.findings
    assert finding.severity == "none"
    assert report.summary.verdict == "pass"


def test_far_pairs_are_not_swept(tmp_path: Path) -> None:
    report = checked(tmp_path, [Motion(("a",), RIGHT)], a=unit_box(), b=unit_box(3.0, 9.0))
    (finding,) = report.findings
    assert finding.motion is None
    assert report.summary.pairs.pruned == 1


def test_bodies_of_one_motion_stand_still_against_each_other(tmp_path: Path) -> None:
    turn = Rotation((0.0, 0.0, 0.0), (0.0, 0.0, 1.0), 90.0)
    report = checked(
        tmp_path,
        [Motion(("a", "b"), turn)],
        a=unit_box(1.0),
        b=unit_box(1.5),
        c=box((1.6, 1.6, 0), (2.2, 2.2, 1)),
    )
    found = {(f.a, f.b): f for f in report.findings}
    assert found["a", "b"].motion is None
    assert found["a", "b"].relation == "penetrating"
    assert found["a", "c"].motion.relation == "separated"


def test_two_motions_meet(tmp_path: Path) -> None:
    left = Translation((-5.0, 0.0, 0.0))
    report = checked(
        tmp_path,
        [Motion(("a",), RIGHT), Motion(("b",), left)],
        a=unit_box(),
        b=unit_box(6.0),
        settings=Settings(tolerance=0.0),
    )
    (finding,) = report.findings
    low, high = finding.motion.time_of_impact
    assert low <= 0.5 <= high
    assert [(p.body, round(p.value, 6)) for p in finding.motion.at] == [("a", 2.5), ("b", 2.5)]


def test_an_allowed_pair_is_not_swept(tmp_path: Path) -> None:
    allowed = Rule(a=Selector("a"), b=Selector("b"), allowed=True)
    meshes = {"a": unit_box(), "b": unit_box(3.0)}
    report = checked(tmp_path, [Motion(("a",), RIGHT)], [allowed], **meshes)
    assert report.findings == ()
    assert report.summary.pairs.allowed == 1


@pytest.mark.parametrize(
    ("limit", "severity", "undecided"),
    [(2.0, "note", None), (0.5, "error", None), (1.0, "warning", "limit")],
)
def test_limits_hold_on_the_way(tmp_path: Path, limit, severity, undecided) -> None:
    """The box goes through the other one, 1 deep; that it is not deeper is known to 1 %."""
    rule = Rule(a=Selector("a"), b=Selector("b"), max_depth=limit)
    meshes = {"a": unit_box(), "b": unit_box(3.0)}
    report = checked(tmp_path, [Motion(("a",), RIGHT)], [rule], **meshes)
    (finding,) = report.findings
    assert (finding.severity, finding.undecided) == (severity, undecided)
    assert (finding.rule, finding.motion.worst.depth[1]) == (
        rule.name,
        pytest.approx(1.0, rel=0.02),
    )
    if undecided:
        assert finding.reason.startswith(
            f"undecided: max_depth is 1 ({rule.name}), and the depth is"
        )


@pytest.mark.parametrize(
    ("clearance", "relation"), [(0.3, "near"), (0.5, "separated"), (0.1, "separated")]
)
def test_a_gap_at_its_clearance_is_judged_in_motion_as_at_rest(
    tmp_path: Path, clearance: float, relation: str
) -> None:
    """The cube ends as far from the other as its clearance, up to the rounding of its pose."""
    way, settings = 3.0 - 1.0 - clearance, Settings(clearance=clearance)
    meshes = {"a": unit_box(), "b": unit_box(3.0)}
    motion = Motion(("a",), Translation((way, 0.0, 0.0)))
    (swept,) = checked(tmp_path, [motion], settings=settings, **meshes).findings
    meshes["a"] = moved(meshes["a"], way, 0.0, 0.0)
    (placed,) = check(scene_of(tmp_path, **meshes), settings).findings
    assert (swept.relation, swept.severity) == (placed.relation, placed.severity)
    assert placed.relation == relation


@pytest.mark.parametrize(("way", "relation"), [(5.0, "penetrating"), (0.5, "indeterminate")])
def test_what_starts_in_a_doubtful_part_hits_what_is_not_doubtful(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, way: float, relation: str
) -> None:
    """A box in a table, which is solid or a cavity, of a room that faces inward. The search for
    the moment takes all its steps: here a fiftieth of them."""
    monkeypatch.setattr(pair, "STEPS_OF_LONE_SWEEP", pair.STEPS_OF_LONE_SWEEP // 50)
    (points, faces), (corners, sides) = box((-8, -8, -8), (8, 8, 8)), box((-2, -2, -2), (2, 2, 2))
    inward = [face[::-1] for face in faces]
    room = (points + corners, inward + [tuple(k + len(points) for k in side) for side in sides])
    motion = Motion(("a",), Translation((way, 0.0, 0.0)))
    report = checked(tmp_path, [motion], a=box((-1, -1, -1), (0, 0, 0)), b=room)
    (finding,) = report.findings
    assert (finding.placed_relation, finding.relation) == ("indeterminate", relation)
    if relation == "penetrating":
        lower, upper = finding.motion.time_of_impact
        assert lower == 0.0
        assert upper == pytest.approx(2 / way)


def test_the_clearance_of_a_rule_holds_on_the_way(tmp_path: Path) -> None:
    rule = Rule(a=Selector("a"), b=Selector("b"), clearance=0.75)
    meshes = {"a": unit_box(), "b": unit_box(3.0, 1.5)}
    report = checked(tmp_path, [Motion(("a",), RIGHT)], [rule], **meshes)
    (finding,) = report.findings
    assert (finding.relation, finding.motion.relation) == ("near", "near")
    assert finding.placed_relation == "separated"
    assert (finding.severity, finding.rule) == ("error", rule.name)


@pytest.mark.parametrize(
    ("clearance", "severity", "rule"),
    [(45.0, "none", None), (45.0 * (1 + 1e-8), "error", "clearance")],
)
def test_a_clearance_that_is_met_exactly_is_kept(
    tmp_path: Path, clearance: float, severity: str, rule: str | None
) -> None:
    """Slides along a wall, 45 away; both far larger than what rounding does to the figure."""
    along = Motion(("a",), Translation((0.0, 0.0, 200.0)))
    wall = box((45.0, -400.0, -300.0), (65.0, 400.0, 300.0))
    meshes = {"a": box((-10.0, -5.0, -5.0), (0.0, 5.0, 5.0)), "b": wall}
    report = checked(tmp_path, [along], settings=Settings(clearance=clearance), **meshes)
    (finding,) = report.findings
    assert (finding.severity, finding.rule, finding.undecided) == (severity, rule, None)


def test_a_clearance_that_is_not_decided_is_no_hit(tmp_path: Path, monkeypatch) -> None:
    """The search may look at one interval: its upper end is 1.5 - sqrt 2, at the corner. The
    clearance is so close below it that the scan does not prove it either."""
    clearance = 1.5 - math.sqrt(2.0) - 1e-13
    monkeypatch.setattr(worst, "INTERVALS", 1)
    turn = Motion(("a",), Rotation((0.0, 0.0, 0.0), (0.0, 0.0, 1.0), 90.0))
    meshes = {"a": box((-1, -1, 0), (1, 1, 1)), "b": box((1.5, -5, 0), (9, 5, 1))}
    report = checked(tmp_path, [turn], settings=Settings(clearance=clearance), **meshes)
    (finding,) = report.findings
    assert finding.motion.relation == "separated"
    assert (finding.severity, finding.undecided) == ("warning", "limit")
    assert (report.summary.verdict, report.summary.limits_undecided) == ("incomplete", 1)
    page = Page(width=120, unicode=False, colour=False)
    text = table.render(report, page, explain=False, timings=False)
    open_gap = f"undecided: clearance is {clearance:.9g} (--clearance), and the gap is between"
    assert f"a and b: {open_gap}" in text
    said = "INCOMPLETE: no collision was found during 1 motion, but 1 pair may be closer"
    assert f"\n{said} than its clearance.\nNext:" in text


def test_a_touch_within_a_wide_band_may_keep_its_clearance(tmp_path: Path) -> None:
    along = Motion(("a",), Translation((0.0, 0.0, 5.0)))
    asked = Settings(clearance=0.25, tolerance=1.0)
    report = checked(tmp_path, [along], settings=asked, a=unit_box(), b=unit_box(1.5))
    (finding,) = report.findings
    assert (finding.motion.relation, finding.severity) == ("touching", "note")


def test_a_file_written_far_from_where_it_stands_makes_no_hit(tmp_path: Path) -> None:
    """An L slides along a wall at 45 degrees. Its file lies 2**30 off along x, and its placement
    takes that back, exactly; with the motion it is one matrix, rounded to some 1e-7."""

    def turned(mesh, off):
        points, faces = mesh
        return [(u - v + off, u + v, z) for u, v, z in points], faces

    wall = turned(box((-20.0, -2.0, -1.0), (20.0, 0.0, 5.0)), 0.0)
    write(tmp_path, slider=turned(bracket(), 2.0**30), wall=wall)
    scene = tmp_path / "far.toml"
    scene.write_text(
        'schema = "satcheck.scene/1"\n'
        f'bodies = [{{id = "a", mesh = "slider.obj", position = [{-(2.0**30)}, 0, 0]}}, '
        '{id = "b", mesh = "wall.obj"}]\n'
        '[[motion]]\nbodies = "a"\ntranslation = [3.3, 3.3, 0]\n'
    )
    (finding,) = check([scene], Settings(tolerance=1e-9)).findings
    assert (finding.relation, finding.exact_relation) == ("touching", "touching")
    assert finding.motion.relation == "touching"
    assert 2.0**30 * 2.0**-53 < finding.motion.tolerance < 1e-4


@pytest.mark.parametrize(
    "path",
    [
        Translation((1e30, 0.0, 0.0)),
        Translation((1.7e308, 1.7e308, 0.0)),
        Rotation((1e308, 1e308, 0.0), (0.0, 0.0, 1.0), 1.0),
        Rotation((0.0, 0.0, 0.0), (1e-308, 1e-320, 1e-310), 1e308),
        PosePath(
            (
                Waypoint(0.0, (0.0, 0.0, 0.0)),
                Waypoint(5e-324, (5.0, 0.0, 0.0)),
                Waypoint(1.0, (0.0, 0.0, 0.0)),
            )
        ),
    ],
)
def test_what_stays_open_is_incomplete(tmp_path: Path, path) -> None:
    report = checked(tmp_path, [Motion(("a",), path)], a=unit_box(), b=unit_box(1.25))
    (finding,) = report.findings
    assert (finding.severity, finding.undecided) == ("warning", "motion")
    assert (report.summary.verdict, report.summary.sweeps_undecided) == ("incomplete", 1)


def test_a_motion_of_nobody_is_said(tmp_path: Path) -> None:
    report = checked(tmp_path, [Motion(("c",), RIGHT)], a=unit_box(), b=unit_box(3.0))
    assert [issue.code for issue in report.issues] == ["unknown-body"]


def test_a_path_may_leave_its_placement_at_once(tmp_path: Path) -> None:
    """The pair is near as placed and far on its way: both count."""
    far = PosePath((Waypoint(0.0, (0.0, 50.0, 0.0)), Waypoint(1.0, (0.0, 60.0, 0.0))))
    report = checked(tmp_path, [Motion(("a",), far)], a=unit_box(), b=unit_box(0.5))
    (finding,) = report.findings
    assert (finding.relation, finding.motion.relation) == ("penetrating", "separated")
    assert finding.severity == "error"


def test_no_motion_no_sweep(tmp_path: Path) -> None:
    for name in [name for name in sys.modules if name.startswith("satcheck.audit.motion")]:
        del sys.modules[name]
    report = checked(tmp_path, [], a=unit_box(), b=unit_box(0.5))
    assert not {name for name in sys.modules if name.startswith("satcheck.audit.motion")}
    assert report.to_dict()["motions"] == []
    assert all(one.effect != "sweep" for one in report.effects)
    assert report.to_dict()["findings"][0]["motion"] is None


def test_the_table_tells(tmp_path: Path) -> None:
    turn = Motion(("a",), Rotation((0.0, 0.0, 0.0), (0.0, 0.0, 1.0), 180.0))
    blade = box((1, -0.5, 0), (3, 0, 1))
    wall, post = box((-0.5, 1, 0), (0, 3, 1)), unit_box(-6.0)
    report = checked(tmp_path, [turn], a=blade, b=wall, c=moved(bracket(), 0, 9, 0), d=post)
    page = Page(width=120, unicode=False, colour=False)
    text = table.render(report, page, explain=False, timings=False)
    assert "hits at 90" in text
    assert "1 pair hits in motion." in text
    assert "a and b: deepest at" in text


def test_a_sweep_is_not_certified(tmp_path: Path) -> None:
    meshes = {"a": unit_box(), "b": unit_box(3.0)}
    report = checked(
        tmp_path, [Motion(("a",), RIGHT)], settings=Settings(certificate=True), **meshes
    )
    (finding,) = report.findings
    assert finding.certificate is None
    verification = verify(json.loads(json.dumps(report.to_dict())), tmp_path)
    assert [one.outcome for one in verification.findings] == ["not certified"]
    assert any("not certified" in fault for fault in verification.not_certified)
