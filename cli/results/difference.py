"""The difference between the results of a batch and older ones."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from satcheck.batch.difference import difference
from satcheck.batch.stored import StoredResults
from satcheck.cli.formats import difference as rendering
from satcheck.cli.formats.words import issue_line
from satcheck.cli.output import Document, Page, talk
from satcheck.cli.results.report import TOP
from satcheck.report.assets import AssetVerdict
from satcheck.report.difference import Difference
from satcheck.report.json import document as json_document

FORMATS = ("table", "json", "markdown")


def compare(
    before: StoredResults,
    now: StoredResults,
    form: str,
    output: Path | None,
    top: int | None,
    document: Document,
) -> AssetVerdict:
    made = difference(before, now)
    document.deliver(lambda page: _render(made, form, page, top), output, utf8=form != "table")
    if output is not None or form == "json":
        for issue in made.issues:
            talk(f"satcheck: {issue_line(issue)}")
    if output is not None:
        talk(f"{rendering.summary_line(made)} Report: {output}")
    return made.verdict


def _render(made: Difference, form: str, page: Page, top: int | None) -> str | Iterable[str]:
    """JSON has all changes."""
    if form == "json":
        return json_document(made)
    if form == "markdown":
        return rendering.markdown(made, top or TOP)
    return rendering.render(made, page, top or TOP)
