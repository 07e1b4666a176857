"""One finding: whether its claims follow from its certificate."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from math import inf

import numpy as np
from msgspec import UnsetType
from msgspec.structs import replace

from satcheck.report.certificate import AxisProof, ExactVector, Proof, SurfacesProof
from satcheck.report.judge import by_rule, disputed, judged, named
from satcheck.report.report import CROSS_CHECK, OVERLAPS, Finding
from satcheck.report.request import Request
from satcheck.verify.bodies import Placed
from satcheck.verify.depth import depth_is_at_least, inner_radius_exceeds
from satcheck.verify.distances import (
    Claim,
    check_distance,
    check_holes,
    check_overlap_of_curves,
    check_pieces,
    is_within,
    keeps,
    prove_apart,
    spanned,
)
from satcheck.verify.exact import Point, Rejected, dot, root
from satcheck.verify.excuse import is_explained
from satcheck.verify.figures import (
    EXACT_WIDTH,
    check_figures,
    check_id,
    check_tolerance,
    rounding_of,
    shows_direction,
)
from satcheck.verify.pairs import Pair, any_pair_of, axis, given, prisms, vector
from satcheck.verify.relations import prove, prove_free
from satcheck.verify.thickness import at_most, holds_ball
from satcheck.verify.world import stick_out

WIDER = 1 + EXACT_WIDTH  # the share of a limit that rounding is granted


@dataclass(frozen=True, slots=True)
class Proven:
    """fields: of an accepted finding, those that are proven, with or without a value. distance: how
    far it may be off; None: it is not proven."""

    fields: frozenset[str]
    distance: Fraction | None


def check_finding(finding: Finding, a: Placed, b: Placed, request: Request) -> Proven:
    """Rejects an unproven finding of two readable bodies."""
    if lost := a.lost or b.lost:
        raise Rejected(str(lost))
    if finding.certificate is None:
        raise Rejected("it has no certificate")
    check_id(finding)
    tolerance = check_tolerance(finding, a, b, request)
    check_figures(finding, a, b)
    pair, rounding = any_pair_of(a, b), rounding_of(a, b)
    claim = Claim(finding, finding.certificate, pair, request, tolerance, rounding)
    shares_ball = _check_ball(claim)
    hulls_apart = _prove_relation(claim, shares_ball)
    overlap = finding.exact_relation in OVERLAPS
    mtv = _check_mtv(claim)
    depth = _check_depth(claim)
    both_ends = depth or (_check_cover(claim) and mtv)
    spans = spanned(claim)
    directed = spans or mtv or (shows_direction(finding, a, b) and not pair.convex)
    block = (a.endless or b.endless) and finding.exact_relation != "touching"
    error = None
    if not (pair.closer or a.holed or b.holed or block):  # the block of a half space may be off
        error = check_distance(claim, spans=spans)
    most = _most_depth(finding, depth=depth, mtv=mtv)
    thickest = _check_thickness(claim, most)
    if not overlap and not hulls_apart:
        check_holes(max(tolerance, claim.clearance), a, b)
        check_pieces(a, b)

    slack = rounding.of(tolerance)
    if finding.relation == "near":
        prove_apart(claim, max(tolerance - slack, Fraction(0)))
    if finding.relation in OVERLAPS and most is not None and most + slack < tolerance:
        raise Rejected("the overlap is within the tolerance: the bodies touch")
    _check_name(claim, both_ends=both_ends, mtv=mtv)
    _check_severity(claim, most, thickest)
    thick = Fraction(finding.thickness or 0)
    ball = isinstance(pair, Pair) and finding.thickness_bounds is not None and not pair.closer
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


def _check_ball(claim: Claim) -> bool:
    """Return whether the finding has a ball that two solids share. Rejects one that is not in
    both."""
    ball, pair = claim.finding.ball, claim.pair
    if ball is None or not isinstance(pair, Pair):
        return False
    for body in (pair.a, pair.b):
        holds_ball(body, ball.centre, Fraction(ball.radius))
    return ball.radius > 0


def _prove_relation(claim: Claim, shares_ball: bool) -> bool:
    """Returns whether the relation also holds for the hulls; then neither body can lie inside the
    other. shares_ball: then an overlap needs no other proof, if the boxes show that neither body
    holds the other."""
    relation, pair, across = claim.finding.exact_relation, claim.pair, claim.request.across
    ends, proof = pair, claim.certificate.relation
    if across is not None and isinstance(pair, Pair):
        _check_in_plane(claim, across)
        ends = prisms(pair, relation, across)
        if relation != "separated":
            check_overlap_of_curves(relation, ends)
    if relation == "penetrating" and isinstance(proof, SurfacesProof) and shares_ball:
        assert isinstance(pair, Pair)
        if stick_out(pair.a, pair.b, Fraction(0), across):
            return False
    beyond = claim.tolerance if claim.finding.relation == "separated" else Fraction(0)
    return prove(relation, proof, ends, max(beyond, pair.closer), claim.least_gap + pair.closer)


def _check_in_plane(claim: Claim, across: int) -> None:
    """Directions and moves of a finding, and of its certificate, run along the plane."""
    finding, certificate = claim.finding, claim.certificate
    directions: list[ExactVector | UnsetType | None] = [finding.mtv, finding.normal]
    if not isinstance(certificate.depth, UnsetType):
        directions.append(certificate.depth.upper)
    if not isinstance(certificate.band, UnsetType):
        directions += [certificate.band.axis, certificate.band.move]
    for direction in directions:
        if isinstance(direction, tuple) and vector(direction)[across] != 0:
            raise Rejected("a direction leaves the plane")


def _check_depth(claim: Claim) -> bool:
    """Checks the interval of the depth: a ball in the Minkowski difference proves the lower bound,
    an axis the upper bound."""
    bounds, proof, pair = claim.finding.depth_bounds, claim.certificate.depth, claim.pair
    if bounds is None or isinstance(proof, UnsetType):
        return False
    low, high = map(Fraction, bounds)
    if not (isinstance(pair, Pair) and pair.convex):
        raise Rejected("a depth is certified for convex meshes only")
    inner_radius_exceeds(proof.lower, pair.a, pair.b, low)
    if pair.gap(axis(proof.upper), pair.closer - high) < 0:
        raise Rejected("along the axis the bodies overlap by more than the depth")
    return True


def _check_cover(claim: Claim) -> bool:
    """Checks the lower bound of the depth of bodies that are not both convex, if it is
    certified."""
    bounds, cover, pair = claim.finding.depth_bounds, claim.certificate.cover, claim.pair
    if isinstance(cover, UnsetType):
        return False
    if bounds is None or not isinstance(pair, Pair):
        raise Rejected("a cover, and no depth of meshes")
    depth_is_at_least(cover, pair.a, pair.b, bounds[0])
    return True


def _check_thickness(claim: Claim, depth: Fraction | None) -> Fraction | None:
    """An upper bound of the thickness, as far as one is proven. depth: a bound of the depth; no
    overlap is thicker than it is deep. The prisms of a check in a plane are higher than wide: the
    largest ball in both has the diameter of the largest disc. Of curves nothing is proven."""
    finding, cells, pair = claim.finding, claim.certificate.thickness, claim.pair
    if isinstance(cells, UnsetType):
        return depth
    if finding.thickness is None or pair.closer or not isinstance(pair, Pair):
        raise Rejected("cells, and no thickness of polyhedra")
    thickness = Fraction(finding.thickness)
    at_most(cells, pair.a, pair.b, thickness / 2, (Fraction(0), Fraction(0)))
    return thickness if depth is None else min(thickness, depth)


def _check_name(claim: Claim, *, both_ends: bool, mtv: bool) -> None:
    """Rejects a relation that does not follow from the exact one, which is proven. both_ends, mtv:
    whether the depth is, and the way out."""
    relation, exact = claim.finding.relation, claim.finding.exact_relation
    band = claim.tolerance * (1 + EXACT_WIDTH)
    near, within = relation == "near", relation == "touching" != exact
    if exact == "separated" and (near or within):
        if not is_within(claim, claim.clearance if near else band, open_=near):
            raise Rejected("the gap is wider than that")
    elif within:
        within = exact in OVERLAPS and _is_in_band(claim, band, both_ends=both_ends, mtv=mtv)
    if exact is None or named(exact, within, not near) != relation:
        raise Rejected(f"{relation!r} does not follow from {exact!r}")


def _is_in_band(claim: Claim, band: Fraction, *, both_ends: bool, mtv: bool) -> bool:
    """Return whether a way out of the overlap is within the touch band, or surfaces that may be off
    explain it."""
    finding, proof, pair = claim.finding, claim.certificate.band, claim.pair
    if isinstance(proof, UnsetType):
        is_shallow = both_ends and finding.depth is not None and finding.depth <= band
        return is_shallow or (mtv and _is_short(vector(finding.mtv or ()), band))
    if not isinstance(proof.axis, UnsetType):
        if pair.convex and pair.gap(axis(proof.axis), -band) >= 0:
            return True
        raise Rejected("the bodies overlap by more than the tolerance")
    if not isinstance(proof.excuse, UnsetType):
        if pair.closer or not isinstance(pair, Pair):
            raise Rejected("an excuse of polygons, and not of their curves")
        is_explained(proof.excuse, pair, Fraction(finding.tolerance or 0.0))
        return True
    move = vector(given(proof.move, "move"))
    if not _is_short(move, band):
        return False
    if isinstance(proof.free, UnsetType):
        raise Rejected("the certificate has no 'free'")
    prove_way_out(move, proof.free, *pair.placed)
    return True


def _is_short(move: Point, band: Fraction) -> bool:
    return bool(dot(move, move) <= band * band)


def _check_mtv(claim: Claim) -> bool:
    """A, moved by the MTV with one rounding of each coordinate, has no common interior with B.

    `check_figures` has checked that an overlap has the MTV, and that it is as long as the depth.
    Returns False if the finding does not claim this, or if it is not certified.
    """
    finding, proof = claim.finding, claim.certificate.mtv
    if finding.mtv_verified is not True or finding.mtv is None:
        if not isinstance(proof, UnsetType):
            raise Rejected("the certificate has an 'mtv', which the finding calls unverified")
        return False
    if isinstance(proof, UnsetType):
        if claim.pair.closer:
            return False
        raise Rejected("the certificate has no 'mtv'")
    prove_way_out(vector(finding.mtv), proof, *claim.pair.placed)
    return True


def prove_way_out(move: Point, proof: Proof, a: Placed, b: Placed) -> None:
    offset = [float(c) for c in move]
    if not np.isfinite(offset).all():
        raise Rejected("a translation is finite")
    moved = a.moved(offset)
    if isinstance(proof, SurfacesProof):
        check_holes(Fraction(0), moved, b)
    pair = any_pair_of(moved, b)
    prove_free(proof, pair)
    closer = pair.closer  # curves may be as far off their polygons
    if closer and not (isinstance(proof, AxisProof) and pair.gap(axis(proof.axis), closer) > 0):
        raise Rejected("the way out is shown of polygons alone, not of the curves")


def _check_severity(claim: Claim, depth: Fraction | None, thickness: Fraction | None) -> None:
    """Rejects a severity, a rule or an `undecided` that does not follow. depth, thickness: proven
    upper bounds; None: there is none. That an overlap is within its limit, or a gap keeps its
    clearance, has to be proven. That it is not follows from the figures of the finding. Volumes are
    not certified."""
    finding, request = claim.finding, claim.request
    kept, overlap = None, finding.relation in OVERLAPS
    if request.clearance and not overlap and finding.relation != "near":
        kept = keeps(claim)
    judgement = judged(finding, replace(request, severity=None), (0.0, inf), kept)
    if overlap and judgement.severity == "note":
        limits = request.max_depth, request.max_thickness, request.max_volume
        for limit, bound in zip(limits, (depth, thickness, None), strict=True):
            if limit is not None and not (bound is not None and bound <= Fraction(limit) * WIDER):
                raise Rejected("that it is within its limits is not certified")
    judgement = by_rule(judgement, request)
    if any(stage.stage == CROSS_CHECK and stage.result == "disagrees" for stage in finding.plan):
        judgement = disputed(judgement, None)
    follows = judgement.severity, judgement.undecided, judgement.rule
    if (finding.severity, finding.undecided, finding.rule) != follows:
        raise Rejected(
            f"its severity is {judgement.severity!r} by the rule {judgement.rule!r}, "
            f"and what is undecided {judgement.undecided!r}"
        )
