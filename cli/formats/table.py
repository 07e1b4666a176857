"""The report as a table: a row for each pair that fails, warns or is undecided, the worst first;
then remarks and the summary."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from typing import TYPE_CHECKING

from msgspec.structs import replace

from satcheck.audit.messages import has_no_pair, is_unsure, of_command, verdict_line
from satcheck.audit.words import (
    about,
    bounds,
    common_root,
    counted,
    duration,
    in_motion,
    interval,
    is_hit,
    is_unusable,
    is_wrong,
    number,
    vector,
    without_root,
    worst_first,
)
from satcheck.cli.formats.details import (
    component_lines,
    explanation,
    part_lines,
    region_lines,
    support_lines,
)
from satcheck.cli.formats.remarks import remarks
from satcheck.cli.formats.summary import closing, config_line
from satcheck.cli.formats.tables import (
    BOLD_MAGENTA,
    BOLD_RED,
    CYAN,
    GREEN,
    ROWS,
    YELLOW,
    Column,
    all_begin,
    fitted,
    fitted_each,
    hidden,
    joined,
    table,
)
from satcheck.report.report import OVERLAPS
from satcheck.report.verdict import severity
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

    explain: also the pairs that pass. top: how many pairs at most; all count in the summary.
    """
    if has_no_pair(report):
        return joined(fitted(of_command(report), page), page)
    names = [body.id for body in report.bodies]
    root = common_root(names) if len(names) > 1 and not report.answers else ""
    if root:
        report = without_root(report, root)
        report = replace(report, message=verdict_line(report))
    usable = _of_usable_bodies(report)
    few = explain or len(usable) == 1
    told = worst_first(usable if few else (f for f in usable if _is_told(f, report)))
    shown = told[: top or ROWS]
    lines: list[str] = []
    if shown:
        columns = columns_of(shown, report, explain=explain, timings=timings)
        lines += table(columns, page, list(map(_style, shown)))
    said = [*hidden(len(told) - len(shown), "pair"), *_passing(report, usable, told)]
    said += all_begin(root) if shown else []
    lines += fitted_each(said, page)
    if report.settings.components:
        lines += component_lines(page, shown)
    if report.settings.parts:
        lines += part_lines(page, shown)
    if report.support is not None:
        lines += support_lines(report.support, report.units, page)
    if report.regions:
        lines += region_lines(report.regions, report.units, page)
    if explain:
        lines += explanation(page, report, shown, timings=timings)
    lines += remarks(report, shown, page)
    if report.config is not None:
        lines += fitted(config_line(report.config), page)
    return joined([*lines, *fitted_each(closing(report), page)], page)


def _of_usable_bodies(report: Report) -> list[Finding]:
    unusable = {body.id for body in report.bodies if is_unusable(body)}
    return [f for f in report.findings if f.a not in unusable and f.b not in unusable]


def _is_told(finding: Finding, report: Report) -> bool:
    """Return whether the pair fails, warns, is undecided or has a figure that was asked for, or
    parts that are not separated."""
    if finding.part_pairs is not None and (finding.part_pairs.pairs or finding.part_pairs.remark):
        return True
    asked = report.settings.contacts or report.settings.volume or report.settings.components
    return is_wrong(finding) or (asked and finding.relation != "separated")


def _passing(report: Report, findings: Sequence[Finding], told: Sequence[Finding]) -> Iterator[str]:
    """Yield `3 touching, 15 separated pairs not shown`."""
    kinds = Counter(map(_kind, findings)) - Counter(map(_kind, told))
    listed = sum(finding.relation == "separated" for finding in findings)
    kinds["separated"] += report.summary.by_relation.get("separated", 0) - listed
    counts = [f"{count:,} {kind}" for kind, count in sorted(kinds.items()) if count > 0]
    if counts and (told or len(counts) > 1):
        yield f"{', '.join(counts)} {'pair' if kinds.total() == 1 else 'pairs'} not shown"


def _kind(finding: Finding) -> str:
    if finding.baseline_state == "unchanged":
        return "known"
    return "allowed" if finding.relation in OVERLAPS else finding.relation


def _style(finding: Finding) -> str:
    return BOLD_MAGENTA if finding.relation == "indeterminate" else _STYLES[severity(finding)]


def columns_of(
    findings: Sequence[Finding], report: Report, *, explain: bool, timings: bool
) -> list[Column]:
    """Columns that say nothing are left out: those that are empty in every row, the severity where
    it is that of the relation."""
    known = unit_of(report.units)
    unit = f" ({known})" if known else ""
    rounded = max((about(finding.mtv) for finding in findings), default="")
    moves = any(finding.motion is not None for finding in findings)
    placed = " as placed" if moves else ""

    def column(name: str, cell: Callable[[Finding], str], **how: bool) -> Column:
        return Column(name, tuple(map(cell, findings)), **how)

    made = [
        column("A", lambda finding: finding.a, named=True),
        column("B", lambda finding: finding.b, named=True),
        column("relation", lambda finding: _relation(finding, report), graded=True),
        column(f"gap{unit}", _gap, right=True, folds=True),
        column(f"thickness{unit}", _overlap("thickness", findings), right=True, folds=True),
        column(f"depth{unit}", _overlap("depth", findings), right=True, folds=True),
        column(f"move A by {rounded}".rstrip() + unit, _mtv, folds=True),
        column(f"volume{placed}{f' ({known}^3)' if known else ''}", _volume, right=True),
        column(f"contact{placed}", contacts, folds=True),
        column("in motion", lambda finding: _moving(finding, known, moves), folds=True),
    ]
    if any(finding.severity != _implied(finding) or finding.baseline_state for finding in findings):
        made.insert(3, column("severity", _severity, graded=True))
    if explain:
        made.append(column("quality", lambda finding: finding.quality or ""))
    if explain and timings:
        made.append(column("time", _time, right=True))
    return [each for each in made if any(each.cells)]


def _relation(finding: Finding, report: Report) -> str:
    if finding.quality != "estimate":
        return finding.relation
    sure = finding.at_rest in OVERLAPS and not is_unsure(finding, report)
    return "overlapping" if sure else f"possibly {finding.relation}"


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


def _moving(finding: Finding, unit: str | None, moves: bool) -> str:
    """moves: others do. Bodies that overlap and keep their places to each other always overlap."""
    if moves and finding.motion is None and finding.at_rest in OVERLAPS:
        return "throughout"
    return in_motion(finding, unit)


def _volume(finding: Finding) -> str:
    return "" if finding.volume is None else number(finding.volume)


def _mtv(finding: Finding) -> str:
    if finding.mtv is None:
        return ""
    return vector(finding.mtv) + ("" if finding.mtv_verified else " not verified")


def _time(finding: Finding) -> str:
    return duration(sum(stage.microseconds for stage in finding.plan)) if finding.plan else ""


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
