"""Joints and keyframes of MJCF files, against the kinematics of MuJoCo."""

from __future__ import annotations

import math
from pathlib import Path

import mujoco
import numpy as np
import pytest

from satcheck.core.errors import SatcheckError
from satcheck.scene import load_scene
from satcheck.scene.robot import RandomPoses, pose_of_states, posed
from tests.plugins.mjcf.files import body, centres, codes, geom, load, model

# Two joints on one body, away from its origin, then one with a reference, then a ball.
ARM = model(
    body(
        "upper",
        geom("g", 'pos="1 0 0"'),
        '<joint name="turn" axis="0 0 1" pos=".5 0 0" range="-180 90"/>',
        '<joint name="lift" type="slide" axis="0 1 1" range="0 2"/>',
        body(
            "fore",
            geom("h", 'pos="0 .3 0"'),
            '<joint name="bend" axis="1 0 1" ref="30"/>',
            body(
                "hand", geom("i", 'pos="0 0 .7"'), '<joint name="wrist" type="ball" pos="0 .1 0"/>'
            ),
            pos="2 0 0",
        ),
        pos="0 0 1",
        more='euler="10 20 30"',
    ),
    body("loose", geom("k"), '<freejoint name="fly"/>', pos="5 5 5"),
    after='<keyframe><key name="there" qpos="1 .5 2  .5 .5 .5 .5  7 8 9 0 1 0 0"/></keyframe>',
)


def of_mujoco(path: Path, values: dict[str, tuple[float, ...]]) -> dict[str, np.ndarray]:
    """Body -> the middle of its geom."""
    compiled = mujoco.MjModel.from_xml_path(str(path))
    data = mujoco.MjData(compiled)
    for name, value in values.items():
        data.joint(name).qpos[:] = value
    mujoco.mj_kinematics(compiled, data)
    return {
        compiled.body(compiled.geom_bodyid[k]).name: data.geom_xpos[k]
        for k in range(compiled.ngeom)
    }


@pytest.mark.parametrize(
    "values",
    [
        {},
        {"turn": (0.7,)},
        {"turn": (-1.0,), "lift": (1.5,), "bend": (2.0,)},
        {"wrist": (0.5, -0.5, 0.5, 0.5), "fly": (1.0, 2.0, 3.0, 0.6, 0.0, 0.8, 0.0)},
    ],
)
def test_bodies_move_as_in_mujoco(tmp_path: Path, values: dict[str, tuple[float, ...]]) -> None:
    scene = load(tmp_path, ARM)
    ours, theirs = centres(scene, values), of_mujoco(tmp_path / "m.xml", values)
    assert ours.keys() == theirs.keys()
    for name, middle in ours.items():
        assert middle == pytest.approx(theirs[name].tolist(), abs=1e-8)


def test_joints_stand_at_qpos0(tmp_path: Path) -> None:
    posture = load(tmp_path, ARM).posture
    assert posture is not None
    assert posture.joints["bend"] == (pytest.approx(math.radians(30)),)
    assert posture.joints["wrist"] == (1, 0, 0, 0)
    assert posture.joints["fly"] == (5, 5, 5, 1, 0, 0, 0)


def test_a_keyframe_is_a_state(tmp_path: Path) -> None:
    scene = load(tmp_path, ARM)
    there = posed(scene, pose_of_states(scene, ["there"]))
    assert there.posture is not None
    assert there.posture.joints["fly"] == (7, 8, 9, 0, 1, 0, 0)
    assert there.posture.joints["lift"] == (0.5,)


def test_a_keyframe_with_a_wrong_number_of_values_is_no_state(tmp_path: Path) -> None:
    scene = load(tmp_path, ARM.replace("7 8 9 0 1 0 0", "7 8 9"))
    assert "keyframe-not-read" in codes(scene)
    with pytest.raises(SatcheckError):
        pose_of_states(scene, ["there"])


def test_random_poses_stay_within_limits(tmp_path: Path) -> None:
    scene = load(tmp_path, ARM)
    for pose in list(RandomPoses([robot.robot for robot in scene.robots], 50, seed=1)):
        assert pose.keys() == {"turn", "lift", "bend"}
        assert -math.pi <= pose["turn"][0] <= math.pi / 2
        assert 0 <= pose["lift"][0] <= 2


def test_a_quaternion_of_length_0_is_refused(tmp_path: Path) -> None:
    scene = load(tmp_path, ARM)
    with pytest.raises(SatcheckError, match="quaternion") as caught:
        posed(scene, {"wrist": (0.0, 0.0, 0.0, 0.0)})
    assert caught.value.code == "bad-pose"


def test_mocap_bodies_are_static(tmp_path: Path) -> None:
    text = model(body("m", geom("g"), more='mocap="true"'), body("b", geom("h"), "<freejoint/>"))
    path = tmp_path / "m.xml"
    path.write_text(text)
    assert {each.id: each.static for each in load_scene([path]).bodies} == {"m": True, "b": False}


def test_a_keyframe_that_places_a_mocap_body_is_no_state(tmp_path: Path) -> None:
    mocap = '<body name="hand" mocap="true" pos="1 0 0"><geom size="1"/></body>'
    keys = '<keyframe><key name="same" mpos="1 0 0"/><key name="far" mpos="5 0 0"/></keyframe>'
    text = model(mocap, body("b", geom("g"), '<joint name="j"/>')).replace(
        "</mujoco>", f"{keys}</mujoco>"
    )
    scene = load(tmp_path, text)
    assert [state.name for state in scene.robots[0].states] == ["same"]
    (said,) = (issue for issue in scene.issues if issue.code == "keyframe-not-read")
    assert "far" in said.message


@pytest.mark.parametrize(
    ("stated", "tendon", "notes"),
    [
        ('springref="1" stiffness="9"', "", 1),
        ('springref="1"', "", 0),
        ('springref="1" ref="1" stiffness="9"', "", 0),
        ("", 'springlength="1" stiffness="9"', 1),
        ("", 'springlength="0" stiffness="9"', 0),
        ("", 'stiffness="9"', 0),
    ],
)
def test_springs_that_rest_elsewhere_are_named(
    tmp_path: Path, stated: str, tendon: str, notes: int
) -> None:
    slide = f'<joint name="j" type="slide" axis="1 0 0" {stated}/>'
    pulled = f'<tendon><fixed {tendon}><joint joint="j" coef="1"/></fixed></tendon>'
    scene = load(tmp_path, model(body("a", slide, geom("g")), after=tendon and pulled))
    assert codes(scene).count("constraint-not-solved") == notes
