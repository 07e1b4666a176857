"""`satcheck report RESULTS ...`: what the results of a batch say."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable
from pathlib import Path

import click

from satcheck.batch.stored import StoredResults
from satcheck.cli import exit_codes
from satcheck.cli.inputs import Inputs, refuse_early
from satcheck.cli.named_assets import Assets, StoredAssets
from satcheck.cli.options import (
    HELP_NAMES,
    REPORT_FORMATS,
    Command,
    color_option,
    debug_option,
    exit_zero_option,
    form_of,
    output_option,
    outside_option,
    root_option,
)
from satcheck.cli.output import Document, Page, talk
from satcheck.cli.report.ci import FORMATS as CI_FORMATS
from satcheck.cli.report.ci import pieces as pieces_for_ci
from satcheck.cli.report.overview import Overview, overview
from satcheck.cli.report.words import issue_line
from satcheck.cli.worst_findings import Illustrated, with_pictures, worst_findings
from satcheck.report.json import render_assets

# Scenes that a table lists without --top, and findings with a picture.
TOP = 100
FORMATS = (*REPORT_FORMATS, "html")


@click.command("report", cls=Command, context_settings=HELP_NAMES)
@click.argument(
    "results",
    metavar="RESULTS ...",
    nargs=-1,
    required=True,
    type=click.Path(dir_okay=False, path_type=Path),
)
@click.option(
    "--format",
    "form",
    type=click.Choice(FORMATS),
    metavar="FORMAT",
    help=f"{', '.join(FORMATS)}; html is a page of the worst findings with their pictures.  "
    "[default: as the file of -o ends, otherwise table]",
)
@output_option
@click.option(
    "--top",
    type=click.IntRange(min=1),
    metavar="N",
    help="Report the N worst scenes, the worst first; of html and --pictures the N worst findings. "
    f"The summary and the exit code count all.  [default: {TOP} in a table and of html, "
    "otherwise all]",
)
@click.option(
    "--pictures",
    "folder",
    type=click.Path(file_okay=False, path_type=Path),
    metavar="DIR",
    help="Also write images of the worst findings into DIR, as PNG.",
)
@root_option
@outside_option
@exit_zero_option
@color_option
@debug_option
def command(
    results: tuple[Path, ...],
    form: str | None,
    output: Path | None,
    top: int | None,
    folder: Path | None,
    root: Path,
    allow_outside: bool,
    exit_zero: bool,
) -> int:
    """Report which scenes of a batch fail, and how.

    RESULTS are files that `satcheck batch` wrote. Those of several shards are one report. A batch
    that did not finish is never reported as a pass. For a picture the files of a scene are read
    again; if one has changed since the check, the page says so in place of the picture.

    The exit code is that of the worst scene: 2 if one cannot be read, else 1 if one fails, else 3
    if one is not fully checked or the batch did not finish, else 0.
    """
    form = form_of(form, output, FORMATS)
    refuse_early(Inputs(paths=tuple(map(str, results))), output)
    document = Document()
    with StoredResults(results) as stored:
        assets = StoredAssets(stored)
        seen = overview(assets, stored.issues, least=stored.least, top=top or TOP)
        chosen = assets if top is None else Assets(seen.shown)
        illustrated: Iterable[Illustrated] = ()
        if form == "html" or folder is not None:
            worst = worst_findings(stored, top or TOP)
            illustrated = with_pictures(worst, folder, root, allow_outside=allow_outside)
        document.deliver(
            lambda page: _render(seen, chosen, illustrated, form, page),
            output,
            utf8=form != "table",
        )
        deque(illustrated, maxlen=0)  # what no page has taken
    _tell(seen, form, output)
    return exit_codes.for_assets(seen.verdict, exit_zero=exit_zero)


def _render(
    seen: Overview, assets: Assets, illustrated: Iterable[Illustrated], form: str, page: Page
) -> str | Iterable[str]:
    if form == "json":
        return render_assets(seen.report(), assets, timings=False)
    if form in CI_FORMATS:
        return pieces_for_ci(assets, form)
    if form == "html":
        from satcheck.cli.report.worst_page import render as render_page

        return render_page(seen, illustrated)
    from satcheck.cli.report.assets import render

    return render(seen, page)


def _tell(seen: Overview, form: str, output: Path | None) -> None:
    """What the document does not say, and with -o the summary and where the report is."""
    if output is not None or form != "table":
        for issue in seen.issues:
            talk(f"satcheck: {issue_line(issue)}")
    if output is not None:
        from satcheck.cli.report.assets import summary_line

        talk(f"{summary_line(seen)} Report: {output}")
