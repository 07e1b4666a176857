"""Joints that make no tree of the links, and mimics that follow nothing."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.scene.robot.robots import joint, link, read, refusal, robot_of

LINKS = [link(name) for name in "abc"]


def mimic(leader: str, offset: float = 0.0) -> str:
    return f'<mimic joint="{leader}" offset="{offset}"/>'


@pytest.mark.parametrize(
    ("joints", "code", "said"),
    [
        ([joint("j", "x", "a")], "index-out-of-range", "joint 'j' names link 'x'"),
        ([joint("j", "a", "x")], "index-out-of-range", "joint 'j' names link 'x'"),
        (
            [joint("j", "a", "c"), joint("k", "b", "c")],
            "bad-robot",
            "link 'c' has two parents: joints 'j' and 'k'",
        ),
        ([joint("j", "a", "b")], "bad-robot", "2 links are the child of no joint"),
        (
            [joint("j", "a", "b"), joint("k", "b", "c"), joint("l", "c", "a")],
            "reference-cycle",
            "'a' -> 'b' -> 'c' -> 'a'",
        ),
        (
            [joint("j", "b", "c"), joint("k", "c", "b")],
            "reference-cycle",
            "'b' -> 'c' -> 'b'",
        ),
        ([joint("j", "a", "a"), joint("k", "a", "b"), joint("l", "b", "c")], "reference-cycle", ""),
    ],
)
def test_joints_that_make_no_tree(tmp_path: Path, joints: list[str], code: str, said: str) -> None:
    found, message = refusal(tmp_path, robot_of(*LINKS, *joints))
    assert found == code
    assert said in message


def test_joints_come_after_those_that_carry_them(tmp_path: Path) -> None:
    robot = read(tmp_path, robot_of(*LINKS, joint("k", "b", "c"), joint("j", "a", "b")))
    assert list(robot.roots) == ["a"]
    assert [one.name for one in robot.joints] == ["j", "k"]


@pytest.mark.parametrize(
    ("first", "second", "code", "said"),
    [
        (
            ("continuous", mimic("x", 1)),
            ("continuous", ""),
            "index-out-of-range",
            "mimics joint 'x'",
        ),
        (("continuous", mimic("j")), ("continuous", ""), "reference-cycle", "mimics itself"),
        (
            ("continuous", mimic("k")),
            ("continuous", mimic("j")),
            "reference-cycle",
            "mimics itself",
        ),
        (("continuous", mimic("k")), ("floating", ""), "bad-robot", "'k', a floating joint"),
        (("continuous", mimic("k")), ("planar", ""), "bad-robot", "'k', a planar joint"),
    ],
)
def test_mimics(
    tmp_path: Path, first: tuple[str, str], second: tuple[str, str], code: str, said: str
) -> None:
    joints = [joint("j", "a", "b", *first), joint("k", "b", "c", *second)]
    found, message = refusal(tmp_path, robot_of(*LINKS, *joints))
    assert found == code
    assert said in message
