"""The grid looks as a table of rich with the same columns does, which measures everything anew."""

from __future__ import annotations

import re
from io import StringIO

import pytest
from msgspec.structs import replace
from rich import box
from rich.console import Console
from rich.table import Table
from rich.text import Text

from satcheck.cli.formats.tables import BOLD_RED, Column, Grid, Layout, fit, joined
from satcheck.cli.output import Page

ESCAPES = re.compile(r"\x1b\[[0-9;]*m")
NAMES = ("box", "歯車_a_longer", "a\x1b[2A", "tab\there", "two\nlines", "\u202eb", "é" * 20, "")
COLUMNS = (
    Column("A", NAMES, named=True),
    Column("B", tuple(f"the_other_{k}" for k in range(len(NAMES))), named=True),
    Column("relation", ("penetrating", "near", *["coincident"] * (len(NAMES) - 2)), graded=True),
    Column("depth (mm)", ("1.24123 .. 1.25001", *["1"] * (len(NAMES) - 1)), right=True, folds=True),
    Column("quality", ("exact",) * len(NAMES)),
    Column("time", ("12 us",) * len(NAMES), right=True),
)


def of_rich(layout: Layout, page: Page) -> str:
    table = Table(box=box.ROUNDED if page.unicode else box.ASCII)
    if not layout.framed:
        table.box = box.SIMPLE_HEAD if page.unicode else box.ASCII2
        table.show_edge = table.pad_edge = False
        table.padding = (0, 1, 0, 0)
    for column, width in zip(layout.columns, layout.widths, strict=True):
        justify = "right" if column.right else "left"
        table.add_column(column.name, justify=justify, overflow="fold", width=width)  # type: ignore[arg-type]
    for cells in zip(*(column.cells for column in layout.columns), strict=True):
        table.add_row(*map(Text, cells))
    width = max(page.width, layout.width)
    console = Console(file=StringIO(), width=width, color_system=None, legacy_windows=False)
    with console.capture() as capture:
        console.print(table)
    return joined(capture.get().splitlines(), page)


@pytest.mark.parametrize("colour", [False, True])
@pytest.mark.parametrize("unicode", [False, True])
@pytest.mark.parametrize("width", [70, 80, 90, 100, 120])
def test_as_rich_draws_it(width: int, unicode: bool, colour: bool) -> None:
    page = Page(width=width, colour=colour, unicode=unicode)
    layout = fit(COLUMNS, width)
    assert layout is not None
    styles = [BOLD_RED, *[""] * (len(NAMES) - 1)]
    drawn = joined(Grid(layout, page, styles).lines(), page)
    assert ("\x1b[1;31mpenetrating\x1b[0m" in drawn) == colour
    lines = [ESCAPES.sub("", line).rstrip() for line in drawn.splitlines()]
    plain = Page(width=width, colour=False, unicode=unicode)
    assert lines == of_rich(layout, plain).splitlines()


@pytest.mark.parametrize("width", [60, 120])
def test_a_rule_stands_before_a_break(width: int) -> None:
    page = Page(width=width, colour=False, unicode=True)
    layout = fit([replace(column, cells=column.cells[3:5]) for column in COLUMNS], width)
    assert layout is not None
    lines = list(Grid(layout, page, ["", ""], {1}).lines())
    first, second = (k for k, line in enumerate(lines) if "the_other" in line)
    between = lines[first + 1 : second]
    assert sum("─" in line for line in between) == 1


def test_a_page_too_narrow_for_names_has_no_layout() -> None:
    assert fit(COLUMNS, 40) is None
