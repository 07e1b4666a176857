"""Certificates of two convex bodies of which one at least is a curved shape: axes and points."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from typing import Any

import numpy as np

from satcheck.audit.bodies.pair import Pair
from satcheck.audit.bodies.placed_body import PlacedBody
from satcheck.audit.certify.values import (
    AXES,
    NoCertificate,
    exact_number,
    exact_point,
    integer_axis,
    leading_axes,
    or_unset,
)
from satcheck.core.curved.exact.pair import proof_of
from satcheck.core.curved.signed import Signed, convex_pair
from satcheck.report.certificate import (
    AxisProof,
    Band,
    Certificate,
    Ends,
    ExactVector,
    NestedProof,
    OnBody,
    PointProof,
    Proof,
)
from satcheck.report.report import OVERLAPS, Finding
from satcheck.verify import Rejected
from satcheck.verify.curved import Curved
from satcheck.verify.curved_pair import CurvedPair, curved_pair_of, reach
from satcheck.verify.evidence import vector
from satcheck.verify.exact import Point, cross, dot
from satcheck.verify.roots import sign_of
from satcheck.verify.world import Exact

Move = tuple[float, float, float]

# A point is pulled this far towards the middle of its body to be found inside, in turn.
PULLS = tuple(Fraction(1, 1 << k) for k in (128, 64, 40))


def curved_certificate(pair: Pair, finding: Finding) -> Certificate | NoCertificate:
    try:
        maker = _Maker(pair, finding)
    except Rejected as why:
        return NoCertificate(str(why))
    relation = maker.relation()
    if relation is None:
        return NoCertificate(f"no evidence was found for {finding.exact_relation!r}")
    free = None
    if finding.mtv_verified and finding.mtv is not None:
        free = maker.free(finding.mtv)
        if free is None:
            return NoCertificate(
                "no axis was found that shows that the translation ends the overlap"
            )
    gap = band = None
    if finding.relation != finding.exact_relation:
        if finding.exact_relation in OVERLAPS:
            band = maker.band()
        else:
            gap = maker.gap()
    return Certificate(relation, mtv=or_unset(free), gap=or_unset(gap), band=or_unset(band))


class _Maker:
    def __init__(self, pair: Pair, finding: Finding) -> None:
        self.pair, self.finding = pair, finding
        self.checked = pair.a.checked(), pair.b.checked()
        self.placed = curved_pair_of(*self.checked)
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
            return self._apart()
        if exact == "touching":
            if self.proof is None or self.proof.point is None:
                return None
            contact = self._shared(_rational(self.proof.point, self.bits))
            return None if contact is None else AxisProof(integer_axis(self.proof.axis), contact)
        return self._overlap() if exact == "penetrating" else None

    def _axes(self, *hints: Any) -> Iterator[ExactVector]:
        """The simplest first."""
        yield from AXES
        for hint in (self.finding.normal, self.signed.normal, *hints):
            if hint is not None and any(hint):
                yield tuple(hint)
        if self.proof is not None:
            yield integer_axis(self.proof.axis)

    def _apart(self) -> AxisProof | None:
        """As wide as asked about."""
        beyond = least = Fraction(0)
        if self.finding.relation == "separated":
            beyond = Fraction(self.pair.tolerance)
            least = Fraction(self.pair.request.clearance or 0.0)
        for axis in self._axes():
            n = vector(list(axis))
            if _at_least(self.placed, n, beyond, 1) and _at_least(self.placed, n, least, 0):
                return AxisProof(axis)
        return None

    def _overlap(self) -> PointProof | None:
        both = next(filter(None, map(self._inside_both, self._inner_points())), None)
        if both is None:
            return None
        axes = self._axes(*_own_axes(self.placed.a), *_own_axes(self.placed.b))
        leads = leading_axes((axis, self._lead(vector(list(axis)))) for axis in axes)
        return None if leads is None else PointProof(both, *leads)

    def _lead(self, n: Point) -> int:
        """The sign of what A reaches beyond B along n."""
        mine, other = reach(self.placed.a, n), reach(self.placed.b, n)
        return sign_of(mine.q - other.q, [other.p], [mine.p])

    def _inner_points(self) -> Iterator[Point]:
        if self.proof is not None and self.proof.outcome == "penetrating" and self.proof.point:
            yield _rational(self.proof.point, self.bits)
        a, b = self.signed.witness_a, self.signed.witness_b
        if a is not None and b is not None:
            for share in (Fraction(1, 2), Fraction(1, 4), Fraction(3, 4)):
                yield _between(_exact(a), _exact(b), share)
        for body in (self.placed.a, self.placed.b):
            if isinstance(body, Curved):
                yield _exact(body.image.origin)

    def _inside_both(self, p: Point) -> Ends | None:
        curved = [x for x in (self.placed.a, self.placed.b) if isinstance(x, Curved)]
        inner, closed = [x.side(p) > 0 for x in curved], [x.side(p) >= 0 for x in curved]
        return self._shared(p) if any(inner) and all(closed) else None

    def _shared(self, p: Point) -> Ends | None:
        """A point as one of both bodies."""
        return self._ends(p, p)

    def _ends(self, p: Point, q: Point) -> Ends | None:
        """p as a point of A, and q as one of B."""
        a, b = on_body(p, self.placed.a, self.pair.a), on_body(q, self.placed.b, self.pair.b)
        return None if a is None or b is None else Ends(a, b)

    def free(self, move: Move) -> AxisProof | None:
        """That A, moved, has no common interior with B."""
        placed = curved_pair_of(self.checked[0].moved(list(move)), self.checked[1])
        for axis in self._axes([-c for c in move]):
            if _at_least(placed, vector(list(axis)), Fraction(0), 0):
                return AxisProof(axis)
        proof, _ = proof_of(self.pair.a, self.pair.b, self.signed, move)
        return None if proof is None else AxisProof(integer_axis(proof.axis))

    def band(self) -> Band | None:
        """An axis along which an overlap is within the tolerance."""
        tolerance = Fraction(self.pair.tolerance)
        for axis in self._axes():
            if _at_least(self.placed, vector(list(axis)), -tolerance, 0):
                return Band(axis)
        return None

    def gap(self) -> Ends | None:
        """Points next to each other."""
        if self.proof is not None and self.proof.ends is not None:
            p, q = (_rational(end, self.bits) for end in self.proof.ends)
            return self._ends(p, q)
        if self.signed.witness_a is None or self.signed.witness_b is None:
            return None
        a = _pulled_in(_exact(self.signed.witness_a), self.placed.a, self.pair.a)
        b = _pulled_in(_exact(self.signed.witness_b), self.placed.b, self.pair.b)
        return None if a is None or b is None else Ends(a, b)


def on_body(p: Point, body: Curved | Exact, placed: PlacedBody) -> OnBody | None:
    """A point of the body; None: of the hull of a mesh, and p is not within it."""
    return in_hull(p, body, placed) if isinstance(body, Exact) else OnBody(point=exact_point(p))


def _at_least(placed: CurvedPair, n: Point, length: Fraction, sign: int) -> bool:
    try:
        return placed.gap(n, length) >= sign
    except Rejected:
        return False


def _own_axes(body: Curved | Exact) -> list[list[Any]]:
    """Along and against the columns of its matrix."""
    columns = body.image.columns if isinstance(body, Curved) else ()
    return [[way * c for c in column] for column in columns for way in (1, -1)]


def _pulled_in(p: Point, body: Curved | Exact, placed: PlacedBody) -> OnBody | None:
    """A point of the body next to a rounded one."""
    if isinstance(body, Exact):
        low, high = (np.asarray(end) for end in placed.bounds)
        middle = _exact(tuple((low + high).tolist()))
        middle = (middle[0] / 2, middle[1] / 2, middle[2] / 2)
    else:
        middle = _exact(body.image.origin)
    for share in (Fraction(0), *PULLS):
        q = _between(p, middle, share)
        if isinstance(body, Exact) or body.side(q) >= 0:
            point = on_body(q, body, placed)
            if point is not None:
                return point
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
    q = tuple(c * scale - o for c, o in zip(p, apex, strict=True))
    for face in hull.triangles.tolist():
        if 0 in face:
            continue
        u, v, w = (
            tuple(c - o for c, o in zip(body.points[index[k]], apex, strict=True)) for k in face
        )
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
    x, y, z = (Fraction(c, p[3] << bits) for c in p[:3])
    return x, y, z


def _between(p: Point, q: Point, share: Fraction) -> Point:
    x, y, z = (c + share * (d - c) for c, d in zip(p, q, strict=True))
    return x, y, z


def _exact(v: tuple[float, ...]) -> Point:
    x, y, z = map(Fraction, v)
    return x, y, z
