"""One finding: whether its claims follow from its certificate."""

from __future__ import annotations

from dataclasses import dataclass, replace
from fractions import Fraction

import numpy as np
from msgspec import UnsetType

from satcheck.report.certificate import Band, Certificate, Proof, SurfacesProof
from satcheck.report.report import OVERLAPS, Finding
from satcheck.report.request import Request
from satcheck.verify.bodies import Placed, curve_error
from satcheck.verify.depth import depth_is_at_least, inner_radius_exceeds
from satcheck.verify.distances import (
    check_claims,
    check_distance,
    check_holes,
    check_pieces,
    least_gap,
    prove_apart,
    spanned,
)
from satcheck.verify.exact import Point, Rejected, dot, root
from satcheck.verify.excuse import is_explained
from satcheck.verify.figures import (
    Rounding,
    check_figures,
    check_id,
    check_tolerance,
    rounding_of,
    shows_direction,
)
from satcheck.verify.in_plane import (
    check_in_plane,
    check_overlap_of_curves,
    leaves_gap_of_curves,
    reaching,
)
from satcheck.verify.pairs import AnyPair, Pair, any_pair_of, axis, given, pair_of, vector
from satcheck.verify.relations import prove, prove_free
from satcheck.verify.thickness import at_most, holds_ball
from satcheck.verify.world import stick_out


@dataclass(frozen=True, slots=True)
class Proven:
    """fields: of an accepted finding, those that are proven, with or without a value. distance: how
    far it may be off; None: it is not proven."""

    fields: frozenset[str]
    distance: Fraction | None


def _required_certificate(finding: Finding, a: Placed, b: Placed) -> Certificate:
    if a.reason is not None or b.reason is not None:
        raise Rejected(a.reason or b.reason or "a body is missing")
    if finding.certificate is None:
        raise Rejected("it has no certificate")
    return finding.certificate


def check_finding(finding: Finding, a: Placed, b: Placed, request: Request) -> Proven:
    """Rejects an unproven finding of two readable bodies."""
    certificate = _required_certificate(finding, a, b)
    check_id(finding)
    tolerance = check_tolerance(finding, a, b, request)
    check_figures(finding, a, b)
    pair = any_pair_of(a, b)
    closer = curve_error(a, b)
    hulls_apart = _prove_relation(finding, certificate, pair, (a, b), request, tolerance)
    overlap = finding.exact_relation in OVERLAPS
    mtv = check_mtv(finding, certificate, a, b)
    depth = _check_depth(finding, certificate, pair, closer)
    both_ends = depth or (_check_cover(finding, certificate, pair) and mtv)
    rounding = rounding_of(a, b)
    spans = spanned(finding, rounding, pair)
    directed = spans or mtv or (shows_direction(finding, a, b) and not pair.convex)
    block = (a.endless or b.endless) and finding.exact_relation != "touching"
    error = None
    if not (closer or a.holed or b.holed or block):  # the block of a half space may be off
        error = _check_distance(finding, certificate, pair, rounding, spans)
    most = _most_depth(finding, depth=depth, mtv=mtv)
    thickest = _check_thickness(finding, certificate, pair, closer, most)
    if not overlap and not hulls_apart:
        check_holes(a, b, max(tolerance, Fraction(request.clearance or 0.0)))
        check_pieces(a, b)

    slack = rounding.of(tolerance)
    if finding.relation == "near":
        prove_apart(certificate, pair, (a, b), max(tolerance - slack, Fraction(0)))
    if finding.relation in OVERLAPS and most is not None and most + slack < tolerance:
        raise Rejected("the overlap is within the tolerance: the bodies touch")

    def is_in_band(band: Fraction) -> bool:
        if isinstance(certificate.band, UnsetType):
            is_shallow = both_ends and finding.depth is not None and finding.depth <= band
            return is_shallow or (mtv and _is_short(vector(finding.mtv or ()), band))
        return _is_in_band(finding, certificate.band, pair, (a, b), band)

    bounds = most, thickest
    check_claims(finding, certificate, pair, (a, b), request, tolerance, is_in_band, bounds)
    thick = Fraction(finding.thickness or 0)
    ball = isinstance(pair, Pair) and finding.thickness_bounds is not None and not closer
    shown = {
        "undecided": finding.undecided != "limit",
        "distance": error is not None,
        "distance_bounds": _bounds_follow(finding, error),
        "depth": both_ends or mtv,
        "depth_bounds": both_ends,
        "normal": directed,
        "mtv": mtv,
        "thickness": thickest is not None and thickest <= thick + rounding.of(thick),
        "thickness_bounds": ball,
        "ball": ball,
        "volume": not overlap,
        "volume_error": not overlap,
    }
    return Proven(frozenset(name for name, is_shown in shown.items() if is_shown), error)


