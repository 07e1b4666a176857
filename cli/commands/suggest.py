"""`satcheck suggest SCENE`."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import click
from msgspec.structs import replace

from satcheck.audit.suggest import Suggestions, suggest
from satcheck.cli import exit_codes
from satcheck.cli.click_classes import HELP_NAMES, Command
from satcheck.cli.formats.suggest import chosen, remark, srdf, toml
from satcheck.cli.formats.words import issue_line
from satcheck.cli.inputs import Inputs, load, refuse_early
from satcheck.cli.lengths import settings_of
from satcheck.cli.options import (
    color_option,
    debug_option,
    output_option,
    paths_argument,
    planar_option,
)
from satcheck.cli.output import Document, talk
from satcheck.cli.posing import poses_of
from satcheck.cli.progress import Bar
from satcheck.cli.scene_options import (
    geometry_options,
    merge_option,
    package_option,
    pose_options,
    reading_options,
    split_option,
    units_option,
)
from satcheck.report.json import document as json_document
from satcheck.scene import Scene
from satcheck.scene.robot import Pose, posed

FORMATS = ("toml", "json", "srdf")
# Names of files that hold rules.
_RULES = (".toml", ".srdf")


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
@click.option(
    "--surface-tolerance",
    "tolerances",
    is_flag=True,
    help="Suggest a surface tolerance instead: how far facets are off the curves that they stand "
    "for, measured on the meshes, with the evidence.",
)
@click.option(
    "--support",
    is_flag=True,
    help="Suggest fixed bodies instead, and rules that ask whether the others are supported.",
)
@output_option
@planar_option
@split_option
@merge_option
@units_option
@reading_options
@package_option
@geometry_options
@pose_options
@color_option
@debug_option
def command(
    form: str | None,
    output: Path | None,
    never: bool,
    tolerances: bool,
    support: bool,
    **options: Any,
) -> int:
    """Suggest which pairs a scene may allow to overlap.

    satcheck suggests the pairs that are in contact as placed, and the links of a robot that a joint
    connects. With --sample, or several poses, it adds the pairs in contact in every pose; a single
    pose places the robot. The reason of each rule states the evidence. Confirm each rule: an
    intended contact and a fault look the same.

    Exit codes: 0, all pairs were looked at; 2, wrong usage, an unreadable input, or an internal
    error; 3, something could not be decided.
    """
    inputs = Inputs.taken_from(options)
    if support:
        if (
            never
            or tolerances
            or inputs.has_poses
            or options["planar"]
            or form not in (None, "toml")
        ):
            raise click.UsageError("--support is about bodies as they are placed, as TOML")
        return _support(inputs, output)
    if tolerances:
        if never or inputs.has_poses or options["planar"] or form not in (None, "json"):
            raise click.UsageError("--surface-tolerance is about meshes alone, as text or JSON")
        if form is None and output is not None and output.suffix.lower() in _RULES:
            raise click.UsageError(
                f"{output}: --surface-tolerance writes text or JSON: name the file .txt or .json"
            )
        return _surface_tolerances(inputs, form, output)
    form = form or _form_of(output)
    refuse_early(inputs, output)
    document = Document()
    scene = load(inputs)
    if form == "srdf" and len(scene.robots) != 1:
        raise click.UsageError("SRDF is about one robot: give one URDF")
    result = _suggest(scene, inputs, options)
    pairs = chosen(result, never=never)
    text = {
        "json": lambda: json_document(result.document()),
        "srdf": lambda: srdf(result, pairs, scene.robots[0].robot.name),
        "toml": lambda: toml(result, pairs),
    }[form]()
    document.deliver(lambda _: text, output, utf8=True)
    told = {issue.code for issue in scene.issues}
    errors = [issue for issue in result.issues if issue.severity == "error"]
    for issue in errors:
        if issue.code not in told:
            talk(f"satcheck: {issue_line(issue)}")
    talk(remark(result, pairs, never=never))
    if form == "srdf" and pairs:
        talk("An SRDF has one line for two links: it covers all pairs of their bodies.")
    if errors:
        return exit_codes.ERROR
    return exit_codes.INCOMPLETE if result.undecided else exit_codes.CLEAN


def _surface_tolerances(inputs: Inputs, form: str | None, output: Path | None) -> int:
    from satcheck.audit.suggest_surface_tolerances import surface_tolerances
    from satcheck.cli.formats import surface_tolerances as words

    refuse_early(inputs, output)
    document = Document()
    scene = load(inputs, hashed=False, least=1)
    scene.require_in_space("it has no facets")
    result = surface_tolerances(scene)
    as_json = "json" in (form, _form_of(output))
    text = json_document(result) if as_json else words.render(result)
    document.deliver(lambda _: text, output, utf8=True)
    talk(words.remark(result))
    return exit_codes.ERROR if scene.unreadable else exit_codes.CLEAN


def _support(inputs: Inputs, output: Path | None) -> int:
    from satcheck.audit.suggest_support import suggest_support
    from satcheck.cli.formats import suggested_support as words

    refuse_early(inputs, output)
    document = Document()
    scene = load(inputs, hashed=False)
    terms = suggest_support(scene, settings_of(inputs.limits, scene))
    document.deliver(lambda _: words.toml(terms), output, utf8=True)
    talk(words.remark(terms))
    return exit_codes.ERROR if scene.unreadable else exit_codes.CLEAN


def _suggest(scene: Scene, inputs: Inputs, options: dict[str, Any]) -> Suggestions:
    placed, poses = _poses(scene, inputs)
    if placed:
        scene = posed(scene, placed)
    held = tuple(placed) if inputs.sample else ()
    settings = settings_of({**options, **inputs.limits}, scene)
    with Bar("poses") as bar:
        return suggest(scene, settings, poses, inputs.random_seed, progress=bar, held=held)


def _poses(scene: Scene, inputs: Inputs) -> tuple[Pose, Sequence[Pose]]:
    """(as the robots are placed, the other poses to look at). The pose that --sample starts from
    places them too; a list of poses does not."""
    if not inputs.has_poses:
        return {}, []
    poses = poses_of(scene, inputs)
    if isinstance(poses, Mapping):
        return poses, []
    fixed = replace(inputs, pose=inputs.pose if inputs.sample else (), sample=None, seed=None)
    placed = poses_of(scene, fixed)
    assert isinstance(placed, Mapping)  # --sample takes no list
    return placed, poses
