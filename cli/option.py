"""The options that several commands share, each spelled here once. Those named like a field of
`audit.Settings` set that field; their defaults are those of the fields. A length is a number with
or without a unit, and is converted to the units of the scene."""

from __future__ import annotations

from collections import ChainMap
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple, NoReturn, TypeVar

import click
from click.shell_completion import CompletionItem

from satcheck.audit import Settings
from satcheck.audit.batch.options import Limits
from satcheck.audit.settings import METHODS, documentation, length_in_units, settings_in_units
from satcheck.core.conventions import PLANES
from satcheck.scene import Scene
from satcheck.scene.units import Length, parse_length

DEFAULTS = Settings()
STANDARD_OUTPUT = Path("-")
_NO_CONFIG = "satcheck.no-config"
_Command = TypeVar("_Command", bound=Callable[..., Any])


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
        return settings_in_units(options, scene, origin_of)
    except ValueError as error:
        raise click.UsageError(str(error)) from None


def origin_of(name: str) -> str:
    """Return what the user wrote: `--clearance`, or `satcheck.toml:1: clearance`."""
    from satcheck.cli.config import origin

    ctx = click.get_current_context(silent=True)
    return (ctx and origin(ctx, name)) or f"--{name.replace('_', '-')}"


class Told(click.Option):
    """An option whose help is made when it is read: few calls show it, and other packages may have
    registered by then."""

    def __init__(self, names: Sequence[str], *, tell: Callable[[], str], **more: Any) -> None:
        super().__init__(names, **more)
        self._tell = tell

    @property
    def help(self) -> str | None:
        return self._tell()

    @help.setter
    def help(self, _: str | None) -> None:
        """click sets what it was given, which is nothing."""


class _Range:
    """A range of numbers, and what it says of others."""

    min: Any
    max: Any
    min_open: bool
    max_open: bool

    def fail(
        self, message: str, param: click.Parameter | None = None, ctx: click.Context | None = None
    ) -> NoReturn:
        what = "a whole number" if isinstance(self, Whole) else "a number"
        ends = [f"{'above' if self.min_open else 'of at least'} {self.min}"]
        if self.max is not None:
            ends.append(f"{'below' if self.max_open else 'at most'} {self.max}")
        message = f"{what} {' and '.join(ends)} is expected"
        raise click.BadParameter(message, ctx=ctx, param=param)

    def _describe_range(self) -> str:
        """Return nothing for the help: the message states it where it matters."""
        return ""


class Whole(_Range, click.IntRange):
    """A whole number of at least `min`."""


class Number(_Range, click.FloatRange):
    """A number."""


def _complete_paths(ctx: click.Context, _: click.Parameter, start: str) -> list[CompletionItem]:
    """Files, and before the first of them the names of the commands."""
    files = [CompletionItem(start, type="file")]
    group = ctx.parent.command if ctx.parent else None
    if not start or ctx.params.get("paths") or not isinstance(group, click.Group):
        return files
    names = [name for name in group.list_commands(ctx) if name.startswith(start)]
    return files + [CompletionItem(name) for name in names]


def paths(metavar: str) -> Callable[[_Command], _Command]:
    return click.argument("paths", nargs=-1, metavar=metavar, shell_complete=_complete_paths)


reports = click.argument(
    "reports",
    metavar="REPORT ...",
    nargs=-1,
    required=True,
    type=click.Path(dir_okay=False, path_type=Path),
)
pair = click.option(
    "--pair",
    "bodies",
    nargs=2,
    metavar="A B",
    help="The ids of two bodies of a scene. [default: its only two]",
)


def together(*options: Callable[[_Command], _Command]) -> Callable[[_Command], _Command]:
    """Several options, in this order in the help."""

    def add(command: _Command) -> _Command:
        for option in reversed(options):
            command = option(command)
        return command

    return add


