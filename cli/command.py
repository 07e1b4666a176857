"""The group of commands. The first word is a path unless it names one of them.

Nothing here imports geometry: --help, --version and completion answer at once.
"""

from __future__ import annotations

from importlib import import_module

import click

from satcheck.cli.commands import COMMANDS
from satcheck.cli.commands.options import HELP_NAMES, Group

DEFAULT_COMMAND = "check"


def meant(word: str) -> str | None:
    """The command that `word`, which is no path, is a slip of; None if it resembles none."""
    from difflib import get_close_matches

    return next(iter(get_close_matches(word, COMMANDS, n=1)), None)


class _Satcheck(Group):
    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        if not args or args[0] not in COMMANDS:
            args = [DEFAULT_COMMAND, *args]
        return super().parse_args(ctx, args)

    def list_commands(self, ctx: click.Context) -> list[str]:
        del ctx
        return list(COMMANDS)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        del ctx
        if cmd_name not in (DEFAULT_COMMAND, *COMMANDS):
            return None
        command = import_module(f"satcheck.cli.commands.{cmd_name}").command
        assert isinstance(command, click.Command)
        return command


def default_context() -> click.Context:
    """Of the command that needs no name, for what is wrong with a call that click has not read."""
    group = click.Context(satcheck, info_name="satcheck")
    command = satcheck.get_command(group, DEFAULT_COMMAND)
    assert command is not None
    return command.make_context(DEFAULT_COMMAND, [], parent=group, resilient_parsing=True)


@click.group(cls=_Satcheck, context_settings=HELP_NAMES, add_help_option=False)
def satcheck() -> None:
    """Check meshes for collisions."""
