"""The config file of a call: its values become defaults of the options, for click to convert."""

from __future__ import annotations

import os
import re
from collections.abc import Mapping
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any, NoReturn

import click
from click.core import ParameterSource
from msgspec import Struct

from satcheck.cli.output import talk
from satcheck.core.errors import SatcheckError

if TYPE_CHECKING:
    from satcheck.report.settings import StatedConfig

# The commands that take options from a config file.
COMMANDS = ("check", "each", "batch")
_META, _FOUND = "satcheck.config", "satcheck.config-was-found"
# What a file that was merely found must not do: whoever wrote it may not be the one who calls.
_BY_HAND = frozenset(("output", "png", "glb", "exit-zero", "allow-outside"))
_LIMITS = frozenset(
    ("seconds-per-file", "megabytes-per-file", "scene-seconds", "scene-megabytes", "depth-budget")
)
# Options that decide what passes.
_DECIDING = (
    *("tolerance", "surface-tolerance", "clearance", "max-thickness", "max-depth", "read"),
    *("accuracy", "fail-on", "allow-open", "accept", "rules", "between", "baseline", "never"),
    *("units", "geometry", "planar", "pose", "state", "exclude"),
)


# About one call, not about a check.
_NOT_HERE = frozenset(("help", "version", "debug", "config", "no_config"))
# Of a pose that is given as text, not as a file.
_OPENING = ("{", "[")
CONFIG, PROJECT = "satcheck.toml", "pyproject.toml"
MOST_BYTES = 1 << 20
_TABLE = ("tool", "satcheck")
# What every usual spelling of [tool.satcheck] contains: other files are not parsed.
_MAY_HAVE_TABLE = re.compile(
    rb"""tool["'\s]*\.["'\s]*satcheck|^[ \t]*\[\s*["']?tool["']?\s*\]|^[ \t]*["']?tool["']?\s*=""",
    re.MULTILINE,
)


class ConfigFile(Struct, frozen=True):
    """path: relative to the current folder if it lies in it or above it. keys: to the table."""

    path: str
    text: str
    keys: tuple[str, ...]
    values: Mapping[str, Any]

    @property
    def folder(self) -> Path:
        return Path(self.path).parent

    def where(self, key: str) -> str:
        """`satcheck.toml:3`."""
        from satcheck.scene.scene_file.text import innermost, lines_of

        keys = (*self.keys, key)
        return f"{self.path}:{innermost(lines_of(self.text, [keys], toml=True), keys)}"

    def refused(self, key: str, reason: str) -> SatcheckError:
        """To be raised."""
        return bad_config(f"{self.where(key)}: {key}: {reason}")


def take_config(ctx: click.Context, given: str | None) -> None:
    """Makes the values of the config file defaults of this call. given: the file; None: the nearest
    one, if there is any. Raises SatcheckError: `bad-config`."""
    path = _nearest() if given is None else Path(given)
    if path is None:
        return
    file = read_config(path)
    options = configurable(ctx.command)
    _refuse_strangers(file, set(options))
    defaults = {}
    for key in file.values.keys() & options.keys():
        if given is None:
            _refuse_found(file, key, options[key])
        try:
            value = value_of(options[key], file.values[key], file.folder)
        except ValueError as error:
            raise file.refused(key, str(error)) from None
        if value is not None:
            defaults[options[key].name] = value
    ctx.default_map = defaults
    ctx.meta[_META] = file
    ctx.meta[_FOUND] = given is None


def _refuse_found(file: ConfigFile, key: str, option: click.Option) -> None:
    """Raise `bad-config` for what a file has to be named for."""
    raw = file.values[key]
    if key in _BY_HAND and raw is not False:
        raise file.refused(key, f"give --{key} yourself, or name the file: --config {file.path}")
    is_number = isinstance(raw, int | float) and not isinstance(raw, bool)
    if key in _LIMITS and is_number and raw > option.default:
        message = f"above the default {option.default}: name the file, --config {file.path}"
        raise file.refused(key, message)


def config_of(ctx: click.Context) -> ConfigFile | None:
    """Return the file that `take_config` has read."""
    file: ConfigFile | None = ctx.meta.get(_META)
    return file


def stated_config(ctx: click.Context) -> StatedConfig | None:
    """Return what took effect, for a report; None: nothing. What a file that was merely found
    decides is told on stderr."""
    file = config_of(ctx)
    if file is None:
        return None
    from satcheck.report.settings import StatedConfig

    taken = {
        key: tuple(map(str, raw)) if isinstance(raw := file.values[key], list) else raw
        for key, option in configurable(ctx.command).items()
        if key in file.values and is_from_config(ctx, option)
    }
    deciding = [key for key in _DECIDING if key in taken]
    if deciding and ctx.meta[_FOUND]:
        talk(f"satcheck: {file.path} sets {', '.join(deciding)}")
    return StatedConfig(file.path, taken) if taken else None


def is_from_config(ctx: click.Context, option: click.Parameter) -> bool:
    return ctx.get_parameter_source(option.name or "") is ParameterSource.DEFAULT_MAP


def origin(ctx: click.Context, name: str) -> str | None:
    """`satcheck.toml:3: clearance`; None: the value of this option is not from the config file."""
    file = config_of(ctx)
    option = next((param for param in ctx.command.params if param.name == name), None)
    if file is None or not isinstance(option, click.Option) or not is_from_config(ctx, option):
        return None
    return f"{file.where(key_of(option))}: {key_of(option)}"


