"""`satcheck A B [C ...]`: the check of bodies, or of robots in many poses."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click
from msgspec.structs import replace

from satcheck._version import __version__
from satcheck.audit import Report, Settings, check
from satcheck.audit.baseline import (
    beside_baseline,
    measuring,
    names_in_baseline,
    read_baseline,
)
from satcheck.audit.settings import ACCURACIES, FAIL_ON, MOST_BUDGET
from satcheck.audit.stated_places import with_stated_places
from satcheck.cli import exit_codes, option, scene_option
from satcheck.cli.click_classes import HELP_NAMES, Command
from satcheck.cli.commands import all_commands
from satcheck.cli.format_option import FormatChoice, format_option, targets_of
from satcheck.cli.formats.registry import ALL, function_of, kind_of
from satcheck.cli.inputs import Inputs, load, refuse_early, worlds_of
from satcheck.cli.option import length, settings_of
from satcheck.cli.output import Document, talk
from satcheck.cli.progress import Bar
from satcheck.cli.rendering import (
    Delivery,
    deliver,
    refuse_certificate,
    refuse_of_poses,
    refuse_of_worlds,
)
from satcheck.report.samples import SamplesReport
from satcheck.scene import Scene
from satcheck.scene.files.readers import readers, robots

if TYPE_CHECKING:
    from satcheck.scene.robot import Pose

FORMATS = FormatChoice(ALL)
WIDTH = option.Number(0, 1, min_open=True, max_open=True)


class _DefaultContext(click.Context):
    """The default command's name is never typed, so it is never shown."""

    @property
    def command_path(self) -> str:
        return self.parent.command_path if self.parent else super().command_path


