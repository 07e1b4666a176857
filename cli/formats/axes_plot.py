"""The shadows of two bodies on their most telling axes, as number lines of one scale.

An axis leads from A to B, and 0 is the middle of the gap or the overlap: overlaps can be compared
by eye, and a gap is a white space.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from satcheck.cli.formats.axes import early_out, gap_words, origin, title
from satcheck.cli.plotting import POINTS_PER_INCH, WIDTH, fitted, style

if TYPE_CHECKING:
    from satcheck.report.axes import AxesReport, CandidateAxis

# Number lines that a person can read on a page.
MOST_LINES = 24
_AROUND, _ROW = 130.0, 21.0  # points
_BAR = 0.3  # the height of a shadow, in rows
_WINS = {"separating": "separating", "touching": "touching", "mtv": "MTV"}


def draw(result: AxesReport, *, dark: bool = False) -> Figure:
    """Return a row for each axis, the most telling at the top: left its number in the order of
    testing and what it comes from, right its gap, and whether it wins.

    result: with the most telling of its axes first."""
    shown = result.axes[:MOST_LINES]
    rows = range(len(shown))
    middle = [0.5 * (axis.shadow_a[1] + axis.shadow_b[0]) for axis in shown]
    overlap = [max(-axis.gap, 0.0) for axis in shown]
    size = WIDTH / POINTS_PER_INCH, (_AROUND + _ROW * len(shown)) / POINTS_PER_INCH
    with style(dark=dark) as palette:
        figure = Figure(size, layout="constrained")
        axes = figure.subplots()
        axes.set_title(fitted(title(result)))
        for name, body, ends, side, colour in (
            ("A", result.a.id, [axis.shadow_a for axis in shown], -0.5 * _BAR, palette.proven),
            ("B", result.b.id, [axis.shadow_b for axis in shown], 0.5 * _BAR, palette.guess),
        ):
            axes.barh(
                [row + side for row in rows],
                [high - low for low, high in ends],
                _BAR,
                [low - at for (low, _), at in zip(ends, middle, strict=True)],
                color=colour,
                ec=colour,
                label=f"shadow of {name}, {fitted(body, 24)}",
                zorder=3,
            )
        left = [-0.5 * width for width in overlap]
        axes.barh(rows, overlap, 0.9, left, color=palette.wrong, alpha=0.3, label="overlap")
        right = axes.secondary_yaxis("right")
        axes.set_yticks(rows, [f"{axis.number}  {origin(axis)}" for axis in shown])
        right.set_yticks(rows, [_said(axis, result) for axis in shown])
        best = None if result.winner is None else result.winner.axis
        for labels in (axes, right):
            labels.tick_params(axis="y", length=0, labelsize=9.5)
            for label, axis in zip(labels.get_yticklabels(), shown, strict=True):
                needed = axis.number <= result.early_out.tested or axis.number == best
                label.set_color(palette.ink if needed else palette.faint)
                label.set_fontweight("bold" if axis.number == best else "normal")
        axes.use_sticky_edges = False
        axes.margins(x=0.02)
        axes.set_ylim(len(shown) - 0.5, -0.5)
        axes.grid(visible=False, axis="y")
        axes.axvline(0, color=palette.faint, linewidth=0.8)
        axes.xaxis.set_major_locator(MaxNLocator(7))
        units = f", {result.units}" if result.units else ""
        where = f"along the axis from A to B, 0 in the middle of the gap or overlap{units}"
        axes.set_xlabel(f"{where}\n{early_out(result)}")
        figure.legend(loc="outside upper left", ncols=3)
    return figure


def _said(axis: CandidateAxis, result: AxesReport) -> str:
    words, winner = gap_words(axis, result.units), result.winner
    if winner is not None and winner.axis == axis.number:
        return f"{words}  {_WINS[winner.kind]}"
    return words if axis.number <= result.early_out.tested else f"{words}  not needed"
