"""The assets that the words of a call stand for."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterable

import click

from satcheck.audit.batch.check_options import World
from satcheck.cli.formats.words import counted
from satcheck.cli.inputs import Inputs
from satcheck.cli.output import talk
from satcheck.core.errors import SatcheckError
from satcheck.scene.asset_files import Assets, asset_files
from satcheck.scene.loader import has_only_rules

STANDARD_INPUT = "-"
_NAMED = 6


def asset_names(inputs: Inputs) -> Assets:
    """Folders and patterns are expanded, and - stands for the names on standard input. A file of
    rules is no asset. click.UsageError if there is none."""
    names: list[str] = []
    for name in inputs.paths:
        names += _standard_input() if name == STANDARD_INPUT else [name]
    assets = asset_files(filter(None, names), inputs.exclude)
    if inputs.exclude:
        talk(f"satcheck: --exclude leaves out {counted(assets.excluded, 'file')}")
    rules = {os.path.realpath(path) for path in inputs.rules}
    files = [
        file
        for file in assets.files
        if os.path.realpath(file) not in rules and not _is_skipped(file)
    ]
    if not files:
        raise click.UsageError("no file is named: give a folder or files")
    return assets._replace(files=files)


def tell_foreign(worlds: Iterable[World]) -> None:
    """`kit: no reader knows 2 files: kit/a.fbx, kit/b.blend`. worlds: of `foreign_worlds`."""
    for folder, *files in worlds:
        named = ", ".join(files[:_NAMED]) + (", ..." if len(files) > _NAMED else "")
        talk(f"satcheck: {folder}: no reader knows {counted(len(files), 'file')}: {named}")


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
    """A name for each line, or with a NUL behind each. click.UsageError if it is closed."""
    if sys.stdin is None:
        raise click.UsageError("standard input is closed: give a folder or files")
    text = os.fsdecode(sys.stdin.buffer.read()).replace(os.linesep, "\n")
    return text.split("\0" if "\0" in text else "\n")
