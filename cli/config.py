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

from satcheck.cli.option import LIMITS, LimitsType
from satcheck.cli.output import talk
from satcheck.core.errors import SatcheckError

if TYPE_CHECKING:
    from satcheck.report.settings import StatedConfig

# The commands that take options from a config file.
COMMANDS = ("check", "batch")
CONFIG, PROJECT = "satcheck.toml", "pyproject.toml"
_META, _FOUND = "satcheck.config", "satcheck.config-was-found"
# What a file that was merely found must not do: whoever wrote it may not be the one who calls.
_BY_HAND = frozenset(("output", "exit-zero", "allow-outside"))
# Options that decide what passes.
_DECIDING = (
    *("tolerance", "surface-tolerance", "max-thickness", "max-depth", "clearance", "read"),
    *("accuracy", "fail-on", "allow-open", "accept", "rules", "between", "baseline", "never"),
    *("units", "geometry", "planar", "pose", "state", "exclude"),
)
# About one call, not about a check.
_NOT_HERE = frozenset(("help", "help_all", "version", "debug", "config", "no_config"))
# What every usual spelling of [tool.satcheck] contains: other files are not parsed.
_MAY_HAVE_TABLE = re.compile(
    rb"""tool["'\s]*\.["'\s]*satcheck|^\s*\[?\s*["']?tool["']?\s*[]=]""", re.MULTILINE
)


class ConfigFile(Struct, frozen=True):
    """path: relative to the current folder if it lies in it or above it. keys: to the table."""

    path: str
    text: str
    keys: tuple[str, ...]
    values: Mapping[str, Any]

    def where(self, key: str) -> str:
        """`satcheck.toml:3`."""
        from satcheck.scene.scene_file.text import innermost, lines_of

        keys = (*self.keys, key)
        return f"{self.path}:{innermost(lines_of(self.text, [keys], toml=True), keys)}"

    def refused(self, key: str, reason: str) -> SatcheckError:
        """To be raised."""
        return _bad_config(f"{self.where(key)}: {key}: {reason}")


def take_config(ctx: click.Context, given: str | None) -> None:
    """Make the values of the config file defaults of this call. given: the file; None: the nearest
    one, if there is any. Raises SatcheckError: `bad-config`."""
    path = _nearest() if given is None else Path(given)
    if path is None:
        return
    file = read_config(path)
    options = configurable(ctx.command)
    _refuse_strangers(file, set(options))
    ctx.default_map, ctx.meta[_META], ctx.meta[_FOUND] = {}, file, given is None
    for key in file.values.keys() & options.keys():
        option, raw = options[key], file.values[key]
        if given is None:
            _refuse_found(file, key, option)
        try:
            value = value_of(option, raw, Path(file.path).parent)
        except ValueError as error:
            raise file.refused(key, str(error)) from None
        if value is not None:
            ctx.default_map[option.name] = value


def _refuse_found(file: ConfigFile, key: str, option: click.Option) -> None:
    """Raise `bad-config` for what a file has to be named for."""
    raw = file.values[key]
    if key in _BY_HAND and raw is not False:
        raise file.refused(key, f"give --{key} yourself, or name the file: --config {file.path}")
    default = option.default if key == "budget" and isinstance(raw, float | int) else None
    if isinstance(option.type, LimitsType):
        for text in _limits(option.type, _listed(raw)):
            for name, value in option.type.convert(text, option, None).items():
                if value > LIMITS[name].default:
                    raw, default = value, LIMITS[name].default
    if default is not None and raw > default:
        message = f"above the default {default:g}: name the file, --config {file.path}"
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
    file, option = config_of(ctx), error.param
    if file is None or not isinstance(option, click.Option) or not is_from_config(ctx, option):
        raise error
    raise file.refused(key_of(option), _number_expected(option) or error.message)


def _number_expected(option: click.Option) -> str | None:
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
    data = _bytes(path)
    tools = _parsed(path, data).get("tool") if _MAY_HAVE_TABLE.search(data) else None
    return isinstance(tools, dict) and "satcheck" in tools


