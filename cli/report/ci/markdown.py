"""Markdown for people: a step summary of GitHub Actions, a comment on a merge request."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from satcheck.cli.report.ci.problems import problems
from satcheck.cli.report.config import config_lines
from satcheck.cli.report.verdict import summary_line
from satcheck.cli.report.words import counted
from satcheck.report.assets import asset

if TYPE_CHECKING:
    from satcheck.cli.report.ci import Reports

# GitHub cuts a step summary at 1 MiB; nobody reads more rows than these.
MOST_ROWS = 200
_MARKUP = re.compile(r"([\\`*_{}\[\]()<>#+\-!|~&@:])")


def render(reports: Reports) -> list[str]:
    listed = problems(reports)
    lines = ["## satcheck", ""]
    for name, report in reports.items():
        verdict = asset(name, report).verdict
        lines.append(f"- **{verdict}** {as_text(name)}: {as_text(summary_line(report))}")
    for line in config_lines(reports.values()):
        lines += ["", as_text(line)]
    if listed:
        lines += ["", "| severity | kind | what |", "|---|---|---|"]
        lines += [
            f"| {problem.level} | {as_text(problem.kind)} | {as_text(problem.message)} |"
            for problem in listed[:MOST_ROWS]
        ]
    if len(listed) > MOST_ROWS:
        lines += ["", f"{counted(len(listed) - MOST_ROWS, 'more row')}: see the JSON report."]
    return [f"{line}\n" for line in lines]


def as_text(text: str) -> str:
    """Names from files are text, never markup."""
    return _MARKUP.sub(r"\\\1", " ".join(text.split()))
