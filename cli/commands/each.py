"""`satcheck each DIR|FILE ...`: many assets, each checked as a scene of its own."""

from __future__ import annotations

import os
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import click

from satcheck.cli.commands.check import command as check_command
from satcheck.cli.config.source import stated_config
from satcheck.cli.inputs import Inputs, refuse_early
from satcheck.cli.options import (
    HELP_NAMES,
    REPORT_FORMATS,
    Command,
    form_of,
    options_of,
    paths_argument,
    reports_form_option,
)
from satcheck.cli.output import talk
from satcheck.cli.worlds import Delivery, check_worlds
from satcheck.core.errors import SatcheckError
from satcheck.scene.asset_files import asset_files
from satcheck.scene.changed_assets import changed_since
from satcheck.scene.drawing import DRAWINGS
from satcheck.scene.loader import has_only_rules

STANDARD_INPUT = "-"
# What is about one world, or about one report.
_NOT_HERE = (
    "form",
    "png",
    "glb",
    "pose",
    "state",
    "sample",
    "seed",
    "explain",
    "certificate",
    "merge",
)


@click.command("each", cls=Command, context_settings=HELP_NAMES)
@paths_argument("DIR|FILE|- ...")
@click.option(
    "--changed-since",
    metavar="REV",
    help="Only assets that changed since this git revision, or that name a changed file.",
)
@reports_form_option
@options_of(check_command, but=(*_NOT_HERE, "version"))
def command(
    form: str | None,
    output: Path | None,
    quiet: bool,
    exit_zero: bool,
    top: int | None,
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
    if not inputs.paths:
        raise click.UsageError("give a folder or files: `satcheck each .` checks this folder")
    refuse_early(inputs, output, baseline)
    config = stated_config(click.get_current_context())
    files = _files(inputs, planar=options["planar"] is not None)
    refuse_early(Inputs(paths=tuple(files)), output)
    if changed_since is not None:
        shared = [*inputs.rules, *filter(None, [baseline])]
        shared += [Path(config.file)] if config else []
        files = _changed(changed_since, files, shared)
    return check_worlds(
        [(file,) for file in files],
        inputs,
        options,
        baseline,
        Delivery(form, output, quiet, exit_zero, top),
        config,
        complete=changed_since is None,
    )


def _files(inputs: Inputs, *, planar: bool) -> list[str]:
    """A file of rules is no asset."""
    names: list[str] = []
    for name in inputs.paths:
        names += _standard_input() if name == STANDARD_INPUT else [name]
    found = asset_files(filter(None, names), drawings=DRAWINGS if planar else ())
    rules = {os.path.realpath(path) for path in inputs.rules}
    files = [
        file for file in found if os.path.realpath(file) not in rules and not _is_skipped(file)
    ]
    if not files:
        raise click.UsageError("no file is named: give a folder or files")
    return files


def _is_skipped(file: str) -> bool:
    """Files that only have rules are told, as their rules do not count here."""
    try:
        skipped = has_only_rules(file)
    except SatcheckError:  # the check of this asset says why
        return False
    if skipped:
        talk(f"satcheck: {file} has only rules and is no asset: --rules {file} applies them")
    return skipped


def _standard_input() -> list[str]:
    """Names of files: a line each, or with a NUL behind each."""
    if sys.stdin is None:
        raise click.UsageError("standard input is closed: give a folder or files")
    text = os.fsdecode(sys.stdin.buffer.read()).replace(os.linesep, "\n")
    return text.split("\0" if "\0" in text else "\n")


def _changed(revision: str, files: list[str], shared: Sequence[Path]) -> list[str]:
    """shared: what these files say of every asset counts."""
    if new := changed_since(revision, list(map(str, shared))):
        talk(f"satcheck: {new[0]} changed since {revision}: every asset is checked")
        return files
    changed = changed_since(revision, files)
    if not changed:
        talk(f"satcheck: no asset changed since {revision}")
    return changed
