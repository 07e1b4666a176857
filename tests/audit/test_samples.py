"""Many poses of one robot: a verdict each, and a tally of every pair."""

from __future__ import annotations

import json
import math
import pickle
from itertools import combinations
from pathlib import Path
from typing import Any

import pytest
from jsonschema import Draft202012Validator

from satcheck.audit import Settings, check
from satcheck.audit.samples import check_poses
from satcheck.audit.suggest import suggest
from satcheck.cli.commands.schema import text as schema_text
from satcheck.cli.formats.samples import render
from satcheck.cli.output import PLAIN_PAGE
from satcheck.core.errors import SatcheckError
from satcheck.report.samples import SamplesReport
from satcheck.scene import MeshFile, Scene, load_scene
from satcheck.scene.robot import Pose, RandomPoses, posed, read_poses
from tests.scene.robot.robots import joint, link, robot_of

SAMPLES = Path(__file__).resolve().parents[2] / "sample_meshes"
ARM = load_scene([SAMPLES / "arm.urdf", SAMPLES / "arm.srdf"])
ROBOTS = [robot.robot for robot in ARM.robots]
QUICK = Settings(depth=False)


def poses() -> list[Pose]:
    found = read_poses(str(SAMPLES / "arm_poses.json"))
    assert isinstance(found, list)
    return found


def overlapping(found: SamplesReport, number: int) -> set[tuple[str, str]]:
    findings = found.samples[number].findings
    return {(one.a, one.b) for one in findings if one.relation == "penetrating"}


def test_each_pose_has_the_verdict_of_a_check_of_its_own() -> None:
    drawn = list(RandomPoses(ROBOTS, 12, 3))
    found = check_poses(ARM, drawn, QUICK)
    assert {sample.verdict for sample in found.samples} == {"pass", "fail"}
    for sample, pose in zip(found.samples, drawn, strict=True):
        report = check(posed(ARM, pose), QUICK)
        assert sample.verdict == report.summary.verdict
        assert [(one.a, one.b, one.relation) for one in sample.findings] == [
            (one.a, one.b, one.relation) for one in report.findings if one.relation != "separated"
        ]
        given = {name: list(values) for name, values in pose.items()}
        stated = {name: [v] if isinstance(v, float) else v for name, v in sample.pose.items()}
        assert stated.items() >= given.items()


def test_a_checked_robot_is_equal_to_a_fresh_one_and_can_be_sent() -> None:
    arm = load_scene([SAMPLES / "arm.urdf", SAMPLES / "arm.srdf"])
    check_poses(arm, poses(), QUICK)
    assert arm.robots == ARM.robots
    assert pickle.loads(pickle.dumps(arm.robots)) == arm.robots


def test_in_a_plane_each_pose_has_outlines_of_its_own() -> None:
    flat = Settings(depth=False, planar="xz")
    drawn = list(RandomPoses(ROBOTS, 12, 3, {"turn": (0.0,)}))
    found = check_poses(ARM, drawn, flat)
    for sample, pose in zip(found.samples, drawn, strict=True):
        findings = check(posed(ARM, pose), flat).findings
        assert [(one.a, one.b, one.relation) for one in sample.findings] == [
            (one.a, one.b, one.relation) for one in findings if one.relation != "separated"
        ]


def test_a_ball_on_a_rod_that_turns_in_closed_form(tmp_path: Path) -> None:
    """Its centre at cos t along x, and a wall there from 1 on: an overlap where cos t > 3/4."""
    wall = '<origin xyz="1.5 0 0"/><geometry><box size="1 4 1"/></geometry>'
    ball = '<origin xyz="1 0 0"/><geometry><sphere radius="0.25"/></geometry>'
    turn = joint("t", "wall", "ball", "continuous", '<axis xyz="0 0 1"/>')
    links = [
        link(name, f"<collision>{shape}</collision>")
        for name, shape in (("wall", wall), ("ball", ball))
    ]
    (tmp_path / "r.urdf").write_text(robot_of(*links, turn))
    angles = [k * math.pi / 50 for k in range(101)]
    scene = load_scene([tmp_path / "r.urdf"])
    found = check_poses(scene, [{"t": (angle,)} for angle in angles], Settings(depth=True))
    for sample, angle in zip(found.samples, angles, strict=True):
        depth = math.cos(angle) - 0.75
        assert abs(depth) > 1e-3  # no sample where rounding could decide
        assert (sample.verdict == "fail") == (depth > 0)
        if depth > 0:
            low, high = sample.findings[0].depth_bounds or (0.0, 0.0)
            assert low - 1e-12 <= depth <= high + 1e-12


def test_the_sample_poses() -> None:
    found = check_poses(ARM, poses(), Settings(depth=True))
    assert [sample.verdict for sample in found.samples] == ["pass", "fail", "fail"]
    assert found.summary.verdict == "fail"
    assert overlapping(found, 1) == {("base", "left"), ("base", "right"), ("turret", "fore/palm")}
    assert overlapping(found, 2) == {("base", "upper")}
    assert all(one.depth for one in found.samples[2].findings if one.relation == "penetrating")


