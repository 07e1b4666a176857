"""What is suggested, and with what evidence."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest
from msgspec.structs import replace

from satcheck.audit import Settings, check
from satcheck.audit.finding import examine
from satcheck.audit.suggest import NO_FIGURE, Suggestions, limit, suggest, suggestions_of
from satcheck.report.report import INTERNAL_ERROR
from satcheck.scene import Rule, Scene, Selector, load_scene
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
    """b and c touch, which passes."""
    meshes = {"a": unit_box(), "b": unit_box(0.75), "c": unit_box(1.75), "d": unit_box(9)}
    found = suggest(scene_of(tmp_path, **meshes))
    (overlap,) = found.report.suggestions
    assert (overlap.a, overlap.b, overlap.why) == ("a", "b", "contact")
    assert overlap.relation == "penetrating"
    assert overlap.depth_bounds == pytest.approx((0.25, 0.25))
    assert overlap.thickness_bounds == pytest.approx((0.25, 0.25), rel=0.01)
    assert (overlap.max_depth, overlap.max_thickness) == (0.275, 0.275)
    assert found.undecided == {}


@pytest.mark.parametrize(
    ("bounds", "most"),
    [
        (None, None),
        ((0.0, 0.0), 0.0),
        ((0.1, 0.25), 0.275),
        ((1.0, 1.0), 1.1),
        ((9.0, 9.1), 10.1),  # 10.01 at least
        ((1e-9, 3e-7), 3.3e-7),
        ((1e30, 1e30), pytest.approx(1.1e30, rel=0.01)),
        ((0.0, 1e-320), pytest.approx(1.1e-320, rel=0.01)),
    ],
)
def test_a_limit_is_the_upper_end_and_a_tenth_in_three_digits(bounds, most):
    assert limit(bounds) == most
    assert bounds is None or limit(bounds) >= bounds[1]


def test_an_overlap_without_a_figure_is_not_suggested(tmp_path):
    """A rule would allow it without a limit. It is counted as undecided."""
    report = check(
        scene_of(tmp_path, a=unit_box(), b=unit_box(0.75)), Settings(depth=False, thickness=False)
    )
    found = suggestions_of({None: report})
    assert found.report.suggestions == ()
    (left_out,) = found.report.unchecked
    assert (left_out.a, left_out.b, left_out.reason) == ("a", "b", NO_FIGURE)
    assert found.undecided == {"a and b": NO_FIGURE}
    assert found.report.undecided == 1


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


def test_the_suggested_limits_make_the_check_pass():
    scene = load_scene([SAMPLES / "gripper.glb"])
    assert check(scene).summary.verdict == "fail"
    rules = tuple(
        allow(one.a, one.b, max_depth=one.max_depth, max_thickness=one.max_thickness)
        for one in suggest(scene).report.suggestions
    )
    allowed = replace(scene, rules=rules)
    assert check(allowed).summary.verdict == "pass"
    assert suggest(allowed).report.suggestions == ()


def turning(tmp_path: Path, size: str) -> Scene:
    """A robot whose tip turns about its base; a link without a body is between them."""
    shape = '<collision>{}<geometry><box size="{}"/></geometry></collision>'
    turn = '<axis xyz="0 0 1"/><limit lower="-3" upper="3" effort="1" velocity="1"/>'
    joints = [joint("j", "base", "mid", "revolute", turn), joint("k", "mid", "tip", "fixed")]
    tip = shape.format('<origin xyz="1 0 0"/>', "1.5 0.1 0.1")
    mid = shape.format('<origin xyz="0 0 9"/>', "1 1 1")
    base = shape.format('<origin xyz="1 0 0"/>', size)
    links = [link("base", base), link("mid", mid), link("tip", tip)]
    (tmp_path / "r.urdf").write_text(robot_of(*links, *joints))
    return load_scene([tmp_path / "r.urdf"])


def test_links_that_meet_in_some_poses_are_never_allowed(tmp_path):
    """They overlap as placed: a rule limits that, and the reason counts the poses."""
    scene = turning(tmp_path, "0.1 0.1 0.1")
    poses = list(RandomPoses([robot.robot for robot in scene.robots], 100, 0))
    found = suggest(scene, poses=poses, seed=0)
    (pair,) = [one for one in found.report.suggestions if (one.a, one.b) == ("base", "tip")]
    assert pair.why == "contact"
    assert 0 < pair.contacts < 50
    assert pair.max_depth is not None


def test_a_floor_below_a_robot_is_limited_and_not_allowed(tmp_path, monkeypatch):
    """They meet in every pose, and as deep; a floor is no link."""
    turning(tmp_path, "3 3 3")
    monkeypatch.chdir(tmp_path)
    floor = '{id = "floor", shape = {type = "box", size = [9, 9, 1]}, position = [0, 0, -1.75]}'
    text = f'schema = "satcheck.scene/1"\nunits = "m"\nbodies = [{floor}]\n'
    (tmp_path / "floor.toml").write_text(text)
    scene = load_scene(["floor.toml", "r.urdf"])
    poses = list(RandomPoses([robot.robot for robot in scene.robots], 3, 0))
    found = {(one.a, one.b): one for one in suggest(scene, poses=poses).report.suggestions}
    floored = found["floor", "base"]
    assert (floored.why, floored.contacts) == ("contact", 3)
    assert floored.max_depth == pytest.approx(0.275)
    assert found["base", "tip"].why == "always"
