"""From --pose, --state, --sample and --seed to poses of a scene's robots."""

from __future__ import annotations

from typing import TYPE_CHECKING

from satcheck.cli.refusals import wrong_usage
from satcheck.core.frozen import frozen

if TYPE_CHECKING:
    from satcheck.scene import Scene
    from satcheck.scene.robot import Pose


@frozen
class Posing:
    """The options of the command line."""

    pose: tuple[str, ...] = ()
    state: tuple[str, ...] = ()
    sample: int | None = None
    seed: int | None = None

    @property
    def given(self) -> bool:
        return bool(self.pose or self.state or self.sample or self.seed is not None)

    @property
    def random_seed(self) -> int | None:
        """Of the random poses, if there are any."""
        return (self.seed or 0) if self.sample else None


def poses_of(scene: Scene, asked: Posing) -> list[Pose] | Pose:
    """A pose, or a list of poses where several or random ones are given, even if it has only one.

    UsageError for a combination that makes no sense; what is wrong with a pose is a SatcheckError.
    """
    from satcheck.scene.robot import joint_samples, pose_of_states, read_poses

    if not scene.robots:
        raise wrong_usage("there is no robot to pose: give a URDF")
    if asked.seed is not None and not asked.sample:
        raise wrong_usage("--seed chooses among random poses: add --sample N")
    base = pose_of_states(scene, asked.state)
    read = [read_poses(given) for given in asked.pose]
    if asked.sample:
        if len(read) > 1 or any(isinstance(one, list) for one in read):
            raise wrong_usage(
                "--sample draws random poses: give one --pose at most, whose joints stay"
            )
        fixed = {**base, **(read[0] if read and not isinstance(read[0], list) else {})}
        robots = [robot.robot for robot in scene.robots]
        return joint_samples(robots, asked.sample, asked.random_seed or 0, fixed)
    if len(read) == 1 and not isinstance(read[0], list):
        return {**base, **read[0]}
    listed = [pose for one in read for pose in (one if isinstance(one, list) else [one])]
    return [{**base, **pose} for pose in listed] if listed else base
