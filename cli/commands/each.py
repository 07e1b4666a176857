"""`satcheck each DIR|FILE ...`: many assets, each checked as a scene of its own."""

from __future__ import annotations

import os
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import click
from msgspec import to_builtins

from satcheck.audit import Settings
from satcheck.audit.assets import check_asset
from satcheck.audit.baseline import beside_baseline
from satcheck.audit.summary import tool
from satcheck.cli import exit_codes
from satcheck.cli.baseline_file import asset_key, read_baseline
from satcheck.cli.commands.check import command as check_command
from satcheck.cli.inputs import Inputs, refuse_early
from satcheck.cli.options import (
    HELP_NAMES,
    REPORT_FORMATS,
    Command,
    form_of,
    options_of,
    paths_argument,
    reports_form_option,
    settings_of,
)
from satcheck.cli.output import Document, Page, talk
from satcheck.cli.progress import Bar
from satcheck.cli.report.ci import FORMATS as CI_FORMATS
from satcheck.cli.report.ci import render as render_for_ci
from satcheck.cli.report.json import document as json_document
from satcheck.cli.report.words import issue_line
from satcheck.core import keep_freed_memory
from satcheck.core.errors import SatcheckError
from satcheck.report.assets import Asset, AssetsReport, AssetVerdict, asset, assets_report
from satcheck.report.baseline import Baseline
from satcheck.report.report import without_timings
from satcheck.scene import Scene, load_scene
from satcheck.scene.asset_files import asset_files
from satcheck.scene.changed_assets import changed_since
from satcheck.scene.drawing import DRAWINGS

STANDARD_INPUT = "-"
# What is about one robot, or about one report.
_NOT_HERE = ("form", "pose", "state", "sample", "seed", "explain", "certificate", "version")
_CODES: dict[AssetVerdict, int] = {
    "error": exit_codes.ERROR,
    "fail": exit_codes.FINDINGS,
    "incomplete": exit_codes.INCOMPLETE,
    "pass": exit_codes.CLEAN,
}


@click.command("each", cls=Command, context_settings=HELP_NAMES)
@paths_argument("DIR|FILE|- ...")
@click.option(
    "--changed-since",
    metavar="REV",
    help="Only assets that changed since this git revision, or that name a changed file.",
)
@reports_form_option
@options_of(check_command, but=_NOT_HERE)
def command(
    form: str | None,
    output: Path | None,
    quiet: bool,
    exit_zero: bool,
    timings: bool,
    changed_since: str | None,
    baseline: Path | None,
    **options: Any,
) -> int:
    """Check each asset of a folder as a scene of its own.

    An asset is a mesh file, a scene or a robot. In a folder every asset below it counts; a pattern
    ("props/**/*.glb") may stand for files, and - reads their names from standard input, a line
    each, or with a NUL behind each. Bodies of different assets are never compared. An asset with
    one body passes if that body can be read. A URDF is read without its SRDF.

    The exit code is that of the worst asset: 2 if one cannot be read, else 1 if one fails, else 3
    if one is not fully checked, else 0. Options that both commands have mean what they mean in
    `satcheck A B`.
    """
    inputs = Inputs.taken_from(options)
    form = form_of(form, output, REPORT_FORMATS)
    refuse_early(inputs, output, baseline)
    known = None if baseline is None else read_baseline(baseline)
    document = Document()
    files = _files(inputs.paths, planar=options["planar"] is not None)
    refuse_early(Inputs(paths=tuple(files)), output)
    if changed_since is not None:
        files = _changed(changed_since, files)
    assets = _check(files, inputs, options, hashed=form == "json")
    if known is not None and baseline is not None:
        assets = [_beside(each, known, baseline) for each in assets]
    report = assets_report(tool(), assets)
    if output is not None or (not quiet and (files or form != "table")):
        document.deliver(
            lambda page: _render(report, form, page, timings=timings),
            output,
            utf8=form != "table",
        )
    _tell(report, None if quiet else output)
    return exit_codes.CLEAN if exit_zero and report.verdict == "fail" else _CODES[report.verdict]


def _files(given: Sequence[str], *, planar: bool) -> list[str]:
    names: list[str] = []
    for name in given:
        names += _standard_input() if name == STANDARD_INPUT else [name]
    files = asset_files(filter(None, names), drawings=DRAWINGS if planar else ())
    if not files:
        raise click.UsageError("no file is named: give a folder or files")
    return files


def _standard_input() -> list[str]:
    """Names of files: a line each, or with a NUL behind each."""
    if sys.stdin is None:
        raise click.UsageError("standard input is closed: give a folder or files")
    text = os.fsdecode(sys.stdin.buffer.read()).replace(os.linesep, "\n")
    return text.split("\0" if "\0" in text else "\n")


def _changed(revision: str, files: Sequence[str]) -> list[str]:
    changed = changed_since(revision, files)
    if not changed:
        talk(f"satcheck: no asset changed since {revision}")
    return changed


def _check(
    files: Sequence[str], inputs: Inputs, options: Mapping[str, Any], *, hashed: bool
) -> list[Asset]:
    keep_freed_memory()

    def load(file: str) -> Scene:
        _refuse_folder(file)
        return load_scene(
            [file],
            split=inputs.split,
            packages=inputs.packages,
            allow_outside=inputs.allow_outside,
            units=inputs.units,
            hashed=hashed,
        )

    def settings_for(scene: Scene) -> Settings:
        try:
            return settings_of(options, scene)
        except click.UsageError as error:
            raise SatcheckError("bad-setting", error.message) from None

    assets = []
    with Bar("assets") as bar:
        for number, file in enumerate(files):
            assets.append(check_asset(file, load, settings_for))
            if bar is not None:
                bar(number + 1, len(files))
    return assets


def _refuse_folder(name: str) -> None:
    """Only a folder that cannot be listed is among the assets."""
    try:
        if Path(name).is_dir():
            next(Path(name).iterdir(), None)
    except OSError as error:
        raise SatcheckError(
            "unreadable-folder", f"the folder cannot be listed: {error.strerror}", file=name
        ) from None


def _beside(each: Asset, known: Baseline, path: Path) -> Asset:
    report = beside_baseline(each.report, known, str(path), asset_key(each.file, path))
    return asset(each.file, report)


def _tell(report: AssetsReport, output: Path | None) -> None:
    """Errors on stderr; with -o also the summary, and where the report is."""
    for each in report.assets:
        for issue in each.report.issues:
            if issue.severity == "error":
                line = issue_line(issue)
                talk(f"satcheck: {line}" if each.file in line else f"satcheck: {each.file}: {line}")
    if output is not None and report.assets:
        from satcheck.cli.report.assets import summary_line

        talk(f"{summary_line(report)} Report: {output}")


def _render(report: AssetsReport, form: str, page: Page, *, timings: bool) -> str:
    if form == "json":
        return json_document(report if timings else without_timings(to_builtins(report)))
    if form in CI_FORMATS:
        return render_for_ci({asset.file: asset.report for asset in report.assets}, form)
    if not report.assets:
        return "PASS: 0 assets.\n"
    from satcheck.cli.report.assets import render

    return render(report, page)
