"""The options that several commands share, each spelled here once. Those named like a field of
`audit.Settings` set that field; their defaults are those of the fields."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, TypeVar, get_args

import click
from click.shell_completion import CompletionItem

from satcheck.audit import Settings
from satcheck.audit.request.settings import METHODS
from satcheck.cli.lengths import length, millimetres
from satcheck.core.conventions import PLANES
from satcheck.scene.path_kind import is_folder
from satcheck.scene.read_options import (
    ANGULAR_TOLERANCE,
    CHORD_TOLERANCE,
    GeometryKind,
    Purpose,
)
from satcheck.scene.units import MICROMETRES

SPLITS = ("nodes", "components", "none")
DEFAULTS = Settings()
_STANDARD_OUTPUT = Path("-")
_NO_CONFIG = "satcheck.no-config"
_Command = TypeVar("_Command", bound=Callable[..., Any])


def _file_or_nothing(_: click.Context, __: click.Parameter, path: Path | None) -> Path | None:
    return None if path == _STANDARD_OUTPUT else path


def _complete_paths(ctx: click.Context, _: click.Parameter, start: str) -> list[CompletionItem]:
    """Files, and before the first of them the names of the commands."""
    files = [CompletionItem(start, type="file")]
    group = ctx.parent.command if ctx.parent else None
    if not start or ctx.params.get("paths") or not isinstance(group, click.Group):
        return files
    names = [name for name in group.list_commands(ctx) if name.startswith(start)]
    return files + [CompletionItem(name) for name in names]


def _packages(_: click.Context, __: click.Parameter, texts: tuple[str, ...]) -> dict[str, Path]:
    packages: dict[str, Path] = {}
    for text in texts:
        name, _equals, folder = text.partition("=")
        if not name or not folder:
            raise click.BadParameter(f"{text!r} should be NAME=DIR")
        if not is_folder(folder):
            raise click.BadParameter(f"{folder!r} is no folder")
        packages[name] = Path(folder)
    return packages


def paths_argument(metavar: str) -> Callable[[_Command], _Command]:
    return click.argument("paths", nargs=-1, metavar=metavar, shell_complete=_complete_paths)


def _together(*options: Callable[[_Command], _Command]) -> Callable[[_Command], _Command]:
    """Several options, in this order in the help."""

    def add(command: _Command) -> _Command:
        for option in reversed(options):
            command = option(command)
        return command

    return add


def options_of(other: click.Command, *, but: Sequence[str]) -> Callable[[_Command], _Command]:
    """Gives a command the options of another one, but for these."""

    def add(command: _Command) -> _Command:
        options = [p for p in other.params if isinstance(p, click.Option) and p.name not in but]
        known = list(getattr(command, "__click_params__", ()))
        command.__click_params__ = [*known, *reversed(options)]  # type: ignore[attr-defined]
        return command

    return add


# Of pictures beside a report.
picture_options = _together(
    click.option(
        "--png",
        type=click.Path(dir_okay=False, path_type=Path),
        metavar="FILE",
        help="Also write an image of the worst finding.",
    ),
    click.option(
        "--glb",
        type=click.Path(dir_okay=False, path_type=Path),
        metavar="FILE",
        help="Also write a 3-D model of bodies and overlaps.",
    ),
)


def seconds_option(name: str, default: float, text: str) -> Callable[[_Command], _Command]:
    """A limit of time. text: its help."""
    return click.option(
        name,
        type=click.FloatRange(0, min_open=True),
        metavar="SECONDS",
        default=default,
        show_default=True,
        help=text,
    )


output_option = click.option(
    "-o",
    "--output",
    type=click.Path(dir_okay=False, allow_dash=True, path_type=Path),
    metavar="FILE",
    callback=_file_or_nothing,
    help="Write the report to FILE; - is standard output.",
)
top_option = click.option(
    "--top",
    type=click.IntRange(min=1),
    metavar="N",
    help="List only the N worst in a table. The summary and the exit code count all.",
)
exit_zero_option = click.option(
    "--exit-zero", is_flag=True, help="Exit with 0 even when pairs fail."
)
root_option = click.option(
    "--root",
    type=click.Path(file_okay=False, exists=True, path_type=Path),
    default=Path(),
    help="The folder where the check ran: paths in the report start there.  "
    "[default: the current one]",
)
outside_option = click.option(
    "--allow-outside",
    is_flag=True,
    help="Read what a file names outside of its folder.",
)
# About what reading a file may do.
reading_options = _together(
    outside_option,
    seconds_option(
        "--seconds-per-file",
        DEFAULTS.seconds_per_file,
        "The most time for reading a mesh file.",
    ),
    click.option(
        "--megabytes-per-file",
        type=click.IntRange(1),
        metavar="MIB",
        default=DEFAULTS.megabytes_per_file,
        show_default=True,
        help="The most memory for reading a mesh file; the file may be a quarter as large.",
    ),
    click.option(
        "--chord-tolerance",
        type=millimetres,
        metavar="LENGTH",
        default=f"{CHORD_TOLERANCE:g}mm",
        show_default=True,
        help="How far facets of curved STEP faces may be off: their surface tolerance.",
    ),
    click.option(
        "--angular-tolerance",
        type=click.FloatRange(0, math.pi, min_open=True),
        metavar="RADIANS",
        default=ANGULAR_TOLERANCE,
        show_default=True,
        help="The most angle between such facets.",
    ),
)
split_option = click.option(
    "--split",
    type=click.Choice(SPLITS),
    metavar="HOW",
    help="A body is a node (nodes, the default for one file alone), a connected piece (components) "
    "or a file (none).",
)
planar_option = click.option(
    "--planar",
    type=click.Choice(PLANES),
    metavar="PLANE",
    default=DEFAULTS.planar,
    help="Check outlines in this plane (xy, yz or xz): flat layouts, SVG and DXF drawings.",
)
units_option = click.option(
    "--units",
    type=click.Choice(tuple(MICROMETRES)),
    metavar="UNIT",
    help=f"Of files that state none: {', '.join(MICROMETRES)}.",
)
tolerance_option = click.option(
    "--tolerance",
    type=length,
    default=DEFAULTS.tolerance,
    help="A gap or a depth up to this counts as touching.  [default: the precision of the files]",
)
method_option = click.option(
    "--method",
    type=click.Choice(METHODS),
    metavar="METHOD",
    default=DEFAULTS.method,
    show_default=True,
    help="Compare hulls by the separating axis test (sat), by portals, GJK and EPA (gjk), or by "
    "the faster one (auto).",
)
open_option = click.option(
    "--allow-open",
    is_flag=True,
    default=DEFAULTS.allow_open,
    help="Open meshes are meant to be open: sheets without an inside, not solids with holes.",
)
jobs_option = click.option(
    "-j",
    "--jobs",
    type=click.IntRange(min=0),
    metavar="N",
    default=DEFAULTS.jobs,
    show_default=True,
    help="Threads; 0 is one per core. Changes no answer.",
)
cache_option = click.option(
    "--no-cache",
    "cache",
    is_flag=True,
    flag_value=False,
    default=DEFAULTS.cache,
    help="Neither read nor write the cache of convex parts.",
)


def _set_colour(ctx: click.Context, _: click.Parameter, choice: str) -> None:
    ctx.color = {"always": True, "never": False}.get(choice)


# cli/output.py reads it from the context of click.
color_option = click.option(
    "--color",
    type=click.Choice(("auto", "always", "never")),
    metavar="WHEN",
    default="auto",
    expose_value=False,
    callback=_set_colour,
    help="Colour in tables: always, never or auto (on a terminal; NO_COLOR and FORCE_COLOR "
    "count).  [default: auto]",
)


def _take_config(ctx: click.Context, _: click.Parameter, path: str | None) -> None:
    if ctx.resilient_parsing:
        return
    if not ctx.meta.get(_NO_CONFIG):
        from satcheck.cli.config.source import take_config

        take_config(ctx, path)
    elif path is not None:
        raise click.UsageError("--config and --no-config contradict each other")


def _take_no_config(ctx: click.Context, _: click.Parameter, wanted: bool) -> None:
    if wanted and ctx.default_map is not None:
        raise click.UsageError("--config and --no-config contradict each other")
    ctx.meta[_NO_CONFIG] = wanted


# Eager: the config file gives defaults to the options that are read after it.
config_option = click.option(
    "--config",
    type=click.Path(dir_okay=False),
    metavar="FILE",
    is_eager=True,
    expose_value=False,
    callback=_take_config,
    help="Take options from FILE.  [default: the nearest satcheck.toml, or [tool.satcheck] of "
    "pyproject.toml]",
)
no_config_option = click.option(
    "--no-config",
    is_flag=True,
    is_eager=True,
    expose_value=False,
    callback=_take_no_config,
    help="Take no options from a config file.",
)
debug_option = click.option(
    "--debug",
    is_flag=True,
    expose_value=False,  # cli/entry.py looks for it: what fails may be the reading of options
    help="Show a traceback when satcheck fails.",
)
merge_option = click.option(
    "--merge",
    is_flag=True,
    help="Put several scene files into one world.",
)
rules_option = click.option(
    "--rules",
    multiple=True,
    type=click.Path(dir_okay=False, path_type=Path),
    metavar="FILE",
    help="Rules about all bodies, after those of scenes: what may overlap, and by how much. "
    "Repeatable.",
)
package_option = click.option(
    "--package",
    "packages",
    multiple=True,
    metavar="NAME=DIR",
    callback=_packages,
    help="The folder of a package or model, or of a folder in it (arm/meshes). Repeatable.",
)


def _time(_: click.Context, parameter: click.Parameter, value: float | None) -> float | None:
    if value is not None and not math.isfinite(value):
        raise click.BadParameter("a finite number", param=parameter)
    return value


# That choose between the geometries of a file.
geometry_options = _together(
    click.option(
        "--geometry",
        type=click.Choice(get_args(GeometryKind)),
        metavar="KIND",
        help="collision (default: robots) or visual (default: USD).",
    ),
    click.option(
        "--purpose",
        multiple=True,
        type=click.Choice(get_args(Purpose)),
        metavar="NAME",
        help="Of USD prims to draw: render (the default), proxy or guide. Repeatable.",
    ),
    click.option(
        "--time",
        type=float,
        metavar="TIME",
        callback=_time,
        help="Of animations: seconds in glTF, time code in USD (default: the first).",
    ),
    click.option(
        "--mesh-hulls",
        is_flag=True,
        help="Of MJCF: check hulls of meshes, as MuJoCo does.",
    ),
)
# That pose robots.
pose_options = _together(
    click.option(
        "--pose",
        multiple=True,
        metavar="FILE",
        help='Values of joints in radians and metres, {"joint": value}: a JSON file or the text. '
        "Several poses, or a list of them, are checked one by one.",
    ),
    click.option(
        "--state",
        multiple=True,
        metavar="NAME",
        help="A state of the SRDF; --pose overrides it. Repeatable.",
    ),
    click.option(
        "--sample",
        type=click.IntRange(min=1),
        metavar="N",
        help="Check N random poses; joints in --pose and --state stay.",
    ),
    click.option(
        "--seed",
        type=click.IntRange(min=0),
        metavar="N",
        help="The seed of the random poses.  [default: 0]",
    ),
)


# That pose robots once.
one_pose_options = _together(
    click.option(
        "--pose",
        multiple=True,
        metavar="FILE",
        help="Values of the joints of a robot, as in a check, of one pose.",
    ),
    click.option(
        "--state", multiple=True, metavar="NAME", help="A state that the SRDF names, as in a check."
    ),
)
