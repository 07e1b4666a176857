"""The report of a batch: all its scenes, or the worst ones."""

from __future__ import annotations

from collections import deque
from collections.abc import Collection, Iterable, Iterator
from pathlib import Path

from msgspec import Struct

from satcheck.audit.batch.stored import StoredResults
from satcheck.cli.formats.overview import Overview, overview
from satcheck.cli.formats.registry import kind_of, pieces
from satcheck.cli.formats.words import issue_line
from satcheck.cli.output import Document, Page, talk
from satcheck.cli.results.worst_findings import Illustrated, with_pictures, worst_findings
from satcheck.report.assets import Asset, AssetVerdict
from satcheck.report.json import render_assets
from satcheck.report.report import Report

# Scenes that a table lists without --top, and findings with a picture.
TOP = 100


class Chosen(Struct, frozen=True):
    """The choices for the report. top: how many of the worst. folder: where pictures go. root:
    where the paths in the results start."""

    form: str
    output: Path | None
    top: int | None
    folder: Path | None
    root: Path
    allow_outside: bool


class Assets:
    """The reports of assets by name (`cli.formats.ci.Reports`)."""

    def __init__(self, assets: Collection[Asset]) -> None:
        self._assets = assets

    def __len__(self) -> int:
        return len(self._assets)

    def __iter__(self) -> Iterator[Asset]:
        return iter(self._assets)

    def items(self) -> Iterator[tuple[str, Report]]:
        return ((asset.file, asset.report) for asset in self)

    def values(self) -> Iterator[Report]:
        return (asset.report for asset in self)


class StoredAssets(Assets):
    """Each iteration reads the files again."""

    def __init__(self, results: StoredResults) -> None:
        self._results = results

    def __len__(self) -> int:
        return len(self._results)

    def __iter__(self) -> Iterator[Asset]:
        return (stored.asset for stored in self._results)


def report(stored: StoredResults, chosen: Chosen, document: Document) -> AssetVerdict:
    assets = StoredAssets(stored)
    top = chosen.top or TOP
    seen = overview(assets, stored.issues, least=stored.least, top=top)
    listed = assets if chosen.top is None else Assets(seen.shown)
    illustrated = iter(_illustrated(stored, chosen, top))
    document.deliver(
        lambda page: _render(seen, listed, illustrated, chosen.form, page),
        chosen.output,
        utf8=chosen.form != "table",
    )
    deque(illustrated, maxlen=0)  # what no page has taken
    _tell(seen, chosen.form, chosen.output)
    return seen.verdict


def _illustrated(stored: StoredResults, chosen: Chosen, top: int) -> Iterable[Illustrated]:
    if chosen.form != "html" and chosen.folder is None:
        return ()
    worst = worst_findings(stored, top)
    return with_pictures(worst, chosen.folder, chosen.root, allow_outside=chosen.allow_outside)


def _render(
    seen: Overview,
    assets: Assets,
    illustrated: Iterable[Illustrated],
    form: str,
    page: Page,
) -> str | Iterable[str]:
    if form == "json":
        return render_assets(seen.report(), assets, timings=False)
    if form == "html":
        from satcheck.cli.formats.worst_page import render as render_page

        return render_page(seen, illustrated)
    if kind_of(form) == "reports":
        return pieces(assets, form)
    from satcheck.cli.formats.assets import render

    return render(seen, page)


def _tell(seen: Overview, form: str, output: Path | None) -> None:
    """Tell what the document does not say, and with -o the summary and where the report is."""
    if output is not None or form != "table":
        for issue in seen.issues:
            talk(f"satcheck: {issue_line(issue)}")
    if output is not None:
        from satcheck.cli.formats.assets import summary_line

        talk(f"{summary_line(seen)} Report: {output}")
