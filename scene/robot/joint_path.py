"""A path of robots: poses one after another, and between two of them each joint moves steadily.

A file of poses is a JSON list of {"joint": value}, as for `--pose`, or a CSV table with a column
for each joint. A key or a column `time`, in all poses or in none, gives the time of each pose.
"""

from __future__ import annotations

import csv
import math
from collections.abc import Mapping, Sequence
from itertools import pairwise
from pathlib import Path

import numpy as np
from msgspec import Struct
from msgspec.structs import replace
from numpy.typing import NDArray

from satcheck.core.errors import SatcheckError
from satcheck.scene.bodies import Scene
from satcheck.scene.opening import read_whole
from satcheck.scene.robot.assembly import posed
from satcheck.scene.robot.poses import Pose, Posture, read_poses, settle

TIME = "time"
# Joints whose numbers are no coordinates, or whose turns do not add up.
_NOT_STEADY = ("floating", "ball", "free")
_MAX_BYTES = 256 << 20

Numbers = NDArray[np.float64]


class JointPath(Struct, frozen=True):
    """times: of the poses, increasing from 0 to 1. values: joint -> its numbers, an array over the
    poses each, for every joint that moves or stands. moving: the joints whose values change.
    mimics: the joints whose values follow from other joints."""

    times: Numbers
    values: Mapping[str, tuple[Numbers, ...]]
    moving: frozenset[str]
    mimics: frozenset[str] = frozenset()

    def at(self, times: Numbers) -> dict[str, tuple[Numbers, ...]]:
        """The values of all joints at these times."""
        return {
            name: tuple(np.interp(times, self.times, own) for own in numbers)
            for name, numbers in self.values.items()
        }

    def pose(self, time: float) -> dict[str, float | list[float]]:
        """The pose at a time as JSON values."""
        values = {
            name: tuple(float(number[0]) for number in numbers)
            for name, numbers in self.at(np.array([time])).items()
        }
        return Posture(values, self.mimics).pose()

    def poses_around(self, time: float) -> tuple[int, int]:
        """The numbers, from 1, of the poses between which the robots are at this time."""
        after = int(np.clip(np.searchsorted(self.times, time), 1, len(self.times) - 1))
        return after, after + 1


def read_path(file: str) -> list[Pose]:
    """The poses of a JSON or CSV file, or of a JSON text; `time` is a joint of each.

    Raises SatcheckError (`bad-pose`, or a code about the file).
    """
    if file.lower().endswith(".csv"):
        return _read_table(file)
    poses = read_poses(file)
    if isinstance(poses, Mapping):
        raise SatcheckError("bad-pose", "a path is a list of poses: [{...}, {...}]", file=file)
    return poses


def with_joint_path(scene: Scene, poses: Sequence[Pose], fixed: Pose | None = None) -> Scene:
    """The scene with its robots in the first pose, and the path. fixed: values of joints that the
    poses do not name.

    Raises SatcheckError (`bad-pose`) for a path that no robot can follow, and what `posed` raises.
    """
    if len(poses) < 2:
        raise SatcheckError("bad-pose", "a path needs two poses at least")
    robots = [robot.robot for robot in scene.robots]
    timed, times = _times(poses, any(robot.joint(TIME) for robot in robots))
    settled = [settle(robots, {**(fixed or {}), **pose}) for pose in timed]
    values = {
        name: tuple(np.array([posture.joints[name] for posture in settled]).T.copy())
        for name in settled[0].joints
    }
    moving = frozenset(
        name for name, own in values.items() if any((number != number[0]).any() for number in own)
    )
    for joint in (joint for robot in robots for joint in robot.joints if joint.name in moving):
        if joint.kind in _NOT_STEADY:
            raise SatcheckError(
                "bad-pose", f"joint {joint.name!r} ({joint.kind}) cannot move along a path"
            )
    placed = posed(scene, {**(fixed or {}), **timed[0]})
    issues = dict.fromkeys((*placed.issues, *(i for posture in settled for i in posture.issues)))
    path = JointPath(times, values, moving, settled[0].mimics)
    return replace(placed, issues=tuple(issues), joint_path=path)


def _times(poses: Sequence[Pose], is_joint: bool) -> tuple[list[Pose], Numbers]:
    """The poses without their times, and the times from 0 to 1."""
    stated = [] if is_joint else [pose[TIME] for pose in poses if TIME in pose]
    if not stated:
        return list(poses), np.linspace(0.0, 1.0, len(poses))
    if len(stated) < len(poses) or any(len(time) != 1 for time in stated):
        raise SatcheckError("bad-pose", "each pose of a path needs a time, or none does")
    seconds = [time[0] for time in stated]
    for number, (earlier, later) in enumerate(pairwise(seconds), 2):
        if later <= earlier:
            message = f"pose {number}: the times must increase, and {later:g} follows {earlier:g}"
            raise SatcheckError("bad-pose", message)
    times = (np.array(seconds) - seconds[0]) / (seconds[-1] - seconds[0])
    if not (np.diff(times) > 0).all():
        raise SatcheckError("bad-pose", "the times of a path differ too little from each other")
    without: list[Pose] = [
        {name: own for name, own in pose.items() if name != TIME} for pose in poses
    ]
    return without, times


def _read_table(file: str) -> list[Pose]:
    try:
        text = read_whole(file, Path(file), _MAX_BYTES).decode("utf-8-sig")
    except UnicodeDecodeError:
        raise SatcheckError("bad-encoding", "the table of poses is not UTF-8", file=file) from None
    head = text.partition("\n")[0]
    separator = next((mark for mark in (",", ";", "\t") if mark in head), ",")
    rows = csv.reader(text.splitlines(), delimiter=separator, skipinitialspace=True)
    lines = [(number, [cell.strip() for cell in row]) for number, row in enumerate(rows, 1)]
    filled = [(number, row) for number, row in lines if any(row)]
    if len(filled) < 3:
        message = "a path needs a line with the names of joints, and two lines of values below it"
        raise SatcheckError("bad-pose", message, file=file)
    first, names = filled[0]
    if len(set(names)) < len(names) or not all(names):
        message = f"line {first}: a column has no name, or two have one"
        raise SatcheckError("bad-pose", message, file=file)
    return [_row(names, row, f"line {number}", file) for number, row in filled[1:]]


def _row(names: Sequence[str], row: Sequence[str], where: str, file: str) -> Pose:
    if len(row) != len(names):
        message = f"{where}: {len(row)} values for {len(names)} columns"
        raise SatcheckError("bad-pose", message, file=file)
    return {
        name: (_number(cell, f"{where}: {name}", file),)
        for name, cell in zip(names, row, strict=True)
    }


def _number(cell: str, where: str, file: str) -> float:
    try:
        value = float(cell)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise SatcheckError("bad-pose", f"{where}: {cell!r} is no finite number", file=file)
    return value
