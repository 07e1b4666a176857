"""Every pair as a dot: time and error of each rung, with quartiles; one row a rung."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from typing import Any

from bench.accuracy.palette import series
from bench.accuracy.rungs import RungSummary, relative_error, rows_of, seconds, worked
from bench.accuracy.spread import Spread, spread
from bench.accuracy.verdicts import outcome
from bench.drawing import LogAxis, disc, figure, line, text, whole_decades
from satcheck.cli.report.numbers import duration, number

Record = dict[str, Any]
WIDTH, TOP, ROW, FOOT = 760.0, 88.0, 46.0, 34.0
LABELS = 92.0
TIME, ERROR = (112.0, 424.0), (512.0, 736.0)
EXACT = 468.0  # where errors of 0 lie: they have no logarithm
_MICROSECONDS = 1e6
_LEAST_TICK = 36.0  # pixels between ticks that are named
_LAST_TICK = 720.0  # names of ticks from here on would leave the picture
_SPAN = 9.0  # by so much dots of a row lie above or below its middle
_LEAST_ERROR = 1e-6  # of the size: what is smaller is drawn there


def draw(records: Sequence[Record], rungs: Sequence[RungSummary]) -> str:
    known = [
        end
        for rung in rungs
        for one in (rung.cold, rung.cached)
        if one
        for end in (one.low, one.high)
    ]
    time = whole_decades(known, *TIME)
    worst = [e.high for r in rungs for e in (r.errors.apart, r.errors.overlapping) if e and e.high]
    error = whole_decades([_LEAST_ERROR, *worst], *ERROR)
    bottom = TOP + len(rungs) * ROW
    parts = [
        text(16, 24, "What each rung costs, and by how much it is off", "start", "head"),
        *_legend(),
        *_grid(time, bottom, lambda value: duration(_MICROSECONDS * value)),
        *_grid(error, bottom, lambda value: f"{number(100 * value)} %"),
        line(EXACT, TOP, EXACT, bottom, "grid"),
        text(EXACT, bottom + 16, "0", "middle", "small"),
        text(TIME[0], TOP - 10, "time", "start", "title"),
        text(EXACT - 12, TOP - 10, "error, in sizes of the smaller body", "start", "title"),
    ]
    for k, rung in enumerate(rungs):
        parts += _row(records, rung, TOP + (k + 0.5) * ROW, time, error)
    return figure(WIDTH, bottom + FOOT, "Time and error by rung", parts, series())


def _grid(axis: LogAxis, bottom: float, words: Callable[[float], str]) -> Iterator[str]:
    values = list(axis.decades)
    every = 1 if abs(axis.end - axis.start) > _LEAST_TICK * len(values) else 2
    for value in values:
        x = axis.at(value)
        yield line(x, TOP, x, bottom, "grid")
        if round(math.log10(value)) % every == 0:
            anchor = "middle" if x < _LAST_TICK else "end"
            end = x if anchor == "middle" else WIDTH - 4
            yield text(end, bottom + 16, words(value), anchor, "small")


def kind_of(label: str) -> str:
    return "parts" if label.startswith("parts") else "boolean" if label == "boolean" else "sound"


def _row(
    records: Sequence[Record], rung: RungSummary, y: float, time: LogAxis, error: LogAxis
) -> Iterator[str]:
    kind, asked = kind_of(rung.label), rows_of(records, rung.label)
    rows = [(record, row) for record, row in asked if worked(row)]
    answered = f"{rung.pairs} of {len(asked)}"
    yield line(16, y + 0.5 * ROW, WIDTH - 16, y + 0.5 * ROW, "grid")
    yield text(LABELS, y, rung.label)
    yield text(LABELS, y + 14, answered, "end", "small")
    for times, which, centre in ((rung.cold, "cold", -10), (rung.cached, "cached", 12)):
        if times is not None:
            style = f"{kind}-fill" if which == "cold" else f"{kind}-line"
            for k, (_, row) in enumerate(rows):
                spent = seconds(row, which)
                if spent is not None:
                    yield dot(time.at(spent), y + centre + _sway(k), style)
            yield from _quartiles(times, time, y + centre, kind, which == "cached")
    yield from _errors(rows, y, error, kind)


def _errors(
    rows: Sequence[tuple[Record, dict[str, Any]]], y: float, axis: LogAxis, kind: str
) -> Iterator[str]:
    seen = []
    for k, (record, row) in enumerate(rows):
        off = relative_error(record, row)
        if off is None:
            continue
        seen.append(off)
        wrong = outcome(record, row) in ("false hit", "miss")
        x = axis.at(max(off, _LEAST_ERROR)) if off else EXACT + 1.6 * _sway(k + 3)
        yield dot(x, y + 1.7 * _sway(k), "wrong-fill" if wrong else f"{kind}-fill")
    middle = spread(seen)
    if middle is not None:
        yield from _quartiles(middle, axis, y, kind, False)


def dot(x: float, y: float, kind: str) -> str:
    return f'<g opacity="0.45">{disc(x, y, 2.2, kind)}</g>'


def _sway(k: int) -> float:
    """Off the middle by the golden ratio: evenly, and the same every time."""
    return _SPAN * ((k * 0.618034) % 1.0 - 0.5)


def _quartiles(one: Spread, axis: LogAxis, y: float, kind: str, hollow: bool) -> Iterator[str]:
    first, middle, third = (
        axis.at(max(value, axis.low)) if value else EXACT
        for value in (one.first, one.median, one.third)
    )
    yield f'<g stroke-width="{2 if hollow else 3}">{line(first, y, third, y, f"{kind}-line")}</g>'
    yield f'<g stroke-width="3">{line(middle, y - 9, middle, y + 9, "rule")}</g>'


def _legend() -> Iterator[str]:
    x = 16.0
    for style, words in (
        ("sound-fill", "a pair"),
        ("parts-fill", "by convex parts"),
        ("parts-line", "cached"),
        ("wrong-fill", "a wrong verdict"),
    ):
        yield disc(x + 5, 46, 4, style)
        yield text(x + 15, 50, words, "start")
        x += 32 + 6.6 * len(words)
    yield f'<g stroke-width="3">{line(x + 5, 46, x + 39, 46, "sound-line")}</g>'
    yield f'<g stroke-width="3">{line(x + 22, 38, x + 22, 54, "rule")}</g>'
    yield text(x + 47, 50, "quartiles and median", "start")
