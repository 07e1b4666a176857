"""A robot among the bodies of a scene: ids, permissions, poses."""

from __future__ import annotations

import math
from pathlib import Path

import pytest
from msgspec.structs import replace

from satcheck.core.errors import SatcheckError
from satcheck.scene import Refused, Scene, load_scene
from satcheck.scene.robot import RandomPoses, pose_of_states, posed
from satcheck.scene.robot.model import State
from tests.scene.files import obj
from tests.scene.robot.robots import BOX, SAMPLES, joint, link, robot_of

ARM = [SAMPLES / "arm.urdf", SAMPLES / "arm.srdf"]


def codes(scene: Scene) -> list[str]:
    return [issue.code for issue in scene.issues]


def load(folder: Path, *elements: str, srdf: str | None = None) -> Scene:
    path = folder / "r.urdf"
    path.write_text(robot_of(*elements))
    if srdf is None:
        return load_scene([path])
    (folder / "r.srdf").write_text(srdf)
    return load_scene([path, folder / "r.srdf"])


def test_each_collision_is_a_body() -> None:
    scene = load_scene(ARM)
    assert scene.order == ("base", "turret", "upper", "fore/beam", "fore/palm", "left", "right")
    assert (scene.units, scene.name) == ("m", "arm")
    assert codes(scene) == ["no-collision-geometry"]
    files = {body.id: body.file for body in scene.bodies}
    assert files["upper"] is files["fore/beam"]
    assert files["upper"].path == (SAMPLES / "arm_beam.stl").as_posix()
    assert files["base"].path == (SAMPLES / "arm.urdf").as_posix()


def test_what_may_touch() -> None:
    rules = load_scene(ARM).rules
    assert all(rule.allowed for rule in rules)
    allowed = {tuple(sorted((rule.a.text, rule.b.text))): rule.reason for rule in rules}
    assert allowed == {
        ("fore/beam", "fore/palm"): "one rigid link",
        ("base", "turret"): "SRDF: Adjacent",
        ("turret", "upper"): "SRDF: Adjacent",
        ("fore/beam", "upper"): "SRDF: Adjacent",
        ("fore/palm", "upper"): "SRDF: Adjacent",
        ("fore/beam", "left"): "SRDF: Adjacent",
        ("fore/palm", "left"): "SRDF: Adjacent",
        ("fore/beam", "right"): "SRDF: Adjacent",
        ("fore/palm", "right"): "SRDF: Adjacent",
    }


def test_without_an_srdf_neighbours_are_checked_and_a_note_says_so() -> None:
    scene = load_scene(ARM[:1])
    assert {rule.reason for rule in scene.rules} == {"one rigid link"}
    (note,) = [issue for issue in scene.issues if issue.code == "neighbours-checked"]
    assert note.severity == "note"
    assert note.message.startswith("5 pairs of links")
    assert "suggest --format srdf writes one" in note.message


def test_one_pair_of_neighbours_is_one(tmp_path: Path) -> None:
    scene = load(tmp_path, link("a"), link("b"), joint("j", "a", "b"))
    (note,) = [issue for issue in scene.issues if issue.code == "neighbours-checked"]
    assert "1 pair of links with a joint between them is checked" in note.message


def test_links_without_bodies_are_part_of_the_joint(tmp_path: Path) -> None:
    elements = [link("a"), link("frame", ""), link("b"), joint("j", "a", "frame")]
    scene = load(tmp_path, *elements, joint("k", "frame", "b"))
    assert scene.robots[0].neighbours() == [("a", "b")]


def test_several_collisions_are_numbered_or_named(tmp_path: Path) -> None:
    named = BOX.replace("<collision>", '<collision name="tip">')
    scene = load(tmp_path, link("a", BOX + named + BOX), link("a/1"), joint("j", "a", "a/1"))
    assert scene.order == ("a/1", "a/tip", "a/3", "a/1-2")
    assert scene.robots[0].bodies_of("a/1") == ["a/1-2"]


