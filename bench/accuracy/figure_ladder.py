"""Error against time, rung by rung: medians over the same pairs, with quartiles."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise

from bench.accuracy.figure_rungs import kind_of
from bench.accuracy.palette import series
from bench.accuracy.rungs import Cost
from bench.drawing import LogAxis, disc, figure, line, plain, text, whole_decades
from satcheck.cli.report.numbers import number
from satcheck.cli.report.tradeoff_labels import Box, around, baseline, place

WIDTH, LEFT, RIGHT = 760.0, 92.0, 722.0
TOP, PLOT, LANE, GAP, FOOT = 86.0, 230.0, 40.0, 56.0, 48.0
_LEAST_ERROR = 1e-5  # of the size; quartiles below it end there
_PART = "parts"
_NEAR = 14.0  # pixels


@dataclass(frozen=True, slots=True)
class ErrorAxis:
    """Decades from the top down, and below them a lane for errors of 0."""

    decades: LogAxis
    lane: float

    def at(self, error: float) -> float:
        return self.decades.at(max(error, self.decades.low)) if error else self.lane


def draw(apart: Sequence[Cost], overlapping: Sequence[Cost]) -> str:
    """Of the pairs that are apart or touch, and of those that overlap. Of these convex parts tell
    the depth of the hulls: drawn, it would be compared with the hulls of other pairs."""
    sides = {
        "Bodies that are apart, or touch: error of the gap, in sizes of the smaller one": apart,
        "Bodies that overlap: error of the depth, in sizes of the smaller one": overlapping,
    }
    shown = {title: points for title, points in sides.items() if points}
    points = [point for side in shown.values() for point in side]
    spreads = [one for p in points for one in (p.cold, p.cached) if one is not None]
    ends = [end for one in spreads for end in (one.first, one.third)]
    time = whole_decades(ends or [1.0], LEFT, RIGHT)
    head = "What accuracy costs: error against time, where boxes and hulls do not settle it"
    parts = [text(16, 24, head, "start", "head"), *_legend()]
    top = TOP
    for title, side in shown.items():
        own = side if side is apart else [one for one in side if not one.label.startswith(_PART)]
        parts += _panel(title, own, time, top)
        if len(own) < len(side):
            note = f"convex parts: the depth of the hulls, {_costs(side)} the time of the proof"
            parts.append(text(RIGHT - 8, top + 18, note, "end", "small"))
        top += PLOT + LANE + GAP
    under = "CPU time, made anew, over that of the exact rung on the same pair"
    parts.append(text(RIGHT, top - GAP + 36, under, "end", "small"))
    high = top - GAP + FOOT
    return figure(WIDTH, high, "Error against time by rung", parts, series())


def _panel(title: str, points: Sequence[Cost], time: LogAxis, top: float) -> Iterator[str]:
    known = [e for p in points for e in (p.error.first, p.error.third) if e > _LEAST_ERROR]
    decades = whole_decades(known or [_LEAST_ERROR], top + PLOT, top)
    errors = ErrorAxis(decades, top + PLOT + 0.5 * LANE)
    bottom = top + PLOT + LANE
    yield text(LEFT, top - 10, title, "start", "title")
    for value in time.decades:
        x = time.at(value)
        yield line(x, top, x, bottom, "grid")
        yield text(x, bottom + 16, times(value), "middle", "small")
    for value in decades.decades:
        yield line(LEFT, decades.at(value), RIGHT, decades.at(value), "grid")
        yield text(LEFT - 8, decades.at(value) + 4, f"{number(100 * value)} %", "end", "small")
    yield line(LEFT, bottom, RIGHT, bottom, "grid")
    yield text(LEFT - 8, errors.lane + 4, "0", "end", "small")
    ladder = [point for point in points if not point.label.startswith(_PART)]
    parts = [point for point in points if point.label.startswith(_PART)]
    yield from _path(ladder, time, errors, "rule")
    yield from _path(parts, time, errors, "rule dashed")
    for point in points:
        yield from _cross(point, time, errors)
    yield from _labels(points, time, errors, (LEFT, top - 8, WIDTH, bottom))


def _costs(points: Sequence[Cost]) -> str:
    """`30 x .. 400 x`: the least and the most of the medians of parts."""
    medians = [one.cold.median for one in points if one.label.startswith(_PART)]
    return " .. ".join(
        dict.fromkeys(f"{number(float(f'{m:.2g}'))} x" for m in (min(medians), max(medians)))
    )


def _path(points: Sequence[Cost], time: LogAxis, errors: ErrorAxis, kind: str) -> Iterator[str]:
    for one, other in pairwise(points):
        a, b = ((time.at(p.cold.median), errors.at(p.error.median)) for p in (one, other))
        yield line(*a, *b, kind)


def _cross(point: Cost, time: LogAxis, errors: ErrorAxis) -> Iterator[str]:
    kind = kind_of(point.label)
    x, y = time.at(point.cold.median), errors.at(point.error.median)
    said = f"{point.label}: {100 * point.error.median:.3g} %, "
    said += times(point.cold.median)
    yield '<g stroke-width="2" opacity="0.6">'
    yield line(time.at(point.cold.first), y, time.at(point.cold.third), y, f"{kind}-line")
    yield line(x, errors.at(point.error.first), x, errors.at(point.error.third), f"{kind}-line")
    yield "</g>"
    if point.cached is not None:
        yield disc(time.at(point.cached.median), y, 4, f"{kind}-open", f"{said}, cached")
    yield disc(x, y, 5, f"{kind}-fill", said)


def _labels(points: Sequence[Cost], time: LogAxis, errors: ErrorAxis, frame: Box) -> Iterator[str]:
    at = {p.label: (time.at(p.cold.median), errors.at(p.error.median)) for p in points}
    taken = [around(*place) for place in at.values()]
    taken += [
        around(time.at(p.cached.median), at[p.label][1]) for p in points if p.cached is not None
    ]
    counts = {point.label: point.pairs for point in points}
    for group in _groups(points, at):
        words = _words(group, counts)
        across = [at[label][0] for label in group]
        box = place(words, (min(across), max(across), at[group[0]][1]), taken, frame)
        taken.append(box)
        yield text(*baseline(box), words, "start", "label")


def _words(group: Sequence[str], counts: dict[str, int]) -> str:
    """`hull (60)`, `parts 0.5 .. 0.1 (20 .. 12)`: with the number of pairs."""
    first, last = group[0], group[-1]
    ends = list(dict.fromkeys((counts[first], counts[last])))
    words = first if first == last else f"{first} .. {last.split()[-1]}"
    return f"{words} ({' .. '.join(map(str, ends))})"


def _groups(points: Sequence[Cost], at: dict[str, tuple[float, float]]) -> list[list[str]]:
    """Parts of neighbouring thresholds whose points lie on each other share a label."""
    found: list[list[str]] = []
    for point in points:
        last = found[-1] if found else None
        alike = last is not None and last[-1].startswith(_PART) and point.label.startswith(_PART)
        if last is not None and alike and math.dist(at[last[-1]], at[point.label]) < _NEAR:
            last.append(point.label)
        else:
            found.append([point.label])
    return found


def times(factor: float) -> str:
    """`100 x`, `0.01 x`."""
    return f"{plain(factor)} x"


def _legend() -> Iterator[str]:
    x = 16.0
    for style, words in (
        ("sound-fill", "boxes, hulls, triangles"),
        ("parts-fill", "convex parts, cold"),
        ("parts-open", "convex parts, cached"),
    ):
        yield disc(x + 5, 46, 5, style)
        yield text(x + 15, 50, words, "start")
        x += 30 + 6.4 * len(words)
    yield f'<g stroke-width="2">{line(x + 2, 46, x + 30, 46, "sound-line")}</g>'
    yield text(x + 37, 50, "quartiles; in brackets: pairs", "start")
