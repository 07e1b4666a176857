"""The whole of a check: which pairs are asked, how they add up, what survives a failure."""

from __future__ import annotations

import json
import struct
from importlib import import_module
from types import SimpleNamespace

import pytest
from jsonschema import Draft202012Validator

from satcheck.audit import Settings, check
from satcheck.audit.baseline import beside_baseline, known_findings
from satcheck.core.errors import SatcheckError
from satcheck.report.baseline import Baseline
from satcheck.report.report import Report, Truncated
from satcheck.report.schema import schema_of
from satcheck.scene import load_scene
from satcheck.verify import verify
from tests.audit.shapes import bracket, placed_scene, pose, scene_of, unit_box, write
from tests.scene import graphs


def adds_up(report):
    pairs = report.summary.pairs
    assert pairs.total == pairs.pruned + pairs.decided + pairs.allowed + pairs.indeterminate
    assert sum(report.summary.by_relation.values()) == pairs.total - pairs.allowed
    return pairs


def row(tmp_path, count, step=0.75, **extra):
    """Unit boxes in a row, each overlapping its neighbours when step < 1."""
    write(tmp_path, box=unit_box())
    bodies = [(f"b{k}", "box.obj", pose(k * step)) for k in range(count)]
    return placed_scene(tmp_path, bodies, **extra)


def test_all_pairs_of_a_row(tmp_path):
    report = check(row(tmp_path, 5))
    pairs = adds_up(report)
    assert (pairs.total, pairs.pruned, pairs.decided) == (10, 6, 4)
    assert len(report.findings) == 10
    assert report.summary.verdict == "fail"
    assert [(f.a, f.b) for f in report.findings[:4]] == [
        ("b0", "b1"),
        ("b0", "b2"),
        ("b0", "b3"),
        ("b0", "b4"),
    ]


@pytest.mark.parametrize(("listed", "count"), [(None, 10), (True, 10), (False, 4)])
def test_pruned_pairs_are_listed_on_request(tmp_path, listed, count):
    report = check(row(tmp_path, 5), Settings(list_pruned=listed))
    assert len(report.findings) == count
    assert report.summary.by_relation["separated"] == 6
    adds_up(report)


def test_of_many_pairs_those_with_boxes_apart_are_counted_alone(tmp_path):
    report = check(row(tmp_path, 11))
    assert (len(report.findings), report.truncated) == (55, None)
    report = check(row(tmp_path, 12))
    pairs = adds_up(report)
    assert (pairs.total, pairs.pruned, len(report.findings)) == (66, 55, 11)
    assert report.truncated == Truncated(55, "their boxes are apart")
    assert report.to_dict()["truncated"] == {"pairs": 55, "reason": "their boxes are apart"}


def test_of_many_pairs_with_an_unreadable_body_most_are_counted_alone(tmp_path, monkeypatch):
    """Ten boxes in a row, and three unreadable bodies: 13 * 12 / 2 pairs, 3 * 10 + 3 of them
    undecidable, of which the rule allows three."""
    monkeypatch.setattr(import_module("satcheck.audit.check"), "LISTED_UNDECIDABLE", 4)
    write(tmp_path, box=unit_box())
    (tmp_path / "bad.obj").write_text("v 0 0")
    bodies = [(f"b{k}", "box.obj", pose(0.75 * k)) for k in range(10)]
    bodies += [(f"bad{k}", "bad.obj", pose(k)) for k in range(3)]
    allowed = [["b0", f"bad{k}", "meant to"] for k in range(3)]
    report = check(placed_scene(tmp_path, bodies, allowed_pairs=allowed))
    pairs = adds_up(report)
    assert (pairs.total, pairs.allowed, pairs.indeterminate, pairs.decided) == (78, 3, 30, 9)
    assert sum(finding.relation == "indeterminate" for finding in report.findings) == 4
    assert report.summary.by_relation["indeterminate"] == 30
    assert report.truncated is not None
    assert report.truncated.pairs == 78 - 3 - 9 - 4
    assert "cannot be used" in report.truncated.reason


def one_place(tmp_path, count, **extra):
    write(tmp_path, box=unit_box())
    return placed_scene(tmp_path, [(f"b{k}", "box.obj", pose()) for k in range(count)], **extra)


