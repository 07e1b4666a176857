"""What certificates prove of two convex bodies of which one at least is a curved shape."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from satcheck.verify.curved import Curved
from satcheck.verify.evidence import axis, member, on_body, vector
from satcheck.verify.exact import Point, Rejected, cross, dot, sub
from satcheck.verify.roots import Reach, sign_of
from satcheck.verify.world import Exact


@dataclass(frozen=True, slots=True)
class CurvedPair:
    """A mesh that is exactly convex in its file is taken as the hull of its world vertices."""

    a: Curved | Exact
    b: Curved | Exact

    def prove(self, relation: str, certificate: Any, beyond: Fraction, least: Fraction) -> None:
        """Rejects a certificate that does not prove the exact relation. A separation has to be over
        `beyond` and at least `least`, world units."""
        kind = member(certificate, "kind")
        if (relation, kind) == ("separated", "axis"):
            n = axis(member(certificate, "axis"))
            if self.gap(n, beyond) <= 0 or self.gap(n, least) < 0:
                raise Rejected("the axis does not separate the bodies by as much as claimed")
        elif (relation, kind) == ("touching", "axis"):
            self.prove_free(certificate)
            contact = member(certificate, "contact")
            if point_of(member(contact, "a"), self.a) != point_of(member(contact, "b"), self.b):
                raise Rejected("the common point is not the same point on both bodies")
        elif (relation, kind) == ("penetrating", "point"):
            self._overlap(certificate)
            self._neither_holds(certificate)
        elif (relation, kind) == ("contains", "nested"):
            _nested(self.a, self.b)
        elif (relation, kind) == ("inside", "nested"):
            _nested(self.b, self.a)
        else:
            raise Rejected(f"a certificate of this kind proves no relation {relation!r}")

    def prove_free(self, certificate: Any) -> None:
        """No common interior."""
        if member(certificate, "kind") != "axis":
            raise Rejected("a certificate of this kind proves no way out")
        if self.gap(axis(member(certificate, "axis"))) < 0:
            raise Rejected("the bodies overlap along the axis")

    def gap(self, n: Point, length: Fraction = Fraction(0)) -> int:
        """The sign of the gap along n, from A to B, less a length, world units."""
        forth, back = reach(self.a, n), reach(self.b, (-n[0], -n[1], -n[2]))
        square = length * length * dot(n, n)
        less = [forth.p, back.p, *([square] if length > 0 else ())]
        return sign_of(-forth.q - back.q, less, [square] if length < 0 else ())

    def squared_gap(self, certificate: Any) -> Fraction:
        """Of two points, one of each."""
        a = point_of(member(certificate, "a"), self.a)
        b = point_of(member(certificate, "b"), self.b)
        return Fraction(dot(step := tuple(q - p for p, q in zip(a, b, strict=True)), step))

    def prove_apart(self, ends: Any, least: Fraction) -> None:
        """Rejects a gap along these two points that is narrower than that."""
        a, b = point_of(member(ends, "a"), self.a), point_of(member(ends, "b"), self.b)
        n = b[0] - a[0], b[1] - a[1], b[2] - a[2]
        if not any(n) or self.gap(n, least) < 0:
            raise Rejected("the gap is not shown to be as wide")

    def _overlap(self, certificate: Any) -> None:
        """A point inside one of them, and of the other, which has an inside: next to it are points
        inside both."""
        p = member(certificate, "both")
        a, b = point_of(member(p, "a"), self.a), point_of(member(p, "b"), self.b)
        inner = (isinstance(x, Curved) and x.side(a) > 0 for x in (self.a, self.b))
        if a != b or not any(inner):
            raise Rejected("the point does not lie inside both")

    def _neither_holds(self, certificate: Any) -> None:
        """Each reaches as far as the other along some axis, one of them farther."""
        leads = []
        for key, x, y in (("a_reaches", self.a, self.b), ("b_reaches", self.b, self.a)):
            n = axis(member(certificate, key))
            mine, other = reach(x, n), reach(y, n)
            leads.append(sign_of(mine.q - other.q, [other.p], [mine.p]))
        if min(leads) < 0 or max(leads) == 0:
            raise Rejected("the axes do not show that neither body lies inside the other")


def reach(body: Curved | Exact, n: Point) -> Reach:
    """World units times the length of n."""
    if isinstance(body, Curved):
        return body.reach(n)
    return Reach(Fraction(body.extent(n)) / (1 << body.k))


def point_of(value: Any, body: Curved | Exact) -> Point:
    """World units: of a curved shape {"point": [x, y, z]}, of a mesh vertices and weights."""
    if isinstance(body, Curved):
        p = vector(member(value, "point"))
        if body.side(p) < 0:
            raise Rejected("a point lies outside of its body")
        return p
    x, y, z = (c / (1 << body.k) for c in on_body(value, body, of_hull=True))
    return x, y, z


def _nested(outer: Curved | Exact, inner: Curved | Exact) -> None:
    """Inner lies inside of outer, and does not reach its border."""
    if isinstance(outer, Curved):
        if isinstance(inner, Curved):
            raise Rejected("of two curved shapes it is not certified that one holds the other")
        used = (inner.points[k] for k in inner.world.used.tolist())
        scale = 1 << inner.k
        if not all(outer.side(tuple(Fraction(c, scale) for c in p)) > 0 for p in used):  # type: ignore[arg-type]
            raise Rejected("a vertex does not lie inside the curved shape")
        return
    assert isinstance(inner, Curved)
    for t in range(len(outer.world.triangles)):
        u, v, w = outer.corners(t)
        n = cross(sub(v, u), sub(w, u))
        if not any(n):
            continue
        exact: Point = (Fraction(n[0]), Fraction(n[1]), Fraction(n[2]))
        most = inner.reach(exact)
        if sign_of(Fraction(dot(n, u), 1 << outer.k) - most.q, [most.p]) <= 0:
            raise Rejected("the curved shape is not behind each face")
    x, y, z = (Fraction(c) * (1 << outer.k) for c in inner.image.origin)
    if not outer.winding((x, y, z)):
        raise Rejected("the curved shape lies outside of the mesh")
