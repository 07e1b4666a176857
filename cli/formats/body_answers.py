"""What a table and its last line say about single bodies: which rules they do not meet."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import groupby
from typing import TYPE_CHECKING

from satcheck.cli.formats.numbers import number
from satcheck.cli.formats.tables import BOLD, BOLD_RED, YELLOW, fitted
from satcheck.cli.formats.words import counted, with_unit
from satcheck.report.verdict import is_unmet
from satcheck.scene.units import unit_of

if TYPE_CHECKING:
    from satcheck.cli.output import Page
    from satcheck.report.regions import InsideFinding
    from satcheck.report.report import Report

MOST_BODIES = 40  # JSON has them all


def unmet(report: Report) -> list[str]:
    """`top is not stable: no contact forces hold it`, of each failing body once."""
    said: dict[str, str] = {}
    for answer in report.answers:
        if is_unmet(answer, report.settings.fail_on):
            sentence = f"{answer.body} is not {answer.question}: {answer.reason}"
            said.setdefault(answer.body, sentence)
    return list(said.values())


def undecided(report: Report) -> list[str]:
    """`the support of 2 bodies is open`."""
    held = report.support.findings if report.support else ()
    lying = report.regions.findings if report.regions else ()
    counts = {
        "the support of {} is open": len({f.body for f in held if f.answer == "open"}),
        "the region of {} is open": len({f.body for f in lying if f.answer == "open"}),
    }
    return [said.format(counted(n, "body", "bodies")) for said, n in counts.items() if n]


def region_lines(report: Report, page: Page) -> list[str]:
    """A line for each region with the number of bodies in it, and one for each other body."""
    regions = report.regions
    if not regions:
        return []
    unit = unit_of(report.units)
    lines = []
    findings = sorted(regions.findings, key=lambda finding: finding.region)
    for region, group in groupby(findings, key=lambda finding: finding.region):
        own = list(group)
        count = sum(finding.answer == "yes" for finding in own)
        tolerance = with_unit(number(regions.tolerance), unit)
        said = f"Inside {region}: {count} of {counted(len(own), 'body', 'bodies')}"
        lines += fitted(f"{said} (tolerance {tolerance})", page, BOLD)
        lines += _others(own, page)
    return lines


def _others(findings: list[InsideFinding], page: Page) -> Iterator[str]:
    """Bodies that are outside first."""
    others = [finding for finding in findings if finding.answer != "yes"]
    others.sort(key=lambda finding: finding.answer)  # no before open
    for finding in others[:MOST_BODIES]:
        state = "not inside" if finding.answer == "no" else "open"
        style = BOLD_RED if finding.answer == "no" else YELLOW
        yield from fitted(f"  {finding.body}: {state}: {finding.reason}", page, style)
    if (rest := len(others) - MOST_BODIES) > 0:
        yield from fitted(f"  and {counted(rest, 'more body', 'more bodies')}", page)
