"""`satcheck suggest SCENE`."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from satcheck.cli.commands.options import (
    HELP_NAMES,
    Command,
    debug_option,
    output_option,
    outside_option,
    paths_argument,
    planar_option,
    split_option,
    units_option,
)
from satcheck.cli.commands.robots import POSE_OPTIONS, package_option, pose_options

FORMATS = ("toml", "json", "srdf")


def _form_of(output: Path | None) -> str:
    ending = "" if output is None else output.suffix.lower().removeprefix(".")
    return ending if ending in FORMATS else FORMATS[0]


@click.command("suggest", cls=Command, context_settings=HELP_NAMES)
@paths_argument("SCENE")
@click.option(
    "--never",
    is_flag=True,
    help="Also suggest pairs that met in none of the poses. It is not proven that they never do.",
)
@click.option(
    "--format",
    "form",
    type=click.Choice(FORMATS),
    help="toml: rules for a scene; json: data; srdf: disable_collisions for a robot. "
    "[default: as the name after -o ends; else toml]",
)
@output_option
@planar_option
@split_option
@units_option
@outside_option
@package_option
@pose_options
@debug_option
def command(debug: bool, **options: Any) -> int:
    """Suggest which pairs a scene may allow to overlap.

    These are the pairs in contact as they are placed, and links of a robot with a joint between
    them. With --sample, or several poses, pairs in contact in every pose are added; a single pose
    places the robot. The reason of each rule has the evidence. Confirm each rule: an intended
    contact and a fault look the same.

    Exit codes: 0, all pairs were looked at; 2, wrong usage, an unreadable input, or an internal
    error; 3, something could not be decided.
    """
    from satcheck.cli.posing import Posing
    from satcheck.cli.suggesting import Choices, run

    del debug
    options["form"] = options["form"] or _form_of(options["output"])
    options["posing"] = Posing(*(options.pop(name) for name in POSE_OPTIONS))
    return run(Choices(**options))
