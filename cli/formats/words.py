"""Words and cells about one thing: a count, an issue, a relation, a depth, a limit, an option; and
a report with names that a terminal can show."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

from satcheck.audit.words import counted, number
from satcheck.cli.output import harmless

if TYPE_CHECKING:
    from collections.abc import Iterable

    from satcheck.report.report import Finding, Issue, Report
    from satcheck.report.settings import OptionValue, StatedConfig
    from satcheck.scene import Issue as InputIssue


def issue_line(issue: Issue | InputIssue) -> str:
    """`warning: l_bracket: 2 open edges [open-mesh]`, as it also goes to stderr; one line, whatever
    the names are."""
    where = issue.body or issue.file
    known = tuple(filter(None, (where, issue.file)))
    named = f"{where}: " if known and not issue.message.startswith(known) else ""
    return harmless(f"{issue.severity}: {named}{issue.message} [{issue.code}]")


def contacts(finding: Finding) -> str:
    """`1 loop of length 4.25`, `2 patches of area 3, 1 point`; empty when not computed."""
    if finding.contacts is None:
        return ""
    curves, totals = finding.contacts.curves, finding.contacts.totals
    loops = len(curves) == totals.curves and all(curve.closed for curve in curves)
    counts = []
    if totals.patches:
        counts.append(
            f"{counted(totals.patches, 'patch', 'patches')} of area {number(totals.area)}"
        )
    if totals.curves:
        name = counted(totals.curves, "loop" if loops else "curve")
        counts.append(f"{name} of length {number(totals.length)}")
    if totals.points:
        counts.append(counted(totals.points, "point"))
    return ", ".join(counts) or "none"


def in_one_line_each(report: Report) -> Report:
    """The report with texts that a terminal can show."""
    names = ((body.id, body.name, body.file, body.path or "") for body in report.bodies)
    if all(name.isprintable() for each in names for name in each):
        return report
    from msgspec import convert, to_builtins

    return convert(_shown(to_builtins(report)), type(report))


def _shown(value: Any) -> Any:
    if isinstance(value, str):
        return harmless(value)
    if isinstance(value, dict):
        return {key: _shown(member) for key, member in value.items()}
    return [_shown(member) for member in value] if isinstance(value, list | tuple) else value


def config_lines(reports: Iterable[Report]) -> list[str]:
    """A line for each config file that took effect."""
    stated = (report.config for report in reports)
    return list(dict.fromkeys(config_line(config) for config in stated if config is not None))


def config_line(config: StatedConfig) -> str:
    """`Options of satcheck.toml: tolerance = 0.1, fail-on = "warning"`."""
    options = (f"{name} = {toml(value)}" for name, value in config.options.items())
    return f"Options of {config.file}: {', '.join(options)}"


def toml(value: OptionValue) -> str:
    """The value as TOML writes it; JSON writes texts, numbers and lists of texts alike."""
    return json.dumps(value, ensure_ascii=False)
