"""The config file of a call: its values become click's `default_map`, and click converts them."""

from __future__ import annotations

import os
from collections.abc import Mapping
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click
from click.core import ParameterSource
from msgspec import Struct

from satcheck.cli.option import LIMITS, default_limits
from satcheck.cli.output import talk
from satcheck.core.errors import SatcheckError

if TYPE_CHECKING:
    from satcheck.report.settings import StatedConfig

# The commands that take options from a config file.
COMMANDS = ("check", "batch", "colliders")
CONFIG, PROJECT = "satcheck.toml", "pyproject.toml"
_FILE = "satcheck.config"
# What a file that was merely found must not do: whoever wrote it may not be the one who calls.
_BY_HAND = frozenset(("output", "exit-zero", "allow-outside"))
# Options that decide what passes.
_DECIDING = (
    *("tolerance", "surface-tolerance", "max-thickness", "max-depth", "clearance", "read"),
    *("max-out", "max-short"),
    *("accuracy", "fail-on", "allow-open", "accept", "rules", "between", "baseline"),
    *("units", "geometry", "planar", "pose", "state", "exclude"),
)
# About one call, not about a check.
_NOT_HERE = frozenset(("help", "help_all", "version", "debug", "config", "no_config"))


class ConfigFile(Struct, frozen=True):
    """path: relative to the current folder if it lies in it or above it. keys: to the table.
    found: nobody has named the file."""

    path: str
    text: str
    keys: tuple[str, ...]
    values: Mapping[str, Any]
    found: bool = False

    def where(self, key: str) -> str:
        """Return `satcheck.toml:3`."""
        from satcheck.scene.scene_file.text import innermost, lines_of

        keys = (*self.keys, key)
        return f"{self.path}:{innermost(lines_of(self.text, [keys], toml=True), keys)}"

    def refused(self, key: str, reason: str) -> SatcheckError:
        """Return an error to be raised."""
        return _bad_config(f"{self.where(key)}: {key}: {reason}")


def take_config(ctx: click.Context, given: str | None) -> None:
    """Make the values of the config file defaults of this call. given: the file; None: the nearest
    one, if there is any. Raises SatcheckError: `bad-config`."""
    file = nearest_config() if given is None else read_config(Path(given))
    if file is None:
        return
    options = configurable(ctx.command)
    _refuse_strangers(file, options.keys())
    ctx.default_map, ctx.meta[_FILE] = {}, file
    for key in file.values.keys() & options.keys():
        option, value = options[key], _as_typed(file, key, options[key])
        try:
            taken = None if value is None else option.process_value(ctx, value)
        except click.BadParameter as error:
            raise file.refused(key, error.message.rstrip(".")) from None
        if file.found:
            _refuse_found(file, key, option, taken)
        if value is not None:
            ctx.default_map[option.name] = value


def _as_typed(file: ConfigFile, key: str, option: click.Option) -> Any:
    """Return what the command line would give, with paths from the folder of the file on; None: the
    default stays."""
    raw = file.values[key]
    if option.is_flag:
        if not isinstance(raw, bool):
            raise file.refused(key, "true or false expected")
        is_inverted = option.flag_value is False  # --no-timings
        return (False if raw else None) if is_inverted else raw
    if option.nargs > 1:
        if isinstance(raw, list) and all(
            isinstance(each, list) and all(isinstance(text, str) for text in each) for each in raw
        ):
            return list(map(tuple, raw))
        raise file.refused(key, 'lists in a list expected, as in [["X", "Y"]]')
    texts = raw if option.multiple and isinstance(raw, list) else [raw]
    if any(isinstance(text, bool | list | dict) for text in texts):
        raise file.refused(key, "a text or a number expected")
    typed = [_from_folder(str(text), option, Path(file.path).parent) for text in texts]
    if option.name == "limit":  # those of other commands are left to them
        others = LIMITS.keys() - set(option.type.names)  # type: ignore[attr-defined]
        each = (part for text in typed for part in text.split(","))
        typed = [part for part in each if part.partition("=")[0].strip() not in others]
    return tuple(typed) if option.multiple else typed[0]


def _from_folder(text: str, option: click.Option, folder: Path) -> str:
    if option.name == "packages":
        name, equals, place = text.partition("=")
        return f"{name}={folder / place}" if equals and place else text
    is_path = isinstance(option.type, click.Path) and text != "-"
    is_path |= option.name == "pose" and not text.lstrip().startswith(("{", "["))
    return str(folder / text) if is_path else text


def _refuse_found(file: ConfigFile, key: str, option: click.Option, value: Any) -> None:
    """Raise `bad-config` for what a file has to be named for."""
    if key in _BY_HAND and value:
        raise file.refused(key, f"give --{key} yourself, or name the file: --config {file.path}")
    limits = default_limits(*value) if key == "limit" else {}
    above = [name for name, most in limits.items() if value[name] > most]
    if above or (key == "budget" and value > option.default):
        raise file.refused(key, f"above the default: name the file, --config {file.path}")


