"""The commands as click has them: how each shows its help, and the group of them all, whose first
word is a path unless it names a command."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import click

from satcheck.cli import exit_codes
from satcheck.cli.commands import DEFAULT_COMMAND, all_commands, command_named, is_command
from satcheck.cli.formats import registry
from satcheck.cli.output import Document
from satcheck.scene.files import readers

HELP_NAMES: dict[str, Any] = {"help_option_names": ["-h", "--help"], "max_content_width": 100}


# Help with fewer options has no headings.
MANY = 19
OTHER = "Options of every command"
_ALL, _BARE = "satcheck.help-all", "satcheck.bare"
# The names of the parameters, in the order of the help.
SECTIONS = {
    "What to check": "bodies pairs manifest shard exclude since split merge planar units "
    "allow_open package packages geometry reading pose state "
    "joint_path sample seed asset root allow_outside",
    "What to compute": "depth contacts components parts volume never cross_check certificate",
    "Tolerances and rules": "max_thickness max_depth clearance tolerance surface_tolerance "
    "rules between baseline fail_on accept exit_zero pins",
    "Output": "outputs output resume form folder plot top explain timings quiet",
    "Accuracy and limits": "accuracy method threshold width budget max_motion iterations limit "
    "engine scheduler jobs",
}


class _Helping(click.Command):
    """Its help is a document like any other: when it cannot be written, that is said."""

    def get_help_option(self, ctx: click.Context) -> click.Option | None:
        option = super().get_help_option(ctx)
        if option is not None:
            option.callback = _show_help
        return option


class Command(_Helping):
    """Many options stand under headings."""

    def __init__(self, *args: Any, daily: str = "", **more: Any) -> None:
        """daily: the names of the options that --help shows; --help-all shows all."""
        super().__init__(*args, **more)
        self.daily = daily.split()
        if daily:
            told = "Show all options, by theme, and exit."
            how: dict[str, Any] = {"is_flag": True, "is_eager": True, "expose_value": False}
            self.params.append(click.Option(["--help-all"], callback=_show_all, help=told, **how))

    def format_options(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        options = [p for p in self.get_params(ctx) if isinstance(p, click.Option) and not p.hidden]
        if self.daily and _ALL not in ctx.meta:
            by_name = {option.name: option for option in options}
            named = (*self.daily, "help_all", "help")
            options = [by_name[name] for name in named if name in by_name]
        groups = sections(options) if len(options) >= MANY else {"Options": options}
        for heading, chosen in groups.items():
            with formatter.section(heading):
                records = (option.get_help_record(ctx) for option in chosen)
                formatter.write_dl([record for record in records if record is not None])


def _show_all(ctx: click.Context, option: click.Parameter, wanted: bool) -> None:
    if wanted:
        ctx.meta[_ALL] = True
        readers.add_others()
        registry.add_others()
    _show_help(ctx, option, wanted)


class Group(_Helping, click.Group):
    """A group of commands."""

    command_class = Command


def _show_help(ctx: click.Context, _: click.Parameter, wanted: bool) -> None:
    if wanted and not ctx.resilient_parsing:
        Document().write(f"{ctx.get_help()}\n")
        # Without a word nothing was checked: that is no success.
        ctx.exit(exit_codes.ERROR if _BARE in ctx.meta else exit_codes.CLEAN)


def sections(options: Sequence[click.Option]) -> dict[str, list[click.Option]]:
    """The options under their headings; what has none comes last."""
    by_name = {option.name: option for option in options}
    made = {
        heading: [by_name.pop(name) for name in names.split() if name in by_name]
        for heading, names in SECTIONS.items()
    }
    made[OTHER] = list(by_name.values())
    return {heading: chosen for heading, chosen in made.items() if chosen}


def _command_first(words: list[str]) -> list[str]:
    """Return the words of a call with the command in front: options may come before its name. A
    first word that names no command is a path."""
    if words[0].startswith("-") and not any(map(is_command, words)):
        return [DEFAULT_COMMAND, *words]
    place = 0
    while place < len(words) and words[place].startswith("-") and words[place] not in ("-", "--"):
        place += 1 + _values_after(words[place])
    if place < len(words) and is_command(words[place]):
        return [words[place], *words[:place], *words[place + 1 :]]
    return [DEFAULT_COMMAND, *words]


def _values_after(word: str) -> int:
    """Return how many of the words behind an option are its value. It may be of any command."""
    if "=" in word or not (word.startswith("--") or len(word) == 2):
        return 0
    if word in HELP_NAMES["help_option_names"]:
        return 0
    for name in (DEFAULT_COMMAND, *all_commands()):
        command = command_named(name)
        for option in command.params if command else ():
            if isinstance(option, click.Option) and word in (*option.opts, *option.secondary_opts):
                return 0 if option.is_flag else option.nargs
    return 0


class _Satcheck(Group):
    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        if not args:
            ctx.meta[_BARE] = True
            args = ["--help"]
        return super().parse_args(ctx, _command_first(args))

    def list_commands(self, ctx: click.Context) -> list[str]:
        del ctx
        return list(all_commands())

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        del ctx
        return command_named(cmd_name)


@click.group(cls=_Satcheck, context_settings=HELP_NAMES, add_help_option=False)
def satcheck() -> None:
    """Check meshes for collisions."""
