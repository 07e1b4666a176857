"""What is suggested, and with what evidence."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest
from msgspec.structs import replace

from satcheck.audit import check
from satcheck.audit.finding import examine
from satcheck.audit.suggest import Suggestions, suggest
from satcheck.report.report import INTERNAL_ERROR
from satcheck.scene import Rule, Selector, load_scene
from satcheck.scene.robot import RandomPoses
from tests.audit.shapes import open_box, scene_of, unit_box
from tests.scene.robot.robots import joint, link, robot_of

SAMPLES = Path(__file__).resolve().parents[2] / "sample_meshes"
ARM = load_scene([SAMPLES / "arm.urdf"])
POSES = list(RandomPoses([robot.robot for robot in ARM.robots], 40, 0))


def pairs(found: Suggestions) -> dict[tuple[str, str], str]:
    return {(one.a, one.b): one.why for one in found.report.suggestions}


def allow(a: str, b: str, **keys) -> Rule:
    return Rule(a=Selector.exactly(a), b=Selector.exactly(b), **(keys or {"allowed": True}))


def test_what_is_in_contact_as_placed(tmp_path):
    meshes = {"a": unit_box(), "b": unit_box(0.75), "c": unit_box(1.75), "d": unit_box(9)}
    found = suggest(scene_of(tmp_path, **meshes))
    assert pairs(found) == {("a", "b"): "contact", ("b", "c"): "contact"}
    overlap, touch = found.report.suggestions
    assert overlap.relation == "penetrating"
    assert overlap.depth_bounds == pytest.approx((0.25, 0.25))
    assert (touch.relation, touch.depth_bounds) == ("touching", None)
    assert found.undecided == {}


@pytest.mark.parametrize(
    "rule", [allow("a", "b"), allow("a", "b", max_depth=0.5), allow("a", "b", severity="note")]
)
def test_what_rules_allow_limit_or_excuse_is_not_suggested(tmp_path, rule):
    scene = replace(scene_of(tmp_path, a=unit_box(), b=unit_box(0.75)), rules=(rule,))
    assert suggest(scene).report.suggestions == ()


def test_too_deep_for_its_rule_is_suggested(tmp_path):
    scene = scene_of(tmp_path, a=unit_box(), b=unit_box(0.75))
    scene = replace(scene, rules=(allow("a", "b", max_depth=0.125),))
    assert pairs(suggest(scene)) == {("a", "b"): "contact"}


def test_what_could_not_be_decided_is_counted_and_not_suggested(tmp_path):
    found = suggest(scene_of(tmp_path, a=open_box(), b=unit_box(1, 1, 3.5)))
    assert (found.report.suggestions, len(found.undecided)) == ((), 1)


def test_links_with_a_joint_between_them():
    found = suggest(ARM)
    adjacent = {(one.links, one.why) for one in found.report.suggestions if one.why == "adjacent"}
    assert {links for links, _ in adjacent} == {
        ("base", "turret"),
        ("turret", "upper"),
        ("upper", "fore"),
        ("fore", "left"),
        ("fore", "right"),
    }
    assert pairs(found)["left", "right"] == "contact"
    assert all(one.contacts is None for one in found.report.suggestions)
    assert "never" not in pairs(found).values()


def test_random_poses_tell_never():
    found = suggest(ARM, poses=POSES, seed=0)
    assert (found.report.poses, found.report.seed) == (40, 0)
    never = [one for one in found.report.suggestions if one.why == "never"]
    assert {one.contacts for one in never} == {0}
    assert {one.relation for one in never} == {None}
    assert {("turret", "left"), ("upper", "right")} <= {(one.a, one.b) for one in never}
    assert ("base", "upper") not in pairs(found)  # it meets in some poses


def test_random_poses_tell_always(tmp_path):
    """Base and tip turn within each other; no joint is between the two."""
    turn = '<axis xyz="0 0 1"/><limit lower="-1" upper="1" effort="1" velocity="1"/>'
    (tmp_path / "r.urdf").write_text(
        robot_of(
            *map(link, ("base", "mid", "tip")),
            joint("j", "base", "mid", "revolute", turn),
            joint("k", "mid", "tip", "revolute", turn),
        )
    )
    scene = load_scene([tmp_path / "r.urdf"])
    poses = list(RandomPoses([robot.robot for robot in scene.robots], 5, 1))
    found = {(one.a, one.b): one for one in suggest(scene, poses=poses, seed=1).report.suggestions}
    assert found["base", "tip"].why == "always"
    assert found["base", "tip"].contacts == 5
    assert found["base", "mid"].why == "adjacent"


def test_never_is_not_said_of_what_overlaps_as_placed(tmp_path, monkeypatch):
    """By 0.05, as a rule allows it; in the random poses the arm is far from the post."""
    shape = '<collision>{}<geometry><box size="1 1 1"/></geometry></collision>'
    arm = shape.format('<origin xyz="1.9 0 0"/>')
    limit = '<axis xyz="1 0 0"/><limit lower="-100" upper="100" effort="1" velocity="1"/>'
    links = [link("base", shape.format("")), link("mid", ""), link("arm", arm)]
    joints = [joint("fix", "base", "mid", "fixed"), joint("j", "mid", "arm", "prismatic", limit)]
    (tmp_path / "r.urdf").write_text(robot_of(*links, *joints))
    monkeypatch.chdir(tmp_path)
    post = '{id = "post", shape = {type = "box", size = [1, 1, 1]}, position = [2.85, 0, 0]}'
    text = f'schema = "satcheck.scene/1"\nunits = "m"\nbodies = [{post}]\n'
    (tmp_path / "post.toml").write_text(text)
    scene = load_scene(["post.toml", "r.urdf"])
    scene = replace(scene, rules=(*scene.rules, allow("post", "arm", max_depth=0.125)))
    drawn = list(RandomPoses([robot.robot for robot in scene.robots], 20, 3))
    found = suggest(scene, poses=drawn, seed=3)
    assert pairs(found)["post", "base"] == "never"
    assert ("post", "arm") not in pairs(found)


def test_an_internal_error_in_a_random_pose_is_told(monkeypatch):
    def fails(draft, climb=None):
        if not draft.pair.request.wants("depth"):
            raise RuntimeError("boom")
        return examine(draft, climb)

    monkeypatch.setattr(sys.modules["satcheck.audit.checked_pairs"], "examine", fails)
    found = suggest(ARM, poses=POSES[:2], seed=0)
    assert INTERNAL_ERROR in {issue.code for issue in found.issues}


def test_bodies_of_links_that_may_meet_are_remembered():
    found = suggest(ARM, poses=POSES, seed=0)
    never = {
        frozenset(one.links) for one in found.report.suggestions if one.why == "never" and one.links
    }
    assert frozenset(("base", "upper")) in found.may_meet
    assert never - found.may_meet


def test_allowing_what_is_suggested_makes_the_check_pass():
    scene = load_scene([SAMPLES / "gripper.glb"])
    assert check(scene).summary.verdict == "fail"
    rules = tuple(allow(one.a, one.b) for one in suggest(scene).report.suggestions)
    allowed = replace(scene, rules=rules)
    assert check(allowed).summary.verdict == "pass"
    assert suggest(allowed).report.suggestions == ()
