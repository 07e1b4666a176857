"""The touch band, one rule for every pair: the signed distance is proven to be within it.

A gap is within it when it is known to be no longer than the tolerance, an overlap when a verified
translation of A that is no longer than the tolerance ends it. Two convex bodies need no search.
For the others, what proves the contrary at once comes first: one crossing pair of triangles that is
deeper, a wider gap around a body inside another. Then the core looks for a way out of the hulls or
off the triangles that A crosses (`core/native/scene/way_within.hpp`). A wide band is searched as
the depth is.
"""

from __future__ import annotations

import math
from time import perf_counter_ns

from satcheck import core
from satcheck.audit.asked.plan import Plan
from satcheck.audit.bodies.pair import Pair
from satcheck.audit.bodies.triangles import crossing_depth
from satcheck.audit.ladder.cheap_bounds import gap_around, way_out_of_hulls
from satcheck.audit.ladder.ladder import Contact
from satcheck.audit.report.report import Vector

# A band narrower than this share of the way out of the hulls.
NARROW_BAND = 1 / 64


def estimate_is_within(pair: Pair, plan: Plan) -> bool:
    """Whether the shapes that a capped ladder ends with overlap by no more than the tolerance.

    The bodies inside them then overlap by no more than that; how far apart they are stays open.
    """
    out = way_out_of_hulls(pair)
    within = out.upper <= pair.tolerance
    if within:
        plan.record("touch-band", "within", f"{_band(pair)}: the {out.by} overlap by no more")
    return within


def move_within(pair: Pair, contact: Contact, plan: Plan) -> Vector | None:
    """A translation of A, at most the tolerance long, after which it is free; None: none found.

    For an overlap that the triangles decided.
    """
    if pair.tolerance == 0:
        return None
    if pair.curved:
        return _move_off_mesh(pair, plan)
    lower, cost = _least_depth(pair, contact)
    if lower > pair.tolerance:
        plan.add("touch-band", "deeper", f"{_band(pair)}: at least {lower:.3g} deep", cost)
        return None
    found, spent = _way_within(pair, contact)
    if found.move is None and found.deepest > pair.tolerance:
        detail = f"{_band(pair)}: at least {found.deepest:.3g} deep"
        plan.add("touch-band", "deeper", detail, cost + spent)
        return None
    move = found.move or _searched(pair, lower, plan)
    if move is None:
        result, detail = "not found", "no move within it frees A"
    else:
        result, detail = "within", f"{math.hypot(*move):.3g} frees A"
    plan.add("touch-band", result, f"{_band(pair)}: {detail}", cost + spent)
    return move


def _move_off_mesh(pair: Pair, plan: Plan) -> Vector | None:
    """For a curved shape and a mesh."""
    from satcheck.audit.curved.in_mesh import move_off

    move = move_off(pair, pair.tolerance)
    if move is None:
        plan.record("touch-band", "not found", f"{_band(pair)}: no move within it frees A")
    else:
        plan.record("touch-band", "within", f"{_band(pair)}: {math.hypot(*move):.3g} frees A")
    return move


def _least_depth(pair: Pair, contact: Contact) -> tuple[float, int]:
    """What proves a depth at once, and what the climb has spent on the band."""
    found = contact.climb
    least = None if found is None else found.least_depth
    if found is not None and least is not None:
        return least, found.band_nanoseconds
    return max(crossing_depth(pair, contact.crossing), gap_around(pair, contact)), 0


def _way_within(pair: Pair, contact: Contact) -> tuple[core.WayWithin, int]:
    """And what finding it cost that the climb has not spent."""
    known = None if contact.climb is None else contact.climb.way_within
    if known is not None:
        return known, 0
    start = perf_counter_ns()
    geometries = pair.a.geometry, pair.b.geometry
    found = core.find_way_within(*geometries, pair.tolerance, contact.crossing)
    return found, perf_counter_ns() - start


def _band(pair: Pair) -> str:
    source = "the input precision" if pair.asked.tolerance is None else "as asked"
    return f"tolerance {pair.tolerance:.3g}, {source}"


def _searched(pair: Pair, lower: float, plan: Plan) -> Vector | None:
    """By the search for the depth, with or without a depth asked for; not for a narrow band, in
    which the way off the triangles was sought."""
    hulls = way_out_of_hulls(pair)
    if pair.tolerance < NARROW_BAND * hulls.upper:
        return None
    from satcheck.audit.figures.concave_depth import search

    found = search(pair, lower, hulls.upper, plan).way_out
    return found if found is not None and math.hypot(*found) <= pair.tolerance else None
