"""`satcheck tradeoff`: from its options to a document, a plot and an exit code."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from satcheck.cli import exit_codes
from satcheck.cli.checking import load, refuse_early
from satcheck.cli.output import Document, write_file
from satcheck.cli.report.png import EXTRA, is_available, png
from satcheck.core.frozen import frozen

if TYPE_CHECKING:
    from satcheck.cli.output import Page
    from satcheck.scene.scene_builder import Split
    from satcheck.studies.tradeoff import Tradeoff

PLOTS = (".svg", ".png", ".html")


@frozen
class Choices:
    """The options of the command line."""

    paths: tuple[str, ...]
    form: str
    output: Path | None
    repeat: int
    budget: float
    pairs: int
    plot: Path | None
    split: Split | None
    units: str | None
    allow_outside: bool


def run(choices: Choices) -> int:
    """Measure, write the document and the plot; returns the exit code."""
    refuse_early(choices.paths, choices.output)
    _refuse_plot(choices)
    document = Document()
    found = _measured(choices)
    if choices.plot:
        _write_plot(found, choices.plot)
    utf8 = choices.form == "json"
    document.deliver(lambda page: _render(found, choices, page), choices.output, utf8=utf8)
    return exit_codes.CLEAN if found.complete else exit_codes.INCOMPLETE


def _refuse_plot(choices: Choices) -> None:
    """What cannot be drawn is said before any work is done."""
    if choices.plot is None:
        return
    if choices.plot.suffix.lower() not in PLOTS:
        raise click.UsageError(
            f"--plot {choices.plot}: drawn as {', '.join(PLOTS[:-1])} or {PLOTS[-1]}"
        )
    if choices.plot.suffix.lower() == ".png" and not is_available():
        raise click.UsageError(
            f"--plot {choices.plot}: a PNG needs more libraries: pip install 'satcheck[{EXTRA}]'"
        )
    refuse_early(choices.paths, choices.plot, option="--plot")
    if choices.plot.absolute() == (choices.output and choices.output.absolute()):
        raise click.UsageError("--plot and -o name the same file")


def _measured(choices: Choices) -> Tradeoff:
    from satcheck.cli.progress import Bar

    scene = load(
        choices.paths,
        split=choices.split,
        allow_outside=choices.allow_outside,
        units=choices.units,
    )
    if scene.unreadable:
        raise click.ClickException("an input could not be used: nothing is compared without it")
    from satcheck.studies.tradeoff import tradeoff

    with Bar("runs") as bar:
        return tradeoff(
            scene, repeat=choices.repeat, budget=choices.budget, pairs=choices.pairs, progress=bar
        )


def _write_plot(found: Tradeoff, path: Path) -> None:
    from satcheck.cli.report.tradeoff_plot import page, svg

    form = path.suffix.lower()
    if form == ".png":
        write_file(path, png(svg(found.pairs)))
    else:
        write_file(path, svg(found.pairs) if form == ".svg" else page(found.pairs))


def _render(found: Tradeoff, choices: Choices, page: Page) -> str:
    if choices.form == "json":
        from satcheck.cli.report.json import document

        return document(found.to_dict())
    from satcheck.cli.report.tradeoff import render

    return render(found, page)
