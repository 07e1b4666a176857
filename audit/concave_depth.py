"""The depth of a pair of which one body at least is not convex: a proven interval.

The hulls of the whole meshes are an upper bound, and so is every translation that was found to free
the meshes. Convex bodies proven inside the meshes are a lower bound, and so is a crossing pair of
triangles on which both bodies end, because a free A has none.
"""

from __future__ import annotations

import math

from satcheck.audit.cheap_bounds import gap_around, way_out_of_hulls
from satcheck.audit.depth import Depth
from satcheck.audit.escape_search import FIRST_SPHERE, escape_on_meshes, escape_on_parts
from satcheck.audit.inner_bodies import depth_of_hulls, depth_of_parts
from satcheck.audit.ladder import Contact
from satcheck.audit.pair import Pair
from satcheck.audit.plan import Plan
from satcheck.audit.report import Vector
from satcheck.audit.tolerances import UNIT_ROUNDOFF
from satcheck.audit.triangles import crossing_depth
from satcheck.audit.verify import Escape, verified_escape


def concave_depth(pair: Pair, contact: Contact, plan: Plan) -> Depth:
    """The depth of an overlapping pair of which the hulls do not say everything.

    Cheap bounds first; parts, which may take seconds to compute, only where a gap is left open.
    """
    hulls = way_out_of_hulls(pair)
    plan.record("depth", "upper bound", f"at most {hulls.upper:.6g} by the {hulls.by}")
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
    lower = gap_around(pair, contact)
    if lower > 0:
        plan.record(
            "depth", "lower bound", f"at least {lower:.6g} by the gap around the inner body"
        )
    return lower


def _is_wide(pair: Pair, lower: float, upper: float) -> bool:
    return upper - lower > pair.settings.depth_width * upper


def depth_by_move(pair: Pair, contact: Contact, move: Vector, plan: Plan) -> Depth:
    """The depth of a pair that a verified translation of A within the touch band frees.

    A band that somebody asked for is not allowed to make the figures coarser: a shorter move is
    then searched, as without a band. Within the input precision there is nothing to refine.
    """
    if pair.settings.tolerance is None:
        return _depth_of(pair, contact, move)
    length, normal = _length_and_normal(move)
    hulls = way_out_of_hulls(pair)
    if not is_fine(pair, hulls.upper):
        depth = concave_depth(pair, contact, plan)
        found = depth.escape.verified and depth.upper <= length
        return depth if found else _depth_of(pair, contact, move)
    lower = crossing_depth(pair, contact.crossing)
    shorter = escape_on_meshes(pair, contact, length, normal, lower, plan)
    return _depth_of(pair, contact, shorter or move)


def is_fine(pair: Pair, way_out: float) -> bool:
    """Whether the touch band is narrower than the moves with which the search for a way out of
    that length starts: it then says nothing about the band."""
    return pair.tolerance < FIRST_SPHERE * way_out


def _depth_of(pair: Pair, contact: Contact, move: Vector) -> Depth:
    length, normal = _length_and_normal(move)
    upper = length + 2 * UNIT_ROUNDOFF * pair.largest_coordinate
    lower = min(crossing_depth(pair, contact.crossing), upper)
    return Depth(lower, upper, normal, Escape(move, True, upper))


def _length_and_normal(translation: Vector) -> tuple[float, Vector]:
    """Its length and the direction against it; both exact along an axis."""
    length = math.hypot(*translation)
    x, y, z = (0.0 - c / length for c in translation)
    return length, (x, y, z)
