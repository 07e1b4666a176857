"""Check how close a pair is claimed to be: its boxes, its touch band, its clearance."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction

from satcheck.report.certificate import Certificate
from satcheck.report.report import OVERLAPS, Finding
from satcheck.report.request import Request
from satcheck.verify.bodies import Placed
from satcheck.verify.distances import is_within, prove_apart
from satcheck.verify.exact import Rejected
from satcheck.verify.figures import EXACT_WIDTH, default_tolerance
from satcheck.verify.in_plane import curve_error
from satcheck.verify.pairs import AnyPair
from satcheck.verify.severity import ProvenFigures, check_severity

CERTAINLY = 1 + 1e-12  # far more than the rounding of a difference


def least_gap(finding: Finding, request: Request) -> Fraction:
    """The least gap that a finding may have if it claims to keep its clearance. A gap that equals
    the clearance up to rounding keeps it."""
    if finding.relation != "separated" or finding.undecided == "limit":
        return Fraction(0)
    return Fraction(request.clearance or 0.0) * (1 - EXACT_WIDTH)


def check_claims(
    finding: Finding,
    certificate: Certificate,
    pair: AnyPair,
    bodies: tuple[Placed, Placed],
    request: Request,
    tolerance: Fraction,
    is_in_band: Callable[[Fraction], bool],
    bounds: tuple[Fraction | None, Fraction | None],
) -> None:
    """Checks that the relation and the severity follow from the exact relation, which is proven.
    is_in_band: whether an overlap is within such a band. bounds: proven upper bounds of depth and
    thickness."""
    relation, exact = finding.relation, finding.exact_relation
    band, clearance = tolerance * (1 + EXACT_WIDTH), Fraction(request.clearance or 0.0)
    if exact == "separated" and relation in ("touching", "near"):
        near = relation == "near"
        if not is_within(certificate, pair, clearance if near else band, open_=near):
            raise Rejected("the gap is wider than that")
    elif relation != exact and not (
        exact in OVERLAPS and relation == "touching" and is_in_band(band)
    ):
        raise Rejected(f"{relation!r} does not follow from {exact!r}")

    def keeps(length: Fraction) -> bool | None:
        """Whether the gap keeps the clearance, whatever the touch band; None: not proven either
        way."""
        if exact != "separated":
            return False
        if relation == "separated":  # then that is a part of what was proven
            return None if finding.undecided == "limit" else True
        if is_within(certificate, pair, length, open_=True):
            return False
        try:
            least = length * (1 - EXACT_WIDTH) + curve_error(*bodies)
            prove_apart(certificate, pair, bodies, least)
        except Rejected:
            return None
        return True

    check_severity(finding, request, ProvenFigures(*bounds, keeps, EXACT_WIDTH))


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
    tolerance = request.tolerance
    if tolerance is None:
        tolerance = default_tolerance(a, b, request.across)
    beyond = max(Fraction(tolerance), Fraction(request.clearance or 0.0) + closer)
    exact = [
        max(Fraction(p) - Fraction(q), Fraction(r) - Fraction(s), Fraction(0))
        for p, q, r, s in zip(*(c.tolist() for c in (low_b, high_a, low_a, high_b)), strict=True)
    ]
    return sum(step * step for step in exact) > beyond * beyond
