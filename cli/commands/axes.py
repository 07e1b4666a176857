"""`satcheck axes A B`."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click
from msgspec.structs import replace

from satcheck.audit.axes import axes_of
from satcheck.cli import exit_codes
from satcheck.cli.click_classes import HELP_NAMES, Command
from satcheck.cli.format_option import form_of, form_option
from satcheck.cli.inputs import Inputs, load, refuse_early
from satcheck.cli.options import (
    color_option,
    debug_option,
    open_option,
    output_option,
    pair_option,
    paths_argument,
    planar_option,
)
from satcheck.cli.output import Document, Page
from satcheck.cli.plotting import dark_option, plot_option, refuse_plot, write_plot
from satcheck.cli.scene_options import (
    geometry_options,
    merge_option,
    one_pose_options,
    package_option,
    reading_options,
    split_option,
    units_option,
)
from satcheck.report.json import document as json_document
from satcheck.scene import Scene

if TYPE_CHECKING:
    from satcheck.core.conventions import Plane
    from satcheck.report.axes import AxesReport

# Rows of a table; JSON has all axes.
TABLE_ROWS = 20


@click.command("axes", cls=Command, context_settings=HELP_NAMES)
@paths_argument("A B")
@pair_option
@click.option(
    "--top",
    type=click.IntRange(min=1),
    metavar="N",
    help=f"List the N most telling axes: the largest gaps, then the smallest overlaps. "
    f"[default: {TABLE_ROWS} in a table, all in JSON]",
)
@plot_option("Draw the shadows on each axis")
@dark_option
@planar_option
@form_option
@output_option
@split_option
@merge_option
@units_option
@open_option
@reading_options
@package_option
@geometry_options
@one_pose_options
@color_option
@debug_option
def command(
    form: str | None,
    output: Path | None,
    bodies: tuple[str, str] | None,
    top: int | None,
    plot: Path | None,
    dark: bool,
    planar: Plane | None,
    allow_open: bool,
    **options: Any,
) -> int:
    """Show why two convex bodies are apart: the separating axis theorem, axis by axis.

    Two convex bodies are apart exactly if their shadows on some axis are. Only the face normals of
    both and the cross products of their edges can be needed: 15 axes for two boxes. For each of
    them axes shows both shadows, the gap or the overlap with its proven sign, and where a test
    stops. The winner is the separating axis, or that of the minimum translation vector. Of a
    concave body it takes the convex hull, and says so.

    A and B are mesh files; a scene or a robot can take their place.

    Exit codes: 0, the axes show how the bodies relate; 2, wrong usage, an unreadable input, or an
    internal error; 3, the sign of an axis is not known, so they do not show it.
    """
    inputs = Inputs.taken_from(options)
    form = form_of(form, output)
    refuse_early(inputs, output)
    refuse_plot(inputs, plot, output)
    document = Document()
    scene = _posed(load(inputs), inputs)
    rows = TABLE_ROWS if form == "table" and top is None else top
    result = axes_of(scene, bodies, planar=planar, allow_open=allow_open)
    if plot:
        from satcheck.cli.formats.axes_plot import draw

        write_plot(draw(result, dark=dark), plot)
    shown = replace(
        result, axes=result.axes[:rows], left_out=len(result.axes) - len(result.axes[:rows])
    )
    document.deliver(lambda page: _render(shown, form, page), output, utf8=form == "json")
    return exit_codes.INCOMPLETE if result.winner is None else exit_codes.CLEAN


def _posed(scene: Scene, inputs: Inputs) -> Scene:
    if not inputs.has_poses:
        return scene
    from satcheck.cli.posing import posed_once

    return posed_once(scene, inputs, "axes are those of one pose: give one --pose")


def _render(result: AxesReport, form: str, page: Page) -> str:
    if form == "json":
        return json_document(result)
    from satcheck.cli.formats.axes import render

    return render(result, page)
