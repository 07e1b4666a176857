"""The answer to a question in SQL about the results of a batch."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import islice
from pathlib import Path

from satcheck.batch.query import Tables
from satcheck.batch.stored import StoredResults
from satcheck.cli.formats.answer import render
from satcheck.cli.formats.words import issue_line
from satcheck.cli.output import Document, Page, talk
from satcheck.report.assets import AssetVerdict

FORMATS = ("table", "json", "jsonl", "csv", "parquet")


def answer(
    stored: StoredResults,
    query: str,
    form: str,
    output: Path | None,
    top: int | None,
    document: Document,
) -> AssetVerdict:
    """top: rows at most. The verdict is about the files of results alone."""
    with Tables(stored) as tables:
        document.deliver(
            lambda page: _render(tables, query, form, top, page), output, utf8=form != "table"
        )
    for issue in stored.issues:
        talk(f"satcheck: {issue_line(issue)}")
    return stored.least


def _render(
    tables: Tables, query: str, form: str, top: int | None, page: Page
) -> str | bytes | Iterable[str]:
    if form == "parquet":
        return tables.parquet(query)
    names, rows = tables.answer(query)
    return render(names, islice(rows, top), form, page)
