"""Check that the figures of a finding agree with each other and with the bodies, up to rounding.

A certificate proves the other claims of the figures, or `coverage` lists them.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction

import numpy as np

from satcheck.report.contacts import Contacts
from satcheck.report.judge import quality_of
from satcheck.report.report import OVERLAPS, Finding, finding_id
from satcheck.report.request import Request
from satcheck.report.values import Vector
from satcheck.verify.bodies import SAME, Placed
from satcheck.verify.exact import Point, Rejected, point, root, sub
from satcheck.verify.pairs import vector
from satcheck.verify.surfaces import comes_within
from satcheck.verify.world import Exact

# An interval of this relative width comes from rounding alone.
EXACT_WIDTH = Fraction(1, 10**9)
# Figures of polytopes are at most 6e-12 of the size off, as the tables of hard cases show.
POLYTOPE_ERROR = Fraction(1, 1 << 37)
# Figures of curved shapes have bounds within 1e-9 of the size.
CURVED_ERROR = EXACT_WIDTH
UNIT_ERROR = 1e-12  # of the length of a unit vector
# A direction is checked only if rounding turns it by at most this angle, in radians.
DIRECTION_ERROR = Fraction(1, 1000)
TOUCH_FRACTION = 1e-3  # the default touch band, of the smaller body's diagonal, at most
DEPTH_FIGURES = ("depth", "depth_bounds", "normal", "mtv", "mtv_moves", "mtv_verified")
# What an undecided pair states; it claims nothing else.
OF_UNDECIDED = {
    *("id", "a", "b", "relation", "placed_relation", "severity", "undecided", "reason_code"),
    *("reason", "message", "tolerance", "motion", "certificate", "plan", "baseline_state"),
}


@dataclass(frozen=True, slots=True)
class Rounding:
    """The largest effects of rounding, world units, for bodies of this size."""

    share: Fraction
    largest: Fraction

    def of(self, length: Fraction) -> Fraction:
        return EXACT_WIDTH * abs(length) + self.share * self.largest


def rounding_of(a: Placed, b: Placed) -> Rounding:
    boxes = [box for body in (a, b) if (box := body.bounds) is not None]
    largest = max((float(np.abs(corners).max()) for corners in boxes), default=0.0)
    curved = a.curved is not None or b.curved is not None
    return Rounding(CURVED_ERROR if curved else POLYTOPE_ERROR, Fraction(largest))


def check_id(finding: Finding) -> None:
    if finding.id != finding_id(finding.a, finding.b):
        raise Rejected("its id is not that of these two bodies")


def tolerance_of(a: Placed, b: Placed, request: Request) -> float:
    """The tolerance that is asked, or the sum of the input precisions of two bodies, at most a
    share of the smaller body, and at least the deviation of polygons from their curves. Sizes
    across the plane of a check do not count."""
    if request.tolerance is not None:
        return request.tolerance
    axes = [axis for axis in range(3) if axis != request.across]
    sizes = (math.dist(*(corner[axes] for corner in body.bounds or ())) for body in (a, b))
    written = min(a.resolution + b.resolution, TOUCH_FRACTION * min(sizes))
    return max(written, a.deviation + b.deviation)


def check_tolerance(finding: Finding, a: Placed, b: Placed, request: Request) -> Fraction:
    tolerance, expected = finding.tolerance, tolerance_of(a, b, request)
    if tolerance is None or not math.isclose(tolerance, expected, rel_tol=SAME):
        raise Rejected(f"the tolerance is {expected!r}")
    return Fraction(tolerance)


def check_no_figures(finding: Finding) -> None:
    """Rejects figures of an undecided pair."""
    others = (key for key in Finding.__struct_fields__ if key not in OF_UNDECIDED)
    claims = [key for key in others if getattr(finding, key)]
    if claims:
        raise Rejected(f"an indeterminate pair claims nothing, this one claims {claims[0]!r}")


def check_figures(finding: Finding, a: Placed, b: Placed) -> None:
    """Check the figures of a finding whose exact relation is known."""
    rounding = rounding_of(a, b)
    if finding.exact_relation in OVERLAPS:
        _check_overlap(finding, rounding)
    else:
        _check_gap(finding)
    _check_distance_bounds(finding, a, b, rounding)
    _check_witness(finding, (a, b), rounding)
    expected = quality_of(finding.depth_bounds, finding.distance_bounds)
    if finding.quality != expected:
        raise Rejected(f"the quality that follows is {expected!r}")
    _check_thickness(finding)
    _check_volume(finding, a, b)


def _check_overlap(finding: Finding, rounding: Rounding) -> None:
    if finding.distance is not None:
        raise Rejected("bodies that overlap have no distance")
    missing = [key for key in DEPTH_FIGURES if getattr(finding, key) is None]
    if len(missing) == len(DEPTH_FIGURES):
        return
    if missing:
        what = "a depth comes with its bounds, its direction and its MTV"
        raise Rejected(f"{what}: no {missing[0]!r}")
    assert finding.depth is not None
    assert finding.depth_bounds is not None
    assert finding.mtv is not None
    assert finding.normal is not None
    if not finding.depth_bounds[0] <= finding.depth_bounds[1] == finding.depth:
        raise Rejected("the depth is the upper end of its bounds")
    depth, move, normal = Fraction(finding.depth), vector(finding.mtv), _unit(finding.normal)
    # The MTV and the depth may differ by rounding, either way.
    length = _length(move)
    longer = EXACT_WIDTH * (depth + rounding.largest)
    if abs(length - depth) > longer:
        raise Rejected("the MTV is not as long as the depth")
    across = tuple(m + length * n for m, n in zip(move, normal, strict=True))
    if _length(across) > EXACT_WIDTH * length:
        raise Rejected("the MTV does not run against the normal")


def _check_gap(finding: Finding) -> None:
    there = [key for key in DEPTH_FIGURES if key != "normal" and getattr(finding, key) is not None]
    if there:
        raise Rejected(f"bodies without a common interior have no {there[0]!r}")
    contacts, apart = finding.contacts, finding.exact_relation == "separated"
    if apart and contacts and contacts != Contacts(truncated=contacts.truncated):
        raise Rejected("bodies that are apart have no contacts")
    if finding.components is not None and finding.components.items:
        raise Rejected("bodies without a common interior have no component of it")
    distance = finding.distance
    if distance is None:
        if finding.normal is not None or finding.witness is not None:
            raise Rejected("a direction or witness points without the distance")
        return
    if distance < 0 or (finding.exact_relation == "touching" and distance > 0):
        raise Rejected("the distance does not fit the relation")


def _check_witness(finding: Finding, bodies: tuple[Placed, Placed], rounding: Rounding) -> None:
    """Rejects witness points that are not on the bodies, or whose distance along the normal is not
    the distance or the depth."""
    normal = None if finding.normal is None else _unit(finding.normal)
    witness = finding.witness
    if witness is None:
        return
    ends = vector(witness.a), vector(witness.b)
    step = sub(ends[1], ends[0])
    overlap = finding.exact_relation in OVERLAPS
    length = Fraction(-(finding.depth or 0.0) if overlap else finding.distance or 0.0)
    slack = rounding.of(length)
    if normal is None:
        if length > slack or _length(step) > slack + abs(length):
            raise Rejected("witness points apart, and no direction from one to the other")
    elif _length(tuple(s - length * n for s, n in zip(step, normal, strict=True))) > 2 * slack:
        raise Rejected("the witness points do not span the figure along the normal")
    for end, body in zip(ends, bodies, strict=True):
        if not is_on(end, body, 2 * slack):
            raise Rejected(f"a witness point does not lie on {body.id}")


def shows_direction(finding: Finding, a: Placed, b: Placed) -> bool:
    """Return whether witness points are far enough apart that rounding does not change their
    direction."""
    if finding.witness is None or finding.normal is None:
        return False
    length = Fraction(finding.distance or finding.depth or 0)
    return abs(length) > rounding_of(a, b).of(length) / DIRECTION_ERROR


def is_on(p: Point, body: Placed, slack: Fraction) -> bool:
    """Return whether a point is within this distance of the surface, world units; of a curved
    shape, whether it is inside once it is moved towards the origin, and not moved away."""
    shape = body.exact
    if isinstance(shape, Exact):
        return comes_within(shape, shape.at(p), slack, open_=False)
    step = sub(p, point(shape.image.origin))
    length = _length(step)
    if length == 0:
        return False
    inward, outward = (
        point(c + share * along for c, along in zip(p, step, strict=True))
        for share in (-slack / length, slack / length)
    )
    return shape.side(inward) >= 0 >= shape.side(outward)


def _check_distance_bounds(finding: Finding, a: Placed, b: Placed, rounding: Rounding) -> None:
    """Checks that the bounds of the distance of curves include the deviation of their polygons.
    Other bounds contain the distance, and are of bodies whose gap may stay open: curved shapes, and
    meshes with holes."""
    bounds, distance = finding.distance_bounds, finding.distance
    closer = Fraction(a.deviation) + Fraction(b.deviation)
    if bounds is None:
        if distance is not None and closer > 0:
            raise Rejected("the distance of polygons that stand for curves has bounds")
        return
    if distance is None:
        raise Rejected("bounds of a distance come with the distance")
    low, high, length = Fraction(bounds[0]), Fraction(bounds[1]), Fraction(distance)
    if closer == 0:
        if not low <= length <= high:
            raise Rejected("the bounds of the distance leave it out")
        if all(body.curved is None and not body.holed for body in (a, b)):
            raise Rejected("bounds of a distance that is exact")
        return
    slack = rounding.of(length)
    if low > max(length - closer + slack, Fraction(0)) or high < length - slack:
        raise Rejected("the bounds of the distance leave out how far the curves may be off")


def _check_thickness(finding: Finding) -> None:
    """Its figures agree; what they claim is not proven."""
    bounds, ball = finding.thickness_bounds, finding.ball
    if (bounds is None) is not (finding.thickness is None) or (bounds is None and ball is not None):
        raise Rejected("a thickness comes with its bounds, and a ball with a thickness")
    if bounds is None:
        return
    if finding.exact_relation is not None and finding.exact_relation not in OVERLAPS:
        raise Rejected("bodies without a common interior have no thickness")
    if not bounds[0] <= bounds[1] == finding.thickness:
        raise Rejected("the thickness is the upper end of its bounds")
    if 2 * (0.0 if ball is None else ball.radius) < bounds[0]:
        raise Rejected("the ball is thinner than the lower end of the thickness")


def _check_volume(finding: Finding, a: Placed, b: Placed) -> None:
    volume, error = finding.volume, finding.volume_error
    if (volume is None) is not (error is None):
        raise Rejected("a volume comes with its error")
    if volume is None or error is None:
        return
    if finding.exact_relation not in OVERLAPS:
        if volume or error:
            raise Rejected("bodies without a common interior share no volume")
        return
    if a.bounds is None or b.bounds is None:
        return
    low, high = np.maximum(a.bounds[0], b.bounds[0]), np.minimum(a.bounds[1], b.bounds[1])
    room = math.prod((Fraction(h) - Fraction(g) for g, h in zip(low, high, strict=True)), start=1)
    if Fraction(volume) - Fraction(error) > room:
        raise Rejected("the common volume is more than that of the boxes")


def _unit(direction: Vector) -> Point:
    normal = vector(direction)
    if abs(float(_length(normal)) - 1) > UNIT_ERROR:
        raise Rejected("the normal is no unit vector")
    return normal


def _length(v: Sequence[Fraction | int]) -> Fraction:
    return root(Fraction(sum(c * c for c in v)))[0]
