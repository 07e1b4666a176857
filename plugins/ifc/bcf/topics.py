"""Which findings are topics, and their titles, states and labels.

Findings of one kind and severity between the same two classes of IFC elements on the same storeys
are one topic, with a view of each pair. Each pair of other bodies is a topic. The GUID of a topic
follows from what its pairs have in common, so a second run updates the topic.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from functools import cache
from typing import TYPE_CHECKING, Literal
from uuid import NAMESPACE_URL, uuid5

from msgspec import Struct

from satcheck.audit.messages import kind_of, measured
from satcheck.audit.words import counted, is_listed, worst_first
from satcheck.plugins.ifc.model import unpacked
from satcheck.scene.access import OWN_FILE
from satcheck.scene.errors import Refused
from satcheck.scene.opening import read_whole
from satcheck.scene.units import unit_of

if TYPE_CHECKING:
    from satcheck.report.report import Finding, Report
    from satcheck.scene import Body, Scene

_PROJECT = re.compile(rb"=\s*IFCPROJECT\s*\(\s*'([0-9A-Za-z_$]{22})'", re.IGNORECASE)
Status = Literal["Open", "ReOpened", "Closed"]
STATUSES: tuple[Status, ...] = ("Open", "ReOpened", "Closed")
_BESIDE_BASELINE: dict[str, Status] = {
    "unchanged": "Closed",
    "accepted": "Closed",
    "worse": "ReOpened",
    "undecided": "ReOpened",
}
TYPES = {
    "overlap": "Clash",
    "motion": "Clash",
    "clearance": "Clearance",
    "undecided": "Undecided",
}
PRIORITIES = {"error": "High", "warning": "Medium", "note": "Low"}
_SPACE = uuid5(NAMESPACE_URL, "satcheck:bcf")
_STOREY = "storey:"
_MOST_DESCRIBED = 100  # pairs of a topic


class Member(Struct, frozen=True):
    """A body of a topic. guid: its GlobalId; None: it is of no IFC file. name: for people. project:
    the GlobalId of the IfcProject. kind: the class of an IFC element. storeys: of the same."""

    id: str
    file: str
    guid: str | None
    name: str
    project: str | None = None
    kind: str | None = None
    storeys: tuple[str, ...] = ()


class Pair(Struct, frozen=True):
    """A pair of a topic. finding: None for a known finding that is gone."""

    members: tuple[Member, Member]
    status: Status
    priority: str
    kind: str
    description: str
    finding: Finding | None

    @property
    def guid(self) -> str:
        """Return the GUID of its view, the same in either order of the bodies."""
        return _guid("view", *sorted(member.id for member in self.members))

    @property
    def classes(self) -> tuple[str, ...]:
        """Return the classes of IFC elements, sorted; (): one body is none."""
        kinds = [member.kind for member in self.members if member.kind is not None]
        return tuple(sorted(kinds)) if len(kinds) == len(self.members) else ()

    @property
    def storeys(self) -> tuple[str, ...]:
        return tuple(sorted({storey for member in self.members for storey in member.storeys}))

    @property
    def labels(self) -> tuple[str, ...]:
        classes = (" / ".join(self.classes),) if self.classes else ()
        return (*classes, *self.storeys)

    @property
    def topic(self) -> str:
        """Return the GUID of its topic: of what the pairs of the topic have in common."""
        if not self.classes:
            return _guid(*sorted(member.id for member in self.members))
        projects = sorted(member.project or member.file for member in self.members)
        place = ("", *self.storeys, "", *projects)
        return _guid("group", self.kind, self.priority, *self.classes, *place)


def topics_of(report: Report, scene: Scene) -> dict[str, list[Pair]]:
    """Return the pairs of each topic by its GUID, the worst first. Pairs that touch, and nothing
    else, are no topics."""
    topics: dict[str, list[Pair]] = {}
    for pair in _pairs(report, scene):
        topics.setdefault(pair.topic, []).append(pair)
    return topics


def shown(pairs: Sequence[Pair]) -> Sequence[Pair]:
    """Return the pairs of a topic that are not closed; all pairs if all are."""
    return [pair for pair in pairs if pair.status != "Closed"] or pairs


def status(pairs: Sequence[Pair]) -> Status:
    """Return the state of a topic: it is closed only if all its pairs are."""
    states = {pair.status for pair in shown(pairs)}
    return "ReOpened" if "ReOpened" in states else states.pop()


def title(pairs: Sequence[Pair]) -> str:
    first, *others = shown(pairs)
    if not others:
        return " / ".join(member.name for member in first.members)
    where = f", {', '.join(first.storeys)}" if first.storeys else ""
    return f"{' / '.join(first.classes)}: {counted(1 + len(others), 'pair')}{where}"


def description(pairs: Sequence[Pair]) -> str:
    lines = []
    for pair in pairs[:_MOST_DESCRIBED]:
        closed = "accepted: " if pair.status == "Closed" and pair.finding else ""
        ids = " / ".join(f"{member.name} ({member.id})" for member in pair.members)
        lines.append(f"{ids}: {closed}{pair.description}")
    if len(pairs) > _MOST_DESCRIBED:
        lines.append(f"and {len(pairs) - _MOST_DESCRIBED} more")
    return "\n".join(lines)


def _pairs(report: Report, scene: Scene) -> Iterator[Pair]:
    bodies = {body.id: body for body in scene.bodies}
    members = {
        each.id: _member(each.id, each.file, each.path, bodies.get(each.id))
        for each in report.bodies
    }
    for finding in worst_first(report.findings):
        if is_listed(finding) and finding.severity in PRIORITIES and kind_of(finding) in TYPES:
            yield _pair(finding, report, members)
    for known in report.baseline.absent if report.baseline else ():
        pair = members[known.a], members[known.b]
        severity = PRIORITIES[known.severity]
        yield Pair(pair, "Closed", severity, TYPES["overlap"], "no longer found", None)


def _member(id_: str, file: str, path: str | None, body: Body | None) -> Member:
    if body is None or body.file.format != "ifc":
        return Member(id_, file, None, body.name if body else id_)
    storeys = (group.removeprefix(_STOREY) for group in body.groups if group.startswith(_STOREY))
    return Member(
        id=id_,
        file=file,
        guid=path,
        name=body.name,
        project=_project_of(file),
        kind=body.name.partition(" ")[0],
        storeys=tuple(storeys),
    )


def _pair(finding: Finding, report: Report, members: Mapping[str, Member]) -> Pair:
    said = [measured(finding, unit_of(report.units))]
    said += [text for text in (finding.reason, finding.rule and f"rule: {finding.rule}") if text]
    return Pair(
        members=(members[finding.a], members[finding.b]),
        status=_BESIDE_BASELINE.get(finding.baseline_state or "", "Open"),
        priority=PRIORITIES[finding.severity],
        kind=TYPES[kind_of(finding)],
        description="; ".join(said),
        finding=finding,
    )


def _guid(*parts: str) -> str:
    """File names may hold what is no text."""
    text = "\n".join(parts).encode(errors="backslashreplace").decode()
    return str(uuid5(_SPACE, text))


@cache
def _project_of(file: str) -> str | None:
    """The GlobalId of the project of an IFC file; None: the file is not there any more, or names no
    project."""
    try:
        match = _PROJECT.search(unpacked(memoryview(read_whole(file)), OWN_FILE))
    except Refused:
        return None
    return match[1].decode("ascii", "replace") if match else None
