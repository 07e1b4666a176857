"""How deep two bodies with a common interior overlap, and the way out for A.

Convex pairs: exact, from the convex solver. Otherwise an interval: the hulls of the whole meshes
are an upper bound, convex bodies proven inside the meshes are a lower one, and so is the deepest
crossing pair of triangles, because a free A has no crossing triangles either.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from satcheck import core
from satcheck.audit.boxes import box_escape
from satcheck.audit.inner_bodies import inner_depth
from satcheck.audit.ladder import Contact
from satcheck.audit.pair import Pair
from satcheck.audit.plan import Plan
from satcheck.audit.report import Vector, Witness
from satcheck.audit.short_escape import shorter_escape
from satcheck.audit.tolerances import UNIT_ROUNDOFF
from satcheck.audit.verify import Escape, verified_escape


@dataclass(frozen=True, slots=True)
class Depth:
    """World units: lower <= true depth <= upper. value: the best single figure for it.

    normal: unit, from A to B, along which A retreats; escape: the translation that was verified,
    which may be longer than the depth by what verification asked for. witness: with
    witness_b - witness_a = -value * normal, known for convex pairs.
    """

    lower: float
    upper: float
    value: float
    normal: Vector
    escape: Escape
    witness: Witness | None = None


def measure_depth(pair: Pair, contact: Contact, plan: Plan) -> Depth:
    """The depth of an overlapping pair."""
    if contact.convex is not None:
        return _convex_depth(pair, contact.convex, plan)
    upper, normal = _upper_bound(pair, plan)
    lower = 0.0
    if contact.proven:
        lower = min(max(crossing_depth(pair, contact), inner_depth(pair, upper, plan)), upper)
    if pair.may("exact") and upper - lower > pair.settings.depth_width * upper:
        shorter = shorter_escape(pair, upper, normal, lower, plan)
        if shorter is not None:
            upper, normal = _length_and_normal(shorter)
    return Depth(lower, upper, upper, normal, verified_escape(pair, upper, normal, plan))


def _convex_depth(pair: Pair, result: core.PairResult, plan: Plan) -> Depth:
    if result.distance is None or result.normal is None:
        raise AssertionError("a penetrating pair has a signed distance and a normal")
    value = max(-result.distance, 0.0)
    lower = value if result.upper is None else min(max(-result.upper, 0.0), value)
    upper = value if result.lower is None else max(-result.lower, value)
    escape = verified_escape(pair, value, result.normal, plan)
    witness = None
    if result.witness_a is not None and result.witness_b is not None:
        witness = Witness(result.witness_a, result.witness_b)
    return Depth(lower, upper, value, result.normal, escape, witness)


def nudged_depth(pair: Pair, contact: Contact, nudge: Vector) -> Depth:
    """The depth of a pair that a verified translation of A within the touch band frees."""
    upper, normal = _length_and_normal(nudge)
    lower = min(crossing_depth(pair, contact), upper)
    return Depth(lower, upper, upper, normal, Escape(nudge, True))


def _upper_bound(pair: Pair, plan: Plan) -> tuple[float, Vector]:
    """A length and a direction that free A for certain: out of B's hull, or out of its box."""
    length, normal = box_escape(pair.a.bounds, pair.b.bounds)
    how = "world boxes"
    if pair.may("hull"):
        hulls = core.check_pair(pair.a.hull_shape(), pair.b.hull_shape(), query="depth")
        if hulls.outcome == "penetrating" and hulls.lower is not None and hulls.normal is not None:
            length, normal, how = -hulls.lower, hulls.normal, "hulls of the whole meshes"
    plan.record("depth", "upper bound", f"at most {length:.6g} by the {how}")
    return length, normal


def _length_and_normal(translation: Vector) -> tuple[float, Vector]:
    """Its length, rounded up, and the direction against it; both exact along an axis."""
    length = math.hypot(*translation)
    x, y, z = (0.0 - c / length for c in translation)
    along_axis = sum(c != 0 for c in translation) == 1
    return length if along_axis else math.nextafter(length, math.inf), (x, y, z)


def crossing_depth(pair: Pair, contact: Contact) -> float:
    """A proven lower bound from one crossing pair of triangles; 0.0 where there is none."""
    if contact.crossing is None:
        return 0.0
    triangles = [
        core.Hull(body.mesh.vertices[body.mesh.triangles[index]])
        for body, index in zip((pair.a, pair.b), contact.crossing, strict=True)
    ]
    result = core.check_pair(triangles[0], triangles[1], query="depth")
    if result.outcome != "penetrating" or result.upper is None:
        return 0.0
    return max(-result.upper * (1 - 2 * UNIT_ROUNDOFF), 0.0)
