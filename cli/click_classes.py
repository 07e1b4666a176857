"""The classes of commands: how a command shows its help, and tells a wrong value of a config
file."""

from __future__ import annotations

from typing import Any

import click

from satcheck.cli.output import Document

HELP_NAMES: dict[str, Any] = {"help_option_names": ["-h", "--help"], "max_content_width": 100}


class Command(click.Command):
    """Its help is a document like any other: when it cannot be written, that is said. Many options
    stand under headings. A wrong value of a config file is told with its line."""

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        try:
            return super().parse_args(ctx, args)
        except click.BadParameter as error:
            if not ctx.default_map:
                raise
            from satcheck.cli.config.source import refuse_value

            refuse_value(ctx, error)

    def format_options(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        from satcheck.cli.help_sections import MANY, brief, sections

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
