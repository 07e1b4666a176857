"""The certificate of a finding: one part for each thing it says, checked before it is given out."""

from __future__ import annotations

import math
from collections.abc import Iterator
from fractions import Fraction
from typing import Any

from satcheck import core
from satcheck.audit.bodies.pair import Pair
from satcheck.audit.certify import overlaps
from satcheck.audit.certify.cover import cover
from satcheck.audit.certify.hulls import Expanded, expanded, nearest_point, shortened
from satcheck.audit.finding import Examined
from satcheck.core.conventions import axis_across
from satcheck.report.report import OVERLAPS, plain
from satcheck.verify import Rejected
from satcheck.verify.distances import check_distance
from satcheck.verify.evidence import exceeds, gap_along, vector
from satcheck.verify.figures import rounding_of
from satcheck.verify.findings import check_finding, depth_at_most, pair_of
from satcheck.verify.in_plane import curve_error, reaching
from satcheck.verify.rules import Asked

Json = dict[str, Any]
SURFACES: Json = {"kind": "surfaces"}


def certified(pair: Pair, examined: Examined) -> Json | str:
    """A certificate that the checker accepts, or why there is none."""
    finding = examined.finding
    if finding.exact_relation is None:
        return "the relation is not proven"
    a, b = pair.a.checked(), pair.b.checked()
    asked = Asked(
        pair.request.tolerance,
        pair.request.clearance,
        pair.settings.allow_open,
        pair.request.max_depth,
        pair.request.max_volume,
        pair.request.severity,
        pair.request.rules or {},
        None if (plane := pair.settings.planar) is None else axis_across(plane),
    )
    if pair.curved:
        from satcheck.audit.certify.curved import make

        certificate = make(pair, finding)
    else:
        certificate = _Maker(pair, examined).make()
    if isinstance(certificate, str):
        return certificate
    try:
        check_finding(plain(finding) | {"certificate": certificate}, a, b, asked)
    except Rejected as why:
        return f"what was found does not prove it: {why}"
    return certificate


