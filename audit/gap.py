"""How far apart two bodies without a common interior are, where somebody has to know."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from satcheck import core
from satcheck.audit.ladder import Contact
from satcheck.audit.pair import Pair
from satcheck.audit.plan import Plan
from satcheck.audit.report import Vector, Witness
from satcheck.audit.tolerances import rounding_pad
from satcheck.core.frozen import frozen

if TYPE_CHECKING:
    from satcheck.audit.curved.signed import Signed


@frozen
class Gap:
    """The distance, world units, to rounding: lower <= true distance <= upper (inf: unknown).

    most: a proven upper bound, rounding granted: what the touch band asks for. normal: unit, from A
    to B; None where the points coincide. witness: the closest points.
    """

    lower: float
    upper: float
    most: float
    normal: Vector | None = None
    witness: Witness | None = None


def measure_gap(pair: Pair, contact: Contact, plan: Plan) -> Gap:
    """The distance of a separated or touching pair, as far as the clearance or the band asks."""
    if contact.convex is not None:
        if pair.asked.wants("distance"):
            plan.record("distance", "measured", "with the hulls")
        return _convex_gap(contact.convex)
    if contact.relation == "touching":
        witness = contact.point and Witness(contact.point, contact.point)
        return Gap(0.0, 0.0, 0.0, None, witness)
    if pair.curved and contact.relation == "separated" and pair.may("hull"):
        beyond = math.nextafter(pair.asked_gap, math.inf)  # no triangle was found within that
        return Gap(max(contact.gap_lower, beyond), math.inf, math.inf)
    settled = contact.gap_lower > pair.asked_gap or pair.asked_gap == 0
    if settled or not pair.may("exact"):
        return Gap(contact.gap_lower, math.inf, math.inf)
    # A clearance wants the figure; the touch band only wants to know whether it is inside.
    asked = pair.asked.wants("distance")
    stage, limit = ("distance", math.inf) if asked else ("touch-band", pair.tolerance)
    found = core.mesh_distance(pair.a.surface(), pair.b.surface(), limit)
    if math.isinf(found.distance):
        plan.record(stage, "beyond", f"more than {limit:.6g} apart")
        return Gap(limit, math.inf, math.inf)
    if _is_void(pair, found):
        plan.record(stage, "lower bound", "to a wall without thickness: no part of the body")
        return Gap(found.distance, math.inf, math.inf)
    plan.record(stage, "measured", f"triangles {found.triangle_a} and {found.triangle_b}")
    return Gap(
        found.distance,
        found.distance,
        found.distance + rounding_pad(pair.largest_coordinate),
        _direction(found.witness_a, found.witness_b),
        Witness(found.witness_a, found.witness_b),
    )


def _is_void(pair: Pair, found: core.MeshDistance) -> bool:
    """Whether the distance may be that of a wall that bounds no material. From the outside no face
    within the material can be nearest."""
    ends = ((pair.a, found.triangle_a), (pair.b, found.triangle_b))
    return any(body.surface().has_void(triangle) for body, triangle in ends)


def _convex_gap(result: core.PairResult | Signed) -> Gap:
    distance = max(result.distance or 0.0, 0.0)
    witness = None
    if result.witness_a is not None and result.witness_b is not None:
        witness = Witness(result.witness_a, result.witness_b)
    return Gap(distance, distance, max(result.upper or 0.0, distance), result.normal, witness)


def _direction(start: Vector, end: Vector) -> Vector | None:
    step = (end[0] - start[0], end[1] - start[1], end[2] - start[2])
    length = math.hypot(*step)
    return None if length == 0 else (step[0] / length, step[1] / length, step[2] / length)
