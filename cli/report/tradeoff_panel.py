"""One pair as a picture: error against time, both logarithmic, an SVG fragment.

Errors of 0 have no logarithm: they lie on a lane of their own below the axis, and what says
yes or no alone, the Boolean, on one below that. Rungs that climbed no further than a lower one are
named, not drawn.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from html import escape
from typing import TYPE_CHECKING

from msgspec import Struct

from satcheck.cli.report.numbers import duration, number
from satcheck.cli.report.tradeoff_labels import around, baseline, place
from satcheck.cli.report.tradeoff_steps import steps
from satcheck.studies.tradeoff import choices, labels_of

if TYPE_CHECKING:
    from satcheck.studies.tradeoff import PairTradeoff, Picked, Row, Rung, Truth

WIDTH = 760.0
_LEFT, _RIGHT = 96.0, 24.0
_TITLE, _LANE, _FOOT, _LINE = 34.0, 34.0, 28.0, 15.0
_ABOVE = 21.0  # labels of the topmost points lie above the grid
_DECADE, _LEAST_HEIGHT, _MOST_HEIGHT = 42.0, 84.0, 210.0
_MICROSECONDS = 1e6
_LETTERS = 104  # that fit on a line below the plot
_NEAR = 20.0  # points of one kind within so many pixels share a label
_KINDS = {0: "proven", 1: "guess", 2: "wrong"}


class TimeAxis(Struct, frozen=True):
    """Decades of seconds, first and last, that all panels share."""

    first: int
    last: int

    def x(self, seconds: float) -> float:
        share = (math.log10(seconds) - self.first) / (self.last - self.first)
        return _LEFT + share * (WIDTH - _LEFT - _RIGHT)

    @property
    def ticks(self) -> Iterator[tuple[float, str]]:
        for decade in range(self.first, self.last + 1):
            yield self.x(10.0**decade), duration(10.0**decade * _MICROSECONDS)


def time_axis(pairs: Sequence[PairTradeoff]) -> TimeAxis:
    """Whole decades around every time."""
    rows = [row for pair in pairs for row in pair.rows]
    known = [t.median for row in rows for t in (row.cold, row.cached) if t is not None]
    first = math.floor(math.log10(min(known, default=1e-5)))
    return TimeAxis(first, max(math.ceil(math.log10(max(known, default=1.0))), first + 1))


class _Errors(Struct, frozen=True):
    """The vertical axis: decades of error from the top down, then the lanes."""

    decades: tuple[int, int] | None
    height: float
    lanes: tuple[str, ...]

    def y(self, error: float | None) -> float:
        top = _TITLE + self.height
        if error is None:
            return top + 1.5 * _LANE
        if error == 0 or self.decades is None:
            return top + 0.5 * _LANE
        first, last = self.decades
        return _TITLE + self.height * (last - math.log10(error)) / (last - first)

    @property
    def bottom(self) -> float:
        return _TITLE + self.height + len(self.lanes) * _LANE


class _Dot(Struct, frozen=True):
    row: Row
    x: float
    y: float
    cached: bool = False


def panel(pair: PairTradeoff, time: TimeAxis) -> tuple[str, float]:
    """The fragment, from y = 0 down, and its height."""
    answered = [row for row in pair.rows if row.cold is not None and row.state == "answered"]
    drawn = choices(answered)
    errors = _error_axis(drawn)
    dots = list(_dots(drawn, time, errors))
    said = steps(pair)
    plot = [
        *_grid(time, errors),
        *_front(dots),
        *_links(dots),
        *(_marker(dot) for dot in dots),
        *_labels([dot for dot in dots if not dot.cached], dots, errors.bottom),
    ]
    top = _LINE * len(said)
    foot = top + errors.bottom + _FOOT
    remarks = list(_remarks(pair, answered, drawn))
    parts = [
        f'<text class="title" x="{_LEFT:g}" y="18">{escape(_title(pair))}</text>',
        *_lines("label", said, 18),
        f'<g transform="translate(0 {top:g})">',
        *plot,
        "</g>",
        *_lines("label", remarks, foot),
    ]
    return "\n".join(parts), foot + _LINE * (len(remarks) + 1)


def _lines(kind: str, said: Sequence[str], above: float) -> Iterator[str]:
    for k, line in enumerate(said, 1):
        y = above + k * _LINE
        yield f'<text class="{kind}" x="{_LEFT:g}" y="{y:.1f}">{escape(line)}</text>'


def _title(pair: PairTradeoff) -> str:
    truth = pair.truth.relation or "truth not known"
    return f"{pair.a} against {pair.b}: {truth}{_by(pair.truth)}{_end(pair.picked)}"


def _by(truth: Truth) -> str:
    value = 0.0 if truth.figure is None else truth.figure.value
    return f", {number(abs(value))} {'apart' if value > 0 else 'deep'}" if value else ""


def _end(picked: Picked | None) -> str:
    if picked is None:
        return ""
    return f"; the default {'settles it by' if picked.settled else 'ends at'}: {picked.rung}"


def _remarks(pair: PairTradeoff, answered: Sequence[Row], drawn: Sequence[Row]) -> Iterator[str]:
    """What is not drawn, and why."""
    found: dict[str, list[Rung]] = {}
    for row in pair.rows:
        if row not in answered:
            found.setdefault(f"{row.state}, {row.reason}", []).append(row.rung)
        elif row not in drawn:
            found.setdefault(f"climbed no further than {row.settled_by}", []).append(row.rung)
    for said, rungs in found.items():
        line = f"{labels_of(rungs)}: {said}"
        yield line if len(line) <= _LETTERS else f"{line[: _LETTERS - 1]}…"


def _error_axis(rows: Sequence[Row]) -> _Errors:
    sizes = [size for row in rows if (size := row.size_of_error)]
    lanes = ("0", *(("verdict only",) if any(row.error is None for row in rows) else ()))
    if not sizes:
        return _Errors(None, 0.0, lanes)
    first = math.floor(math.log10(min(sizes)))
    last = max(math.ceil(math.log10(max(sizes))), first + 1)
    height = min(max(_DECADE * (last - first), _LEAST_HEIGHT), _MOST_HEIGHT)
    return _Errors((first, last), height, lanes)


def _dots(rows: Sequence[Row], time: TimeAxis, errors: _Errors) -> Iterator[_Dot]:
    for row in rows:
        y = errors.y(row.size_of_error)
        for times, cached in ((row.cold, False), (row.cached, True)):
            if times is not None:
                yield _Dot(row, time.x(times.median), y, cached)


def _grid(time: TimeAxis, errors: _Errors) -> Iterator[str]:
    right = WIDTH - _RIGHT
    for x, text in time.ticks:
        yield _line("grid", x, _TITLE, x, errors.bottom)
        y = errors.bottom + 15
        yield f'<text class="tick" x="{x:.1f}" y="{y:.1f}" text-anchor="middle">{text}</text>'
    heights = []
    if errors.decades is not None:
        first, last = errors.decades
        step = max(1, math.ceil((last - first) / 6))
        heights = [(errors.y(10.0**d), number(10.0**d)) for d in range(last, first - 1, -step)]
    yield _y_tick(14.0, "error")
    for y, text in heights:
        yield _line("grid", _LEFT, y, right, y)
        yield _y_tick(y, text)
    for y, text in zip((errors.y(0.0), errors.y(None)), errors.lanes, strict=False):
        yield _line("lane", _LEFT, y - 0.5 * _LANE, right, y - 0.5 * _LANE)
        yield _y_tick(y, text)
    yield _line("lane", _LEFT, errors.bottom, right, errors.bottom)


def _y_tick(y: float, text: str) -> str:
    return f'<text class="tick" x="{_LEFT - 8:g}" y="{y + 4:.1f}" text-anchor="end">{text}</text>'


def _line(kind: str, x1: float, y1: float, x2: float, y2: float) -> str:
    return f'<line class="{kind}" x1="{x1:.1f}" y1="{y1:.1f}" x2="{x2:.1f}" y2="{y2:.1f}"/>'


def _front(dots: Sequence[_Dot]) -> Iterator[str]:
    """A step from each rung on the front to the next slower one."""
    best = sorted((dot.x, dot.y) for dot in dots if dot.row.on_front and not dot.cached)
    path = "".join(
        f"H{x:.1f}V{y:.1f}" if k else f"M{x:.1f} {y:.1f}" for k, (x, y) in enumerate(best)
    )
    if path:
        yield f'<path class="front" d="{path}"/>'


def _links(dots: Sequence[_Dot]) -> Iterator[str]:
    cold = {dot.row.rung: dot for dot in dots if not dot.cached}
    for dot in dots:
        if dot.cached:
            yield _line("link", dot.x, dot.y, cold[dot.row.rung].x, dot.y)


def _marker(dot: _Dot) -> str:
    row, x, y = dot.row, dot.x, dot.y
    times = row.cached if dot.cached else row.cold
    assert times is not None
    kind = _KINDS[row.standing]
    error = "no distance" if row.error is None else f"error {number(row.error)}"
    said = f"{row.rung.label}{', cached' if dot.cached else ''}: {error}, "
    said += duration(times.median * _MICROSECONDS)
    return shape(kind, x, y, cached=dot.cached, title=said)


def shape(kind: str, x: float, y: float, *, cached: bool = False, title: str = "") -> str:
    """proven: a disc; guess: a triangle; wrong: a cross. cached: smaller, an outline."""
    r = 3.5 if cached else 5.0
    hint = f"<title>{escape(title)}</title>" if title else ""
    name = f"{kind}{' cached' if cached else ''}"
    if kind == "proven":
        return f'<circle class="{name}" cx="{x:.1f}" cy="{y:.1f}" r="{r:g}">{hint}</circle>'
    if kind == "guess":
        path = f"M{x:.1f} {y - r:.1f}l{r:g} {1.8 * r:.1f}h{-2 * r:g}z"
    else:
        path = f"M{x - r:.1f} {y - r:.1f}l{2 * r:g} {2 * r:g}m0 {-2 * r:g}l{-2 * r:g} {2 * r:g}"
    return f'<path class="{name}" d="{path}">{hint}</path>'


def _labels(named: Sequence[_Dot], dots: Sequence[_Dot], bottom: float) -> Iterator[str]:
    """Beside the points, where nothing else is; neighbours of one kind share a label."""
    taken = [around(dot.x, dot.y) for dot in dots]
    frame = (_LEFT, _ABOVE, WIDTH, bottom)
    for group in _groups(named):
        name = labels_of([dot.row.rung for dot in group])
        left, right = min(dot.x for dot in group), max(dot.x for dot in group)
        box = place(name, (left, right, group[-1].y), taken, frame)
        taken.append(box)
        x, y = baseline(box)
        yield f'<text class="label" x="{x:.1f}" y="{y:.1f}">{escape(name)}</text>'


def _groups(dots: Sequence[_Dot]) -> list[list[_Dot]]:
    found: list[list[_Dot]] = []
    for dot in sorted(dots, key=lambda dot: (dot.row.rung.name, dot.y, dot.x)):
        last = found[-1][-1] if found else None
        same = last is not None and last.row.rung.name == dot.row.rung.name
        if last is not None and same and math.hypot(dot.x - last.x, dot.y - last.y) < _NEAR:
            found[-1].append(dot)
        else:
            found.append([dot])
    return found