def test_a_body_that_cannot_be_read_leaves_the_others(tmp_path: Path) -> None:
    (tmp_path / "cut.obj").write_bytes(obj() + b"f 1 2 99\n")
    meshes = ("gone.stl", "cut.obj", "text.txt")
    inside = [f'<mesh filename="{name}"/>' for name in meshes] + ["<torus/>"]
    elements = [
        link(name, f"<collision><geometry>{shape}</geometry></collision>")
        for name, shape in zip("abcd", inside, strict=True)
    ]
    joints = [joint(name, "good", name) for name in "abcd"]
    (tmp_path / "text.txt").write_text("")
    scene = load(tmp_path, link("good"), *elements, *joints)
    assert [body.id for body in scene.bodies] == ["good"]
    assert {lost.id: lost.issue.code for lost in scene.unreadable} == {
        "a": "missing-resource",
        "b": "index-out-of-range",
        "c": "unsupported-format",
        "d": "unsupported-feature",
    }
    assert all(lost.issue.severity == "error" for lost in scene.unreadable)
    assert posed(scene, {}).unreadable == scene.unreadable


def test_another_pose_moves_bodies_and_reads_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    scene = load_scene([*ARM, SAMPLES / "box.obj"])
    monkeypatch.setattr(Path, "read_bytes", None)
    moved = posed(scene, {"turn": (3.5,), "grip": (0.25,)})
    before, after = ({body.id: body for body in one.bodies} for one in (scene, moved))
    assert all(after[name].file is before[name].file for name in before)
    assert after["base"] is before["base"]
    assert after["box"] is before["box"]
    assert after["left"].transform != before["left"].transform
    assert codes(moved).count("beyond-limits") == 2  # grip, and what mimics it
    assert codes(posed(moved, {})) == codes(scene)


def test_states_are_put_together_unless_they_differ() -> None:
    scene = load_scene(ARM)
    pose = pose_of_states(scene, ["bowed", "open"])
    assert pose == {"shoulder": (1.5,), "elbow": (1.25,), "grip": (0.1875,)}
    with pytest.raises(SatcheckError, match="different values: together they are one pose"):
        pose_of_states(scene, ["bowed", "folded"])


@pytest.mark.parametrize(
    ("joint", "said"),
    [
        ('name="elbo" value="3"', "unknown joint 'elbo' (did you mean 'elbow'?)"),
        ('name="elbow" value="3 1"', "joint 'elbow' (revolute) takes 1 number, not 2"),
    ],
)
def test_a_state_that_the_robot_cannot_take_is_said_with_its_place(
    tmp_path: Path, joint: str, said: str
) -> None:
    srdf = (SAMPLES / "arm.srdf").read_text().replace('name="elbow" value="3"', joint)
    (tmp_path / "arm.srdf").write_text(srdf)
    scene = load_scene([SAMPLES / "arm.urdf", tmp_path / "arm.srdf"])
    assert pose_of_states(scene, ["bowed"])
    with pytest.raises(SatcheckError) as caught:
        pose_of_states(scene, ["folded"])
    line = 1 + srdf[: srdf.index(joint)].count("\n")
    assert caught.value.message == f"line {line}: state 'folded': {said}"
    assert caught.value.file == (tmp_path / "arm.srdf").as_posix()


def test_a_mirrored_mesh_is_a_solid_the_right_way_round() -> None:
    bodies = {body.id: body for body in posed(load_scene(ARM), {"grip": (0.125,)}).bodies}
    left, right = (bodies[name].world_mesh() for name in ("left", "right"))
    assert left.topology().volume == right.topology().volume == 1 / 16 / 32 / 4
    low, high = left.bounds
    assert right.bounds == ((low[0], -high[1], low[2]), (high[0], -low[1], high[2]))