def stop_after(monkeypatch, failures, block):
    monkeypatch.setattr(import_module("satcheck.audit.check"), "BLOCK", block)
    for room in ("audit.check", "verify.document"):
        monkeypatch.setattr(import_module(f"satcheck.{room}"), "ENOUGH_FAILURES", failures)


def test_after_enough_failures_the_other_pairs_are_counted_as_undecided(tmp_path, monkeypatch):
    """12 * 11 / 2 pairs of boxes at one place; 20 failures end the check within the third block of
    nine."""
    stop_after(monkeypatch, failures=20, block=9)
    told = []
    report = check(one_place(tmp_path, 12), Settings(certificate=True), lambda *n: told.append(n))
    pairs = adds_up(report)
    assert (pairs.total, pairs.decided, pairs.indeterminate, pairs.pruned) == (66, 27, 39, 0)
    assert [(f.a, f.b) for f in report.findings[9:13]] == [
        ("b0", "b10"),
        ("b0", "b11"),
        ("b1", "b2"),
        ("b1", "b3"),
    ]
    assert (report.summary.verdict, len(report.findings)) == ("fail", 27)
    assert report.truncated is not None
    assert report.truncated.pairs == 39
    (stopped,) = (issue for issue in report.issues if issue.code == "stopped-early")
    assert stopped.message.startswith("39 close pairs were not examined")
    assert told[-1] == (27, 66)
    verified = verify(report.to_dict(), tmp_path)
    assert verified.accepted, verified


