"""Pairs as paragraphs, for a terminal that is too narrow for a table."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from satcheck.cli.formats.lines import fitted

if TYPE_CHECKING:
    from satcheck.cli.formats.columns import Column
    from satcheck.cli.output import Page


def stacked(columns: Sequence[Column], page: Page, styles: Sequence[str]) -> Iterator[str]:
    """`box and lid: penetrating`, then a line for each figure.

    columns: A, B and the relation come first. styles: of each pair.
    """
    a, b, relation, *others = columns
    rows = zip(a.cells, b.cells, relation.cells, styles, strict=True)
    for number, (first, second, told, style) in enumerate(rows):
        yield from fitted(f"{first} and {second}: {told}", page, style)
        for column in others:
            if cell := column.cells[number]:
                yield from fitted(f"  {column.name}: {cell}", page)
