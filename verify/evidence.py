"""The values of certificates: numbers, points and axes, as read from JSON."""

from __future__ import annotations

import re
from fractions import Fraction
from typing import Any

from satcheck.verify.exact import Point, Rejected, dot
from satcheck.verify.world import Exact

# An exponent could ask for a number of any length.
NUMBER = re.compile(r"-?[0-9]{1,4000}(/[0-9]{1,4000})?")


def member(value: Any, key: str) -> Any:
    if not isinstance(value, dict) or key not in value:
        raise Rejected(f"the certificate has no {key!r}")
    return value[key]


def rational(value: Any) -> Fraction:
    """A JSON number, or "numerator/denominator" as text."""
    if isinstance(value, bool) or not isinstance(value, int | float | str):
        raise Rejected("a number is expected")
    if isinstance(value, str) and not NUMBER.fullmatch(value):
        raise Rejected("a number is expected")
    try:
        return Fraction(value)
    except (ValueError, OverflowError, ZeroDivisionError):
        raise Rejected("a number is expected") from None


def vector(value: Any) -> Point:
    if not isinstance(value, list) or len(value) != 3:
        raise Rejected("three numbers are expected")
    return rational(value[0]), rational(value[1]), rational(value[2])


def axis(value: Any) -> Point:
    found = vector(value)
    if not any(found):
        raise Rejected("an axis of length 0")
    return found


def index(value: Any, count: int) -> int:
    if isinstance(value, bool) or not isinstance(value, int) or not 0 <= value < count:
        raise Rejected("an index is out of range")
    return value


def on_body(value: Any, body: Exact, *, of_hull: bool) -> Point:
    """{"vertices": [i, ...], "weights": [...]}: a convex combination of corners of one triangle, or
    of any vertices where the body is its own hull. On the lattice of the pair."""
    vertices, weights = member(value, "vertices"), member(value, "weights")
    if not isinstance(vertices, list) or not isinstance(weights, list):
        raise Rejected("a point on a body is a list of vertices and one of weights")
    if not 1 <= len(vertices) == len(weights) <= 4:
        raise Rejected("a point on a body has one to four vertices, each with a weight")
    chosen = [index(v, len(body.points)) for v in vertices]
    shares = [rational(w) for w in weights]
    if min(shares) < 0 or sum(shares) != 1:
        raise Rejected("weights are not negative and sum to 1")
    if not of_hull:
        triangle_of(chosen, body)
    points = [body.points[v] for v in chosen]
    x, y, z = (
        sum((w * p[k] for w, p in zip(shares, points, strict=True)), Fraction()) for k in range(3)
    )
    return x, y, z


def triangle_of(vertices: list[int], body: Exact) -> int:
    """A triangle that has all these corners."""
    found = (body.world.triangles[:, :, None] == vertices).any(axis=1).all(axis=1)
    if not found.any():
        raise Rejected("the vertices of a point on a surface are corners of one triangle")
    return int(found.argmax())


def gap_along(a: Exact, b: Exact, n: Point) -> Fraction:
    """min_B n.b - max_A n.a, world units times |n|: over 0 the axis separates."""
    forth, back = n, (-n[0], -n[1], -n[2])
    return Fraction(-b.extent(back) - a.extent(forth)) / (1 << a.k)


def exceeds(gap: Fraction, n: Point, length: Fraction) -> bool:
    """Whether a gap along n is more than this length."""
    return gap > 0 and gap * gap > length * length * dot(n, n)
