"""The group of commands. The first word is a path unless it names one of them.

A command imports what it needs, and is imported when it is called.
"""

from __future__ import annotations

import click

from satcheck.cli.click_classes import HELP_NAMES, Group
from satcheck.cli.commands import all_commands, command_named, is_command

DEFAULT_COMMAND = "check"


class _Satcheck(Group):
    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        if not args or not is_command(args[0]):
            args = [DEFAULT_COMMAND, *args]
        return super().parse_args(ctx, args)

    def list_commands(self, ctx: click.Context) -> list[str]:
        del ctx
        return list(all_commands())

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        del ctx
        if cmd_name == DEFAULT_COMMAND:
            from satcheck.cli.commands.check import command

            return command
        return command_named(cmd_name)


@click.group(cls=_Satcheck, context_settings=HELP_NAMES, add_help_option=False)
def satcheck() -> None:
    """Check meshes for collisions."""
