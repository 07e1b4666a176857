"""What an input is: by its ending, else by the root of its XML."""

from __future__ import annotations

from pathlib import Path

import pytest

from satcheck.scene import load_scene
from satcheck.scene.files.readers import kind_of
from tests.plugin_marks import needs
from tests.scene.robot.robots import link, robot_of

ROBOT = robot_of(link("a"), link("b", ""), '<joint name="j" type="fixed">').replace(
    "</robot>", '<parent link="a"/><child link="b"/></joint></robot>'
)
SRDF = '<robot name="r"><disable_collisions link1="a" link2="b"/></robot>'
COMMENTS = "<!-- " + "made by a tool " * 400 + "-->\n"


@pytest.mark.parametrize(
    ("name", "content", "kind"),
    [
        ("r.urdf", "", "robot"),
        ("r.URDF", "", "robot"),
        ("r.srdf", "", "srdf"),
        pytest.param("w.sdf", "", "robot", marks=needs("sdf")),
        pytest.param("w.WORLD", "", "robot", marks=needs("sdf")),
        pytest.param("w.xml", '<sdf version="1.9"/>', "robot", marks=needs("sdf")),
        ("r.toml", "", "scene"),
        ("r.json", "", "scene"),
        ("r.stl", ROBOT, "mesh"),
        ("r.xml", ROBOT, "robot"),
        ("r.urdf.xml", f"\n<?xml version='1.0'?>\n{COMMENTS}{ROBOT}", "robot"),
        ("robot_description", ROBOT, "robot"),
        ("r.txt", f"\ufeff{ROBOT}", "robot"),
        ("r.xml", SRDF, "srdf"),
        ("r.srdf.xacro", SRDF, "srdf"),
        ("r.xacro", ROBOT, "robot"),
        ("r.urdf.xacro", "<xacro:arm/>", "robot"),
        pytest.param("r.xml", "<mujoco/>", "robot", marks=needs("mjcf")),
        ("r.xml", "<mujocoinclude/>", "mesh"),
        ("r.xml", "<robot", "mesh"),
        ("r", "a robot", "mesh"),
        ("r", "", "mesh"),
    ],
)
def test_kinds(tmp_path: Path, name: str, content: str, kind: str) -> None:
    (tmp_path / name).write_text(content, encoding="utf-8")
    assert kind_of(str(tmp_path / name)) == kind


def test_what_is_not_there_and_what_is_no_file_is_for_the_reader_to_refuse(tmp_path: Path) -> None:
    assert kind_of(str(tmp_path / "gone.xml")) == "mesh"
    assert kind_of(str(tmp_path)) == "mesh"


@pytest.mark.parametrize("name", ["r.xml", "r", "r.urdf.xml", "r.xacro"])
def test_a_robot_is_one_whatever_its_ending(tmp_path: Path, name: str) -> None:
    (tmp_path / name).write_text(ROBOT, encoding="utf-8")
    (tmp_path / "allowed.xml").write_text(SRDF, encoding="utf-8")
    scene = load_scene([tmp_path / name, tmp_path / "allowed.xml"])
    assert [body.id for body in scene.bodies] == ["a"]
    assert scene.robots[0].srdf is not None
