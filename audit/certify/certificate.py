"""The certificate of a finding: one part for each claim, checked before it is returned."""

from __future__ import annotations

import math
from collections.abc import Iterator
from fractions import Fraction

from msgspec import UNSET
from msgspec.structs import replace

from satcheck import core
from satcheck.audit.bodies.pair import Pair
from satcheck.audit.certify import overlaps
from satcheck.audit.certify.cover import cover
from satcheck.audit.certify.curved import curved_certificate
from satcheck.audit.certify.thickness import cells, excuse
from satcheck.audit.certify.values import (
    AXES,
    NoCertificate,
    exact_number,
    integer_axis,
    leading_axes,
    or_unset,
)
from satcheck.audit.figures.exact_hulls import Expanded, expanded, nearest_point, shortened
from satcheck.audit.finding import Examined
from satcheck.core.conventions import axis_across
from satcheck.report.certificate import (
    AxisProof,
    Band,
    Cells,
    Certificate,
    Cover,
    DepthProof,
    Ends,
    ExactVector,
    OnBody,
    Polytope,
    PolytopeProof,
    Proof,
    SameProof,
    SurfacesProof,
)
from satcheck.report.report import OVERLAPS, Finding
from satcheck.report.request import Request
from satcheck.report.values import Vector
from satcheck.verify import Rejected
from satcheck.verify.bodies import Placed
from satcheck.verify.distances import check_distance
from satcheck.verify.evidence import exceeds, gap_along, vector
from satcheck.verify.figures import EXACT_WIDTH
from satcheck.verify.findings import check_finding, depth_at_most
from satcheck.verify.in_plane import curve_error, reaching
from satcheck.verify.relations import pair_of

SURFACES = SurfacesProof()


def certified(pair: Pair, examined: Examined) -> Certificate | NoCertificate:
    """A certificate that the checker accepts, or why there is none."""
    finding = examined.finding
    if finding.exact_relation is None:
        return NoCertificate("the relation is not proven")
    a, b = pair.a.checked(), pair.b.checked()
    if pair.curved:
        certificate = curved_certificate(pair, finding)
    else:
        certificate = _Maker(pair, examined).certificate()
    if isinstance(certificate, NoCertificate):
        return certificate
    why = _refusal(replace(finding, certificate=certificate), a, b, pair.request)
    if why is not None and certificate.thickness is not UNSET:  # it may be that alone
        certificate = replace(certificate, thickness=UNSET)
        why = _refusal(replace(finding, certificate=certificate), a, b, pair.request)
    return certificate if why is None else NoCertificate(f"what was found does not prove it: {why}")


def _refusal(finding: Finding, a: Placed, b: Placed, request: Request) -> str | None:
    try:
        check_finding(finding, a, b, request)
    except Rejected as why:
        return str(why)
    return None