def those_of(other: click.Command, *, but: Sequence[str]) -> Callable[[_Command], _Command]:
    """Gives a command the options of another one, but for these."""

    def add(command: _Command) -> _Command:
        options = [p for p in other.params if isinstance(p, click.Option) and p.name not in but]
        known = list(getattr(command, "__click_params__", ()))
        command.__click_params__ = [*known, *reversed(options)]  # type: ignore[attr-defined]
        return command

    return add


class _Limit(NamedTuple):
    """least: megabytes are whole numbers, seconds are more than 0."""

    default: float
    about: str
    least: int = 0


LIMITS = {
    "seconds": _Limit(DEFAULTS.seconds_per_file, "to read a mesh file"),
    "megabytes": _Limit(
        DEFAULTS.megabytes_per_file, "to read one, which may be a quarter as large", least=1
    ),
    "scene-seconds": _Limit(Limits().seconds, "to check an asset"),
    "scene-megabytes": _Limit(Limits().megabytes, "for a process that checks assets", least=256),
    "body-seconds": _Limit(DEFAULTS.part_seconds, "to split a body"),
    "run-seconds": _Limit(60.0, "for the whole run: rungs that do not fit are not run"),
}


def default_limits(*names: str) -> dict[str, float]:
    return {name: LIMITS[name].default for name in names}


class LimitsType(click.ParamType[dict[str, float]]):
    """Limits of these names: `seconds=60,megabytes=2048`."""

    name = "limits"

    def __init__(self, names: Sequence[str]) -> None:
        self.names = names

    def convert(
        self, value: Any, param: click.Parameter | None, ctx: click.Context | None
    ) -> dict[str, float]:
        del param, ctx
        stated: dict[str, float] = {}
        for each in value.split(","):
            name, _, text = map(str.strip, each.partition("="))
            number: Any = text
            if name not in self.names:
                self.fail(f"{each!r} should be NAME=NUMBER; names: {', '.join(self.names)}")
            least = LIMITS[name].least
            kind = Whole(least) if least else Number(0, min_open=True)
            try:
                stated[name] = kind.convert(number, None, None)
            except click.BadParameter as error:
                self.fail(f"{name}: {error.message}")
        return stated


def limits(*more: str) -> Callable[[_Command], _Command]:
    """Return the option of limits: those of reading a mesh file, and more of these names."""
    names = ("seconds", "megabytes", *more)

    def taken(
        _: click.Context, __: click.Parameter, given: tuple[dict[str, float], ...]
    ) -> dict[str, float]:
        return dict(ChainMap(*reversed(given), default_limits(*names)))

    said = "; ".join(f"{name}={LIMITS[name].default:g} {LIMITS[name].about}" for name in names)
    return click.option(
        "--limit",
        multiple=True,
        type=LimitsType(names),
        metavar="NAME=N[,...]",
        callback=taken,
        help=f"The most time, or MiB of memory. Names and defaults: {said}. Repeatable.",
    )


_FILE = click.Path(dir_okay=False, allow_dash=True, path_type=Path)
output = click.option(
    "-o",
    "--output",
    type=_FILE,
    metavar="FILE",
    callback=lambda _, __, path: None if path == STANDARD_OUTPUT else path,
    help="Write the report to FILE; - is standard output.",
)


def outputs(text: str) -> Callable[[_Command], _Command]:
    """Return -o of a command that writes several documents. text: its help."""
    return click.option(
        "-o", "--output", "outputs", multiple=True, type=_FILE, metavar="FILE", help=text
    )


top = click.option(
    "--top",
    type=Whole(min=1),
    metavar="N",
    help="List only the N worst in a table. The summary and the exit code count all.",
)
exit_zero = click.option(
    "--exit-zero", is_flag=True, help="Exit as if no pair failed: with 0, or 3 if pairs are open."
)
root = click.option(
    "--root",
    type=click.Path(file_okay=False, exists=True, path_type=Path),
    default=Path(),
    help="The folder where the check ran: paths in the report start there.  "
    "[default: the current one]",
)


