"""Certificates of two convex bodies of which one at least is a curved shape: axes and points."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from fractions import Fraction
from typing import Any

import numpy as np

from satcheck.audit.body import PlacedBody
from satcheck.audit.pair import Pair
from satcheck.audit.stages.certificate.maker import (
    Maker,
    axis_of,
    exact_number,
    exact_point,
    leading_axes,
)
from satcheck.core.curved.exact.pair import proof_of
from satcheck.core.curved.signed import Signed, convex_pair
from satcheck.report.certificate import AxisProof, Ends, NestedProof, OnBody, PointProof, Proof
from satcheck.report.report import Finding
from satcheck.verify import Rejected
from satcheck.verify.curved import Curved
from satcheck.verify.exact import Point, cross, dot, point, sub
from satcheck.verify.pairs import AnyPair, vector
from satcheck.verify.world import Exact

Move = tuple[float, float, float]

# A point is pulled this far towards the middle of its body to be found inside, in turn.
PULLS = tuple(Fraction(1, 1 << k) for k in (128, 64, 40))


class CurvedMaker(Maker):
    """Raises Rejected if the bounds of a curved shape did not close."""

    def __init__(self, pair: Pair, finding: Finding) -> None:
        super().__init__(pair, finding)
        signed = convex_pair(pair.a, pair.b)
        if signed is None:
            raise Rejected("the bounds of a curved shape did not close")
        self.signed: Signed = signed
        self.proof, self.bits = proof_of(pair.a, pair.b, signed)

    def relation(self) -> Proof | None:
        exact = self.finding.exact_relation
        if exact in ("contains", "inside"):
            return NestedProof()
        if exact == "separated":
            return self.apart()
        if exact == "touching":
            if self.proof is None or self.proof.point is None:
                return None
            shared = _rational(self.proof.point, self.bits)
            contact = self._ends(shared, shared)
            return None if contact is None else AxisProof(axis_of(self.proof.axis), contact)
        return self._overlap() if exact == "penetrating" else None

    def hints(self) -> Iterator[Iterable[Any]]:
        if self.signed.normal is not None:
            yield self.signed.normal
        if self.proof is not None:
            yield self.proof.axis

    def _overlap(self) -> PointProof | None:
        both = next(filter(None, map(self._inside_both, self._inner_points())), None)
        if both is None:
            return None
        axes = self._axes(*_own_axes(self.placed.a), *_own_axes(self.placed.b))
        leads = leading_axes((axis, self.placed.lead(vector(axis))) for axis in axes)
        return None if leads is None else PointProof(both, *leads)

    def _inner_points(self) -> Iterator[Point]:
        if self.proof is not None and self.proof.outcome == "penetrating" and self.proof.point:
            yield _rational(self.proof.point, self.bits)
        a, b = self.signed.witness_a, self.signed.witness_b
        if a is not None and b is not None:
            for share in (Fraction(1, 2), Fraction(1, 4), Fraction(3, 4)):
                yield _between(point(a), point(b), share)
        for body in (self.placed.a, self.placed.b):
            if isinstance(body, Curved):
                yield point(body.image.origin)

    def _inside_both(self, p: Point) -> Ends | None:
        curved = [x for x in (self.placed.a, self.placed.b) if isinstance(x, Curved)]
        inner, closed = [x.side(p) > 0 for x in curved], [x.side(p) >= 0 for x in curved]
        return self._ends(p, p) if any(inner) and all(closed) else None

    def _ends(self, p: Point, q: Point) -> Ends | None:
        """p as a point of A, and q as one of B."""
        a, b = on_body(p, self.placed.a, self.pair.a), on_body(q, self.placed.b, self.pair.b)
        return None if a is None or b is None else Ends(a, b)

    def freed(self, _: AnyPair, move: Move) -> AxisProof | None:
        proof = proof_of(self.pair.a, self.pair.b, self.signed, move)[0]
        return None if proof is None else AxisProof(axis_of(proof.axis))

    def gap(self) -> Ends | None:
        """Points next to each other."""
        if self.proof is not None and self.proof.ends is not None:
            p, q = (_rational(end, self.bits) for end in self.proof.ends)
            return self._ends(p, q)
        if self.signed.witness_a is None or self.signed.witness_b is None:
            return None
        a = _pulled_in(point(self.signed.witness_a), self.placed.a, self.pair.a)
        b = _pulled_in(point(self.signed.witness_b), self.placed.b, self.pair.b)
        return None if a is None or b is None else Ends(a, b)


def on_body(p: Point, body: Curved | Exact, placed: PlacedBody) -> OnBody | None:
    """A point of the body; None: of the hull of a mesh, and p is not within it."""
    return in_hull(p, body, placed) if isinstance(body, Exact) else OnBody(point=exact_point(p))


def _own_axes(body: Curved | Exact) -> list[list[Any]]:
    """Along and against the columns of its matrix."""
    columns = body.image.columns if isinstance(body, Curved) else ()
    return [[way * c for c in column] for column in columns for way in (1, -1)]


def _pulled_in(p: Point, body: Curved | Exact, placed: PlacedBody) -> OnBody | None:
    """A point of the body next to a rounded one."""
    if isinstance(body, Exact):
        middle = _between(point(placed.bounds[0]), point(placed.bounds[1]), Fraction(1, 2))
    else:
        middle = point(body.image.origin)
    for share in (Fraction(0), *PULLS):
        q = _between(p, middle, share)
        if isinstance(body, Exact) or body.side(q) >= 0:
            found = on_body(q, body, placed)
            if found is not None:
                return found
    return None


def in_hull(p: Point, body: Exact, placed: PlacedBody) -> OnBody | None:
    """The point by weights on four vertices: one of the hull, and those of a face that it sees."""
    hull = placed.hull()
    rows = {tuple(v): k for k, v in enumerate((body.world.vertices + 0.0).tolist())}
    index = [rows.get(tuple(v)) for v in (np.asarray(hull.vertices) + 0.0).tolist()]
    if None in index:
        return None
    scale = 1 << body.k
    apex = body.points[index[0]]  # type: ignore[index]
    q = sub(point(c * scale for c in p), apex)
    for face in hull.triangles.tolist():
        if 0 in face:
            continue
        u, v, w = (sub(body.points[index[k]], apex) for k in face)
        volume = dot(u, cross(v, w))
        if volume == 0:
            continue
        shares = [Fraction(dot(q, cross(s, t))) / volume for s, t in ((v, w), (w, u), (u, v))]
        weights = [1 - sum(shares, Fraction(0)), *shares]
        if min(weights) >= 0:
            ends = [(index[k], x) for k, x in zip((0, *face), weights, strict=True) if x]
            return OnBody(tuple(k for k, _ in ends), tuple(exact_number(x) for _, x in ends))
    return None


def _rational(p: tuple[int, int, int, int], bits: int) -> Point:
    return point(Fraction(c, p[3] << bits) for c in p[:3])


def _between(p: Point, q: Point, share: Fraction) -> Point:
    return point(c + share * (d - c) for c, d in zip(p, q, strict=True))
