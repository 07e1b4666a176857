"""What all plots share: a light and a dark style, labels that keep clear, and files of them.

A plot is the same on every machine: its letters are measured with the font that comes with
matplotlib, which is a wide one, and its file carries no date.
"""

from __future__ import annotations

import io
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import Any, NamedTuple

import numpy as np
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.text import Annotation
from matplotlib.transforms import Bbox

FORMS = (".svg", ".png", ".pdf")
POINTS_PER_INCH = 72.0
_PIXELS_PER_INCH = 144.0  # of a PNG
_CLEARANCE = 7.0  # points around a marker
_PIECES = 12  # of a line that labels keep clear of
_NO_DATE = {".svg": {"Date": None}, ".pdf": {"CreationDate": None}}

# x and y, in the units of the axes.
Point = tuple[float, float]


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


class Labels:
    """Puts labels beside the markers of one panel, clear of the markers and of each other.

    Scales and limits of the axes have to be final.
    """

    # Offset in points, horizontal and vertical alignment: above, below, right, left, then further.
    _PLACES = tuple(
        (dx, dy, across, up)
        for away in (0.0, 13.0, 26.0)
        for dx, dy, across, up in (
            (0.0, 7.0 + away, "center", "bottom"),
            (0.0, -7.0 - away, "center", "top"),
            (9.0, away, "left", "center"),
            (-9.0, away, "right", "center"),
        )
    )

    def __init__(self, axes: Axes, markers: Sequence[Point]) -> None:
        """markers: in the units of the axes; labels keep clear of all of them."""
        self._axes = axes
        self._taken: list[Bbox] = []
        for marker in markers:
            at = axes.transData.transform(marker)
            self._taken.append(Bbox([at - _CLEARANCE, at + _CLEARANCE]))

    def keep_clear_of_line(self, start: Point, end: Point) -> None:
        ends = self._axes.transData.transform([start, end])
        for k in range(_PIECES):
            piece = [ends[0] + (ends[1] - ends[0]) * share / _PIECES for share in (k, k + 1)]
            low, high = np.minimum(*piece), np.maximum(*piece)
            self._taken.append(Bbox([low - 1.0, high + 1.0]))

    def place(self, words: str, markers: Sequence[Point]) -> None:
        """One label for markers of one height, where it covers least."""
        left, right = min(markers), max(markers)
        label = self._axes.annotate(words, left, xytext=(0, 0), textcoords="offset points")
        label.set_zorder(5)
        places = [
            (left if dx < 0 else right if dx > 0 else self._between(left, right), *place)
            for place in self._PLACES
            for dx in (place[0],)
        ]
        best = min(places, key=lambda place: self._cost(label, *place))
        self._cost(label, *best)
        self._taken.append(label.get_window_extent())

    def _between(self, left: Point, right: Point) -> Point:
        middle = self._axes.transData.transform([left, right]).mean(axis=0)
        x, _ = self._axes.transData.inverted().transform(middle)
        return float(x), left[1]

    def _cost(
        self, label: Annotation, at: Point, dx: float, dy: float, across: str, up: str
    ) -> float:
        """Move the label there; the area it then covers of what is taken, or lies outside."""
        label.xy = at
        label.set(position=(dx, dy), ha=across, va=up)
        box, frame = label.get_window_extent(), self._axes.bbox
        if across == "center":  # as far within the frame as it can be
            inwards = max(frame.x0 - box.x0, 0.0) + min(frame.x1 - box.x1, 0.0)
            label.set(position=(dx + inwards, dy))
            box = box.translated(inwards, 0.0)
        inside = Bbox.intersection(box, frame)
        outside = _area(box) - (0.0 if inside is None else _area(inside))
        covered = (Bbox.intersection(box, other) for other in self._taken)
        return outside + sum(_area(overlap) for overlap in covered if overlap is not None)


def _area(box: Bbox) -> float:
    return float(box.width * box.height)
