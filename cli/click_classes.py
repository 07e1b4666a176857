"""The commands as click has them: how each shows its help and tells a wrong value of a config file,
and the group of them all, whose first word is a path unless it names a command."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Any

import click

from satcheck.cli.commands import all_commands, command_named, is_command
from satcheck.cli.output import Document

HELP_NAMES: dict[str, Any] = {"help_option_names": ["-h", "--help"], "max_content_width": 100}


# Help with fewer options has no headings.
MANY = 15
OTHER = "Other options"
# The range of a number, as click writes it: ` [x>=1]`, `; 0<x<1`.
_RANGE = re.compile(r"\s*\[[^\]\s]*x[<>][^\]]*\]|; [^;\[\]]*x[<>][^\]]*(?=\])")
# The names of the parameters, in the order of the help.
SECTIONS = {
    "What to check": "bodies pairs manifest shard exclude changed_since split merge planar units "
    "allow_open package packages geometry read pose state "
    "joint_path sample seed root allow_outside",
    "What to compute": "depth contacts components volume never cross_check certificate",
    "Tolerances and rules": "clearance tolerance surface_tolerance "
    "rules between baseline fail_on accept exit_zero pins",
    "Output": "output parts_out resume form png glb folder scene_out plot dark top explain timings "
    "quiet color",
    "Accuracy and limits": "accuracy method threshold width budget "
    "max_motion iterations repeat budget seconds seconds_per_file megabytes_per_file "
    "scene_seconds scene_megabytes engine scheduler jobs cache",
}
DEFAULT_COMMAND = "check"


class Command(click.Command):
    """Its help is a document like any other: when it cannot be written, that is said. Many options
    stand under headings. A wrong value of a config file is told with its line."""

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        try:
            return super().parse_args(ctx, args)
        except click.BadParameter as error:
            if not ctx.default_map:
                raise
            from satcheck.cli.config import refuse_value

            refuse_value(ctx, error)

    def format_options(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
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


def brief(record: tuple[str, str]) -> tuple[str, str]:
    """Without the range of a number: a message states it where it matters."""
    option, text = record
    return option, _RANGE.sub("", text)


def sections(options: Sequence[click.Option]) -> dict[str, list[click.Option]]:
    """The options under their headings; what has none comes last."""
    by_name = {option.name: option for option in options}
    made = {
        heading: [by_name.pop(name) for name in names.split() if name in by_name]
        for heading, names in SECTIONS.items()
    }
    made[OTHER] = list(by_name.values())
    return {heading: chosen for heading, chosen in made.items() if chosen}


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
