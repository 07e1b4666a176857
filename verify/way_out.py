"""Check that A, moved by a translation, has no common interior with B."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
from msgspec import UnsetType

from satcheck.report.certificate import Certificate, Proof, SurfacesProof
from satcheck.report.report import OVERLAPS, Finding
from satcheck.verify.bodies import Placed
from satcheck.verify.evidence import vector
from satcheck.verify.exact import Point, Rejected, dot
from satcheck.verify.figures import EXACT_WIDTH, rounding_of
from satcheck.verify.holes import check_holes
from satcheck.verify.in_plane import curve_error, leaves_gap_of_curves
from satcheck.verify.pairs import any_pair_of
from satcheck.verify.relations import prove_free


def check_mtv(finding: Finding, certificate: Certificate, a: Placed, b: Placed) -> bool:
    """A, moved by the MTV with one rounding of each coordinate, has no common interior with B.

    The MTV is longer than the depth by some rounding, because it is lengthened until the rounded
    coordinates are free. Returns False if the finding does not claim this, or if it is not
    certified.
    """
    if finding.mtv_verified is not True:
        return False
    if finding.exact_relation not in OVERLAPS:
        raise Rejected("only an overlap has a way out")
    if finding.depth is None or finding.mtv is None:
        raise Rejected("a verified MTV comes with its depth")
    depth, move = Fraction(finding.depth), vector(finding.mtv)
    if dot(move, move) > (depth + EXACT_WIDTH * (depth + rounding_of(a, b).largest)) ** 2:
        raise Rejected("the MTV is longer than the depth")
    if isinstance(certificate.mtv, UnsetType):
        if curve_error(a, b):
            return False
        raise Rejected("the certificate has no 'mtv'")
    prove_way_out(move, certificate.mtv, a, b)
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
