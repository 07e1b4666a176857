"""`satcheck colliders FILE`."""

from __future__ import annotations

from collections.abc import Iterable
from functools import partial
from pathlib import Path
from typing import Any

import click
from msgspec.structs import replace

from satcheck.audit.colliders import compare
from satcheck.cli import exit_codes, option, scene_option
from satcheck.cli.click_classes import HELP_NAMES, Command
from satcheck.cli.config import stated_config
from satcheck.cli.format_option import FormatChoice, format_option, targets_of
from satcheck.cli.formats.colliders import as_report, render
from satcheck.cli.formats.registry import ALL, kind_of, pieces
from satcheck.cli.inputs import Inputs, refuse_early
from satcheck.cli.option import in_units_of, length, settings_of
from satcheck.cli.output import Document, Page, harmless, talk, tell_issues
from satcheck.cli.progress import Bar
from satcheck.core.errors import SatcheckError
from satcheck.report.colliders import ColliderLimits, CollidersReport
from satcheck.report.json import document as json_document
from satcheck.report.report import Report
from satcheck.scene import Scene
from satcheck.scene.files.readers import GEOMETRY, GeometryKind
from satcheck.scene.units import Length

FORMATS = FormatChoice(ALL, without=("csv", "bcf"))  # their rows are pairs of bodies
_BOTH = "a robot, a USD or a glTF file, which has visual and collision geometry"


@click.command("colliders", cls=Command, context_settings=HELP_NAMES)
@option.paths("FILE ...")
@click.option(
    "--max-out",
    type=length,
    help="Fail if a collider sticks out of the visual geometry by more than this.",
)
@click.option(
    "--max-short",
    type=length,
    help="Fail if visual geometry sticks out of the colliders by more than this.",
)
@format_option(FORMATS)
@option.outputs("Write the report to FILE, in the format that its name ends with. Repeatable.")
@option.top
@option.accept
@scene_option.rules
@scene_option.units
@scene_option.reading()
@scene_option.package
@option.no_config
@option.config
@option.common
def command(
    form: str | None,
    outputs: tuple[Path, ...],
    top: int | None,
    max_out: Length | None,
    max_short: Length | None,
    **options: Any,
) -> int:
    """Show how faithful the colliders of links are to what is drawn.

    FILE is a robot (a URDF with its SRDF, SDFormat, MJCF), a USD or a glTF file, which has visual
    and collision geometry. For each link proven bounds say how far the colliders stick out of what
    is drawn, and how far they fall short of it, and where; and which openings they close. The
    colliders are checked against each other at rest.

    Exit codes: 0, all links keep the limits, and no colliders overlap that may not; 1, some do; 2,
    wrong usage, an unreadable input, or an internal error; 3, that could not be decided.
    """
    inputs, targets = Inputs.taken_from(options), targets_of(form, outputs, FORMATS)
    if not inputs.paths:
        raise click.UsageError(f"give {_BOTH}")
    refuse_early(inputs, outputs)
    config = stated_config(click.get_current_context())
    document = Document()
    visual, collision = (_loaded(inputs, kind) for kind in ("visual", "collision"))
    issues = dict.fromkeys((*visual.issues, *collision.issues))
    tell_issues(issue for issue in issues if issue.severity == "error")
    limits = ColliderLimits(
        max_out=_limit(max_out, visual, "--max-out"),
        max_short=_limit(max_short, visual, "--max-short"),
    )
    with Bar("links", "comparing") as bar:
        report, checked = compare(visual, collision, limits, settings_of(options, visual), bar)
    report = replace(report, config=config)
    scenes = visual, collision
    for name, output in targets:
        shown = partial(_rendered, name, report, checked, scenes, top)
        document.deliver(shown, output, utf8=name != "table")
    files = [str(output) for _, output in targets if output is not None]
    if len(files) == len(targets):
        talk(harmless(f"{report.message} Report: {', '.join(files)}"))
    return exit_codes.for_verdict(report.verdict, report.issues)


def _rendered(
    form: str,
    report: CollidersReport,
    checked: Report,
    scenes: tuple[Scene, Scene],
    top: int | None,
    page: Page,
) -> str | bytes | Iterable[str]:
    if form == "json":
        return json_document(report)
    if form == "table":
        return render(report, checked, page, top=top)
    listed, scene = as_report(report, checked, *scenes)
    if kind_of(form) == "reports":
        return pieces({"satcheck": listed}, form)
    from satcheck.cli.formats.picture import render as render_picture

    return render_picture(form, listed, scene)


def _loaded(inputs: Inputs, kind: GeometryKind) -> Scene:
    try:
        return replace(inputs, geometry=kind).load(inputs.paths, must_count=[GEOMETRY.name])
    except SatcheckError as error:
        if error.code != "unused-option":
            raise
    scene = inputs.load(inputs.paths)
    for issue in scene.issues if not scene.bodies else ():
        if issue.severity == "error":
            raise SatcheckError(issue.code, issue.message, file=issue.file)
    # Nobody has typed --geometry.
    raise SatcheckError("unused-option", f"only one kind of geometry: give {_BOTH}")


def _limit(given: Length | None, scene: Scene, name: str) -> float | None:
    return None if given is None else in_units_of(given, scene.units, name)
