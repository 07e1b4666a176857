"""Markdown for people: a step summary of GitHub Actions, a comment on a merge request."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from satcheck.audit.words import counted
from satcheck.cli.formats.ci.problems import worst_problems
from satcheck.cli.formats.summary import config_lines, summary_line
from satcheck.cli.output import harmless
from satcheck.report.assets import ASSET_VERDICTS, AssetVerdict, asset

if TYPE_CHECKING:
    from collections.abc import Iterator

    from satcheck.cli.formats.registry import Reports

# GitHub cuts a step summary at 1 MiB; nobody reads more rows than these.
MOST_ROWS = 200
# What begins a list, a link (`://`, `www.`) or an emoji (`:x:`) does so in its place only.
_MARKUP = re.compile(r"([\\`*_\[\]<>#|~&@]|^[+-]|:(?=\S)|(?<=www)\.)", re.IGNORECASE)


def render(reports: Reports) -> Iterator[str]:
    return (f"{line}\n" for line in _lines(reports))


def _lines(reports: Reports) -> Iterator[str]:
    yield from ("## satcheck", "")
    told: dict[AssetVerdict, list[str]] = {verdict: [] for verdict in ASSET_VERDICTS}
    passing = 0
    for name, report in reports.items():
        verdict = asset(name, report).verdict
        if verdict == "pass" and len(reports) > 1:
            passing += 1
        elif len(told[verdict]) < MOST_ROWS:
            told[verdict].append(
                f"- **{verdict}** {as_text(name)}: {as_text(summary_line(report))}"
            )
    for lines in told.values():
        yield from lines
    if passing:
        yield f"- **pass** {counted(passing, 'report')}"
    for line in config_lines(reports.values()):
        yield from ("", as_text(line))
    worst, left_out = worst_problems(reports, MOST_ROWS)
    listed = [problem for problem in worst if problem.level != "note"]
    left_out += len(worst) - len(listed)
    if listed:
        yield from ("", "| severity | kind | what |", "|---|---|---|")
    for problem in listed:
        yield f"| {problem.level} | {as_text(problem.kind)} | {as_text(problem.message)} |"
    if left_out:
        yield from ("", f"{counted(left_out, 'more row')}: a JSON report has all.")


def as_text(text: str) -> str:
    """Names from files are text, never markup."""
    return _MARKUP.sub(r"\\\1", harmless(" ".join(text.split())))
