"""Reads the joints of SDFormat."""

from __future__ import annotations

import math
from typing import NamedTuple

from satcheck.core.conventions import Vector
from satcheck.plugins.sdf.frames import WORLD, Frames, Name, Scope
from satcheck.plugins.sdf.values import boolean, vector
from satcheck.scene.files.xml_tree import Element
from satcheck.scene.robot.joint_forest import Moves
from satcheck.scene.robot.kinematics import inverse
from satcheck.scene.robot.model import JointKind, Limits, Mimic
from satcheck.scene.robot.slips import Slips

UNLIMITED = 1e16  # SDFormat writes it for "no limit"
_KINDS: dict[str, JointKind] = {
    "revolute": "revolute",
    "continuous": "continuous",
    "prismatic": "prismatic",
    "fixed": "fixed",
}
# They have several axes, or axes that depend on each other.
_STILL = frozenset(("ball", "universal", "revolute2", "screw", "gearbox", "ball2"))
_LIMITED = ("revolute", "prismatic")
_Z: Vector = (0.0, 0.0, 1.0)  # the default axis
_JOINT_FRAME_SINCE = (1, 5)  # before, the axis was in the frame of the model


class JointEntry(NamedTuple):
    """A joint of the file. parent, child: frames. moves: its model is not static."""

    element: Element
    path: str
    scope: Scope
    version: tuple[int, ...]
    parent: Name
    child: Name
    moves: bool


def moves_of(joint: JointEntry, frames: Frames, slips: Slips) -> Moves:
    element = joint.element
    given = element.attribute("type")
    if given not in _KINDS and given not in _STILL:
        element.refuse(f"type {given!r} is none of {', '.join((*_KINDS, *sorted(_STILL)))}")
    if not joint.moves or given == "fixed":
        return Moves("fixed")
    axis = element.only("axis")
    if given in _STILL or axis is None:
        why = (
            f"a {given} joint is not moved" if axis or given in _STILL else "a joint has no <axis>"
        )
        slips.note("joint-not-moved", element, f"{why}: its links stay as the file places them")
        return Moves("fixed")
    kind = _KINDS[given]
    dynamics = axis.only("dynamics")
    spring = dynamics and [dynamics.only(tag) for tag in ("spring_stiffness", "spring_reference")]
    if spring and all(each and each.text_numbers(1)[0] for each in spring):
        cause = "a spring that rests elsewhere is not solved: joints stand where the pose says"
        slips.note("constraint-not-solved", axis, cause)
    return Moves(
        kind,
        _axis(axis, joint, frames),
        _limits(axis, kind, slips),
        _mimic(axis, joint, frames),
    )


def _axis(element: Element, joint: JointEntry, frames: Frames) -> Vector:
    """In the frame of the joint, scaled to length 1."""
    axis = vector(element, "xyz", _Z)
    length = math.hypot(*axis)
    if not (length > 0.0 and math.isfinite(length)):
        element.refuse("an axis of length 0" if length == 0.0 else "the axis is too long")
    frame = _frame_of_axis(element, joint, frames)
    if frame is not None:
        into = inverse(frames.world(joint.path))
        axis = _turned(into, _turned(frames.world(frame), axis))
    x, y, z = (c / length for c in axis)
    return x, y, z


def _frame_of_axis(element: Element, joint: JointEntry, frames: Frames) -> str | None:
    """The frame that states the axis; None: that of the joint."""
    xyz = element.only("xyz")
    text = xyz.attributes.get("expressed_in") if xyz else None
    if xyz and text:
        return frames.find(Name(joint.scope, text, xyz))
    early = joint.version < _JOINT_FRAME_SINCE
    return joint.scope.model if boolean(element, "use_parent_model_frame", early) else None


def _turned(pose: tuple[float, ...], v: Vector) -> Vector:
    x, y, z = (a * v[0] + b * v[1] + c * v[2] for a, b, c in (pose[0:3], pose[4:7], pose[8:11]))
    return x, y, z


def _limits(axis: Element, kind: JointKind, slips: Slips) -> Limits | None:
    limit = axis.only("limit")
    if kind not in _LIMITED or limit is None:
        return None
    lower, upper = _bound(limit, "lower", -UNLIMITED), _bound(limit, "upper", UNLIMITED)
    if lower <= -UNLIMITED and upper >= UNLIMITED:
        return None
    if lower > upper or lower <= -UNLIMITED or upper >= UNLIMITED:
        what = "lower is above upper" if lower > upper else "a limit on one side only"
        slips.note("no-limits", limit, f"{what}: treated as unlimited")
        return None
    return Limits(lower, upper)


def _bound(limit: Element, tag: str, default: float) -> float:
    child = limit.only(tag)
    if child is None or child.text.lower().strip("+-") in ("inf", "infinity", "1.#inf"):
        return default if child is None or child.text.startswith("-") == (default < 0) else -default
    return child.text_numbers(1)[0]


def _mimic(axis: Element, joint: JointEntry, frames: Frames) -> Mimic | None:
    """value = multiplier * (value of the leader - reference) + offset"""
    element = axis.only("mimic")
    if element is None:
        return None
    leader = frames.find(Name(joint.scope, element.attribute("joint"), element))
    if leader == WORLD or frames.element(leader).tag != "joint":
        element.refuse(f"mimics {leader!r}, which is no joint")
    multiplier, offset, reference = (
        child.text_numbers(1)[0] if (child := element.only(tag)) else default
        for tag, default in (("multiplier", 1.0), ("offset", 0.0), ("reference", 0.0))
    )
    return Mimic(leader, multiplier, offset - multiplier * reference)
