"""Path data of SVG as contours. Source: W3C, "SVG 1.1", 8.3, and F.6 for arcs."""

from __future__ import annotations

import math
from collections.abc import Iterator

from satcheck.scene.drawing.contour import Contour, Point, Tracer
from satcheck.scene.drawing.svg_values import bad, number_at, skip

_ARGUMENTS = {"m": 2, "l": 2, "h": 1, "v": 1, "c": 6, "s": 4, "q": 4, "t": 2, "a": 7, "z": 0}


def contours_of(d: str, filled: bool) -> tuple[list[Contour], bool]:
    """The closed contours, and whether an open line was left out.

    A filled path closes every line. Raises MeshFileError if the data are malformed.
    """
    pen = _Pen(filled)
    for letter, given in _commands(d):
        pen.draw(letter, given)
    pen.lift(closed=False)
    return pen.contours, pen.left_out


def _commands(d: str) -> Iterator[tuple[str, list[float]]]:
    place, first = skip(d, 0), True
    while place < len(d):
        letter = d[place]
        if letter.lower() not in _ARGUMENTS or (first and letter not in "mM"):
            raise bad(f"path data: {d[place : place + 12]!r} is not a command")
        start, place, first = place, skip(d, place + 1), False
        goes_on = True
        while goes_on:
            given, place = _arguments(d, place, letter.lower())
            if given is None:
                raise bad(f"path data: {d[start : start + 12]!r} lacks numbers")
            yield letter, given
            letter = {"m": "l", "M": "L"}.get(letter, letter)
            goes_on = bool(given) and place < len(d) and d[place].lower() not in _ARGUMENTS


def _arguments(d: str, place: int, letter: str) -> tuple[list[float] | None, int]:
    """The arguments of one command, and the place after them; None: some are missing."""
    given: list[float] = []
    for k in range(_ARGUMENTS[letter]):
        if letter == "a" and k in (3, 4):  # a flag, which needs no space after it
            if d[place : place + 1] not in ("0", "1"):
                return None, place
            value, place = float(d[place]), place + 1
        else:
            parsed = number_at(d, place, "path data")
            if parsed is None:
                return None, place
            value, place = parsed
        given.append(value)
        place = skip(d, place)
    return given, place


class _Pen:
    def __init__(self, filled: bool) -> None:
        self.contours: list[Contour] = []
        self.left_out = False
        self._filled = filled
        self._tracer: Tracer | None = None
        self._start = self._here = (0.0, 0.0)
        self._control: tuple[str, Point] | None = None  # last control point, for smooth curves

    def draw(self, letter: str, given: list[float]) -> None:
        kind = letter.lower()
        x, y = self._here if letter.islower() else (0.0, 0.0)
        before, self._control = self._control, None
        if kind == "z":
            self._here = self._start
            self.lift(closed=True)
            return
        if kind == "m":
            self.lift(closed=False)
            self._start = self._here = (given[0] + x, given[1] + y)
            return
        if self._tracer is None:
            self._start = self._here
            self._tracer = Tracer(self._here)
        if kind == "h":
            end = (given[0] + x, self._here[1])
        elif kind == "v":
            end = (self._here[0], given[0] + y)
        else:
            end = (given[-2] + x, given[-1] + y)
        if kind in "lhv":
            self._tracer.line(end)
        elif kind == "a":
            trace_arc(self._tracer, given, end)
        else:
            controls = [(a + x, b + y) for a, b in zip(given[::2], given[1::2], strict=True)]
            if kind in "st":
                controls.insert(0, self._reflected(before, "cs" if kind == "s" else "qt"))
            self._tracer.bezier(controls)
            self._control = (kind, controls[-2])
        self._here = end

    def _reflected(self, before: tuple[str, Point] | None, kinds: str) -> Point:
        if before is None or before[0] not in kinds:
            return self._here
        (x, y), (cx, cy) = self._here, before[1]
        return (2 * x - cx, 2 * y - cy)

    def lift(self, *, closed: bool) -> None:
        tracer, self._tracer = self._tracer, None
        if tracer is None:
            return
        if closed or self._filled or tracer.here == self._start:
            contour = tracer.closed()
            if contour is not None:
                self.contours.append(contour)
        else:
            self.left_out = True


def trace_arc(tracer: Tracer, given: list[float], end: Point) -> None:
    """given: radii, turn of the axis in degrees, flags, end point."""
    start = tracer.here
    rx, ry = abs(given[0]), abs(given[1])
    if rx == 0 or ry == 0 or start == end:
        if start != end:
            tracer.line(end)
        return
    c, s = math.cos(math.radians(given[2])), math.sin(math.radians(given[2]))
    dx, dy = (start[0] - end[0]) / 2, (start[1] - end[1]) / 2
    x, y = (c * dx + s * dy) / rx, (c * dy - s * dx) / ry  # unit circle, from mid-chord
    reach = math.hypot(x, y)
    if reach > 1:
        rx, ry, x, y = rx * reach, ry * reach, x / reach, y / reach
    away = math.sqrt(max(0.0, 1 - x * x - y * y)) / math.hypot(x, y)
    if (given[3] != 0) == (given[4] != 0):
        away = -away
    u, v = away * y, -away * x  # the centre
    begin = math.atan2(y - v, x - u)
    sweep = math.atan2(-y - v, -x - u) - begin
    if given[4] and sweep < 0:
        sweep += 2 * math.pi
    elif not given[4] and sweep > 0:
        sweep -= 2 * math.pi
    major, minor = (c * rx, s * rx), (-s * ry, c * ry)
    centre = (
        (start[0] + end[0]) / 2 + u * major[0] + v * minor[0],
        (start[1] + end[1]) / 2 + u * major[1] + v * minor[1],
    )
    tracer.ellipse(centre, major, minor, begin, sweep, end)
