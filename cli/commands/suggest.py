"""`satcheck suggest SCENE`."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import click

from satcheck.audit.suggest import suggest
from satcheck.cli import exit_codes, option, scene_option
from satcheck.cli.click_classes import HELP_NAMES, Command
from satcheck.cli.formats.suggest import chosen, remark, srdf, toml
from satcheck.cli.inputs import Inputs, load, refuse_early
from satcheck.cli.option import settings_of
from satcheck.cli.output import Document, issue_line, talk
from satcheck.cli.posing import poses_of
from satcheck.cli.progress import Bar
from satcheck.report.json import document as json_document
from satcheck.scene import Scene
from satcheck.scene.robot import Pose, RandomPoses, pose_of_states, posed

FORMATS = ("toml", "json", "srdf")


@click.command("suggest", cls=Command, context_settings=HELP_NAMES)
@option.paths("SCENE")
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
@option.output
@option.planar
@scene_option.split
@scene_option.merge
@scene_option.units
@scene_option.reading
@scene_option.package
@scene_option.geometry
@scene_option.poses
@option.common
def command(
    form: str | None,
    output: Path | None,
    never: bool,
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
    if form is None:
        ending = "" if output is None else output.suffix.lower().removeprefix(".")
        form = ending if ending in FORMATS else FORMATS[0]
    refuse_early(inputs, output)
    document = Document()
    scene = load(inputs)
    if form == "srdf" and len(scene.robots) != 1:
        raise click.UsageError("SRDF is about one robot: give one URDF")
    placed, poses = _poses(scene, inputs)
    if placed:
        scene = posed(scene, placed)
    held = tuple(placed) if inputs.sample else ()
    settings = settings_of({**options, **inputs.limits}, scene)
    with Bar("poses") as bar:
        result = suggest(scene, settings, poses, inputs.random_seed, progress=bar, held=held)
    pairs = chosen(result.report, never=never)
    if form == "json":
        text = json_document(result.report)
    elif form == "srdf":
        text = srdf(result, pairs, scene.robots[0].robot.name)
    else:
        text = toml(result.report, pairs)
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


def _poses(scene: Scene, inputs: Inputs) -> tuple[Pose, Sequence[Pose]]:
    """(as the robots are placed, the other poses to look at). The pose that --sample starts from
    places them too; a list of poses does not."""
    if not inputs.has_poses:
        return {}, []
    poses = poses_of(scene, inputs)
    if isinstance(poses, Mapping):
        return poses, []
    if isinstance(poses, RandomPoses):
        return poses.fixed, poses
    return pose_of_states(scene, inputs.state), poses
