"""The basic shapes of SVG and paths, as contours. Source: W3C, "SVG 1.1", chapters 8 and 9."""

from __future__ import annotations

import math
from xml.etree.ElementTree import Element

from msgspec.structs import replace

from satcheck.scene.drawing.contour import Contour, Tracer
from satcheck.scene.drawing.svg_path import contours_of
from satcheck.scene.drawing.svg_values import Viewport, bad, numbers, unread

SHAPES = frozenset({"circle", "ellipse", "line", "path", "polygon", "polyline", "rect"})


def outlines(
    kind: str, element: Element, viewport: Viewport, filled: bool
) -> tuple[list[Contour], bool]:
    """The closed contours, and whether an open line was left out. Raises MeshFileError."""
    if kind == "path":
        return contours_of(element.get("d", ""), filled)
    if kind in ("polygon", "polyline"):
        return _polygon(element, filled or kind == "polygon")
    sizes = _Sizes(element, viewport)
    if kind == "line":
        return [], True
    if kind == "rect":
        contour = _rectangle(sizes)
    elif kind == "circle":
        contour = _ellipse(sizes, sizes.size("r", "d"), sizes.size("r", "d"))
    else:
        rx, ry = sizes.size("rx", "x"), sizes.size("ry", "y")
        if (rx is None) != (ry is None):
            raise unread("an ellipse with only one radius: versions of SVG differ")
        contour = _ellipse(sizes, rx, ry)
    return [] if contour is None else [contour], False


class _Sizes:
    def __init__(self, element: Element, viewport: Viewport) -> None:
        self._element = element
        self._viewport = viewport

    def place(self, key: str, along: str) -> float:
        text = self._element.get(key)
        return 0.0 if text is None else self._viewport.length(text, along, key)

    def size(self, key: str, along: str) -> float | None:
        """None: not given, or "auto"."""
        text = self._element.get(key, "auto")
        if text.strip() == "auto":
            return None
        value = self._viewport.length(text, along, key)
        if value < 0:
            raise bad(f"{key}: {text.strip()} is negative")
        return value


def _polygon(element: Element, closed: bool) -> tuple[list[Contour], bool]:
    given = numbers(element.get("points", ""), "points")
    if len(given) % 2:
        raise bad("points: an odd number of coordinates")
    points = list(zip(given[::2], given[1::2], strict=True))
    if not points:
        return [], False
    if not (closed or points[0] == points[-1]):
        return [], True
    tracer = Tracer(points[0])
    tracer.points(points[1:], 0.0)
    contour = tracer.closed()
    return [] if contour is None else [contour], False


def _ellipse(sizes: _Sizes, rx: float | None, ry: float | None) -> Contour | None:
    if not rx or not ry:
        return None
    x, y = sizes.place("cx", "x"), sizes.place("cy", "y")
    tracer = Tracer((x + rx, y))
    tracer.ellipse((x, y), (rx, 0.0), (0.0, ry), 0.0, 2 * math.pi, tracer.here)
    contour = tracer.closed()
    return None if contour is None else replace(contour, inscribed=True)


def _rectangle(sizes: _Sizes) -> Contour | None:
    width, height = sizes.size("width", "x"), sizes.size("height", "y")
    if not width or not height:
        return None
    left, top = sizes.place("x", "x"), sizes.place("y", "y")
    right, bottom = left + width, top + height
    rx, ry = sizes.size("rx", "x"), sizes.size("ry", "y")
    rx, ry = (ry if rx is None else rx) or 0.0, (rx if ry is None else ry) or 0.0
    rx, ry = min(rx, width / 2), min(ry, height / 2)
    if not rx or not ry:
        tracer = Tracer((left, top))
        tracer.points([(right, top), (right, bottom), (left, bottom)], 0.0)
        return tracer.closed()
    tracer = Tracer((left + rx, top))
    corners = (
        ((right - rx, top), (right - rx, top + ry), (right, top + ry), -1),
        ((right, bottom - ry), (right - rx, bottom - ry), (right - rx, bottom), 0),
        ((left + rx, bottom), (left + rx, bottom - ry), (left, bottom - ry), 1),
        ((left, top + ry), (left + rx, top + ry), (left + rx, top), 2),
    )
    for begin, centre, end, quarter in corners:
        tracer.line(begin)
        start = quarter * math.pi / 2
        tracer.ellipse(centre, (rx, 0.0), (0.0, ry), start, math.pi / 2, end)
    return tracer.closed()
