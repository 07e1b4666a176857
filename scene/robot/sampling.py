"""Random poses: a value in its range for each joint that moves. A seed fixes the sequence."""

from __future__ import annotations

import math
import random
from collections.abc import Sequence

from satcheck.scene.robot.model import Joint, Robot
from satcheck.scene.robot.poses import Pose

# Significant digits of a value. A user can then read and retype a pose; the rounded pose is the one
# that is checked.
_DIGITS = 6


def joint_samples(
    robots: Sequence[Robot], count: int, seed: int, fixed: Pose | None = None
) -> list[Pose]:
    """`count` poses, uniform within the limits. A rotating joint without limits is in [-pi, pi].

    Each value is rounded to six significant digits. A longer list starts with the poses of a
    shorter one. The poses are the same on every machine and version of Python. Joints in `fixed`
    keep those values. Sliding joints without limits, planar and floating joints stay at 0. Mimics
    follow their leaders.
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
    still = joint.neutral[0]
    return (still, still) if joint.kind == "prismatic" else (-math.pi, math.pi)


def _between(low: float, high: float, share: float) -> float:
    rounded = float(f"{low + share * (high - low):.{_DIGITS}g}")
    return min(max(rounded, low), high)
