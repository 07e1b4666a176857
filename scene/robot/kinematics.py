"""Forward kinematics in float64: from values of joints to poses of links.

Poses are rigid row-major 4x4 for column vectors. Conventions of URDF: roll, pitch, yaw turn about
the fixed x, y, z in that order, R = Rz(yaw) Ry(pitch) Rx(roll); the motion of a joint is applied
after its origin, in the frame of the joint; angles are right-handed.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

from satcheck.core.conventions import Vector
from satcheck.core.transform import (
    Transform,
    about,
    about_fixed_axes,
    compose,
    placed,
    quaternion_matrix,
)
from satcheck.scene.bodies import IDENTITY
from satcheck.scene.robot.model import Joint, Robot

# The value of a joint: no number for a fixed joint, (x, y, angle) for a planar one, (x, y, z, roll,
# pitch, yaw) for a floating one, an angle or a length for others.
Values = tuple[float, ...]

_NO_TURN = (1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0)


def link_poses(robot: Robot, values: Mapping[str, Values]) -> dict[str, Transform]:
    """World pose of each link. The root has the identity. values: of every joint that moves."""
    poses = {robot.root: IDENTITY}
    for joint in robot.joints:
        placed = compose(poses[joint.parent], joint.origin)
        if joint.freedoms:
            placed = compose(placed, motion(joint, values[joint.name]))
        poses[joint.child] = placed
    return poses


def motion(joint: Joint, values: Sequence[float]) -> Transform:
    """The motion of the joint, which is applied after its origin."""
    match joint.kind:
        case "fixed":
            return IDENTITY
        case "prismatic":
            x, y, z = (values[0] * c for c in joint.axis)
            return placed(_NO_TURN, (x, y, z))
        case "planar":
            x, y, angle = values
            u, v = _plane(joint.axis)
            shift = (x * u[0] + y * v[0], x * u[1] + y * v[1], x * u[2] + y * v[2])
            return placed(about(joint.axis, _cos_sin(angle)), shift)
        case "floating":
            return from_rpy((values[0], values[1], values[2]), (values[3], values[4], values[5]))
    return placed(about(joint.axis, _cos_sin(values[0])), (0.0, 0.0, 0.0))


def scaled(pose: Transform, scale: Vector) -> Transform:
    """pose * diag(scale): the geometry is scaled in its own frame first."""
    factors = (*scale, 1.0)
    return tuple(entry * factors[k % 4] for k, entry in enumerate(pose))


def from_rpy(xyz: Vector, rpy: Vector) -> Transform:
    roll, pitch, yaw = map(_cos_sin, rpy)
    return placed(about_fixed_axes(roll, pitch, yaw), xyz)


def from_quaternion(xyz: Vector, quaternion: tuple[float, float, float, float]) -> Transform:
    """quaternion: (x, y, z, w) of any length except 0."""
    return placed(quaternion_matrix(*quaternion), xyz)


def _cos_sin(radians: float) -> tuple[float, float]:
    return math.cos(radians), math.sin(radians)


def _plane(normal: Vector) -> tuple[Vector, Vector]:
    """x and y of the joint's frame after the shortest rotation from z to the normal.

    If the normal is -z, this is half a turn about x. Moller, Hughes, "Efficiently Building a Matrix
    to Rotate One Vector to Another" (1999), for from = z.
    """
    x, y, z = normal
    if z < -1 + 1e-12:
        return (1.0, 0.0, 0.0), (0.0, -1.0, 0.0)
    h = 1 / (1 + z)
    return (1 - h * x * x, -h * x * y, -x), (-h * x * y, 1 - h * y * y, -y)
