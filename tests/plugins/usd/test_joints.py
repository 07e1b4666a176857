"""USD: joints of physics move their rigid bodies."""

from __future__ import annotations

import json
import math
from pathlib import Path

import pytest

from satcheck.core.errors import SatcheckError
from satcheck.scene import Scene, load_scene
from satcheck.scene.robot import posed
from tests.cli.process import satcheck
from tests.plugins.usd.files import at, bounds_of, cube, load, said, stage
from tests.plugins.usd.test_physics import body

DOOR = "/Hinge"
CROSSED = "float physics:lowerLimit = 9\nfloat physics:upperLimit = 1"


def joint(
    kind: str, body0: str | None, body1: str | None, more: str = "", name: str = "Hinge"
) -> str:
    ends = [
        f"rel physics:body{k} = <{end}>" for k, end in enumerate((body0, body1)) if end is not None
    ]
    return f'def Physics{kind}Joint "{name}"\n{{\n{chr(10).join([*ends, more])}\n}}\n'


def door(more: str = "", kind: str = "Revolute", head: str = "metersPerUnit = 1") -> str:
    """A frame, and a door whose hinge is the z axis through (2, 0, 0), turned by 0 at rest."""
    axis = 'uniform token physics:axis = "Z"\npoint3f physics:localPos0 = (2, 0, 0)\n' + more
    return stage(
        body("Frame", cube("Geom")),
        body("Door", cube("Geom"), more=at(2)),
        joint(kind, "/Frame", "/Door", axis),
        head=head + '\nupAxis = "Z"',
    )


def box(scene: Scene, name: str = "/Door/Geom") -> list[float]:
    low, high = bounds_of(scene)[name]
    return [*low, *high]


def test_a_revolute_joint_turns_its_body_about_its_axis(tmp_path: Path) -> None:
    scene = load(tmp_path, door())
    assert box(scene) == [2, 0, 0, 3, 1, 1]
    turned = posed(scene, {DOOR: (math.pi / 2,)})
    assert box(turned) == pytest.approx([1, 0, 0, 2, 1, 1])
    assert box(turned, "/Frame/Geom") == [0, 0, 0, 1, 1, 1]


def test_bodies_stand_exactly_where_the_file_places_them(tmp_path: Path) -> None:
    text = door().replace("(2, 0, 0)", "(2.1, 0.3, 0.7)")
    scene = load(tmp_path, text)
    assert scene.posture is not None
    assert scene.posture.joints == {DOOR: (0.0,)}
    alone = load(tmp_path, text.replace("PhysicsRevoluteJoint", "Scope"))
    assert [b.transform for b in scene.bodies] == [b.transform for b in alone.bodies]
    moved = posed(scene, {DOOR: (1.0,)})
    assert [b.transform for b in posed(moved, {}).bodies] == [b.transform for b in alone.bodies]


def test_the_angle_at_rest_is_that_of_the_frames(tmp_path: Path) -> None:
    half = math.sqrt(0.5)
    scene = load(tmp_path, door(f"quatf physics:localRot1 = ({half}, 0, 0, {half})"))
    assert scene.posture is not None
    (angle,) = scene.posture.joints[DOOR]
    assert angle == pytest.approx(math.pi / 2, abs=1e-6)
    assert box(posed(scene, {DOOR: (math.pi,)})) == pytest.approx([1, 0, 0, 2, 1, 1], abs=1e-6)


def test_a_joint_without_a_second_body_turns_against_the_world(tmp_path: Path) -> None:
    hinge = 'uniform token physics:axis = "Z"\n'
    for ends, sign in ((("/Door", None), -1), ((None, "/Door"), 1)):
        scene = load(
            tmp_path,
            stage(body("Door", cube("Geom")), cube("Wall"), joint("Revolute", *ends, hinge)),
        )
        turned = posed(scene, {DOOR: (sign * math.pi / 2,)})
        assert box(turned) == pytest.approx([-1, 0, 0, 0, 1, 1])
        assert box(turned, "/Wall") == [0, 0, 0, 1, 1, 1]


def test_limits_are_in_degrees_and_lengths_in_metres(tmp_path: Path) -> None:
    limits = "float physics:lowerLimit = -90\nfloat physics:upperLimit = 45\n"
    scene = load(tmp_path, door(limits))
    (hinge,) = scene.robots[0].robot.joints
    assert hinge.limits is not None
    assert (hinge.limits.lower, hinge.limits.upper) == pytest.approx((-math.pi / 2, math.pi / 4))
    centimetres = load(tmp_path, door(limits, "Prismatic", "metersPerUnit = 0.01"))
    (slide,) = centimetres.robots[0].robot.joints
    assert slide.limits is not None
    assert (slide.limits.lower, slide.limits.upper) == pytest.approx((-0.9, 0.45))
    moved = posed(centimetres, {DOOR: (0.25,)})
    assert box(moved) == pytest.approx([2, 0, 25, 3, 1, 26])