def _refuse_strangers(file: ConfigFile, known: Any) -> None:
    """Refuse keys of no command. Keys of other commands are left to them."""
    if file.values.keys() <= known:
        return
    from satcheck.scene.words import meant

    names = options_of_commands().keys()
    strangers = [key for key in file.values if key not in names]
    errors = [file.refused(key, f"no such option{meant(key, names)}") for key in strangers]
    for error in errors[:1]:
        error.others = tuple(errors[1:])
        raise error


def config_of(ctx: click.Context) -> ConfigFile | None:
    """Return the file that `take_config` has read."""
    file: ConfigFile | None = ctx.meta.get(_FILE)
    return file


def stated_config(ctx: click.Context) -> StatedConfig | None:
    """Return what took effect, for a report; None: nothing. What a file that was merely found
    decides is told on stderr."""
    file = config_of(ctx)
    if file is None:
        return None
    from satcheck.report.settings import StatedConfig

    taken = {
        key: tuple(map(_text, raw)) if isinstance(raw := file.values[key], list) else raw
        for key, option in configurable(ctx.command).items()
        if place_of(ctx, key, option)
    }
    deciding = [key for key in _DECIDING if key in taken]
    if deciding and file.found:
        talk(f"satcheck: {file.path} sets {', '.join(deciding)}")
    return StatedConfig(file.path, taken) if taken else None


def _text(value: Any) -> str:
    return " ".join(map(str, value)) if isinstance(value, list) else str(value)


def place_of(ctx: click.Context, key: str, option: click.Parameter) -> str | None:
    """Return `satcheck.toml:3`; None: the option is not from the config file."""
    file, source = config_of(ctx), ctx.get_parameter_source(option.name or "")
    return file.where(key) if file and source is ParameterSource.DEFAULT_MAP else None


def origin(ctx: click.Context, name: str) -> str | None:
    """Return `satcheck.toml:3: clearance`; None: as above."""
    keys = {option.name: (key, option) for key, option in configurable(ctx.command).items()}
    place = name in keys and place_of(ctx, *keys[name])
    return f"{place}: {keys[name][0]}" if place else None


def configurable(command: click.Command) -> dict[str, click.Option]:
    """Return the options that a file can set, by their keys."""
    options = (each for each in command.params if isinstance(each, click.Option))
    return {
        max(option.opts, key=len).lstrip("-"): option
        for option in options
        if option.name not in _NOT_HERE
    }


def options_of_commands() -> dict[str, click.Option]:
    """Return those of all commands."""
    options: dict[str, click.Option] = {}
    for name in COMMANDS:
        options |= configurable(import_module(f"satcheck.cli.commands.{name}").command)
    return options


def nearest_config() -> ConfigFile | None:
    """Return the nearest satcheck.toml or pyproject.toml with [tool.satcheck], from the current
    folder upward. In one folder satcheck.toml comes first. Raises SatcheckError: `bad-config`."""
    try:
        folder = Path.cwd()
    except OSError:  # the folder is gone, and what it was in is unknown
        return None
    paths = (place / name for place in (folder, *folder.parents) for name in (CONFIG, PROJECT))
    # A link that leads nowhere counts: its options are not passed over, reading it fails.
    there = (path for path in paths if path.is_file() or path.is_symlink())
    files = (read_config(Path(os.path.relpath(path)), found=True) for path in there)
    return next(filter(None, files), None)


def read_config(path: Path, *, found: bool = False) -> ConfigFile | None:
    """Return the file. None: it was found, and has no table for satcheck."""
    from satcheck.scene.opening import read_whole

    keys = ("tool", "satcheck") if path.name == PROJECT else ()
    try:
        data = read_whole(path)
        if found and keys and b"satcheck" not in data:
            return None  # without a parser
        from satcheck.scene.scene_file.text import read_toml

        table: Any = read_toml(path.as_posix(), data.decode())
    except SatcheckError as error:
        raise _bad_config(str(error)) from None
    except UnicodeDecodeError:
        raise _bad_config(f"{path}: not UTF-8") from None
    for key in keys:
        table = table.get(key) if isinstance(table, dict) else None
    if isinstance(table, dict):
        return ConfigFile(path.as_posix(), data.decode(), keys, table, found)
    if found and table is None:
        return None
    raise _bad_config(f"{path}: there is no table [tool.satcheck]")


def _bad_config(message: str) -> SatcheckError:
    """Return an error to be raised."""
    return SatcheckError("bad-config", f"{message} (--no-config ignores config files)")
