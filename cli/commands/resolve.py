"""`satcheck resolve SCENE`."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Any

import click

from satcheck.audit import Report, Settings, check
from satcheck.audit.resolve.resolve import resolve
from satcheck.audit.words import counted, number, vector, with_unit
from satcheck.cli import exit_codes, option, scene_option
from satcheck.cli.click_classes import HELP_NAMES, Command
from satcheck.cli.format_option import deliver, form_option, plain_call, product_and_report
from satcheck.cli.formats.summary import counts_line
from satcheck.cli.formats.tables import ROWS, Column, fitted_each, joined, table
from satcheck.cli.inputs import Inputs, load
from satcheck.cli.option import in_units_of, length, settings_of
from satcheck.cli.output import Page, talk, tell_issues, write_file
from satcheck.cli.posing import posed_once
from satcheck.cli.progress import Bar
from satcheck.core.conventions import Vector
from satcheck.core.errors import SatcheckError
from satcheck.report.resolution import Move, ResolutionReport, ResolutionSummary
from satcheck.scene import Scene, load_scene
from satcheck.scene.files.readers import kind_of
from satcheck.scene.loader import is_rules
from satcheck.scene.new_scene_file import left_out_of, new_scene_file, stray_mesh
from satcheck.scene.units import Length, unit_of


@click.command("resolve", cls=Command, context_settings=HELP_NAMES)
@option.paths("SCENE")
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
@option.tolerance
@click.option("--max-motion", type=length, help="Move no body farther than this.")
@click.option(
    "--iterations",
    type=option.Whole(min=0),
    metavar="N",
    default=50,
    show_default=True,
    help="Rounds of pushing. Bodies that still overlap then move to a free place.",
)
@option.open_meshes
@option.jobs
@form_option
@option.outputs(
    "Write the moved scene to a scene file (.toml, .scene.json), or the report (.json). "
    "Repeatable.  [default: show the moves only]"
)
@scene_option.one_scene
@option.common
def command(
    form: str | None,
    outputs: tuple[Path, ...],
    pins: tuple[str, ...],
    max_motion: Length | None,
    iterations: int,
    **options: Any,
) -> int:
    """Move the bodies of a scene apart, by short ways.

    SCENE is a scene file or mesh files, with or without robots. Static and pinned bodies stay, and
    so do the links of robots and pairs that the scene allows. The translations are short, not the
    shortest. The moved scene is checked again (with -o moved.toml the file that was written), and
    what still overlaps is reported.

    Exit codes: 0, no pair overlaps any more; 1, a pair does; 2, wrong usage, an unreadable input,
    or an internal error; 3, nothing is known to overlap, but not everything could be checked.
    """
    scene_out, output = product_and_report(outputs, (".toml", ".scene.json"), form)
    inputs, form, document = plain_call(options, form, output, scene_out)
    if scene_out is not None:
        _refuse_output(inputs, scene_out)
    scene = load(inputs)
    scene = posed_once(scene, inputs, "resolve takes one pose, which places the links")
    stray = scene_out and _stray(scene_out, scene, allow_outside=inputs.allow_outside)
    settings = settings_of(options, scene)
    farthest = None
    if max_motion is not None:
        farthest = in_units_of(max_motion, scene.units, "--max-motion")
    written = None if scene_out is None else partial(_written, scene_out, scene, inputs)
    with Bar(verb="pushing apart") as bar:
        resolution, report = resolve(
            scene,
            settings,
            pins=pins,
            max_motion=farthest,
            iterations=iterations,
            progress=bar,
            checked=written,
            output=None if scene_out is None else str(scene_out),
        )
    deliver(document, resolution, form, output, partial(_table, resolution, report))
    if output is not None:
        talk(f"{report.message} Report: {output}")
    if stray:
        talk(f"note: to read {scene_out} give --allow-outside, because of {stray}")
    if scene_out is not None and scene.robots:
        talk(f"note: {scene_out} has no joints: the bodies stand where they were moved")
    return exit_codes.for_verdict(report.summary.verdict, report.issues)


def _refuse_output(inputs: Inputs, moved: Path) -> None:
    """Refuse what cannot be written before any work is done."""
    paths, permitted = inputs.paths, inputs.permitted
    bodies = [path for path in paths if len(paths) == 1 or not is_rules(path, permitted)]
    kinds = {kind_of(path) for path in bodies}
    if not (kinds <= {"mesh", "document"} or (kinds == {"scene"} and len(bodies) == 1)):
        raise click.UsageError(
            f"-o {moved} needs one scene file, or files without joints and rules: links of robots "
            "are not moved"
        )


def _stray(output: Path, scene: Scene, *, allow_outside: bool) -> str | None:
    """A mesh outside of the folder of the scene file to write, which names it; UsageError unless
    allow_outside, and for a body that the file cannot state."""
    for body in left_out_of(scene):
        raise click.UsageError(
            f"-o {output}: {body} could not be read, and a scene file cannot state it"
        )
    stray = stray_mesh(output, scene)
    if stray is not None and not allow_outside:
        raise click.UsageError(
            f"-o {output}: {stray} lies outside of its folder: write it into a "
            "folder that contains the meshes, or add --allow-outside"
        )
    return stray


def _written(
    path: Path, scene: Scene, inputs: Inputs, moves: Mapping[str, Vector], settings: Settings
) -> Report:
    """Write the moved scene, and return the check of the file, as anybody would check it. Errors of
    reading are told. What cannot be read is not left behind."""
    write_file(path, new_scene_file(path, scene, inputs.mesh_files(scene.reading), moves))
    try:
        moved = load_scene(
            [str(path)],
            units=inputs.units,
            allow_outside=inputs.allow_outside,
            reading=inputs.reading,
            geometry=inputs.geometry,
        )
    except SatcheckError:
        path.unlink(missing_ok=True)
        raise
    report = check(moved, settings)
    tell_issues(issue for issue in report.issues if issue.severity == "error")
    return report


def _table(resolution: ResolutionReport, report: Report, page: Page) -> str:
    """Return the whole text, final newline included. report: of the moved scene."""
    shown = list(resolution.moves)
    if len(shown) > ROWS:  # the longest ones, and not in the order of the scene
        shown = sorted(shown, key=lambda move: -move.length)[:ROWS]
    said = []
    if rest := len(resolution.moves) - len(shown):
        said.append(f"{counted(rest, 'more body', 'more bodies')} moved by less")
    messages = {(finding.a, finding.b): finding.message for finding in report.findings}
    said += (
        f"not resolved: {messages[left.a, left.b].removesuffix('.')}: {left.reason}"
        for left in resolution.left
    )
    said.append(_motion_line(resolution, report))
    if resolution.summary.flush:
        pairs = counted(resolution.summary.flush, "pair")
        said.append(f"{pairs} within the tolerance: they count as touching.")
    subject = resolution.output or "The moved scene"
    said.append(f"{subject}, checked again: {counts_line(report)}")
    said.append(report.message)
    lines = _moves(shown, page) if shown else []
    return joined([*lines, *fitted_each(said, page)], page)


def _moves(moves: Sequence[Move], page: Page) -> list[str]:
    columns = (
        Column("body", tuple(move.body for move in moves), named=True),
        Column("move by", tuple(vector(move.translation) for move in moves), folds=True),
        Column("length", tuple(number(move.length) for move in moves), right=True),
    )
    return table(columns, page)


def _conflicts(summary: ResolutionSummary) -> str:
    """`2 overlaps, 3 gaps below their clearance, 1 pair left open by a hole`."""
    overlaps = summary.conflicts - summary.gaps - summary.open
    below = counted(summary.gaps, "gap below its clearance", "gaps below their clearance")
    kinds = {
        counted(overlaps, "overlap"): overlaps,
        below: summary.gaps,
        counted(summary.open, "pair") + " left open by a hole": summary.open,
    }
    return ", ".join(text for text, count in kinds.items() if count)


def _motion_line(resolution: ResolutionReport, report: Report) -> str:
    """`2 overlaps: 3 bodies moved by 1.25 mm in total, at most 0.75 mm, in 2 rounds; 1 stays.`"""
    summary, unit = resolution.summary, unit_of(resolution.units)
    stays = ""
    if summary.pinned:
        stays = f" {counted(summary.pinned, 'body', 'bodies')} had to stay."
    if not summary.conflicts:
        where = "as the bodies are placed" if report.motions else "beyond what is allowed"
        return f"Nothing overlaps {where}: nothing was moved.{stays}"
    conflicts = _conflicts(summary)
    if not summary.moved:
        return f"{conflicts}: nothing was moved.{stays}"
    total, largest = (
        with_unit(number(length), unit) for length in (summary.total_motion, summary.largest_motion)
    )
    return (
        f"{conflicts}: {counted(summary.moved, 'body', 'bodies')} moved, "
        f"by {total} in total and {largest} at most, "
        f"in {counted(summary.rounds, 'round')}.{stays}"
    )
