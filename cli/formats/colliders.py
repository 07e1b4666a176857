"""What `satcheck colliders` has found, as a table: a row for each link, the worst first."""

from __future__ import annotations

from typing import TYPE_CHECKING

from satcheck.audit.words import at_least, counted, interval, vector, with_unit
from satcheck.cli.formats.summary import MESHES
from satcheck.cli.formats.table import columns_of
from satcheck.cli.formats.tables import (
    ROWS,
    VERDICT_STYLES,
    Column,
    fitted_each,
    hidden,
    joined,
    table,
)
from satcheck.cli.output import issue_line
from satcheck.scene.units import unit_of

if TYPE_CHECKING:
    from collections.abc import Iterator

    from satcheck.cli.output import Page
    from satcheck.report.colliders import ColliderPart, CollidersReport, Reach
    from satcheck.report.report import Report

# Links whose places are told.
_TOLD = 3


def render(report: CollidersReport, checked: Report, page: Page, *, top: int | None = None) -> str:
    """checked: the check of the colliders. top: how many rows at most."""
    unit = unit_of(report.units)
    named = f" ({unit})" if unit else ""
    shown = report.parts[: top or ROWS]
    lines = []
    if shown:
        cells = {
            f"sticks out{named}": [_reach(part.out) for part in shown],
            f"falls short{named}": [_reach(part.short) for part in shown],
            f"closes{named}": [_opening(part) for part in shown],
        }
        columns = [Column("link", tuple(part.name for part in shown), named=True)]
        columns += [Column(name, tuple(own), right=True) for name, own in cells.items()]
        verdicts = tuple(part.verdict for part in shown)
        columns.append(Column("verdict", verdicts, graded=True))
        columns.append(Column("", tuple(part.reason or "" for part in shown), folds=True))
        lines += table(columns, page, [VERDICT_STYLES[verdict] for verdict in verdicts])
    lines += fitted_each(hidden(len(report.parts) - len(shown), "link"), page)
    for part in shown[:_TOLD]:
        lines += fitted_each(_places(part, unit), page)
    overlaps = report.overlaps[: top or ROWS]
    if overlaps:
        lines += table(columns_of(overlaps, checked, explain=False, timings=False), page)
        lines += fitted_each(hidden(len(report.overlaps) - len(overlaps), "pair"), page)
    said = [f"note: {part.name}: {note}" for part in shown for note in part.notes]
    told = (i for i in report.issues if i.severity == "warning" and i.code not in MESHES)
    said += map(issue_line, told)
    summary = f"{counted(len(report.parts), 'link')}, {counted(report.pairs.total, 'pair')} of colliders."
    return joined([*lines, *fitted_each([*said, summary, report.message], page)], page)


def _reach(reach: Reach | None) -> str:
    if reach is None:
        return ""
    return interval(reach.bounds) if reach.bounds[1] else "0"


def _opening(part: ColliderPart) -> str:
    return f">= {at_least(part.opening.diameter)}" if part.opening else ""


def _places(part: ColliderPart, unit: str | None) -> Iterator[str]:
    """Yield `link5: sticks out at (1, 0, 0); closes 88 mm at (0, 0, 0), along (1, 0, 0)`."""
    said = [
        f"{verb} at {vector(reach.point)}"
        for verb, reach in (("sticks out", part.out), ("falls short", part.short))
        if reach is not None and reach.point is not None
    ]
    if (opening := part.opening) is not None:
        wide = with_unit(at_least(opening.diameter), unit)
        way = vector(opening.direction)
        said.append(f"closes an opening {wide} wide at {vector(opening.point)}, along {way}")
    if said:
        yield f"{part.name}: {'; '.join(said)}"
