"""The result of `satcheck resolve` as text: a row for each moved body, the remaining overlaps, a
summary."""

from __future__ import annotations

from typing import TYPE_CHECKING

from satcheck.audit.words import counted, number, vector, with_unit
from satcheck.cli.formats.summary import counts_line
from satcheck.cli.formats.tables import ROWS, Column, fitted_each, joined, table
from satcheck.scene.units import unit_of

if TYPE_CHECKING:
    from collections.abc import Sequence

    from satcheck.cli.output import Page
    from satcheck.report.report import Report
    from satcheck.report.resolution import Move, ResolutionReport, ResolutionSummary


def render(resolution: ResolutionReport, report: Report, page: Page) -> str:
    """Return the whole text, final newline included. report: of the moved scene."""
    shown = _shown(resolution.moves)
    said = []
    if rest := len(resolution.moves) - len(shown):
        said.append(f"{counted(rest, 'more body', 'more bodies')} moved by less")
    messages = {(finding.a, finding.b): finding.message for finding in report.findings}
    said += (
        f"not resolved: {messages[left.a, left.b].removesuffix('.')}: {left.reason}"
        for left in resolution.left
    )
    said.append(_motion_line(resolution, report))
    if resolution.summary.flush:
        pairs = counted(resolution.summary.flush, "pair")
        said.append(f"{pairs} within the tolerance: they count as touching.")
    subject = resolution.output or "The moved scene"
    said.append(f"{subject}, checked again: {counts_line(report)}")
    said.append(report.message)
    lines = _moves(shown, page) if shown else []
    return joined([*lines, *fitted_each(said, page)], page)


def _shown(moves: Sequence[Move]) -> list[Move]:
    """All in the order of the scene, or the longest first."""
    if len(moves) <= ROWS:
        return list(moves)
    return sorted(moves, key=lambda move: -move.length)[:ROWS]


def _moves(moves: Sequence[Move], page: Page) -> list[str]:
    columns = (
        Column("body", tuple(move.body for move in moves), named=True),
        Column("move by", tuple(vector(move.translation) for move in moves), folds=True),
        Column("length", tuple(number(move.length) for move in moves), right=True),
    )
    return table(columns, page)


def _conflicts(summary: ResolutionSummary) -> str:
    """`2 overlaps, 3 gaps below their clearance, 1 pair left open by a hole`."""
    overlaps = summary.conflicts - summary.gaps - summary.open
    below = counted(summary.gaps, "gap below its clearance", "gaps below their clearance")
    kinds = {
        counted(overlaps, "overlap"): overlaps,
        below: summary.gaps,
        counted(summary.open, "pair") + " left open by a hole": summary.open,
    }
    return ", ".join(text for text, count in kinds.items() if count)


def _motion_line(resolution: ResolutionReport, report: Report) -> str:
    """`2 overlaps: 3 bodies moved by 1.25 mm in total, at most 0.75 mm, in 2 rounds; 1 stays.`"""
    summary, unit = resolution.summary, unit_of(resolution.units)
    stays = ""
    if summary.pinned:
        stays = f" {counted(summary.pinned, 'body', 'bodies')} had to stay."
    if not summary.conflicts:
        where = "as the bodies are placed" if report.motions else "beyond what is allowed"
        return f"Nothing overlaps {where}: nothing was moved.{stays}"
    conflicts = _conflicts(summary)
    if not summary.moved:
        return f"{conflicts}: nothing was moved.{stays}"
    total, largest = (
        with_unit(number(length), unit) for length in (summary.total_motion, summary.largest_motion)
    )
    return (
        f"{conflicts}: {counted(summary.moved, 'body', 'bodies')} moved, "
        f"by {total} in total and {largest} at most, "
        f"in {counted(summary.rounds, 'round')}.{stays}"
    )
