"""The config file of a call: its values become defaults of the options, for click to convert."""

from __future__ import annotations

import os
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, NoReturn

import click
from click.core import ParameterSource

from satcheck.cli.config.search import nearest_config
from satcheck.cli.output import talk

if TYPE_CHECKING:
    from satcheck.cli.config.file import ConfigFile
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
    *("tolerance", "surface-tolerance", "chord-tolerance", "angular-tolerance", "clearance"),
    *("accuracy", "fail-on", "allow-open", "accept", "rules", "between", "baseline", "never"),
    *("units", "geometry", "planar", "pose", "state", "exclude"),
)


def take_config(ctx: click.Context, given: str | None) -> None:
    """Makes the values of the config file defaults of this call. given: the file; None: the nearest
    one, if there is any. Raises SatcheckError: `bad-config`."""
    path = _nearest() if given is None else Path(given)
    if path is None:
        return
    from satcheck.cli.config.file import read_config
    from satcheck.cli.config.values import configurable, value_of

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
    from satcheck.cli.config.values import configurable
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
    from satcheck.cli.config.values import key_of

    file = config_of(ctx)
    option = next((param for param in ctx.command.params if param.name == name), None)
    if file is None or not isinstance(option, click.Option) or not is_from_config(ctx, option):
        return None
    return f"{file.where(key_of(option))}: {key_of(option)}"


def refuse_value(ctx: click.Context, error: click.BadParameter) -> NoReturn:
    """Raises `bad-config` for a value that click refuses, if the config file has it."""
    from satcheck.cli.config.values import key_of, number_expected

    file = config_of(ctx)
    if file is None or not isinstance(error.param, click.Option):
        raise error
    if not is_from_config(ctx, error.param):
        raise error
    raise file.refused(key_of(error.param), number_expected(error.param) or error.message)


def _nearest() -> Path | None:
    """Relative to the current folder."""
    try:
        folder = Path.cwd()
    except OSError:  # the folder is gone, and what it was in is unknown
        return None
    path = nearest_config(folder)
    return None if path is None else Path(os.path.relpath(path, folder))


def options_of_commands() -> dict[str, click.Option]:
    """All options that a config file can set, by their keys."""
    from satcheck.cli.config.values import configurable

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
