"""The problems of a report that a CI system shows: findings that are errors, warnings or notes, and
the issues of the inputs, the worst first."""

from __future__ import annotations

import os
from heapq import nsmallest
from itertools import count
from math import inf
from pathlib import Path
from typing import TYPE_CHECKING, Literal, NamedTuple, get_args
from urllib.parse import quote

from satcheck.audit.messages import kind_of
from satcheck.audit.words import rank
from satcheck.cli.formats.summary import issues_to_tell
from satcheck.cli.output import with_place
from satcheck.report.assets import LEFT_OUT
from satcheck.report.bodies import Place
from satcheck.report.colliders import FALLS_SHORT, STICKS_OUT
from satcheck.report.report import NOTHING_TO_CHECK, OF_ANSWERS
from satcheck.report.verdict import severity

if TYPE_CHECKING:
    from collections.abc import Collection, Iterator

    from satcheck.cli.formats.registry import Reports
    from satcheck.report.baseline import BaselineState
    from satcheck.report.report import Finding, Issue, Report

Level = Literal["error", "warning", "note"]
LEVELS: tuple[Level, ...] = get_args(Level)
# Kinds of findings, and what each means. The kind of an issue is its code.
KINDS = {
    "overlap": "Two bodies share a part of their interior.",
    "motion": "Two bodies hit while they move.",
    "clearance": "Two bodies are closer than their clearance.",
    "touch": "Two bodies touch.",
    "undecided": "A question about two bodies could not be decided.",
    STICKS_OUT: "A collider sticks out of what is drawn.",
    FALLS_SHORT: "A collider falls short of what is drawn.",
}


class Problem(NamedTuple):
    """kind: a key of KINDS, or the code of an issue. places: where each body is stated, in their
    order, or where the issue is; at least one. id: that of the finding; of an issue its code and
    its body. rank: that of the finding; an issue comes last. state: beside a baseline. stops:
    nothing passes while it stands.
    """

    level: Level
    kind: str
    message: str
    places: tuple[Place, ...]
    bodies: tuple[str, ...]
    id: str
    rank: tuple[float, ...] = (inf,)
    state: BaselineState | None = None
    stops: bool = False


def problems(reports: Reports) -> list[Problem]:
    """Return the problems of all reports, the worst first: by level, then findings as a table has
    them, then issues. With several reports each message and each id names its asset."""
    return sorted(_of_all(reports), key=_order)


def worst_problems(reports: Reports, most: int) -> tuple[list[Problem], int]:
    """The first of them, and the number of the others, which need no memory."""
    numbers = count()
    numbered = zip(_of_all(reports), numbers, strict=False)
    worst = nsmallest(most, (problem for problem, _ in numbered), key=_order)
    return worst, next(numbers) - len(worst)


def _of_all(reports: Reports) -> Iterator[Problem]:
    is_one = len(reports) == 1
    for asset, report in reports.items():
        for problem in _of_report(report):
            yield problem if is_one else _naming(asset, problem)


def _order(problem: Problem) -> tuple[int, tuple[float, ...]]:
    return (LEVELS.index(problem.level), problem.rank)


def _naming(asset: str, problem: Problem) -> Problem:
    message = problem.message
    named = message if message.startswith(asset) else f"{asset}: {message}"
    return problem._replace(message=named, id=f"{uri(asset)}/{problem.id}")


def _of_report(report: Report) -> list[Problem]:
    places = {body.id: body.stated_at or Place(body.file, 1) for body in report.bodies}
    findings = [
        _of_finding(finding, level, places)
        for finding in report.findings
        if (level := severity(finding)) in ("error", "warning", "note")
    ]
    unmet = {answer.body for answer in report.answers if answer.severity == "error"}
    return findings + [_of_issue(issue, places, unmet) for issue in issues_to_tell(report)]


def stops_pass(issue: Issue) -> bool:
    """Return whether nothing passes while the issue stands."""
    is_empty = issue.code == NOTHING_TO_CHECK and issue.severity == "warning"
    is_open = issue.state == "blocking" or issue.code in LEFT_OUT or is_empty
    return issue.severity == "error" or is_open


def uri(file: str) -> str:
    """Relative to the current folder if the file lies in it, otherwise a file URI. Links are not
    followed: the name is stable."""
    path = Path(near(file))
    return path.as_uri() if path.is_absolute() else quote(os.fsencode(path.as_posix()))


def near(file: str) -> str:
    """The path relative to the current folder if the file lies in it, otherwise absolute."""
    path = Path(os.path.normpath(Path.cwd() / file))
    inside = path.is_relative_to(Path.cwd())
    return (path.relative_to(Path.cwd()) if inside else path).as_posix()


def _of_finding(finding: Finding, level: Level, places: dict[str, Place]) -> Problem:
    bodies = (finding.a, finding.b)
    return Problem(
        level,
        kind_of(finding),
        finding.message,
        tuple(places[body] for body in bodies),
        bodies,
        finding.id,
        rank(finding),
        finding.baseline_state,
        finding.undecided is not None,
    )


def _of_issue(issue: Issue, places: dict[str, Place], unmet: Collection[str]) -> Problem:
    """An issue of the whole check gets the first file. unmet: bodies about which the answer is an
    error; their issue is one, too."""
    body = (issue.body,) if issue.body else ()
    where = issue.body or issue.file
    first = next(iter(places.values()), Place(".", 1))
    place = places.get(issue.body or "", first)
    if issue.file:
        place = Place(issue.file, issue.line or 1)
    return Problem(
        "error" if issue.code in OF_ANSWERS and issue.body in unmet else issue.severity,
        issue.code,
        with_place(issue),
        (place,),
        body,
        f"{issue.code}/{where or ''}",
        stops=stops_pass(issue),
    )