def setting(name: str, *spelled: str, note: str = "", **how: Any) -> Callable[[_Command], _Command]:
    """Return the option that sets a field of `Settings`. Its help is the documentation of the
    field, and its default that of the field. spelled: if it is not named like the field. note: what
    the default is."""
    value = getattr(DEFAULTS, name)
    if value is False:
        how["is_flag"] = True
    elif value is not None and "multiple" not in how:
        how["show_default"] = True

    def tell() -> str:
        return f"{documentation(name)}  [default: {note}]" if note else documentation(name)

    names = spelled or (f"--{name.replace('_', '-')}",)
    return click.option(*names, default=value, cls=Told, tell=tell, **how)


planar = setting("planar", type=click.Choice(PLANES), metavar="PLANE")
tolerance = setting("tolerance", type=length, note="the precision of the files")
method = setting("method", type=click.Choice(METHODS), metavar="METHOD")
open_meshes = setting("allow_open")


def _known(_: click.Context, __: click.Parameter, accepted: tuple[str, ...]) -> tuple[str, ...]:
    if accepted:
        from satcheck.audit.acceptance import acceptance

        for text in accepted:
            acceptance(text)
    return accepted


accept = setting("accept", multiple=True, callback=_known, metavar="CODE[:NAME]")
exclude = click.option(
    "--exclude",
    multiple=True,
    metavar="PATTERN",
    help="Files of folders to leave out, or folders, by name or path. Repeatable.",
)
jobs = setting("jobs", "-j", "--jobs", type=Whole(min=0), metavar="N")


def _set_colour(ctx: click.Context, _: click.Parameter, choice: str) -> None:
    ctx.color = {"always": True, "never": False}.get(choice)


def color(*, hidden: bool = False) -> Callable[[_Command], _Command]:
    """Return the option of colours. cli/output.py reads it from the context of click."""
    return click.option(
        "--color",
        type=click.Choice(("auto", "always", "never")),
        metavar="WHEN",
        default="auto",
        expose_value=False,
        callback=_set_colour,
        hidden=hidden,
        help="Colour in tables: always, never or auto (on a terminal; NO_COLOR and FORCE_COLOR "
        "count).  [default: auto]",
    )


def debug(*, hidden: bool = False) -> Callable[[_Command], _Command]:
    """Return the option of tracebacks. cli/entry.py looks for it: what fails may be the reading of
    options."""
    return click.option(
        "--debug",
        is_flag=True,
        expose_value=False,
        hidden=hidden,
        help="Show a traceback when satcheck fails.",
    )


# Options of every command, which the help of satcheck shows.
common = together(color(hidden=True), debug(hidden=True))


def _take_config(ctx: click.Context, _: click.Parameter, path: str | None) -> None:
    if ctx.resilient_parsing:
        return
    if not ctx.meta.get(_NO_CONFIG):
        from satcheck.cli.config import take_config

        take_config(ctx, path)
    elif path is not None:
        raise click.UsageError("--config and --no-config contradict each other")


def _take_no_config(ctx: click.Context, _: click.Parameter, wanted: bool) -> None:
    if wanted and ctx.default_map is not None:
        raise click.UsageError("--config and --no-config contradict each other")
    ctx.meta[_NO_CONFIG] = wanted


# Eager: the config file gives defaults to the options that are read after it.
config = click.option(
    "--config",
    type=click.Path(dir_okay=False),
    metavar="FILE",
    is_eager=True,
    expose_value=False,
    callback=_take_config,
    help="Take options from FILE.  [default: the nearest satcheck.toml, or [tool.satcheck] of "
    "pyproject.toml]",
)
no_config = click.option(
    "--no-config",
    is_flag=True,
    is_eager=True,
    expose_value=False,
    callback=_take_no_config,
    help="Take no options from a config file.",
)
