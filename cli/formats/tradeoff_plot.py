"""What accuracy costs in time: a panel for each pair, error against time, both logarithmic.

A diamond at the time of a rung is the error of its thickness. An error of 0 has a row of its own
below the others, and so has a rung without an error, the Boolean. A rung that climbed no further
than a lower one is named below its panel, not drawn.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import msgspec
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import FuncFormatter, NullLocator

from satcheck.audit.tradeoff import choices, labels_of
from satcheck.cli.formats.numbers import duration, number
from satcheck.cli.formats.plot_style import POINTS_PER_INCH, Labels, Palette, style
from satcheck.cli.formats.tradeoff_steps import steps
from satcheck.cli.output import harmless

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from satcheck.audit.tradeoff import ClimbEnd, PairTradeoff, Row, Rung, Truth

# Points, 72 to the inch.
WIDTH = 780.0
_LEFT, _RIGHT = 92.0, 28.0
_HEAD, _TITLE, _LINE, _FOOT, _GAP = 84.0, 26.0, 15.0, 26.0, 22.0
_DECADE, _LEAST_HEIGHT, _MOST_HEIGHT, _ROW = 42.0, 84.0, 210.0, 34.0
_ABOVE = 14.0  # between the highest error and the frame: room for a label
_LETTERS = 98  # that fit on a line
_NEAR = 20.0  # points of one kind this close share a label
_RUNGS = (
    "aabb, obb: boxes; hull: convex hulls; parts: convex parts, coarse to fine; exact: triangles; "
    "boolean: common volume"
)
_MARKERS = ("o", "^", "x")  # by Row.standing: proven, not proven, wrong
_MICROSECONDS = 1e6


def draw(pairs: Sequence[PairTradeoff], *, dark: bool = False) -> Figure:
    """All panels share one axis of time."""
    panels = [_Panel(pair) for pair in pairs]
    height = _HEAD + sum(panel.height for panel in panels)
    with style(dark=dark) as palette:
        figure = Figure((WIDTH / POINTS_PER_INCH, height / POINTS_PER_INCH))
        _head(figure, palette, height)
        times, top = _time_limits(pairs), height - _HEAD
        for panel in panels:
            left, bottom = _LEFT / WIDTH, (top - panel.above - panel.errors.height) / height
            box = (left, bottom, 1 - left - _RIGHT / WIDTH, panel.errors.height / height)
            panel.draw(figure.add_axes(box), times, palette)
            top -= panel.height
    return figure


def _head(figure: Figure, palette: Palette, height: float) -> None:
    title = "What accuracy costs: error of distance or depth against time (lower left is better)"
    figure.text(16 / WIDTH, 1 - 26 / height, title, size=13, weight="bold")
    marks = [
        Line2D([], [], **_marker(standing, palette), label=f"verdict {words}")
        for standing, words in enumerate(("proven", "not proven", "wrong"))
    ]
    marks.append(Line2D([], [], **_marker(0, palette, cached=True), label="cached"))
    marks.append(Line2D([], [], **_diamond(palette), label="thickness"))
    marks.append(Line2D([], [], color=palette.faint, label="Pareto front: worth its time"))
    corner = (8 / WIDTH, 1 - 32 / height)
    figure.legend(handles=marks, loc="upper left", bbox_to_anchor=corner, ncols=len(marks))
    figure.text(16 / WIDTH, 1 - 68 / height, _RUNGS, color=palette.faint, size=10)


def _time_limits(pairs: Sequence[PairTradeoff]) -> tuple[float, float]:
    """Whole decades of seconds around every time."""
    rows = [row for pair in pairs for row in pair.rows]
    known = [t.median for row in rows for t in (row.cold, row.cached) if t is not None]
    first = math.floor(math.log10(min(known, default=1e-5)))
    last = math.ceil(math.log10(max(known, default=1.0)))
    return 10.0**first, 10.0 ** max(last, first + 1)


class _ErrorAxis(msgspec.Struct, frozen=True):
    """In points from the foot up: a row for rungs without an error, where there are any, a row for
    errors of 0, and decades of error from 10^first to 10^last, where first < last."""

    first: int
    last: int
    without: bool

    @property
    def zero(self) -> float:
        """Where errors of 0 lie."""
        return (1.5 if self.without else 0.5) * _ROW

    @property
    def decades_height(self) -> float:
        span = self.last - self.first
        return min(max(_DECADE * span, _LEAST_HEIGHT), _MOST_HEIGHT) if span else 0.0

    @property
    def height(self) -> float:
        return self.zero + 0.5 * _ROW + self.decades_height + _ABOVE

    def at(self, error: float | None) -> float:
        if error is None:
            return 0.5 * _ROW
        if error == 0:
            return self.zero
        share = (math.log10(error) - self.first) / (self.last - self.first)
        return self.zero + 0.5 * _ROW + share * self.decades_height

    def apply(self, axes: Axes, palette: Palette) -> None:
        step = max(1, math.ceil((self.last - self.first) / 6))
        decades = range(self.last, self.first - 1, -step) if self.decades_height else ()
        values = [*(10.0**k for k in decades), 0.0, *([None] if self.without else [])]
        words = ["verdict only" if value is None else number(value) for value in values]
        axes.set_ylim(0.0, self.height)
        axes.set_yticks([self.at(value) for value in values], words)
        axes.tick_params(length=0)
        for border in (self.zero - 0.5 * _ROW, self.zero + 0.5 * _ROW):
            axes.axhline(border, color=palette.faint, linewidth=0.6, alpha=0.6)


def _error_axis(rows: Sequence[Row]) -> _ErrorAxis:
    errors = [error for row in rows for error in (row.error, row.thickness_error)]
    sizes = [abs(error) for error in errors if error]
    without = any(row.error is None for row in rows)
    if not sizes:
        return _ErrorAxis(0, 0, without)
    first = math.floor(math.log10(min(sizes)))
    return _ErrorAxis(first, max(math.ceil(math.log10(max(sizes))), first + 1), without)


class _Panel:
    """One pair: title and prices above the plot, what is not drawn below."""

    def __init__(self, pair: PairTradeoff) -> None:
        answered = [row for row in pair.rows if row.cold is not None and row.state == "answered"]
        self._rows = choices(answered)
        self.errors = _error_axis(self._rows)
        self._title = _fitted(_title(pair))
        self._prices = [_fitted(line) for line in steps(pair)]
        self._remarks = [_fitted(line) for line in _remarks(pair, answered, self._rows)]

    @property
    def above(self) -> float:
        return _TITLE + _LINE * len(self._prices)

    @property
    def height(self) -> float:
        return self.above + self.errors.height + _FOOT + _LINE * len(self._remarks) + _GAP

    def draw(self, axes: Axes, times: tuple[float, float], palette: Palette) -> None:
        axes.set_xscale("log")
        axes.set_xlim(*times)
        axes.xaxis.set_major_formatter(FuncFormatter(lambda x, _: duration(_MICROSECONDS * x)))
        axes.xaxis.set_minor_locator(NullLocator())
        self.errors.apply(axes, palette)
        self._words(axes, palette)
        self._front(axes, palette)
        for row in self._rows:
            self._mark(axes, row, palette)
        self._name(axes)

    def _words(self, axes: Axes, palette: Palette) -> None:
        def lines(words: Sequence[str], y: float, up: float, **how: Any) -> None:
            axes.annotate(
                "\n".join(words),
                (0, y),
                xytext=(0, up),
                xycoords="axes fraction",
                textcoords="offset points",
                linespacing=1.3,
                **how,
            )

        lines([self._title], 1, 8 + _LINE * len(self._prices), va="bottom", weight="bold", size=11)
        lines(self._prices, 1, 6, va="bottom")
        lines(self._remarks, 0, -_FOOT, va="top", color=palette.faint, size=10)
        axes.annotate(
            "error",
            (0, 1),
            xytext=(-6, 6),
            xycoords="axes fraction",
            textcoords="offset points",
            ha="right",
            color=palette.faint,
            size=10,
        )

    def _front(self, axes: Axes, palette: Palette) -> None:
        """A step from each rung on the front to the next slower one."""
        corners = self._corners
        if corners:
            axes.plot(*zip(*corners, strict=True), color=palette.faint, linewidth=1.5)

    @property
    def _corners(self) -> list[tuple[float, float]]:
        """Of the line along the front."""
        best = sorted(self._place(row) for row in self._rows if row.on_front)
        turns = [[left, (right[0], left[1])] for left, right in pairwise(best)]
        return [corner for turn in turns for corner in turn] + best[-1:]

    def _mark(self, axes: Axes, row: Row, palette: Palette) -> None:
        x, y = self._place(row)
        if row.cached is not None:
            axes.plot([row.cached.median, x], [y, y], ":", color=palette.faint, linewidth=1)
            marker = _marker(row.standing, palette, cached=True)
            axes.plot(row.cached.median, y, **marker, gid=f"{row.rung.label}, cached")
        axes.plot(x, y, **_marker(row.standing, palette), gid=row.rung.label)
        if row.thickness_error is not None:
            name = f"{row.rung.label}, thickness"
            axes.plot(x, self._thickness(row), **_diamond(palette), gid=name)

    def _name(self, axes: Axes) -> None:
        """A label for each rung; neighbours of one kind share one."""
        cached = [
            (row.cached.median, self.errors.at(row.size_of_error))
            for row in self._rows
            if row.cached is not None
        ]
        thick = [
            (self._place(row)[0], self._thickness(row))
            for row in self._rows
            if row.thickness_error is not None
        ]
        labels = Labels(axes, [*map(self._place, self._rows), *cached, *thick])
        for start, end in pairwise(self._corners):
            labels.keep_clear_of_line(start, end)
        for group in self._groups(axes):
            places = [self._place(row) for row in group]
            labels.place(labels_of([row.rung for row in group]), places)

    def _groups(self, axes: Axes) -> list[list[Row]]:
        groups: list[list[Row]] = []
        for row in sorted(self._rows, key=lambda row: (row.rung.name, self._place(row)[::-1])):
            here = axes.transData.transform(self._place(row))
            last = groups[-1][-1] if groups else None
            if (
                last is not None
                and last.rung.name == row.rung.name
                and math.dist(axes.transData.transform(self._place(last)), here) < _NEAR
            ):
                groups[-1].append(row)
            else:
                groups.append([row])
        return groups

    def _place(self, row: Row) -> tuple[float, float]:
        assert row.cold is not None
        return row.cold.median, self.errors.at(row.size_of_error)

    def _thickness(self, row: Row) -> float:
        assert row.thickness_error is not None
        return self.errors.at(abs(row.thickness_error))


def _diamond(palette: Palette) -> dict[str, Any]:
    """Of an error of the thickness."""
    return {
        "marker": "D",
        "color": palette.faint,
        "markersize": 5,
        "markerfacecolor": "none",
        "markeredgewidth": 1.2,
        "linestyle": "none",
        "zorder": 5,
    }


def _marker(standing: int, palette: Palette, *, cached: bool = False) -> dict[str, Any]:
    """cached: smaller, an outline."""
    colour = (palette.proven, palette.guess, palette.wrong)[standing]
    return {
        "marker": _MARKERS[standing],
        "color": colour,
        "markersize": 6.5 if cached else 9,
        "markerfacecolor": palette.paper if cached else colour,
        "markeredgewidth": 2.5 if standing == 2 else 1.2,
        "linestyle": "none",
        "zorder": 4,
    }


def _title(pair: PairTradeoff) -> str:
    truth = pair.truth.relation or "truth not known"
    return f"{pair.a} against {pair.b}: {truth}{_by(pair.truth)}{_end(pair.default)}"


def _by(truth: Truth) -> str:
    value = 0.0 if truth.figure is None else truth.figure.value
    return f", {number(abs(value))} {'apart' if value > 0 else 'deep'}" if value else ""


def _end(default: ClimbEnd | None) -> str:
    if default is None:
        return ""
    return f"; the default {'settles it by' if default.settled else 'ends at'}: {default.rung}"


def _remarks(pair: PairTradeoff, answered: Sequence[Row], drawn: Sequence[Row]) -> Iterator[str]:
    """What is not drawn, and why."""
    rungs: dict[str, list[Rung]] = {}
    for row in pair.rows:
        if row not in answered:
            rungs.setdefault(f"{row.state}, {row.reason}", []).append(row.rung)
        elif row not in drawn:
            rungs.setdefault(f"climbed no further than {row.settled_by}", []).append(row.rung)
    for reason, silent in rungs.items():
        yield f"{labels_of(silent)}: {reason}"


def _fitted(words: str) -> str:
    """On one line; names of bodies can hold any character."""
    line = harmless(words)
    return line if len(line) <= _LETTERS else f"{line[: _LETTERS - 1]}\N{HORIZONTAL ELLIPSIS}"
