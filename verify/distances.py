"""The proofs of how far two bodies are apart.

The certificate names a point of each convex body: the planes normal to the step between them show
that nothing is nearer. For other meshes every triangle that could be nearer is checked. The
distance may be off by the last rounding of a figure, and by no more. For curved shapes the normal
and the witness points of the finding are the proof, up to their own rounding. Of an open surface
the fills of its holes may be nearer, and pieces of it may surround the other body. In a plane a
polygon may replace a curve, within which it lies. A proof must then hold for every boundary around
the polygon whose distance from it is at most the deviation of the body.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

from msgspec import UnsetType

from satcheck.report.certificate import Certificate
from satcheck.report.report import Finding
from satcheck.report.request import Request
from satcheck.report.values import Relation
from satcheck.scene.inspect import MOST_AROUND
from satcheck.verify.bodies import Placed, box_gaps, curve_error
from satcheck.verify.cells import contacts_if_apart
from satcheck.verify.exact import Rejected, TooMany, dot
from satcheck.verify.figures import EXACT_WIDTH, Rounding, tolerance_of
from satcheck.verify.meshes import turns_around
from satcheck.verify.pairs import AnyPair, Pair, given, vector
from satcheck.verify.surfaces import close_pairs
from satcheck.verify.world import Exact, stick_out

# Beyond this many pairs of triangles with near boxes there is no certificate.
MOST_NEAR = 2_000_000


@dataclass(frozen=True, slots=True)
class Claim:
    """A finding to be checked. tolerance: the width of its touch band."""

    finding: Finding
    certificate: Certificate
    pair: AnyPair
    request: Request
    tolerance: Fraction
    rounding: Rounding

    @property
    def clearance(self) -> Fraction:
        return Fraction(self.request.clearance or 0.0)

    @property
    def least_gap(self) -> Fraction:
        """The least gap that the finding may have if it claims to keep its clearance. A gap that
        equals the clearance up to rounding keeps it."""
        if self.finding.relation != "separated" or self.finding.undecided == "limit":
            return Fraction(0)
        return self.clearance * (1 - EXACT_WIDTH)


def spanned(claim: Claim) -> bool:
    """Return whether the gap or the overlap of a convex pair along the normal is what the finding
    states. Rejects a closer pair."""
    finding, pair = claim.finding, claim.pair
    figure = finding.distance if finding.depth is None else -finding.depth
    if finding.normal is None or figure is None or not pair.convex:
        return False
    length = Fraction(figure)
    if pair.gap(vector(finding.normal), length - 2 * claim.rounding.of(length)) < 0:
        raise Rejected("along the normal the bodies are closer than the finding says")
    return finding.witness is not None


def check_distance(claim: Claim, *, spans: bool) -> Fraction | None:
    """Return how far the distance may be off; None: it is not proven. spans: see `spanned`."""
    finding, pair = claim.finding, claim.pair
    if finding.exact_relation == "touching":
        return Fraction(0)
    if finding.distance is None:
        return None
    length = Fraction(finding.distance)
    if not isinstance(pair, Pair):
        return 2 * claim.rounding.of(length) if spans else None
    error = EXACT_WIDTH * length
    if not pair.convex:
        try:
            nearest = nothing_nearer(pair.a, pair.b, length - error, length + error)
        except TooMany:
            return None
        if not nearest:
            raise Rejected("the bodies are further apart than the distance")
        return error
    if isinstance(claim.certificate.distance, UnsetType):
        return None
    step = pair.step(claim.certificate.distance)
    if dot(step, step) > (length + error) ** 2:
        raise Rejected("the points of the distance are further apart than that")
    if pair.gap(step, length - error) < 0:
        raise Rejected("the bodies are closer than the distance")
    return error


def nothing_nearer(a: Exact, b: Exact, length: Fraction, most: Fraction) -> bool:
    """Rejects surfaces that are closer than a length. Returns whether they are within `most` of
    each other. Both in world units."""
    found = False
    for _, _, squared in close_pairs(a, b, most, MOST_NEAR):
        found = True
        if length > 0 and squared < length**2:
            raise Rejected("triangles of the bodies are closer than the distance")
    return found


def check_overlap_of_curves(relation: Relation | None, pair: Pair) -> None:
    """Rejects an exact relation of bodies that meet if it is proven of the polygons only. pair:
    with heights that suit the relation.

    A body lies within another if its polygon does, with more room than the deviation. Bodies
    overlap if their polygons do. Neither body contains the other if the box of each sticks out of
    the other by more than the deviation.
    """
    closer = pair.closer
    if not closer:
        return
    if relation in ("contains", "inside"):
        nothing_nearer(pair.a, pair.b, closer, closer)
        return
    if relation != "penetrating":
        raise Rejected(f"{relation!r} is shown of polygons alone, not of the curves")
    if not stick_out(pair.a, pair.b, closer, pair.across):
        raise Rejected("one body may hold the other, by what its curve is off its polygon")


def is_within(claim: Claim, length: Fraction, *, open_: bool) -> bool:
    """Return whether the gap of separated bodies is shown to be at most a length, world units.
    open_: or less than that."""
    pair = claim.pair
    if isinstance(pair, Pair) and not pair.convex:
        return any(s < length**2 or not open_ for *_, s in close_pairs(pair.a, pair.b, length))
    step = pair.step(given(claim.certificate.gap, "gap"))
    squared = dot(step, step)
    return bool(squared < length**2 if open_ else squared <= length**2)


def prove_apart(claim: Claim, least: Fraction) -> None:
    """Rejects separated bodies with a narrower gap."""
    pair = claim.pair
    if isinstance(pair, Pair) and not pair.convex:
        check_holes(least, *pair.placed)
        contacts_if_apart(pair.a, pair.b, Fraction(0), least)
        return
    n = pair.step(given(claim.certificate.gap, "gap"))
    if pair.gap(n) <= 0 or pair.gap(n, least) < 0:
        raise Rejected("the gap is not shown to be as wide")


def keeps(claim: Claim) -> bool | None:
    """Return whether the gap keeps the clearance, whatever the touch band; None: not proven either
    way."""
    finding = claim.finding
    if finding.exact_relation != "separated":
        return False
    if finding.relation == "separated":  # then that is a part of what was proven
        return None if finding.undecided == "limit" else True
    if is_within(claim, claim.clearance, open_=True):
        return False
    try:
        prove_apart(claim, claim.clearance * (1 - EXACT_WIDTH) + claim.pair.closer)
    except Rejected:
        return None
    return True


def check_pieces(a: Placed, b: Placed) -> None:
    """Rejects bodies that do not meet if open pieces of one surround the other."""
    for outer, inner in ((a, b), (b, a)):
        pieces = None if outer.shape is None else outer.shape.pieces
        if outer.world is None or inner.world is None or pieces is None:
            continue
        world, point = outer.world, inner.world.vertices[0]
        low, high = world.bounds
        is_inside = (low <= point).all() and (point <= high).all()
        if is_inside and abs(turns_around(world.vertices[pieces], point)) > MOST_AROUND:
            raise Rejected(f"open pieces of {outer.id} surround {inner.id}")


def check_holes(margin: Fraction, a: Placed, b: Placed) -> None:
    """Rejects bodies with holes unless the gap of their boxes is large enough: the fill of a hole
    may be anywhere near."""
    if (a.holed or b.holed) and max(box_gaps(a, b)) <= margin * (1 + EXACT_WIDTH):
        raise Rejected("what fills a hole is not certified, and may be where the other body is")


CERTAINLY = 1 + 1e-12  # far more than the rounding of a difference


def boxes_apart(a: Placed, b: Placed, request: Request) -> bool:
    """Return whether the boxes of two bodies are too far apart to matter."""
    if a.bounds is None or b.bounds is None:
        return False
    (low_a, high_a), (low_b, high_b) = a.bounds, b.bounds
    most = a.resolution + b.resolution if request.tolerance is None else request.tolerance
    widest = max((low_b - high_a).max(), (low_a - high_b).max())
    if widest <= 0:
        return False
    closer = curve_error(a, b)
    if widest > max(most, (request.clearance or 0.0) + float(closer)) * CERTAINLY:
        return True
    tolerance = Fraction(tolerance_of(a, b, request))
    beyond = max(tolerance, Fraction(request.clearance or 0.0) + closer)
    return sum(max(gap, Fraction(0)) ** 2 for gap in box_gaps(a, b)) > beyond * beyond
