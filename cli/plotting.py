"""Plots of commands: the option, a light and a dark style, and their files. They need matplotlib.

A plot is the same on every machine: its letters are measured with the font that comes with
matplotlib, which is a wide one, and its file carries no date.
"""

from __future__ import annotations

import io
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple, TypeVar

import click

from satcheck.cli.output import harmless, write_file

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_Command = TypeVar("_Command", bound=Callable[..., Any])

FORMS = (".svg", ".png", ".pdf")
POINTS_PER_INCH = 72.0
WIDTH = 780.0  # of a page, in points
LETTERS = 98  # that fit on a line
_PIXELS_PER_INCH = 144.0  # of a PNG
_NO_DATE = {".svg": {"Date": None}, ".pdf": {"CreationDate": None}}


class Palette(NamedTuple):
    """Colours of one style; proven, guess and wrong are told apart without red and green
    (after Okabe and Ito, Color Universal Design, 2008)."""

    paper: str
    ink: str
    faint: str
    grid: str
    proven: str
    guess: str
    wrong: str


LIGHT = Palette("#ffffff", "#1f2328", "#59636e", "#dfe3e8", "#0a62c9", "#8f5f00", "#cf222e")
DARK = Palette("#0d1117", "#e6edf3", "#9198a1", "#2a3038", "#58a6ff", "#e3b341", "#ff7b72")


def plot_option(what: str) -> Callable[[_Command], _Command]:
    """what: a sentence without its end, such as `Draw error against time`."""
    return click.option(
        "--plot",
        type=click.Path(dir_okay=False, path_type=Path),
        metavar="FILE",
        help=f"{what}: FILE.svg, FILE.png or FILE.pdf.",
    )


def refuse_plot(plot: Path | None) -> None:
    """Refuse what cannot be drawn, before any work is done."""
    if plot is None:
        return
    if plot.suffix.lower() not in FORMS:
        raise click.UsageError(f"--plot {plot}: drawn as {', '.join(FORMS[:-1])} or {FORMS[-1]}")
    if find_spec("matplotlib") is None:
        raise click.UsageError("--plot needs matplotlib: pip install matplotlib")


def write_plot(figure: Figure, path: Path) -> None:
    write_file(path, file_of(figure, path.suffix.lower()))


def file_of(figure: Figure, form: str) -> bytes:
    """Return the bytes of a file; form: one of FORMS."""
    from matplotlib import rc_context

    content = io.BytesIO()
    with rc_context({"svg.hashsalt": "satcheck", "svg.fonttype": "none"}):
        figure.savefig(content, format=form[1:], dpi=_PIXELS_PER_INCH, metadata=_NO_DATE.get(form))
    return content.getvalue()


@contextmanager
def style(*, dark: bool) -> Iterator[Palette]:
    """Give this style to the figures that are made within."""
    from matplotlib import rc_context

    palette = DARK if dark else LIGHT
    settings: dict[Any, Any] = {
        "figure.dpi": POINTS_PER_INCH,
        "figure.facecolor": palette.paper,
        "axes.facecolor": palette.paper,
        "axes.edgecolor": palette.grid,
        "axes.labelcolor": palette.faint,
        "axes.grid": True,
        "axes.axisbelow": True,
        "axes.titlelocation": "left",
        "axes.titleweight": "bold",
        "axes.titlesize": 11,
        "grid.color": palette.grid,
        "text.color": palette.ink,
        "text.parse_math": False,
        "xtick.color": palette.grid,
        "ytick.color": palette.grid,
        "xtick.labelcolor": palette.faint,
        "ytick.labelcolor": palette.faint,
        "xtick.labelsize": 10,
        "ytick.labelsize": 10,
        "legend.frameon": False,
        "legend.fontsize": 10.5,
        "font.family": "sans-serif",
        "font.size": 10.5,
    }
    with rc_context(settings):
        yield palette


def fitted(words: str, letters: int = LETTERS) -> str:
    """Return them on one line; names of bodies can hold any character."""
    line = harmless(words)
    return line if len(line) <= letters else f"{line[: letters - 1]}\N{HORIZONTAL ELLIPSIS}"