def test_after_enough_pairs_that_meet_the_others_are_counted_as_undecided(tmp_path, monkeypatch):
    """12 sheets at one place touch each other: none of 66 pairs fails."""
    stop_after(monkeypatch, failures=8, block=9)
    for room in ("audit.check", "verify.document"):
        monkeypatch.setattr(import_module(f"satcheck.{room}"), "MEETINGS_OF_BODY", 1)
    (tmp_path / "sheet.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    scene = placed_scene(tmp_path, [(f"s{k}", "sheet.obj", pose()) for k in range(12)])
    report = check(scene, Settings(certificate=True))
    pairs = adds_up(report)
    assert (pairs.total, pairs.decided, pairs.indeterminate) == (66, 27, 39)  # of 20 at least
    assert (report.summary.verdict, {f.relation for f in report.findings}) == (
        "incomplete",
        {"touching"},
    )
    verified = verify(report.to_dict(), tmp_path)
    assert verified.accepted, verified


def test_a_baseline_of_all_findings_passes_no_check_that_has_stopped(tmp_path, monkeypatch):
    stop_after(monkeypatch, failures=20, block=9)
    report = check(one_place(tmp_path, 12))
    known = Baseline(findings=tuple(known_findings(report)))
    assert beside_baseline(report, known, "b.json").summary.verdict == "incomplete"


def test_blocks_of_pairs_give_the_findings_of_all_at_once(tmp_path, monkeypatch):
    scene = row(tmp_path, 9, 0.3)
    whole = check(scene).to_dict(timings=False)
    stop_after(monkeypatch, failures=1000, block=4)
    assert check(scene).to_dict(timings=False) == whole


def test_an_unreadable_body_that_no_finding_names_is_no_pass(tmp_path, monkeypatch):
    monkeypatch.setattr(import_module("satcheck.audit.check"), "LISTED_UNDECIDABLE", 0)
    write(tmp_path, box=unit_box())
    (tmp_path / "bad.obj").write_text("v 0 0")
    bodies = [(f"b{k}", "box.obj", pose(2.0 * k)) for k in range(12)]
    report = check(placed_scene(tmp_path, [*bodies, ("bad", "bad.obj", pose(0))]))
    assert (adds_up(report).indeterminate, report.findings) == (12, ())
    assert report.summary.verdict == "incomplete"
    assert not verify(report.to_dict(), tmp_path).faults


@pytest.mark.parametrize(
    ("static", "ignored", "why"),
    [
        ([0, 1, 2], [], "3 of static bodies"),
        ([], ["all"], "3 within ignored groups"),
        ([0, 1], ["all"], "1 of static bodies, 2 within ignored groups"),
    ],
)
def test_a_scene_that_exempts_every_pair_says_why(tmp_path, static, ignored, why):
    write(tmp_path, box=unit_box())
    bodies = [
        {"id": f"b{k}", "mesh": "box.obj", "groups": ["all"], "static": k in static}
        for k in range(3)
    ]
    scene = {"schema": "satcheck.scene/1", "bodies": bodies, "ignore_within_groups": ignored}
    path = tmp_path / "scene.json"
    path.write_text(json.dumps(scene), encoding="utf-8")
    report = check([path])
    pairs = adds_up(report)
    assert (pairs.total, pairs.exempt, report.summary.verdict) == (0, 3, "incomplete")
    (issue,) = report.issues
    assert (issue.code, issue.severity) == ("nothing-to-check", "warning")
    assert issue.message == f"no pair was checked: {why}"


def test_a_scene_whose_rules_allow_every_pair_passes_and_says_so(tmp_path):
    allowed = [["b0", "b1", "meant to"], ["b1", "b2", "too"], ["b0", "b2", "too"]]
    path = row(tmp_path, 3, allowed_pairs=allowed)
    report = check(path)
    pairs = adds_up(report)
    assert (pairs.total, pairs.allowed, report.summary.verdict) == (3, 3, "pass")
    (issue,) = report.issues
    assert (issue.code, issue.severity) == ("nothing-to-check", "note")
    assert issue.message == "no pair was checked: 3 allowed by rules"


def test_a_choice_of_pairs_that_leaves_none_does_not_pass(tmp_path):
    write(tmp_path, a=unit_box(), b=unit_box())
    files = [tmp_path / "a.obj", tmp_path / "b.obj"]
    report = check(load_scene(files, between=[("a", "nobody")]))
    assert (report.summary.pairs.allowed, report.summary.verdict) == (1, "incomplete")


def test_shapes_of_one_link_are_no_check(tmp_path):
    """A scene beside the robot allows what is not within the link."""
    shapes = "".join(
        f'<collision><origin xyz="{x} 0 0"/><geometry><box size="1 1 1"/></geometry></collision>'
        for x in (0.0, 0.5, 5.0)
    )
    robot = tmp_path / "robot.urdf"
    robot.write_text(f'<robot name="r"><link name="base">{shapes}</link></robot>')
    report = check([robot])
    assert report.summary.verdict == "incomplete"
    (issue,) = report.issues
    assert issue.message == "no pair was checked: 3 within one link"
    write(tmp_path, box=unit_box())
    rule = {"a": "table", "b": "base/*", "allowed": True, "reason": "bolted"}
    bodies = [{"id": "table", "mesh": "box.obj"}]
    scene = {"schema": "satcheck.scene/1", "units": "m", "bodies": bodies, "rules": [rule]}
    (tmp_path / "scene.json").write_text(json.dumps(scene), encoding="utf-8")
    report = check([robot, tmp_path / "scene.json"])
    assert report.summary.verdict == "incomplete"
    (issue,) = report.issues
    assert issue.message == "no pair was checked: 3 within one link, 3 allowed by rules"


def test_allowed_pairs_cost_nothing(tmp_path):
    report = check(row(tmp_path, 3, allowed_pairs=[["b1", "b0", "meant to"]]))
    pairs = adds_up(report)
    assert (pairs.total, pairs.allowed, pairs.decided, pairs.pruned) == (3, 1, 1, 1)
    assert [(f.a, f.b) for f in report.findings] == [("b0", "b2"), ("b1", "b2")]


def test_pairs_within_an_ignored_group_are_not_asked(tmp_path):
    write(tmp_path, box=unit_box())
    bodies = [
        ("a", "box.obj", pose(), "arm"),
        ("b", "box.obj", pose(0.5), "arm"),
        ("c", "box.obj", pose(0.75), "tool"),
        ("d", "box.obj", pose(0.25), "tool"),
    ]
    report = check(placed_scene(tmp_path, bodies, ignore_within_groups=["arm"]))
    pairs = adds_up(report)
    assert (pairs.total, pairs.exempt) == (5, 1)
    assert ("a", "b") not in [(f.a, f.b) for f in report.findings]
    assert ("c", "d") in [(f.a, f.b) for f in report.findings]


def test_an_unreadable_file_leaves_its_pairs_indeterminate(tmp_path):
    broken = tmp_path / "broken.obj"
    broken.write_text("v 0 0 nan\nf 1 1 1\n", encoding="utf-8")
    paths = write(tmp_path, a=unit_box(), b=unit_box(2))
    report = check([paths[0], broken, paths[1]])
    pairs = adds_up(report)
    assert (pairs.total, pairs.indeterminate) == (3, 2)
    assert report.summary.verdict == "incomplete"
    reasons = [f.reason for f in report.findings if f.relation == "indeterminate"]
    assert all(reason.startswith("unreadable") for reason in reasons)
    assert any(issue.severity == "error" for issue in report.issues)
    assert [body.triangles for body in report.bodies] == [12, None, 12]


def test_one_body_is_refused(tmp_path):
    with pytest.raises(SatcheckError) as caught:
        check(write(tmp_path, a=unit_box()))
    assert caught.value.code == "too-few-bodies"
    with pytest.raises(SatcheckError, match=r"two bodies at least; .*gone.obj: no such file"):
        check([tmp_path / "gone.obj"])


def test_one_path_is_no_list_of_paths(tmp_path):
    with pytest.raises(SatcheckError, match=r"a list of paths, got .*Path") as caught:
        check(write(tmp_path, a=unit_box())[0])
    assert caught.value.code == "bad-argument"


def test_a_check_of_nothing_never_passes(tmp_path):
    write(tmp_path, box=unit_box())
    bodies = [("a", "box.obj", pose(), "g"), ("b", "box.obj", pose(0.5), "g")]
    report = check(placed_scene(tmp_path, bodies, ignore_within_groups=["g"]))
    assert report.summary.pairs.total == 0
    assert report.summary.verdict == "incomplete"


def test_threads_change_nothing(tmp_path):
    scene = row(tmp_path, 14)
    one = check(scene, Settings(jobs=1)).to_dict(timings=False)
    many = check(row(tmp_path, 14), Settings(jobs=4)).to_dict(timings=False)
    assert json.dumps(one) == json.dumps(many)


def test_progress_counts_every_pair(tmp_path):
    seen = []
    check(row(tmp_path, 12), Settings(jobs=2), progress=lambda done, of: seen.append((done, of)))
    assert seen == [(k, 11) for k in range(1, 12)]


def test_ids_hold_no_positions(tmp_path):
    first = check(row(tmp_path, 3))
    second = check(row(tmp_path, 3, step=0.5))
    assert [f.id for f in first.findings] == [f.id for f in second.findings]
    assert len({f.id for f in first.findings}) == 3


def test_the_report_keeps_to_the_published_schema(tmp_path):
    schema = Draft202012Validator(schema_of("report", Report))
    scene = scene_of(tmp_path, a=unit_box(), b=unit_box(0.5), c=unit_box(9), d=bracket())
    for settings in (Settings(clearance=10.0), Settings(depth=False), Settings(accuracy="aabb")):
        schema.validate(check(scene, settings).to_dict())


def test_flush_nodes_touch_however_far_out_a_program_put_them(tmp_path):
    """Bricks of length 1.1 side by side, their places rounded to float32 as exporters do."""

    def single(value):
        return struct.unpack("<f", struct.pack("<f", value))[0]

    nodes = [
        {"mesh": 0, "scale": [single(1.1), 1, 1], "translation": [single(1000 + 1.1 * k), 0, 0]}
        for k in range(8)
    ]
    path = tmp_path / "wall.glb"
    path.write_bytes(graphs.glb(nodes))
    findings = check([path], Settings(depth=False)).findings
    side_by_side = [f for f in findings if f.relation != "separated"]
    assert {f.relation for f in side_by_side} == {"touching"}
    assert len(side_by_side) == len(nodes) - 1
    assert {f.exact_relation for f in side_by_side} == {"penetrating", "separated"}


def test_two_arguments_that_are_no_scene_get_the_right_call():
    def refused(first, second):
        with pytest.raises(SatcheckError) as caught:
            check(first, second)
        return caught.value.message

    assert refused("a.stl", "b.stl").endswith(": satcheck.check(['a.stl', 'b.stl'])")
    box = SimpleNamespace(vertices=[], faces=[])
    assert refused(box, box) == "satcheck.check_meshes takes two meshes"
    assert refused(["a.stl"], {"depth": True}).startswith("settings should be a satcheck.Settings")
