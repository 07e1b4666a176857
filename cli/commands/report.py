"""`satcheck report RESULTS ...`: what the results of a batch say."""

from __future__ import annotations

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
)
from satcheck.cli.output import Document, Page, talk
from satcheck.cli.report.ci import FORMATS as CI_FORMATS
from satcheck.cli.report.ci import pieces as pieces_for_ci
from satcheck.cli.report.overview import Overview, overview
from satcheck.cli.report.words import issue_line
from satcheck.report.json import render_assets

# Scenes that a table lists without --top.
TOP = 100


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
    type=click.Choice(REPORT_FORMATS),
    metavar="FORMAT",
    help=f"{', '.join(REPORT_FORMATS)}.  [default: as the file of -o ends, otherwise table]",
)
@output_option
@click.option(
    "--top",
    type=click.IntRange(min=1),
    metavar="N",
    help=f"Report the N worst scenes, the worst first. The summary and the exit code count all.  "
    f"[default: {TOP} in a table, otherwise all]",
)
@exit_zero_option
@color_option
@debug_option
def command(
    results: tuple[Path, ...],
    form: str | None,
    output: Path | None,
    top: int | None,
    exit_zero: bool,
) -> int:
    """Report which scenes of a batch fail, and how.

    RESULTS are files that `satcheck batch` wrote. Those of several shards are one report. A batch
    that did not finish is never reported as a pass.

    The exit code is that of the worst scene: 2 if one cannot be read, else 1 if one fails, else 3
    if one is not fully checked or the batch did not finish, else 0.
    """
    form = form_of(form, output, REPORT_FORMATS)
    refuse_early(Inputs(paths=tuple(map(str, results))), output)
    document = Document()
    with StoredResults(results) as stored:
        assets = StoredAssets(stored)
        seen = overview(assets, stored.issues, least=stored.least, top=top or TOP)
        chosen = assets if top is None else Assets(seen.shown)
        document.deliver(
            lambda page: _render(seen, chosen, form, page), output, utf8=form != "table"
        )
    _tell(seen, form, output)
    return exit_codes.for_assets(seen.verdict, exit_zero=exit_zero)


def _render(seen: Overview, assets: Assets, form: str, page: Page) -> str | Iterable[str]:
    if form == "json":
        return render_assets(seen.report(), assets, timings=False)
    if form in CI_FORMATS:
        return pieces_for_ci(assets, form)
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
