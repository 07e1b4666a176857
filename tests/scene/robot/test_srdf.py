"""Which links an SRDF lets touch, and the states that it names."""

from __future__ import annotations

from contextlib import chdir
from pathlib import Path

import pytest

from satcheck.scene import Refused, load_scene
from satcheck.scene.robot.srdf import Srdf, read_srdf
from tests.scene.robot.robots import SAMPLES, joint, link, robot_of


def read(folder: Path, *elements: str) -> Srdf:
    path = folder / "r.srdf"
    path.write_text("\n".join(['<robot name="r">', *elements, "</robot>"]))
    with chdir(folder):
        return read_srdf(path.name)


def test_the_sample() -> None:
    srdf = read_srdf(str(SAMPLES / "arm.srdf"))
    assert srdf.robot == "arm"
    assert srdf.permission("turret", "base") == "SRDF: Adjacent"
    assert srdf.permission("base", "fore") is None
    assert [state.name for state in srdf.states] == ["up", "bowed", "folded", "open"]
    assert srdf.states[1].joints == {"shoulder": (1.5,), "elbow": (1.25,)}


def test_pairs_without_a_reason_and_links_that_are_silent_by_default(tmp_path: Path) -> None:
    srdf = read(
        tmp_path,
        '<disable_collisions link1="a" link2="b"/>',
        '<disable_default_collisions link="c"/>',
        '<enable_collisions link1="c" link2="a"/>',
        '<disable_collisions link1="b" link2="c" reason="Never"/>',
    )
    assert srdf.permission("b", "a") == "SRDF"
    assert srdf.permission("c", "d") == "SRDF: disabled by default"
    assert srdf.permission("c", "a") is None
    assert srdf.permission("c", "b") == "SRDF: Never"
    assert srdf.links() == {"a", "b", "c"}


@pytest.mark.parametrize(
    ("element", "said"),
    [
        ("<disable_colisions/>", "unknown disable_colisions (did you mean disable_collisions?)"),
        ("<enable_collsions/>", "unknown enable_collsions (did you mean enable_collisions?)"),
        ('<group_state name="s"><jont/></group_state>', "<group_state>: unknown jont"),
        ('<disable_collisions link1="a" lnk2="b"/>', "unknown lnk2 (did you mean link2?)"),
        (
            '<enable_collisions link1="a" link2="b"/><disable_collisions link1="b" link2="a"/>',
            "<enable_collisions>: the pair is disabled as well",
        ),
        ('<enable_collisions link1="a" link2="a"/>', "<enable_collisions>: one link twice"),
        ('<disable_collisions link1="a"/>', 'attribute "link2" is missing'),
        ("<disable_default_collisions/>", 'attribute "link" is missing'),
        ('<group_state group="g"/>', 'attribute "name" is missing'),
        ('<group_state name="s"><joint name="j"/></group_state>', 'attribute "value" is missing'),
        (
            '<group_state name="s"><joint name="j" value="nan"/></group_state>',
            'value="nan" is not a finite number',
        ),
        (
            '<group_state name="s"><joint name="j" value="1"/><joint name="j" value="2"/>'
            "</group_state>",
            "a second value of joint 'j'",
        ),
    ],
)
def test_what_is_wrong_is_refused_with_its_line(tmp_path: Path, element: str, said: str) -> None:
    with pytest.raises(Refused) as caught:
        read(tmp_path, element)
    assert str(caught.value).startswith(("r.srdf: line 2: <", "r.srdf: line 2: attribute of <"))
    assert said in caught.value.message


@pytest.mark.parametrize(
    ("element", "said"),
    [
        ("<foo/>", "<robot>: foo is not read"),
        ('<link_sphere_approximation link="b"/>', "link_sphere_approximation is not read"),
        ('<disable_collisions link1="a" link2="b" when="x"/>', "<disable_collisions>: when is"),
        ('<group_state name="s"><mimic/></group_state>', "<group_state>: mimic is not read"),
        ('<group name="g"><enable_collisions/></group>', "<group>: enable_collisions is not read"),
        ('<group name="g"><group_state name="s"/></group>', "<group>: group_state is not read"),
        ("<end_effector><enable_collisions/></end_effector>", "enable_collisions is not read"),
        ("<virtual_joint><origin/></virtual_joint>", "<virtual_joint>: origin is not read"),
    ],
)
def test_what_may_enable_a_pair_or_hold_a_body_blocks_a_pass(
    tmp_path: Path, element: str, said: str
) -> None:
    (found,) = read(tmp_path, element).issues
    assert found.code == "unread"
    assert said in found.message


def test_what_plans_is_no_issue(tmp_path: Path) -> None:
    plans = [
        '<group name="g"><chain base_link="a" tip_link="b"/><passive_joint name="j"/></group>',
        '<end_effector name="e" parent_link="a" group="g"/>',
        '<virtual_joint name="v" type="fixed" parent_frame="w" child_link="a"/>',
        '<passive_joint name="j"/>',
    ]
    assert read(tmp_path, *plans).issues == ()


def test_a_pair_that_is_enabled_for_a_link_that_is_missing_blocks_a_pass(tmp_path: Path) -> None:
    robot = [link(name) for name in "abc"] + [joint("j", "a", "b"), joint("k", "a", "c")]
    (tmp_path / "r.urdf").write_text(robot_of(*robot))
    (tmp_path / "r.srdf").write_text(
        robot_of(
            '<disable_default_collisions link="b"/>', '<enable_collisions link1="b" link2="cc"/>'
        )
    )
    issues = load_scene([tmp_path / "r.urdf", tmp_path / "r.srdf"]).issues
    (found,) = [issue for issue in issues if issue.code == "unread"]
    assert "enable_collisions names link 'cc'" in found.message
