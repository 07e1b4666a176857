"""A path of robots: poses one after another, and between two of them each joint moves steadily.

A key or a column `time`, in all poses or in none, gives the time of each pose.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import pairwise

import numpy as np
from msgspec import Struct
from msgspec.structs import replace

from satcheck.core.errors import SatcheckError
from satcheck.scene.bodies import Scene
from satcheck.scene.robot.kinematics import Numbers
from satcheck.scene.robot.poses import Pose, pose_at
from satcheck.scene.robot.postures import Posture, pose_batches, posed

TIME = "time"
# Joints whose numbers are no coordinates, or whose turns do not add up.
_NOT_STEADY = ("floating", "ball", "free")


class JointPath(Struct, frozen=True):
    """times: of the poses, increasing from 0 to 1. values: joint -> its numbers, shape (numbers,
    poses), for every joint that moves or stands. moving: the joints whose values change. mimics:
    the joints whose values follow from other joints."""

    times: Numbers
    values: Mapping[str, Numbers]
    moving: frozenset[str]
    mimics: frozenset[str] = frozenset()

    def at(self, times: Numbers) -> dict[str, Numbers]:
        """The values of all joints at these times."""
        return {
            name: np.array([np.interp(times, self.times, own) for own in numbers])
            for name, numbers in self.values.items()
        }

    def pose(self, time: float) -> dict[str, float | list[float]]:
        """The pose at a time as JSON values."""
        return Posture(pose_at(self.at(np.array([time])), 0), self.mimics).pose()

    def poses_around(self, time: float) -> tuple[int, int]:
        """The numbers, from 1, of the poses between which the robots are at this time."""
        after = int(np.clip(np.searchsorted(self.times, time), 1, len(self.times) - 1))
        return after, after + 1


def with_joint_path(scene: Scene, poses: Sequence[Pose], fixed: Pose | None = None) -> Scene:
    """The scene with its robots in the first pose, and the path. fixed: values of joints that the
    poses do not name.

    Raises SatcheckError (`bad-pose`) for a path that no robot can follow, and what `posed` raises.
    """
    if len(poses) < 2:
        raise SatcheckError("bad-pose", "a path needs two poses at least")
    joints = [joint for robot in scene.robots for joint in robot.robot.joints]
    timed, times = _times(poses, any(joint.name == TIME for joint in joints))
    given = [{**(fixed or {}), **pose} for pose in timed]
    (batch,) = pose_batches(scene, given, len(given))
    values = {
        name: np.broadcast_to(own, (len(own), len(given))) for name, own in batch.values.items()
    }
    moving = frozenset(name for name, own in values.items() if (own != own[:, :1]).any())
    for joint in joints:
        if joint.name in moving and joint.kind in _NOT_STEADY:
            raise SatcheckError(
                "bad-pose", f"joint {joint.name!r} ({joint.kind}) cannot move along a path"
            )
    postures = list(map(batch.posture, range(len(given))))
    placed = posed(scene, given[0])
    issues = dict.fromkeys((*placed.issues, *(i for posture in postures for i in posture.issues)))
    path = JointPath(times, values, moving, postures[0].mimics)
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
