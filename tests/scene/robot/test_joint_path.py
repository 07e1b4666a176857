"""Paths of robots: how files state them, and the values of joints between two poses."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from satcheck.core.errors import SatcheckError
from satcheck.scene import Scene, load_scene
from satcheck.scene.robot import JointPath, Pose, read_path, with_joint_path
from tests.scene.robot.robots import joint, link, robot_of

TURNS = '<axis xyz="0 0 1"/><limit lower="-1" upper="2" effort="1" velocity="1"/>'


def scene(folder: Path, kind: str = "revolute", more: str = "") -> Scene:
    text = robot_of(
        link("root"),
        link("hand"),
        link("tool"),
        joint("turn", "root", "hand", kind, TURNS),
        joint("follow", "hand", "tool", "revolute", f'{TURNS}<mimic joint="turn" multiplier="2"/>')
        if kind == "revolute"
        else joint("follow", "hand", "tool"),
        more,
    )
    (folder / "r.urdf").write_text(text)
    return load_scene([folder / "r.urdf"])


def path_of(scene: Scene, poses: list[Pose], fixed: Pose | None = None) -> JointPath:
    path = with_joint_path(scene, poses, fixed).joint_path
    assert path is not None
    return path


def turns(*values: float) -> list[Pose]:
    return [{"turn": (value,)} for value in values]


def test_joints_move_steadily_and_mimics_follow(tmp_path: Path) -> None:
    path = path_of(scene(tmp_path), turns(0.0, 1.0, 0.5))
    assert path.moving == {"turn", "follow"}
    values = path.at(np.array([0.0, 0.25, 0.5, 0.75, 1.0]))
    assert values["turn"][0].tolist() == [0.0, 0.5, 1.0, 0.75, 0.5]
    assert values["follow"][0].tolist() == [0.0, 1.0, 2.0, 1.5, 1.0]
    assert path.pose(0.25) == {"turn": 0.5}  # a mimic needs no value
    assert [path.poses_around(t) for t in (0.0, 0.4, 0.5, 0.6, 1.0)] == [
        (1, 2),
        (1, 2),
        (1, 2),
        (2, 3),
        (2, 3),
    ]


def test_times_divide_the_path(tmp_path: Path) -> None:
    poses: list[Pose] = [
        {"time": (time,), "turn": (value,)} for time, value in ((10, 0.0), (11, 1.0), (14, 0.0))
    ]
    path = path_of(scene(tmp_path), poses)
    assert path.times.tolist() == [0.0, 0.25, 1.0]
    assert path.at(np.array([0.125]))["turn"][0].tolist() == [0.5]


def test_the_robot_stands_in_the_first_pose_and_limits_are_named(tmp_path: Path) -> None:
    placed = with_joint_path(scene(tmp_path), turns(0.5, 3.0))
    assert placed.posture is not None
    assert placed.posture.joints["turn"] == (0.5,)
    assert [issue.code for issue in placed.issues].count("beyond-limits") == 2  # and the mimic


def test_joints_without_a_value_keep_the_given_one(tmp_path: Path) -> None:
    poses: list[Pose] = [{}, {}]
    path = path_of(scene(tmp_path), poses, {"turn": (0.25,)})
    assert path.moving == frozenset()
    assert path.pose(0.5) == {"turn": 0.25}


@pytest.mark.parametrize(
    ("poses", "message"),
    [
        (turns(1.0), "two poses"),
        ([{"turn": (0.0,)}, {"elbow": (1.0,)}], "unknown joint 'elbow'"),
        ([{"time": (0.0,)}, {"turn": (1.0,)}], "needs a time"),
        ([{"time": (0.0,)}, {"time": (1.0,)}, {"time": (1.0,)}], "pose 3: .* must increase"),
    ],
)
def test_paths_that_no_robot_follows(tmp_path: Path, poses: list[Pose], message: str) -> None:
    with pytest.raises(SatcheckError, match=message):
        with_joint_path(scene(tmp_path), poses)


def test_a_floating_joint_may_stand_but_not_move(tmp_path: Path) -> None:
    robot = scene(tmp_path, "floating")
    still: Pose = {"turn": (1.0, 0.0, 0.0, 0.0, 0.0, 0.0)}
    assert path_of(robot, [still, still]).moving == frozenset()
    with pytest.raises(SatcheckError, match="floating"):
        with_joint_path(robot, [still, {"turn": (2.0, 0.0, 0.0, 0.0, 0.0, 0.0)}])


@pytest.mark.parametrize("separator", [",", ";", "\t", ", "])
@pytest.mark.parametrize("mark", ["", "\ufeff"])
def test_tables(tmp_path: Path, separator: str, mark: str) -> None:
    lines = (("time", "turn"), ("0", "0.5"), ("", ""), ("1", "-1e-3"))
    text = mark + "\r\n".join(separator.join(line) for line in lines)
    (tmp_path / "p.csv").write_text(text, encoding="utf-8", newline="")
    assert read_path(str(tmp_path / "p.csv")) == [
        {"time": (0.0,), "turn": (0.5,)},
        {"time": (1.0,), "turn": (-0.001,)},
    ]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "a line with the names"),
        ("a,b\n", "a line with the names"),
        ("a,a\n1,2\n3,4\n", "line 1"),
        ("\na,\n1,2\n3,4\n", "line 2"),
        ("0,0.5\n1,1\n", "names of joints, and two lines"),
        ("a,b\n1\n2\n", "line 2: 1 values for 2 columns"),
        ("a\n1\nnan\n", "line 3: a: 'nan'"),
        ("a;b\n0,5;1\n0;1\n", "line 2: a: '0,5'"),
    ],
)
def test_tables_that_are_refused(tmp_path: Path, text: str, message: str) -> None:
    (tmp_path / "p.csv").write_text(text)
    with pytest.raises(SatcheckError, match=message):
        read_path(str(tmp_path / "p.csv"))


def test_one_pose_is_no_path() -> None:
    with pytest.raises(SatcheckError, match="list of poses"):
        read_path('{"turn": 1}')
