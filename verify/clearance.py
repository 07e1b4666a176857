"""Check that the gap of a finding keeps its clearance."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction

from satcheck.report.certificate import Certificate
from satcheck.report.report import Finding
from satcheck.report.request import Request
from satcheck.verify.bodies import Placed
from satcheck.verify.boundary import boundary_point, contacts_if_apart
from satcheck.verify.evidence import gap_along, given
from satcheck.verify.exact import Point, Rejected, dot, sub
from satcheck.verify.figures import EXACT_WIDTH
from satcheck.verify.holes import check_holes
from satcheck.verify.relations import Pair


def least_gap(finding: Finding, request: Request) -> Fraction:
    """The least gap that a finding may have if it claims to keep its clearance. A gap that equals
    the clearance up to rounding keeps it."""
    if finding.relation != "separated" or finding.undecided == "limit":
        return Fraction(0)
    return Fraction(request.clearance or 0.0) * (1 - EXACT_WIDTH)


def keeps_clearance(
    finding: Finding,
    clearance: Fraction,
    squared: Callable[[], Fraction],
    prove_apart: Callable[[Fraction], None],
    closer: Fraction = Fraction(0),
) -> bool | None:
    """Return whether the gap keeps the clearance, independent of the touch band; None: not proven
    either way. squared: of the gap between two points. prove_apart: rejects a narrower gap. closer:
    by how much curves may be closer than their polygons."""
    if finding.exact_relation != "separated":
        return False
    if finding.relation == "separated":  # then that is a part of what was proven
        return None if finding.undecided == "limit" else True
    if squared() < clearance**2:
        return False
    try:
        prove_apart(clearance * (1 - EXACT_WIDTH) + closer)
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
