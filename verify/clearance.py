"""Check how close a pair is claimed to be: its boxes, its touch band, its clearance."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction

from satcheck.report.certificate import Certificate
from satcheck.report.report import OVERLAPS, Finding
from satcheck.report.request import Request
from satcheck.verify.bodies import Placed
from satcheck.verify.boundary import boundary_point, contacts_if_apart
from satcheck.verify.evidence import gap_along, given
from satcheck.verify.exact import Point, Rejected, dot, sub
from satcheck.verify.figures import EXACT_WIDTH, default_tolerance
from satcheck.verify.holes import check_holes
from satcheck.verify.in_plane import curve_error
from satcheck.verify.relations import Pair
from satcheck.verify.severity import ProvenFigures, check_severity

CERTAINLY = 1 + 1e-12  # far more than the rounding of a difference


def least_gap(finding: Finding, request: Request) -> Fraction:
    """The least gap that a finding may have if it claims to keep its clearance. A gap that equals
    the clearance up to rounding keeps it."""
    if finding.relation != "separated" or finding.undecided == "limit":
        return Fraction(0)
    return Fraction(request.clearance or 0.0) * (1 - EXACT_WIDTH)


@dataclass(frozen=True, slots=True)
class GapProof:
    """What a certificate shows of a gap. squared: of the gap between two points. apart: rejects a
    narrower gap. closer: by how much curves may be closer than their polygons."""

    squared: Callable[[], Fraction]
    apart: Callable[[Fraction], None]
    closer: Fraction = Fraction(0)


def check_claims(
    finding: Finding,
    request: Request,
    tolerance: Fraction,
    gap: GapProof,
    is_in_band: Callable[[Fraction], bool],
    bounds: tuple[Fraction | None, Fraction | None],
) -> None:
    """Checks that the relation and the severity follow from the exact relation, which is proven.
    is_in_band: whether an overlap is within such a band. bounds: proven upper bounds of depth and
    thickness."""
    relation, exact = finding.relation, finding.exact_relation
    band, clearance = tolerance * (1 + EXACT_WIDTH), Fraction(request.clearance or 0.0)
    if exact == "separated" and relation in ("touching", "near"):
        squared = gap.squared()
        if not (squared < clearance**2 if relation == "near" else squared <= band**2):
            raise Rejected("the points of the gap are further apart than that")
    elif relation != exact and not (
        exact in OVERLAPS and relation == "touching" and is_in_band(band)
    ):
        raise Rejected(f"{relation!r} does not follow from {exact!r}")

    def keeps(length: Fraction) -> bool | None:
        return _keeps_clearance(finding, length, gap)

    check_severity(finding, request, ProvenFigures(*bounds, keeps, EXACT_WIDTH))


def _keeps_clearance(finding: Finding, clearance: Fraction, gap: GapProof) -> bool | None:
    """Return whether the gap keeps the clearance, whatever the touch band; None: not proven either
    way."""
    if finding.exact_relation != "separated":
        return False
    if finding.relation == "separated":  # then that is a part of what was proven
        return None if finding.undecided == "limit" else True
    if gap.squared() < clearance**2:
        return False
    try:
        gap.apart(clearance * (1 - EXACT_WIDTH) + gap.closer)
    except Rejected:
        return None
    return True


def prove_apart(
    certificate: Certificate, pair: Pair, bodies: tuple[Placed, Placed], least: Fraction
) -> None:
    """Rejects separated bodies with a narrower gap."""
    if not pair.convex:
        check_holes(*bodies, least)
        contacts_if_apart(pair.a, pair.b, Fraction(0), least)
        return
    gap = given(certificate.gap, "gap")
    p = boundary_point(gap.a, pair.a, of_hull=True)
    q = boundary_point(gap.b, pair.b, of_hull=True)
    n: Point = sub(q, p)  # type: ignore[arg-type, assignment]
    along = gap_along(pair.a, pair.b, n)
    if along <= 0 or along * along < least * least * dot(n, n):
        raise Rejected("the gap is not shown to be as wide")


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