def test_lengths_follow_the_unit_of_the_check(tmp_path: Path) -> None:
    (tmp_path / "stage.usda").write_text(door("", "Prismatic", "metersPerUnit = 0.01"))
    (tmp_path / "other.usda").write_text(
        stage(cube("Other"), head='metersPerUnit = 0.001\nupAxis = "Z"')
    )
    scene = load_scene([tmp_path / "stage.usda", tmp_path / "other.usda"])
    moved = posed(scene, {DOOR: (0.25,)})
    assert scene.units == "mm"
    assert box(moved, "stage/Door/Geom") == pytest.approx([20, 0, 250, 30, 10, 260])


def test_a_chain_moves_what_hangs_on_it(tmp_path: Path) -> None:
    axis = 'uniform token physics:axis = "Z"\n'
    scene = load(
        tmp_path,
        stage(
            body("A", cube("Geom")),
            body("B", cube("Geom"), more=at(1)),
            joint("Revolute", None, "/A", axis),
            joint("Fixed", "/B", "/A", "point3f physics:localPos0 = (-1, 0, 0)", "Weld"),
        ),
    )
    turned = posed(scene, {DOOR: (math.pi / 2,)})
    assert box(turned, "/B/Geom") == pytest.approx([-1, 1, 0, 0, 2, 1])


def test_joints_that_are_not_moved_are_named(tmp_path: Path) -> None:
    scene = load(tmp_path, door(kind="Spherical"))
    assert "PhysicsSphericalJoint" in said(scene)["joint-not-moved"]
    assert scene.robots == ()
    apart = load(tmp_path, door("point3f physics:localPos1 = (0.5, 0, 0)"))
    assert "its frames do not meet" in said(apart)["joint-not-moved"]
    assert apart.robots == ()


@pytest.mark.parametrize(
    ("old", "new", "why"),
    [
        ("</Door>", "</Gone>", "is missing"),
        ("localPos0 = (2, 0, 0)", "localPos0 = (nan, 0, 0)", "not finite"),
        ("point3f", f"{CROSSED}\npoint3f", "no value"),
    ],
)  # fmt: skip
def test_joints_that_make_no_sense_are_named(tmp_path: Path, old: str, new: str, why: str) -> None:
    scene = load(tmp_path, door().replace(old, new))
    assert why in said(scene)["joint-not-moved"]
    assert scene.robots == ()
    assert box(scene) == [2, 0, 0, 3, 1, 1]


def test_joints_of_a_loop_are_not_moved(tmp_path: Path) -> None:
    axis = 'uniform token physics:axis = "Z"\n'
    loop = [
        joint("Revolute", "/A", "/B", axis + "point3f physics:localPos1 = (-1, 0, 0)", "J1"),
        joint("Revolute", "/A", "/B", axis + "point3f physics:localPos1 = (-1, 0, 0)", "J2"),
    ]
    scene = load(
        tmp_path, stage(body("A", cube("Geom")), body("B", cube("Geom"), more=at(1)), *loop)
    )
    assert (
        "/J1, /J2" in said(scene)["joint-not-moved"] or "/J2, /J1" in said(scene)["joint-not-moved"]
    )
    with pytest.raises(SatcheckError, match="does not move"):
        posed(scene, {"/J1": (1.0,)})


def test_the_command_poses_and_samples_a_stage(tmp_path: Path) -> None:
    path = tmp_path / "door.usda"
    limits = "float physics:lowerLimit = 0\nfloat physics:upperLimit = 170\n"
    path.write_text(door(limits + "bool physics:collisionEnabled = true\n"))
    assert satcheck(str(path)).code == 0
    ran = satcheck(str(path), "--pose", json.dumps({DOOR: 2.5}), "--format", "json")
    assert ran.code == 1
    assert ran.document["findings"][0]["relation"] == "penetrating"
    assert satcheck(str(path), "--sample", "50", "--seed", "1").code == 1


def test_resolve_moves_bodies_of_joints_and_says_that_these_are_not_written(tmp_path: Path) -> None:
    path = tmp_path / "door.usda"
    path.write_text(
        door("bool physics:collisionEnabled = true\n").replace("(2, 0, 0)", "(0.75, 0, 0)")
    )
    ran = satcheck("resolve", str(path), "-o", str(tmp_path / "moved.toml"))
    assert ran.code == 0, ran.err
    assert "moved.toml has no joints" in " ".join(ran.err.split())
