"""Exact verdict, depth and distance of two small convex point sets, in integers and fractions.

No hull is computed. The axes are all normals of vertex triples of A and of B and all cross
products of vertex pairs of A with vertex pairs of B: a superset of the facet normals of the
Minkowski difference A - B. Every spare axis is a true projection and only repeats a bound. The
distance runs over all vertex-triangle and segment-segment pairs: a superset of the features.

Cost grows with the cube of the vertex count: meant for up to about 10 vertices each.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from fractions import Fraction
from itertools import combinations
from typing import Literal

Number = int | Fraction
Vector = tuple[Number, Number, Number]
Outcome = Literal["separated", "touching", "penetrating"]

_AXES: tuple[Vector, ...] = ((1, 0, 0), (0, 1, 0), (0, 0, 1))


def exact(points: Iterable[Sequence[float]]) -> list[Vector]:
    return [(Fraction(p[0]), Fraction(p[1]), Fraction(p[2])) for p in points]


def _integers(a: list[Vector], b: list[Vector]) -> tuple[list[Vector], list[Vector], int]:
    """Both sets times one common denominator: integers multiply far faster than fractions."""
    scale = 1
    for p in (*a, *b):
        for c in p:
            scale = max(scale, Fraction(c).denominator)  # powers of two: the largest is common

    def times(points: list[Vector]) -> list[Vector]:
        return [(int(p[0] * scale), int(p[1] * scale), int(p[2] * scale)) for p in points]

    return times(a), times(b), scale


def _sub(a: Vector, b: Vector) -> Vector:
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def dot(a: Vector, b: Vector) -> Number:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def _cross(a: Vector, b: Vector) -> Vector:
    return (
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    )


def _directions(points: list[Vector]) -> list[Vector]:
    return [_sub(q, p) for p, q in combinations(points, 2)]


def _rank(vectors: Iterable[Vector]) -> tuple[int, list[Vector]]:
    """Dimension of the span (0 to 3) and a basis of it."""
    basis: list[Vector] = []
    for v in vectors:
        if not basis:
            independent = any(v)
        elif len(basis) == 1:
            independent = any(_cross(basis[0], v))
        else:
            independent = dot(_cross(basis[0], basis[1]), v) != 0
        if independent:
            basis.append(v)
            if len(basis) == 3:
                break
    return len(basis), basis


def candidate_axes(a: list[Vector], b: list[Vector]) -> set[Vector]:
    """Axes that decide: normals of the facets of A - B among them, in the span of A - B and
    across it."""
    along_a, along_b = _directions(a), _directions(b)
    dimension, basis = _rank([*along_a, *along_b])
    axes = {_cross(u, v) for u in along_a for v in along_b}
    for points in (a, b):
        axes |= {_cross(_sub(q, p), _sub(r, p)) for p, q, r in combinations(points, 3)}
    if dimension == 2:
        normal = _cross(basis[0], basis[1])
        axes |= {_cross(normal, e) for e in (*along_a, *along_b)}
    elif dimension == 1:
        axes |= {basis[0], *(_cross(basis[0], e) for e in _AXES)}
        axes |= {_cross(basis[0], _cross(basis[0], e)) for e in _AXES}
    elif dimension == 0:
        axes |= set(_AXES)
    axes.discard((0, 0, 0))
    return axes | {(-n[0], -n[1], -n[2]) for n in axes}


def _overlap(a: list[Vector], b: list[Vector], axis: Vector) -> Number:
    return max(dot(axis, p) for p in a) - min(dot(axis, p) for p in b)


def exact_outcome(
    points_a: Iterable[Sequence[float]], points_b: Iterable[Sequence[float]]
) -> Outcome:
    """The exact relation of the two hulls, float64 coordinates taken as they are.

    "touching": a common point, but no common interior. Sets whose Minkowski difference is flat
    have no common interior.
    """
    a, b, _ = _integers(exact(points_a), exact(points_b))
    least = min(_overlap(a, b, axis) for axis in candidate_axes(a, b))
    if least < 0:
        return "separated"
    flat = _rank([*_directions(a), *_directions(b)])[0] < 3
    return "touching" if least == 0 or flat else "penetrating"


def exact_squared_depth(
    points_a: Iterable[Sequence[float]], points_b: Iterable[Sequence[float]]
) -> Fraction:
    """Square of the penetration depth; 0 when the hulls have no common interior."""
    a, b, scale = _integers(exact(points_a), exact(points_b))
    if _rank([*_directions(a), *_directions(b)])[0] < 3:
        return Fraction(0)
    squares = []
    for axis in candidate_axes(a, b):
        overlap = _overlap(a, b, axis)
        if overlap <= 0:
            return Fraction(0)
        squares.append(Fraction(overlap * overlap) / (dot(axis, axis) * scale * scale))
    return min(squares)


def _squared_point_segment(p: Vector, tail: Vector, head: Vector) -> Fraction:
    along, to = _sub(head, tail), _sub(p, tail)
    squared = dot(along, along)
    t = min(max(Fraction(dot(to, along)) / squared, Fraction(0)), Fraction(1)) if squared else 0
    gap = _sub(to, (along[0] * t, along[1] * t, along[2] * t))
    return Fraction(dot(gap, gap))


def _squared_point_face(p: Vector, triangle: tuple[Vector, Vector, Vector]) -> Fraction | None:
    """Squared height over the triangle; None when the foot lies outside it."""
    q, r, s = triangle
    normal = _cross(_sub(r, q), _sub(s, q))
    squared = dot(normal, normal)
    if squared == 0:
        return None
    for u, v in ((q, r), (r, s), (s, q)):
        if dot(_cross(_sub(v, u), _sub(p, u)), normal) < 0:
            return None
    height = dot(_sub(p, q), normal)
    return Fraction(height * height) / squared


def _squared_line_line(p: Vector, u: Vector, q: Vector, v: Vector) -> Fraction | None:
    """Squared distance of the segments p + [0, 1] u and q + [0, 1] v between inner points."""
    w = _sub(q, p)
    uu, vv, uv, uw, vw = dot(u, u), dot(v, v), dot(u, v), dot(u, w), dot(v, w)
    det = uu * vv - uv * uv
    s, t = uw * vv - vw * uv, uw * uv - vw * uu
    if det == 0 or not (0 <= s <= det and 0 <= t <= det):
        return None
    normal = _cross(u, v)
    height = dot(w, normal)
    return Fraction(height * height) / dot(normal, normal)


def exact_squared_distance(
    points_a: Iterable[Sequence[float]], points_b: Iterable[Sequence[float]]
) -> Fraction:
    """Square of the distance of two hulls that do not overlap."""
    a, b, scale = _integers(exact(points_a), exact(points_b))
    best = Fraction(dot(_sub(a[0], b[0]), _sub(a[0], b[0])))
    for points, others in ((a, b), (b, a)):
        for p in points:
            for tail, head in combinations(others, 2):
                best = min(best, _squared_point_segment(p, tail, head))
            for triangle in combinations(others, 3):
                height = _squared_point_face(p, triangle)
                best = best if height is None else min(best, height)
            for q in others:
                best = min(best, Fraction(dot(_sub(p, q), _sub(p, q))))
    for p, p2 in combinations(a, 2):
        for q, q2 in combinations(b, 2):
            height = _squared_line_line(p, _sub(p2, p), q, _sub(q2, q))
            best = best if height is None else min(best, height)
    return best / (scale * scale)
