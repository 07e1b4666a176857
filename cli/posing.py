"""The poses of the robots of a scene, from --pose, --state, --path, --sample and --seed.

Apart from `cli.inputs`, because it imports the readers of robots, and these numpy.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import click

from satcheck.cli.inputs import Inputs
from satcheck.scene import Scene
from satcheck.scene.robot import (
    Pose,
    RandomPoses,
    pose_of_states,
    posed,
    read_path,
    read_poses,
    with_joint_path,
)


def poses_of(scene: Scene, inputs: Inputs) -> Sequence[Pose] | Pose:
    """A pose, or a sequence of poses where several or random ones are given, even if only one.

    UsageError for a combination that makes no sense; what is wrong with a pose is a SatcheckError.
    """
    if not scene.robots:
        raise click.UsageError("there is no robot to pose, nor a USD file with joints: give a URDF")
    if inputs.seed is not None and not inputs.sample:
        raise click.UsageError("--seed chooses among random poses: add --sample N")
    base = pose_of_states(scene, inputs.state)
    given = [read_poses(text) for text in inputs.pose]
    if inputs.sample:
        if len(given) > 1 or any(isinstance(poses, list) for poses in given):
            raise click.UsageError(
                "--sample draws random poses: give one --pose at most, whose joints stay"
            )
        held = {**base, **(given[0] if given and not isinstance(given[0], list) else {})}
        robots = [robot.robot for robot in scene.robots]
        return RandomPoses(robots, inputs.sample, inputs.random_seed or 0, held)
    if len(given) == 1 and not isinstance(given[0], list):
        return {**base, **given[0]}
    listed = [pose for poses in given for pose in (poses if isinstance(poses, list) else [poses])]
    return [{**base, **pose} for pose in listed] if listed else base


def on_path(scene: Scene, inputs: Inputs, file: str) -> Scene:
    """The scene with its robots at the start of the path of a file. Raises what `poses_of` does."""
    if inputs.sample or inputs.seed is not None:
        raise click.UsageError("--path sweeps given poses: leave out --sample and --seed")
    fixed = poses_of(scene, inputs)
    if not isinstance(fixed, Mapping):
        raise click.UsageError("--path takes one --pose at most, whose joints stay")
    return with_joint_path(scene, read_path(file), fixed)


def posed_once(scene: Scene, inputs: Inputs, several: str) -> Scene:
    """The scene in the one pose of the options, if there is any. several: the UsageError where they
    give more."""
    if not inputs.has_poses:
        return scene
    pose = poses_of(scene, inputs)
    if not isinstance(pose, Mapping):
        raise click.UsageError(several)
    return posed(scene, pose)