class _DefaultCommand(Command):
    context_class = _DefaultContext

    def collect_usage_pieces(self, _: click.Context) -> list[str]:
        return ["[OPTIONS] A B [C ...]"]

    def format_help_text(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        self.help = _help()
        super().format_help_text(ctx, formatter)

    def format_epilog(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        del ctx
        with formatter.section("Other commands"):
            formatter.write_dl(
                [(f"satcheck {name}", text) for name, text in all_commands().items()]
            )
        with formatter.section("Exit codes"):
            formatter.write_dl(
                [
                    ("0", "everything was checked, and no pair fails"),
                    ("1", "a pair overlaps more than is allowed, or is closer than its clearance"),
                    ("2", "wrong usage, an unreadable input, or an internal error"),
                    ("3", "no pair is known to fail, but not everything could be checked"),
                    ("130", "interrupted"),
                ]
            )


def _help() -> str:
    """Return the text above the options. The registry says which formats there are."""
    titles: dict[str, dict[str, None]] = {"mesh": {}, "document": {}, "robot": {}}
    for reader in readers().values():
        titles[reader.kind][reader.title] = None
    meshes, documents = ", ".join(titles["mesh"]), ", ".join(["TOML", "JSON", *titles["document"]])
    known = ", ".join(dict.fromkeys(robot.title for robot in robots().values()))
    return f"""Do these meshes collide? How deep, and which way out?

    A, B ... are meshes ({meshes}), scenes ({documents}) or robots ({known}, SRDF). A body is a
    file; of one file alone that has nodes, a node. Every pair of bodies is checked, in the
    coordinates of the files. A LENGTH is in units of the files, or has its own: 2mm.

    \b
      satcheck a.stl b.stl                   do they collide?
      satcheck a.stl b.stl -o report.html    look at the overlap
      satcheck assembly.glb                  the parts of one file
      satcheck batch models                  every file of a folder, by itself
    """


def _version(ctx: click.Context, _: click.Parameter, wanted: bool) -> None:
    if wanted and not ctx.resilient_parsing:
        Document().write(f"satcheck {__version__}\n")
        ctx.exit()


# The options of daily use. Those of a robot or a format are in messages that ask for them.
DAILY = """outputs form clearance max_thickness max_depth tolerance depth rules baseline allow_open
units split sample explain version"""


@click.command(
    "check",
    cls=_DefaultCommand,
    context_settings=HELP_NAMES,
    hidden=True,
    daily=DAILY,
)
@option.paths("A B [C ...]")
@format_option(FORMATS)
@option.outputs(
    "Write the report to FILE, in the format that its name ends with; - is standard output. "
    "Repeatable."
)
@click.option(
    "--explain",
    is_flag=True,
    help="Show the steps of each pair: what each proved, its time.",
)
@option.top
@option.setting(
    "depth",
    "--depth/--no-depth",
    note="for mesh files of one body each; otherwise for the worst pairs that fail",
)
@option.setting("max_thickness", type=length)
@option.setting("max_depth", type=length)
@option.setting("contacts")
@option.setting("components")
@option.setting("parts")
@option.setting("volume")
@option.setting("clearance", type=length)
@option.tolerance
@option.setting("surface_tolerance", type=length, note="of the scene, else 0")
@option.setting("accuracy", type=click.Choice(ACCURACIES), metavar="LEVEL")
@option.method
@option.setting("width", type=WIDTH, metavar="RATIO")
@option.setting("budget", type=option.Number(0, MOST_BUDGET, min_open=True), metavar="SECONDS")
@option.planar
@scene_option.split
@option.setting("fail_on", type=click.Choice(FAIL_ON), metavar="SEVERITY")
@click.option(
    "--baseline",
    type=click.Path(dir_okay=False, path_type=Path),
    metavar="FILE",
    help="Fail only on findings that are new, or worse than in FILE (satcheck baseline).",
)
@scene_option.rules
@scene_option.between
@scene_option.merge
@option.accept
@option.open_meshes
@option.setting("cross_check")
@option.setting("certificate")
@option.jobs
@click.option(
    "--no-timings",
    "timings",
    is_flag=True,
    flag_value=False,
    default=option.DEFAULTS.timings,
    help="Leave out times: same input, same bytes.",
)
@click.option("-q", "--quiet", is_flag=True, help="Print errors only; -o still writes the report.")
@option.exit_zero
@scene_option.units
@scene_option.reading("body-seconds")
@scene_option.package
@scene_option.geometry
@scene_option.poses
@scene_option.joint_path
@option.color()
@option.no_config
@option.config
@option.debug()
@click.option(
    "--version",
    is_flag=True,
    is_eager=True,
    expose_value=False,
    callback=_version,
    help="Show the version and exit.",
)
def command(
    form: str | None,
    outputs: tuple[Path, ...],
    baseline: Path | None,
    explain: bool,
    top: int | None,
    quiet: bool,
    exit_zero: bool,
    **options: Any,
) -> int:
    """Check bodies, or robots in many poses. The exit code is returned."""
    inputs = Inputs.taken_from(options)
    options["part_seconds"] = inputs.limit["body-seconds"]
    refuse_early(inputs, outputs, baseline)
    targets, shows = targets_of(form, outputs, FORMATS), bool(outputs) or not quiet
    to = Delivery(targets, quiet, exit_zero, options["timings"], top, explain, shows=shows)
    refuse_certificate(to.forms, wanted=options["certificate"])
    pictures = [form for form in to.forms if kind_of(form) == "picture"]
    for picture in pictures:
        function_of(picture)  # a library that it lacks is told before the check
    ctx, config = click.get_current_context(), None
    if ctx.default_map:  # of a config file
        from satcheck.cli.config import stated_config

        config = stated_config(ctx)
    worlds = worlds_of(inputs)
    if len(worlds) > 1:
        from satcheck.cli.worlds import check_options, check_worlds

        refuse_of_worlds(to.forms, inputs, explain=explain, **options)
        terms = check_options(inputs, options, baseline, config)
        return check_worlds(worlds, terms, to, compares=True)
    known = None if baseline is None else read_baseline(baseline)
    document = Document()
    scene = load(inputs, hashed="json" in to.forms)
    if len(inputs.paths) > 2:
        from satcheck.cli.slips import about_assets

        for advice in about_assets(inputs.paths, scene):
            talk(str(advice))
    poses = None
    if inputs.has_poses:
        scene, poses = _placed(scene, inputs)
    result: Report | SamplesReport
    if poses is None:
        asked = settings_of(options, scene)
        result = _check(scene, asked if known is None else measuring(asked))
        if baseline is not None and known is not None:
            names = names_in_baseline(inputs.paths, baseline)
            result = beside_baseline(result, known, str(baseline), names)
        if to.forms != {"table"}:
            result = with_stated_places(result, scene)
    else:
        refuse_of_poses(to.forms, explain=explain, baseline=baseline, **options)
        result = _check_poses(scene, poses, settings_of(options, scene), inputs.random_seed)
    if config is not None:
        result = replace(result, config=config)
    deliver(document, result, scene, to)
    return exit_codes.for_report(result, exit_zero=exit_zero)


def _placed(scene: Scene, inputs: Inputs) -> tuple[Scene, Sequence[Pose] | None]:
    """The scene in the pose of the options, or the poses to check where there are several."""
    # With the readers of robots comes numpy.
    from satcheck.cli.posing import on_path, poses_of
    from satcheck.scene.robot import posed

    if inputs.joint_path is not None:
        return on_path(scene, inputs, inputs.joint_path), None
    poses = poses_of(scene, inputs)
    return (posed(scene, poses), None) if isinstance(poses, Mapping) else (scene, poses)


def _check(scene: Scene, settings: Settings) -> Report:
    try:
        with Bar() as bar:
            return check(scene, settings, progress=bar)
    except SystemExit as stop:  # a library that ends the process must not look like an answer
        raise RuntimeError(f"a library called exit({stop.code!r})") from stop


def _check_poses(
    scene: Scene, poses: Sequence[Pose], settings: Settings, seed: int | None
) -> SamplesReport:
    from satcheck.audit.samples import check_poses  # imports numpy

    with Bar("poses") as bar:
        return replace(check_poses(scene, poses, settings, progress=bar), seed=seed)
