"""The report as a table: one row for each pair, the worst first, then remarks and the summary."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
from itertools import accumulate, chain, pairwise
from typing import TYPE_CHECKING

from satcheck.audit.settings import LISTED_PAIRS
from satcheck.audit.words import (
    after_rounding,
    bounds,
    counted,
    duration,
    in_motion,
    interval,
    is_hit,
    is_unusable,
    number,
    past_holes,
    severity,
    vector,
    worst_first,
)
from satcheck.cli.formats.remarks import remarks
from satcheck.cli.formats.summary import config_line, counts_line, next_step
from satcheck.cli.formats.tables import (
    BOLD_MAGENTA,
    BOLD_RED,
    CYAN,
    GREEN,
    YELLOW,
    Column,
    Grid,
    fit,
    fitted,
    joined,
    stacked,
)
from satcheck.report.report import OVERLAPS
from satcheck.scene.units import unit_of

if TYPE_CHECKING:
    from satcheck.cli.output import Page
    from satcheck.report.report import Finding, Report, Severity

# Colour only repeats what the words beside it say. A touch is a note, too.
_STYLES: dict[Severity, str] = {
    "error": BOLD_RED,
    "warning": YELLOW,
    "note": CYAN,
    "silenced": "",
    "none": GREEN,
}


def render(
    report: Report, page: Page, *, explain: bool, timings: bool, top: int | None = None
) -> str:
    """The whole text, final newline included. Errors are not in it: they go to stderr.

    top: how many pairs at most; all count in the summary.
    """
    rows = worst_first(_listed(report))
    groups = groups_of(rows[:top], _titled(report))
    shown = list(chain.from_iterable(groups))
    lines: list[str] = []
    if shown:
        columns = columns_of(shown, report.units, timings=explain and timings)
        styles = [_style(finding) for finding in shown]
        layout = fit(columns, page.width)
        if layout is None:
            titles = [f"{each.a} and {each.b}: {each.relation}" for each in shown]
            lines += stacked(titles, columns[3:], page, styles)
        else:
            lines += Grid(layout, page, styles, set(_breaks(groups))).lines()
    for rest in _left_out(report, rows, top):
        lines += fitted(rest, page)
    if any(finding.components for finding in shown):
        from satcheck.cli.formats.details import component_lines

        lines += component_lines(page, shown)
    if report.support is not None:
        from satcheck.cli.formats.details import support_lines

        lines += support_lines(report, page)
    if report.regions:
        from satcheck.cli.formats.details import region_lines

        lines += region_lines(report, page)
    if explain:
        from satcheck.cli.formats.explain import explanation  # rich's tables

        lines += explanation(page, report, shown, timings=timings)
    for remark in remarks(report, shown):
        lines += fitted(remark.text, page, remark.style)
    if report.config is not None:
        lines += fitted(config_line(report.config), page)
    lines += fitted(counts_line(report), page)
    lines += fitted(" ".join([report.message, *next_step(report)]), page)
    return joined(lines, page)


def _listed(report: Report) -> Sequence[Finding]:
    """What could be examined; of more than LISTED_PAIRS only what is not plainly separated, at rest
    and on the way."""
    unusable = {body.id for body in report.bodies if is_unusable(body)}
    findings = [f for f in report.findings if f.a not in unusable and f.b not in unusable]
    if len(findings) > LISTED_PAIRS:
        findings = [f for f in findings if _is_told(f)]
    return findings


def _is_told(finding: Finding) -> bool:
    if finding.relation != "separated":
        return True
    return finding.reason is not None and not past_holes(finding)


def _titled(report: Report) -> set[str]:
    """The ids of elements that have names of their own, such as those of IFC files."""
    return {body.id for body in report.bodies if body.path is not None and body.name != body.id}


def _style(finding: Finding) -> str:
    return BOLD_MAGENTA if finding.relation == "indeterminate" else _STYLES[severity(finding)]


def _breaks(groups: Sequence[Sequence[Finding]]) -> Iterator[int]:
    """The rows that begin behind a rule: where a group of several findings begins or ends."""
    ends = accumulate(map(len, groups))
    for end, (before, after) in zip(ends, pairwise(groups), strict=False):
        if severity(before[0]) != "none" and (len(before) > 1 or len(after) > 1):
            yield end


def _left_out(report: Report, rows: Sequence[Finding], top: int | None) -> Iterator[str]:
    hidden = len(rows[top:]) if top else 0
    if hidden:
        yield f"{counted(hidden, 'more pair')} not shown (--top {top})"
    listed = sum(finding.relation == "separated" for finding in rows)
    rest = report.summary.by_relation.get("separated", 0) - listed
    if rows and rest:
        yield f"{counted(rest, 'more pair')}, all separated"


def columns_of(findings: Sequence[Finding], units: str | None, *, timings: bool) -> list[Column]:
    """Columns that say nothing are left out: those that are empty in every row, the severity where
    it is that of the relation, the quality where all is exact."""
    known = unit_of(units)
    unit = f" ({known})" if known else ""
    rounded = max((after_rounding(finding.mtv) for finding in findings), default="")
    placed = " as placed" if any(finding.motion is not None for finding in findings) else ""

    def column(name: str, cell: Callable[[Finding], str], **how: bool) -> Column:
        return Column(name, tuple(map(cell, findings)), **how)

    made = [
        column("A", lambda finding: finding.a, named=True),
        column("B", lambda finding: finding.b, named=True),
        column("relation", lambda finding: finding.relation, graded=True),
        column(f"gap{unit}", _gap, right=True, folds=True),
        column(f"thickness{unit}", _overlap("thickness", findings), right=True, folds=True),
        column(f"depth{unit}", _overlap("depth", findings), right=True, folds=True),
        column(f"move A by{unit}{rounded}", _mtv, folds=True),
        column(f"volume{placed}{f' ({known}^3)' if known else ''}", _volume, right=True),
        column(f"contact{placed}", contacts, folds=True),
        column("in motion", lambda finding: in_motion(finding, known), folds=True),
    ]
    if any(finding.severity != _implied(finding) or finding.baseline_state for finding in findings):
        made.insert(3, column("severity", _severity, graded=True))
    if any(finding.quality not in (None, "exact") for finding in findings):
        made.append(column("quality", lambda finding: finding.quality or ""))
    if timings:
        made.append(column("time", _time, right=True))
    return [each for each in made if any(each.cells)]


def _gap(finding: Finding) -> str:
    if finding.distance is None or finding.distance <= 0:
        return ""
    between = finding.distance_bounds
    return number(finding.distance) if between is None else bounds(*between)


def _overlap(figure: str, findings: Sequence[Finding]) -> Callable[[Finding], str]:
    """The cell of the thickness or the depth; where any is known, it says why others are not."""
    some = any(getattr(finding, figure) is not None for finding in findings)

    def cell(finding: Finding) -> str:
        text = interval(getattr(finding, f"{figure}_bounds"))
        if text or not some or finding.at_rest not in OVERLAPS:
            return text
        tried = any(stage.stage == figure for stage in finding.plan)
        return "not known" if tried else "not asked"

    return cell


def _implied(finding: Finding) -> Severity:
    """The severity of such a finding where no rule says otherwise."""
    if finding.relation in OVERLAPS or finding.relation == "near" or is_hit(finding):
        return "error"
    if finding.undecided is not None:
        return "warning"
    return "note" if finding.relation == "touching" else "none"


def _severity(finding: Finding) -> str:
    """`error`, `error, new`; a finding that the baseline holds, unchanged, is `known`."""
    said = "" if finding.severity == "none" else finding.severity
    state = finding.baseline_state
    return f"{said}, {'known' if state == 'unchanged' else state}" if state else said


def _volume(finding: Finding) -> str:
    return "" if finding.volume is None else number(finding.volume)


def _mtv(finding: Finding) -> str:
    if finding.mtv is None:
        return ""
    return vector(finding.mtv) + ("" if finding.mtv_verified else " not verified")


def _time(finding: Finding) -> str:
    return duration(sum(stage.microseconds for stage in finding.plan)) if finding.plan else ""


def groups_of(
    findings: Iterable[Finding], alone: Collection[str] = frozenset()
) -> list[list[Finding]]:
    """Findings that are the worst first: of one severity, all pairs between two parts in a group,
    which stands where its worst finding stands. alone: ids of bodies that are parts of their
    own."""
    groups: dict[tuple[str, frozenset[str]], list[Finding]] = {}
    for finding in findings:
        ids = finding.a, finding.b
        parts = frozenset(id_ if id_ in alone else _part(id_) for id_ in ids)
        groups.setdefault((severity(finding), parts), []).append(finding)
    return list(groups.values())


def _part(id_: str) -> str:
    """`gripper` of `gripper/left`: the node or the link that the body belongs to."""
    return id_.rpartition("/")[0] or id_


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
