"""The proofs about two convex bodies, at least one of them a curved shape."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

from satcheck.report.certificate import AxisProof, Ends, NestedProof, OnBody, PointProof, Proof
from satcheck.report.values import Relation
from satcheck.verify.bodies import Placed
from satcheck.verify.curved import Curved
from satcheck.verify.evidence import axis, given, on_body, vector
from satcheck.verify.exact import Point, Rejected, cross, dot, sub
from satcheck.verify.roots import Reach, sign_of
from satcheck.verify.world import Exact


@dataclass(frozen=True, slots=True)
class CurvedPair:
    """Two convex bodies. A mesh that is exactly convex in its file counts as the hull of its world
    vertices."""

    a: Curved | Exact
    b: Curved | Exact

    def prove(
        self, relation: Relation | None, proof: Proof, beyond: Fraction, least: Fraction
    ) -> None:
        """Rejects a proof that does not prove the exact relation. A gap must be greater than
        `beyond` and at least `least`, world units."""
        match relation, proof:
            case "separated", AxisProof() as separation:
                n = axis(separation.axis)
                if self.gap(n, beyond) <= 0 or self.gap(n, least) < 0:
                    raise Rejected("the axis does not separate the bodies by as much as claimed")
            case "touching", AxisProof() as separation:
                self.prove_free(separation)
                a, b = self._points(given(separation.contact, "contact"))
                if a != b:
                    raise Rejected("the common point is not the same point on both bodies")
            case "penetrating", PointProof() as overlap:
                self._overlap(overlap)
                self._neither_holds(overlap)
            case "contains", NestedProof():
                _nested(self.a, self.b)
            case "inside", NestedProof():
                _nested(self.b, self.a)
            case _:
                raise Rejected(f"a certificate of this kind proves no relation {relation!r}")

    def prove_free(self, proof: Proof) -> None:
        """No common interior."""
        if not isinstance(proof, AxisProof):
            raise Rejected("a certificate of this kind proves no way out")
        if self.gap(axis(proof.axis)) < 0:
            raise Rejected("the bodies overlap along the axis")

    def gap(self, n: Point, length: Fraction = Fraction(0)) -> int:
        """The sign of the gap along n, from A to B, less a length, world units."""
        forth, back = reach(self.a, n), reach(self.b, (-n[0], -n[1], -n[2]))
        square = length * length * dot(n, n)
        less = [forth.p, back.p, *([square] if length > 0 else ())]
        return sign_of(-forth.q - back.q, less, [square] if length < 0 else ())

    def squared_gap(self, ends: Ends) -> Fraction:
        """The squared gap of two points, one of each body."""
        step = self._step(ends)
        return Fraction(dot(step, step))

    def prove_apart(self, ends: Ends, least: Fraction) -> None:
        """Rejects a narrower gap along these two points."""
        n = self._step(ends)
        if not any(n) or self.gap(n, least) < 0:
            raise Rejected("the gap is not shown to be as wide")

    def _points(self, ends: Ends) -> tuple[Point, Point]:
        return point_of(ends.a, self.a), point_of(ends.b, self.b)

    def _step(self, ends: Ends) -> Point:
        a, b = self._points(ends)
        return b[0] - a[0], b[1] - a[1], b[2] - a[2]

    def _overlap(self, proof: PointProof) -> None:
        """A point in the interior of one body and in the other, closed body. The other has an
        interior, so points nearby lie inside both."""
        a, b = self._points(proof.both)
        inner = (isinstance(x, Curved) and x.side(a) > 0 for x in (self.a, self.b))
        if a != b or not any(inner):
            raise Rejected("the point does not lie inside both")

    def _neither_holds(self, proof: PointProof) -> None:
        """Proves that neither contains the other: each reaches at least as far as the other along
        some axis, and one farther."""
        leads = []
        for n, x, y in ((proof.a_reaches, self.a, self.b), (proof.b_reaches, self.b, self.a)):
            mine, other = reach(x, axis(n)), reach(y, axis(n))
            leads.append(sign_of(mine.q - other.q, [other.p], [mine.p]))
        if min(leads) < 0 or max(leads) == 0:
            raise Rejected("the axes do not show that neither body lies inside the other")


def curved_pair_of(a: Placed, b: Placed) -> CurvedPair:
    """World units: one lattice is enough for the vertices of the one mesh at most."""
    bodies: list[Curved | Exact] = []
    for body in (a, b):
        if body.curved is not None:
            bodies.append(body.curved)
        elif body.world is None or not body.convex or body.world.is_flat:
            raise Rejected("a curved shape is certified against convex bodies only")
        else:
            bodies.append(Exact(body.world, body.world.lattice))
    return CurvedPair(bodies[0], bodies[1])


def reach(body: Curved | Exact, n: Point) -> Reach:
    """World units times the length of n."""
    if isinstance(body, Curved):
        return body.reach(n)
    return Reach(Fraction(body.extent(n)) / (1 << body.k))


def point_of(point: OnBody, body: Curved | Exact) -> Point:
    """World units."""
    if isinstance(body, Curved):
        p = vector(given(point.point, "point"))
        if body.side(p) < 0:
            raise Rejected("a point lies outside of its body")
        return p
    x, y, z = (c / (1 << body.k) for c in on_body(point, body, of_hull=True))
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
