"""Forward kinematics in float64: from values of joints to poses of links, in many poses at once.

A pose is rigid. A single one is a row-major 4x4 for column vectors; `Poses` are the upper three
rows of many, shape (3, 4, poses), or (3, 4, 1) where all are the same. `Values` of a joint have
shape (numbers, poses) or (numbers, 1). The bits are those of `core.transform.compose`.

Conventions of URDF: roll, pitch, yaw turn about the fixed x, y, z in that order, R = Rz(yaw)
Ry(pitch) Rx(roll); the motion of a joint is applied after its origin, in the frame of the joint;
angles are right-handed.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from satcheck.core.conventions import Vector
from satcheck.core.transform import (
    Transform,
    about,
    about_fixed_axes,
    placed,
    quaternion_matrix,
    within,
)
from satcheck.scene.bodies import IDENTITY, Scene
from satcheck.scene.robot.model import Joint, Robot

Numbers = NDArray[np.float64]
_NO_TURN = (1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0)
_NO_SHIFT = (0.0, 0.0, 0.0)


def poses_of(pose: Transform) -> Numbers:
    """Return a pose that is the same in all poses of a robot, shape (3, 4, 1)."""
    return np.array(pose[:12]).reshape(3, 4, 1)


def link_poses(robot: Robot, values: Mapping[str, Numbers]) -> dict[str, Numbers]:
    """Return the poses of each link in the world. values: of every joint that moves.

    A link with a pose at rest has exactly this pose while no joint above it has moved.
    """
    poses = {link: poses_of(pose) for link, pose in robot.roots.items()}
    still: dict[str, Any] = dict.fromkeys(poses, True)
    for joint in robot.joints:
        pose = within(poses[joint.parent], poses_of(joint.origin))
        stays = still[joint.parent]
        if joint.freedoms:
            own = values[joint.name]
            stays = stays & np.equal(own.T, joint.neutral).all(axis=1)
            pose = within(pose, motion(joint, own))
        if joint.child_origin != IDENTITY:
            pose = within(pose, poses_of(joint.child_origin))
        rest = robot.links[joint.child].rest
        if rest is not None:
            pose = np.where(stays, poses_of(rest), pose)
        poses[joint.child], still[joint.child] = pose, stays
    return poses


def motion(joint: Joint, values: Numbers) -> Numbers:
    """Return the motion of a joint that moves, which is applied after its origin."""
    start = joint.reference[0] if joint.reference else 0.0
    turn: Sequence[Any] = _NO_TURN
    shift: Sequence[Any] = _NO_SHIFT
    match joint.kind:
        case "prismatic":
            shift = [(values[0] - start) * c for c in joint.axis]
        case "planar":
            x, y, angle = values
            turn = about(joint.axis, _cos_sin(angle))
            shift = [x * u + y * v for u, v in zip(*plane_axes(joint.axis), strict=True)]
        case "floating":
            roll, pitch, yaw = map(_cos_sin, values[3:])
            turn, shift = about_fixed_axes(roll, pitch, yaw), [*values[:3]]
        case "ball":
            turn = _turned(values)
        case "free":
            turn, shift = _turned(values[3:]), [*values[:3]]
        case _:
            turn = about(joint.axis, _cos_sin(values[0] - start))
    poses = np.empty((12, values.shape[1]))
    for row, entry in enumerate(placed(turn, shift)[:12]):
        poses[row] = entry
    return poses.reshape(3, 4, -1)


def _turned(quaternion: Numbers) -> Any:
    w, x, y, z = quaternion.tolist()
    turns = [quaternion_matrix(*each) for each in zip(x, y, z, w, strict=True)]
    return np.array(turns).T


def _cos_sin(radians: Numbers) -> tuple[Any, Any]:
    # numpy's own cosine may differ in the last bit, and between processors.
    turns = radians.tolist()
    cosines, sines = (map(function, turns) for function in (math.cos, math.sin))
    return np.fromiter(cosines, float, len(turns)), np.fromiter(sines, float, len(turns))


def plane_axes(normal: Vector) -> tuple[Vector, Vector]:
    """x and y of the joint's frame after the shortest rotation from z to the normal.

    If the normal is -z, this is half a turn about x. Moller, Hughes, "Efficiently Building a Matrix
    to Rotate One Vector to Another" (1999), for from = z.
    """
    x, y, z = normal
    if z < -1 + 1e-12:
        return (1.0, 0.0, 0.0), (0.0, -1.0, 0.0)
    h = 1 / (1 + z)
    return (1 - h * x * x, -h * x * y, -x), (-h * x * y, 1 - h * y * y, -y)


def link_frames(scene: Scene, joints: Mapping[str, Numbers]) -> list[dict[str, Numbers]]:
    """Return of each robot: link -> its poses. joints: the values of every joint that moves."""
    return [link_poses(robot.robot, joints) for robot in scene.robots]


def placements(scene: Scene, frames: Sequence[Mapping[str, Numbers]], count: int) -> Numbers:
    """Return the upper three rows of the placement of each readable body, in the order of
    `Scene.bodies`, shape (poses, bodies, 12). frames: of the links in `count` poses."""
    carried = {
        body.id: within(links[body.link], poses_of(body.offset))
        for robot, links in zip(scene.robots, frames, strict=True)
        for body in robot.bodies
    }
    rows = np.empty((count, len(scene.bodies), 12))
    for k, body in enumerate(scene.bodies):
        if body.id in carried:
            rows[:, k] = carried[body.id].reshape(12, -1).T
        else:
            rows[:, k] = (body.transform or IDENTITY)[:12]
    return rows


def inverse(pose: Transform) -> Transform:
    """Return the inverse of a rigid pose."""
    turn = (*pose[0:9:4], *pose[1:10:4], *pose[2:11:4])
    x, y, z = pose[3:12:4]
    shift = (-(a * x + b * y + c * z) for a, b, c in (turn[0:3], turn[3:6], turn[6:9]))
    return placed(turn, tuple(shift))


def scaled(pose: Transform, scale: Vector) -> Transform:
    """Return pose * diag(scale): the geometry is scaled in its own frame first."""
    factors = (*scale, 1.0)
    return tuple(entry * factors[k % 4] for k, entry in enumerate(pose))


def from_rpy(xyz: Vector, rpy: Vector) -> Transform:
    roll, pitch, yaw = ((math.cos(angle), math.sin(angle)) for angle in rpy)
    return placed(about_fixed_axes(roll, pitch, yaw), xyz)
