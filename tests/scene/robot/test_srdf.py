"""Which links an SRDF lets touch, and the states that it names."""

from __future__ import annotations

from pathlib import Path

import pytest

from satcheck.scene import SceneFileError
from satcheck.scene.robot.srdf import Srdf, read_srdf
from tests.scene.robot.robots import SAMPLES


def read(folder: Path, *elements: str) -> Srdf:
    path = folder / "r.srdf"
    path.write_text("\n".join(['<robot name="r">', *elements, "</robot>"]))
    return read_srdf("r.srdf", path)


def test_the_sample() -> None:
    srdf = read_srdf("arm.srdf", SAMPLES / "arm.srdf")
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
        '<enable_collisions link1="c" link2="b"/>',
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
    with pytest.raises(SceneFileError) as caught:
        read(tmp_path, element)
    assert str(caught.value).startswith("r.srdf: line 2: <")
    assert said in caught.value.message
