"""Reads the joints of SDFormat."""

from __future__ import annotations

from typing import NamedTuple

from satcheck.core.conventions import Vector
from satcheck.plugins.sdf.elements import boolean, number, numbers
from satcheck.plugins.sdf.frames import WORLD, Frames, Name, Scope
from satcheck.scene.files.xml_tree import Element
from satcheck.scene.robot.elements import unit_axis
from satcheck.scene.robot.kinematics import inverse
from satcheck.scene.robot.model import Joint, JointKind, Limits, Mimic
from satcheck.scene.robot.slips import Slips

UNLIMITED = 1e16  # SDFormat writes it for "no limit"
_KINDS: tuple[JointKind, ...] = ("revolute", "continuous", "prismatic", "fixed")
# They have several axes, or axes that depend on each other.
_STILL = ("ball", "ball2", "gearbox", "revolute2", "screw", "universal")
_LIMITED = ("revolute", "prismatic")
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


def joint_of(joint: JointEntry, parent: str, child: str, frames: Frames, slips: Slips) -> Joint:
    """Return the joint between two links, or a link and the world, at its pose in the world."""
    element = joint.element
    still = Joint(joint.path, "fixed", parent, child, frames.world(joint.path))
    given = element.attribute("type")
    kind = next((kind for kind in _KINDS if kind == given), None)
    if kind is None and given not in _STILL:
        element.refuse(f"type {given!r} is none of {', '.join((*_KINDS, *_STILL))}")
    if not joint.moves or kind == "fixed":
        return still
    axis = element.only("axis")
    if kind is None or axis is None:
        why = "a joint has no <axis>" if kind else f"a {given} joint is not moved"
        slips.note("joint-not-moved", element, f"{why}: its links stay as the file places them")
        return still
    dynamics = axis.only("dynamics")
    if dynamics and all(
        number(dynamics, tag, 0.0) for tag in ("spring_stiffness", "spring_reference")
    ):
        cause = "a spring that rests elsewhere is not solved: joints stand where the pose says"
        slips.note("constraint-not-solved", axis, cause)
    return Joint(
        name=joint.path,
        kind=kind,
        parent=parent,
        child=child,
        origin=still.origin,
        axis=_axis(axis, joint, frames),
        limits=_limits(axis, slips) if kind in _LIMITED else None,
        mimic=_mimic(axis, joint, frames),
    )


def _axis(element: Element, joint: JointEntry, frames: Frames) -> Vector:
    """In the frame of the joint, scaled to length 1."""
    x, y, z = numbers(element, "xyz", 3, (0.0, 0.0, 1.0))
    axis = unit_axis(element, (x, y, z))
    frame = _frame_of_axis(element, joint, frames)
    if frame is None:
        return axis
    return _turned(inverse(frames.world(joint.path)), _turned(frames.world(frame), axis))


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


def _limits(axis: Element, slips: Slips) -> Limits | None:
    limit = axis.only("limit")
    if limit is None:
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
    multiplier = number(element, "multiplier", 1.0)
    offset = number(element, "offset", 0.0) - multiplier * number(element, "reference", 0.0)
    return Mimic(leader, multiplier, offset)
