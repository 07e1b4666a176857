"""Do two triangles cross, and still do when every corner moves a little? In rational numbers.

An edge pierces a triangle when its ends lie on two sides of the plane and the line of the edge
passes on one side of the three edges of the triangle: five signs of determinants (Möller, Trumbore,
"Fast, Minimum Storage Ray/Triangle Intersection", 1997, in exact arithmetic and with a margin).
Each determinant has to be larger than the change that the margin can cause. So a crossing that is
found here is none of rounding, of a placement, or of surfaces that only touch.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction

Vector = tuple[Fraction, Fraction, Fraction]
Triangle = Sequence[Sequence[float]]


def cross_for_sure(a: Triangle, b: Triangle, margin: float) -> bool:
    """Whether an edge of one triangle pierces the other for all corners within `margin` of these.

    a, b: three points each. Triangles that touch, or lie in one plane, do not cross for sure.
    """
    first, second = [_exact(p) for p in a], [_exact(p) for p in b]
    slack = Fraction(margin)
    return any(
        _pierces(edges[k - 1], edges[k], face, slack)
        for edges, face in ((first, second), (second, first))
        for k in range(3)
    )


def _pierces(p: Vector, q: Vector, face: Sequence[Vector], margin: Fraction) -> bool:
    a, b, c = face
    above, below = _sign(p, a, b, c, margin), _sign(q, a, b, c, margin)
    if above * below >= 0:
        return False
    turns = [_sign(p, q, *edge, margin) for edge in ((a, b), (b, c), (c, a))]
    return turns[0] != 0 and turns.count(turns[0]) == 3


def _sign(o: Vector, p: Vector, q: Vector, r: Vector, margin: Fraction) -> int:
    """Of the volume of a tetrahedron; 0 where corners that move by the margin can change it."""
    u, v, w = _sub(p, o), _sub(q, o), _sub(r, o)
    volume = (
        u[0] * (v[1] * w[2] - v[2] * w[1])
        + u[1] * (v[2] * w[0] - v[0] * w[2])
        + u[2] * (v[0] * w[1] - v[1] * w[0])
    )
    # |det| changes by at most (L + e)^3 - L^3, where each vector has a length of at most L and
    # changes by at most e: twice the margin, for both of its ends move.
    length = max(sum(abs(x) for x in vector) for vector in (u, v, w))
    change = 2 * margin
    if abs(volume) <= (length + change) ** 3 - length**3:
        return 0
    return 1 if volume > 0 else -1


def _exact(p: Sequence[float]) -> Vector:
    return (Fraction(float(p[0])), Fraction(float(p[1])), Fraction(float(p[2])))


def _sub(a: Vector, b: Vector) -> Vector:
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])