class _Maker:
    def __init__(self, pair: Pair, examined: Examined) -> None:
        self.pair, self.examined, self.finding = pair, examined, examined.finding
        a, b = pair.a.checked(), pair.b.checked()
        if a.world is None or b.world is None:
            raise AssertionError("a placed body has a world mesh")
        self.a, self.b = a, b
        self.worlds = a.world, b.world
        self.placed = self.ends = pair_of(a, b, a.world, b.world)
        plane = pair.settings.planar
        self.error = curve_error(a, b)
        self.across = None if plane is None else axis_across(plane)
        if self.across is not None:
            relation = str(self.finding.exact_relation)
            self.ends = pair_of(a, b, *reaching(relation, a.world, b.world, self.across))

    def make(self) -> Json | str:
        finding = self.finding
        relation = self._relation()
        if relation is None:
            return f"no evidence was found for {finding.exact_relation!r}"
        certificate: Json = {"relation": relation}
        if self.placed.convex and finding.depth_bounds is not None:
            low, high = (Fraction(bound) for bound in finding.depth_bounds)
            depth = self._depth(low + self.error.farther, high - self.error.closer)
            if depth is not None:
                certificate["depth"] = depth
        elif finding.depth_bounds is not None:
            covered = cover(self.placed, Fraction(finding.depth_bounds[0]))
            if covered is not None:
                certificate["cover"] = covered
        if finding.mtv_verified and finding.mtv is not None:
            free = self._free(finding.mtv, self.error.closer)
            if free["kind"] == "axis" or not self.error.closer:
                certificate["mtv"] = free
        if finding.relation != finding.exact_relation:
            certificate |= self._band()
        if finding.distance and not (self.placed.convex or self.error.closer):
            certificate |= self._distance()
        return certificate

    def _relation(self) -> Json | None:
        exact, placed = self.finding.exact_relation, self.ends
        if exact == "separated":
            return self._apart()
        if exact == "touching":
            return self._touching()
        solids = placed.a.world.solid + placed.b.world.solid
        if exact in ("contains", "inside", "coincident"):
            proof = {"kind": "same"} if exact == "coincident" else SURFACES
            both = overlaps.inside_both(placed) if solids else None
            return proof if both is None else {**proof, "both": both}
        found = self._hulls_overlap() if solids == 2 else None
        if found is not None:
            return found
        hint = self._crossing()
        if solids == 2:
            found = overlaps.overlap(placed, hint, across=self.across)
        elif solids:
            found = overlaps.sheet_overlap(placed, hint)
        return found or overlaps.crossing(placed, hint)

    def _crossing(self) -> tuple[int, int] | None:
        """Triangles that meet. A lower rung may have settled the pair without any."""
        climb = self.examined.verdict.climb
        if climb is not None and climb.triangles is not None:
            return climb.crossing
        found = core.mesh_relation(self.pair.a.surface(), self.pair.b.surface())
        if found.triangle_a < 0 or found.triangle_b < 0:
            return None
        return found.triangle_a, found.triangle_b

    def _hulls(self) -> core.PairResult:
        """How the hulls of the bodies are apart; a lower rung may have settled the pair."""
        climb = self.examined.verdict.climb
        if climb is not None and climb.hulls is not None:
            return climb.hulls
        return core.check_pair(self.pair.a.hull_shape(), self.pair.b.hull_shape(), query="distance")

    def _axes(self) -> Iterator[Any]:
        """Candidates for a separating axis, from A to B, the simplest first."""
        for axis in range(3):
            for side in (1, -1):
                yield [side if k == axis else 0 for k in range(3)]
        if self.finding.normal is not None:
            yield list(self.finding.normal)
        normal = self._hulls().normal
        if normal is not None:
            yield list(normal)

    def _apart(self) -> Json:
        """A separation of the hulls as wide as asked about, or the surfaces themselves."""
        asked = Fraction(0)
        if self.finding.relation == "separated":
            asked = max(Fraction(self.pair.tolerance), Fraction(self.pair.request.clearance or 0.0))
        asked += self.error.closer
        placed = self.placed
        for axis in self._axes():
            n = vector(axis)
            if any(n) and exceeds(gap_along(placed.a, placed.b, n), n, asked):
                return {"kind": "axis", "axis": axis}
        if self._hulls().outcome != "separated":
            return SURFACES
        nearest = nearest_point(placed)
        n = nearest.point
        if not any(n):
            return SURFACES
        # The nearest point of A - B leads from B to A.
        direction = shortened((-n[0], -n[1], -n[2]))
        if exceeds(
            gap_along(placed.a, placed.b, vector(_text(direction))), vector(_text(direction)), asked
        ):
            return {"kind": "axis", "axis": _text(direction)}
        return SURFACES

    def _touching(self) -> Json | None:
        placed = self.placed
        if placed.convex:
            outside = expanded(placed, Fraction(0))
            nearest = nearest_point(placed)
            if outside is not None and not outside.overlaps and not any(nearest.point):
                return {
                    "kind": "axis",
                    "axis": _text(shortened(outside.axis)),
                    "contact": _on_hulls(nearest.weights),
                }
        contact = overlaps.boundary_contact(placed, self._crossing())
        return None if contact is None else {**SURFACES, "contact": contact}

    def _hulls_overlap(self) -> Json | None:
        """For convex bodies that stick out of each other."""
        if not self.placed.convex:
            return None
        found = expanded(self.ends, self.error.farther)
        if found is None or not found.overlaps:
            return None
        leads: Json = {}
        for axis in range(3):
            if axis == self.across:
                continue
            for side in (1, -1):
                n = [side if k == axis else 0 for k in range(3)]
                lead = self.ends.a.extent(n) - self.ends.b.extent(n)
                if lead > 0:
                    leads.setdefault("a_reaches", n)
                elif lead < 0:
                    leads.setdefault("b_reaches", n)
                else:
                    leads.setdefault("even", n)
        even = leads.pop("even", None)
        if even is not None and leads:
            leads = {"a_reaches": even, "b_reaches": even} | leads
        if len(leads) < 2:
            return None
        return {"kind": "polytope", **_polytope(found), **leads}

    def _depth(self, lower: Fraction, limit: Fraction) -> Json | None:
        found = expanded(self.placed, lower)
        if found is None or not found.overlaps:
            return None
        normal = self.finding.normal
        if normal is not None and depth_at_most(vector(list(normal)), self.placed, limit):
            return {"lower": _polytope(found), "upper": list(normal)}
        complete = expanded(self.placed, limit * 2) or found
        return {"lower": _polytope(found), "upper": _text(shortened(complete.axis))}

    def _free(self, move: Any, least: Fraction = Fraction(0)) -> Json:
        """That A, moved, has no common interior with B. least: of the gap along an axis."""
        world = self.worlds[0].moved(move)
        placed = pair_of(self.a, self.b, world, self.worlds[1])
        length = math.hypot(*move)
        hints = [[-c / length for c in move]] if length else []
        if self.finding.normal is not None:
            hints.append(list(self.finding.normal))
        for axis in range(3):
            hints += [[float(side) if k == axis else 0.0 for k in range(3)] for side in (1, -1)]
        for axis_ in hints:
            n = vector(axis_)
            gap = gap_along(placed.a, placed.b, n)
            if any(n) and (exceeds(gap, n, least) if least else gap >= 0):
                return {"kind": "axis", "axis": axis_}
        if placed.convex:
            found = expanded(placed, Fraction(0))
            if found is not None and not found.overlaps:
                return {"kind": "axis", "axis": _text(shortened(found.axis))}
        return SURFACES

    def _distance(self) -> Json:
        """Points next to each other, where few triangles could be nearer than these."""
        ends = self._nearest()
        rounding = rounding_of(self.a, self.b)
        try:
            check_distance(plain(self.finding), {"distance": ends}, self.placed, rounding)
        except Rejected:
            return {}
        return {"distance": ends}

    def _band(self) -> Json:
        """Why the relation is another than the exact one."""
        finding = self.finding
        if finding.exact_relation == "separated":
            if self.placed.convex:
                return {"gap": _on_hulls(nearest_point(self.placed).weights)}
            return {"gap": self._nearest()}
        if finding.exact_relation in OVERLAPS and not (
            finding.mtv_verified
            and finding.depth is not None
            and finding.depth <= self.pair.tolerance
        ):
            if self.placed.convex:
                found_ = expanded(self.placed, Fraction(self.pair.tolerance) * 2)
                if found_ is not None:
                    return {"band": {"axis": _text(shortened(found_.axis))}}
            answer = self.examined.answer
            move = None if answer is None or answer.band is None else answer.band.move
            if move is not None:
                return {"band": {"move": list(move), "free": self._free(move)}}
        return {}

    def _nearest(self) -> Json:
        """Points next to each other, on the nearest triangles."""
        climb = self.examined.verdict.climb
        near = None if climb is None else climb.gap
        if near is None or near.triangle_a < 0:
            near = core.mesh_distance(self.pair.a.surface(), self.pair.b.surface())
        return overlaps.nearest_points(self.placed, near.triangle_a, near.triangle_b)


def _text(v: Any) -> list[str]:
    return [str(c) for c in v]


def _polytope(found: Expanded) -> Json:
    return {
        "vertices": [list(vertex) for vertex in found.vertices],
        "faces": [list(face) for face in found.faces],
    }


def _on_hulls(weights: dict[tuple[int, int], Fraction]) -> Json:
    ends: Json = {}
    for side, key in enumerate(("a", "b")):
        shares: dict[int, Fraction] = {}
        for vertex, weight in weights.items():
            shares[vertex[side]] = shares.get(vertex[side], Fraction(0)) + weight
        ends[key] = {
            "vertices": list(shares),
            "weights": [overlaps.as_json(weight) for weight in shares.values()],
        }
    return ends
