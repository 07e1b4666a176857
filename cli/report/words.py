"""Sentences about a report, in plain words."""

from __future__ import annotations

from typing import TYPE_CHECKING

from satcheck.audit.report import OVERLAPS, RELATIONS
from satcheck.cli.lengths import unit_of
from satcheck.cli.report.numbers import bounds, number

if TYPE_CHECKING:
    from satcheck.audit.report import Finding, Issue, Report

_WORDS = {"indeterminate": "not decided", "contains": "containing"}


def counted(count: int, one: str, many: str | None = None) -> str:
    """`1 pair`, `2 pairs`."""
    return f"{count:,} {one if count == 1 else many or one + 's'}"


def issue_line(issue: Issue) -> str:
    """`warning: l_bracket: 2 open edges [open-mesh]`, as it also goes to stderr."""
    where = issue.body or issue.file
    named = f"{where}: " if where and not issue.message.startswith(where) else ""
    return f"{issue.severity}: {named}{issue.message} [{issue.code}]"


def summary_line(report: Report) -> str:
    """What was checked, what was found, and the worst of it."""
    pairs = report.summary.pairs
    counts = report.summary.by_relation
    found = [f"{counts[name]:,} {_WORDS.get(name, name)}" for name in RELATIONS if counts.get(name)]
    if pairs.allowed:
        found.append(f"{pairs.allowed:,} allowed by the scene")
    bodies = counted(len(report.bodies), "body", "bodies")
    line = f"{bodies}, {counted(pairs.total, 'pair')}: {', '.join(found) or 'nothing checked'}."
    return " ".join([line, *_worst(report), *_errors(report)])


def relation(finding: Finding) -> str:
    """One or two words."""
    return "not decided" if finding.relation == "indeterminate" else finding.relation


def depth(finding: Finding) -> str:
    """The depth, with its proven bounds where they differ; empty when there is none."""
    if finding.depth is None:
        return ""
    if finding.quality == "bounded" and finding.depth_bounds:
        return bounds(*finding.depth_bounds)
    return number(finding.depth)


def _worst(report: Report) -> list[str]:
    deep = [f for f in report.findings if f.depth is not None and f.relation in OVERLAPS]
    if deep:
        worst = max(deep, key=lambda f: f.depth or 0.0)
        known = unit_of(report.units)
        units = f" {known}" if known else ""
        if len(deep) == 1:
            return [f"Depth {depth(worst)}{units}."]
        return [f"The deepest: {worst.a} and {worst.b}, {depth(worst)}{units}."]
    if report.summary.verdict == "pass" and report.summary.pairs.total:
        return ["No collision."]
    return []


def _errors(report: Report) -> list[str]:
    count = sum(issue.severity == "error" for issue in report.issues)
    return [f"{counted(count, 'input')} could not be used."] if count else []
