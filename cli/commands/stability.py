"""`satcheck stability A B`."""

from __future__ import annotations

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
    units_option,
)
from satcheck.cli.output import form_of


@click.command("stability", cls=Command, context_settings=HELP_NAMES)
@paths_argument("A B")
@click.option(
    "--samples",
    type=click.IntRange(min=1),
    metavar="N",
    default=4,
    show_default=True,
    help="How many variants of each kind.",
)
@click.option(
    "--seed",
    type=click.IntRange(min=0),
    metavar="N",
    default=0,
    show_default=True,
    help="Which variants: the same seed makes the same variants.",
)
@click.option("--depth/--no-depth", default=True, help="Compare depths as well.  [default: depth]")
@form_option
@output_option
@click.option("--explain", is_flag=True, help="Show every variant, not only those that went wrong.")
@units_option
@outside_option
@debug_option
def command(debug: bool, **options: Any) -> int:
    """Ask the same question in other ways: does the answer stay?

    The mesh files A and B are scaled by powers of two, stored in another order of vertices and
    faces, given other axes, swapped, moved, given other triangles, turned, and disturbed by one
    unit in the last place, N samples of each. Each change is compared with its proven bound.

    Exit codes: 0, everything is within its bound; 1, something is not; 2, wrong usage, an
    unreadable input, or an internal error; 3, something could not be decided.
    """
    from satcheck.cli.stability import Choices, run

    del debug
    options["form"] = form_of(options["form"], options["output"])
    return run(Choices(**options))
