"""`satcheck report RESULTS ...`: what the results of a batch say."""

from __future__ import annotations

from pathlib import Path

import click

from satcheck.batch.stored import StoredResults
from satcheck.cli import exit_codes
from satcheck.cli.inputs import Inputs, refuse_early
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
from satcheck.cli.output import Document, talk
from satcheck.cli.report.words import issue_line
from satcheck.cli.results.query import FORMATS as QUERY_FORMATS
from satcheck.cli.results.query import answer
from satcheck.cli.results.report import TOP, Chosen, report

FORMATS = (*REPORT_FORMATS, "html", "parquet")


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
    help=f"{', '.join(FORMATS)}; html is a page of the worst findings with their pictures, parquet "
    "all findings.  [default: as the file of -o ends, otherwise table]",
)
@output_option
@click.option(
    "--top",
    type=click.IntRange(min=1),
    metavar="N",
    help="Report the N worst scenes, the worst first; of html and --pictures the N worst findings. "
    f"The summary and the exit code count all.  [default: {TOP} in a table and of html, "
    "otherwise all]. Of --sql, the first N rows.",
)
@click.option(
    "--sql",
    metavar="QUERY",
    help="Answer a question about the tables scenes, findings and issues, as table, json, jsonl, "
    "csv or parquet (pip install 'satcheck[query]').",
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
    sql: str | None,
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
    if one is not fully checked or the batch did not finish, else 0. With --sql only the files
    count: 2 if one has lines that are no results, 3 if a batch did not finish, else 0.
    """
    if sql is not None and folder is not None:
        raise click.UsageError("--pictures: the answer to --sql has no pictures")
    form = form_of(form, output, FORMATS if sql is None else QUERY_FORMATS)
    refuse_early(Inputs(paths=tuple(map(str, results))), output)
    document = Document()
    with StoredResults(results) as stored:
        if sql is not None:
            answer(stored, sql, form, output, top, document)
            for issue in stored.issues:
                talk(f"satcheck: {issue_line(issue)}")
            return exit_codes.for_assets(stored.least, exit_zero=exit_zero)
        chosen = Chosen(form, output, top, folder, root, allow_outside)
        verdict = report(stored, chosen, document)
    return exit_codes.for_assets(verdict, exit_zero=exit_zero)
