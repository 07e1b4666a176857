"""SRDF -> which links need no check against each other, and named values of joints.

The format: http://wiki.ros.org/srdf. Virtual joints, groups and end effectors say nothing about
what may collide, and are passed over.
"""

from __future__ import annotations

from pathlib import Path

from msgspec import Struct

from satcheck.scene.robot.kinematics import Values
from satcheck.scene.robot.xml_tree import Element, read_tree


class State(Struct, frozen=True):
    """A <group_state>: values of some joints under a name. lines: where the file, as given, says
    them."""

    group: str
    name: str
    joints: dict[str, Values]
    file: str
    lines: dict[str, int]


class Srdf(Struct, frozen=True):
    """file: path as given. robot: the name of the robot that it is about.

    disabled: two links -> the reason given. silent: links that by default are not checked against
    any other; enabled: pairs that are checked nevertheless.
    """

    file: str
    robot: str
    disabled: dict[frozenset[str], str]
    silent: frozenset[str]
    enabled: frozenset[frozenset[str]]
    states: tuple[State, ...]

    def links(self) -> set[str]:
        """All links named."""
        return {*self.silent}.union(*self.disabled, *self.enabled)

    def permission(self, a: str, b: str) -> str | None:
        """Why two links need no check; None: they do. As in MoveIt, what is disabled goes last."""
        pair = frozenset((a, b))
        if pair in self.disabled:
            return f"SRDF: {self.disabled[pair]}".rstrip(": ")
        if pair & self.silent and pair not in self.enabled:
            return "SRDF: disabled by default"
        return None


def read_srdf(path: str, location: Path) -> Srdf:
    """Raises SceneFileError with the file, the line and the element."""
    root = read_tree(path, location, "robot")
    return Srdf(
        file=path,
        robot=root.attribute("name"),
        disabled={_pair(e): e.attributes.get("reason", "") for e in root.all("disable_collisions")},
        silent=frozenset(e.attribute("link") for e in root.all("disable_default_collisions")),
        enabled=frozenset(_pair(e) for e in root.all("enable_collisions")),
        states=tuple(_state(element) for element in root.all("group_state")),
    )


def _pair(element: Element) -> frozenset[str]:
    return frozenset((element.attribute("link1"), element.attribute("link2")))


def _state(element: Element) -> State:
    joints: dict[str, Values] = {}
    lines: dict[str, int] = {}
    for joint in element.all("joint"):
        name = joint.attribute("name")
        values = joint.numbers("value", len(joint.attribute("value").split()))
        if joints.setdefault(name, values) != values:
            joint.refuse(f"a second value of joint {name!r}", "duplicate-id")
        lines.setdefault(name, joint.line)
    group, name = element.attributes.get("group", ""), element.attribute("name")
    return State(group, name, joints, element.file, lines)
