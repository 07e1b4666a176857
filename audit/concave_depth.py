"""The depth of a pair of which one body at least is not convex: a proven interval.

The hulls of the whole meshes are an upper bound, and so is every translation that was found to free
the meshes. Convex bodies proven inside the meshes are a lower bound, and so is a crossing pair of
triangles, because a free A has no crossing triangles either.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from satcheck import core
from satcheck.audit.boxes import box_escape
from satcheck.audit.depth import Depth
from satcheck.audit.escape_search import escape_on_meshes, escape_on_parts
from satcheck.audit.inner_bodies import depth_of_hulls, depth_of_parts
from satcheck.audit.ladder import Contact
from satcheck.audit.pair import Pair
from satcheck.audit.plan import Plan
from satcheck.audit.report import Vector
from satcheck.audit.tolerances import UNIT_ROUNDOFF, rounding_pad
from satcheck.audit.triangles import crossing_depth
from satcheck.audit.verify import Escape, verified_escape


def concave_depth(pair: Pair, contact: Contact, plan: Plan) -> Depth:
    """The depth of an overlapping pair of which the hulls do not say everything.

    Cheap bounds first; parts, which may take seconds to compute, only where a gap is left open.
    """
    hulls = _way_out_of_hulls(pair, plan)
    lower, upper, shorter = 0.0, hulls.upper, None
    if contact.proven:
        known = crossing_depth(pair, contact.crossing), _depth_of_nesting(pair, contact, plan)
        lower = max(*known, depth_of_hulls(pair, plan))
    if pair.may("exact") and _is_wide(pair, lower, upper):
        shorter = escape_on_meshes(pair, contact, upper, hulls.normal, lower, plan)
        upper = math.hypot(*shorter) if shorter else upper
    if contact.proven and _is_wide(pair, lower, upper) and pair.may("parts"):
        if not pair.both_solid:
            plan.record("parts", "not asked", "a mesh that is not solid has no inside to fill")
        else:
            lower = max(lower, depth_of_parts(pair, plan))
            if pair.may("exact") and _is_wide(pair, lower, upper):
                shorter = escape_on_parts(pair, upper, lower, plan) or shorter
    if shorter is not None:
        length, normal = _length_and_normal(shorter)
        escape = verified_escape(pair, length, normal, plan)
        if escape.verified:
            return Depth(min(lower, escape.bound), escape.bound, normal, escape)
    escape = verified_escape(pair, hulls.length, hulls.normal, plan)
    upper = min(hulls.upper, escape.bound)
    return Depth(min(lower, upper), upper, hulls.normal, escape)


def _depth_of_nesting(pair: Pair, contact: Contact, plan: Plan) -> float:
    """A body inside another stays inside at least until their surfaces meet."""
    if contact.relation not in ("contains", "inside"):
        return 0.0
    gap = core.mesh_distance(pair.a.surface(), pair.b.surface()).distance
    lower = max(gap - rounding_pad(pair.largest_coordinate), 0.0)
    plan.record("depth", "lower bound", f"at least {lower:.6g} by the gap around the inner body")
    return lower


def _is_wide(pair: Pair, lower: float, upper: float) -> bool:
    return upper - lower > pair.settings.depth_width * upper


def nudged_depth(pair: Pair, contact: Contact, nudge: Vector) -> Depth:
    """The depth of a pair that a verified translation of A within the touch band frees."""
    length, normal = _length_and_normal(nudge)
    upper = length + 2 * UNIT_ROUNDOFF * pair.largest_coordinate
    lower = min(crossing_depth(pair, contact.crossing), upper)
    return Depth(lower, upper, normal, Escape(nudge, True, upper))


@dataclass(frozen=True, slots=True)
class WayOut:
    """length: of the nominal translation along -normal; upper: that length rounded outward."""

    length: float
    upper: float
    normal: Vector


def _way_out_of_hulls(pair: Pair, plan: Plan) -> WayOut:
    """What frees A for certain: out of B's hull, or out of its box."""
    length, normal = box_escape(pair.a.bounds, pair.b.bounds)
    way, how = WayOut(length, length, normal), "world boxes"
    if pair.may("hull"):
        found = core.check_pair(pair.a.hull_shape(), pair.b.hull_shape(), query="depth")
        distance, least, towards = found.distance, found.lower, found.normal
        penetrating = found.outcome == "penetrating"
        if penetrating and distance is not None and least is not None and towards is not None:
            way = WayOut(-distance, -least, towards)
            how = "hulls of the whole meshes"
    plan.record("depth", "upper bound", f"at most {way.upper:.6g} by the {how}")
    return way


def _length_and_normal(translation: Vector) -> tuple[float, Vector]:
    """Its length and the direction against it; both exact along an axis."""
    length = math.hypot(*translation)
    x, y, z = (0.0 - c / length for c in translation)
    return length, (x, y, z)
