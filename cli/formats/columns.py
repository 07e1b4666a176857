"""The columns of the table of pairs, and which of them fit.

A terminal that is too narrow costs, in this order: the frame, figures in one line, names in one
line. Figures are broken between numbers only, and where that does not help there is no table
(cli/formats/table.py).
"""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

from msgspec import Struct
from msgspec.structs import replace
from rich.cells import cell_len, chop_cells

from satcheck.cli.formats.numbers import after_rounding, bounds, duration, number, vector
from satcheck.cli.formats.words import contacts, in_motion, interval, is_hit
from satcheck.report.report import OVERLAPS
from satcheck.scene.units import unit_of

if TYPE_CHECKING:
    from satcheck.report.report import Finding, Severity

# A table breaks no name into pieces shorter than this.
NARROWEST_NAME = 12
FRAME = 3  # characters between columns, and 1 more in all, with a frame ...
GAP = 2  # ... and without one
_PIECES = re.compile(r"[^\s_./-]*[\s_./-]*")


class Column(Struct, frozen=True):
    """Cells in the order of the findings. folds: figures, which may be broken between numbers.
    graded: in the colour of the severity."""

    name: str
    cells: tuple[str, ...]
    right: bool = False
    folds: bool = False
    graded: bool = False

    @property
    def widest(self) -> int:
        return max(cell_len(text) for text in (self.name, *self.cells))

    @property
    def longest_word(self) -> int:
        return max(
            cell_len(word) for text in (self.name, *self.cells) for word in text.split() or [""]
        )


class Layout(Struct, frozen=True):
    """Columns with their widths, as they fit a page."""

    columns: tuple[Column, ...]
    widths: tuple[int, ...]
    framed: bool

    @property
    def width(self) -> int:
        return _total(self.widths, framed=self.framed)


def columns_of(findings: Sequence[Finding], units: str | None, *, timings: bool) -> list[Column]:
    """Columns that say nothing are left out: those that are empty in every row, the severity where
    it is that of the relation, the quality where all is exact."""
    known = unit_of(units)
    unit = f" ({known})" if known else ""
    rounded = max((after_rounding(finding.mtv) for finding in findings), default="")
    placed = " as placed" if any(finding.motion is not None for finding in findings) else ""

    def column(
        name: str,
        cell: Callable[[Finding], str],
        *,
        right: bool = False,
        folds: bool = False,
        graded: bool = False,
    ) -> Column:
        return Column(name, tuple(cell(finding) for finding in findings), right, folds, graded)

    made = [
        column("A", lambda finding: finding.a),
        column("B", lambda finding: finding.b),
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


def fit(columns: Sequence[Column], width: int) -> Layout | None:
    """The layout that costs least; None where not even broken names help."""
    natural = [column.widest for column in columns]
    if _total(natural, framed=True) <= width:
        return Layout(tuple(columns), tuple(natural), framed=True)
    folded = [column.longest_word if column.folds else column.widest for column in columns]
    for least in (natural, folded):
        spare = width - _total(least, framed=False)
        if spare >= 0:
            return Layout(tuple(columns), _spread(columns, least, spare), framed=False)
    return _broken_names(columns, width)


def broken(name: str, width: int) -> str:
    """In lines of at most `width`, ended after `_`, `-`, `.`, `/` or a space where one is there."""
    lines = [""]
    for piece in _PIECES.findall(name):
        if cell_len(lines[-1]) + cell_len(piece) > width and lines[-1]:
            lines.append("")
        lines[-1] += piece
        lines[-1:] = chop_cells(lines[-1], width) or [""]
    return "\n".join(lines)


def _total(widths: Sequence[int], *, framed: bool) -> int:
    count = len(widths)
    return sum(widths) + (FRAME * count + 1 if framed else GAP * (count - 1))


def _spread(columns: Sequence[Column], least: Sequence[int], spare: int) -> tuple[int, ...]:
    """Spare width goes to the columns that fold, from left to right."""
    widths = []
    for column, width in zip(columns, least, strict=True):
        more = min(spare, column.widest - width)
        spare -= more
        widths.append(width + more)
    return tuple(widths)


def _broken_names(columns: Sequence[Column], width: int) -> Layout | None:
    """A and B share what the others leave; the shorter of them takes no more than it needs."""
    first, second, *others = columns
    rest = [column.longest_word if column.folds else column.widest for column in others]
    left = width - _total([0, 0, *rest], framed=False)
    a = min(first.widest, max(left // 2, left - second.widest))
    b = min(second.widest, left - a)
    if a < min(NARROWEST_NAME, first.widest) or b < min(NARROWEST_NAME, second.widest):
        return None
    named = [
        replace(column, cells=tuple(broken(cell, room) for cell in column.cells))
        for column, room in ((first, a), (second, b))
    ]
    return Layout((*named, *others), (a, b, *rest), framed=False)


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
