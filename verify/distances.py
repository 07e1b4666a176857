"""The proofs of how far two bodies are apart.

The certificate names a point of each convex body: the planes normal to the step between them show
that nothing is nearer. For other meshes every triangle that could be nearer is checked. The
distance may be off by the last rounding of a figure, and by no more. For curved shapes the normal
and the witness points of the finding are the proof, up to their own rounding.
"""

from __future__ import annotations

from fractions import Fraction

from msgspec import UnsetType

from satcheck.report.certificate import Certificate
from satcheck.report.report import Finding
from satcheck.verify.bodies import Placed
from satcheck.verify.boundary import contacts_if_apart
from satcheck.verify.evidence import given, vector
from satcheck.verify.exact import Rejected, TooMany, dot
from satcheck.verify.figures import EXACT_WIDTH, Rounding
from satcheck.verify.holes import check_holes
from satcheck.verify.pairs import AnyPair, Pair
from satcheck.verify.surfaces import close_pairs
from satcheck.verify.world import Exact

# Beyond this many pairs of triangles with near boxes there is no certificate.
MOST_NEAR = 2_000_000


def spanned(finding: Finding, rounding: Rounding, pair: AnyPair) -> bool:
    """Return whether the gap or the overlap of a convex pair along the normal is what the finding
    states. Rejects a closer pair."""
    figure = finding.distance if finding.depth is None else -finding.depth
    if finding.normal is None or figure is None:
        return False
    length = Fraction(figure)
    if pair.gap(vector(finding.normal), length - 2 * rounding.of(length)) < 0:
        raise Rejected("along the normal the bodies are closer than the finding says")
    return finding.witness is not None


def check_distance(finding: Finding, certificate: Certificate, pair: Pair) -> Fraction | None:
    """Return how far the distance of meshes may be off; None: it is not proven."""
    if finding.exact_relation == "touching":
        return Fraction(0)
    if finding.distance is None:
        return None
    length = Fraction(finding.distance)
    error = EXACT_WIDTH * length
    if not pair.convex:
        try:
            nearest = nothing_nearer(pair.a, pair.b, length - error, length + error)
        except TooMany:
            return None
        if not nearest:
            raise Rejected("the bodies are further apart than the distance")
        return error
    if isinstance(certificate.distance, UnsetType):
        return None
    step = pair.step(certificate.distance)
    if dot(step, step) > (length + error) ** 2:
        raise Rejected("the points of the distance are further apart than that")
    if pair.gap(step, length - error) < 0:
        raise Rejected("the bodies are closer than the distance")
    return error


def nothing_nearer(a: Exact, b: Exact, length: Fraction, most: Fraction) -> bool:
    """Rejects surfaces that are closer than a length. Returns whether they are within `most` of
    each other. Both in world units."""
    least, found = (length * (1 << a.k)) ** 2, False
    for _, _, squared in close_pairs(a, b, most, MOST_NEAR):
        found = True
        if length > 0 and squared < least:
            raise Rejected("triangles of the bodies are closer than the distance")
    return found


def is_within(certificate: Certificate, pair: AnyPair, length: Fraction, *, open_: bool) -> bool:
    """Return whether the gap of separated bodies is shown to be at most a length, world units.
    open_: or less than that."""
    if isinstance(pair, Pair) and not pair.convex:
        least = (length * (1 << pair.a.k)) ** 2
        return any(s < least or not open_ for *_, s in close_pairs(pair.a, pair.b, length))
    step = pair.step(given(certificate.gap, "gap"))
    squared = dot(step, step)
    return bool(squared < length**2 if open_ else squared <= length**2)


def prove_apart(
    certificate: Certificate, pair: AnyPair, bodies: tuple[Placed, Placed], least: Fraction
) -> None:
    """Rejects separated bodies with a narrower gap."""
    if isinstance(pair, Pair) and not pair.convex:
        check_holes(*bodies, least)
        contacts_if_apart(pair.a, pair.b, Fraction(0), least)
        return
    n = pair.step(given(certificate.gap, "gap"))
    if pair.gap(n) <= 0 or pair.gap(n, least) < 0:
        raise Rejected("the gap is not shown to be as wide")
