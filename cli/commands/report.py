"""`satcheck report RESULTS ...`: what the results of a batch say."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator
from pathlib import Path

import click

from satcheck.audit.batch.manifest import read_manifest
from satcheck.audit.batch.stored import StoredResults
from satcheck.cli import exit_codes, option, scene_option
from satcheck.cli.click_classes import HELP_NAMES, Command
from satcheck.cli.format_option import form_of, format_option
from satcheck.cli.formats import worst_page
from satcheck.cli.formats.assets import AssetReports, overview, summary_line, tell_issues, written
from satcheck.cli.formats.registry import REPORTS
from satcheck.cli.inputs import Inputs, refuse_early
from satcheck.cli.output import Document, talk
from satcheck.cli.worst_findings import Illustrated, with_pictures, worst_findings

# Scenes that a table lists without --top, and findings with a picture.
TOP = 100
_PAGE = {"html": "a page of the worst findings with their pictures"}


@click.command("report", cls=Command, context_settings=HELP_NAMES)
@click.argument(
    "results",
    metavar="RESULTS ...",
    nargs=-1,
    required=True,
    type=click.Path(dir_okay=False, path_type=Path),
)
@click.option(
    "--manifest",
    metavar="FILE",
    help="Expect a result for each scene that FILE names, one per line, as satcheck batch does.",
)
@format_option(REPORTS, also=_PAGE)
@option.output
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
@option.root
@scene_option.outside
@option.exit_zero
@option.color
@option.debug
def command(
    results: tuple[Path, ...],
    manifest: str | None,
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
    form = form_of(form, output, REPORTS, tuple(_PAGE))
    refuse_early(Inputs(paths=tuple(map(str, (*results, *filter(None, [manifest]))))), output)
    document = Document()
    expected = () if manifest is None else read_manifest(manifest)
    with StoredResults(results, expected) as stored:
        most = top or TOP
        found = (each.asset for each in stored)
        seen = overview(found, stored.issues, least=stored.least, top=most)
        assets = AssetReports(lambda: (each.asset for each in stored), len(stored))
        if top is not None:
            assets = AssetReports(lambda: seen.shown, len(seen.shown))
        illustrated: Iterator[Illustrated] = iter(())
        if form == "html" or folder is not None:
            worst = worst_findings(stored, most)
            illustrated = with_pictures(worst, folder, root, allow_outside=allow_outside)
        document.deliver(
            lambda page: (
                worst_page.render(seen, illustrated)
                if form == "html"
                else written(seen, assets, form, page, timings=False)
            ),
            output,
            utf8=form != "table",
        )
        deque(illustrated, maxlen=0)  # what no page has taken
    if output is not None or form != "table":
        tell_issues(seen)
    if output is not None:
        talk(f"{summary_line(seen)} Report: {output}")
    return exit_codes.for_assets(seen.verdict, exit_zero=exit_zero)
