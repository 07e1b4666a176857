"""Random poses: every joint that moves somewhere in its range, the same for the same seed."""

from __future__ import annotations

import math
import random
from collections.abc import Sequence

from satcheck.scene.robot.model import Joint, Robot
from satcheck.scene.robot.poses import Pose

# So that a pose can be read and typed again; it is checked exactly as rounded.
_DIGITS = 6


def joint_samples(
    robots: Sequence[Robot], count: int, seed: int, fixed: Pose | None = None
) -> list[Pose]:
    """`count` poses, uniform within the limits; joints that turn without any from -pi to pi.

    Each value is rounded to six significant digits. The first poses of a longer list are those of a
    shorter one; no machine or version of Python changes them. Joints of `fixed` keep its values;
    joints that slide without limits stay at 0, planar and floating ones too; mimics follow.
    """
    # Random.random() is the one method whose sequence Python promises to keep.
    draw = random.Random(seed).random
    fixed = fixed or {}
    joints = [joint for robot in robots for joint in robot.joints if joint.free]
    poses: list[Pose] = []
    for _ in range(count):
        pose = dict(fixed)
        for joint in joints:
            if joint.freedoms == 1:
                value = _between(*_range(joint), draw())
                pose.setdefault(joint.name, (value,))
        poses.append(pose)
    return poses


def _range(joint: Joint) -> tuple[float, float]:
    if joint.limits is not None:
        return joint.limits.lower, joint.limits.upper
    return (0.0, 0.0) if joint.kind == "prismatic" else (-math.pi, math.pi)


def _between(low: float, high: float, share: float) -> float:
    rounded = float(f"{low + share * (high - low):.{_DIGITS}g}")
    return min(max(rounded, low), high)
