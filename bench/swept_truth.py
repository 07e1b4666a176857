"""When bodies that move along a line meet: exact, in rational numbers, and by no code of satcheck.

Two convex polytopes have a common point if and only if their projections overlap on each axis of
the separating axis theorem: the normals of their faces, and the cross products of their edges; for
flat ones also the directions across an edge in their plane. While one of them moves along a line,
each projection overlaps for an interval of t, whose ends are quotients of coordinates.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from fractions import Fraction
from itertools import combinations, product

from msgspec import Struct

# A point whose coordinates are integers times a scale that is common to both bodies.
Point = tuple[int, int, int]


class Convex(Struct, frozen=True):
    """A convex polytope, perhaps a single triangle. triangles: its faces, by their corners."""

    points: Sequence[Point]
    triangles: Sequence[tuple[int, int, int]]


class Meeting(Struct, frozen=True):
    """touch: the first t in [0, 1] with a common point; None: there is none. overlap: the limit of
    the t with a common interior from which on there is one; None: there is none."""

    touch: Fraction | None
    overlap: Fraction | None


def meeting(a: Iterable[Convex], move: Point, b: Iterable[Convex]) -> Meeting:
    """a, b: bodies as unions of convex pieces; A moves by t * move."""
    touches, overlaps = [], []
    for piece, other in product(a, b):
        touch, overlap = _of_pieces(piece, move, other)
        touches += [] if touch is None else [touch]
        overlaps += [] if overlap is None else [overlap]
    return Meeting(min(touches, default=None), min(overlaps, default=None))


def is_convex(body: Convex) -> bool:
    """Whether no point lies outside of a face."""
    for triangle in body.triangles:
        normal = _normal(body, triangle)
        height = _dot(normal, body.points[triangle[0]])
        if any(_dot(normal, p) > height for p in body.points):
            return False
    return True


def _of_pieces(a: Convex, move: Point, b: Convex) -> tuple[Fraction | None, Fraction | None]:
    start, end, strict = Fraction(0), Fraction(1), True
    for axis in _axes(a, b):
        first, last = _span(a, axis), _span(b, axis)
        ahead, behind, speed = last[0] - first[1], last[1] - first[0], _dot(axis, move)
        if speed == 0:
            if ahead > 0 or behind < 0:
                return None, None
            strict = strict and ahead < 0 < behind
            continue
        times = sorted((Fraction(ahead, speed), Fraction(behind, speed)))
        start, end = max(start, times[0]), min(end, times[1])
        if start > end:
            return None, None
    return start, start if strict and start < end else None


def _axes(a: Convex, b: Convex) -> set[Point]:
    normals = [_normal(body, triangle) for body in (a, b) for triangle in body.triangles]
    edges_a, edges_b = _edges(a), _edges(b)
    axes = normals + [_cross(e, f) for e, f in product(edges_a, edges_b)]
    for body, edges in ((a, edges_a), (b, edges_b)):
        if len(body.triangles) == 1:
            axes += [_cross(_normal(body, body.triangles[0]), edge) for edge in edges]
    return {axis for axis in axes if any(axis)}


def _edges(body: Convex) -> list[Point]:
    ends = {tuple(sorted(pair)) for t in body.triangles for pair in combinations(t, 2)}
    return [_minus(body.points[i], body.points[j]) for i, j in ends]


def _normal(body: Convex, triangle: tuple[int, int, int]) -> Point:
    p, q, r = (body.points[k] for k in triangle)
    return _cross(_minus(q, p), _minus(r, p))


def _span(body: Convex, axis: Point) -> tuple[int, int]:
    heights = [_dot(axis, p) for p in body.points]
    return min(heights), max(heights)


def _minus(p: Point, q: Point) -> Point:
    return p[0] - q[0], p[1] - q[1], p[2] - q[2]


def _cross(p: Point, q: Point) -> Point:
    return p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]


def _dot(p: Point, q: Point) -> int:
    return p[0] * q[0] + p[1] * q[1] + p[2] * q[2]
