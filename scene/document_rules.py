"""The groups, rules and joints of documents: files that state, beside bodies, which may touch
which, and how they move."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from msgspec import Struct

from satcheck.scene.loading.nodes import Nodes
from satcheck.scene.loading.raw_mesh import RawJoint
from satcheck.scene.plain_ids import UniqueNames
from satcheck.scene.rules import Rule, Selector


def groups_of(nodes: Nodes, names: UniqueNames, shared: dict[str, str]) -> dict[str, str]:
    """Return the groups of a document -> their names in the check.

    Groups of several documents that have one name are one group, unless rules of a document name
    the group. names: of all groups in the check. shared: of these documents; this call adds to it.
    """
    ruled = {group for rule in nodes.rules if rule.of_groups for group in (rule.a, rule.b)}
    groups: dict[str, str] = {}
    for group in dict.fromkeys(group for node in nodes.nodes.values() for group in node.groups):
        if group not in ruled and group not in shared:
            shared[group] = names.unique(group)
        groups[group] = names.unique(group) if group in ruled else shared[group]
    return groups


class Jointed(Struct, frozen=True):
    """A document with joints that move. links: id of a body -> its rigid body."""

    path: str
    joints: tuple[RawJoint, ...]
    links: Mapping[str, str]


def jointed(nodes: Nodes, ids: Mapping[str | None, str], path: str) -> list[Jointed]:
    """Of the document at `path`, if it has joints that move. ids: as in `document_rules`."""
    if all(joint.kind == "fixed" for joint in nodes.joints):
        return []
    links = {ids[path]: node.link for path, node in nodes.nodes.items() if node.link is not None}
    return [Jointed(path, nodes.joints, links)]


def document_rules(
    nodes: Nodes, ids: Mapping[str | None, str], groups: Mapping[str, str], path: str
) -> Iterator[Rule]:
    """The rules of the document at `path`. ids, groups: of its nodes -> their names in
    the check."""
    for rule in nodes.rules:
        select = Selector.exactly_group if rule.of_groups else Selector.exactly
        names = groups if rule.of_groups else ids
        if rule.a in names and rule.b in names:
            yield Rule(
                a=select(names[rule.a]),
                b=select(names[rule.b]),
                allowed=True if rule.severity is None else None,
                severity=rule.severity,
                reason=rule.reason,
                where=f"{path}: {rule.reason}",
                file=path,
            )
