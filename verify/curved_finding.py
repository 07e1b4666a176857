"""One finding of a pair with a curved shape."""

from __future__ import annotations

from fractions import Fraction
from functools import partial

from satcheck.report.certificate import Certificate
from satcheck.report.report import Finding
from satcheck.report.request import Request
from satcheck.verify.bodies import Placed
from satcheck.verify.clearance import GapProof, check_claims, least_gap
from satcheck.verify.curved_pair import CurvedPair, curved_pair_of
from satcheck.verify.distances import spanned
from satcheck.verify.evidence import axis, given
from satcheck.verify.exact import Rejected
from satcheck.verify.figures import rounding_of
from satcheck.verify.severity import ProvenFields, proven_depth
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
    gap = GapProof(
        lambda: pair.squared_gap(given(certificate.gap, "gap")),
        lambda least: pair.prove_apart(given(certificate.gap, "gap"), least),
    )
    most = proven_depth(finding, proven)
    in_band = partial(_in_band, certificate, pair)
    check_claims(finding, request, tolerance, gap, in_band, (most, most))
    return proven


def _in_band(certificate: Certificate, pair: CurvedPair, band: Fraction) -> bool:
    """Return whether the overlap along the axis of the certificate is within the tolerance."""
    proof = given(certificate.band, "band")
    if pair.gap(axis(given(proof.axis, "axis")), -band) < 0:
        raise Rejected("the bodies overlap by more than the tolerance")
    return True
