"""Forward kinematics against closed forms.

Every entry is a sum of a few products of numbers below 4, each sine and cosine within 1 ulp; the
longest chain here takes 12 products of matrices. 1e-14 is 45 times the rounding of 4.
"""

from __future__ import annotations

import math
import random
from pathlib import Path

import pytest

from satcheck.core import transform
from satcheck.core.transform import Vector, compose, quaternion_matrix
from satcheck.scene.bodies import IDENTITY
from satcheck.scene.robot.kinematics import (
    from_rpy,
    motion,
    scaled,
)
from satcheck.scene.robot.model import Joint
from satcheck.scene.robot.poses import values_of
from tests.scene.robot.robots import (
    SAMPLES,
    joint,
    link,
    link_transforms,
    read,
    read_robot,
    robot_of,
)

CLOSE = 1e-14
Matrix = tuple[float, ...]


def about(axis: Vector, angle: float) -> Matrix:
    return transform.about(axis, (math.cos(angle), math.sin(angle)))


def close(a: Matrix, b: Matrix) -> bool:
    return all(abs(x - y) <= CLOSE for x, y in zip(a, b, strict=True))


def dot(a: Matrix, b: Matrix) -> float:
    return sum(x * y for x, y in zip(a, b, strict=True))


def place(pose: Matrix) -> tuple[float, float, float]:
    return pose[3], pose[7], pose[11]


def turn(pose: Matrix) -> Matrix:
    return (*pose[0:3], *pose[4:7], *pose[8:11])


def moved(joint: Joint, values: tuple[float, ...]) -> Matrix:
    return (*motion(joint, values_of(values)).ravel(), 0.0, 0.0, 0.0, 1.0)


def test_roll_pitch_yaw_turn_about_fixed_axes_in_that_order() -> None:
    r, p, y = 0.3, -1.1, 2.5
    x_axis, y_axis, z_axis = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)

    def rotation(axis: tuple[float, float, float], angle: float) -> Matrix:
        a = about(axis, angle)
        return (*a[0:3], 0.0, *a[3:6], 0.0, *a[6:9], 0.0, 0.0, 0.0, 0.0, 1.0)

    first_roll = compose(rotation(y_axis, p), rotation(x_axis, r))
    expected = compose(rotation(z_axis, y), first_roll)
    assert close(from_rpy((0.0, 0.0, 0.0), (r, p, y)), expected)


@pytest.mark.parametrize(
    ("axis", "moved"),
    [
        ((1.0, 0.0, 0.0), (0.0, 0.0, 1.0)),  # y goes to z
        ((0.0, 0.0, 1.0), (-1.0, 0.0, 0.0)),  # y goes to -x
    ],
)
def test_angles_are_right_handed(axis, moved) -> None:
    a = about(axis, math.pi / 2)
    assert close((a[1], a[4], a[7]), moved)


def test_a_turn_about_an_axis_of_the_frame_leaves_it_as_it_is_to_the_bit() -> None:
    draw = random.Random(1).random
    for _ in range(100):
        a = about((0.0, 0.0, 1.0), 7 * draw())
        assert (a[2], a[5], a[6], a[7], a[8]) == (0.0, 0.0, 0.0, 0.0, 1.0)


def test_a_turn_keeps_its_axis_and_is_one() -> None:
    axis = (2 / 7, -3 / 7, 6 / 7)
    a = about(axis, 1.2345)
    rows = (a[0:3], a[3:6], a[6:9])
    assert close(tuple(dot(row, axis) for row in rows), axis)
    for i, row in enumerate(rows):
        assert close(
            tuple(dot(row, other) for other in rows), tuple(float(i == j) for j in range(3))
        )
    assert abs(a[0] + a[4] + a[8] - (1 + 2 * math.cos(1.2345))) <= CLOSE


def test_quaternions() -> None:
    half = 0.35
    axis = (2 / 7, -3 / 7, 6 / 7)
    s = 5 * math.sin(half)
    turned = quaternion_matrix(s * axis[0], s * axis[1], s * axis[2], 5 * math.cos(half))
    assert close(turned, about(axis, 2 * half))


