"""Random poses: a value in its range for each joint that moves. A seed fixes the sequence."""

from __future__ import annotations

import math
import random
from collections.abc import Iterator, Mapping, Sequence
from typing import overload

import numpy as np
from numpy.typing import NDArray

from satcheck.scene.robot.model import Joint, Robot
from satcheck.scene.robot.poses import Pose

# Significant digits of a value. A user can then read and retype a pose; the rounded pose is the one
# that is checked.
_DIGITS = 6
# Values of other sizes are rounded one by one, and so is a value this close to the middle of two
# rounded ones, in units of the last digit.
_PLAIN = (1e-9, 1e9)
_NEAR_MIDDLE = 1e-6
# Poses that are drawn at a time where they are taken one by one.
_DRAWN = 1024

# Powers of ten that are exact in float64.
_POWERS = np.array([float(f"1e{k}") for k in range(23)])

Numbers = NDArray[np.float64]
ManyValues = tuple[Numbers, ...]  # the value of a joint in many poses: an array for each number


def row_of(values: Mapping[str, ManyValues], row: int) -> Pose:
    """One of many poses."""
    return {name: tuple(float(number[row]) for number in own) for name, own in values.items()}


class RandomPoses(Sequence[Pose]):
    """`count` random poses, see `joint_samples`. They are drawn again each time they are visited,
    so that they need no memory. fixed: the values of joints that stay."""

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
                yield row_of(values, row)

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


def joint_samples(
    robots: Sequence[Robot], count: int, seed: int, fixed: Pose | None = None
) -> list[Pose]:
    """`count` poses, uniform within the limits. A rotating joint without limits is in [-pi, pi].

    Each value is rounded to six significant digits. A longer list starts with the poses of a
    shorter one. The poses are the same on every machine and version of Python. Joints in `fixed`
    keep those values. Sliding joints without limits, planar and floating joints stay at 0. Mimics
    follow their leaders.
    """
    return list(RandomPoses(robots, count, seed, fixed))


def _range(joint: Joint) -> tuple[float, float]:
    if joint.limits is not None:
        return joint.limits.lower, joint.limits.upper
    still = joint.neutral[0]
    return (still, still) if joint.kind == "prismatic" else (-math.pi, math.pi)


def _between(low: float, high: float, shares: Numbers) -> Numbers:
    values: Numbers = np.clip(_rounded(low + shares * (high - low)), low, high)
    return values


def _rounded(values: Numbers) -> Numbers:
    """To six significant digits, the same float64 as float(f"{value:.6g}").

    value = m / 10^k with an integer m of six digits. Both are exact in float64, so their quotient
    is rounded once.
    """
    sizes = np.abs(values)
    plain = (sizes >= _PLAIN[0]) & (sizes <= _PLAIN[1])
    digits = np.where(plain, sizes, 1.0)
    power = _DIGITS - 1 - np.floor(np.log10(digits)).astype(int)
    up, down = _POWERS[np.maximum(power, 0)], _POWERS[np.maximum(-power, 0)]
    scaled = digits * up / down
    result: Numbers = np.copysign(np.rint(scaled) / up * down, values)
    in_doubt = ~plain | (np.abs(scaled - np.floor(scaled) - 0.5) < _NEAR_MIDDLE)
    in_doubt |= (np.rint(scaled) < 10.0 ** (_DIGITS - 1)) | (scaled >= 10.0**_DIGITS - 1)
    for row in np.flatnonzero(in_doubt):
        result[row] = float(f"{float(values[row]):.{_DIGITS}g}")
    return result
