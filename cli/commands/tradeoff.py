"""`satcheck tradeoff A B`."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from satcheck.audit.request.settings import Method
from satcheck.audit.studied_pair import two_of
from satcheck.audit.tradeoff import tradeoff
from satcheck.cli import exit_codes
from satcheck.cli.click_classes import HELP_NAMES, Command
from satcheck.cli.format_option import form_of, form_option
from satcheck.cli.inputs import Inputs, load, refuse_early
from satcheck.cli.options import (
    color_option,
    debug_option,
    method_option,
    output_option,
    pair_option,
    paths_argument,
    seconds_option,
)
from satcheck.cli.output import Document, Page
from satcheck.cli.plotting import dark_option, plot_option, refuse_plot, write_plot
from satcheck.cli.progress import Bar
from satcheck.cli.scene_options import merge_option, reading_options, split_option, units_option
from satcheck.report.json import document as json_document
from satcheck.report.tradeoff import TradeoffReport


@click.command("tradeoff", cls=Command, context_settings=HELP_NAMES)
@paths_argument("A B")
@pair_option
@click.option(
    "--repeat",
    type=click.IntRange(min=1),
    metavar="N",
    default=5,
    show_default=True,
    help="The number of runs of each rung; the rungs take turns.",
)
@seconds_option(
    "--budget",
    60.0,
    "Time for the whole run. Rungs that do not fit are shown as not run.",
)
@plot_option("Draw error against time")
@dark_option
@method_option
@form_option
@output_option
@split_option
@merge_option
@units_option
@reading_options
@color_option
@debug_option
def command(
    form: str | None,
    output: Path | None,
    bodies: tuple[str, str] | None,
    repeat: int,
    budget: float,
    plot: Path | None,
    method: Method,
    dark: bool,
    **options: Any,
) -> int:
    """What accuracy costs in time: every rung of the ladder on one pair.

    Boxes, oriented boxes, hulls, convex parts from coarse to fine, triangles and the Boolean of
    manifold3d answer about the same bodies. Each answer is compared with what the triangles prove.
    A and B are mesh files; a scene can take their place.

    Exit codes: 0, every rung has answered; 2, wrong usage, an unreadable input, or an internal
    error; 3, a rung failed or was not run, or the truth is not known.
    """
    inputs = Inputs.taken_from(options)
    form = form_of(form, output)
    refuse_early(inputs, output)
    refuse_plot(inputs, plot, output)
    document = Document()
    scene = load(inputs)
    scene.require_in_space("tradeoff compares meshes in space only")
    pair = two_of(scene, bodies)
    with Bar("runs", "measuring") as bar:
        result = tradeoff(pair, repeat=repeat, budget=budget, method=method, progress=bar)
    if plot:
        from satcheck.cli.formats.tradeoff_plot import draw

        write_plot(draw([result], dark=dark), plot)
    document.deliver(lambda page: _render(result, form, page), output, utf8=form == "json")
    return exit_codes.CLEAN if result.complete else exit_codes.INCOMPLETE


def _render(result: TradeoffReport, form: str, page: Page) -> str:
    if form == "json":
        return json_document(result)
    from satcheck.cli.formats.tradeoff import render

    return render(result, page)
