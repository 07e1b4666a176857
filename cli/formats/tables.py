"""Text for a page, by rich: lines that are folded to its width and painted in its colours, and
tables.

Where a page is too narrow, columns give way, the widest first: names are broken anywhere, figures
between words only. Where that does not help, there is a paragraph for each row. What draws with
rich imports it: the lines that are said beside a file do not need it.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from functools import cache
from io import StringIO
from typing import TYPE_CHECKING, Literal

from msgspec import Struct
from msgspec.structs import replace
from rich.cells import cell_len, chop_cells

from satcheck.audit.words import counted
from satcheck.cli.output import harmless

if TYPE_CHECKING:
    from rich.console import Console
    from rich.table import Table
    from rich.text import Text

    from satcheck.cli.output import Page
    from satcheck.report.assets import AssetVerdict

# Styles of rich.
BOLD, GREEN, YELLOW, CYAN = "bold", "green", "yellow", "cyan"
BOLD_RED, BOLD_MAGENTA = "bold red", "bold magenta"
# Of a row about a pose or an asset. Colour only repeats what the word says.
VERDICT_STYLES: dict[AssetVerdict, str] = {
    "pass": GREEN,
    "fail": BOLD_RED,
    "incomplete": BOLD_MAGENTA,
    "error": BOLD_MAGENTA,
}
# A table has at most so many rows, unless --top says how many.
ROWS = 60
# A table breaks no name into pieces shorter than this.
NARROWEST_NAME = 12
GAP = 2  # characters between columns
INDENT = 2
_ASCII = str.maketrans({"±": "+-", "─": "-"})
_PIECES = re.compile(r"[^\s_./-]*[\s_./-]*")


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
        if self.named:
            return min(self.widest, NARROWEST_NAME)
        if not self.folds:
            return self.widest
        texts = (self.name, *self.cells)
        return max(cell_len(word) for text in texts for word in text.split() or [""])


def table(columns: Sequence[Column], page: Page, styles: Sequence[str] | None = None) -> list[str]:
    """Return the lines of a table, or of a paragraph for each row where the page is too narrow.

    styles: of each row, in the columns that are graded.
    """
    from rich import box
    from rich.table import Table
    from rich.text import Text

    styles = [""] * len(columns[0].cells) if styles is None else styles
    columns = [
        replace(column, cells=tuple(map(harmless, column.cells))) if column.named else column
        for column in columns
    ]
    widths = _widths(columns, page.width)
    if widths is None:
        return list(_paragraphs(columns, page, styles))
    made = Table(
        box=box.SIMPLE_HEAD,
        show_edge=False,
        pad_edge=False,
        padding=(0, GAP - 1, 0, 0),
    )
    for column, width in zip(columns, widths, strict=True):
        justify: Literal["left", "right"] = "right" if column.right else "left"
        made.add_column(column.name, justify=justify, width=width, overflow="fold")
    rows = zip(*(column.cells for column in columns), strict=True)
    for cells, style in zip(rows, styles, strict=True):
        texts = [
            Text(broken(cell, width) if column.named else cell, style if column.graded else "")
            for cell, column, width in zip(cells, columns, widths, strict=True)
        ]
        made.add_row(*texts)
    return _drawn(made, page)


def fitted(text: str, page: Page, style: str = "") -> list[str]:
    """Return the text as lines of the page. All but the first are indented: no name in it can pass
    for a line of our own."""
    text = harmless(text)
    lines = [text]
    if (style and page.colour) or cell_len(text) > page.width:
        from rich.text import Text

        narrow = page._replace(width=max(page.width - INDENT, 1))
        lines = _drawn(Text(text, style), narrow)
    return [lines[0], *(f"{' ' * INDENT}{line}" for line in lines[1:])]


def fitted_each(texts: Iterable[str], page: Page) -> list[str]:
    """Return the texts as lines of the page."""
    return [line for text in texts for line in fitted(text, page)]


def joined(lines: Iterable[str], page: Page) -> str:
    """Return one text, without blanks at the ends of lines and what a terminal would obey."""
    text = "".join(f"{harmless(line, colour=page.colour).rstrip()}\n" for line in lines)
    return text if page.unicode else text.translate(_ASCII)


def hidden(count: int, singular: str, plural: str | None = None) -> list[str]:
    """Return `5 more pairs not shown: see --top`; nothing for none."""
    return [f"{counted(count, f'more {singular}', plural)} not shown: see --top"] if count else []


def all_begin(root: str) -> list[str]:
    """Return a line about the beginning that the names of a table leave out."""
    return [f"All names begin with {root}"] if root else []


def aligned(rows: Iterable[Sequence[str]], page: Page, *, bold: bool = True) -> list[str]:
    """Return indented rows without a head. bold: the first cell of each."""
    from rich.table import Table
    from rich.text import Text

    grid = Table.grid(padding=(0, GAP, 0, 0))
    for cells in rows:
        first, *others = map(harmless, cells)
        grid.add_row(Text(first, BOLD if bold else ""), *map(Text, others))
    lines = _drawn(grid, page._replace(width=max(page.width - INDENT, 1)))
    return [f"{' ' * INDENT}{line}" for line in lines]


def broken(name: str, width: int) -> str:
    """Return the name in lines of at most `width`, ended after `_`, `-`, `.`, `/` or a space where
    one is there. All but the first are indented, as those of a text."""
    if cell_len(name) <= width:
        return name
    lines = [""]
    for piece in _PIECES.findall(name):
        if cell_len(lines[-1]) + cell_len(piece) >= width and lines[-1]:
            lines.append("")
        lines[-1] += piece
        lines[-1:] = chop_cells(lines[-1], width - 1) or [""]
    return "\n ".join(lines)


def _widths(columns: Sequence[Column], room: int) -> list[int] | None:
    """Return the widths of the columns; None: there is not room enough."""
    room -= GAP * (len(columns) - 1)
    widths, least = [column.widest for column in columns], [column.least for column in columns]
    if sum(least) > room:
        return None
    while sum(widths) > room:
        wide = [k for k, width in enumerate(widths) if width > least[k]]
        widths[max(wide, key=widths.__getitem__)] -= 1
    return widths


def _paragraphs(columns: Sequence[Column], page: Page, styles: Sequence[str]) -> Iterator[str]:
    """Yield the names of each row, then a line for each other cell."""
    names = [column for column in columns if column.named] or columns[:1]
    others = [column for column in columns if column not in names]
    for number, style in enumerate(styles):
        yield from fitted(" and ".join(column.cells[number] for column in names), page, style)
        for column in others:
            if cell := column.cells[number]:
                yield from fitted(f"  {column.name}: {cell}", page)


@cache
def _console(page: Page) -> Console:
    from rich.console import Console

    return Console(
        file=StringIO(),
        width=page.width,
        height=1,
        color_system="standard" if page.colour else None,
        force_terminal=page.colour,
        no_color=not page.colour,
        legacy_windows=False,
    )


def _drawn(drawn: Table | Text, page: Page) -> list[str]:
    console = _console(page)
    with console.capture() as capture:
        console.print(drawn, overflow="fold")
    return capture.get().split("\n")[:-1]
