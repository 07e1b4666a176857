"""Blocks reach beyond all that the bodies of a scene may do."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import pytest

from satcheck.core.shapes import HalfSpace
from satcheck.scene import Scene, load_scene
from satcheck.scene.half_spaces import holds, with_reach
from satcheck.scene.robot import posed
from tests.plugin_marks import needs

UNIT = {"type": "box", "size": [1, 1, 1]}


def scene_of(folder: Path, body: dict[str, Any], **more: Any) -> Scene:
    floor = {"id": "floor", "shape": {"type": "half-space"}, "position": [0, 0, -3]}
    document = {"schema": "satcheck.scene/1", "bodies": [floor, {"id": "body", **body}], **more}
    (folder / "scene.json").write_text(json.dumps(document))
    return load_scene([folder / "scene.json"])


def reaches(scene: Scene) -> float:
    shape = scene.bodies[0].shape
    assert isinstance(shape, HalfSpace)
    return shape.reaches


@pytest.mark.parametrize(
    ("motion", "farthest"),
    [
        ({"translation": [100, 0, 0]}, 105),
        ({"rotation": {"point": [50, 0, 0], "axis": [0, 0, 1], "degrees": 180}}, 95),
        (
            {
                "path": [
                    {"time": 0, "position": [0, 0, 0]},
                    {"time": 0.5, "position": [0, 200, 0]},
                    {"time": 1, "position": [0, 0, 0]},
                ]
            },
            200,
        ),
    ],
)
def test_of_motions(tmp_path: Path, motion: dict[str, Any], farthest: float) -> None:
    still = scene_of(tmp_path, {"shape": UNIT, "position": [5, 0, 0]})
    assert 9 < reaches(still) < 60
    moved = scene_of(
        tmp_path, {"shape": UNIT, "position": [5, 0, 0]}, motion=[{"bodies": ["body"], **motion}]
    )
    assert reaches(moved) > farthest


def test_a_block_that_reaches_far_enough_stays(tmp_path: Path) -> None:
    scene = scene_of(tmp_path, {"shape": UNIT, "position": [5, 0, 0]})
    assert with_reach(scene) is scene


def test_of_a_scene_in_other_units(tmp_path: Path) -> None:
    """The block is as large as the bodies, whatever the scale of its placement is."""
    for units in ("um", "m"):
        scene = scene_of(tmp_path, {"shape": UNIT, "position": [5, 0, 0]}, units=units)
        assert holds(scene.bodies[0], ((-5.5, -0.5, -9.0), (5.5, 0.5, 0.5)))
        assert not holds(scene.bodies[0], ((0.0, 0.0, 0.0), (999.0, 0.0, 0.0)))


def arm(folder: Path, joint: str) -> Scene:
    (folder / "m.xml").write_text(
        "<mujoco><worldbody><geom type='plane' size='1 1 1'/>"
        f"<body pos='0 0 1'>{joint}<geom type='sphere' size='.5' pos='0 0 9'/></body>"
        "</worldbody></mujoco>"
    )
    return load_scene([folder / "m.xml"])


@needs("sdf", "mjcf")
def test_of_joints_with_limits(tmp_path: Path) -> None:
    """All poses within the limits are within reach."""
    scene = arm(tmp_path, "<joint name='j' type='slide' axis='1 0 0' range='-5000 1'/>")
    low = posed(scene, {"j": (-5000.0,)})
    assert with_reach(low) is low
    turning = arm(tmp_path, "<joint name='j' type='hinge' axis='0 1 0'/>")
    for angle in (0.5, 2.0, 3.0):
        turned = posed(turning, {"j": (angle,)})
        assert with_reach(turned) is turned
        assert holds(turned.bodies[0], turned.bodies[1].world_mesh().bounds)


@needs("sdf", "mjcf")
def test_of_a_joint_without_limits(tmp_path: Path) -> None:
    scene = arm(tmp_path, "<joint name='j' type='slide' axis='1 0 0'/>")
    away = posed(scene, {"j": (1e7,)})
    assert not holds(away.bodies[0], away.bodies[1].world_mesh().bounds)
    fitted = with_reach(away)
    assert holds(fitted.bodies[0], fitted.bodies[1].world_mesh().bounds)


def test_a_stretched_placement(tmp_path: Path) -> None:
    """A half space stays one; its block grows where the placement makes it small."""
    floor = {"id": "floor", "shape": {"type": "half-space"}, "scale": 1e-3}
    body = {"id": "body", "shape": UNIT, "position": [0, 0, 30]}
    document = {"schema": "satcheck.scene/1", "bodies": [floor, body]}
    (tmp_path / "scene.json").write_text(json.dumps(document))
    scene = load_scene([tmp_path / "scene.json"])
    assert reaches(scene) * 1e-3 > math.hypot(30.5, 0.5, 0.5)
