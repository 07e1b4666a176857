"""Workflow commands of GitHub Actions: each problem becomes an annotation of its file. GitHub shows
the first ten errors and the first ten warnings of a step, so the worst come first."""

from __future__ import annotations

from typing import TYPE_CHECKING

from satcheck.cli.formats.ci.problems import near, problems
from satcheck.cli.formats.summary import config_lines, summary_line
from satcheck.cli.output import harmless

if TYPE_CHECKING:
    from satcheck.cli.formats.registry import Reports

_COMMANDS = {"error": "error", "warning": "warning", "note": "notice"}


def render(reports: Reports) -> list[str]:
    lines = []
    for problem in problems(reports):
        title = f"satcheck: {problem.kind}"
        place = problem.places[0]
        values = {"file": near(place.file), "line": str(place.line), "title": title}
        properties = ",".join(f"{name}={_property(value)}" for name, value in values.items())
        lines.append(f"::{_COMMANDS[problem.level]} {properties}::{_data(problem.message)}\n")
    lines += [f"{_own(line)}\n" for line in config_lines(reports.values())]
    lines += [f"{_own(f'{name}: {summary_line(r)}')}\n" for name, r in reports.items()]
    return lines


def _own(line: str) -> str:
    """Its begin is ours: a name at the begin of a line could form a command."""
    return _data(line if line.startswith("satcheck: ") else f"satcheck: {line}")


def _data(text: str) -> str:
    lines = map(harmless, text.replace("\r\n", "\n").split("\n"))
    return "%0A".join(line.replace("%", "%25") for line in lines)


def _property(text: str) -> str:
    return _data(text).replace(":", "%3A").replace(",", "%2C")
