"""Values of joints: as they are written, as a robot takes them, and what is said about them."""

from __future__ import annotations

from pathlib import Path

import pytest

from satcheck.core.errors import SatcheckError
from satcheck.scene.robot import Pose, Posture, Robot, read_poses, settle
from satcheck.scene.robot.model import State
from satcheck.scene.robot.postures import state_named
from tests.scene.robot.robots import SAMPLES, joint, link, read, read_robot, robot_of

ARM, _ = read_robot(SAMPLES / "arm.urdf", "arm.urdf")
MIMIC = '<mimic joint="j" multiplier="-2" offset="0.5"/>'


def codes(posture: Posture) -> list[str]:
    return [issue.code for issue in posture.issues]


def chain(folder: Path, *joints: tuple[str, str]) -> Robot:
    """Links a, b, c ... and joints j, k, l ... between them: (kind, what is inside)."""
    elements = [link(name) for name in "abcde"[: len(joints) + 1]]
    for name, parent, child, (kind, inside) in zip("jklm", "abcd", "bcde", joints, strict=False):
        elements.append(joint(name, parent, child, kind, inside))
    return read(folder, robot_of(*elements))


def test_the_sample_file() -> None:
    poses = read_poses(str(SAMPLES / "arm_poses.json"))
    assert isinstance(poses, list)
    assert poses[0] == {"shoulder": (0.5,), "elbow": (1.0,), "grip": (0.125,)}


def test_one_pose_is_no_list_and_text_needs_no_file(tmp_path: Path) -> None:
    assert read_poses('{"a": 1}') == {"a": (1.0,)}
    assert read_poses(' [{"a": [1, 2, 3]}]') == [{"a": (1.0, 2.0, 3.0)}]
    (tmp_path / "q.json").write_bytes(b'\xef\xbb\xbf{"a": -0.5}')
    assert read_poses(str(tmp_path / "q.json")) == {"a": (-0.5,)}


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("{", "line 1: not well-formed JSON"),
        ("[]", "should be an object"),
        ("[3]", "pose 1 should be an object"),
        ('{"a": "1"}', "joint 'a' should be a number"),
        ('{"a": true}', "joint 'a' should be a number"),
        ('{"a": []}', "joint 'a' should be a number"),
        ('{"a": null}', "joint 'a' should be a number"),
        ('{"a": NaN}', "joint 'a' is not finite"),
        ('[{"a": 0}, {"b": 1e999}]', "pose 2: joint 'b' is not finite"),
        ('{"a": 1, "a": 2}', "named twice"),
        ("[" * 100_000, "recursion"),
        (f'{{"a": {"9" * 5000}}}', "a number of more than 4300 digits"),
    ],
)
def test_what_is_no_pose(tmp_path: Path, text: str, said: str) -> None:
    path = tmp_path / "q.json"
    path.write_text(text)
    for given, culprit in ((text, None), (str(path), str(path))):
        with pytest.raises(SatcheckError) as caught:
            read_poses(given)
        assert caught.value.code == "bad-pose"
        assert caught.value.file == culprit
        assert said in caught.value.message


@pytest.mark.parametrize(
    ("name", "code"), [("gone.json", "file-not-found"), ("", "not-a-file"), ("x", "bad-encoding")]
)
def test_what_is_no_file(tmp_path: Path, name: str, code: str) -> None:
    (tmp_path / "x").write_bytes(b"\xff\xff")
    with pytest.raises(SatcheckError) as caught:
        read_poses(str(tmp_path / name))
    assert caught.value.code == code
    assert ("--state takes names of states" in str(caught.value)) == (code == "file-not-found")


def test_joints_that_are_not_named_stand_at_0() -> None:
    posture = settle([ARM], {"elbow": (1.0,)})
    assert posture.pose() == {"turn": 0.0, "shoulder": 0.0, "elbow": 1.0, "grip": 0.0}
    assert posture.joints["grip_right"] == (0.0,)
    assert not posture.issues


