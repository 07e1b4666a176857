"""The shadows of two bodies on their most telling axes, as number lines of one scale.

An axis leads from A to B, and 0 is the middle of the gap or the overlap: overlaps can be compared
by eye, and a gap is a white space.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from satcheck.cli.formats.axes import early_out, gap_words, origin, title
from satcheck.cli.formats.plot_style import POINTS_PER_INCH, Palette, fitted, style

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from satcheck.report.axes import AxesReport, CandidateAxis

# Number lines that a person can read on a page.
MOST_LINES = 24
# Points, 72 to the inch.
WIDTH = 780.0
_AROUND, _ROW = 130.0, 21.0
_BAR = 0.3  # the height of a shadow, in rows
_WINS = {"separating": "separating", "touching": "touching", "mtv": "MTV"}


def draw(result: AxesReport, *, dark: bool = False) -> Figure:
    """result: with the most telling of its axes first."""
    shown = result.axes[:MOST_LINES]
    size = WIDTH / POINTS_PER_INCH, (_AROUND + _ROW * len(shown)) / POINTS_PER_INCH
    with style(dark=dark) as palette:
        figure = Figure(size, layout="constrained")
        axes = figure.subplots()
        axes.set_title(fitted(title(result)))
        _draw_shadows(axes, shown, result, palette)
        _name_rows(axes, shown, result, palette)
        axes.use_sticky_edges = False
        axes.margins(x=0.02)
        axes.set_ylim(len(shown) - 0.5, -0.5)
        axes.grid(visible=False, axis="y")
        axes.axvline(0, color=palette.faint, linewidth=0.8)
        axes.xaxis.set_major_locator(MaxNLocator(7))
        units = f", {result.units}" if result.units else ""
        axes.set_xlabel(
            f"along the axis from A to B, 0 in the middle of the gap or overlap{units}\n"
            + early_out(result)
        )
        figure.legend(loc="outside upper left", ncols=3)
    return figure


def _draw_shadows(
    axes: Axes, shown: tuple[CandidateAxis, ...], result: AxesReport, palette: Palette
) -> None:
    """A row for each axis, the most telling at the top."""
    rows = np.arange(len(shown))
    middle = np.array([0.5 * (axis.shadow_a[1] + axis.shadow_b[0]) for axis in shown])
    for name, body, side, colour in (
        ("A", result.a.id, -1, palette.proven),
        ("B", result.b.id, 1, palette.guess),
    ):
        ends = np.array([axis.shadow_a if name == "A" else axis.shadow_b for axis in shown])
        low, length = ends[:, 0] - middle, ends[:, 1] - ends[:, 0]
        label = f"shadow of {name}, {fitted(body, 24)}"
        places = rows + 0.5 * _BAR * side
        axes.barh(places, length, _BAR, low, color=colour, ec=colour, label=label, zorder=3)
    overlap = np.array([max(-axis.gap, 0.0) for axis in shown])
    axes.barh(rows, overlap, 0.9, -0.5 * overlap, color=palette.wrong, alpha=0.3, label="overlap")


def _name_rows(
    axes: Axes, shown: tuple[CandidateAxis, ...], result: AxesReport, palette: Palette
) -> None:
    """Left the number in the order of testing and what the axis comes from; right its gap, and
    whether it wins."""
    rows, right = range(len(shown)), axes.secondary_yaxis("right")
    axes.set_yticks(rows, [f"{axis.number}  {origin(axis)}" for axis in shown])
    right.set_yticks(rows, [_said(axis, result) for axis in shown])
    best = None if result.winner is None else result.winner.axis
    for side in (axes, right):
        side.tick_params(axis="y", length=0, labelsize=9.5)
        for label, axis in zip(side.get_yticklabels(), shown, strict=True):
            needed = axis.number <= result.early_out.tested or axis.number == best
            label.set_color(palette.ink if needed else palette.faint)
            label.set_fontweight("bold" if axis.number == best else "normal")


def _said(axis: CandidateAxis, result: AxesReport) -> str:
    words, winner = gap_words(axis, result.units), result.winner
    if winner is not None and winner.axis == axis.number:
        return f"{words}  {_WINS[winner.kind]}"
    return words if axis.number <= result.early_out.tested else f"{words}  not needed"
