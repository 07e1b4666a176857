"""The common volume of two tetrahedra, by cutting one of them in rational numbers."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction

Point = tuple[Fraction, Fraction, Fraction]
Tetrahedron = list[Point]


def common_volume(a: Sequence[Sequence[float]], b: Sequence[Sequence[float]]) -> Fraction:
    """Four corners each, in any order; exact."""
    pieces, knife = [_exact(a)], _exact(b)
    for k in range(4):
        apex, (p, q, r) = knife[k], knife[:k] + knife[k + 1 :]
        inside = _determinant(p, q, r, apex)
        if inside == 0:
            return Fraction(0)
        pieces = [
            part
            for piece in pieces
            for part in _cut(piece, [_determinant(p, q, r, x) / inside for x in piece])
        ]
    return sum((abs(_determinant(*piece)) for piece in pieces), Fraction(0)) / 6


def _cut(corners: Tetrahedron, heights: list[Fraction]) -> list[Tetrahedron]:
    """The part with heights >= 0, as tetrahedra."""
    order = sorted(range(4), key=lambda i: heights[i], reverse=True)
    points, high = [corners[i] for i in order], [heights[i] for i in order]
    above = sum(h > 0 for h in high)

    def at(i: int, k: int) -> Point:
        t = high[i] / (high[i] - high[k])
        x, y, z = (c + t * (d - c) for c, d in zip(points[i], points[k], strict=True))
        return (x, y, z)

    if above == 0:
        return []
    if above == 4:
        return [points]
    if above == 1:
        return [[points[0], at(0, 1), at(0, 2), at(0, 3)]]
    if above == 3:
        return _prism((points[0], points[1], points[2]), (at(0, 3), at(1, 3), at(2, 3)))
    return _prism((points[0], at(0, 2), at(0, 3)), (points[1], at(1, 2), at(1, 3)))


def _prism(low: tuple[Point, Point, Point], high: tuple[Point, Point, Point]) -> list[Tetrahedron]:
    """Three tetrahedra between two triangles whose corners correspond."""
    (a, b, c), (d, e, f) = low, high
    return [[a, b, c, d], [b, c, d, e], [c, d, e, f]]


def _exact(corners: Sequence[Sequence[float]]) -> Tetrahedron:
    return [(Fraction(p[0]), Fraction(p[1]), Fraction(p[2])) for p in corners]


def _determinant(a: Point, b: Point, c: Point, d: Point) -> Fraction:
    u, v, w = (tuple(q - p for p, q in zip(a, x, strict=True)) for x in (b, c, d))
    return (
        u[0] * (v[1] * w[2] - v[2] * w[1])
        + u[1] * (v[2] * w[0] - v[0] * w[2])
        + u[2] * (v[0] * w[1] - v[1] * w[0])
    )