@pytest.mark.parametrize(("limits", "stands"), [((0.5, 2.0), 0.5), ((-3.0, -1.0), -1.0)])
def test_or_at_the_nearer_limit(tmp_path: Path, limits: tuple[float, float], stands: float) -> None:
    limit = f'<limit lower="{limits[0]}" upper="{limits[1]}"/>'
    posture = settle([chain(tmp_path, ("revolute", limit))], {})
    assert posture.joints == {"j": (stands,)}
    assert codes(posture) == ["not-at-zero"]


@pytest.mark.parametrize(("value", "by"), [(3.5, "0.5"), (-3.25, "0.25")])
def test_beyond_limits_is_a_warning_and_says_how_far(value: float, by: str) -> None:
    posture = settle([ARM], {"elbow": (value,)})
    assert posture.joints["elbow"] == (value,)
    (issue,) = posture.issues
    assert (issue.code, issue.severity) == ("beyond-limits", "warning")
    assert f"-3 .. 3 by {by}:" in issue.message


def test_a_limit_itself_is_within() -> None:
    assert not settle([ARM], {"elbow": (3.0,), "shoulder": (-2.25,)}).issues


def test_mimics_follow_along_a_chain_and_are_held_against_their_limits(tmp_path: Path) -> None:
    again = '<mimic joint="k" multiplier="3"/>'
    limited = f'<limit lower="-1" upper="1"/>{again}'
    robot = chain(tmp_path, ("continuous", ""), ("continuous", MIMIC), ("revolute", limited))
    posture = settle([robot], {"j": (1.0,)})
    assert posture.joints == {"j": (1.0,), "k": (-1.5,), "l": (-4.5,)}
    assert posture.pose() == {"j": 1.0}
    assert codes(posture) == ["beyond-limits"]


def test_a_mimic_of_a_fixed_joint_stands_at_its_offset(tmp_path: Path) -> None:
    robot = chain(tmp_path, ("fixed", ""), ("continuous", MIMIC))
    assert settle([robot], {}).joints == {"k": (0.5,)}


def test_a_pose_may_name_a_mimic_and_is_told_when_it_contradicts() -> None:
    assert not settle([ARM], {"grip": (0.1,), "grip_right": (-0.1,)}).issues
    posture = settle([ARM], {"grip": (0.1,), "grip_right": (0.0,)})
    assert posture.joints["grip_right"] == (-0.1,)
    assert codes(posture) == ["mimic-differs"]


@pytest.mark.parametrize(
    ("pose", "said"),
    [
        ({"elbo": (0.0,)}, "unknown joint 'elbo' (did you mean 'elbow'?)"),
        ({"camera_mount": (0.0,)}, "'camera_mount' does not move"),
        ({"elbow": (0.0, 1.0)}, "(revolute) takes 1 number, not 2"),
    ],
)
def test_what_a_robot_does_not_take(pose: Pose, said: str) -> None:
    with pytest.raises(SatcheckError) as caught:
        settle([ARM], pose)
    assert caught.value.code == "bad-pose"
    assert said in caught.value.message


def test_planar_and_floating_joints_take_three_and_six_numbers(tmp_path: Path) -> None:
    robot = chain(tmp_path, ("planar", ""), ("floating", ""))
    assert settle([robot], {}).joints == {"j": (0.0,) * 3, "k": (0.0,) * 6}
    with pytest.raises(SatcheckError, match="takes 6 numbers, not 3"):
        settle([robot], {"k": (1.0, 2.0, 3.0)})


def test_a_name_that_two_robots_have_poses_neither(tmp_path: Path) -> None:
    other = chain(tmp_path, ("continuous", ""))
    assert len(settle([ARM, other], {"j": (1.0,)}).joints) == 6
    with pytest.raises(SatcheckError, match="robots r and r have it"):
        settle([other, other], {"j": (1.0,)})


def test_states_by_name_and_by_group() -> None:
    names = (("g", "home"), ("h", "home"), ("g", "far"))
    states = [State(group, name, {}, "r.srdf", {}) for group, name in names]
    assert state_named("far", states) is states[2]
    assert state_named("h/home", states) is states[1]
    with pytest.raises(SatcheckError, match="several groups have a state 'home': g/home, h/home"):
        state_named("home", states)
    with pytest.raises(SatcheckError, match="the states are home, far"):
        state_named("x", states)
    with pytest.raises(SatcheckError, match="no SRDF"):
        state_named("x", [])
