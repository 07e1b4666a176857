"""Many poses of robots as arrays: random ones, the values of the joints, and the placements that
follow."""

from __future__ import annotations

import math
import random
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial
from typing import Any, overload

import numpy as np
from msgspec import Struct
from numpy.typing import NDArray

from satcheck.core.transform import Transform
from satcheck.scene.bodies import IDENTITY, Scene
from satcheck.scene.robot.assembly import body_poses, link_frames
from satcheck.scene.robot.model import Joint, Robot, Values
from satcheck.scene.robot.poses import (
    Pose,
    Posture,
    check_names,
    complete,
    movable_joints,
    posture_of,
)

# Significant digits of a random value. A user can then read and retype a pose; the rounded pose is
# the one that is checked.
_DIGITS = 6
# Poses that are drawn at a time where they are taken one by one.
_DRAWN = 1024

Numbers = NDArray[np.float64]
ManyValues = tuple[Numbers, ...]  # the value of a joint in many poses: an array for each number


class RandomPoses(Sequence[Pose]):
    """`count` random poses, uniform within the limits. A rotating joint without limits is in
    [-pi, pi].

    Each value is rounded to six significant digits. A longer list starts with the poses of a
    shorter one. The poses are the same on every machine and version of Python. Joints in `fixed`
    keep those values. Sliding joints without limits, planar and floating joints stay at 0. Mimics
    follow their leaders. The poses are drawn again each time they are visited, so that they need
    no memory.
    """

    def __init__(
        self, robots: Sequence[Robot], count: int, seed: int, fixed: Pose | None = None
    ) -> None:
        self._robots, self._count, self._seed = tuple(robots), count, seed
        self.fixed = dict(fixed or {})

    def __len__(self) -> int:
        return self._count

    def __iter__(self) -> Iterator[Pose]:
        for first, values in self.batches(_DRAWN):
            for row in range(min(_DRAWN, self._count - first)):
                yield _row(values, row)

    @overload
    def __getitem__(self, number: int) -> Pose: ...
    @overload
    def __getitem__(self, number: slice) -> list[Pose]: ...
    def __getitem__(self, number: int | slice) -> Pose | list[Pose]:
        return list(self)[number]

    def batches(self, size: int) -> Iterator[tuple[int, dict[str, ManyValues]]]:
        """(the number of the first pose, from 0; joint -> its numbers, an array over the poses
        each), for the fixed joints and for those that are drawn."""
        # Random.random() is the one method whose sequence Python promises to keep. numpy continues
        # the same generator faster.
        _, state, _ = random.Random(self._seed).getstate()
        draw = np.random.RandomState()
        draw.set_state(("MT19937", np.array(state[:-1], np.uint32), state[-1], 0, 0.0))
        drawn = self._drawn()
        for first in range(0, self._count, size):
            count = min(size, self._count - first)
            shares = draw.random_sample((count, len(drawn)))
            values = {
                name: tuple(np.full(count, number) for number in own)
                for name, own in self.fixed.items()
            }
            for column, joint in enumerate(drawn):
                if joint.name not in self.fixed:
                    values[joint.name] = (_between(*_range(joint), shares[:, column]),)
            yield first, values

    def _drawn(self) -> list[Joint]:
        joints = (joint for robot in self._robots for joint in robot.joints)
        return [joint for joint in joints if joint.free and joint.freedoms == 1]


def _range(joint: Joint) -> tuple[float, float]:
    if joint.limits is not None:
        return joint.limits.lower, joint.limits.upper
    still = joint.neutral[0]
    return (still, still) if joint.kind == "prismatic" else (-math.pi, math.pi)


def _between(low: float, high: float, shares: Numbers) -> Numbers:
    drawn = [float(f"{value:.{_DIGITS}g}") for value in (low + shares * (high - low)).tolist()]
    values: Numbers = np.clip(drawn, low, high)
    return values


def _row(values: Mapping[str, tuple[Any, ...]], row: int) -> dict[str, Values]:
    """One of many poses. Numbers that are no array hold in all of them."""
    """One of many poses."""
    return {
        name: tuple(n if isinstance(n, float) else float(n[row]) for n in own)
        for name, own in values.items()
    }


class PoseBatch(Struct, frozen=True):
    """Some poses one after another. first: the number of the first one, from 1. joints: name of
    every joint that moves -> its numbers, an array over the poses each, or one for all. movable:
    these joints. pose: takes a row, and returns the pose as it was given or drawn."""

    first: int
    count: int
    joints: Mapping[str, tuple[Any, ...]]
    movable: Mapping[str, Joint]
    pose: Callable[[int], Pose]

    def posture(self, row: int) -> Posture:
        return posture_of(self.movable, _row(self.joints, row), self.pose(row))

    def matrices(self, scene: Scene) -> Numbers:
        """Shape (poses, bodies, 12): the upper three rows of the placement of each readable body,
        in the order of `Scene.bodies`. The same bits as those of `posed`."""
        return placements(scene, link_frames(scene, self.joints), self.count)


def placements(scene: Scene, frames: Sequence[Mapping[str, Transform]], count: int) -> Numbers:
    """See `PoseBatch.matrices`. frames: of the links in `count` poses."""
    of_links = body_poses(scene, frames)
    placed = np.empty((count, len(scene.bodies), 12))
    for k, body in enumerate(scene.bodies):
        placed[:, k] = rows_of(of_links.get(body.id, body.transform or IDENTITY), count)
    return placed


def rows_of(pose: Sequence[Any], count: int) -> Numbers:
    """The upper three rows of a pose, shape (count, 12). Its entries are numbers, or arrays over
    the poses."""
    rows = np.empty((count, 12))
    for entry in range(12):
        rows[:, entry] = pose[entry]
    return rows


def require_joints(scene: Scene, poses: Sequence[Pose]) -> None:
    """Raises what `settle` raises for any of the poses."""
    robots = [robot.robot for robot in scene.robots]
    for pose in [poses.fixed] if isinstance(poses, RandomPoses) else poses:
        check_names(robots, pose)


def pose_batches(scene: Scene, poses: Sequence[Pose], size: int) -> Iterator[PoseBatch]:
    """The poses, at most `size` at a time; see `require_joints`."""
    robots = [robot.robot for robot in scene.robots]
    movable = movable_joints(robots)
    if isinstance(poses, RandomPoses):
        for start, named in poses.batches(size):
            count = min(size, len(poses) - start)
            joints = complete(robots, named)
            yield PoseBatch(start + 1, count, joints, movable, partial(_row, named))
        return
    standing = complete(robots, {})
    for start in range(0, len(poses), size):
        given = poses[start : start + size]
        named = {
            name: tuple(np.array([pose.get(name, standing[name]) for pose in given]).T.copy())
            for name in dict.fromkeys(name for pose in given for name in pose)
        }
        joints = complete(robots, named)
        yield PoseBatch(start + 1, len(given), joints, movable, given.__getitem__)
