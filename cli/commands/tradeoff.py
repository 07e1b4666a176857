"""`satcheck tradeoff A B`."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from satcheck.cli.commands.options import (
    HELP_NAMES,
    Command,
    debug_option,
    form_option,
    output_option,
    outside_option,
    paths_argument,
    split_option,
    units_option,
)
from satcheck.cli.output import form_of


@click.command("tradeoff", cls=Command, context_settings=HELP_NAMES)
@paths_argument("A B")
@click.option(
    "--repeat",
    type=click.IntRange(min=1),
    metavar="N",
    default=5,
    show_default=True,
    help="How often each rung is asked; the rungs take turns.",
)
@click.option(
    "--budget",
    type=click.FloatRange(min=0, min_open=True),
    metavar="SECONDS",
    default=60.0,
    show_default=True,
    help="Time for the whole run, shared by all pairs. Rungs that do not fit are shown as not run.",
)
@click.option(
    "--pairs",
    type=click.IntRange(min=1),
    metavar="N",
    default=10,
    show_default=True,
    help="At most this many pairs of a scene, of those whose boxes meet.",
)
@click.option(
    "--plot",
    type=click.Path(dir_okay=False, path_type=Path),
    metavar="FILE",
    help="Draw error against time: FILE.svg, FILE.png or FILE.html.",
)
@form_option
@output_option
@split_option
@units_option
@outside_option
@debug_option
def command(debug: bool, **options: Any) -> int:
    """What accuracy costs in time: every rung of the ladder on one pair.

    Boxes, oriented boxes, hulls, convex parts from coarse to fine, triangles and the Boolean of
    manifold3d answer about the same bodies. Each answer is compared with what the triangles prove.
    A and B are mesh files; a scene can take their place.

    Exit codes: 0, every rung has answered; 2, wrong usage, an unreadable input, or an internal
    error; 3, a rung failed or was not run, or the truth is not known.
    """
    from satcheck.cli.tradeoff import Choices, run

    del debug
    options["form"] = form_of(options["form"], options["output"])
    return run(Choices(**options))
