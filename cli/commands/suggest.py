"""`satcheck suggest SCENE`."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from contextlib import closing
from itertools import chain
from pathlib import Path
from typing import Any

import click
from click.core import ParameterSource
from msgspec.structs import replace

from satcheck.audit.batch.local import check_locally
from satcheck.audit.batch.options import Limits
from satcheck.audit.batch.slot_server import Wanted
from satcheck.audit.settings import Settings
from satcheck.audit.suggest import LOOSER, MEASURED, Suggestions, suggest, suggestions_of
from satcheck.cli import exit_codes, option, scene_option
from satcheck.cli.click_classes import HELP_NAMES, Command
from satcheck.cli.commands import DEFAULT_COMMAND
from satcheck.cli.format_option import FormatChoice, form_of, format_option
from satcheck.cli.formats.registry import Format
from satcheck.cli.formats.suggest import remark, rules_of, srdf, toml
from satcheck.cli.inputs import Inputs, load, refuse_early
from satcheck.cli.option import settings_of
from satcheck.cli.output import Document, talk, tell_issues
from satcheck.cli.posing import poses_of
from satcheck.cli.progress import Bar
from satcheck.cli.slips import call_of
from satcheck.cli.worlds import asset_names, check_options
from satcheck.report.assets import Result
from satcheck.report.json import document as json_document
from satcheck.report.json import read_line
from satcheck.report.report import Report
from satcheck.report.suggestions import Suggestion
from satcheck.scene import Scene
from satcheck.scene.opening import is_folder
from satcheck.scene.robot import Pose, RandomPoses, pose_of_states, posed

_WRITTEN = (
    Format("toml", (".toml",), about="rules for a scene"),
    Format("json", (".json",), about="data"),
    Format("srdf", (".srdf",), about="disable_collisions for a robot"),
)
FORMATS = FormatChoice((), {each.name: each for each in _WRITTEN})


@click.command("suggest", cls=Command, context_settings=HELP_NAMES)
@option.paths("SCENE|DIR")
@click.option(
    "--never",
    is_flag=True,
    help="Also suggest pairs that met in none of the poses. It is not proven that they never do.",
)
@format_option(FORMATS, "as the name after -o ends; else toml")
@option.output
@option.exclude
@option.planar
@scene_option.scene
@scene_option.poses
@option.common
def command(
    form: str | None,
    output: Path | None,
    never: bool,
    **options: Any,
) -> int:
    """Suggest which pairs a scene may allow to overlap.

    A rule limits an overlap to its thickness and its depth as placed, and 10 % more; one rule
    stands for all bodies whose names differ in a number. A touch needs no rule. Of a folder, each
    asset is a scene of its own, and the worst one sets the limits of two names. Links of a robot
    that a joint connects are allowed; with --sample, or several poses, also those in contact in
    every pose. A single pose places the robot. Confirm each rule: an intended contact and a fault
    look the same.

    Exit codes: 0, all pairs were looked at; 2, wrong usage, an unreadable input, or an internal
    error; 3, something could not be decided.
    """
    inputs = Inputs.taken_from(options)
    named = form_of(form, output, FORMATS)
    form = "toml" if named == "table" else named
    refuse_early(inputs, [output])
    document = Document()
    told: set[str] = set()
    of_folders = any(map(is_folder, inputs.paths))
    if of_folders:
        if form == "srdf" or inputs.has_poses:
            raise click.UsageError("a robot in a folder stands as its file says: give it alone")
        result, robot = _of_assets(inputs, options), ""
    else:
        source = click.get_current_context().get_parameter_source("exclude")
        if source is ParameterSource.COMMANDLINE:  # a config file is about other commands, too
            raise click.UsageError("--exclude leaves out files of a folder, and none is given")
        scene = load(inputs)
        if form == "srdf" and len(scene.robots) != 1:
            raise click.UsageError("SRDF is about one robot: give one URDF")
        robot = scene.robots[0].robot.name if scene.robots else ""
        told = {issue.code for issue in scene.issues}
        result = _of_scene(scene, inputs, settings_of(options, scene))
    pairs = [pair for pair in result.report.suggestions if never or pair.why != "never"]
    if form == "srdf":
        pairs = [pair for pair in pairs if pair.why != "contact"]
    document.deliver(lambda _: _text(form, result, pairs, robot), output, utf8=True)
    errors = [issue for issue in result.issues if issue.severity == "error"]
    tell_issues(issue for issue in errors if issue.code not in told)
    talk(remark(result, pairs, never=never))
    if form == "toml" and pairs and output is not None:
        name = "batch" if of_folders else DEFAULT_COMMAND
        line = call_of(name, inputs.paths, ["--rules", str(output)])
        talk(f"Next: {line} checks with these rules.")
    _tell_of_assets(result, inputs)
    if form == "srdf" and pairs:
        talk("An SRDF has one line for two links: it covers all pairs of their bodies.")
    if errors:
        return exit_codes.ERROR
    return exit_codes.INCOMPLETE if result.undecided else exit_codes.CLEAN


def _text(form: str, result: Suggestions, pairs: Sequence[Suggestion], robot: str) -> str:
    """robot: its name, for an SRDF."""
    if form == "json":
        return json_document(result.report)
    return srdf(result, pairs, robot) if form == "srdf" else toml(result, pairs)


def _tell_of_assets(result: Suggestions, inputs: Inputs) -> None:
    """Say what to do where a rule, which goes by names, would loosen another asset."""
    refused = any(pair.reason.startswith(LOOSER) for pair in result.report.unchecked)
    if refused or any(rule.milder for rule in rules_of(result, result.report.suggestions)):
        line = call_of("batch", inputs.paths, ["-o", "report.json"])
        talk(f"Next: {line}, then satcheck baseline write baseline.json report.json accepts what")
        talk("each asset has now, by itself.")


def _of_scene(scene: Scene, inputs: Inputs, settings: Settings) -> Suggestions:
    """The pose that --sample starts from places the robots, too; a list of poses does not."""
    given = poses_of(scene, inputs) if inputs.has_poses else {}
    poses: Sequence[Pose] = () if isinstance(given, Mapping) else given
    placed = given if isinstance(given, Mapping) else pose_of_states(scene, inputs.state)
    if isinstance(given, RandomPoses):
        placed = given.fixed
    if placed:
        scene = posed(scene, placed)
    held = tuple(placed) if inputs.sample else ()
    with Bar("poses") as bar:
        return suggest(scene, settings, poses, inputs.random_seed, progress=bar, held=held)


def _of_assets(inputs: Inputs, options: Mapping[str, Any]) -> Suggestions:
    """Each asset of the folders is checked as a world of its own."""
    assets = asset_names(inputs)
    inputs = replace(inputs, folders=tuple(assets.folders))
    terms = check_options(inputs, {**options, **MEASURED}, None, None)
    worlds = [(file,) for file in assets.files]
    found: dict[str, Report] = {}
    slots, wanted = os.cpu_count() or 1, Wanted(kept=False)
    checked = check_locally(worlds, terms, Limits(), slots, wanted)
    with closing(checked) as answers, Bar("assets") as bar:
        for each in chain.from_iterable(answers):
            found[each.world[0]] = read_line(each.line, Result).report
            if bar is not None:
                bar(len(found), len(worlds))
    return suggestions_of({file: found[file] for (file,) in worlds})
