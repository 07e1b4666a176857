"""Error against time, rung by rung: medians over the same pairs, with quartiles."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import NullLocator

from bench.accuracy.labels import Labels, Point
from bench.accuracy.palette import Colours, kind_of, series
from bench.accuracy.rungs import PARTS, Cost
from bench.drawing import name_decades, percent, plain
from satcheck.audit.words import number
from satcheck.cli.plotting import POINTS_PER_INCH, Palette, style

# Points, 72 to the inch.
WIDTH = 780.0
_LEFT, _RIGHT, _HEAD, _GAP, _FOOT, _PANEL = 84.0, 32.0, 56.0, 34.0, 40.0, 350.0
_TITLE = "What accuracy costs: error against time, where boxes and hulls do not settle it"
_LEAST_ERROR = 1e-5  # of the size; quartiles below it end there
_NEAR = 14.0  # points


def draw(apart: Sequence[Cost], overlapping: Sequence[Cost], *, dark: bool) -> Figure:
    """Of the pairs that are apart or touch, and of those that overlap. For these, convex parts give
    the depth of the hulls: a point for them would be compared with the hulls of other pairs."""
    ladder = [one for one in overlapping if not one.label.startswith(PARTS)]
    panels = [
        _Panel("Bodies that are apart, or touch: error of the gap", apart, ""),
        _Panel("Bodies that overlap: error of the depth", ladder, _note(overlapping)),
    ]
    shown = [panel for panel in panels if panel.points]
    with style(dark=dark) as palette:
        height = _HEAD + _PANEL * max(len(shown), 1)
        figure = Figure((WIDTH / POINTS_PER_INCH, height / POINTS_PER_INCH))
        figure.text(16 / WIDTH, 1 - 26 / height, _TITLE, size=13, weight="bold")
        colours, limits = series(dark=dark), _time_limits([*apart, *overlapping])
        corner = (8 / WIDTH, 1 - 32 / height)
        handles = _legend(colours, palette)
        figure.legend(handles=handles, ncols=4, loc="upper left", bbox_to_anchor=corner)
        for k, panel in enumerate(shown):
            bottom = height - _HEAD - (k + 1) * _PANEL + _FOOT
            frame = (_LEFT, bottom, WIDTH - _LEFT - _RIGHT, _PANEL - _FOOT - _GAP)
            box = [length / whole for length, whole in zip(frame, 2 * (WIDTH, height), strict=True)]
            panel.draw(figure.add_axes((box[0], box[1], box[2], box[3])), limits, colours, palette)
    return figure


@dataclass(frozen=True, slots=True)
class _Panel:
    """note: written into the upper right corner."""

    title: str
    points: Sequence[Cost]
    note: str

    def draw(
        self, axes: Axes, limits: tuple[float, float], colours: Colours, palette: Palette
    ) -> None:
        axes.set_title(self.title)
        axes.set(xscale="log", xlim=limits)
        axes.set_xlabel("CPU time, nothing cached, over that of the exact rung on the same pair")
        name_decades(axes.xaxis, lambda value: f"{plain(value)} x")
        _error_axis(axes, self.points)
        corner: dict[str, Any] = {"xycoords": "axes fraction", "ha": "right"}
        axes.annotate(self.note, (0.985, 0.9), color=palette.faint, va="top", **corner)
        axes.annotate(
            "in sizes of the smaller body", (1, 1.03), color=palette.faint, size=10, **corner
        )
        for (x, y), (to_x, to_y) in _path(self.points):
            axes.plot([x, to_x], [y, to_y], color=palette.faint, linewidth=1)
        for point in self.points:
            _mark(axes, point, colours[kind_of(point.label)], palette)
        _name(axes, self.points)


def _error_axis(axes: Axes, points: Sequence[Cost]) -> None:
    """Decades of error, and below them a row for 0."""
    known = [e for p in points for e in (p.error.first, p.error.third) if e > _LEAST_ERROR]
    first = math.floor(math.log10(min(known, default=_LEAST_ERROR)))
    last = max(math.ceil(math.log10(max(known, default=_LEAST_ERROR))), first + 1)
    axes.set_yscale("symlog", linthresh=10.0**first, linscale=0.5)
    axes.set_ylim(-0.6 * 10.0**first, 10.0**last * 1.6)
    ticks = [0.0, *(10.0**k for k in range(first, last + 1))]
    axes.set_yticks(ticks, [percent(value) for value in ticks])
    axes.yaxis.set_minor_locator(NullLocator())


def _path(points: Sequence[Cost]) -> list[tuple[Point, Point]]:
    """From each rung to the next finer one, convex parts among themselves."""
    kinds = [
        [_at(p) for p in points if p.label.startswith(PARTS) is kind] for kind in (False, True)
    ]
    return [piece for places in kinds for piece in pairwise(places)]


def _at(point: Cost) -> tuple[float, float]:
    return point.cold.median, point.error.median


def _mark(axes: Axes, point: Cost, colour: str, palette: Palette) -> None:
    x, y = _at(point)
    quartiles: dict[str, Any] = {"color": colour, "alpha": 0.6, "linewidth": 2}
    axes.plot([point.cold.first, point.cold.third], [y, y], **quartiles)
    axes.plot([x, x], [point.error.first, point.error.third], **quartiles)
    if point.cached is not None:
        axes.plot(point.cached.median, y, "o", color=colour, markerfacecolor=palette.paper)
    axes.plot(x, y, "o", color=colour, markersize=9, zorder=4)


def _name(axes: Axes, points: Sequence[Cost]) -> None:
    """With the number of pairs; parts whose points lie on each other share a label."""
    cached = [(p.cached.median, p.error.median) for p in points if p.cached is not None]
    labels = Labels(axes, [*map(_at, points), *cached])
    for point in points:
        x, y = _at(point)
        labels.keep_clear_of_line((x, point.error.first), (x, point.error.third))
        labels.keep_clear_of_line((point.cold.first, y), (point.cold.third, y))
    for piece in _path(points):
        labels.keep_clear_of_line(*piece)
    for group in _groups(axes, points):
        # One height for all of them: the label stands beside the last.
        heights = group[-1].error.median
        labels.place(_words(group), [(one.cold.median, heights) for one in group])


def _words(group: Sequence[Cost]) -> str:
    """`hull (60)`, `parts 0.5 .. 0.1 (20 .. 12)`."""
    first, last = group[0], group[-1]
    pairs = " .. ".join(dict.fromkeys((str(first.pairs), str(last.pairs))))
    words = first.label if len(group) == 1 else f"{first.label} .. {last.label.split()[-1]}"
    return f"{words} ({pairs})"


def _groups(axes: Axes, points: Sequence[Cost]) -> list[list[Cost]]:
    groups: list[list[Cost]] = []
    for point in points:
        last = groups[-1][-1] if groups else None
        parts = last is not None and all(one.label.startswith(PARTS) for one in (last, point))
        here, there = (axes.transData.transform(_at(one)) for one in (point, last or point))
        if parts and math.dist(here, there) < _NEAR:
            groups[-1].append(point)
        else:
            groups.append([point])
    return groups


def _note(points: Sequence[Cost]) -> str:
    """What is not drawn: the least and the most of the medians of convex parts."""
    medians = [one.cold.median for one in points if one.label.startswith(PARTS)]
    if not medians:
        return ""
    ends = dict.fromkeys(f"{number(float(f'{m:.2g}'))} x" for m in (min(medians), max(medians)))
    return f"convex parts: the depth of the hulls, {' .. '.join(ends)} the time of the proof"


def _time_limits(points: Sequence[Cost]) -> tuple[float, float]:
    spreads = [one for point in points for one in (point.cold, point.cached) if one is not None]
    ends = [end for one in spreads for end in (one.first, one.third)]
    first = math.floor(math.log10(min(ends, default=1.0)))
    return 10.0**first, 10.0 ** max(math.ceil(math.log10(2 * max(ends, default=1.0))), first + 1)


def _legend(colours: Colours, palette: Palette) -> list[Line2D]:
    sound, parts = colours["sound"], colours["parts"]
    dot: dict[str, Any] = {"marker": "o", "linestyle": "none", "markersize": 8}
    return [
        Line2D([], [], color=sound, label="boxes, hulls, triangles", **dot),
        Line2D([], [], color=parts, label="convex parts", **dot),
        Line2D([], [], color=parts, mfc=palette.paper, label="convex parts, cached", **dot),
        Line2D([], [], color=sound, linewidth=2, label="quartiles; (number of pairs)"),
    ]
