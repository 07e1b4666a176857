"""`--components`: where the bodies of each pair overlap, the thickest places first."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from satcheck.cli.formats.numbers import at_most, bounds, number, vector
from satcheck.cli.formats.tables import BOLD, fitted
from satcheck.cli.formats.words import NEGLIGIBLE, counted

if TYPE_CHECKING:
    from satcheck.cli.output import Page
    from satcheck.report.components import Component
    from satcheck.report.report import Finding

# Of each pair; JSON has them all.
MOST_COMPONENTS = 8


def component_lines(page: Page, findings: Sequence[Finding]) -> list[str]:
    """The lines between the table and the remarks."""
    lines: list[str] = []
    for finding in findings:
        if finding.components is None or not (items := finding.components.items):
            continue
        title = f"{finding.a} and {finding.b}: {counted(len(items), 'connected overlap')}"
        title += "" if finding.components.resolved else ", perhaps not all"
        lines += fitted(title, page, BOLD)
        for item in items[:MOST_COMPONENTS]:
            lines += fitted("  " + ", ".join(facts(item, finding)), page)
        if rest := len(items) - MOST_COMPONENTS:
            lines += fitted(f"  {counted(rest, 'thinner one')}", page) if rest > 0 else []
    return lines


def facts(item: Component, finding: Finding) -> Iterator[str]:
    if item.thickness_bounds is None:
        yield "thickness not known"
    else:
        low, high = item.thickness_bounds
        yield f"{'<= ' + at_most(high) if low <= NEGLIGIBLE * high else bounds(low, high)} thick"
    yield f"at {vector(item.point)}"
    if item.volume is not None:
        yield f"volume {number(item.volume)}"
    if item.passes in ("a-through-b", "both"):
        yield f"{finding.a} passes through {finding.b}"
    if item.passes in ("b-through-a", "both"):
        yield f"{finding.b} passes through {finding.a}"
