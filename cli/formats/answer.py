"""The answer to a query: rows as a table, JSON, JSON Lines or CSV."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from decimal import Decimal
from math import isfinite
from typing import TYPE_CHECKING, Any

from rich import box
from rich.table import Table
from rich.text import Text

from satcheck.cli.formats.canvas import Canvas
from satcheck.cli.formats.ci.csv import lines as csv_lines
from satcheck.cli.formats.numbers import number
from satcheck.cli.formats.words import counted
from satcheck.report.json import line

if TYPE_CHECKING:
    from satcheck.cli.output import Page

Rows = Iterable[Sequence[Any]]
# Columns of numbers.
_NUMBERS = (int, float, Decimal)


def render(names: Sequence[str], rows: Rows, form: str, page: Page) -> str | Iterable[str]:
    """names: of the columns. form: table, json, jsonl or csv. JSON has null for a number that is
    not finite, and a text for a value of a kind that it does not have, such as a date."""
    if form == "table":
        return _table(names, list(rows), page)
    if form == "csv":
        return _csv(names, rows)
    objects = (line(dict(zip(names, map(_plain, row), strict=True))) for row in rows)
    return objects if form == "jsonl" else _array(objects)


def _table(names: Sequence[str], rows: Sequence[Sequence[Any]], page: Page) -> str:
    console = Canvas(page)
    table = Table(box=box.ROUNDED if page.unicode else box.ASCII)
    for k, name in enumerate(names):
        right = any(isinstance(row[k], _NUMBERS) for row in rows)
        table.add_column(Text(name), justify="right" if right else "left", overflow="fold")
    for row in rows:
        table.add_row(*(Text(_cell(value)) for value in row))
    console.print(table)
    console.print(counted(len(rows), "row"))
    return console.text()


def _cell(value: Any) -> str:
    if value is None:
        return ""
    if isinstance(value, bool):
        return str(value).lower()
    return number(value) if isinstance(value, float) else str(value)


def _csv(names: Sequence[str], rows: Rows) -> Iterator[str]:
    yield csv_lines([names])
    for row in rows:
        yield csv_lines([row])


def _array(objects: Iterable[str]) -> Iterator[str]:
    before = "["
    for each in objects:
        yield f"{before}\n  {each.removesuffix(chr(10))}"
        before = ","
    yield "[]\n" if before == "[" else "\n]\n"


def _plain(value: Any) -> Any:
    """A JSON value."""
    if isinstance(value, float):
        return value if isfinite(value) else None
    if value is None or isinstance(value, bool | int | str):
        return value
    if isinstance(value, Decimal):
        return _plain(float(value))
    if isinstance(value, dict):
        return {str(key): _plain(each) for key, each in value.items()}
    return [_plain(each) for each in value] if isinstance(value, list | tuple) else str(value)