def read_config(path: Path) -> ConfigFile:
    data = _bytes(path)
    table: Any = _parsed(path, data)
    keys = ("tool", "satcheck") if path.name == PROJECT else ()
    for key in keys:
        table = table.get(key) if isinstance(table, dict) else None
    if not isinstance(table, dict):
        raise _bad_config(f"{path}: there is no table [tool.satcheck]")
    return ConfigFile(path.as_posix(), data.decode(), keys, table)


def _bytes(path: Path) -> bytes:
    from satcheck.scene.opening import read_whole

    try:
        return read_whole(str(path), path)
    except SatcheckError as error:
        raise _bad_config(str(error)) from None


def _parsed(path: Path, data: bytes) -> dict[str, Any]:
    import tomllib

    from satcheck.scene.words import why_unreadable

    try:
        return tomllib.loads(data.decode())
    except (ValueError, RecursionError) as error:
        raise _bad_config(f"{path}: not readable TOML: {why_unreadable(error)}") from None


def _bad_config(message: str) -> SatcheckError:
    """To be raised."""
    return SatcheckError("bad-config", f"{message} (--no-config ignores config files)")


def options_of_commands() -> dict[str, click.Option]:
    """All options that a config file can set, by their keys."""
    options: dict[str, click.Option] = {}
    for name in COMMANDS:
        options |= configurable(import_module(f"satcheck.cli.commands.{name}").command)
    return options


def configurable(command: click.Command) -> dict[str, click.Option]:
    """Key -> option."""
    return {
        key_of(option): option
        for option in command.params
        if isinstance(option, click.Option) and option.name not in _NOT_HERE
    }


def key_of(option: click.Option) -> str:
    return max(option.opts, key=len).lstrip("-")


def _refuse_strangers(file: ConfigFile, known: set[str]) -> None:
    """Keys of no command. Keys of the other command are left to it."""
    if file.values.keys() <= known:
        return
    from satcheck.scene.words import meant

    known = set(options_of_commands())
    errors = [
        file.refused(key, f"no such option{meant(key, known)}")
        for key in file.values
        if key not in known
    ]
    for error in errors[:1]:
        error.others = tuple(errors[1:])
        raise error


def value_of(option: click.Option, raw: Any, folder: Path) -> Any:
    """Return what click makes the value of, with paths from `folder` on; None: the default stays.
    Raises ValueError for a value of a wrong kind."""
    if option.is_flag:
        if not isinstance(raw, bool):
            raise ValueError("true or false expected")
        is_inverted = option.flag_value is False  # --no-timings
        return (False if raw else None) if is_inverted else raw
    texts = [_text(option, each, folder) for each in _listed(raw)]
    if isinstance(option.type, LimitsType):
        texts = _limits(option.type, texts)
    if not option.multiple and isinstance(raw, list):
        raise ValueError("a text or a number expected")
    return tuple(texts) if option.multiple else texts[0]


def _listed(raw: Any) -> list[Any]:
    return raw if isinstance(raw, list) else [raw]


def _limits(kind: LimitsType, texts: list[Any]) -> list[str]:
    """Return the limits that this command has. Those of the other command are left to it."""
    each = [part for text in texts for part in str(text).split(",")]
    others = LIMITS.keys() - set(kind.names)
    return [part for part in each if part.partition("=")[0].strip() not in others]


def _text(option: click.Option, raw: Any, folder: Path) -> str:
    if isinstance(raw, bool) or not isinstance(raw, str | int | float):
        raise ValueError("a text or a number expected")
    text = str(raw)
    if option.name == "packages":
        name, equals, place = text.partition("=")
        return f"{name}={folder / place}" if equals and place else text
    is_path = isinstance(option.type, click.Path) and text != "-"
    if is_path or (option.name == "pose" and not text.lstrip().startswith(("{", "["))):
        return str(folder / text)
    return text
