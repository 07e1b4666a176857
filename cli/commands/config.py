"""`satcheck config`: which options are in effect, and where they come from."""

from __future__ import annotations

from collections.abc import Sequence
from importlib import import_module
from typing import cast

import click
from click.core import ParameterSource

from satcheck.cli.click_classes import HELP_NAMES, Command, Group
from satcheck.cli.config import COMMANDS, config_of, configurable, place_of
from satcheck.cli.formats.summary import toml
from satcheck.cli.output import Document

# Words of a call are those of another command, not options of this one.
_ANY = {**HELP_NAMES, "ignore_unknown_options": True}


@click.group("config", cls=Group, context_settings=HELP_NAMES)
def command() -> None:
    """The config file: show which options are in effect.

    The file is the nearest satcheck.toml, or pyproject.toml with [tool.satcheck], from the current
    folder upward. It sets options of a check, of `satcheck batch` and of `satcheck colliders`.
    `satcheck schema config` prints its JSON Schema.
    """


@command.command("show", cls=Command, context_settings=_ANY)
@click.argument(
    "arguments", metavar="[batch|colliders] [OPTIONS]", nargs=-1, type=click.UNPROCESSED
)
def show(arguments: Sequence[str]) -> None:
    """Print the options in effect, and where each comes from.

    The options are those of `satcheck [OPTIONS]`, or of the named command. An option comes from
    its default, a line of the config file, or the command line.
    """
    name, rest = COMMANDS[0], list(arguments)
    if rest and rest[0] in COMMANDS:
        name, *rest = rest
    called = import_module(f"satcheck.cli.commands.{name}").command
    with cast("click.Command", called).make_context(f"satcheck {name}", rest) as ctx:
        file = config_of(ctx)
        rows = [_row(ctx, key, option) for key, option in configurable(ctx.command).items()]
        width = max(len(value) for value, _ in rows)
        head = f"# {file.path}\n" if file else "# no config file\n"
        lines = (f"{value:{width}}  # {source}\n" for value, source in rows)
        Document().write("".join([head, *lines]))


def _row(ctx: click.Context, key: str, option: click.Option) -> tuple[str, str]:
    """Return `jobs = 2`, and `satcheck.toml:3`."""
    file, place = config_of(ctx), place_of(ctx, key, option)
    if file and place:
        return f"{key} = {toml(file.values[key])}", place
    value = ctx.params.get(option.name or "", option.get_default(ctx))
    if option.flag_value is False:  # --no-timings
        value = not value
    said = "not set" if value is None or value in ((), {}) else toml(value)
    typed = ctx.get_parameter_source(option.name or "") is ParameterSource.COMMANDLINE
    return f"{key} = {said}", "command line" if typed else "default"
