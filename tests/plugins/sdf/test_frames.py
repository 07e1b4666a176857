"""Where the frames of SDFormat put links."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from tests.plugins.sdf.files import (
    joint,
    link,
    model,
    origins,
    poses,
    read,
    refusal,
    sdf,
    world,
)

HALF_PI = "1.5707963267948966"


def test_poses_are_relative_to_the_model_and_the_world(tmp_path: Path) -> None:
    inner = model("in", "<pose>0 1 0 0 0 0</pose>", link("c", "0 0 1 0 0 0"))
    outer = model("m", "<pose>1 0 0 0 0 0</pose>", link("a"), link("b", "2 0 0 0 0 0"), inner)
    robot, _ = read(tmp_path, world(outer))
    assert origins(robot) == {"m::a": (1, 0, 0), "m::b": (3, 0, 0), "m::in::c": (1, 1, 1)}


def test_a_pose_names_another_frame_even_one_declared_later(tmp_path: Path) -> None:
    text = model(
        "m",
        '<link name="a"><pose relative_to="f">1 0 0 0 0 0</pose></link>',
        f'<frame name="f" attached_to="b"><pose>0 0 0 0 0 {HALF_PI}</pose></frame>',
        link("b", "0 0 5 0 0 0"),
        '<link name="c"><pose relative_to="n::d">0 0 1 0 0 0</pose></link>',
        model("n", link("d", "7 0 0 0 0 0")),
        '<link name="e"><pose relative_to="__model__">9 0 0 0 0 0</pose></link>',
    )
    robot, _ = read(tmp_path, sdf(text))
    found = origins(robot)
    assert (found["m::a"], found["m::c"], found["m::e"]) == ((0, 1, 5), (7, 0, 1), (9, 0, 0))


def test_a_pose_relative_to_a_joint(tmp_path: Path) -> None:
    text = model(
        "m",
        link("a"),
        link("b", "0 2 0 0 0 0"),
        joint("j", "a", "b", inside="<pose>0 0 3 0 0 0</pose>"),
        '<link name="c"><pose relative_to="j">4 0 0 0 0 0</pose></link>',
    )
    assert origins(read(tmp_path, sdf(text))[0])["m::c"] == (4, 2, 3)


def test_the_placement_frame_stands_at_the_pose_of_the_model(tmp_path: Path) -> None:
    text = model(
        "m",
        f"<pose>10 0 0 0 0 {HALF_PI}</pose>",
        link("a"),
        link("tip", "2 0 1 0 0 0"),
        attributes='placement_frame="tip"',
    )
    assert origins(read(tmp_path, sdf(text))[0]) == {"m::a": (10, -2, -1), "m::tip": (10, 0, 0)}


@pytest.mark.parametrize(
    ("pose", "x_axis"),
    [
        ("<pose>0 0 0 0 0 0.5</pose>", (math.cos(0.5), math.sin(0.5), 0.0)),
        ('<pose degrees="true">0 0 0 0 0 90</pose>', (0.0, 1.0, 0.0)),
        ('<pose rotation_format="quat_xyzw">0 0 0 0 0 1 1</pose>', (0.0, 1.0, 0.0)),
        ("<pose/>", (1.0, 0.0, 0.0)),
    ],
)
def test_the_forms_of_a_rotation(
    tmp_path: Path, pose: str, x_axis: tuple[float, float, float]
) -> None:
    robot, _ = read(tmp_path, sdf(model("m", f'<link name="a">{pose}</link>')))
    assert poses(robot)["m::a"][0:9:4] == x_axis


@pytest.mark.parametrize(
    ("pose", "code", "words"),
    [
        ("<pose>0 0 0</pose>", "bad-robot", "should be 6 numbers"),
        ("<pose>0 0 0 0 0 x</pose>", "bad-robot", "not a finite number"),
        ("<pose>${x} 0 0 0 0 0</pose>", "xacro", "expand"),
        ('<pose relative_to="aa">0 0 0 0 0 0</pose>', "index-out-of-range", "did you mean 'a'"),
        ('<pose relativ_to="a">0 0 0 0 0 0</pose>', "misspelt", "did you mean relative_to?"),
        ('<pose relative_to="b">0 0 0 0 0 0</pose>', "reference-cycle", "'m::b' -> 'm::b'"),
        ('<pose rotation_format="quat_xyzw">0 0 0 0 0 0 0</pose>', "bad-robot", "length 0"),
        ('<pose rotation_format="matrix">0 0 0 0 0 0</pose>', "bad-robot", "rotation_format"),
        ('<pose degrees="yes">0 0 0 0 0 0</pose>', "bad-robot", "true or false"),
        ("<pose>0 0 0 0 0 0</pose><pose>1 0 0 0 0 0</pose>", "bad-robot", "a second <pose>"),
    ],
)
def test_a_wrong_pose_refuses_the_file(tmp_path: Path, pose: str, code: str, words: str) -> None:
    text = sdf(model("m", link("a"), f'<link name="b">{pose}</link>'))
    found, message = refusal(tmp_path, text)
    assert found == code
    assert message.startswith("line 4: ")
    assert words in message


def test_a_name_twice_is_refused(tmp_path: Path) -> None:
    code, message = refusal(tmp_path, sdf(model("m", link("a"), link("a"))))
    assert (code, message) == (
        "duplicate-id",
        "line 4: <link>: a second 'm::a', the first is in line 3",
    )


def test_the_frame_attribute_of_early_versions(tmp_path: Path) -> None:
    text = '<link name="b"><pose frame="a">1 0 0 0 0 0</pose></link>'
    robot, _ = read(tmp_path, sdf(model("m", link("a", "0 1 0 0 0 0"), text), version="1.6"))
    assert origins(robot)["m::b"] == (1, 1, 0)


def test_a_frame_with_the_name_of_a_model(tmp_path: Path) -> None:
    frame = '<frame name="m"><pose>0 0 9 0 0 0</pose></frame>'
    text = '<pose relative_to="m_frame">1 0 0 0 0 0</pose>'
    robot, _ = read(tmp_path, world(frame, model("m", link("a")), model("n", text, link("a"))))
    assert origins(robot) == {"m::a": (0, 0, 0), "n::a": (1, 0, 9)}
