"""What all plots share: a light and a dark style, and files of them.

A plot is the same on every machine: its letters are measured with the font that comes with
matplotlib, which is a wide one, and its file carries no date.
"""

from __future__ import annotations

import io
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any, NamedTuple

from matplotlib import rc_context
from matplotlib.figure import Figure

from satcheck.cli.output import harmless

FORMS = (".svg", ".png", ".pdf")
POINTS_PER_INCH = 72.0
_PIXELS_PER_INCH = 144.0  # of a PNG
LETTERS = 98  # that fit on a line
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


@contextmanager
def style(*, dark: bool) -> Iterator[Palette]:
    """Figures that are made within have this style."""
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


def file_of(figure: Figure, form: str) -> bytes:
    """The bytes of a file; form: one of FORMS."""
    content = io.BytesIO()
    with rc_context({"svg.hashsalt": "satcheck", "svg.fonttype": "none"}):
        figure.savefig(content, format=form[1:], dpi=_PIXELS_PER_INCH, metadata=_NO_DATE.get(form))
    return content.getvalue()


def fitted(words: str, letters: int = LETTERS) -> str:
    """On one line; names of bodies can hold any character."""
    line = harmless(words)
    return line if len(line) <= letters else f"{line[: letters - 1]}\N{HORIZONTAL ELLIPSIS}"