def test_an_srdf_belongs_to_the_robot_of_its_name_or_to_the_only_one(tmp_path: Path) -> None:
    other = '<robot name="other"><disable_collisions link1="a" link2="x" reason="Never"/></robot>'
    scene = load(tmp_path, link("a"), srdf=other)
    assert codes(scene) == ["other-robot", "unknown-body"]
    srdf = tmp_path / "r.srdf"
    with pytest.raises(Refused, match="about robot 'other', which is not given"):
        load_scene([ARM[0], tmp_path / "r.urdf", srdf])
    with pytest.raises(Refused, match="no URDF is given"):
        load_scene([srdf])
    with pytest.raises(Refused, match="a second SRDF about robot 'arm'"):
        load_scene([*ARM, ARM[1]])


def test_two_robots_have_ids_of_their_own() -> None:
    scene = load_scene([*ARM, ARM[0]])
    assert len(set(scene.order)) == 14
    assert "fore/palm-2" in scene.order


def collision(inside: str) -> str:
    return f"<collision><geometry>{inside}</geometry></collision>"


@pytest.mark.parametrize(
    ("shape", "said"),
    [
        ('<mesh filename="package://gone/{}.stl"/>', "(package://gone/0.stl): package 'gone' is"),
        ('<mesh filename="meshes/{}.stl"/>', "(meshes/0.stl): there is no folder"),
        ('<mesh filename="{}.stl"/>', "(0.stl): no such file in /"),
        ('<box size="{} -1 1"/>', "in line 2: <box>: size should be positive and finite"),
        ("<torus/>", "in line 2: <torus>: no geometry that is read"),
    ],
)
def test_one_cause_has_one_message(tmp_path: Path, shape: str, said: str) -> None:
    links = [link(f"l{k}", collision(shape.format(k))) for k in range(5)]
    joints = [joint(f"j{k}", "l0", f"l{k}") for k in range(1, 5)]
    scene = load(tmp_path, *links, *joints)
    assert len(scene.unreadable) == 5
    (found,) = [issue for issue in scene.issues if issue.severity == "error"]
    assert found.body is None
    assert found.file is not None
    assert "5 bodies, the first in line 2" in found.message
    assert said in found.message


def test_a_broken_mesh_of_many_bodies_is_told_once(tmp_path: Path) -> None:
    (tmp_path / "wheel.obj").write_text("v 0 0 0\n")
    mesh = collision('<mesh filename="wheel.obj"/>')
    joints = [joint(f"j{k}", "l0", f"l{k}") for k in range(1, 4)]
    scene = load(tmp_path, *(link(f"l{k}", mesh) for k in range(4)), *joints)
    assert len(scene.unreadable) == 4
    (found,) = [issue for issue in scene.issues if issue.severity == "error"]
    assert "wheel.obj" in found.message


def test_without_limits_a_joint_that_slides_stays_and_one_that_turns_is_sampled(
    tmp_path: Path,
) -> None:
    joints = [joint("j", "a", "b", "prismatic"), joint("k", "b", "c", "revolute")]
    scene = load(tmp_path, *map(link, "abc"), *joints)
    poses = list(RandomPoses([robot.robot for robot in scene.robots], 20, seed=1))
    assert {pose["j"] for pose in poses} == {(0.0,)}
    turns = [pose["k"][0] for pose in poses]
    assert min(turns) < -1.0
    assert max(turns) > 1.0
    assert all(-math.pi <= turn <= math.pi for turn in turns)


def test_a_state_of_a_file_without_lines_does_not_suit_two_robots(tmp_path: Path) -> None:
    """Keyframes of MJCF have no lines."""
    paths = [tmp_path / "a.urdf", tmp_path / "b.urdf"]
    for path in paths:
        path.write_text(robot_of(link("a"), link("b"), joint("j", "a", "b", "continuous")))
    scene = load_scene(paths)
    first, second = scene.robots
    key = State("", "key", {"j": (1.0,)}, "m.xml", {})
    first = replace(first, robot=replace(first.robot, states=(key,)))
    with pytest.raises(SatcheckError, match="state 'key': joint 'j': robots r and r have it"):
        pose_of_states(replace(scene, robots=(first, second)), ["key"])
