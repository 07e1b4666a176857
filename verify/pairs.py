"""Two bodies of a pair, how they lie along an axis, and what certificates say of them: numbers,
points and axes, as read from JSON.

In a plane each body is the prism over its outline, |z| <= height, where z is normal to the plane.
Every height exceeds the width of every body. Two prisms relate as their outlines do, with the same
gap and depth. Only containment depends on the heights, which outlines do not have.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import TypeVar

import numpy as np
from msgspec import UnsetType

from satcheck.report.certificate import Ends, OnBody
from satcheck.report.certificate import Exact as Number
from satcheck.report.values import Relation
from satcheck.verify.bodies import Placed, curve_error
from satcheck.verify.curved import Curved
from satcheck.verify.exact import Point, Rejected, dot, point, sign_of, sub
from satcheck.verify.world import Exact, World, is_flat

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


@dataclass(frozen=True)
class AnyPair:
    """Two bodies. placed: of the report; none: of surfaces. Lengths are in world units."""

    a: Curved | Exact
    b: Curved | Exact
    placed: tuple[Placed, ...] = ()

    @property
    def convex(self) -> bool:
        """Whether both are exactly convex in their files. Then a mesh counts as the hull of its
        world vertices."""
        return bool(self.placed) and all(body.convex for body in self.placed)

    @property
    def closer(self) -> Fraction:
        """The `curve_error` of the bodies."""
        return curve_error(*self.placed)

    def gap(self, n: Point, length: Fraction = Fraction(0)) -> int:
        """The sign of the gap along n, from A to B, less a length: over 0 the axis separates."""
        forth, back = self.a.reach(n), self.b.reach((-n[0], -n[1], -n[2]))
        square = length * length * dot(n, n)
        less = [forth.p, back.p, *([square] if length > 0 else ())]
        return sign_of(-forth.q - back.q, less, [square] if length < 0 else ())

    def lead(self, n: Point) -> int:
        """The sign of what A reaches beyond B along n."""
        mine, other = self.a.reach(n), self.b.reach(n)
        return sign_of(mine.q - other.q, [other.p], [mine.p])

    def points(self, ends: Ends) -> tuple[Point, Point]:
        if not self.convex:
            raise Rejected("points are evidence of convex bodies only")
        return _point_of(ends.a, self.a), _point_of(ends.b, self.b)

    def step(self, ends: Ends) -> Point:
        """From the point of A to the point of B."""
        a, b = self.points(ends)
        return sub(b, a)


@dataclass(frozen=True)
class Pair(AnyPair):
    """Two meshes on one lattice. across: they are prisms of one height along this axis."""

    a: Exact
    b: Exact
    across: int | None = None


def pair_of(a: Placed, b: Placed, world_a: World, world_b: World) -> Pair:
    k = max(world_a.lattice, world_b.lattice)
    return Pair(Exact(world_a, k), Exact(world_b, k), (a, b))


def any_pair_of(a: Placed, b: Placed) -> AnyPair:
    if a.curved is None and b.curved is None:
        return pair_of(a, b, a.mesh, b.mesh)
    bodies: list[Curved | Exact] = []
    for body in (a, b):
        if body.curved is None and (not body.convex or is_flat(body.mesh.used[1])):
            raise Rejected("a curved shape is certified against convex bodies only")
        bodies.append(body.exact)
    return AnyPair(bodies[0], bodies[1], (a, b))


def _point_of(end: OnBody, body: Curved | Exact) -> Point:
    if isinstance(body, Exact):
        return point(c / body.scale for c in on_body(end, body, of_hull=True))
    p = vector(given(end.point, "point"))
    if body.side(p) < 0:
        raise Rejected("a point lies outside of its body")
    return p


def prisms(pair: Pair, relation: Relation | None, across: int) -> Pair:
    """A pair in a plane, with heights that suit the relation to be proven: a prism that is claimed
    to contain the other one gets the greater height. Otherwise both get the same height, and only
    their walls may separate them."""
    a, b = pair.a.world, pair.b.world
    height = max(float(world.bounds[1][across]) for world in (a, b))
    if relation in ("contains", "inside", "penetrating", "coincident"):
        a = _of_height(a, (1 + (relation == "contains")) * height, across)
        b = _of_height(b, (1 + (relation == "inside")) * height, across)
    of_a, of_b = pair.placed
    return replace(pair_of(of_a, of_b, a, b), across=across)


def _of_height(prism: World, height: float, across: int) -> World:
    vertices = prism.vertices.copy()
    vertices[:, across] = np.copysign(height, vertices[:, across])
    return World(vertices, prism.triangles, prism.solid)