def _most_depth(finding: Finding, *, depth: bool, mtv: bool) -> Fraction | None:
    """An upper bound, world units, of the depth that is certified; None: none is."""
    bounds = []
    if depth and finding.depth is not None:
        bounds.append(Fraction(finding.depth))
    if mtv and finding.mtv is not None:
        move = vector(finding.mtv)
        bounds.append(root(dot(move, move))[1])
    return min(bounds, default=None)


def _bounds_follow(finding: Finding, error: Fraction | None) -> bool:
    """Return whether bounds of the distance, if the finding has any, are as wide as the proof of
    it. error: how far it may be off; None: it is not proven."""
    bounds, distance = finding.distance_bounds, finding.distance
    if bounds is None or distance is None:
        return True
    if error is None:
        return False
    low, high, length = Fraction(bounds[0]), Fraction(bounds[1]), Fraction(distance)
    return low <= max(length - error, Fraction(0)) and length + error <= high


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
    by_surfaces = relation == "penetrating" and isinstance(certificate.relation, SurfacesProof)
    if by_surfaces and _share_ball(finding, pair, request.across):
        return False
    beyond = tolerance if finding.relation == "separated" else Fraction(0)
    least = least_gap(finding, request) + closer
    return prove(relation, certificate.relation, ends, max(beyond, closer), least)


def _share_ball(finding: Finding, pair: AnyPair, across: int | None) -> bool:
    """Whether the ball of the thickness shows that two solids overlap, and their boxes that neither
    holds the other. Rejects a ball that is not in both."""
    ball = finding.ball
    if ball is None or ball.radius <= 0 or not isinstance(pair, Pair):
        return False
    a, b = pair.a.world, pair.b.world
    if not (a.solid and b.solid and stick_out(a, b, Fraction(0), across)):
        return False
    for body in (pair.a, pair.b):
        holds_ball(body, ball.centre, Fraction(ball.radius))
    return True


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
    depth_is_at_least(certificate.cover, pair.a, pair.b, finding.depth_bounds[0])
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


def _is_in_band(
    finding: Finding,
    proof: Band,
    pair: AnyPair,
    bodies: tuple[Placed, Placed],
    band: Fraction,
) -> bool:
    """Return whether a way out of the overlap is within the tolerance, or surfaces that may be off
    explain it."""
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


def check_mtv(finding: Finding, certificate: Certificate, a: Placed, b: Placed) -> bool:
    """A, moved by the MTV with one rounding of each coordinate, has no common interior with B.

    `check_figures` has checked that an overlap has the MTV, and that it is as long as the depth.
    Returns False if the finding does not claim this, or if it is not certified.
    """
    if finding.mtv_verified is not True or finding.mtv is None:
        return False
    if isinstance(certificate.mtv, UnsetType):
        if curve_error(a, b):
            return False
        raise Rejected("the certificate has no 'mtv'")
    prove_way_out(vector(finding.mtv), certificate.mtv, a, b)
    return True


def prove_way_out(move: Point, proof: Proof, a: Placed, b: Placed) -> None:
    offset = [float(c) for c in move]
    if not np.isfinite(offset).all():
        raise Rejected("a translation is finite")
    moved = a.moved(offset)
    if isinstance(proof, SurfacesProof):
        check_holes(moved, b, Fraction(0))
    pair = any_pair_of(moved, b)
    prove_free(proof, pair)
    if not leaves_gap_of_curves(proof, curve_error(a, b), pair):
        raise Rejected("the way out is shown of polygons alone, not of the curves")
