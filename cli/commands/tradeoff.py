"""`satcheck tradeoff A B`."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Any

import click

from satcheck.audit.settings import Method
from satcheck.audit.studied_pair import two_of
from satcheck.audit.tradeoff import tradeoff
from satcheck.cli import exit_codes, option, scene_option
from satcheck.cli.click_classes import HELP_NAMES, Command
from satcheck.cli.format_option import deliver, form_option, plain_call
from satcheck.cli.formats.tradeoff import render
from satcheck.cli.inputs import load
from satcheck.cli.plotting import plot_option, refuse_plot, write_plot
from satcheck.cli.progress import Bar


@click.command("tradeoff", cls=Command, context_settings=HELP_NAMES)
@option.paths("A B")
@option.pair
@plot_option("Draw error against time")
@option.method
@form_option
@option.output
@scene_option.split
@scene_option.merge
@scene_option.units
@scene_option.reading("run-seconds")
@option.common
def command(
    form: str | None,
    output: Path | None,
    bodies: tuple[str, str] | None,
    plot: Path | None,
    method: Method,
    **options: Any,
) -> int:
    """Show what accuracy costs in time, on one pair.

    Boxes, oriented boxes, hulls, convex parts from coarse to fine, triangles and the Boolean of
    manifold3d answer about the same bodies. Each answer is compared with what the triangles prove.
    A and B are mesh files; a scene can take their place.

    Exit codes: 0, every rung has answered; 2, wrong usage, an unreadable input, or an internal
    error; 3, a rung failed or was not run, or the truth is not known.
    """
    inputs, form, document = plain_call(options, form, output, plot)
    refuse_plot(plot)
    scene = load(inputs, tell_all=True)
    scene.require_in_space("tradeoff compares meshes in space only")
    pair = two_of(scene, bodies)
    budget = inputs.limit["run-seconds"]
    with Bar("runs", "measuring") as bar:
        result = tradeoff(pair, budget=budget, method=method, progress=bar)
    if plot:
        from satcheck.cli.formats.tradeoff_plot import draw

        write_plot(draw([result]), plot)
    deliver(document, result, form, output, partial(render, result))
    return exit_codes.CLEAN if result.complete else exit_codes.INCOMPLETE