def test_scale_comes_before_the_pose() -> None:
    pose = from_rpy((1.0, 2.0, 3.0), (0.0, 0.0, math.pi / 2))
    mirrored = scaled(pose, (2.0, -1.0, 1.0))
    assert place(mirrored) == (1.0, 2.0, 3.0)
    assert close((mirrored[0], mirrored[4]), (0.0, 2.0))  # x, twice as long, goes to y
    assert close((mirrored[1], mirrored[5]), (1.0, 0.0))  # y, mirrored, to x


@pytest.mark.parametrize(
    ("kind", "values", "expected"),
    [
        ("continuous", (math.pi / 2,), (0.0, 0.0, 0.0)),
        ("prismatic", (0.5,), (0.0, 0.0, 0.5)),
        ("planar", (0.25, -0.5, math.pi / 2), (0.25, -0.5, 0.0)),
        ("floating", (1.0, 2.0, 3.0, 0.0, 0.0, math.pi / 2), (1.0, 2.0, 3.0)),
    ],
)
def test_motions_of_every_kind(tmp_path: Path, kind, values, expected) -> None:
    inside = '<axis xyz="0 0 1"/>' + ('<limit upper="1"/>' if kind == "prismatic" else "")
    robot = read(tmp_path, robot_of(link("a"), link("b"), joint("j", "a", "b", kind, inside)))
    pose = moved(robot.joints[0], values)
    assert place(pose) == expected
    turned = math.pi / 2 if kind in ("continuous", "planar", "floating") else 0.0
    assert close(turn(pose), about((0.0, 0.0, 1.0), turned))


@pytest.mark.parametrize("axis", ["0 1 0", "2 -3 6", "0 0 -1"])
def test_a_planar_joint_stays_in_its_plane(tmp_path: Path, axis: str) -> None:
    inside = f'<axis xyz="{axis}"/>'
    robot = read(tmp_path, robot_of(link("a"), link("b"), joint("j", "a", "b", "planar", inside)))
    normal = robot.joints[0].axis
    u = place(moved(robot.joints[0], (1.0, 0.0, 0.0)))
    v = place(moved(robot.joints[0], (0.0, 1.0, 0.0)))
    cross = (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])
    assert close(cross, normal)
    assert abs(dot(u, v)) <= CLOSE


def test_the_sample_arm_in_closed_form() -> None:
    robot, _ = read_robot(SAMPLES / "arm.urdf", "arm.urdf")
    draw = random.Random(2)
    for _ in range(50):
        t, a, b, g = (draw.uniform(-2, 2) for _ in range(4))
        pose = {"turn": (t,), "shoulder": (a,), "elbow": (b,), "grip": (g,)}
        links = link_transforms(robot, pose)
        out, up = math.sin(a), 0.5 + math.cos(a)  # the elbow, in the plane of the arm
        assert close(place(links["fore"]), (out * math.cos(t), out * math.sin(t), up))
        out += 1.0625 * math.sin(a + b)
        up += 1.0625 * math.cos(a + b)
        aside = (-g * math.sin(t), g * math.cos(t))
        tip = (out * math.cos(t), out * math.sin(t))
        assert close(place(links["left"]), (tip[0] + aside[0], tip[1] + aside[1], up))
        assert close(place(links["right"]), (tip[0] - aside[0], tip[1] - aside[1], up))
        assert links["base"] == IDENTITY


def test_origins_come_before_motions(tmp_path: Path) -> None:
    """A slide along the x of a frame that is turned by 90 degrees about z, and moved."""
    inside = '<origin xyz="1 0 0" rpy="0 0 1.5707963267948966"/><limit lower="0" upper="1"/>'
    text = robot_of(link("a"), link("b"), joint("j", "a", "b", "prismatic", inside))
    poses = link_transforms(read(tmp_path, text), {"j": (0.5,)})
    assert close(place(poses["b"]), (1.0, 0.5, 0.0))