class _Maker:
    def __init__(self, pair: Pair, examined: Examined) -> None:
        self.pair, self.draft, self.finding = pair, examined.draft, examined.finding
        a, b = pair.a.checked(), pair.b.checked()
        self.a, self.b = a, b
        self.worlds = a.mesh, b.mesh
        self.placed = self.ends = pair_of(a, b, *self.worlds)
        plane = pair.settings.planar
        self.closer = curve_error(a, b)
        self.across = None if plane is None else axis_across(plane)
        if self.across is not None:
            relation = self.finding.exact_relation
            self.ends = pair_of(a, b, *reaching(relation, *self.worlds, self.across))

    def certificate(self) -> Certificate | NoCertificate:
        finding = self.finding
        relation = self._relation()
        if relation is None:
            return NoCertificate(f"no evidence was found for {finding.exact_relation!r}")
        band: Band | None = None
        gap: Ends | None = None
        if finding.relation != finding.exact_relation:
            if finding.exact_relation == "separated":
                gap = self._gap()
            elif finding.exact_relation in OVERLAPS:
                within = self._band()
                if isinstance(within, NoCertificate):
                    return within
                band = within
        return Certificate(
            relation,
            mtv=or_unset(self._mtv()),
            depth=or_unset(self._depth()),
            distance=or_unset(self._distance()),
            cover=or_unset(self._cover()),
            thickness=or_unset(self._cells()),
            gap=or_unset(gap),
            band=or_unset(band),
        )

    def _relation(self) -> Proof | None:
        exact, placed = self.finding.exact_relation, self.ends
        if exact == "separated":
            return self._apart()
        if exact == "touching":
            return self._touching()
        solids = placed.a.world.solid + placed.b.world.solid
        if exact in ("contains", "inside", "coincident"):
            inner = overlaps.inside_both(placed) if solids else None
            both = UNSET if inner is None else inner
            return SameProof(both) if exact == "coincident" else SurfacesProof(both=both)
        proof = self._hulls_overlap() if solids == 2 else None
        if proof is not None:
            return proof
        hint = self._crossing()
        overlap = None
        if solids == 2:
            overlap = overlaps.overlap(placed, hint, across=self.across)
        elif solids:
            overlap = overlaps.sheet_overlap(placed, hint)
        return overlap or overlaps.crossing(placed, hint)

    def _crossing(self) -> tuple[int, int] | None:
        """Triangles that meet. A lower rung may have settled the pair without any."""
        climb = self.draft.verdict.climb
        if climb is not None and climb.triangles is not None:
            return climb.crossing
        relation = core.mesh_relation(self.pair.a.surface(), self.pair.b.surface())
        if relation.triangle_a < 0 or relation.triangle_b < 0:
            return None
        return relation.triangle_a, relation.triangle_b

    def _hulls(self) -> core.PairResult:
        """Prove how the hulls of the bodies are apart; a lower rung may have settled the pair."""
        climb = self.draft.verdict.climb
        if climb is not None and climb.hulls is not None:
            return climb.hulls
        return core.check_pair(self.pair.a.hull_shape(), self.pair.b.hull_shape(), query="distance")

    def _axes(self) -> Iterator[ExactVector]:
        """Candidates for a separating axis, from A to B, the simplest first."""
        yield from AXES
        if self.finding.normal is not None:
            yield self.finding.normal
        normal = self._hulls().normal
        if normal is not None:
            yield normal

    def _apart(self) -> AxisProof | SurfacesProof:
        """A separation of the hulls as wide as requested, or the surfaces themselves."""
        least = Fraction(0)
        if self.finding.relation == "separated":
            least = max(Fraction(self.pair.tolerance), Fraction(self.pair.request.clearance or 0.0))
        least += self.closer
        for axis in self._axes():
            if self._separates(axis, least):
                return AxisProof(axis)
        if self._hulls().outcome != "separated":
            return SURFACES
        x, y, z = nearest_point(self.placed).point
        # The nearest point of A - B leads from B to A.
        direction = integer_axis(shortened((-x, -y, -z)))
        return AxisProof(direction) if self._separates(direction, least) else SURFACES

    def _separates(self, axis: ExactVector, least: Fraction) -> bool:
        """Return whether the gap along the axis is wider than that."""
        n = vector(list(axis))
        return any(n) and exceeds(gap_along(self.placed.a, self.placed.b, n), n, least)

    def _touching(self) -> AxisProof | SurfacesProof | None:
        placed = self.placed
        if placed.convex:
            outside = expanded(placed, Fraction(0))
            nearest = nearest_point(placed)
            if outside is not None and not outside.overlaps and not any(nearest.point):
                axis = integer_axis(shortened(outside.axis))
                return AxisProof(axis, _on_hulls(nearest.weights))
        contact = overlaps.boundary_contact(placed, self._crossing())
        return None if contact is None else SurfacesProof(contact)

    def _hulls_overlap(self) -> PolytopeProof | None:
        """For convex bodies that stick out of each other."""
        if not self.placed.convex:
            return None
        inner = expanded(self.ends, Fraction(0))
        if inner is None or not inner.overlaps:
            return None
        leads = leading_axes(
            (axis, self._lead(axis)) for k, axis in enumerate(AXES) if k // 2 != self.across
        )
        if leads is None:
            return None
        return PolytopeProof(tuple(inner.vertices), tuple(inner.faces), *leads)

    def _lead(self, axis: ExactVector) -> Fraction:
        """Return how far A reaches beyond B along the axis, on the lattice."""
        n = vector(list(axis))
        return Fraction(self.ends.a.extent(n) - self.ends.b.extent(n))

    def _depth(self) -> DepthProof | None:
        """Certify the depth of convex bodies."""
        bounds, normal = self.finding.depth_bounds, self.finding.normal
        if bounds is None or not self.placed.convex:
            return None
        lower, limit = Fraction(bounds[0]), Fraction(bounds[1]) - self.closer
        inner = expanded(self.placed, lower)
        if inner is None or not inner.overlaps:
            return None
        if normal is not None and depth_at_most(vector(list(normal)), self.placed, limit):
            return DepthProof(_polytope(inner), normal)
        complete = expanded(self.placed, limit * 2) or inner
        return DepthProof(_polytope(inner), integer_axis(shortened(complete.axis)))

    def _cover(self) -> Cover | None:
        """Certify the depth of bodies that are not both convex."""
        bounds = self.finding.depth_bounds
        if bounds is None or self.placed.convex:
            return None
        return cover(self.placed, Fraction(bounds[0]))

    def _cells(self) -> Cells | None:
        """Certify the thickness of an overlap that is thinner than it is deep."""
        thickness, finding = self.draft.thickness, self.finding
        if thickness is None or thickness.proof is None:
            return None
        if finding.mtv_verified and finding.depth is not None and thickness.upper >= finding.depth:
            return None
        return cells(thickness.proof)

    def _mtv(self) -> Proof | None:
        if not self.finding.mtv_verified or self.finding.mtv is None:
            return None
        proof = self._free(self.finding.mtv, self.closer)
        return None if self.closer and proof is SURFACES else proof

    def _free(self, move: Vector, least: Fraction = Fraction(0)) -> Proof:
        """Prove that A, moved, has no common interior with B. least: of the gap along an axis."""
        world = self.worlds[0].moved(move)
        placed = pair_of(self.a, self.b, world, self.worlds[1])
        x, y, z = move
        length = math.hypot(x, y, z)
        hints: list[ExactVector] = [(-x / length, -y / length, -z / length)] if length else []
        if self.finding.normal is not None:
            hints.append(self.finding.normal)
        for axis in (*hints, *AXES):
            n = vector(list(axis))
            gap = gap_along(placed.a, placed.b, n)
            if any(n) and (exceeds(gap, n, least) if least else gap >= 0):
                return AxisProof(axis)
        if placed.convex:
            outside = expanded(placed, Fraction(0))
            if outside is not None and not outside.overlaps:
                return AxisProof(integer_axis(shortened(outside.axis)))
        return SURFACES

    def _distance(self) -> Ends | None:
        """Points next to each other, where few triangles could be nearer than these."""
        if not self.finding.distance or self.closer:
            return None
        ends = self._gap()
        try:
            check_distance(self.finding.distance, ends, self.placed)
        except Rejected:
            return None
        return ends

    def _gap(self) -> Ends:
        """Points that show how close separated bodies are."""
        if self.placed.convex:
            return _on_hulls(nearest_point(self.placed).weights)
        return self._nearest()

    def _band(self) -> Band | NoCertificate | None:
        """Why an overlap is within the touch band."""
        finding = self.finding
        if (
            finding.mtv_verified
            and finding.depth is not None
            and finding.depth <= self.pair.tolerance
        ):
            return None
        if self.placed.convex:
            inner = expanded(self.placed, Fraction(self.pair.tolerance) * 2)
            axis = None if inner is None else integer_axis(shortened(inner.axis))
            band = Fraction(self.pair.tolerance) * (1 + EXACT_WIDTH)
            if axis is not None and depth_at_most(vector(list(axis)), self.placed, band):
                return Band(axis)
        move = None if self.draft.band is None else self.draft.band.move
        if move is not None:
            return Band(move=move, free=self._free(move))
        explained = excuse(self.pair)
        return explained if isinstance(explained, NoCertificate) else Band(excuse=explained)

    def _nearest(self) -> Ends:
        """Points next to each other, on the nearest triangles."""
        climb = self.draft.verdict.climb
        near = None if climb is None else climb.gap
        if near is None or near.triangle_a < 0:
            near = core.mesh_distance(self.pair.a.surface(), self.pair.b.surface())
        return overlaps.nearest_points(self.placed, near.triangle_a, near.triangle_b)


def _polytope(expansion: Expanded) -> Polytope:
    return Polytope(tuple(expansion.vertices), tuple(expansion.faces))


def _on_hulls(weights: dict[tuple[int, int], Fraction]) -> Ends:
    a, b = (_on_hull(weights, side) for side in (0, 1))
    return Ends(a, b)


def _on_hull(weights: dict[tuple[int, int], Fraction], side: int) -> OnBody:
    shares: dict[int, Fraction] = {}
    for vertex, weight in weights.items():
        shares[vertex[side]] = shares.get(vertex[side], Fraction(0)) + weight
    return OnBody(tuple(shares), tuple(map(exact_number, shares.values())))
