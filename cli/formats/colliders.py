"""What `satcheck colliders` has found: a table with a row for each link, the worst first; and the
report of a check, for the other formats."""

from __future__ import annotations

from typing import TYPE_CHECKING

from msgspec.structs import replace

from satcheck.audit.bodies import place
from satcheck.audit.settings import Settings
from satcheck.audit.summary import body_reports
from satcheck.audit.words import (
    at_least,
    counted,
    figure,
    interval,
    vector,
    with_unit,
)
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
from satcheck.report.colliders import FALLS_SHORT, STICKS_OUT
from satcheck.report.report import Finding, Issue, Witness, finding_id
from satcheck.scene.units import unit_of

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from satcheck.cli.output import Page
    from satcheck.report.colliders import ColliderPart, CollidersReport, Farthest, Reach
    from satcheck.report.report import Report
    from satcheck.scene import Scene

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
        verdicts = tuple(part.verdict or "" for part in shown)
        columns.append(Column("verdict", verdicts, graded=True))
        columns.append(Column("reason", tuple(part.reason or "" for part in shown), folds=True))
        lines += table(columns, page, [VERDICT_STYLES[verdict or "pass"] for verdict in verdicts])
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
    summary = (
        f"{counted(len(report.parts), 'link')}, {counted(report.pairs.total, 'pair')} of colliders."
    )
    return joined([*lines, *fitted_each([*said, summary, report.message], page)], page)


def _reach(reach: Reach | None) -> str:
    if reach is None:
        return ""
    return interval(reach.bounds) if reach.bounds[1] else "0"


def _opening(part: ColliderPart) -> str:
    return f">= {at_least(part.opening.diameter)}" if part.opening else ""


def _places(part: ColliderPart, unit: str | None) -> Iterator[str]:
    for rule, reach in ((STICKS_OUT, part.out), (FALLS_SHORT, part.short)):
        if reach is not None and reach.farthest is not None:
            yield _sentence(part, rule, reach, reach.farthest, unit)


def _sentence(part: ColliderPart, rule: str, reach: Reach, at: Farthest, unit: str | None) -> str:
    said = "sticks out" if rule == STICKS_OUT else "falls short"
    said = f"{part.name}: {said} by {figure(reach.bounds, unit)} at {vector(at.point)}"
    if rule == FALLS_SHORT or (opening := part.opening) is None:
        return f"{said}."
    wide = with_unit(at_least(opening.diameter), unit)
    where, way = vector(opening.point), vector(opening.direction)
    return f"{said}; closes an opening at least {wide} wide at {where}, along {way}."


def as_report(
    report: CollidersReport, checked: Report, visual: Scene, collision: Scene
) -> tuple[Report, Scene]:
    """Return the check of the colliders with a finding for each figure about a link, and the scene
    of the colliders and of what is drawn."""
    names = {body.id: f"{body.id} (visual)" for body in visual.in_order()}
    drawn = [replace(body, id=names[body.id], name=names[body.id]) for body in visual.bodies]
    both = replace(collision, bodies=(*collision.bodies, *drawn))
    placed = place(replace(visual, bodies=tuple(drawn), order=tuple(names.values())), Settings())
    findings, told = [*checked.findings], set()
    for part in report.parts:
        for rule, reach, most in (
            (STICKS_OUT, part.out, report.settings.max_out),
            (FALLS_SHORT, part.short, report.settings.max_short),
        ):
            if reach is not None and (at := reach.farthest) is not None:
                said = _sentence(part, rule, reach, at, unit_of(report.units))
                finding = replace(_finding(rule, reach, at, most, names), message=said)
                findings.append(finding)
                if finding.severity != "note":
                    told.add(part.name)
    open_links = (
        part
        for part in report.parts
        if part.verdict in ("fail", "incomplete") and part.name not in told
    )
    issues = (
        Issue(
            "not-measured",
            "error" if part.verdict == "fail" else "warning",
            *(None, None, f"{part.name}: {part.reason}"),
        )
        for part in open_links
    )
    listed = replace(
        checked,
        bodies=(*checked.bodies, *body_reports(placed)),
        findings=tuple(findings),
        issues=(*checked.issues, *issues),
    )
    return listed, both


def _finding(
    rule: str, reach: Reach, at: Farthest, most: float | None, names: Mapping[str, str]
) -> Finding:
    """most: the limit. names: of the drawn bodies."""
    low, high = reach.bounds
    is_out, is_open = rule == STICKS_OUT, most is not None and low <= most < high
    return Finding(
        id=finding_id(f"{rule} {at.body}", at.nearest_body),
        a=at.body if is_out else names[at.body],
        b=names[at.nearest_body] if is_out else at.nearest_body,
        rule=rule,
        severity="note" if most is None or high <= most else "warning" if is_open else "error",
        undecided="limit" if is_open else None,
        relation="separated",
        distance=low,
        witness=Witness(at.point, at.nearest),
        reason=reach.reason,
        plan=(),
    )
