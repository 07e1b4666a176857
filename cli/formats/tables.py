"""Text for a page: lines that are folded to its width and painted in its colours, and tables.

A terminal that is too narrow costs a table, in this order: the frame, figures in one line, names in
one line. Figures are broken between words only, and where that does not help there is a paragraph
for each row.

A table of rich measures, wraps and styles every cell once more, which takes half a millisecond a
row, and its console takes a fifth of the start-up. Here rich folds the few texts that do not fit.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Iterator, Sequence
from typing import TYPE_CHECKING, Literal

from msgspec import Struct
from msgspec.structs import replace
from rich import box
from rich.cells import cell_len, chop_cells

from satcheck.cli.output import harmless

if TYPE_CHECKING:
    from satcheck.cli.output import Page

# Codes of ANSI escape sequences (ECMA-48, SGR).
BOLD, GREEN, YELLOW, CYAN, BOLD_RED, BOLD_MAGENTA = "1", "32", "33", "36", "1;31", "1;35"
# A table breaks no name into pieces shorter than this.
NARROWEST_NAME = 12
FRAME = 3  # characters between columns, and 1 more in all, with a frame ...
GAP = 2  # ... and without one
INDENT = 2
_PIECES = re.compile(r"[^\s_./-]*[\s_./-]*")


def paint(text: str, style: str) -> str:
    """Return the text between the escape sequences of a style; "" is none."""
    return f"\x1b[{style}m{text}\x1b[0m" if style else text


def fold(text: str, width: int, *, right: bool = False) -> list[str]:
    """Return lines of exactly `width` cells, broken between words where possible."""
    from rich.console import Console
    from rich.text import Text

    justify: Literal["left", "right"] = "right" if right else "left"
    folded = Text(text).wrap(Console(width=width), width, justify=justify, overflow="fold")
    return [line.plain for line in folded]


def fitted(text: str, page: Page, style: str = "") -> list[str]:
    """Return the text as lines of the page."""
    lines = [
        line
        for whole in text.split("\n")
        for line in ([whole] if cell_len(whole) <= page.width else fold(whole, page.width))
    ]
    return [paint(line, style if page.colour else "") for line in lines]


def fitted_each(texts: Iterable[str], page: Page) -> list[str]:
    """Return the texts as lines of the page."""
    return [line for text in texts for line in fitted(text, page)]


def joined(lines: Iterable[str], page: Page) -> str:
    """Return one text, without blanks at the ends of lines and what a terminal would obey."""
    return "".join(f"{harmless(line, colour=page.colour).rstrip()}\n" for line in lines)


class Column(Struct, frozen=True):
    """The cells of a column from top to bottom. folds: figures or words, which may be broken
    between words; named: names, which may be broken anywhere. graded: in the style of the row."""

    name: str
    cells: tuple[str, ...]
    right: bool = False
    folds: bool = False
    graded: bool = False
    named: bool = False

    @property
    def widest(self) -> int:
        return max(cell_len(line) for text in (self.name, *self.cells) for line in text.split("\n"))

    @property
    def least(self) -> int:
        """Return the width without which a word would be broken."""
        if not self.folds:
            return self.widest
        texts = (self.name, *self.cells)
        return max(cell_len(word) for text in texts for word in text.split() or [""])


class Layout(Struct, frozen=True):
    """Columns with their widths, as they fit a page."""

    columns: tuple[Column, ...]
    widths: tuple[int, ...]
    framed: bool

    @property
    def width(self) -> int:
        return _total(self.widths, framed=self.framed)


def table(
    columns: Sequence[Column],
    page: Page,
    styles: Sequence[str] | None = None,
    breaks: Collection[int] = (),
) -> list[str]:
    """Return the lines of a table, or of a paragraph for each row where the page is too narrow.

    styles: of each row, in the columns that are graded. breaks: the rows that begin behind a rule.
    """
    styles = [""] * len(columns[0].cells) if styles is None else styles
    layout = fit(columns, page.width)
    if layout is None:
        return list(stacked(columns[0].cells, columns[1:], page, styles))
    return list(Grid(layout, page, styles, breaks).lines())


def stacked(
    titles: Sequence[str], columns: Sequence[Column], page: Page, styles: Sequence[str]
) -> Iterator[str]:
    """Yield rows as paragraphs: a title, then a line for each figure. styles: of the titles."""
    for number, (title, style) in enumerate(zip(titles, styles, strict=True)):
        yield from fitted(title, page, style)
        for column in columns:
            if cell := column.cells[number]:
                yield from fitted(f"  {column.name}: {cell}", page)


def aligned(rows: Sequence[Sequence[str]], page: Page, *, bold: bool = True) -> list[str]:
    """Return indented rows without a frame. The last cell of a row is folded. bold: the first."""
    widths = [max(map(cell_len, cells)) for cells in zip(*rows, strict=True)][:-1]
    indent = sum(widths) + INDENT * (len(widths) + 1)
    room = max(page.width - indent, NARROWEST_NAME)
    lines = []
    for *cells, last in rows:
        head = [
            cell + " " * (width - cell_len(cell)) for cell, width in zip(cells, widths, strict=True)
        ]
        head[0] = paint(head[0], BOLD if bold and page.colour else "")
        text, *more = [last] if cell_len(last) <= room else fold(last, room)
        lines.append("".join(f"{' ' * INDENT}{cell}" for cell in (*head, text)))
        lines += [f"{' ' * indent}{text}" for text in more]
    return lines


def fit(columns: Sequence[Column], width: int) -> Layout | None:
    """Return the layout that costs least; None where not even broken names help."""
    natural = [column.widest for column in columns]
    if _total(natural, framed=True) <= width:
        return Layout(tuple(columns), tuple(natural), framed=True)
    for least in (natural, [column.least for column in columns]):
        spare = width - _total(least, framed=False)
        if spare >= 0:
            return Layout(tuple(columns), _spread(columns, least, spare), framed=False)
    return _broken_names(columns, width)


def broken(name: str, width: int) -> str:
    """Return the name in lines of at most `width`, ended after `_`, `-`, `.`, `/` or a space where
    one is there."""
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
    """Names share what the other columns leave; a short one takes no more than it needs."""
    widths = [0 if column.named else column.least for column in columns]
    left = width - _total(widths, framed=False)
    names = [k for k, column in enumerate(columns) if column.named]
    half = -(-left // max(len(names), 1))
    for count, k in enumerate(sorted(names, key=lambda k: min(columns[k].widest, half))):
        widths[k] = min(columns[k].widest, left // (len(names) - count))
        left -= widths[k]
        if widths[k] < min(NARROWEST_NAME, columns[k].widest):
            return None
    if left < 0 or not names:
        return None
    named = tuple(
        replace(column, cells=tuple(broken(cell, room) for cell in column.cells))
        if column.named
        else column
        for column, room in zip(columns, widths, strict=True)
    )
    return Layout(named, tuple(widths), framed=False)


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
