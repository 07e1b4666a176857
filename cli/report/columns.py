"""The columns of the table of pairs, and which of them fit.

A terminal that is too narrow costs, in this order: the frame, the column `time`, figures in one
line, the column `quality`, names in one line. Figures are broken between numbers only.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

from msgspec import Struct
from rich.cells import cell_len, chop_cells

from satcheck.cli.report.numbers import bounds, duration, number, vector
from satcheck.cli.report.words import contacts, in_motion, interval
from satcheck.report.report import OVERLAPS
from satcheck.scene.units import unit_of

if TYPE_CHECKING:
    from satcheck.report.report import Finding

# Narrower than this a name is not broken: the terminal may fold the row.
NARROWEST_NAME = 6
FRAME = 3  # characters between columns, and 1 more in all, with a frame ...
GAP = 2  # ... and without one
_PIECES = re.compile(r"[^\s_./-]*[\s_./-]*")


class Column(Struct, frozen=True):
    """Cells in the order of the findings. folds: figures, which may be broken between numbers."""

    name: str
    cells: tuple[str, ...]
    right: bool = False
    folds: bool = False

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
    """Columns that would be empty in every row are left out."""
    known = unit_of(units)
    unit = f" ({known})" if known else ""
    placed = " as placed" if any(finding.motion is not None for finding in findings) else ""

    def column(
        name: str, cell: Callable[[Finding], str], *, right: bool = False, folds: bool = False
    ) -> Column:
        return Column(name, tuple(cell(finding) for finding in findings), right, folds)

    made = [
        column("A", lambda finding: finding.a),
        column("B", lambda finding: finding.b),
        column("relation", lambda finding: finding.relation),
        column(f"gap{unit}", _gap, right=True, folds=True),
        column(f"thickness{unit}", _overlap("thickness", findings), right=True, folds=True),
        column(f"depth{unit}", _overlap("depth", findings), right=True, folds=True),
        column(f"move A by{unit}", _mtv, folds=True),
        column(f"volume{placed}{f' ({known}^3)' if known else ''}", _volume, right=True),
        column(f"contact{placed}", contacts, folds=True),
        column("in motion", lambda finding: in_motion(finding, known), folds=True),
        column("quality", lambda finding: finding.quality or ""),
    ]
    if timings:
        made.append(column("time", _time, right=True))
    return [each for each in made if any(each.cells)]


def fit(columns: Sequence[Column], width: int) -> Layout:
    """The layout that costs least; wider than `width` only where not even broken names help."""
    natural = [column.widest for column in columns]
    if _total(natural, framed=True) <= width:
        return Layout(tuple(columns), tuple(natural), framed=True)
    untimed = [column for column in columns if column.name != "time"]
    bare = [column for column in untimed if column.name != "quality"]
    for chosen, folded in ((columns, False), (untimed, False), (untimed, True), (bare, True)):
        least = [
            column.longest_word if folded and column.folds else column.widest for column in chosen
        ]
        spare = width - _total(least, framed=False)
        if spare >= 0:
            return Layout(tuple(chosen), _spread(chosen, least, spare), framed=False)
    return _broken_names(bare, width)


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


def _broken_names(columns: Sequence[Column], width: int) -> Layout:
    """A and B share what the others leave; the shorter of them takes no more than it needs."""
    first, second, *others = columns
    rest = [column.longest_word if column.folds else column.widest for column in others]
    left = max(width - _total([0, 0, *rest], framed=False), 2 * NARROWEST_NAME)
    a = min(first.widest, max(left // 2, left - second.widest))
    b = min(second.widest, left - a)
    named = [
        Column(column.name, tuple(broken(cell, room) for cell in column.cells))
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


def _volume(finding: Finding) -> str:
    return "" if finding.volume is None else number(finding.volume)


def _mtv(finding: Finding) -> str:
    if finding.mtv is None:
        return ""
    return vector(finding.mtv) + ("" if finding.mtv_verified else " not verified")


def _time(finding: Finding) -> str:
    return duration(sum(stage.microseconds for stage in finding.plan)) if finding.plan else ""
