"""One finding of a pair with a curved shape."""

from __future__ import annotations

from fractions import Fraction

from satcheck.report.certificate import Certificate
from satcheck.report.report import OVERLAPS, Finding
from satcheck.report.request import Request
from satcheck.verify.bodies import Placed
from satcheck.verify.clearance import keeps_clearance, least_gap
from satcheck.verify.curved_pair import CurvedPair, curved_pair_of
from satcheck.verify.distances import spanned
from satcheck.verify.evidence import axis, given
from satcheck.verify.exact import Rejected
from satcheck.verify.figures import EXACT_WIDTH, rounding_of
from satcheck.verify.severity import ProvenFields, ProvenFigures, check_severity, proven_depth
from satcheck.verify.way_out import check_mtv


def check_curved(
    finding: Finding,
    certificate: Certificate,
    a: Placed,
    b: Placed,
    request: Request,
    tolerance: Fraction,
) -> ProvenFields:
    """Checks a finding of two solids with at least one curved shape. Their depth is not
    certified."""
    pair = curved_pair_of(a, b)
    relation, exact = finding.relation, finding.exact_relation
    clearance = Fraction(request.clearance or 0.0)
    separated = relation == "separated"
    beyond, least = (tolerance if separated else Fraction(0)), least_gap(finding, request)
    pair.prove(exact, certificate.relation, beyond, least)
    mtv = check_mtv(finding, certificate, a, b)
    rounding = rounding_of(a, b)
    spans = spanned(finding, rounding, lambda n, length: pair.gap(n, length) >= 0)
    error = 2 * rounding.of(Fraction(finding.distance or 0.0)) if spans else None
    if exact == "touching":
        error = Fraction(0)
    proven = ProvenFields(False, mtv, error, spans or mtv)
    if relation != exact:
        band = tolerance * (1 + EXACT_WIDTH)
        if exact == "separated" and relation in ("touching", "near"):
            squared, near = pair.squared_gap(given(certificate.gap, "gap")), relation == "near"
            if not (squared < clearance**2 if near else squared <= band**2):
                raise Rejected("the points of the gap are further apart than that")
        elif not (
            exact in OVERLAPS and relation == "touching" and _in_band(certificate, pair, band)
        ):
            raise Rejected(f"{relation!r} does not follow from {exact!r}")

    def keeps(length: Fraction) -> bool | None:
        return keeps_clearance(
            finding,
            length,
            lambda: pair.squared_gap(given(certificate.gap, "gap")),
            lambda least: pair.prove_apart(given(certificate.gap, "gap"), least),
        )

    most = proven_depth(finding, proven)
    check_severity(finding, request, ProvenFigures(most, most, keeps, EXACT_WIDTH))
    return proven


def _in_band(certificate: Certificate, pair: CurvedPair, band: Fraction) -> bool:
    """Return whether the overlap along the axis of the certificate is within the tolerance."""
    proof = given(certificate.band, "band")
    if pair.gap(axis(given(proof.axis, "axis")), -band) < 0:
        raise Rejected("the bodies overlap by more than the tolerance")
    return True
