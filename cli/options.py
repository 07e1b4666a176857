"""The options that several commands share, each spelled here once. Those named like a field of
`audit.Settings` set that field; their defaults are those of the fields."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any, TypeVar, get_args

import click
from click.core import ParameterSource
from click.shell_completion import CompletionItem

from satcheck.audit import Settings
from satcheck.audit.request.in_units import length_in_units, settings_in_units
from satcheck.audit.request.settings import METHODS
from satcheck.cli.output import Document
from satcheck.cli.report.ci import FORMATS as CI_FORMATS
from satcheck.cli.report.picture import FORMATS as PICTURE_FORMATS
from satcheck.core.conventions import PLANES
from satcheck.scene import Scene
from satcheck.scene.input_kind import GeometryKind
from satcheck.scene.loading.source import FORMATS as MESHES
from satcheck.scene.path_kind import is_folder
from satcheck.scene.units import MICROMETRES, Length, parse_length

FORMATS = ("table", "json")
# Formats of one report or of many.
REPORT_FORMATS = (*FORMATS, *CI_FORMATS)
PICTURES = tuple(PICTURE_FORMATS)
SPLITS = ("nodes", "components", "none")
HELP_NAMES: dict[str, Any] = {"help_option_names": ["-h", "--help"], "max_content_width": 100}
DEFAULTS = Settings()
_ENDINGS = {
    ending: form for form, endings in (CI_FORMATS | PICTURE_FORMATS).items() for ending in endings
} | {".parquet": "parquet"}
# Documents of other kinds, by the end of their names.
_NO_REPORTS = frozenset({".svg", ".pdf", ".toml", ".yaml", *MESHES}) - frozenset(_ENDINGS)
_STANDARD_OUTPUT = Path("-")
_NO_CONFIG = "satcheck.no-config"
_Command = TypeVar("_Command", bound=Callable[..., Any])


class Command(click.Command):
    """Its help is a document like any other: when it cannot be written, that is said. Many options
    stand under headings. A wrong value of a config file is told with its line."""

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        try:
            return super().parse_args(ctx, args)
        except click.BadParameter as error:
            if not ctx.default_map:
                raise
            from satcheck.cli.config.source import refuse_value

            refuse_value(ctx, error)

    def format_options(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        from satcheck.cli.help_sections import MANY, brief, sections

        options = [p for p in self.get_params(ctx) if isinstance(p, click.Option) and not p.hidden]
        groups = sections(options) if len(options) >= MANY else {"Options": options}
        for heading, chosen in groups.items():
            with formatter.section(heading):
                records = (option.get_help_record(ctx) for option in chosen)
                formatter.write_dl([brief(record) for record in records if record is not None])

    def get_help_option(self, ctx: click.Context) -> click.Option | None:
        return _written(super().get_help_option(ctx))


class Group(click.Group):
    """The same of a group of commands, and of those in it."""

    command_class = Command

    def get_help_option(self, ctx: click.Context) -> click.Option | None:
        return _written(super().get_help_option(ctx))


def _written(option: click.Option | None) -> click.Option | None:
    if option is not None:
        option.callback = _show_help
    return option


def _show_help(ctx: click.Context, _: click.Parameter, wanted: bool) -> None:
    if wanted and not ctx.resilient_parsing:
        Document().write(f"{ctx.get_help()}\n")
        ctx.exit()


def form_of(form: str | None, output: Path | None, forms: Sequence[str] = FORMATS) -> str:
    """The format, one of `forms`: as given, else as the name of the output file says.

    Raises click.UsageError for a name that promises another kind of document.
    """
    if output is not None and _is_overridden("form", "output"):
        form = None
    if form is not None and form not in forms:
        raise click.UsageError(f"--format {form}: this command writes {', '.join(forms)}")
    if form is not None or output is None:
        return form or "table"
    ending = output.suffix.lower()
    named = "json" if ending == ".json" else _ENDINGS.get(ending, "table")
    if ending in _NO_REPORTS or named not in forms:
        raise click.UsageError(
            f"{output}: this command writes {', '.join(forms)}: give one of them with --format, "
            "or name the file .json"
        )
    return named


def _is_overridden(name: str, typed: str) -> bool:
    """Whether an option comes from a config file, and another one that decides it was typed."""
    ctx = click.get_current_context(silent=True)
    return (
        ctx is not None
        and ctx.get_parameter_source(name) is ParameterSource.DEFAULT_MAP
        and ctx.get_parameter_source(typed) is ParameterSource.COMMANDLINE
    )


def length(text: str) -> Length:
    """A click parameter type; click.BadParameter for what is not a length."""
    try:
        return parse_length(text)
    except ValueError as error:
        raise click.BadParameter(str(error)) from None


def in_units_of(value: Length, declared: str | None, option: str) -> float:
    """The length in the declared units of the scene; click.UsageError if they are unknown."""
    try:
        return length_in_units(value, declared, option)
    except ValueError as error:
        raise click.UsageError(str(error)) from None


def settings_of(options: Mapping[str, Any], scene: Scene) -> Settings:
    """options: values of fields of Settings; a Length is converted to the units of the scene."""
    try:
        return settings_in_units(options, scene, names_of_lengths(options))
    except ValueError as error:
        raise click.UsageError(str(error)) from None


def names_of_lengths(options: Mapping[str, Any]) -> dict[str, str]:
    """What the user wrote for each length: `--clearance`, or `satcheck.toml:1: clearance`."""
    return {name: _origin(name) for name, value in options.items() if isinstance(value, Length)}


def _origin(name: str) -> str:
    from satcheck.cli.config.source import origin

    ctx = click.get_current_context(silent=True)
    return (ctx and origin(ctx, name)) or f"--{name.replace('_', '-')}"


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


def options_of(other: click.Command, *, but: Sequence[str]) -> Callable[[_Command], _Command]:
    """Gives a command the options of another one, but for these."""

    def add(command: _Command) -> _Command:
        options = [p for p in other.params if isinstance(p, click.Option) and p.name not in but]
        known = list(getattr(command, "__click_params__", ()))
        command.__click_params__ = [*known, *reversed(options)]  # type: ignore[attr-defined]
        return command

    return add


form_option = click.option(
    "--format",
    "form",
    type=click.Choice(FORMATS),
    metavar="FORMAT",
    help="table or json.  [default: json if the file of -o ends in .json, otherwise table]",
)
reports_form_option = click.option(
    "--format",
    "form",
    type=click.Choice(REPORT_FORMATS),
    metavar="FORMAT",
    help=f"{', '.join(REPORT_FORMATS)}.  [default: as the file of -o ends, otherwise table]",
)
report_form_option = click.option(
    "--format",
    "form",
    type=click.Choice((*REPORT_FORMATS, *PICTURES)),
    metavar="FORMAT",
    help=f"{', '.join((*REPORT_FORMATS, *PICTURES))}; html is a 3-D view, png an image of the "
    "worst finding, glb a 3-D model.  [default: as the file of -o ends, otherwise table]",
)
_PICTURE_OPTIONS = (
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
        help="Also write a 3-D model of bodies, overlaps and ways out, for any viewer.",
    ),
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
    help="Read files outside of the folder of the scene, robot or glTF file that names them.",
)
_READING_OPTIONS = (
    outside_option,
    click.option(
        "--seconds-per-file",
        type=click.FloatRange(0, min_open=True),
        metavar="SECONDS",
        default=DEFAULTS.seconds_per_file,
        show_default=True,
        help="The most time for reading a mesh file.",
    ),
    click.option(
        "--megabytes-per-file",
        type=click.IntRange(1),
        metavar="MIB",
        default=DEFAULTS.megabytes_per_file,
        show_default=True,
        help="The most memory for reading a mesh file; the file may be a quarter as large.",
    ),
)
split_option = click.option(
    "--split",
    type=click.Choice(SPLITS),
    metavar="HOW",
    help="A body is a node of a file (nodes), a connected piece (components) or a whole file "
    "(none).  [default: nodes for one file alone, otherwise none]",
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
    help=f"The unit of files that state none, such as OBJ and STL: {', '.join(MICROMETRES)}.",
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
    help="Put several scene files into one world, instead of checking each by itself.",
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
geometry_option = click.option(
    "--geometry",
    type=click.Choice(get_args(GeometryKind)),
    metavar="KIND",
    help="Of robots: collision (the default) or visual.",
)
_POSE_OPTIONS = (
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
        help="A state of the SRDF. Several are combined; --pose overrides them.",
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


def picture_options(command: _Command) -> _Command:
    """Adds the options of pictures beside a report."""
    for option in reversed(_PICTURE_OPTIONS):
        command = option(command)
    return command


_ONE_POSE_OPTIONS = (
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


def reading_options(command: _Command) -> _Command:
    """Adds the options about what reading a file may do."""
    for option in reversed(_READING_OPTIONS):
        command = option(command)
    return command


def one_pose_options(command: _Command) -> _Command:
    """Adds the options that pose robots once."""
    for option in reversed(_ONE_POSE_OPTIONS):
        command = option(command)
    return command


def pose_options(command: _Command) -> _Command:
    """Adds the options that pose robots, in their order."""
    for option in reversed(_POSE_OPTIONS):
        command = option(command)
    return command
