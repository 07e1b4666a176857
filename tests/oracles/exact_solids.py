"""The exact relation of two small closed meshes by brute force, in integers and fractions.

Shares no code with the core. All triangles of both meshes cut each other: on every triangle the
lines of all others divide its plane, and each cell of that arrangement is sampled at one point,
with the winding numbers of both solids on both sides by rays. A solid is where its winding number
is not 0; contact is not told. Cost grows with the cube of the triangle count: meant for up to
about 30 in all.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from fractions import Fraction
from itertools import combinations, pairwise

Number = int | Fraction
Vector = tuple[Number, Number, Number]
Corners = tuple[Vector, Vector, Vector]
Line = tuple[Number, Number, Number]  # a u + b v = c in the triangle's own coordinates

# Directions of rays, tried in turn: no plane of small integer normals contains several of them.
_RAYS: tuple[Vector, ...] = ((1009, 283, 97), (-311, 877, 1201), (67, -1511, 449), (1, 613, -2003))


def _sub(p: Vector, q: Vector) -> Vector:
    return (p[0] - q[0], p[1] - q[1], p[2] - q[2])


def _dot(p: Vector, q: Vector) -> Number:
    return p[0] * q[0] + p[1] * q[1] + p[2] * q[2]


def _cross(p: Vector, q: Vector) -> Vector:
    return (p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0])


def _normal(t: Corners) -> Vector:
    return _cross(_sub(t[1], t[0]), _sub(t[2], t[0]))


def exact(mesh: Sequence[Sequence[Sequence[float]]]) -> list[Corners]:
    """Triangles with an area, as fractions."""
    triangles = [tuple((Fraction(x), Fraction(y), Fraction(z)) for x, y, z in t) for t in mesh]
    return [t for t in triangles if any(_normal(t))]  # type: ignore[misc, arg-type]


def winding(mesh: list[Corners], point: Vector, ray: Vector) -> int | None:
    """Of a point beside the mesh, along the ray; None when the ray meets an edge or runs in a face.

    A triangle that contains the point does not count.
    """
    total = 0
    for t in mesh:
        normal = _normal(t)
        height, speed = _dot(normal, _sub(t[0], point)), _dot(normal, ray)
        if height == 0:
            continue  # in the plane: met at the point, if anywhere
        if speed == 0 or height * speed < 0:
            continue
        sides = [_dot(_cross(_sub(t[(i + 1) % 3], t[i]), _sub(point, t[i])), ray) for i in range(3)]
        if min(sides) < 0 < max(sides):
            continue
        if 0 in sides:
            return None
        total += 1 if speed > 0 else -1
    return total


def beside(mesh: list[Corners], point: Vector, normal: Vector, side: int) -> int:
    """Winding number just off a generic point of a triangle with that normal, on that side."""
    for ray in _RAYS:
        towards = ray if _dot(ray, normal) * side > 0 else (-ray[0], -ray[1], -ray[2])
        found = winding(mesh, point, towards)
        if _dot(ray, normal) != 0 and found is not None:
            return found
    raise ArithmeticError("every ray meets an edge")


def _lines(t: Corners, others: list[Corners]) -> set[Line]:
    """The lines in which other planes, and edges in this plane, cut the plane of t.

    Coordinates: p = t[0] + u (t[1] - t[0]) + v (t[2] - t[0])."""
    normal, u, v = _normal(t), _sub(t[1], t[0]), _sub(t[2], t[0])
    lines: set[Line] = {(1, 0, 0), (0, 1, 0), (1, 1, 1)}
    for other in others:
        across = _normal(other)
        planes = [(across, other[0])]
        if not any(_cross(normal, across)):
            if _dot(normal, _sub(other[0], t[0])) != 0:
                continue
            planes = [(_cross(normal, _sub(q, p)), p) for p, q in combinations(other, 2)]
        for n, p in planes:
            lines.add(_scaled(_dot(n, u), _dot(n, v), _dot(n, _sub(p, t[0]))))
    return {line for line in lines if line[0] != 0 or line[1] != 0}


def _scaled(a: Number, b: Number, c: Number) -> Line:
    lead = a if a != 0 else b
    return (Fraction(a) / lead, Fraction(b) / lead, Fraction(c) / lead) if lead else (0, 0, 0)


def _cells(t: Corners, others: list[Corners]) -> Iterator[Vector]:
    """A point of every cell of the lines within t: between any two neighbouring crossings with a
    vertical line that runs between two neighbouring corners of the arrangement."""
    lines = _lines(t, others)
    stops = {Fraction(0), Fraction(1)}
    for (a, b, c), (d, e, f) in combinations(lines, 2):
        det = a * e - b * d
        if det != 0:
            stops.add(Fraction(c * e - b * f) / det)
    stops |= {Fraction(c) / a for a, b, c in lines if b == 0}
    between = sorted(s for s in stops if 0 <= s <= 1)
    for left, right in pairwise(between):
        u = (left + right) / 2
        heights = sorted({(c - a * u) / b for a, b, c in lines if b != 0})
        for low, high in pairwise(heights):
            v = (low + high) / 2
            if v > 0 and u + v < 1:
                p, along, up = t[0], _sub(t[1], t[0]), _sub(t[2], t[0])
                x, y, z = (p[k] + u * along[k] + v * up[k] for k in range(3))
                yield (x, y, z)


def combinations_met(a: list[Corners], b: list[Corners]) -> set[tuple[bool, bool]]:
    """Which of (in A, in B) occur somewhere in space."""
    met = {(False, False)}
    for t in (*a, *b):
        normal = _normal(t)
        for point in _cells(t, [*a, *b]):
            for side in (1, -1):
                met.add((beside(a, point, normal, side) != 0, beside(b, point, normal, side) != 0))
    return met
