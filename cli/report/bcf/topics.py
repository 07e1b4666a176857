"""Which findings are topics, and their titles, states and labels.

The GUID of a topic follows from the ids of its bodies. A second run updates the topic.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import count
from typing import TYPE_CHECKING, Literal
from uuid import NAMESPACE_URL, UUID, uuid5

from msgspec import Struct

from satcheck.cli.report.ci.problems import kind_of, measured
from satcheck.cli.report.order import is_listed, worst_first
from satcheck.scene.units import unit_of

if TYPE_CHECKING:
    from satcheck.report.report import Finding, Report
    from satcheck.scene import Body, Scene

Status = Literal["Open", "ReOpened", "Closed"]
STATUSES: tuple[Status, ...] = ("Open", "ReOpened", "Closed")
TYPES = {
    "overlap": "Clash",
    "motion": "Clash",
    "clearance": "Clearance",
    "undecided": "Undecided",
}
PRIORITIES = {"error": "High", "warning": "Medium", "note": "Low"}
_SPACE = uuid5(NAMESPACE_URL, "satcheck:bcf")
_STOREY = "storey:"


class Member(Struct, frozen=True):
    """A body of a topic. guid: its GlobalId; None: it is of no IFC file. name: for people."""

    id: str
    file: str
    guid: str | None
    name: str


class Topic(Struct, frozen=True):
    """finding: None for a known finding that is gone. labels: classes and storeys of the bodies."""

    guid: str
    index: int
    kind: str
    status: Status
    priority: str
    title: str
    description: str
    labels: tuple[str, ...]
    members: tuple[Member, Member]
    finding: Finding | None

    @property
    def view_guid(self) -> str:
        return str(uuid5(UUID(self.guid), "view"))


def topics_of(report: Report, scene: Scene) -> list[Topic]:
    """The worst first. Pairs that touch, and nothing else, are no topics."""
    bodies = {body.id: body for body in scene.bodies}
    members = _members(report, bodies)
    numbers = count()
    topics = [
        _topic(finding, report, members, bodies, next(numbers))
        for finding in worst_first(filter(_is_topic, report.findings))
    ]
    return [*topics, *_gone(report, members, numbers)]


def _is_topic(finding: Finding) -> bool:
    return is_listed(finding) and finding.severity in PRIORITIES and kind_of(finding) in TYPES


def _members(report: Report, bodies: Mapping[str, Body]) -> dict[str, Member]:
    return {
        each.id: Member(
            id=each.id,
            file=each.file,
            guid=each.path if each.id in bodies and bodies[each.id].file.format == "ifc" else None,
            name=bodies[each.id].name if each.id in bodies else each.id,
        )
        for each in report.bodies
    }


def _topic(
    finding: Finding,
    report: Report,
    members: Mapping[str, Member],
    bodies: Mapping[str, Body],
    number: int,
) -> Topic:
    a, b = members[finding.a], members[finding.b]
    said = [measured(finding, unit_of(report.units))]
    said += [text for text in (finding.reason, finding.rule and f"rule: {finding.rule}") if text]
    return Topic(
        guid=_guid(finding.a, finding.b),
        index=number,
        kind=TYPES[kind_of(finding)],
        status=_status(finding),
        priority=PRIORITIES[finding.severity],
        title=f"{a.name} / {b.name}",
        description="\n".join([*said, *(f"{each.name} ({each.id})" for each in (a, b))]),
        labels=tuple(_labels([bodies[each.id] for each in (a, b) if each.id in bodies])),
        members=(a, b),
        finding=finding,
    )


def _guid(a: str, b: str) -> str:
    """The same in either order of the bodies."""
    return str(uuid5(_SPACE, "\n".join(sorted((a, b)))))


def _status(finding: Finding) -> Status:
    """Beside a baseline: closed if the finding is accepted."""
    if finding.baseline_state == "unchanged":
        return "Closed"
    return "ReOpened" if finding.baseline_state in ("worse", "undecided") else "Open"


def _labels(bodies: list[Body]) -> Iterator[str]:
    """Of IFC elements: the pair of classes, and the storeys."""
    if len(bodies) == 2 and all(body.file.format == "ifc" for body in bodies):
        yield " / ".join(sorted(body.name.partition(" ")[0] for body in bodies))
    storeys = (group for body in bodies for group in body.groups if group.startswith(_STOREY))
    yield from sorted({storey.removeprefix(_STOREY) for storey in storeys})


def _gone(report: Report, members: Mapping[str, Member], numbers: Iterator[int]) -> Iterator[Topic]:
    """Known findings of the baseline that are no findings any more."""
    for known in report.baseline.absent if report.baseline else ():
        a, b = members[known.a], members[known.b]
        yield Topic(
            guid=_guid(known.a, known.b),
            index=next(numbers),
            kind=TYPES["overlap"],
            status="Closed",
            priority=PRIORITIES[known.severity],
            title=f"{a.name} / {b.name}",
            description="no longer found",
            labels=(),
            members=(a, b),
            finding=None,
        )
