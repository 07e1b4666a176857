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
from satcheck.report.colliders import OF_COLLIDERS, STICKS_OUT
from satcheck.report.report import Finding, Issue, Witness, finding_id
from satcheck.scene.units import unit_of

if TYPE_CHECKING:
    from collections.abc import Iterator

    from satcheck.cli.output import Page
    from satcheck.report.colliders import ColliderPart, CollidersReport, Reach
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
            f"closes{named}": [
                f">= {at_least(part.opening.diameter)}" if part.opening else "" for part in shown
            ],
        }
        columns = [Column("link", tuple(part.name for part in shown), named=True)]
        columns += [Column(name, tuple(own), right=True) for name, own in cells.items()]
        verdicts = tuple(part.verdict or "" for part in shown)
        columns.append(Column("verdict", verdicts, graded=True))
        columns.append(Column("reason", tuple(part.reason or "" for part in shown), folds=True))
        lines += table(columns, page, [VERDICT_STYLES[verdict or "pass"] for verdict in verdicts])
    lines += fitted_each(hidden(len(report.parts) - len(shown), "link"), page)
    for part in shown[:_TOLD]:
        lines += fitted_each([each.message for each in _findings(part, report)], page)
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


def as_report(
    report: CollidersReport, checked: Report, visual: Scene, collision: Scene
) -> tuple[Report, Scene]:
    """Return the check of the colliders with a finding for each figure about a link, and the scene
    of the colliders and of what is drawn."""
    drawn = [replace(body, id=_drawn(body.id), name=_drawn(body.id)) for body in visual.bodies]
    order = tuple(body.id for body in drawn)
    placed = place(replace(visual, bodies=tuple(drawn), order=order), Settings())
    findings, issues = [*checked.findings], [*checked.issues]
    for part in report.parts:
        own = list(_findings(part, report))
        findings += own
        if part.verdict in ("fail", "incomplete") and all(f.severity == "note" for f in own):
            why = Issue("not-measured", "warning", None, None, f"{part.name}: {part.reason}")
            issues.append(replace(why, severity="error") if part.verdict == "fail" else why)
    listed = replace(
        checked,
        bodies=(*checked.bodies, *body_reports(placed)),
        findings=tuple(findings),
        issues=tuple(issues),
    )
    return listed, replace(collision, bodies=(*collision.bodies, *drawn))


def _findings(part: ColliderPart, report: CollidersReport) -> Iterator[Finding]:
    """Yield one for each figure that is not 0, about a collider and a drawn body."""
    unit = unit_of(report.units)
    for rule, reach, most in part.reaches(report.settings):
        if reach is None or (at := reach.farthest) is None:
            continue
        low, high = reach.bounds
        said = f"{part.name}: {OF_COLLIDERS[rule]} by {figure(reach.bounds, unit)}"
        said += f" at {vector(at.point)}"
        a, b = _drawn(at.body), at.nearest_body
        if rule == STICKS_OUT:
            a, b = at.body, _drawn(at.nearest_body)
            if (opening := part.opening) is not None:
                wide = with_unit(at_least(opening.diameter), unit)
                where, way = vector(opening.point), vector(opening.direction)
                said += f"; closes an opening at least {wide} wide at {where}, along {way}"
        is_open = most is not None and low <= most < high
        yield Finding(
            id=finding_id(f"{rule} {at.body}", at.nearest_body),
            a=a,
            b=b,
            rule=rule,
            severity="note" if most is None or high <= most else "warning" if is_open else "error",
            message=f"{said}.",
            undecided="limit" if is_open else None,
            relation="indeterminate",
            distance=low,
            witness=Witness(at.point, at.nearest),
            reason=reach.reason,
            plan=(),
        )


def _drawn(body: str) -> str:
    """Return its id beside the colliders, some of which may have the same."""
    return f"{body} (visual)"
