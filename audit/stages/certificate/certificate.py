"""The certificate of a finding: one part for each claim, checked before it is returned."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from fractions import Fraction
from typing import Any

from msgspec import UNSET
from msgspec.structs import replace

from satcheck import core
from satcheck.audit.draft import Draft
from satcheck.audit.stages.certificate.cells import cells, cover, excuse
from satcheck.audit.stages.certificate.curved import CurvedMaker
from satcheck.audit.stages.certificate.maker import (
    AXES,
    Maker,
    at_least,
    axis_of,
    exact_number,
    leading_axes,
    or_unset,
)
from satcheck.audit.stages.exact_hulls import Expanded, expanded, nearest_point, shortened
from satcheck.core.steps import not_for_lack_of_memory
from satcheck.report.certificate import (
    AxisProof,
    Band,
    Cells,
    Certificate,
    Cover,
    DepthProof,
    Ends,
    OnBody,
    Polytope,
    PolytopeProof,
    Proof,
    SurfacesProof,
)
from satcheck.report.report import Finding
from satcheck.verify import Rejected, pairs
from satcheck.verify.figures import EXACT_WIDTH
from satcheck.verify.findings import check_finding
from satcheck.verify.pairs import vector


def with_certificate(finding: Finding, draft: Draft) -> Finding:
    """Return the finding with its evidence, or with a stage that says why there is none."""
    try:
        certificate = _certified(draft, finding)
    except Rejected as why:
        draft.record("certificate", "none", str(why))
        return replace(finding, plan=tuple(draft.stages))
    except Exception as error:  # noqa: BLE001 the verdict stands whatever becomes of its evidence
        not_for_lack_of_memory(error)
        draft.record("certificate", "none", f"internal error: {type(error).__name__}: {error}")
        return replace(finding, plan=tuple(draft.stages))
    kind = certificate.relation.__struct_config__.tag
    draft.record("certificate", str(kind), "accepted by the checker")
    return replace(finding, certificate=certificate, plan=tuple(draft.stages))


def _certified(draft: Draft, finding: Finding) -> Certificate:
    """Return a certificate that the checker accepts. Raises Rejected: there is none."""
    pair = draft.pair
    if finding.motion is not None:
        raise Rejected("a sweep of moving bodies leaves no evidence")
    if finding.exact_relation is None:
        raise Rejected("the relation is not proven")
    maker = CurvedMaker(pair, finding) if pair.curved else _MeshMaker(draft, finding)
    certificate = maker.certificate()
    parts = [part for part in ("thickness", "cover") if getattr(certificate, part) is not UNSET]
    while True:
        try:
            check_finding(replace(finding, certificate=certificate), *maker.bodies, pair.request)
        except Rejected as why:
            if not parts:
                raise Rejected(f"what was found does not prove it: {why}") from None
            certificate = replace(certificate, **{parts.pop(0): UNSET})  # it may be that alone
        else:
            return certificate


class _MeshMaker(Maker):
    placed: pairs.Pair

    def __init__(self, draft: Draft, finding: Finding) -> None:
        super().__init__(draft.pair, finding)
        self.draft = draft
        self.across = draft.pair.request.across
        self.ends = self.placed
        if self.across is not None:
            self.ends = pairs.prisms(self.placed, finding.exact_relation, self.across)

    def certificate(self) -> Certificate:
        made = super().certificate()
        finding, bounds = self.finding, self.finding.depth_bounds
        if bounds is not None and self.placed.convex:
            depth = self._depth(Fraction(bounds[0]), Fraction(bounds[1]) - self.closer)
            made = replace(made, depth=or_unset(depth))
        elif bounds is not None:
            made = replace(made, cover=or_unset(self._cover(bounds[0])))
        if finding.distance and not self.closer:
            made = replace(made, distance=or_unset(self.gap()))
        return replace(made, thickness=or_unset(self._cells()))

    def relation(self) -> Proof | None:
        match self.finding.exact_relation:
            case "separated":
                return self.apart() or SurfacesProof()
            case "touching":
                return self._touching() or SurfacesProof()
            case "penetrating":
                return self._hulls_overlap() or SurfacesProof(or_unset(self._crossing()))
        return SurfacesProof()

    def _crossing(self) -> tuple[int, int] | None:
        """Triangles that meet. A lower rung may have settled the pair without any."""
        climb = self.draft.climb
        if climb is not None and climb.triangles is not None:
            return climb.crossing
        relation = core.mesh_relation(self.pair.a.surface(), self.pair.b.surface())
        if relation.triangle_a < 0 or relation.triangle_b < 0:
            return None
        return relation.triangle_a, relation.triangle_b

    def hints(self) -> Iterator[Iterable[Any]]:
        """Yield how the hulls are apart; a lower rung may have settled the pair."""
        climb = self.draft.climb
        hulls = None if climb is None else climb.hulls
        if hulls is None:
            shapes = self.pair.a.hull_shape(), self.pair.b.hull_shape()
            hulls = core.check_pair(*shapes, query="distance")
        if hulls.normal is not None:
            yield hulls.normal
        if hulls.outcome == "separated":
            x, y, z = nearest_point(self.placed).point
            # The nearest point of A - B leads from B to A.
            yield shortened((-x, -y, -z))

    def freed(self, placed: pairs.AnyPair, _: tuple[float, float, float]) -> Proof:
        if placed.convex and isinstance(placed, pairs.Pair):
            outside = expanded(placed, Fraction(0))
            if outside is not None and not outside.overlaps:
                return AxisProof(axis_of(shortened(outside.axis)))
        return SurfacesProof()

    def _touching(self) -> AxisProof | None:
        if not self.placed.convex:
            return None
        nearest = nearest_point(self.placed)
        axis = next((n for n in self._axes() if at_least(self.placed, n, Fraction(0))), None)
        if axis is None:
            outside = expanded(self.placed, Fraction(0))
            if outside is None or outside.overlaps:
                return None
            axis = axis_of(shortened(outside.axis))
        return None if any(nearest.point) else AxisProof(axis, _on_hulls(nearest.weights))

    def _hulls_overlap(self) -> PolytopeProof | None:
        """For convex bodies that stick out of each other."""
        if not self.placed.convex:
            return None
        inner = expanded(self.ends, Fraction(0))
        if inner is None or not inner.overlaps:
            return None
        leads = leading_axes(
            (axis, self.ends.lead(vector(axis)))
            for k, axis in enumerate(AXES)
            if k // 2 != self.across
        )
        if leads is None:
            return None
        return PolytopeProof(tuple(inner.vertices), tuple(inner.faces), *leads)

    def _depth(self, lower: Fraction, limit: Fraction) -> DepthProof | None:
        """Certify the depth of convex bodies."""
        inner = expanded(self.placed, lower)
        if inner is None or not inner.overlaps:
            return None
        normal = self.finding.normal
        if normal is not None and at_least(self.placed, normal, -limit):
            return DepthProof(_polytope(inner), normal)
        complete = expanded(self.placed, limit * 2) or inner
        return DepthProof(_polytope(inner), axis_of(shortened(complete.axis)))

    def _cover(self, lower: float) -> Cover | None:
        if not (self.placed.a.world.solid and self.placed.b.world.solid):
            return None
        surfaces = self.pair.a.surface(), self.pair.b.surface()
        return cover(*surfaces, lower, self.pair.work)

    def _cells(self) -> Cells | None:
        """Certify the thickness of an overlap that is thinner than it is deep."""
        thickness, finding = self.draft.thickness, self.finding
        if thickness is None or thickness.proof is None:
            return None
        if finding.mtv_verified and finding.depth is not None and thickness.upper >= finding.depth:
            return None
        return cells(thickness.proof)

    def gap(self) -> Ends | None:
        return _on_hulls(nearest_point(self.placed).weights) if self.placed.convex else None

    def otherwise_in_band(self) -> Band:
        if self.placed.convex:
            inner = expanded(self.placed, Fraction(self.pair.tolerance) * 2)
            axis = None if inner is None else axis_of(shortened(inner.axis))
            band = Fraction(self.pair.tolerance) * (1 + EXACT_WIDTH)
            if axis is not None and at_least(self.placed, axis, -band):
                return Band(axis)
        move = None if self.draft.band is None else self.draft.band.move
        if move is not None:
            return Band(move=move, free=or_unset(self.free(move)))
        return Band(excuse=excuse(self.pair))


def _polytope(expansion: Expanded) -> Polytope:
    return Polytope(tuple(expansion.vertices), tuple(expansion.faces))


def _on_hulls(weights: dict[tuple[int, int], Fraction]) -> Ends:
    of_a: dict[int, Fraction] = {}
    of_b: dict[int, Fraction] = {}
    for (i, j), weight in weights.items():
        of_a[i] = of_a.get(i, Fraction(0)) + weight
        of_b[j] = of_b.get(j, Fraction(0)) + weight
    a, b = (OnBody(tuple(x), tuple(map(exact_number, x.values()))) for x in (of_a, of_b))
    return Ends(a, b)
