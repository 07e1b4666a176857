"""Check that the boxes of two bodies are too far apart to matter."""

from __future__ import annotations

from fractions import Fraction

from satcheck.report.request import Request
from satcheck.verify.bodies import Placed
from satcheck.verify.figures import default_tolerance
from satcheck.verify.in_plane import curve_error

CERTAINLY = 1 + 1e-12  # far more than the rounding of a difference


def boxes_apart(a: Placed, b: Placed, request: Request) -> bool:
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
