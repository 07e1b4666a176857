"""`satcheck resolve SCENE`."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from satcheck.cli.commands.options import (
    HELP_NAMES,
    Command,
    debug_option,
    form_option,
    jobs_option,
    open_option,
    output_option,
    outside_option,
    paths_argument,
    split_option,
    units_option,
)
from satcheck.cli.commands.robots import package_option
from satcheck.cli.lengths import length
from satcheck.cli.output import form_of


@click.command("resolve", cls=Command, context_settings=HELP_NAMES)
@paths_argument("SCENE")
@click.option(
    "--moved",
    type=click.Path(dir_okay=False, path_type=Path),
    metavar="FILE",
    help="Write the moved scene to FILE. [default: show the moves only]",
)
@click.option(
    "--pin",
    "pins",
    multiple=True,
    metavar="GLOB",
    help="Do not move bodies with such an id, or with group:GLOB in such a group. Repeatable.",
)
@click.option(
    "--clearance",
    type=length,
    help="The gap to leave between bodies. [default: none, they may touch]",
)
@click.option(
    "--tolerance",
    type=length,
    help="Call it touching when the depth is at most this. "
    "[default: the precision of the input files]",
)
@click.option("--max-motion", type=length, help="Move no body farther than this.")
@click.option(
    "--iterations",
    type=click.IntRange(min=0),
    metavar="N",
    default=50,
    show_default=True,
    help="Rounds of pushing; bodies that overlap after them are taken out to a free place.",
)
@open_option
@jobs_option
@form_option
@output_option
@split_option
@package_option
@click.option(
    "--pose",
    multiple=True,
    metavar="FILE",
    help="Values of the joints of a robot, as in a check: its links stay there.",
)
@click.option(
    "--state", multiple=True, metavar="NAME", help="A state that the SRDF names, as in a check."
)
@units_option
@outside_option
@debug_option
def command(debug: bool, pose: tuple[str, ...], state: tuple[str, ...], **options: Any) -> int:
    """Move the bodies of a scene apart, by short translations.

    SCENE is a scene file or mesh files, with or without robots. Static and pinned bodies stay, and
    so do the links of robots and pairs that the scene allows. Among several ways resolve takes one
    with a small sum of squared lengths. The moved scene is checked again (with --moved the file
    that was written), and what still overlaps is reported.

    Exit codes: 0, nothing overlaps any more; 1, something does; 2, wrong usage, an unreadable
    input, or an internal error; 3, nothing is known to overlap, but not everything could be
    checked.
    """
    from satcheck.cli.posing import Posing
    from satcheck.cli.resolving import Choices, run

    del debug
    output = options["output"]
    if options["form"] is None and output is not None and output.suffix.lower() == ".toml":
        raise click.UsageError(
            f"-o {output}: the report is no TOML; --moved {output} writes the moved scene"
        )
    options["form"] = form_of(options["form"], options["output"])
    return run(Choices(**options, posing=Posing(pose, state)))
