"""How the joints of SDFormat move links."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from tests.plugins.sdf.files import axis, joint, link, model, origins, read, refusal, sdf

A, B = link("a"), link("b", "1 0 0 0 0 0")
QUARTER = math.pi / 2


@pytest.mark.parametrize(
    ("kind", "inside", "value", "place"),
    [
        ("prismatic", axis("0 0 2"), 3.0, (1, 0, 3)),
        ("revolute", axis() + "<pose>-1 0 0 0 0 0</pose>", QUARTER, (0, 1, 0)),
        ("continuous", axis() + '<pose relative_to="a"/>', QUARTER, (0, 1, 0)),
        ("revolute", axis("0 0 -1") + '<pose relative_to="a">0 0 0 0 0 0</pose>', QUARTER, None),
    ],
)
def test_a_joint_moves_its_child(
    tmp_path: Path, kind: str, inside: str, value: float, place: tuple[float, ...] | None
) -> None:
    robot, issues = read(tmp_path, sdf(model("m", A, B, joint("j", "a", "b", kind, inside))))
    found = origins(robot, {"m::j": value})
    assert issues == ()
    assert found == {"m::a": (0, 0, 0), "m::b": place or (0, -1, 0)}


def test_a_link_at_rest_stands_exactly_where_the_file_says(tmp_path: Path) -> None:
    turned = link("b", "0.1 0.2 0.3 0.4 0.5 0.6")
    moving = joint("j", "a", "b", "revolute", axis("1 2 3"))
    alone, _ = read(tmp_path, sdf(model("m", link("a", "0.7 0 0 1 0 0"), turned)))
    joined, _ = read(tmp_path, sdf(model("m", link("a", "0.7 0 0 1 0 0"), turned, moving)))
    assert alone.roots["m::b"] == joined.links["m::b"].rest
    assert origins(joined) == origins(joined, {"m::j": 0.0}) == origins(alone)


def test_what_moves_is_on_the_far_side_of_the_canonical_link(tmp_path: Path) -> None:
    slide = joint("j", "b", "a", "prismatic", axis("1 0 0"))
    first_a, _ = read(tmp_path, sdf(model("m", A, B, slide)))
    assert origins(first_a, {"m::j": 2.0}) == {"m::a": (0, 0, 0), "m::b": (-1, 0, 0)}
    named_b, _ = read(tmp_path, sdf(model("m", A, B, slide, attributes='canonical_link="b"')))
    assert origins(named_b, {"m::j": 2.0}) == {"m::a": (2, 0, 0), "m::b": (1, 0, 0)}


def test_a_joint_with_the_world(tmp_path: Path) -> None:
    rail = joint("j", "world", "b", "prismatic", axis("1 0 0"))
    robot, _ = read(tmp_path, sdf(model("m", A, B, rail, joint("k", "b", "a"))))
    assert origins(robot, {"m::j": 2.0}) == {"m::a": (2, 0, 0), "m::b": (3, 0, 0)}


@pytest.mark.parametrize(
    ("inside", "version", "place"),
    [
        ('<axis><xyz expressed_in="__model__">1 0 0</xyz></axis>', "1.9", (1, 2, 0)),
        (axis("1 0 0", "<use_parent_model_frame>true</use_parent_model_frame>"), "1.6", (1, 2, 0)),
        (axis("1 0 0"), "1.4", (1, 2, 0)),
        (axis("1 0 0"), "1.6", (0, 3, 0)),
    ],
)
def test_the_frame_of_the_axis(
    tmp_path: Path, inside: str, version: str, place: tuple[float, ...]
) -> None:
    turned = link("b", f"0 2 0 0 0 {QUARTER!r}")
    text = model("m", A, turned, joint("j", "a", "b", "prismatic", inside))
    robot, _ = read(tmp_path, sdf(text, version=version))
    assert origins(robot, {"m::j": 1.0})["m::b"] == place


def test_joints_of_a_loop_are_not_moved(tmp_path: Path) -> None:
    pairs = [("a", "b"), ("b", "c"), ("a", "c"), ("c", "d")]
    joints = [joint(f"{p}{c}", p, c, "prismatic", axis("1 0 0")) for p, c in pairs]
    robot, issues = read(tmp_path, sdf(model("m", *map(link, "abcd"), *joints)))
    assert [joint.name for joint in robot.joints if joint.freedoms] == ["m::cd"]
    (warning,) = issues
    assert warning.code == "joint-not-moved"
    assert {"m::ab", "m::bc", "m::ac"} <= set(warning.message.replace(",", "").split())


@pytest.mark.parametrize("kind", ["ball", "universal", "revolute2", "screw", "gearbox"])
def test_other_joints_are_not_moved(tmp_path: Path, kind: str) -> None:
    text = sdf(model("m", A, B, joint("j", "a", "b", kind, axis())))
    robot, (warning,) = read(tmp_path, text)
    assert [joint.kind for joint in robot.joints] == ["fixed"]
    assert warning.message == (
        f"line 5: a {kind} joint is not moved: its links stay as the file places them"
    )


def test_nothing_moves_a_static_model(tmp_path: Path) -> None:
    slide = joint("j", "a", "b", "prismatic", axis())
    robot, issues = read(tmp_path, sdf(model("m", "<static>true</static>", A, B, slide)))
    assert issues == ()
    assert all(link.static for link in robot.links.values())
    assert not any(joint.freedoms for joint in robot.joints)


def test_limits(tmp_path: Path) -> None:
    def limits(lower: str, upper: str) -> tuple[object, list[str]]:
        limit = f"<limit><lower>{lower}</lower><upper>{upper}</upper></limit>"
        slide = joint("j", "a", "b", "prismatic", axis("0 0 1", limit))
        robot, issues = read(tmp_path, sdf(model("m", A, B, slide)))
        found = robot.joints[0].limits
        return found and (found.lower, found.upper), [issue.code for issue in issues]

    assert limits("0.5", "2") == ((0.5, 2.0), [])
    assert limits("-1e16", "1e16") == limits("-inf", "inf") == (None, [])
    assert limits("0", "inf") == limits("2", "1") == (None, ["no-limits"])


def test_a_joint_stands_at_zero_though_its_limits_exclude_it(tmp_path: Path) -> None:
    limit = "<limit><lower>1</lower><upper>2</upper></limit>"
    slide = joint("j", "a", "b", "prismatic", axis("0 0 1", limit))
    robot, _ = read(tmp_path, sdf(model("m", A, B, slide)))
    assert origins(robot)["m::b"] == (1, 0, 0)


def test_a_mimic(tmp_path: Path) -> None:
    rule = "<multiplier>2</multiplier><offset>1</offset><reference>0.5</reference>"
    follows = axis("0 0 1", f'<mimic joint="j" axis="axis">{rule}</mimic>')
    text = model(
        "m",
        A,
        B,
        link("c"),
        joint("j", "a", "b", "prismatic", axis()),
        joint("k", "a", "c", "prismatic", follows),
    )
    robot, _ = read(tmp_path, sdf(text))
    assert origins(robot, {"m::j": 3.0}) == {
        "m::a": (0, 0, 0),
        "m::b": (1, 0, 3),
        "m::c": (0, 0, 6),
    }


@pytest.mark.parametrize(
    ("text", "code", "words"),
    [
        (joint("j", "a", "x"), "index-out-of-range", "names 'x'"),
        (joint("j", "a", "b", "hinge"), "bad-robot", "'hinge' is none of"),
        (joint("j", "a", "b", "revolute", axis("0 0 0")), "bad-robot", "an axis of length 0"),
        ('<joint name="j" type="fixed"><parent>a</parent></joint>', "bad-robot", "<child>"),
        (
            joint("j", "a", "b", "revolute", axis("0 0 1", '<mimic joint="j"/>')),
            "reference-cycle",
            "mimics itself",
        ),
    ],
)
def test_a_wrong_joint_refuses_the_file(tmp_path: Path, text: str, code: str, words: str) -> None:
    found, message = refusal(tmp_path, sdf(model("m", A, B, text)))
    assert found == code
    assert message.startswith("line 5: ")
    assert words in message


def test_a_joint_with_the_name_of_a_link(tmp_path: Path) -> None:
    robot, _ = read(tmp_path, sdf(model("m", joint("b", "a", "b"), A, B), version="1.6"))
    assert [joint.name for joint in robot.joints] == ["m::b_joint"]


def test_a_joint_that_connects_a_link_to_itself_is_ignored(tmp_path: Path) -> None:
    frame = '<frame name="f" attached_to="a"/>'
    robot, (warning,) = read(tmp_path, sdf(model("m", A, frame, joint("j", "a", "f"))))
    assert robot.joints == ()
    assert warning.message == ("line 5: joint 'm::j' connects 'm::a' to itself: it is ignored")


def test_a_joint_with_the_name_world_still_has_the_world_as_its_parent(tmp_path: Path) -> None:
    robot, issues = read(tmp_path, sdf(model("m", A, joint("world", "world", "a"))))
    assert issues == ()
    assert [(joint.parent, joint.child) for joint in robot.joints] == [("", "m::a")]


@pytest.mark.parametrize("tag", ["axis", "axis2"])
@pytest.mark.parametrize(("value", "codes"), [(0.0, []), (0.5, ["unread"])])
def test_a_joint_that_does_not_stand_at_zero_blocks_a_pass(
    tmp_path: Path, tag: str, value: float, codes: list[str]
) -> None:
    start = f"<initial_position>{value}</initial_position>"
    axes = axis("0 0 1", start if tag == "axis" else "")
    axes += axis("1 0 0", start).replace("axis>", "axis2>") if tag == "axis2" else ""
    moving = joint("j", "a", "b", "universal", axes)
    _, issues = read(tmp_path, sdf(model("m", A, B, moving)))
    assert [each.code for each in issues if each.code != "joint-not-moved"] == codes


@pytest.mark.parametrize(("stiffness", "reference", "notes"), [(9, 1, 1), (0, 1, 0), (9, 0, 0)])
def test_a_spring_that_rests_elsewhere_is_named(
    tmp_path: Path, stiffness: int, reference: int, notes: int
) -> None:
    spring = f"<spring_stiffness>{stiffness}</spring_stiffness>"
    spring += f"<spring_reference>{reference}</spring_reference>"
    bent = joint("j", "a", "b", "revolute", axis(inside=f"<dynamics>{spring}</dynamics>"))
    _, issues = read(tmp_path, sdf(model("m", A, B, bent)))
    assert [issue.code for issue in issues] == ["constraint-not-solved"] * notes
