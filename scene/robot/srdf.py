"""Reads SRDF: pairs of links that need no check, and named values of joints.

The format: http://wiki.ros.org/srdf.
"""

from __future__ import annotations

from msgspec import Struct

from satcheck.scene.access import NOTHING_ELSE, Permitted
from satcheck.scene.files.xml_tree import Element
from satcheck.scene.issue import Issue
from satcheck.scene.robot.model import State, Values
from satcheck.scene.robot.reading import read_tree
from satcheck.scene.robot.slips import Place, Slips, attributes, elements

_PLANNED = Place(
    elements("", it_plans="chain link joint group passive_joint"),
    attributes(
        "",
        it_plans="""name type parent_frame child_link parent_link group parent_group
            component_name""",
    ),
)
_PAIR = Place(attributes=attributes("link1 link2", words="reason"))
ROBOT = Place(
    elements(
        "disable_collisions disable_default_collisions enable_collisions group_state",
        it_plans_and_exempts_and_moves_no_body="""group end_effector virtual_joint passive_joint
            joint_property chain link_property group_property""",
    ),
    attributes("name", words_about_the_file="version"),
    inside={
        "group": _PLANNED,
        "end_effector": _PLANNED,
        "virtual_joint": _PLANNED,
        "disable_collisions": _PAIR,
        "enable_collisions": _PAIR,
        "disable_default_collisions": Place(attributes=attributes("link", words="reason")),
        "group_state": Place(
            elements("joint"),
            attributes("name group"),
            inside={"joint": Place(attributes=attributes("name value"))},
        ),
    },
)


class Srdf(Struct, frozen=True):
    """file: path as given. robot: the name of the robot that it is about. issues: names that are
    not read.

    disabled: two links -> the stated reason. silent: links that by default are checked against no
    other link; enabled: pairs that are checked anyway.
    """

    file: str
    robot: str
    disabled: dict[frozenset[str], str]
    silent: frozenset[str]
    enabled: frozenset[frozenset[str]]
    states: tuple[State, ...]
    issues: tuple[Issue, ...] = ()

    def links(self) -> set[str]:
        """All links that the file names."""
        return {*self.silent}.union(*self.disabled, *self.enabled)

    def permission(self, a: str, b: str) -> str | None:
        """The reason why two links need no check; None: they need one."""
        pair = frozenset((a, b))
        if pair in self.disabled:
            return f"SRDF: {self.disabled[pair]}".rstrip(": ")
        if pair & self.silent and pair not in self.enabled:
            return "SRDF: disabled by default"
        return None


def read_srdf(path: str, permitted: Permitted = NOTHING_ELSE) -> Srdf:
    """permitted: how large it may be. Raises Refused with the file, the line and the element."""
    root = read_tree(path, permitted, "robot")
    slips = Slips()
    slips.look(root, ROBOT)
    disabled = {_pair(e): e.attributes.get("reason", "") for e in root.all("disable_collisions")}
    for element in root.all("enable_collisions"):
        if _pair(element) in disabled:
            element.refuse("the pair is disabled as well: state one of the two")
        if len(_pair(element)) == 1:
            element.refuse("one link twice: name two links")
    return Srdf(
        file=path,
        robot=root.attribute("name"),
        disabled=disabled,
        silent=frozenset(e.attribute("link") for e in root.all("disable_default_collisions")),
        enabled=frozenset(_pair(e) for e in root.all("enable_collisions")),
        states=tuple(_state(element) for element in root.all("group_state")),
        issues=slips.issues(),
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
