"""Options that several commands share, and how they are read."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import click

from satcheck.cli.choices import PLANES, UNITS
from satcheck.cli.plain import FORMATS

if TYPE_CHECKING:
    from click.shell_completion import CompletionItem

_Command = TypeVar("_Command", bound=Callable[..., Any])

SPLITS = ("nodes", "components", "none")
HELP_NAMES: dict[str, Any] = {"help_option_names": ["-h", "--help"]}


class Command(click.Command):
    """Its help is a document like any other: when it cannot be written, that is said."""

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
    from satcheck.cli.output import Document

    if wanted and not ctx.resilient_parsing:
        Document().write(f"{ctx.get_help()}\n")
        ctx.exit()


_STANDARD_OUTPUT = Path("-")


def _file_or_nothing(_: click.Context, __: click.Parameter, given: Path | None) -> Path | None:
    return None if given == _STANDARD_OUTPUT else given


def _complete_paths(ctx: click.Context, _: click.Parameter, start: str) -> list[CompletionItem]:
    """Files, and before the first of them the names of the commands."""
    from click.shell_completion import CompletionItem

    files = [CompletionItem(start, type="file")]
    group = ctx.parent.command if ctx.parent else None
    if not start or ctx.params.get("paths") or not isinstance(group, click.Group):
        return files
    names = [name for name in group.list_commands(ctx) if name.startswith(start)]
    return files + [CompletionItem(name) for name in names]


def paths_argument(metavar: str) -> Callable[[_Command], _Command]:
    return click.argument("paths", nargs=-1, metavar=metavar, shell_complete=_complete_paths)


form_option = click.option(
    "--format",
    "form",
    type=click.Choice(FORMATS),
    help="How to report. [default: table; json where the name after -o ends in .json]",
)
output_option = click.option(
    "-o",
    "--output",
    type=click.Path(dir_okay=False, allow_dash=True, path_type=Path),
    metavar="FILE",
    callback=_file_or_nothing,
    help="Write the result to FILE; - is standard output.",
)
outside_option = click.option(
    "--allow-outside",
    is_flag=True,
    help="Read files that lie outside of the folder of the scene, robot or glTF file that names "
    "them.",
)
split_option = click.option(
    "--split",
    type=click.Choice(SPLITS),
    help="What a body is: a node of a GLB, glTF, 3MF or 3DXML file, a connected component, or a "
    "whole file. [default: nodes for one file alone, otherwise none]",
)
planar_option = click.option(
    "--planar",
    type=click.Choice(PLANES),
    help="Check the outlines of bodies in this plane: flat layouts, SVG and DXF drawings too.",
)
units_option = click.option(
    "--units",
    type=click.Choice(UNITS),
    help="The unit of length of the inputs that state none: OBJ, STL, PLY, OFF, XAML, a scene "
    "without `units`.",
)
open_option = click.option(
    "--allow-open",
    is_flag=True,
    help="Meshes that are not closed are meant to be open: their open parts are sheets, which have "
    "no inside, and not solids with holes.",
)
jobs_option = click.option(
    "-j",
    "--jobs",
    type=click.IntRange(min=0),
    metavar="N",
    default=0,
    show_default=True,
    help="Threads; 0 is one per core. Changes no answer.",
)
debug_option = click.option("--debug", is_flag=True, help="Show a traceback when satcheck fails.")
