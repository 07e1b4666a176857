"""The answer to a question in SQL about the results of a batch."""

from __future__ import annotations

from itertools import islice
from pathlib import Path

from satcheck.batch.query import Tables, require_duckdb
from satcheck.batch.stored import StoredResults
from satcheck.cli.output import Document
from satcheck.cli.report.answer import render

FORMATS = ("table", "json", "jsonl", "csv", "parquet")


def answer(
    stored: StoredResults,
    query: str,
    form: str,
    output: Path | None,
    top: int | None,
    document: Document,
) -> None:
    """top: rows at most."""
    require_duckdb()
    with Tables(stored) as tables:
        if form == "parquet":
            content = tables.parquet(query)
            document.deliver(lambda _: content, output)
            return
        names, rows = tables.answer(query)
        document.deliver(
            lambda page: render(names, islice(rows, top), form, page),
            output,
            utf8=form != "table",
        )
