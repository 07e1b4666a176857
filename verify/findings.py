"""One finding: whether its claims follow from its certificate."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

from msgspec import UnsetType

from satcheck.report.certificate import Band, Certificate
from satcheck.report.report import OVERLAPS, Finding
from satcheck.report.request import Request
from satcheck.verify.bodies import Placed
from satcheck.verify.clearance import check_claims, least_gap
from satcheck.verify.cover import depth_is_at_least
from satcheck.verify.distances import check_distance, prove_apart, spanned
from satcheck.verify.evidence import axis, given, vector
from satcheck.verify.exact import Point, Rejected, dot
from satcheck.verify.excuse import is_explained
from satcheck.verify.figures import (
    Rounding,
    check_figures,
    check_id,
    check_tolerance,
    rounding_of,
    shows_direction,
)
from satcheck.verify.holes import check_holes, check_pieces
from satcheck.verify.in_plane import (
    check_in_plane,
    check_overlap_of_curves,
    curve_error,
    reaching,
)
from satcheck.verify.pairs import AnyPair, Pair, any_pair_of, pair_of
from satcheck.verify.polytope import inner_radius_exceeds
from satcheck.verify.relations import prove
from satcheck.verify.severity import ProvenFields, proven_depth
from satcheck.verify.thickness import at_most, holds_ball
from satcheck.verify.way_out import check_mtv, prove_way_out


def check_finding(finding: Finding, a: Placed, b: Placed, request: Request) -> ProvenFields:
    """Rejects an unproven finding of two readable bodies."""
    if a.reason is not None or b.reason is not None:
        raise Rejected(a.reason or b.reason or "a body is missing")
    certificate = finding.certificate
    if certificate is None:
        raise Rejected("it has no certificate")
    check_id(finding)
    tolerance = check_tolerance(finding, a, b, request)
    check_figures(finding, a, b)
    pair = any_pair_of(a, b)
    closer = curve_error(a, b)
    hulls_apart = _prove_relation(finding, certificate, pair, (a, b), request, tolerance)
    mtv = check_mtv(finding, certificate, a, b)
    depth = _check_depth(finding, certificate, pair, closer)
    covered = _check_cover(finding, certificate, pair)
    rounding = rounding_of(a, b)
    spans = pair.convex and spanned(finding, rounding, pair)
    directed = spans or mtv or (not pair.convex and shows_direction(finding, a, b))
    block = (a.endless or b.endless) and finding.exact_relation != "touching"
    error = None
    if not (closer or a.holed or b.holed or block):  # the block of a half space may be off
        error = _check_distance(finding, certificate, pair, rounding, spans)
    proven = ProvenFields(depth or (covered and mtv), mtv, error, directed)
    most = proven_depth(finding, replace(proven, depth=depth))
    thickest = _check_thickness(finding, certificate, pair, closer, most)
    if isinstance(pair, Pair):
        proven = replace(
            proven,
            ball=finding.thickness_bounds is not None and not closer,
            thickness=thickest is not None and thickest <= _granted(finding.thickness, rounding),
        )
    if finding.exact_relation not in OVERLAPS and not hulls_apart:
        check_holes(a, b, max(tolerance, Fraction(request.clearance or 0.0)))
        check_pieces(a, b)

    slack = rounding.of(tolerance)
    if finding.relation == "near":
        prove_apart(certificate, pair, (a, b), max(tolerance - slack, Fraction(0)))
    if finding.relation in OVERLAPS and most is not None and most + slack < tolerance:
        raise Rejected("the overlap is within the tolerance: the bodies touch")

    def is_in_band(band: Fraction) -> bool:
        return _is_in_band(finding, certificate.band, pair, (a, b), band, proven)

    bounds = most, thickest
    check_claims(finding, certificate, pair, (a, b), request, tolerance, is_in_band, bounds)
    return proven


def _prove_relation(
    finding: Finding,
    certificate: Certificate,
    pair: AnyPair,
    bodies: tuple[Placed, Placed],
    request: Request,
    tolerance: Fraction,
) -> bool:
    """Returns whether the relation also holds for the hulls; then neither body can lie inside the
    other."""
    relation, ends = finding.exact_relation, pair
    closer = curve_error(*bodies)
    if request.across is not None and isinstance(pair, Pair):
        check_in_plane(finding, certificate, request.across)
        worlds = reaching(relation, pair.a.world, pair.b.world, request.across)
        ends = replace(pair_of(*bodies, *worlds), across=request.across)
        if relation != "separated":
            check_overlap_of_curves(relation, closer, ends, request.across)
    beyond = tolerance if finding.relation == "separated" else Fraction(0)
    least = least_gap(finding, request) + closer
    return prove(relation, certificate.relation, ends, max(beyond, closer), least)


def _check_distance(
    finding: Finding, certificate: Certificate, pair: AnyPair, rounding: Rounding, spans: bool
) -> Fraction | None:
    """Return how far the distance may be off; None: it is not proven."""
    if isinstance(pair, Pair):
        return check_distance(finding, certificate, pair)
    if finding.exact_relation == "touching":
        return Fraction(0)
    return 2 * rounding.of(Fraction(finding.distance or 0.0)) if spans else None


def _check_depth(
    finding: Finding, certificate: Certificate, pair: AnyPair, closer: Fraction
) -> bool:
    """Checks the interval of the depth: a ball in the Minkowski difference proves the lower bound,
    an axis the upper bound."""
    bounds, proof = finding.depth_bounds, certificate.depth
    if bounds is None or isinstance(proof, UnsetType):
        return False
    low, high = map(Fraction, bounds)
    if not (isinstance(pair, Pair) and pair.convex):
        raise Rejected("a depth is certified for convex meshes only")
    inner_radius_exceeds(proof.lower, pair.a, pair.b, low)
    if pair.gap(axis(proof.upper), closer - high) < 0:
        raise Rejected("along the axis the bodies overlap by more than the depth")
    return True


def _check_cover(finding: Finding, certificate: Certificate, pair: AnyPair) -> bool:
    """Checks the lower bound of the depth of bodies that are not both convex, if it is
    certified."""
    if isinstance(certificate.cover, UnsetType):
        return False
    if finding.depth_bounds is None or not isinstance(pair, Pair):
        raise Rejected("a cover, and no depth of meshes")
    depth_is_at_least(certificate.cover, pair.a, pair.b, Fraction(finding.depth_bounds[0]))
    return True


def _check_thickness(
    finding: Finding,
    certificate: Certificate,
    pair: AnyPair,
    closer: Fraction,
    depth: Fraction | None,
) -> Fraction | None:
    """An upper bound of the thickness, as far as one is proven. Rejects a ball that is not in both
    bodies. depth: a bound of the depth; no overlap is thicker than it is deep. The prisms of a
    check in a plane are higher than wide: the largest ball in both has the diameter of the largest
    disc. Of curves nothing is proven."""
    cells = certificate.thickness
    if finding.thickness is None or closer or not isinstance(pair, Pair):
        if not isinstance(cells, UnsetType):
            raise Rejected("cells, and no thickness of polyhedra")
        return depth
    if finding.ball is not None:
        for body in (pair.a, pair.b):
            holds_ball(body, finding.ball.centre, Fraction(finding.ball.radius))
    if isinstance(cells, UnsetType):
        return depth
    thickness = Fraction(finding.thickness)
    at_most(cells, pair.a, pair.b, thickness / 2, (Fraction(0), Fraction(0)))
    return thickness if depth is None else min(thickness, depth)


def _granted(figure: float | None, rounding: Rounding) -> Fraction:
    length = Fraction(figure or 0)
    return length + rounding.of(length)


def _is_in_band(
    finding: Finding,
    proof: Band | UnsetType,
    pair: AnyPair,
    bodies: tuple[Placed, Placed],
    band: Fraction,
    proven: ProvenFields,
) -> bool:
    """Return whether a way out of the overlap is within the tolerance, or surfaces that may be off
    explain it."""
    if isinstance(proof, UnsetType):
        if proven.depth and finding.depth is not None and finding.depth <= band:
            return True
        return proven.mtv and finding.mtv is not None and _is_short(vector(finding.mtv), band)
    if not isinstance(proof.axis, UnsetType):
        if pair.convex and pair.gap(axis(proof.axis), -band) >= 0:
            return True
        raise Rejected("the bodies overlap by more than the tolerance")
    if not isinstance(proof.excuse, UnsetType):
        if curve_error(*bodies) or not isinstance(pair, Pair):
            raise Rejected("an excuse of polygons, and not of their curves")
        is_explained(proof.excuse, pair, bodies, Fraction(finding.tolerance or 0.0))
        return True
    move = vector(given(proof.move, "move"))
    if not _is_short(move, band):
        return False
    if isinstance(proof.free, UnsetType):
        raise Rejected("the certificate has no 'free'")
    prove_way_out(move, proof.free, *bodies)
    return True


def _is_short(move: Point, band: Fraction) -> bool:
    return bool(dot(move, move) <= band * band)
