"""`satcheck view REPORT`: the picture of a report that was written earlier."""

from __future__ import annotations

import os
import sys
import webbrowser
from pathlib import Path
from tempfile import mkdtemp
from typing import Any

import click
from click.core import ParameterSource
from msgspec.structs import replace

from satcheck.cli import exit_codes, option, scene_option
from satcheck.cli.click_classes import HELP_NAMES, Command
from satcheck.cli.format_option import form_of
from satcheck.cli.formats.picture import render
from satcheck.cli.inputs import Inputs, refuse_early
from satcheck.cli.output import Document, issue_line, talk, write_file
from satcheck.cli.rendering import files_line, refuse_pictures, taken_pictures, write_pictures
from satcheck.cli.stated_scene import read_stored, stated_scene
from satcheck.report.assets import AssetsReport
from satcheck.report.report import Report
from satcheck.report.samples import SamplesReport


@click.command("view", cls=Command, context_settings=HELP_NAMES)
@click.argument("report", metavar="REPORT", type=click.Path(dir_okay=False, path_type=Path))
@option.output
@option.pictures
@click.option(
    "--asset",
    metavar="FILE",
    help="The asset to show, if a report of satcheck each has several.",
)
@click.option(
    "--pose",
    type=click.IntRange(1),
    metavar="NUMBER",
    help="The pose to show, if a report has several.  [default: all on a page, else the worst]",
)
@option.root
@click.option(
    "--parts",
    is_flag=True,
    help="Split the bodies with findings, so that the page shows their convex parts. A report of "
    "--accuracy parts has them anyway.",
)
@option.cache
@scene_option.outside
@option.color
@option.debug
def command(
    report: Path,
    output: Path | None,
    asset: str | None,
    pose: int | None,
    root: Path,
    parts: bool,
    cache: bool,
    allow_outside: bool,
    **options: Any,
) -> int:
    """Show a report in 3-D, from its mesh files.

    REPORT is a JSON report of a check. satcheck reads the mesh files again, and names each file
    that has changed since the check. Without -o the page opens in the browser; -o takes .html,
    .png, .glb and .bcf. The page shows where surfaces cross if the check had --contacts.

    Exit codes: 0, every body is shown as it was checked; 2, wrong usage, an unreadable report, or
    an internal error; 3, a file is missing or has changed, or the report does not say where bodies
    stand.
    """
    form = form_of(None, output, ("picture",)) if output else "html"
    pictures, inputs = taken_pictures(options), Inputs((str(report),))
    refuse_early(inputs, output)
    refuse_pictures(pictures, inputs, output)
    stated = _report_of(report, asset)
    if pose is not None and not isinstance(stated, SamplesReport):
        raise click.UsageError(f"--pose: {report} is about one pose")
    scene, issues = stated_scene(stated, root, allow_outside=allow_outside)
    for issue in issues:
        talk(f"satcheck: {issue_line(issue)}")
    document = Document()
    stated = replace(stated, issues=(*issues, *stated.issues))
    split = parts or stated.settings.accuracy == "parts"
    named = _is_named("output")
    if named or not pictures:
        content = render(form, stated, scene, split=split, cache=cache, pose=pose)
        if named:
            document.deliver(lambda _: content, output, utf8=True)
        else:
            _show(content, document)
    write_pictures(pictures, stated, scene, pose)
    if pictures:
        talk(files_line(stated, scene, form, None, pictures))
    return exit_codes.INCOMPLETE if issues else exit_codes.CLEAN


def _report_of(path: Path, asset: str | None) -> Report | SamplesReport:
    document = read_stored(path)
    if not isinstance(document, AssetsReport):
        if asset is not None:
            raise click.UsageError(f"--asset: {path} is the report of one check")
        return document
    return _of_asset(document, path, asset)


def _of_asset(document: AssetsReport, path: Path, asset: str | None) -> Report:
    named = [each for each in document.assets if asset in (None, each.file)]
    if len(named) != 1:
        files = ", ".join(each.file for each in document.assets)
        raise click.UsageError(f"{path} has several assets: name one with --asset: {files}")
    return named[0].report


def _is_named(option: str) -> bool:
    """Also as standard output."""
    source = click.get_current_context().get_parameter_source(option)
    return source is not ParameterSource.DEFAULT


def _show(content: bytes | str, document: Document) -> None:
    """The path is printed, as a browser may not come up."""
    path = Path(mkdtemp(prefix="satcheck-")) / "report.html"
    write_file(path, content)
    document.write(f"{path}\n")
    if _has_display():
        webbrowser.open(path.as_uri())


def _has_display() -> bool:
    return sys.platform in ("win32", "darwin") or any(
        os.environ.get(name) for name in ("DISPLAY", "WAYLAND_DISPLAY")
    )
