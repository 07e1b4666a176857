"""`satcheck suggest SCENE`."""

from __future__ import annotations

from typing import Any

import click

from satcheck.cli.commands.options import HELP_NAMES, debug_option, output_option, paths_argument
from satcheck.cli.commands.robots import package_option

FORMATS = ("toml", "json", "srdf")


@click.command("suggest", context_settings=HELP_NAMES)
@paths_argument("SCENE")
@click.option(
    "--sample",
    type=click.IntRange(min=1),
    metavar="N",
    help="Look at N random poses of the robots too: which pairs always meet, which never.",
)
@click.option(
    "--seed",
    type=click.IntRange(min=0),
    metavar="N",
    help="Which random poses: the same number draws the same ones.  [default: 0]",
)
@click.option(
    "--never",
    is_flag=True,
    help="Suggest pairs too that met in none of the poses. That they never do is not proven.",
)
@click.option(
    "--format",
    "form",
    type=click.Choice(FORMATS),
    default=FORMATS[0],
    show_default=True,
    help="Rules for a scene file, data, or disable_collisions for the SRDF of a robot.",
)
@output_option
@package_option
@debug_option
def command(debug: bool, **options: Any) -> int:
    """Suggest which pairs a scene may allow to overlap.

    These are the pairs in contact as they are placed, links of a robot with a joint between them,
    and with --sample those that are in contact in every pose. The evidence stands in the reason of
    each rule: whether the contact is meant is yours to confirm.

    Exit codes: 0, all pairs were looked at; 2, wrong usage, an unreadable input, or an internal
    error; 3, something could not be decided.
    """
    from satcheck.cli.suggesting import Choices, run

    del debug
    return run(Choices(**options))
