"""How far apart two bodies without a common interior are, where somebody has to know."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from satcheck.audit.asked.plan import Plan
from satcheck.audit.bodies.pair import Pair
from satcheck.audit.ladder.ladder import Contact
from satcheck.audit.report.report import Vector, Witness
from satcheck.audit.tolerances import rounding_pad
from satcheck.core.frozen import frozen

if TYPE_CHECKING:
    from satcheck import core
    from satcheck.audit.curved.signed import Signed


@frozen
class Gap:
    """The distance, world units, to rounding: lower <= true distance <= upper (inf: unknown).

    most: a proven upper bound, rounding granted: what the touch band asks for. distance: the
    figure, between the two; None where none was measured. normal: unit, from A to B; None where
    the points coincide. witness: the closest points.
    """

    lower: float
    upper: float
    most: float
    distance: float | None = None
    normal: Vector | None = None
    witness: Witness | None = None


def measure_gap(pair: Pair, contact: Contact, plan: Plan) -> Gap:
    """The distance of a separated or touching pair, as far as the clearance or the band asks."""
    if contact.convex is not None:
        if pair.asked.wants("distance"):
            plan.record("distance", "measured", "with the hulls")
        return _convex_gap(contact.convex, bounded=pair.curved)
    if contact.relation == "touching":
        witness = contact.point and Witness(contact.point, contact.point)
        return Gap(0.0, 0.0, 0.0, 0.0, None, witness)
    if pair.curved and contact.relation == "separated" and pair.may("hull"):
        beyond = math.nextafter(pair.asked_gap, math.inf)  # no triangle was found within that
        return Gap(max(contact.gap_lower, beyond), math.inf, math.inf)
    settled = contact.gap_lower > pair.asked_gap or pair.asked_gap == 0
    if settled or not pair.may("exact"):
        return Gap(contact.gap_lower, math.inf, math.inf)
    # A clearance wants the figure; the touch band only wants to know whether it is inside.
    asked = pair.asked.wants("distance")
    stage, limit = ("distance", math.inf) if asked else ("touch-band", pair.tolerance)
    assert contact.climb is not None
    assert contact.climb.gap is not None
    found, cost = contact.climb.gap, contact.climb.band_nanoseconds
    if math.isinf(found.distance):
        plan.add(stage, "beyond", f"more than {limit:.6g} apart", cost)
        return Gap(limit, math.inf, math.inf)
    if contact.climb.gap_is_void:
        # From the outside no face within the material can be nearest.
        plan.add(stage, "lower bound", "to a wall without thickness: no part of the body", cost)
        return Gap(found.distance, math.inf, math.inf)
    plan.add(stage, "measured", f"triangles {found.triangle_a} and {found.triangle_b}", cost)
    return Gap(
        found.distance,
        found.distance,
        found.distance + rounding_pad(pair.largest_coordinate),
        found.distance,
        _direction(found.witness_a, found.witness_b),
        Witness(found.witness_a, found.witness_b),
    )


def _convex_gap(result: core.PairResult | Signed, *, bounded: bool) -> Gap:
    """bounded: of a curved shape the distance is an estimate; of polytopes it is the distance, to
    rounding."""
    distance = max(result.distance or 0.0, 0.0)
    witness = None
    if result.witness_a is not None and result.witness_b is not None:
        witness = Witness(result.witness_a, result.witness_b)
    most = max(result.upper or 0.0, distance)
    lower, upper = (max(result.lower or 0.0, 0.0), most) if bounded else (distance, distance)
    return Gap(lower, upper, most, distance, result.normal, witness)


def _direction(start: Vector, end: Vector) -> Vector | None:
    step = (end[0] - start[0], end[1] - start[1], end[2] - start[2])
    length = math.hypot(*step)
    return None if length == 0 else (step[0] / length, step[1] / length, step[2] / length)
