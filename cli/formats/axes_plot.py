"""The shadows of two bodies on their candidate axes, as number lines of one scale.

An axis leads from A to B, and 0 is the middle of the gap or the overlap: overlaps can be compared
by eye, and a gap is a white space. Where there are more axes than lines, a second panel has the
gaps of all, in the order of testing.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import Patch
from matplotlib.ticker import MaxNLocator

from satcheck.cli.formats.axes import gap_words, origin
from satcheck.cli.formats.numbers import number
from satcheck.cli.formats.plot_style import POINTS_PER_INCH, Palette, fitted, style
from satcheck.cli.formats.words import counted, with_unit

if TYPE_CHECKING:
    from collections.abc import Sequence

    from matplotlib.axes import Axes

    from satcheck.report.axes import AxesReport, CandidateAxis

# Number lines that a person can read on a page.
MOST_LINES = 24
# Points, 72 to the inch.
WIDTH = 780.0
_LEFT, _RIGHT = 216.0, 190.0
_HEAD, _FOOT, _ROW, _GAP, _ALL = 82.0, 40.0, 21.0, 60.0, 150.0
_BAR = 0.3  # the height of a shadow, in rows
_MANY = 2000  # dots that a vector file still shows at once


def draw(result: AxesReport, *, dark: bool = False) -> Figure:
    """result: with all of its axes, the most telling first."""
    shown = result.axes[:MOST_LINES]
    lines = _ROW * len(shown)
    more = _GAP + _ALL if len(result.axes) > len(shown) else 0.0
    height = _HEAD + lines + _FOOT + more
    with style(dark=dark) as palette:
        figure = Figure((WIDTH / POINTS_PER_INCH, height / POINTS_PER_INCH))
        _head(figure, result, palette, height)
        across = (_LEFT / WIDTH, 1 - (_LEFT + _RIGHT) / WIDTH)
        bottom = 1 - (_HEAD + lines) / height
        box = (across[0], bottom, across[1], lines / height)
        _draw_lines(figure.add_axes(box), result, shown, palette)
        if more:
            box = (_LEFT / 2 / WIDTH, _FOOT / height, 1 - _LEFT / WIDTH, _ALL / height)
            _draw_all(figure.add_axes(box), result, palette)
    return figure


def _head(figure: Figure, result: AxesReport, palette: Palette, height: float) -> None:
    figure.text(16 / WIDTH, 1 - 26 / height, fitted(_title(result)), size=13, weight="bold")
    handles = [
        Patch(color=palette.proven, label=f"shadow of A, {fitted(result.a.id, 24)}"),
        Patch(color=palette.guess, label=f"shadow of B, {fitted(result.b.id, 24)}"),
        Patch(color=palette.wrong, alpha=0.3, label="overlap"),
    ]
    corner = (8 / WIDTH, 1 - 32 / height)
    figure.legend(handles=handles, loc="upper left", bbox_to_anchor=corner, ncols=3)
    figure.text(16 / WIDTH, 1 - 68 / height, _summary(result), color=palette.faint, size=10)


def _title(result: AxesReport) -> str:
    hulls = "" if result.of == "bodies" else "hulls of "
    return f"{hulls}{result.a.id} and {result.b.id}: {result.relation}"


def _summary(result: AxesReport) -> str:
    counts, early = result.counts, result.early_out
    axes = counted(counts.distinct, "axis", "axes")
    stop = "no axis has a gap, so a test tries all"
    if early.axis is not None:
        stop = f"a test stops at axis {early.tested:,}, {early.not_needed:,} are not needed"
    return f"{counted(counts.candidates, 'candidate')}, {axes} to test; {stop}."


def _draw_lines(
    axes: Axes, result: AxesReport, shown: Sequence[CandidateAxis], palette: Palette
) -> None:
    """A row for each axis, the most telling at the top."""
    for row, axis in enumerate(shown):
        middle = 0.5 * (axis.shadow_a[1] + axis.shadow_b[0])
        for shadow, side, colour in (
            (axis.shadow_a, -1, palette.proven),
            (axis.shadow_b, 1, palette.guess),
        ):
            low, length = shadow[0] - middle, shadow[1] - shadow[0]
            at = row + 0.5 * _BAR * side
            axes.barh(at, length, height=_BAR, left=low, color=colour, linewidth=0.8, zorder=3)
            axes.plot([low, low + length], [at, at], "|", color=colour, markersize=9, zorder=4)
        if axis.gap < 0:
            axes.barh(
                row, -axis.gap, height=0.9, left=0.5 * axis.gap, color=palette.wrong, alpha=0.3
            )
        _name_row(axes, row, axis, result, palette)
    axes.use_sticky_edges = False
    axes.margins(x=0.02)
    axes.set_ylim(len(shown) - 0.5, -0.5)
    axes.set_yticks([])
    axes.grid(visible=True, axis="x")
    axes.axvline(0, color=palette.faint, linewidth=0.8)
    axes.xaxis.set_major_locator(MaxNLocator(7))
    units = f", {result.units}" if result.units else ""
    axes.set_xlabel(f"along the axis from A to B, 0 in the middle of the gap or overlap{units}")


def _name_row(
    axes: Axes, row: int, axis: CandidateAxis, result: AxesReport, palette: Palette
) -> None:
    """Its number in the order of testing and what it comes from; its gap, and whether it wins."""
    early, winner = result.early_out, result.winner
    needed = axis.number <= early.tested
    wins = winner is not None and winner.axis == axis.number
    look: dict[str, Any] = {"va": "center", "size": 9.5, "weight": "bold" if wins else "normal"}
    colour = palette.ink if needed or wins else palette.faint
    transform = axes.get_yaxis_transform()
    axes.text(
        -0.02,
        row,
        f"{axis.number}  {origin(axis)}",
        transform=transform,
        ha="right",
        color=colour,
        **look,
    )
    words = gap_words(axis, result.units)
    if wins and winner is not None:
        kinds = {"separating": "separating", "touching": "touching", "mtv": "MTV"}
        words += f"  {kinds[winner.kind]}"
    elif not needed:
        words += "  not needed"
    axes.text(1.02, row, words, transform=transform, ha="left", color=colour, **look)


def _draw_all(axes: Axes, result: AxesReport, palette: Palette) -> None:
    """The gaps of all axes, in the order of testing."""
    numbers = np.array([axis.number for axis in result.axes])
    gaps = np.array([axis.gap for axis in result.axes])
    many = len(numbers) > _MANY
    axes.plot(
        numbers, gaps, ".", color=palette.proven, markersize=2 if many else 4, rasterized=many
    )
    axes.axhline(0, color=palette.faint, linewidth=0.8)
    if result.early_out.axis is not None:
        stop = result.early_out.axis
        axes.axvline(stop, color=palette.wrong, linewidth=1.2)
        place: dict[str, Any] = {
            "xytext": (4, 6),
            "textcoords": "offset points",
            "color": palette.wrong,
        }
        axes.annotate("a test stops here", (stop, 0), xycoords=("data", "axes fraction"), **place)
    if result.winner is not None:
        best = gaps[numbers == result.winner.axis]
        axes.plot([result.winner.axis], best, "o", color=palette.wrong, markersize=6)
        words = f"axis {result.winner.axis:,}: {with_unit(number(float(best[0])), result.units)}"
        axes.annotate(
            words, (result.winner.axis, best[0]), xytext=(8, 4), textcoords="offset points"
        )
    axes.set_title(f"All {len(numbers):,} axes in the order of testing: gap above 0, overlap below")
    axes.margins(0.03, 0.15)
    axes.xaxis.set_major_locator(MaxNLocator(7, integer=True))
