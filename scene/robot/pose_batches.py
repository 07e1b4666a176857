"""Many poses of robots as arrays: the values of the joints, and the placements that follow."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np
from msgspec import Struct
from numpy.typing import NDArray

from satcheck.core.transform import Transform, compose
from satcheck.scene.bodies import IDENTITY, Scene
from satcheck.scene.robot.kinematics import link_poses
from satcheck.scene.robot.poses import Pose, Posture, check_names, complete, settle
from satcheck.scene.robot.sampling import ManyValues, RandomPoses, row_of

Numbers = NDArray[np.float64]


class PoseBatch(Struct, frozen=True):
    """Some poses one after another. first: the number of the first one, from 1. joints: name of
    every joint that moves -> its numbers, an array over the poses each, or one for all. given: the
    poses as they were given; None: `named` has them."""

    first: int
    count: int
    joints: Mapping[str, tuple[Any, ...]]
    given: Sequence[Pose] | None = None
    named: Mapping[str, ManyValues] = {}

    def pose(self, row: int) -> Pose:
        return row_of(self.named, row) if self.given is None else self.given[row]

    def posture(self, scene: Scene, row: int) -> Posture:
        return settle([robot.robot for robot in scene.robots], self.pose(row))

    def matrices(self, scene: Scene) -> Numbers:
        """Shape (poses, bodies, 12): the upper three rows of the placement of each readable body,
        in the order of `Scene.bodies`. The same bits as those of `posed`."""
        return placements(scene, link_frames(scene, self.joints), self.count)


def link_frames(scene: Scene, joints: Mapping[str, Any]) -> list[dict[str, Transform]]:
    """Of each robot: link -> its pose, whose entries are arrays where those of the joints are."""
    return [link_poses(robot.robot, joints) for robot in scene.robots]


def placements(scene: Scene, frames: Sequence[Mapping[str, Transform]], count: int) -> Numbers:
    """See `PoseBatch.matrices`. frames: of the links in `count` poses."""
    of_links = {
        body.id: compose(links[body.link], body.offset)
        for robot, links in zip(scene.robots, frames, strict=True)
        for body in robot.bodies
    }
    placed = np.empty((count, len(scene.bodies), 12))
    for k, body in enumerate(scene.bodies):
        matrix = of_links.get(body.id, body.transform or IDENTITY)
        for entry in range(12):
            placed[:, k, entry] = matrix[entry]
    return placed


def require_joints(scene: Scene, poses: Sequence[Pose]) -> None:
    """Raises what `settle` raises for any of the poses."""
    robots = [robot.robot for robot in scene.robots]
    for pose in [poses.fixed] if isinstance(poses, RandomPoses) else poses:
        check_names(robots, pose)


def pose_batches(scene: Scene, poses: Sequence[Pose], size: int) -> Iterator[PoseBatch]:
    """The poses, at most `size` at a time; see `require_joints`."""
    robots = [robot.robot for robot in scene.robots]
    if isinstance(poses, RandomPoses):
        for start, named in poses.batches(size):
            count = min(size, len(poses) - start)
            yield PoseBatch(start + 1, count, complete(robots, named), named=named)
        return
    for start in range(0, len(poses), size):
        given = poses[start : start + size]
        settled = [settle(robots, pose).joints for pose in given]
        joints = {name: tuple(np.array([j[name] for j in settled]).T.copy()) for name in settled[0]}
        yield PoseBatch(start + 1, len(given), joints, given)
