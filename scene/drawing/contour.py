"""Closed contours in the plane, and how curves become polygons."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterable
from typing import Literal

from msgspec import Struct

from satcheck.scene.errors import MeshFileError

Point = tuple[float, float]
# (a, b, c, d, e, f): x' = a x + b y + c, y' = d x + e y + f.
Affine = tuple[float, float, float, float, float, float]
FillRule = Literal["nonzero", "evenodd"]

# The largest distance between a polygon and its curve, relative to the size of the curve. The
# precision of the input includes it: contacts within it count as touching.
FLATNESS = 2.0**-14
MAX_SEGMENTS = 4096  # of one curve


class Contour(Struct, frozen=True):
    """A closed polygon, drawing units; the last corner joins the first.

    deviation: the largest distance to the curve that it replaces; 0.0: it is exact. inscribed: it
    lies within that curve, like a polygon in a circle.
    """

    points: tuple[Point, ...]
    deviation: float = 0.0
    inscribed: bool = False

    def mapped(self, affine: Affine) -> Contour:
        """The image of the contour. Raises MeshFileError if a coordinate is not finite."""
        a, b, c, d, e, f = affine
        points = tuple((a * x + b * y + c, d * x + e * y + f) for x, y in self.points)
        refuse_non_finite(points)
        return Contour(points, self.deviation * _stretch(a, b, d, e), self.inscribed)


class DrawnShape(Struct, frozen=True):
    """The area inside the contours by the fill rule, and inside each of `filled`."""

    name: str
    contours: tuple[Contour, ...]
    rule: FillRule
    filled: tuple[Contour, ...] = ()


class RefusedShape(Struct, frozen=True, tag=True):
    """A shape that cannot be read; the others still can. code: of `issue.CODES`."""

    name: str
    code: str
    message: str


class Drawing(Struct, frozen=True):
    """units: of its coordinates, if the file states them. ignored: a text for each kind of content
    that was left out."""

    shapes: tuple[DrawnShape | RefusedShape, ...]
    units: str | None
    ignored: tuple[str, ...]


class Tracer:
    """Collects the corners of one contour; curves add corners that lie on them."""

    def __init__(self, start: Point) -> None:
        self._points = [start]
        self._deviation = 0.0

    @property
    def here(self) -> Point:
        return self._points[-1]

    def line(self, end: Point) -> None:
        self._points.append(end)

    def bezier(self, controls: list[Point]) -> None:
        """controls: the rest of a quadratic (2) or cubic (3) Bezier curve that starts here.

        A chord over 1/n of the parameter deviates by at most max |B''| / (8 n^2), and |B''| by no
        more than d (d - 1) times the largest second difference of the controls.
        """
        hull = [self.here, *controls]
        degree = len(hull) - 1
        bend = max(
            math.hypot(p[0] - 2 * q[0] + r[0], p[1] - 2 * q[1] + r[1])
            for p, q, r in zip(hull, hull[1:], hull[2:], strict=False)
        )
        most = degree * (degree - 1) * bend / 8
        n = _segments(math.sqrt(most / _flat(hull)) if most > 0 else 1)
        self._points += [_on_bezier(hull, k / n) for k in range(1, n)]
        self._points.append(hull[-1])
        self._deviation = max(self._deviation, most / n**2)

    def ellipse(
        self, centre: Point, major: Point, minor: Point, start: float, sweep: float, end: Point
    ) -> None:
        """The arc centre + cos(t) major + sin(t) minor, t from start over sweep radians, to `end`.

        It is the image of a circle under a map that stretches no length by more than the larger
        half axis (they are perpendicular), so a chord over an angle w deviates by at most that
        times 1 - cos(w / 2). The distance of the given ends from the ellipse is added.
        """

        def at(t: float) -> Point:
            c, s = math.cos(t), math.sin(t)
            return (
                centre[0] + c * major[0] + s * minor[0],
                centre[1] + c * major[1] + s * minor[1],
            )

        off = max(math.dist(at(start), self.here), math.dist(at(start + sweep), end))
        radius = max(math.hypot(*major), math.hypot(*minor))
        step = 2 * math.acos(1 - FLATNESS)
        n = _segments(abs(sweep) / step)
        self._points += [at(start + sweep * k / n) for k in range(1, n)]
        self._points.append(end)
        deviation = radius * (1 - math.cos(sweep / n / 2)) + off
        self._deviation = max(self._deviation, deviation)

    def points(self, corners: list[Point], deviation: float) -> None:
        """Adds corners that a library placed on a curve."""
        self._points += corners
        self._deviation = max(self._deviation, deviation)

    def closed(self) -> Contour | None:
        """The contour, equal neighbours merged; None when fewer than 3 corners are left."""
        corners = [p for p, q in zip(self._points, self._rotated(), strict=True) if p != q]
        refuse_non_finite(corners)
        return Contour(tuple(corners), self._deviation) if len(corners) >= 3 else None

    def _rotated(self) -> list[Point]:
        return [*self._points[1:], self._points[0]]


def _stretch(a: float, b: float, d: float, e: float) -> float:
    """A bound on how far the map stretches a length: the square of the largest singular value of M
    is at most the largest row sum of |M^T M|."""
    largest = max(map(abs, (a, b, d, e)))
    if largest == 0:
        return 0.0
    a, b, d, e = (c / largest for c in (a, b, d, e))
    return largest * math.sqrt(max(a * a + d * d, b * b + e * e) + abs(a * b + d * e))


def refuse_non_finite(points: Iterable[Point]) -> None:
    if any(not math.isfinite(c) for p in points for c in p):
        raise MeshFileError("non-finite", "non-finite coordinates")


def _segments(wanted: float) -> int:
    return min(MAX_SEGMENTS, max(1, math.ceil(wanted))) if math.isfinite(wanted) else 1


def _flat(hull: list[Point]) -> float:
    size = max(math.dist(hull[0], p) for p in hull[1:])
    return FLATNESS * size if size > 0 else 1.0


def _on_bezier(hull: list[Point], t: float) -> Point:
    """De Casteljau."""
    level = hull
    while len(level) > 1:
        level = [
            (p[0] + t * (q[0] - p[0]), p[1] + t * (q[1] - p[1]))
            for p, q in itertools.pairwise(level)
        ]
    return level[0]
