"""The depth of a pair of which one body at least is not convex: a proven interval.

The hulls of the whole meshes are an upper bound, and so is every translation that was found to free
the meshes. Convex bodies proven inside the meshes are a lower bound, and so is a crossing pair of
triangles, because a free A has no crossing triangles either.
"""

from __future__ import annotations

import math

from satcheck import core
from satcheck.audit.boxes import box_escape
from satcheck.audit.depth import Depth
from satcheck.audit.inner_bodies import inner_depth
from satcheck.audit.ladder import Contact
from satcheck.audit.pair import Pair
from satcheck.audit.plan import Plan
from satcheck.audit.report import Vector
from satcheck.audit.short_escape import shorter_escape
from satcheck.audit.tolerances import UNIT_ROUNDOFF
from satcheck.audit.verify import Escape, verified_escape


def concave_depth(pair: Pair, contact: Contact, plan: Plan) -> Depth:
    """The depth of an overlapping pair of which the hulls do not say everything."""
    upper, normal = _upper_bound(pair, plan)
    lower = 0.0
    if contact.proven:
        lower = min(max(crossing_depth(pair, contact), inner_depth(pair, upper, plan)), upper)
    if pair.may("exact") and upper - lower > pair.settings.depth_width * upper:
        shorter = shorter_escape(pair, upper, normal, lower, plan)
        if shorter is not None:
            upper, normal = _length_and_normal(shorter)
    return Depth(lower, upper, upper, normal, verified_escape(pair, upper, normal, plan))


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