def test_every_asked_pair_has_its_tally() -> None:
    found = check_poses(ARM, [{}, {"elbow": (3.0,)}, {"elbow": (3.0,)}, {"grip": (0.125,)}], QUICK)
    allowed = {frozenset((rule.a.text, rule.b.text)) for rule in ARM.rules}
    asked = [pair for pair in combinations(ARM.order, 2) if frozenset(pair) not in allowed]
    assert sorted((tally.a, tally.b) for tally in found.pairs) == sorted(asked)
    tallies = {(tally.a, tally.b): tally for tally in found.pairs}
    fingers = tallies["left", "right"]  # closed in the first three
    assert (fingers.touches, fingers.overlaps, fingers.contacts) == (3, 0, 3)
    assert fingers.first_overlap is None
    palm = tallies["turret", "fore/palm"]
    assert (palm.overlaps, palm.first_overlap) == (2, 2)
    assert tallies["base", "upper"].contacts == 0


def test_near_counts_as_near() -> None:
    found = check_poses(ARM, [{"grip": (0.0625,)}], Settings(depth=False, clearance=0.25))
    tallies = {(tally.a, tally.b): tally for tally in found.pairs}
    assert tallies["left", "right"].near == 1
    assert tallies["left", "right"].contacts == 0


def test_what_cannot_be_read_is_undecided_in_every_pose(tmp_path: Path) -> None:
    text = (SAMPLES / "arm.urdf").read_text().replace("arm_finger.obj", "gone.obj")
    (tmp_path / "arm.urdf").write_text(text)
    (tmp_path / "arm_beam.stl").write_bytes((SAMPLES / "arm_beam.stl").read_bytes())
    found = check_poses(load_scene([tmp_path / "arm.urdf", SAMPLES / "arm.srdf"]), poses()[:1])
    assert found.summary.verdict == "incomplete"
    tallies = {(tally.a, tally.b): tally for tally in found.pairs}
    assert tallies["base", "left"].undecided == 1
    assert [issue.code for issue in found.issues].count("missing-resource") == 1


def test_issues_stand_with_their_pose_and_the_others_once() -> None:
    found = check_poses(ARM, [{"elbow": (3.25,)}, {}], QUICK)
    assert [issue.code for issue in found.samples[0].issues] == ["beyond-limits"]
    assert not found.samples[1].issues
    assert [issue.code for issue in found.issues] == ["no-collision-geometry"]


def with_cart(path: str) -> Scene:
    """A box that is driven along x, 5 to -5, past or through the column of the arm."""
    cart = '{id = "cart", shape = {type = "box", size = [0.2, 0.2, 0.2]}, position = [5, 0, 0.5]}'
    head = f'schema = "satcheck.scene/1"\nunits = "m"\nbodies = [{cart}]\n'
    text = f'{head}[[motion]]\nbodies = "cart"\n{path}\n'
    Path("cart.toml").write_text(text, encoding="utf-8")
    return load_scene(["cart.toml", SAMPLES / "arm.urdf"])


def test_what_hits_on_the_way_counts(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    scene = with_cart("translation = [-10, 0, 0]")
    drawn = list(RandomPoses([robot.robot for robot in scene.robots], 3, 1))
    found = check_poses(scene, drawn, QUICK)
    tallies = {(one.a, one.b): one for one in found.pairs}
    for number, pose in enumerate(drawn, 1):
        report = check(posed(scene, pose), QUICK)
        hits = {
            (one.a, one.b)
            for one in report.findings
            if one.motion is not None and one.motion.relation == "penetrating"
        }
        assert hits
        listed = {(one.a, one.b) for one in found.samples[number - 1].findings}
        assert hits <= listed
        assert all(tallies[pair].first_overlap <= number for pair in hits)
    text = render(found, PLAIN_PAGE)
    assert "cart hits " in text
    assert "separated" not in text
    schema = Draft202012Validator(json.loads(schema_text("samples")))
    schema.validate(json.loads(json.dumps(found.to_dict())))
    why = {
        (one.a, one.b): one.why for one in suggest(scene, poses=drawn, seed=1).report.suggestions
    }
    assert all(why.get(pair) != "never" for pair in hits)


def test_progress_counts_poses() -> None:
    seen: list[tuple[int, int]] = []
    check_poses(ARM, poses(), QUICK, lambda done, total: seen.append((done, total)))
    assert seen == [(1, 3), (2, 3), (3, 3)]


def test_no_work_is_done_when_a_later_pose_is_wrong() -> None:
    seen: list[int] = []
    with pytest.raises(SatcheckError, match="unknown joint"):
        check_poses(ARM, [{}, {"x": (1.0,)}], QUICK, lambda done, _: seen.append(done))
    assert not seen


def test_what_a_mesh_has_is_made_once_for_all_poses(monkeypatch: pytest.MonkeyPatch) -> None:
    from satcheck.audit.body import SharedMesh

    made: list[str] = []
    make = SharedMesh.__init__

    def counted(self: SharedMesh, file: MeshFile, *rest: Any, **named: Any) -> None:
        made.append(file.sha256 + str(file.part))
        make(self, file, *rest, **named)

    monkeypatch.setattr(SharedMesh, "__init__", counted)
    arm = load_scene([SAMPLES / "arm.urdf", SAMPLES / "arm.srdf"])
    for seed in (3, 4):
        check_poses(arm, list(RandomPoses(ROBOTS, 10, seed)), QUICK)
    assert made
    assert len(made) == len(set(made))
