"""Reads SRDF: pairs of links that need no check, and named values of joints.

The format: http://wiki.ros.org/srdf. Virtual joints, groups and end effectors do not affect
collisions and are ignored.
"""

from __future__ import annotations

from pathlib import Path

from msgspec import Struct

from satcheck.scene.robot.model import State, Values
from satcheck.scene.robot.xml_tree import Element, read_tree


class Srdf(Struct, frozen=True):
    """file: path as given. robot: the name of the robot that it is about.

    disabled: two links -> the stated reason. silent: links that by default are checked against no
    other link; enabled: pairs that are checked anyway.
    """

    file: str
    robot: str
    disabled: dict[frozenset[str], str]
    silent: frozenset[str]
    enabled: frozenset[frozenset[str]]
    states: tuple[State, ...]

    def links(self) -> set[str]:
        """All links that the file names."""
        return {*self.silent}.union(*self.disabled, *self.enabled)

    def permission(self, a: str, b: str) -> str | None:
        """The reason why two links need no check; None: they need one. As in MoveIt, `disabled`
        overrides `enabled`."""
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
