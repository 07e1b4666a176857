"""The values of certificates: numbers, points and axes, as read from JSON."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import TypeVar

from msgspec import UnsetType

from satcheck.report.certificate import Exact as Number
from satcheck.report.certificate import OnBody
from satcheck.verify.exact import Point, Rejected, point
from satcheck.verify.world import Exact

Part = TypeVar("Part")


def given(part: Part | UnsetType, name: str) -> Part:
    """A part of a certificate. Rejects one that is left out."""
    if isinstance(part, UnsetType):
        raise Rejected(f"the certificate has no {name!r}")
    return part


def rational(number: Number) -> Fraction:
    try:
        return Fraction(number)
    except ZeroDivisionError:
        raise Rejected("a number over 0 is none") from None


def vector(numbers: Sequence[Number]) -> Point:
    return point(map(rational, numbers))


def axis(numbers: Sequence[Number]) -> Point:
    direction = vector(numbers)
    if not any(direction):
        raise Rejected("an axis of length 0")
    return direction


def index(number: int, count: int) -> int:
    if not 0 <= number < count:
        raise Rejected("an index is out of range")
    return number


def on_body(end: OnBody, body: Exact, *, of_hull: bool) -> Point:
    """A convex combination of the corners of one triangle, or of any vertices if the body is
    convex. On the lattice of the pair."""
    vertices, weights = given(end.vertices, "vertices"), given(end.weights, "weights")
    if not 1 <= len(vertices) == len(weights) <= 4:
        raise Rejected("a point on a body has one to four vertices, each with a weight")
    chosen = [index(v, len(body.points)) for v in vertices]
    shares = [rational(w) for w in weights]
    if min(shares) < 0 or sum(shares) != 1:
        raise Rejected("weights are not negative and sum to 1")
    corners = body.world.triangles[:, :, None] == chosen
    if not of_hull and not corners.any(axis=1).all(axis=1).any():
        raise Rejected("the vertices of a point on a surface are corners of one triangle")
    points = [body.points[v] for v in chosen]
    return point(sum(w * p[k] for w, p in zip(shares, points, strict=True)) for k in range(3))
