"""Reads poses of robots from JSON, completes them and checks them against the limits.

    {"joint": value, ...}          one pose; a list of such objects is several

A value is a number (radians; metres for a prismatic joint), or a list of numbers: [x, y, angle] for
a planar joint, [x, y, z, roll, pitch, yaw] for a floating one. Joints without a value stand at 0.
If 0 is beyond its limits, a joint of a URDF stands at the nearer limit.
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

from msgspec import Struct

from satcheck.core.errors import SatcheckError
from satcheck.scene.issue import Issue, issue
from satcheck.scene.opening import read_whole
from satcheck.scene.robot.model import Joint, Robot, State, Values
from satcheck.scene.words import meant, why_unreadable

Pose = Mapping[str, Values]
# A given value of a mimic joint may differ from the computed one by this: states are written with
# few decimals.
_SAME = 1e-6
_MAX_BYTES = 256 << 20


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


def read_poses(given: str) -> list[Pose] | Pose:
    """Poses from a JSON file, or from a JSON text that starts with { or [. Returns a list of poses
    or one pose, as in the text.

    Raises SatcheckError (`bad-pose`, or a code about the file).
    """
    text, file = (given, None) if given.lstrip()[:1] in ("{", "[") else (_text(given), given)
    try:
        document = json.loads(text, object_pairs_hook=_once)
    except json.JSONDecodeError as error:
        raise _bad(f"line {error.lineno}: not well-formed JSON: {error.msg}", file) from None
    except (RecursionError, ValueError) as error:
        raise _bad(why_unreadable(error), file) from None
    if isinstance(document, dict):
        return _pose(document, "the pose", file)
    if not isinstance(document, list) or not document:
        raise _bad('should be an object {"joint": value} or a list of such', file)
    return [_pose(pose, f"pose {k}", file) for k, pose in enumerate(document, 1)]


def state_named(name: str, states: Iterable[State]) -> State:
    """The state of that name, "group/name" where groups share it. Raises SatcheckError."""
    known = list(states)
    matches = [state for state in known if name in (state.name, f"{state.group}/{state.name}")]
    if len(matches) == 1:
        return matches[0]
    if matches:
        choices = ", ".join(f"{state.group}/{state.name}" for state in matches)
        raise SatcheckError("bad-pose", f"several groups have a state {name!r}: {choices}")
    names = ", ".join(dict.fromkeys(state.name for state in known))
    none = "no SRDF with a <group_state>, and no MJCF with a <key>, was given"
    has = f"the states are {names}" if known else none
    raise SatcheckError("bad-pose", f"no state {name!r}: {has}")


def check_state(state: State, robots: Sequence[Robot]) -> None:
    """Checks the joints of a state as `settle` does. Errors name the place in the SRDF."""
    movable = movable_joints(robots)
    for name, values in state.joints.items():
        try:
            _check_named(name, values, robots, movable)
        except SatcheckError as error:
            where = f"line {state.lines[name]}: state {state.name!r}"
            raise SatcheckError(error.code, f"{where}: {error.message}", file=state.file) from None


def settle(robots: Sequence[Robot], pose: Pose) -> Posture:
    """The complete pose of these robots.

    Raises SatcheckError (`bad-pose`) if a joint is unknown, is fixed, exists in two robots, or has
    a wrong count of numbers. A value beyond the limits is kept, with a warning.
    """
    check_names(robots, pose)
    return posture_of(movable_joints(robots), complete(robots, pose), pose)


def posture_of(movable: Mapping[str, Joint], joints: dict[str, Values], pose: Pose) -> Posture:
    """The posture with these values of all joints that move, of which the pose names some."""
    unnamed = [joint for name, joint in movable.items() if name not in pose]
    issues = [
        *(_not_at_zero(joint, joints[joint.name]) for joint in unnamed if joint.free),
        *(_mimic_differs(joint, joints, pose) for joint in movable.values() if joint.mimic),
        *(_beyond(joint, joints[name]) for name, joint in movable.items() if joint.limits),
    ]
    return Posture(
        joints=joints,
        mimics=frozenset(name for name, joint in movable.items() if joint.mimic),
        issues=tuple(each for each in issues if each is not None),
    )


def complete(robots: Sequence[Robot], named: Mapping[str, Any]) -> dict[str, Any]:
    """The values of all joints that move, where these are named. The numbers may be arrays over
    many poses; those of joints that no pose names are single ones."""
    movable = movable_joints(robots)
    joints = {
        joint.name: named[joint.name] if joint.name in named else _rest(joint)
        for joint in movable.values()
        if joint.free
    }
    for joint in movable.values():
        if joint.mimic is not None:
            joints[joint.name] = (_mimicked(joint, movable, joints),)
    return {name: joints[name] for name in movable}


def check_names(robots: Sequence[Robot], pose: Pose) -> None:
    """Raises what `settle` raises."""
    movable = movable_joints(robots)
    for name, values in pose.items():
        _check_named(name, values, robots, movable)


def movable_joints(robots: Sequence[Robot]) -> dict[str, Joint]:
    return {joint.name: joint for robot in robots for joint in robot.joints if joint.freedoms}


def _text(path: str) -> str:
    try:
        return read_whole(path, Path(path), _MAX_BYTES).decode("utf-8-sig")
    except UnicodeDecodeError:
        raise SatcheckError("bad-encoding", "the file of poses is not UTF-8", file=path) from None
    except SatcheckError as error:
        hint = '; values themselves are written {"joint": value}' if "=" in path else ""
        raise SatcheckError(error.code, error.message + hint, file=path) from None


def _once(members: list[tuple[str, Any]]) -> dict[str, Any]:
    values = dict(members)
    if len(values) < len(members):
        raise ValueError("a joint is named twice in one pose")
    return values


def _pose(document: Any, what: str, file: str | None) -> Pose:
    if not isinstance(document, dict):
        raise _bad(f'{what} should be an object {{"joint": value}}', file)
    return {name: _values(name, value, what, file) for name, value in document.items()}


def _values(name: str, value: Any, what: str, file: str | None) -> Values:
    numbers = value if isinstance(value, list) else [value]
    if not numbers or not all(type(number) in (int, float) for number in numbers):
        raise _bad(f"{what}: joint {name!r}: should be a number or a list of numbers", file)
    try:
        values = tuple(float(number) for number in numbers)
    except OverflowError:
        values = (math.inf,)
    if not all(map(math.isfinite, values)):
        raise _bad(f"{what}: joint {name!r}: is not finite", file)
    return values


def _bad(message: str, file: str | None) -> SatcheckError:
    return SatcheckError("bad-pose", message if file else f"--pose: {message}", file=file)


def _check_named(
    name: str, values: Values, robots: Sequence[Robot], movable: Mapping[str, Joint]
) -> None:
    owners = [robot.name for robot in robots if robot.joint(name) is not None]
    if not owners:
        raise SatcheckError("bad-pose", f"unknown joint {name!r}{meant(name, movable)}")
    if len(owners) > 1:
        raise SatcheckError("bad-pose", f"joint {name!r}: robots {' and '.join(owners)} have it")
    if name not in movable:
        raise SatcheckError("bad-pose", f"joint {name!r} does not move: it has no value")
    wanted = movable[name].freedoms
    if len(values) != wanted:
        number = "1 number" if wanted == 1 else f"{wanted} numbers"
        kind = movable[name].kind
        raise SatcheckError(
            "bad-pose", f"joint {name!r} ({kind}) takes {number}, not {len(values)}"
        )
    if movable[name].kind in ("ball", "free") and not any(values[-4:]):
        raise SatcheckError("bad-pose", f"joint {name!r}: a quaternion of length 0")


def _rest(joint: Joint) -> Values:
    if joint.limits is None or joint.stands_at_zero:
        return joint.neutral
    return (min(max(0.0, joint.limits.lower), joint.limits.upper),)


def _not_at_zero(joint: Joint, values: Values) -> Issue | None:
    if joint.limits is None or joint.stands_at_zero or not values[0]:
        return None
    message = f"joint {joint.name!r}: 0 is beyond its limits, so it stands at {values[0]:g}"
    return issue("not-at-zero", message)


def _mimic_differs(joint: Joint, joints: Mapping[str, Values], pose: Pose) -> Issue | None:
    value, given = joints[joint.name][0], pose.get(joint.name)
    if given is None or abs(given[0] - value) <= _SAME:
        return None
    leader = joint.mimic.joint if joint.mimic else ""
    message = (
        f"joint {joint.name!r} follows {leader!r} and stands at {value:g}, "
        f"not at {given[0]:g} as the pose says"
    )
    return issue("mimic-differs", message)


def _mimicked(joint: Joint, movable: Mapping[str, Joint], joints: Mapping[str, Values]) -> float:
    mimic = joint.mimic
    if mimic is None:
        return joints[joint.name][0]
    leader = movable.get(mimic.joint)  # None: a fixed joint, which stands at 0
    led = 0.0 if leader is None else _mimicked(leader, movable, joints)
    return mimic.multiplier * led + mimic.offset


def _beyond(joint: Joint, values: Values) -> Issue | None:
    if joint.limits is None:
        return None
    low, high = joint.limits.lower, joint.limits.upper
    excess = max(low - values[0], values[0] - high)
    if excess <= 0:
        return None
    message = (
        f"joint {joint.name!r}: {values[0]:g} is beyond its limits {low:g} .. {high:g} "
        f"by {excess:.3g}: checked there all the same"
    )
    return issue("beyond-limits", message)
