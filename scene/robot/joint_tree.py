"""Checks that the joints of a robot connect its links into one tree, and orders them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from satcheck.scene.files.xml_tree import Element
from satcheck.scene.robot.model import Joint, Link
from satcheck.scene.words import listed, meant


def in_order(
    robot: Element, links: Mapping[str, Link], joints: Sequence[tuple[Joint, Element]]
) -> tuple[str, tuple[Joint, ...]]:
    """(the root link, the joints, each after the joint of its parent link).

    Raises Refused for missing links, two parents, a cycle, several roots, and for a joint
    that mimics itself or a joint that it cannot mimic.
    """
    carriers: dict[str, Joint] = {}
    for joint, element in joints:
        for role, link in (("parent", joint.parent), ("child", joint.child)):
            if link not in links:
                hint = meant(link, links)
                element.need(role).refuse(
                    f"joint {joint.name!r} names link {link!r}, which does not exist{hint}",
                    "index-out-of-range",
                )
        if joint.child in carriers:
            other = carriers[joint.child].name
            element.refuse(
                f"link {joint.child!r} has two parents: joints {other!r} and {joint.name!r}"
            )
        carriers[joint.child] = joint
    roots = [name for name in links if name not in carriers]
    if len(roots) > 1:
        names = listed([repr(root) for root in roots])
        robot.refuse(f"{len(roots)} links are the child of no joint, only the root may be: {names}")
    ordered = _walk(roots, [joint for joint, _ in joints])
    if len(ordered) < len(joints):
        reached = {*roots, *(joint.child for joint in ordered)}
        circle = _circle(next(name for name in links if name not in reached), carriers)
        robot.refuse(f"joints form a cycle: {circle}", "reference-cycle")
    check_mimics(joints)
    return roots[0], ordered


def _walk(roots: Sequence[str], joints: Sequence[Joint]) -> tuple[Joint, ...]:
    """The joints that can be reached from the root, parents first."""
    carried: dict[str, list[Joint]] = {}
    for joint in joints:
        carried.setdefault(joint.parent, []).append(joint)
    ordered, waiting = [], list(roots)
    while waiting:
        for joint in carried.get(waiting.pop(), ()):
            ordered.append(joint)
            waiting.append(joint.child)
    return tuple(ordered)


def _circle(link: str, carriers: Mapping[str, Joint]) -> str:
    """A cycle of links as text, `a -> b -> a`. link: one whose chain of parents never ends."""
    seen: list[str] = []
    while link not in seen:
        seen.append(link)
        link = carriers[link].parent
    round_trip = [link, *reversed(seen[seen.index(link) :])]
    return " -> ".join(map(repr, round_trip))


def check_mimics(joints: Sequence[tuple[Joint, Element]]) -> None:
    """Raises Refused for a joint that mimics itself or a joint that it cannot mimic."""
    by_name = {joint.name: joint for joint, _ in joints}
    for joint, element in joints:
        chain = [joint]
        while (mimic := chain[-1].mimic) is not None:
            leader = by_name.get(mimic.joint)
            if leader is None:  # it does not move
                break
            if leader.freedoms > 1:
                element.refuse(f"{chain[-1].name!r} mimics {leader.name!r}, a {leader.kind} joint")
            if leader in chain:
                element.refuse(f"joint {joint.name!r} indirectly mimics itself", "reference-cycle")
            chain.append(leader)
