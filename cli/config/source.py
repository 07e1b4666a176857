"""The config file of a call: its values become defaults of the options, for click to convert."""

from __future__ import annotations

import os
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, NoReturn

import click
from click.core import ParameterSource

from satcheck.cli.config.search import nearest_config

if TYPE_CHECKING:
    from satcheck.cli.config.file import ConfigFile
    from satcheck.report.settings import StatedConfig

# The commands that take options from a config file.
COMMANDS = ("check", "each", "batch")
_META = "satcheck.config"


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
        try:
            value = value_of(options[key], file.values[key], file.folder)
        except ValueError as error:
            raise file.refused(key, str(error)) from None
        if value is not None:
            defaults[options[key].name] = value
    ctx.default_map = defaults
    ctx.meta[_META] = file


def config_of(ctx: click.Context) -> ConfigFile | None:
    """Return the file that `take_config` has read."""
    file: ConfigFile | None = ctx.meta.get(_META)
    return file


def stated_config(ctx: click.Context) -> StatedConfig | None:
    """Return what took effect, for a report; None: nothing."""
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
