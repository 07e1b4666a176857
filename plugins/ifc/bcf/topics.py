"""Which findings are topics, and their titles, states and labels.

Findings of one kind and severity between the same two classes of IFC elements on the same storeys
are one topic, with a view of each pair. Each pair of other bodies is a topic. The GUID of a topic
follows from what its pairs have in common, so a second run updates the topic.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Literal
from uuid import NAMESPACE_URL, uuid5

from msgspec import Struct

from satcheck.cli.formats.ci.problems import kind_of, measured
from satcheck.cli.formats.order import is_listed, worst_first
from satcheck.cli.formats.words import counted
from satcheck.plugins.ifc.model import unpacked
from satcheck.scene.errors import MeshFileError
from satcheck.scene.units import unit_of

if TYPE_CHECKING:
    from satcheck.report.baseline import KnownFinding
    from satcheck.report.report import Finding, Report
    from satcheck.scene import Body, Scene

_PROJECT = re.compile(rb"=\s*IFCPROJECT\s*\(\s*'([0-9A-Za-z_$]{22})'", re.IGNORECASE)
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


class PairView(Struct, frozen=True):
    """A pair of a topic. finding: None for a known finding that is gone."""

    guid: str
    members: tuple[Member, Member]
    status: Status
    priority: str
    kind: str
    description: str
    finding: Finding | None

    @property
    def title(self) -> str:
        return " / ".join(member.name for member in self.members)

    @property
    def classes(self) -> tuple[str, ...]:
        """Return the classes of IFC elements, sorted; (): one body is none."""
        kinds = [member.kind for member in self.members if member.kind is not None]
        return tuple(sorted(kinds)) if len(kinds) == len(self.members) else ()

    @property
    def storeys(self) -> tuple[str, ...]:
        return tuple(sorted({storey for member in self.members for storey in member.storeys}))

    @property
    def key(self) -> str:
        """Return what the pairs of a topic have in common."""
        if not self.classes:
            return "\n".join(sorted(member.id for member in self.members))
        projects = sorted(member.project or member.file for member in self.members)
        return "\n".join(
            ("group", self.kind, self.priority, *self.classes, "", *self.storeys, "", *projects)
        )


class Topic(Struct, frozen=True):
    """views: of its pairs, the worst first; those that are to be shown. labels: classes and storeys
    of the bodies."""

    guid: str
    index: int
    kind: str
    status: Status
    priority: str
    title: str
    description: str
    labels: tuple[str, ...]
    views: tuple[PairView, ...]


def topics_of(report: Report, scene: Scene) -> list[Topic]:
    """The worst first. Pairs that touch, and nothing else, are no topics."""
    groups: dict[str, list[PairView]] = {}
    for view in _views(report, scene):
        groups.setdefault(view.key, []).append(view)
    return [_topic(key, views, index) for index, (key, views) in enumerate(groups.items())]


def _views(report: Report, scene: Scene) -> Iterator[PairView]:
    members = _members(report, {body.id: body for body in scene.bodies})
    for finding in worst_first(filter(_is_shown, report.findings)):
        yield _of_finding(finding, report, members)
    for known in report.baseline.absent if report.baseline else ():
        yield _gone(known, members)


def _is_shown(finding: Finding) -> bool:
    return is_listed(finding) and finding.severity in PRIORITIES and kind_of(finding) in TYPES


def _members(report: Report, bodies: Mapping[str, Body]) -> dict[str, Member]:
    known = {each.id: bodies.get(each.id) for each in report.bodies}
    return {
        each.id: _member(each.id, each.file, each.path, known[each.id]) for each in report.bodies
    }


def _member(id_: str, file: str, path: str | None, body: Body | None) -> Member:
    if body is None or body.file.format != "ifc":
        return Member(id_, file, None, body.name if body else id_)
    storeys = [group for group in body.groups if group.startswith(_STOREY)]
    return Member(
        id=id_,
        file=file,
        guid=path,
        name=body.name,
        project=_project_of(file),
        kind=body.name.partition(" ")[0],
        storeys=tuple(storey.removeprefix(_STOREY) for storey in storeys),
    )


def _of_finding(finding: Finding, report: Report, members: Mapping[str, Member]) -> PairView:
    said = [measured(finding, unit_of(report.units))]
    said += [text for text in (finding.reason, finding.rule and f"rule: {finding.rule}") if text]
    return PairView(
        guid=_view_guid(finding.a, finding.b),
        members=(members[finding.a], members[finding.b]),
        status=_status(finding),
        priority=PRIORITIES[finding.severity],
        kind=TYPES[kind_of(finding)],
        description="; ".join(said),
        finding=finding,
    )


def _gone(known: KnownFinding, members: Mapping[str, Member]) -> PairView:
    """Return the topic of a known finding of the baseline that is no finding any more."""
    return PairView(
        guid=_view_guid(known.a, known.b),
        members=(members[known.a], members[known.b]),
        status="Closed",
        priority=PRIORITIES[known.severity],
        kind=TYPES["overlap"],
        description="no longer found",
        finding=None,
    )


def _view_guid(a: str, b: str) -> str:
    """The same in either order of the bodies."""
    return str(uuid5(_SPACE, "\n".join(("view", *sorted((a, b))))))


def _status(finding: Finding) -> Status:
    """Beside a baseline: closed if the finding is accepted."""
    if finding.baseline_state == "unchanged":
        return "Closed"
    return "ReOpened" if finding.baseline_state in ("worse", "undecided") else "Open"


def _topic(key: str, views: Sequence[PairView], index: int) -> Topic:
    first = views[0]
    status = _common_status(view.status for view in views)
    shown = tuple(view for view in views if status == "Closed" or view.status != "Closed")
    return Topic(
        guid=str(uuid5(_SPACE, key)),
        index=index,
        kind=first.kind,
        status=status,
        priority=first.priority,
        title=_title(shown),
        description=_description(views),
        labels=_labels(first),
        views=shown,
    )


def _common_status(states: Iterable[Status]) -> Status:
    """Closed only if all are."""
    left = set(states) - {"Closed"}
    if not left:
        return "Closed"
    return "ReOpened" if "ReOpened" in left else "Open"


def _title(views: Sequence[PairView]) -> str:
    first = views[0]
    if len(views) == 1:
        return first.title
    where = f", {', '.join(first.storeys)}" if first.storeys else ""
    return f"{' / '.join(first.classes)}: {counted(len(views), 'pair')}{where}"


def _description(views: Sequence[PairView]) -> str:
    lines = []
    for view in views[:_MOST_DESCRIBED]:
        closed = "accepted: " if view.status == "Closed" and view.finding else ""
        ids = " / ".join(f"{member.name} ({member.id})" for member in view.members)
        lines.append(f"{ids}: {closed}{view.description}")
    if len(views) > _MOST_DESCRIBED:
        lines.append(f"and {len(views) - _MOST_DESCRIBED} more")
    return "\n".join(lines)


def _labels(view: PairView) -> tuple[str, ...]:
    """Return the labels of IFC elements: the pair of classes, and the storeys."""
    classes = (" / ".join(view.classes),) if view.classes else ()
    return (*classes, *view.storeys)


@cache
def _project_of(file: str) -> str | None:
    """The GlobalId of the project of an IFC file; None: the file is not there any more, or names no
    project."""
    try:
        match = _PROJECT.search(unpacked(memoryview(Path(file).read_bytes())))
    except (OSError, MeshFileError):
        return None
    return match[1].decode("ascii", "replace") if match else None
