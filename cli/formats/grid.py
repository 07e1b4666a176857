"""The table of pairs, drawn line by line.

Its columns have their widths already. A table of rich measures, wraps and styles every cell once
more, which takes half a millisecond a row, and its console takes a fifth of the start-up.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from typing import TYPE_CHECKING

from rich import box

from satcheck.cli.formats.lines import BOLD, fold, paint

if TYPE_CHECKING:
    from satcheck.cli.formats.columns import Layout
    from satcheck.cli.output import Page


class Grid:
    """The lines of a table, in the colours and characters of the page.

    styles: of each row, in the columns that are graded. breaks: the rows that begin behind a rule.
    """

    def __init__(
        self, layout: Layout, page: Page, styles: Sequence[str], breaks: Collection[int] = ()
    ) -> None:
        self._styles, self._breaks = styles, breaks
        self._columns = layout.columns
        self._widths = layout.widths
        self._colour = page.colour
        self._edge = layout.framed
        if layout.framed:
            self._box, self._before = (box.ROUNDED if page.unicode else box.ASCII), " "
            self._after = [" "] * len(layout.widths)
        else:  # two spaces between columns instead of three characters
            self._box, self._before = (box.SIMPLE_HEAD if page.unicode else box.ASCII2), ""
            self._after = [*([" "] * (len(layout.widths) - 1)), ""]
        self._spaces = [
            len(self._before) + width + len(after)
            for width, after in zip(self._widths, self._after, strict=True)
        ]

    def lines(self) -> Iterator[str]:
        if self._edge:
            yield self._box.get_top(self._spaces)
        names = [column.name for column in self._columns]
        yield from self._row(names, [BOLD] * len(names), sunk=True)
        yield self._box.get_row(self._spaces, "head", edge=self._edge)
        graded = [column.graded for column in self._columns]
        rows = zip(*(column.cells for column in self._columns), strict=True)
        for number, (cells, style) in enumerate(zip(rows, self._styles, strict=True)):
            if number in self._breaks:
                yield self._rule()
            yield from self._row(cells, [style if told else "" for told in graded])
        if self._edge:
            yield self._box.get_bottom(self._spaces)

    def _rule(self) -> str:
        """Between groups of rows."""
        return self._box.get_row(self._spaces, "row" if self._edge else "head", edge=self._edge)

    def _row(
        self, cells: Sequence[str], styles: Sequence[str], *, sunk: bool = False
    ) -> Iterator[str]:
        """sunk: cells with fewer lines than others are at the bottom."""
        columns = zip(cells, styles, self._columns, self._widths, self._after, strict=True)
        blocks = [
            [
                f"{self._before}{self._painted(line, style)}{after}"
                for line in self._wrapped(cell, width, right=column.right)
            ]
            for cell, style, column, width, after in columns
        ]
        height = max(map(len, blocks))
        for block, space in zip(blocks, self._spaces, strict=True):
            end = 0 if sunk else len(block)
            block[end:end] = [" " * space] * (height - len(block))
        for lines in zip(*blocks, strict=True):
            inner = self._box.mid_vertical.join(lines)
            yield f"{self._box.mid_left}{inner}{self._box.mid_right}" if self._edge else inner

    def _wrapped(self, cell: str, width: int, *, right: bool) -> list[str]:
        """Lines as wide as the column."""
        if len(cell) <= width and cell.isascii() and cell.isprintable():
            return [cell.rjust(width) if right else cell.ljust(width)]
        return fold(cell, width, right=right)

    def _painted(self, line: str, style: str) -> str:
        return paint(line, style) if style and self._colour else line
