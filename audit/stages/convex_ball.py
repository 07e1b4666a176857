"""Whether two convex bodies hold a ball of a given size together, in exact arithmetic.

The largest ball in both is the optimum of a linear program: its centre x and radius r meet
n . x + |n| r <= d for each face. The dual simplex method (C. E. Lemke, "The dual method of solving
the linear programming problem", 1954) keeps four faces that limit the radius, an upper bound at
each step, and exchanges one of them for a face that the ball crosses. Lengths of normals are
rounded down, so that the bound holds; the face of a large ball is tested without them.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from fractions import Fraction
from typing import TYPE_CHECKING, NamedTuple

from satcheck.verify.exact import IntVector, cross, dot, integers, lattice, root, sub

if TYPE_CHECKING:
    from satcheck.core import Polytope

MOST_FACES, MOST_STEPS = 4_000, 300
UNIT: tuple[IntVector, ...] = ((1, 0, 0), (0, 1, 0), (0, 0, 1))
BACK: tuple[IntVector, ...] = ((-1, 0, 0), (0, -1, 0), (0, 0, -1))
Rational = int | Fraction


class Side(NamedTuple):
    """The half space n . x <= d. length: of n, rounded down."""

    n: IntVector
    d: int
    length: Fraction


def holds_thicker_ball(a: Polytope, b: Polytope, diameter: float) -> bool | None:
    """Return whether a ball thicker than the diameter lies in both polytopes; None: it takes too
    many steps to tell."""
    if len(a.triangles) + len(b.triangles) > MOST_FACES:
        return None
    k = lattice(a.vertices, b.vertices)
    hulls = [(integers(hull.vertices, k), hull.triangles.tolist()) for hull in (a, b)]
    boxes = [side for points, _ in hulls for side in _sides_of_box(points)]
    faces = [side for hull in hulls for side in _sides_of_faces(*hull)]
    return _is_wider(boxes, faces, Fraction(diameter) * (1 << k) / 2)


def _sides_of_box(points: list[IntVector]) -> Iterator[Side]:
    for n in (*UNIT, *BACK):
        yield Side(n, max(dot(n, p) for p in points), Fraction(1))


def _sides_of_faces(points: list[IntVector], triangles: list[list[int]]) -> Iterator[Side]:
    for i, j, m in triangles:
        n = cross(sub(points[j], points[i]), sub(points[m], points[i]))
        if any(n):
            yield Side(n, dot(n, points[i]), root(Fraction(dot(n, n)))[0])


def _is_wider(boxes: list[Side], faces: list[Side], radius: Fraction) -> bool | None:
    """Return whether the largest ball has a larger radius."""
    holding, sides = _across_box(boxes), boxes + faces
    for _ in range(MOST_STEPS):
        weights = _weights(holding, (0, 0, 0, 1))
        if sum(w * side.d for w, side in zip(weights, holding, strict=True)) <= radius:
            return False
        *centre, r = _solved([[*side.n, side.length, side.d] for side in holding])
        crossed = max(sides, key=lambda side: _beyond(side, centre, r) / side.length)
        if _beyond(crossed, centre, r) <= 0:
            return all(_is_farther(side, centre, radius) for side in sides) or None
        enters = _weights(holding, (*crossed.n, crossed.length))
        leaving = min((i for i in range(4) if enters[i] > 0), key=lambda i: weights[i] / enters[i])
        holding[leaving] = crossed
    return None


def _across_box(boxes: list[Side]) -> list[Side]:
    """Return four sides of the common box, which limit the radius across its least extent."""
    box = [min((s for s in boxes if s.n == n), key=lambda s: s.d) for n in (*UNIT, *BACK)]
    least = min(range(3), key=lambda k: box[k].d + box[k + 3].d)
    return [*box[:3], box[least + 3]]


def _beyond(side: Side, centre: Sequence[Fraction], radius: Fraction) -> Fraction:
    """Return how far the ball lies beyond the side, times the length of its normal."""
    beyond: Fraction = dot(side.n, centre) + side.length * radius - side.d
    return beyond


def _is_farther(side: Side, centre: Sequence[Fraction], radius: Fraction) -> bool:
    """Return whether the centre lies deeper than the radius, by the true length of the normal."""
    deep = side.d - dot(side.n, centre)
    return bool(deep > 0 and deep * deep > radius * radius * dot(side.n, side.n))


def _weights(holding: list[Side], of: Sequence[Rational]) -> list[Fraction]:
    """Return what of the normals and lengths of four sides adds up to that."""
    columns = zip(*((*side.n, side.length) for side in holding), strict=True)
    return _solved([[*column, total] for column, total in zip(columns, of, strict=True)])


def _solved(rows: list[list[Rational]]) -> list[Fraction]:
    """Return the solution of linear equations, each with its right side last, by elimination."""
    table = [[Fraction(x) for x in row] for row in rows]
    for k in range(len(table)):
        pivot = next(i for i in range(k, len(table)) if table[i][k])
        table[k], table[pivot] = table[pivot], table[k]
        table[k] = [x / table[k][k] for x in table[k]]
        for i, row in enumerate(table):
            if i != k and row[k]:
                table[i] = [x - row[k] * y for x, y in zip(row, table[k], strict=True)]
    return [row[-1] for row in table]
