"""`satcheck stability`: from its options to a document and an exit code."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from satcheck.cli import exit_codes
from satcheck.cli.checking import load, refuse_early
from satcheck.cli.output import Document
from satcheck.core.frozen import frozen

if TYPE_CHECKING:
    from satcheck.cli.output import Page
    from satcheck.studies.stability import Stability

_EXIT_CODES = {
    "stable": exit_codes.CLEAN,
    "changed": exit_codes.FINDINGS,
    "undecided": exit_codes.INCOMPLETE,
}


@frozen
class Choices:
    """The options of the command line."""

    paths: tuple[str, ...]
    form: str
    output: Path | None
    samples: int
    seed: int
    depth: bool
    explain: bool
    units: str | None
    allow_outside: bool


def run(choices: Choices) -> int:
    """Ask, write the document; returns the exit code."""
    if len(choices.paths) != 2:
        raise click.UsageError(f"give two mesh files, not {len(choices.paths)}")
    refuse_early(choices.paths, choices.output)
    document = Document()
    found = _probe(choices)
    utf8 = choices.form == "json"
    document.deliver(lambda page: _render(found, choices, page), choices.output, utf8=utf8)
    return _EXIT_CODES[found.verdict]


def _probe(choices: Choices) -> Stability:
    from satcheck.audit import Settings
    from satcheck.cli.progress import Bar

    scene = load(choices.paths, allow_outside=choices.allow_outside, units=choices.units)
    if scene.unreadable:
        raise click.ClickException("an input could not be used: there is no pair to ask about")
    from satcheck.studies.stability import probe

    settings = Settings(depth=choices.depth)
    with Bar("variants") as bar:
        return probe(scene, choices.samples, choices.seed, settings, progress=bar)


def _render(found: Stability, choices: Choices, page: Page) -> str:
    if choices.form == "json":
        from satcheck.cli.report.json import document

        return document(found.to_dict())
    from satcheck.cli.report.stability import render

    return render(found, page, explain=choices.explain)
