"""Forward kinematics in float64: from values of joints to poses of links.

Poses are rigid row-major 4x4 for column vectors. Conventions of URDF: roll, pitch, yaw turn about
the fixed x, y, z in that order, R = Rz(yaw) Ry(pitch) Rx(roll); the motion of a joint is applied
after its origin, in the frame of the joint; angles are right-handed.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

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
from satcheck.scene.files.xml_tree import Element
from satcheck.scene.robot.model import Joint, Robot, Values

_NO_TURN = (1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0)


def link_poses(robot: Robot, values: Mapping[str, Values]) -> dict[str, Transform]:
    """World pose of each link. values: of every joint that moves.

    The numbers of a value may be arrays with an entry for each of many poses. The entries of the
    link poses that depend on them are then arrays, too, with the same bits as for single poses.

    A link with a pose at rest has exactly this pose while no joint above it has moved.
    """
    poses = dict(robot.roots)
    still: dict[str, Any] = dict.fromkeys(poses, True)
    for joint in robot.joints:
        own = values[joint.name] if joint.freedoms else ()
        stays = still[joint.parent]
        for number, neutral in zip(own, joint.neutral, strict=True):
            stays = stays & (number == neutral)
        still[joint.child] = stays
        poses[joint.child] = _carried(joint, poses[joint.parent], own)
        rest = robot.links[joint.child].rest
        if rest is not None:
            poses[joint.child] = _chosen(stays, rest, poses[joint.child])
    return poses


def _chosen(rests: Any, rest: Transform, moved: Transform) -> Transform:
    if isinstance(rests, bool):
        return rest if rests else moved
    import numpy as np

    entries: list[Any] = [np.where(rests, *both) for both in zip(rest, moved, strict=True)]
    return tuple(entries)


def _carried(joint: Joint, parent: Transform, values: Values) -> Transform:
    pose = compose(parent, joint.origin)
    if joint.freedoms:
        pose = compose(pose, motion(joint, values))
    return pose if joint.child_origin == IDENTITY else compose(pose, joint.child_origin)


def inverse(pose: Transform) -> Transform:
    """Of a rigid pose."""
    turn = (*pose[0:9:4], *pose[1:10:4], *pose[2:11:4])
    x, y, z = pose[3:12:4]
    shift = (-(a * x + b * y + c * z) for a, b, c in (turn[0:3], turn[3:6], turn[6:9]))
    return placed(turn, tuple(shift))


def motion(joint: Joint, values: Sequence[float]) -> Transform:
    """The motion of the joint, which is applied after its origin."""
    start = joint.reference[0] if joint.reference else 0.0
    match joint.kind:
        case "fixed":
            return IDENTITY
        case "prismatic":
            x, y, z = ((values[0] - start) * c for c in joint.axis)
            return placed(_NO_TURN, (x, y, z))
        case "planar":
            x, y, angle = values
            u, v = _plane(joint.axis)
            shift = (x * u[0] + y * v[0], x * u[1] + y * v[1], x * u[2] + y * v[2])
            return placed(about(joint.axis, _cos_sin(angle)), shift)
        case "floating":
            return from_rpy((values[0], values[1], values[2]), (values[3], values[4], values[5]))
        case "ball":
            return _turned((0.0, 0.0, 0.0), values)
        case "free":
            return _turned((values[0], values[1], values[2]), values[3:])
    return placed(about(joint.axis, _cos_sin(values[0] - start)), (0.0, 0.0, 0.0))


def _turned(at: Vector, quaternion: Sequence[float]) -> Transform:
    w, x, y, z = quaternion
    if isinstance(w, float | int):
        return from_quaternion(at, (x, y, z, w))
    import numpy as np

    turns = [
        quaternion_matrix(*row) for row in zip(*(n.tolist() for n in (x, y, z, w)), strict=True)
    ]
    return placed([*np.array(turns).T], at)


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


def facing(normal: Vector, plane: Element) -> Transform:
    """The rotation that takes z to a normal of any length; exact for normals along the axes. Raises
    RefusedElement for length 0."""
    length = math.hypot(*normal)
    if length == 0.0:
        plane.refuse("a normal of length 0")
    x, y, z = (c / length for c in normal)
    across = math.hypot(x, y)
    # About z to the side of the normal, after a turn from z to it.
    c, s = (x / across, y / across) if across else (1.0, 0.0)
    return placed((c * z, -s, x, s * z, c, y, -across, 0.0, z), (0.0, 0.0, 0.0))


def _cos_sin(radians: Any) -> tuple[Any, Any]:
    if isinstance(radians, float | int):
        return math.cos(radians), math.sin(radians)
    # numpy's own cosine may differ in the last bit, and between processors.
    import numpy as np

    turns = radians.tolist()
    return np.array([*map(math.cos, turns)]), np.array([*map(math.sin, turns)])


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