def refuse_value(ctx: click.Context, error: click.BadParameter) -> NoReturn:
    """Raises `bad-config` for a value that click refuses, if the config file has it."""
    file = config_of(ctx)
    if file is None or not isinstance(error.param, click.Option):
        raise error
    if not is_from_config(ctx, error.param):
        raise error
    raise file.refused(key_of(error.param), number_expected(error.param) or error.message)


def _nearest() -> Path | None:
    """Return the file that counts in the current folder, relative to it."""
    try:
        here = Path.cwd()
    except OSError:  # the folder is gone, and what it was in is unknown
        return None
    path = nearest_config(here)
    return None if path is None else Path(os.path.relpath(path, here))


def nearest_config(folder: Path) -> Path | None:
    """Return the nearest satcheck.toml or pyproject.toml with [tool.satcheck], from this folder
    upward. In one folder satcheck.toml comes first. Raises SatcheckError: `bad-config`."""
    for path in (place / name for place in (folder, *folder.parents) for name in (CONFIG, PROJECT)):
        # A link that leads nowhere counts: its options are not passed over, reading it fails.
        if (path.is_file() or path.is_symlink()) and (path.name == CONFIG or _has_table(path)):
            return path
    return None


def _has_table(path: Path) -> bool:
    data = text_of(path)
    tools = _parsed(path, data).get("tool") if _MAY_HAVE_TABLE.search(data) else None
    return isinstance(tools, dict) and "satcheck" in tools


def options_of_commands() -> dict[str, click.Option]:
    """All options that a config file can set, by their keys."""
    options: dict[str, click.Option] = {}
    for name in COMMANDS:
        options |= configurable(import_module(f"satcheck.cli.commands.{name}").command)
    return options


def _refuse_strangers(file: ConfigFile, known: set[str]) -> None:
    """Keys of no command. Keys of the other command are left to it."""
    if file.values.keys() <= known:
        return
    from satcheck.scene.words import meant

    known = set(options_of_commands())
    strangers = (key for key in file.values if key not in known)
    errors = [file.refused(key, f"no such option{meant(key, known)}") for key in strangers]
    for error in errors[:1]:
        error.others = tuple(errors[1:])
        raise error


def read_config(path: Path) -> ConfigFile:
    """Raises SatcheckError: `bad-config`."""
    data = text_of(path)
    document = _parsed(path, data)
    keys = _TABLE if path.name == PROJECT else ()
    table: Any = document
    for key in keys:
        table = table.get(key) if isinstance(table, dict) else None
    if not isinstance(table, dict):
        raise bad_config(f"{path}: there is no table [tool.satcheck]")
    return ConfigFile(path.as_posix(), data.decode(), keys, table)


def text_of(path: Path) -> bytes:
    """Raises as `read_config`."""
    from satcheck.scene.opening import read_whole

    try:
        return read_whole(str(path), path, MOST_BYTES)
    except SatcheckError as error:
        raise bad_config(str(error)) from None


def bad_config(message: str) -> SatcheckError:
    """To be raised."""
    return SatcheckError("bad-config", f"{message} (--no-config ignores config files)")


def _parsed(path: Path, data: bytes) -> dict[str, Any]:
    from satcheck.scene.scene_file.text import parse_toml
    from satcheck.scene.words import why_unreadable

    try:
        return parse_toml(data.decode())
    except (ValueError, RecursionError) as error:
        raise bad_config(f"{path}: not readable TOML: {why_unreadable(error)}") from None


def configurable(command: click.Command) -> dict[str, click.Option]:
    """Key -> option."""
    return {
        key_of(option): option
        for option in command.params
        if isinstance(option, click.Option) and option.name not in _NOT_HERE
    }


def key_of(option: click.Option) -> str:
    return max(option.opts, key=len).lstrip("-")


def is_inverted(option: click.Option) -> bool:
    """A flag that turns something off: --no-cache."""
    return option.flag_value is False


def value_of(option: click.Option, raw: Any, folder: Path) -> Any:
    """What click makes the value of, with paths from `folder` on; None: the default stays. Raises
    ValueError for a value of a wrong kind."""
    if option.is_flag:
        if not isinstance(raw, bool):
            raise ValueError("true or false expected")
        if is_inverted(option):
            return False if raw else None
        return raw
    if option.multiple:
        items = raw if isinstance(raw, list) else [raw]
        return tuple(_text(option, item, folder) for item in items)
    return _text(option, raw, folder)


def number_expected(option: click.Option) -> str | None:
    """`must be a whole number, at least 0`; None: not of a number in a range."""
    kind = option.type
    if not isinstance(kind, click.IntRange | click.FloatRange):
        return None
    words = ["must be a whole number" if isinstance(kind, click.IntRange) else "must be a number"]
    if kind.min is not None:
        words.append(f"{'more than' if kind.min_open else 'at least'} {kind.min}")
    if kind.max is not None:
        words.append(f"{'less than' if kind.max_open else 'at most'} {kind.max}")
    return ", ".join(words)


def _text(option: click.Option, raw: Any, folder: Path) -> str:
    if isinstance(raw, bool) or not isinstance(raw, str | int | float):
        raise ValueError("a text or a number expected")
    text = str(raw)
    if option.name == "packages":
        name, equals, place = text.partition("=")
        return f"{name}={folder / place}" if equals and place else text
    is_path = isinstance(option.type, click.Path) and text != "-"
    if is_path or (option.name == "pose" and not text.lstrip().startswith(_OPENING)):
        return str(folder / text)
    return text
