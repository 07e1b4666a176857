"""Every pair as a dot: time and error of each rung, with quartiles; one row a rung."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from bench.accuracy.palette import Colours, kind_of, series
from bench.accuracy.rungs import RungSummary, relative_error, rows_of, seconds, worked
from bench.accuracy.spread import Spread, spread
from bench.accuracy.verdicts import outcome
from bench.drawing import name_decades, percent
from satcheck.audit.words import duration
from satcheck.cli.plotting import POINTS_PER_INCH, Palette, style

Record = dict[str, Any]
# Points, 72 to the inch.
WIDTH, _ROW = 780.0, 46.0
_HEAD, _FOOT, _LEFT, _MIDDLE, _RIGHT, _BETWEEN = 92.0, 34.0, 96.0, 420.0, 32.0, 44.0
_LEAST_ERROR = 1e-6  # of the size: what is smaller, but not 0, is drawn there
_MICROSECONDS = 1e6
# In rows: cold and cached runs lie above and below the middle, dots up to half of the spread off.
_COLD, _CACHED, _SPREAD = -0.2, 0.25, 0.24


def draw(records: Sequence[Record], rungs: Sequence[RungSummary], *, dark: bool) -> Figure:
    height = _HEAD + _ROW * len(rungs) + _FOOT
    with style(dark=dark) as palette:
        figure = Figure((WIDTH / POINTS_PER_INCH, height / POINTS_PER_INCH))
        title = "What each rung costs, and by how much it is off"
        figure.text(16 / WIDTH, 1 - 26 / height, title, size=13, weight="bold")
        corner, colours = (8 / WIDTH, 1 - 32 / height), series(dark=dark)
        figure.legend(
            handles=_legend(colours, palette), ncols=5, loc="upper left", bbox_to_anchor=corner
        )
        low, high = _FOOT / height, _ROW * len(rungs) / height
        times = figure.add_axes((_LEFT / WIDTH, low, (_MIDDLE - _LEFT) / WIDTH, high))
        start = _MIDDLE + _BETWEEN
        errors = figure.add_axes((start / WIDTH, low, (WIDTH - _RIGHT - start) / WIDTH, high))
        for axes in (times, errors):
            axes.set_ylim(len(rungs) - 0.5, -0.5)
            axes.tick_params(length=0)
            axes.grid(False, axis="y")
            axes.hlines(
                [k + 0.5 for k in range(len(rungs))],
                0,
                1,
                palette.grid,
                transform=axes.get_yaxis_transform(),
                linewidth=0.8,
            )
        _time_axis(times, records, rungs, palette)
        _error_axis(errors, rungs)
        for k, rung in enumerate(rungs):
            _row(times, errors, k, rung, records, colours, palette)
    return figure


def _time_axis(
    axes: Axes, records: Sequence[Record], rungs: Sequence[RungSummary], palette: Palette
) -> None:
    known = [
        end
        for rung in rungs
        for one in (rung.cold, rung.cached)
        if one
        for end in (one.low, one.high)
    ]
    first, last = math.floor(math.log10(min(known))), math.ceil(math.log10(max(known)))
    axes.set_title("time")
    axes.set(xscale="log", xlim=(10.0**first, 10.0 ** max(last, first + 1)))
    name_decades(axes.xaxis, lambda value: duration(_MICROSECONDS * value))
    counts = [f"{rung.pairs} of {len(rows_of(records, rung.label))}" for rung in rungs]
    names = [f"{rung.label}\n{count}" for rung, count in zip(rungs, counts, strict=True)]
    axes.set_yticks(range(len(rungs)), names, color=palette.ink)


def _error_axis(axes: Axes, rungs: Sequence[RungSummary]) -> None:
    """A logarithm beside a column for errors of 0."""
    worst = [e.high for r in rungs for e in (r.errors.apart, r.errors.overlapping) if e]
    last = math.ceil(math.log10(max(worst, default=1.0) or 1.0))
    first = round(math.log10(_LEAST_ERROR))
    axes.set_title("error, in sizes of the smaller body")
    axes.set_xscale("symlog", linthresh=_LEAST_ERROR, linscale=1.0)
    axes.set_xlim(-0.5 * _LEAST_ERROR, 10.0**last * 1.5)
    ticks = [0.0, *(10.0**k for k in range(first, last + 1, 2))]
    axes.set_xticks(ticks, [percent(value) for value in ticks])
    axes.set_yticks([])


def _row(
    times: Axes,
    errors: Axes,
    k: int,
    rung: RungSummary,
    records: Sequence[Record],
    colours: Colours,
    palette: Palette,
) -> None:
    colour = colours[kind_of(rung.label)]
    rows = [(record, row) for record, row in rows_of(records, rung.label) if worked(row)]
    for summary, which, off in ((rung.cold, "cold", _COLD), (rung.cached, "cached", _CACHED)):
        if summary is None:
            continue
        spent = [time for _, row in rows if (time := seconds(row, which)) is not None]
        face = colour if which == "cold" else "none"
        times.scatter(
            spent, _swaying(k + off, spent), 14, edgecolor=colour, facecolor=face, alpha=0.45
        )
        _quartiles(times, summary, k + off, colour, palette)
    known = [
        (error, outcome(record, row))
        for record, row in rows
        if (error := relative_error(record, row)) is not None
    ]
    ends = [max(error, _LEAST_ERROR) if error else 0.0 for error, _ in known]
    hues = [colours["wrong"] if kind in ("false hit", "miss") else colour for _, kind in known]
    errors.scatter(ends, _swaying(k, ends, 2.5), 14, c=hues, alpha=0.45, linewidths=0)
    middle = spread(ends)
    if middle is not None:
        _quartiles(errors, middle, k, colour, palette)


def _swaying(middle: float, dots: Sequence[float], by: float = 1.0) -> list[float]:
    """Off the middle by the golden ratio: evenly, and the same every time."""
    return [middle + by * _SPREAD * ((k * 0.618034) % 1.0 - 0.5) for k in range(len(dots))]


def _quartiles(axes: Axes, one: Spread, y: float, colour: str, palette: Palette) -> None:
    axes.plot([one.first, one.third], [y, y], color=colour, linewidth=2.5)
    axes.plot(one.median, y, "|", color=palette.ink, markersize=13, markeredgewidth=2.5)


def _legend(colours: Colours, palette: Palette) -> list[Line2D]:
    dot: dict[str, Any] = {"marker": "o", "linestyle": "none", "markersize": 6}
    sound, parts = colours["sound"], colours["parts"]
    middle: dict[str, Any] = {
        "marker": "|",
        "mec": palette.ink,
        "markersize": 13,
        "mew": 2.5,
        "linewidth": 2.5,
    }
    return [
        Line2D([], [], color=sound, label="a pair", **dot),
        Line2D([], [], color=parts, label="by convex parts", **dot),
        Line2D([], [], color=parts, mfc="none", label="cached", **dot),
        Line2D([], [], color=colours["wrong"], label="a wrong verdict", **dot),
        Line2D([], [], color=sound, label="quartiles and median", **middle),
    ]
