"""Completes poses of robots, checks them, and places bodies in them.

Joints without a value stand at 0. If 0 is beyond its limits, a joint of a URDF stands at the nearer
limit.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from functools import cached_property, partial
from typing import Any

import numpy as np
from msgspec import Struct
from msgspec.structs import replace
from numpy.typing import NDArray

from satcheck.core.errors import SatcheckError
from satcheck.core.transform import Transform
from satcheck.scene.bodies import IDENTITY, Body, Scene
from satcheck.scene.issue import Issue, issue
from satcheck.scene.robot.kinematics import Numbers, link_frames, placements
from satcheck.scene.robot.model import Joint, Robot, State, Values
from satcheck.scene.robot.poses import Pose, RandomPoses, pose_at, values_of
from satcheck.scene.words import meant

# A given value of a mimic joint may differ from the computed one by this: states are written with
# few decimals.
_SAME = 1e-6


class Posture(Struct, frozen=True):
    """A complete pose.

    joints: name of every joint that moves -> its value. issues: about the pose. mimics: the joints
    whose values follow from other joints.
    """

    joints: dict[str, Values]
    mimics: frozenset[str] = frozenset()
    issues: tuple[Issue, ...] = ()

    def pose(self) -> dict[str, float | list[float]]:
        """The pose as JSON values. Settling it gives this posture again."""
        return {
            name: values[0] if len(values) == 1 else list(values)
            for name, values in self.joints.items()
            if name not in self.mimics
        }


class Joints:
    """The joints of these robots by name. movable: those that have a value."""

    def __init__(self, robots: Iterable[Robot]) -> None:
        self._owners: dict[str, list[str]] = {}
        self.movable: dict[str, Joint] = {}
        for robot in robots:
            for joint in robot.joints:
                self._owners.setdefault(joint.name, []).append(robot.name)
                if joint.freedoms:
                    self.movable[joint.name] = joint
        self._mimics = frozenset(name for name, joint in self.movable.items() if joint.mimic)

    def check(self, pose: Pose) -> None:
        """Raise SatcheckError (`bad-pose`) if a joint is unknown, is fixed, exists in two robots,
        or has a wrong count of numbers."""
        for name, values in pose.items():
            fault = self._fault(name, values)
            if fault is not None:
                raise SatcheckError("bad-pose", fault)

    def _fault(self, name: str, values: Values) -> str | None:
        owners = self._owners.get(name, [])
        if not owners:
            return f"unknown joint {name!r}{meant(name, self.movable)}"
        if len(owners) > 1:
            return f"joint {name!r}: robots {' and '.join(owners)} have it"
        if name not in self.movable:
            return f"joint {name!r} does not move: it has no value"
        joint = self.movable[name]
        if len(values) != joint.freedoms:
            number = "1 number" if joint.freedoms == 1 else f"{joint.freedoms} numbers"
            return f"joint {name!r} ({joint.kind}) takes {number}, not {len(values)}"
        if joint.kind in ("ball", "free") and not any(values[-4:]):
            return f"joint {name!r}: a quaternion of length 0"
        return None

    def complete(self, named: Mapping[str, Numbers]) -> dict[str, Numbers]:
        """Return the values of all joints that move, where these are named."""
        values = {}
        for name, joint in self.movable.items():
            values[name] = named[name] if name in named else values_of(_rest(joint))
        return {name: self._followed(joint, values) for name, joint in self.movable.items()}

    def _followed(self, joint: Joint, values: Mapping[str, Numbers]) -> Numbers:
        if joint.mimic is None:
            return values[joint.name]
        leader = self.movable.get(joint.mimic.joint)  # None: a fixed joint, which stands at 0
        led = values_of((0.0,)) if leader is None else self._followed(leader, values)
        return joint.mimic.multiplier * led + joint.mimic.offset

    def remarkable(
        self, values: Mapping[str, Numbers], named: Collection[str], count: int
    ) -> NDArray[np.bool_]:
        """Return of each of these poses whether there may be an issue about it. values: of all
        joints that move; named: those that any of the poses names."""
        some = np.zeros(count, bool)
        for name, joint in self.movable.items():
            some |= joint.mimic is not None and name in named
            if joint.limits is not None:
                at, rest = values[name][0], _rest(joint)[0]
                some |= (at < joint.limits.lower) | (at > joint.limits.upper)
                some |= (at == rest) & (rest != 0)
        return some

    def posture(self, joints: dict[str, Values], pose: Pose) -> Posture:
        """Return the posture with these values of all joints that move, of which the pose names
        some. A value beyond the limits is kept, with a warning."""
        return Posture(joints, self._mimics, tuple(self._issues(joints, pose)))

    def _issues(self, joints: Mapping[str, Values], pose: Pose) -> Iterator[Issue]:
        moved = [(repr(name), joint, joints[name][0]) for name, joint in self.movable.items()]
        for name, joint, value in moved:
            limited = joint.limits is not None and joint.mimic is None and not joint.stands_at_zero
            if limited and value and joint.name not in pose:
                message = f"joint {name}: 0 is beyond its limits, so it stands at {value:g}"
                yield issue("not-at-zero", message)
        for name, joint, value in moved:
            given = pose.get(joint.name)
            if joint.mimic is not None and given is not None and abs(given[0] - value) > _SAME:
                message = (
                    f"joint {name} follows {joint.mimic.joint!r} and stands at {value:g}, "
                    f"not at {given[0]:g} as the pose says"
                )
                yield issue("mimic-differs", message)
        for name, joint, value in moved:
            if joint.limits is None:
                continue
            low, high = joint.limits.lower, joint.limits.upper
            excess = max(low - value, value - high)
            if excess > 0:
                message = (
                    f"joint {name}: {value:g} is beyond its limits {low:g} .. {high:g} "
                    f"by {excess:.3g}: checked there all the same"
                )
                yield issue("beyond-limits", message)


class PoseBatch:
    """Some poses of a scene one after another. first: the number of the first one, from 1. values:
    of every joint that moves. named: the joints that any of the poses names. pose: takes a row, and
    returns the pose as it was given or drawn."""

    def __init__(
        self,
        scene: Scene,
        first: int,
        count: int,
        named: Mapping[str, Numbers],
        joints: Joints,
        pose: Callable[[int], Pose],
    ) -> None:
        self._scene, self._joints, self._named = scene, joints, named
        self.first, self.count, self.pose = first, count, pose
        self.values = joints.complete(named)

    def posture(self, row: int) -> Posture:
        return self._joints.posture(pose_at(self.values, row), self.pose(row))

    def stated(self, row: int) -> dict[str, float | list[float]]:
        """See `Posture.pose`."""
        names, rows = self._stated
        return dict(zip(names, rows[row], strict=True))

    @cached_property
    def _stated(self) -> tuple[list[str], list[tuple[Any, ...]]]:
        names = [name for name in self.values if self._joints.movable[name].mimic is None]
        columns = [range(self.count)]
        for own in map(self.values.__getitem__, names):
            column = np.broadcast_to(own, (len(own), self.count))
            columns.append((column[0] if len(own) == 1 else column.T).tolist())
        return names, [row[1:] for row in zip(*columns, strict=True)]

    def issues(self, row: int) -> tuple[Issue, ...]:
        """See `Posture.issues`."""
        return self.posture(row).issues if self._remarkable[row] else ()

    @cached_property
    def _remarkable(self) -> NDArray[np.bool_]:
        return self._joints.remarkable(self.values, self._named, self.count)

    @cached_property
    def matrices(self) -> Numbers:
        """See `placements`."""
        return placements(self._scene, link_frames(self._scene, self.values), self.count)

    def transforms(self, row: int) -> Iterator[tuple[Body, Transform | None]]:
        """Yield each readable body with its transform in this pose; None: it has not moved."""
        for body, rows in zip(self._scene.bodies, self.matrices[row].tolist(), strict=True):
            transform = (*rows, 0.0, 0.0, 0.0, 1.0)
            yield body, None if transform == (body.transform or IDENTITY) else transform

    def posed(self, row: int) -> Scene:
        """The scene with its robots in this pose; see `posed`."""
        scene, posture = self._scene, self.posture(row)
        bodies = [
            body if transform is None else replace(body, transform=transform)
            for body, transform in self.transforms(row)
        ]
        earlier = scene.posture.issues if scene.posture else ()
        issues = (*(remark for remark in scene.issues if remark not in earlier), *posture.issues)
        return replace(scene, bodies=tuple(bodies), issues=issues, posture=posture)


def pose_batches(scene: Scene, poses: Sequence[Pose], size: int) -> Iterator[PoseBatch]:
    """Yield the poses, at most `size` at a time. Raises what `Joints.check` raises for any of them
    before the first batch."""
    joints = Joints(robot.robot for robot in scene.robots)
    for pose in [poses.fixed] if isinstance(poses, RandomPoses) else poses:
        joints.check(pose)
    if isinstance(poses, RandomPoses):
        for start, named in poses.batches(size):
            count, drawn = min(size, len(poses) - start), partial(pose_at, named)
            yield PoseBatch(scene, start + 1, count, named, joints, drawn)
        return
    for start in range(0, len(poses), size):
        given = poses[start : start + size]
        named = {}
        for name in dict.fromkeys(name for pose in given for name in pose):
            rest = _rest(joints.movable[name])
            named[name] = np.array([pose.get(name, rest) for pose in given]).T.copy()
        yield PoseBatch(scene, start + 1, len(given), named, joints, given.__getitem__)


def settle(robots: Iterable[Robot], pose: Pose) -> Posture:
    """Return the complete pose of these robots. Raises what `Joints.check` raises."""
    joints = Joints(robots)
    joints.check(pose)
    values = joints.complete({name: values_of(own) for name, own in pose.items()})
    return joints.posture(pose_at(values, 0), pose)


def posed(scene: Scene, pose: Pose) -> Scene:
    """The scene with its robots in this pose: new transforms, the same meshes. Bodies that do not
    move are the same objects.

    pose: joint -> values; `settle` says what happens to other joints, and which values are refused.
    The result has the complete posture and the issues about it.
    """
    return next(pose_batches(scene, [pose], 1)).posed(0)


def pose_of_states(scene: Scene, names: Iterable[str]) -> Pose:
    """The named states combined. Raises SatcheckError if two give a joint different values, or if a
    state names a joint that the robots do not have."""
    states = [state for robot in scene.robots for state in robot.states]
    joints = Joints(robot.robot for robot in scene.robots)
    pose: dict[str, Values] = {}
    for name in names:
        state = state_named(name, states)
        for joint, values in state.joints.items():
            try:
                joints.check({joint: values})
            except SatcheckError as error:
                line = f"line {state.lines[joint]}: " if joint in state.lines else ""
                message = f"{line}state {state.name!r}: {error.message}"
                raise SatcheckError(error.code, message, file=state.file) from None
            if pose.setdefault(joint, values) != values:
                message = (
                    f"two states give joint {joint!r} different values: together they are one "
                )
                message += "pose; --pose takes several, and --path sweeps through them"
                raise SatcheckError("bad-pose", message)
    return pose


def state_named(name: str, states: Sequence[State]) -> State:
    """The state of that name, "group/name" where groups share it. Raises SatcheckError."""
    matches = [state for state in states if name in (state.name, f"{state.group}/{state.name}")]
    if len(matches) == 1:
        return matches[0]
    if matches:
        choices = ", ".join(f"{state.group}/{state.name}" for state in matches)
        raise SatcheckError("bad-pose", f"several groups have a state {name!r}: {choices}")
    names = ", ".join(dict.fromkeys(state.name for state in states))
    none = "no SRDF with a <group_state>, and no MJCF with a <key>, was given"
    has = f"the states are {names}" if states else none
    raise SatcheckError("bad-pose", f"no state {name!r}: {has}")


def _rest(joint: Joint) -> Values:
    if joint.limits is None or joint.stands_at_zero:
        return joint.neutral
    return (min(max(0.0, joint.limits.lower), joint.limits.upper),)
