"""`satcheck axes A B`."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click
from msgspec.structs import replace

from satcheck.audit.axes import axes_of
from satcheck.cli import exit_codes, option, scene_option
from satcheck.cli.click_classes import HELP_NAMES, Command
from satcheck.cli.format_option import deliver, form_option, plain_call
from satcheck.cli.formats.axes import render
from satcheck.cli.inputs import load
from satcheck.cli.plotting import plot_option, refuse_plot, write_plot
from satcheck.cli.posing import posed_once

if TYPE_CHECKING:
    from satcheck.core.conventions import Plane

# Rows of a table; JSON has all axes.
TABLE_ROWS = 20


@click.command("axes", cls=Command, context_settings=HELP_NAMES)
@option.paths("A B")
@option.pair
@click.option(
    "--top",
    type=option.Whole(min=1),
    metavar="N",
    help=f"List the N most telling axes: the largest gaps, then the smallest overlaps. "
    f"[default: {TABLE_ROWS} in a table, all in JSON]",
)
@plot_option("Draw the shadows on each axis")
@option.planar
@form_option
@option.output
@option.open_meshes
@scene_option.one_scene
@option.common
def command(
    form: str | None,
    output: Path | None,
    bodies: tuple[str, str] | None,
    top: int | None,
    plot: Path | None,
    planar: Plane | None,
    allow_open: bool,
    **options: Any,
) -> int:
    """Show why two convex bodies are apart, axis by axis.

    Two convex bodies are apart exactly if their shadows on some axis are. Only the face normals of
    both and the cross products of their edges can be needed: 15 axes for two boxes. For each of
    them axes shows both shadows, the gap or the overlap with its proven sign, and where a test
    stops. The winner is the separating axis, or that of the minimum translation vector. Of a
    concave body it takes the convex hull, and says so.

    A and B are mesh files; a scene or a robot can take their place.

    Exit codes: 0, the axes show how the bodies relate; 2, wrong usage, an unreadable input, or an
    internal error; 3, the sign of an axis is not known, so they do not show it.
    """
    inputs, form, document = plain_call(options, form, output, plot)
    refuse_plot(plot)
    scene = load(inputs, tell_all=True)
    scene = posed_once(scene, inputs, "axes are those of one pose: give one --pose")
    rows = TABLE_ROWS if form == "table" and top is None else top
    result = axes_of(scene, bodies, planar=planar, allow_open=allow_open)
    if plot:
        from satcheck.cli.formats.axes_plot import draw

        write_plot(draw(result), plot)
    shown = replace(
        result, axes=result.axes[:rows], left_out=len(result.axes) - len(result.axes[:rows])
    )
    deliver(document, shown, form, output, partial(render, shown))
    return exit_codes.INCOMPLETE if result.winner is None else exit_codes.CLEAN
