"""The proof of the distance of two bodies.

The certificate names a point of each mesh. For convex meshes the planes normal to the step between
them prove that nothing is nearer; for other meshes every triangle that could be nearer is checked.
The distance may be off by the last rounding of a figure, and by no more. For curved shapes the
normal and the witness points of the finding are the proof, up to their own rounding.
"""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction

from satcheck.report.certificate import Ends
from satcheck.report.report import Finding
from satcheck.verify.boundary import boundary_point
from satcheck.verify.evidence import gap_along, vector
from satcheck.verify.exact import Point, Rejected, dot, sub
from satcheck.verify.figures import EXACT_WIDTH, Rounding
from satcheck.verify.relations import Pair
from satcheck.verify.surfaces import close_pairs
from satcheck.verify.world import Exact

# Beyond this many pairs of triangles with near boxes there is no certificate.
MOST_NEAR = 2_000_000


def squared_gap(ends: Ends, pair: Pair) -> Fraction:
    """Return the squared distance of a point of either body, world units."""
    p = boundary_point(ends.a, pair.a, of_hull=pair.convex)
    q = boundary_point(ends.b, pair.b, of_hull=pair.convex)
    step = sub(q, p)  # type: ignore[arg-type]
    return Fraction(dot(step, step)) / (1 << 2 * pair.a.k)


def spanned(
    finding: Finding, rounding: Rounding, is_apart: Callable[[Point, Fraction], bool]
) -> bool:
    """Return whether the gap or the overlap of a convex pair along the normal is what the finding
    states. Rejects a closer pair. is_apart: whether the gap along an axis is at least a length,
    world units; the length may be negative.
    """
    figure = finding.distance if finding.depth is None else -finding.depth
    if finding.normal is None or figure is None:
        return False
    length = Fraction(figure)
    if not is_apart(vector(finding.normal), length - 2 * rounding.of(length)):
        raise Rejected("along the normal the bodies are closer than the finding says")
    return finding.witness is not None


def hulls_are_apart(pair: Pair) -> Callable[[Point, Fraction], bool]:
    def is_apart(n: Point, length: Fraction) -> bool:
        gap = gap_along(pair.a, pair.b, n)
        longer = gap * gap - length * length * dot(n, n)
        if gap >= 0:
            return length <= 0 or longer >= 0
        return length < 0 and longer <= 0

    return is_apart


def check_distance(distance: float, ends: Ends, pair: Pair) -> Fraction:
    """Returns how far the distance of meshes may be off. ends: points of them with that
    distance."""
    length = Fraction(distance)
    error = EXACT_WIDTH * length
    p = boundary_point(ends.a, pair.a, of_hull=pair.convex)
    q = boundary_point(ends.b, pair.b, of_hull=pair.convex)
    step: Point = sub(q, p)  # type: ignore[arg-type, assignment]
    if Fraction(dot(step, step)) / (1 << 2 * pair.a.k) > (length + error) ** 2:
        raise Rejected("the points of the distance are further apart than that")
    if not pair.convex:
        nothing_nearer(pair.a, pair.b, length - error)
    elif not hulls_are_apart(pair)(step, length - error):
        raise Rejected("the bodies are closer than the distance")
    return error


def nothing_nearer(a: Exact, b: Exact, length: Fraction) -> None:
    """Rejects surfaces that are closer than this, world units."""
    if length <= 0:
        return
    least = (length * (1 << a.k)) ** 2
    for _, _, squared in close_pairs(a, b, length, MOST_NEAR):
        if squared < least:
            raise Rejected("triangles of the bodies are closer than the distance")
