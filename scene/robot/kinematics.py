"""Forward kinematics: values of joints -> where the links are, in float64.

Poses are rigid row-major 4x4 for column vectors. Conventions of URDF: roll, pitch, yaw turn about
the fixed x, y, z in that order, R = Rz(yaw) Ry(pitch) Rx(roll); a joint's motion comes after its
origin, in the joint's own frame; angles are right-handed.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

from satcheck.scene.bodies import IDENTITY, Transform
from satcheck.scene.robot.model import Joint, Robot, Vector

Rotation = tuple[float, float, float, float, float, float, float, float, float]
# Numbers of one joint: none for a fixed one, (x, y, angle) for a planar one, (x, y, z, roll, pitch,
# yaw) for a floating one, an angle or a length for the others.
Values = tuple[float, ...]


def link_poses(robot: Robot, values: Mapping[str, Values]) -> dict[str, Transform]:
    """World pose of each link; the root's is the identity. values: of every joint that moves."""
    poses = {robot.root: IDENTITY}
    for joint in robot.joints:
        placed = compose(poses[joint.parent], joint.origin)
        if joint.freedoms:
            placed = compose(placed, motion(joint, values[joint.name]))
        poses[joint.child] = placed
    return poses


def motion(joint: Joint, values: Sequence[float]) -> Transform:
    """What the joint adds to its origin."""
    match joint.kind:
        case "fixed":
            return IDENTITY
        case "prismatic":
            x, y, z = (values[0] * c for c in joint.axis)
            return _pose(_NO_TURN, (x, y, z))
        case "planar":
            x, y, angle = values
            u, v = _plane(joint.axis)
            shift = (x * u[0] + y * v[0], x * u[1] + y * v[1], x * u[2] + y * v[2])
            return _pose(about(joint.axis, angle), shift)
        case "floating":
            return from_rpy((values[0], values[1], values[2]), (values[3], values[4], values[5]))
    return _pose(about(joint.axis, values[0]), (0.0, 0.0, 0.0))


def compose(a: Transform, b: Transform) -> Transform:
    """a * b: first b, then a."""
    columns = [(b[j], b[4 + j], b[8 + j], b[12 + j]) for j in range(4)]
    return tuple(
        p * x + q * y + r * z + t * w
        for p, q, r, t in (a[0:4], a[4:8], a[8:12], a[12:16])
        for x, y, z, w in columns
    )


def scaled(pose: Transform, scale: Vector) -> Transform:
    """pose * diag(scale): the geometry is scaled in its own frame first."""
    factors = (*scale, 1.0)
    return tuple(entry * factors[k % 4] for k, entry in enumerate(pose))


def from_rpy(xyz: Vector, rpy: Vector) -> Transform:
    (sr, sp, sy), (cr, cp, cy) = map(math.sin, rpy), map(math.cos, rpy)
    turn = (
        *(cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr),
        *(sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr),
        *(-sp, cp * sr, cp * cr),
    )
    return _pose(turn, xyz)


def from_quaternion(xyz: Vector, quaternion: tuple[float, float, float, float]) -> Transform:
    """(x, y, z, w) of any length but 0."""
    length = math.hypot(*quaternion)
    x, y, z, w = (c / length for c in quaternion)
    turn = (
        *(1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)),
        *(2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)),
        *(2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)),
    )
    return _pose(turn, xyz)


def about(axis: Vector, angle: float) -> Rotation:
    """Rodrigues' formula; axis of length 1. Exact zeros and ones where the axis is one
    of the frame's."""
    x, y, z = axis
    s, c = math.sin(angle), math.cos(angle)
    t = 1.0 - c
    return (
        *(x * x + c * (1.0 - x * x), t * x * y - s * z, t * x * z + s * y),
        *(t * x * y + s * z, y * y + c * (1.0 - y * y), t * y * z - s * x),
        *(t * x * z - s * y, t * y * z + s * x, z * z + c * (1.0 - z * z)),
    )


def _plane(normal: Vector) -> tuple[Vector, Vector]:
    """x and y of the joint's frame, after the shortest turn that brings its z to the normal.

    For z down that is half a turn about x. Moller, Hughes, "Efficiently Building a Matrix to Rotate
    One Vector to Another" (1999), for from = z.
    """
    x, y, z = normal
    if z < -1 + 1e-12:
        return (1.0, 0.0, 0.0), (0.0, -1.0, 0.0)
    h = 1 / (1 + z)
    return (1 - h * x * x, -h * x * y, -x), (-h * x * y, 1 - h * y * y, -y)


_NO_TURN: Rotation = (1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0)


def _pose(turn: Rotation, shift: Vector) -> Transform:
    a, b, c = turn[0:3], turn[3:6], turn[6:9]
    return (*a, shift[0], *b, shift[1], *c, shift[2], 0.0, 0.0, 0.0, 1.0)
