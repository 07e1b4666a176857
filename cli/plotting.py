"""The options of commands that draw a plot, what is refused early about it, and its file."""

from __future__ import annotations

from collections.abc import Callable
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import click

from satcheck.cli.inputs import Inputs, refuse_early
from satcheck.cli.output import write_file

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_Command = TypeVar("_Command", bound=Callable[..., Any])

PLOTS = (".svg", ".png", ".pdf")


def plot_option(what: str) -> Callable[[_Command], _Command]:
    """what: a sentence without its end, such as `Draw error against time`."""
    return click.option(
        "--plot",
        type=click.Path(dir_okay=False, path_type=Path),
        metavar="FILE",
        help=f"{what}: FILE.svg, FILE.png or FILE.pdf.",
    )


def refuse_plot(inputs: Inputs, plot: Path | None, output: Path | None) -> None:
    """What cannot be drawn is said before any work is done."""
    if plot is None:
        return
    if plot.suffix.lower() not in PLOTS:
        raise click.UsageError(f"--plot {plot}: drawn as {', '.join(PLOTS[:-1])} or {PLOTS[-1]}")
    if find_spec("matplotlib") is None:
        raise click.UsageError("--plot needs matplotlib: pip install matplotlib")
    refuse_early(inputs, plot, option="--plot")
    if output is not None and plot.absolute() == output.absolute():
        raise click.UsageError("--plot and -o name the same file")


def write_plot(figure: Figure, path: Path) -> None:
    from satcheck.cli.formats.plot_style import file_of

    write_file(path, file_of(figure, path.suffix.lower()))
