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
from typing import Literal

from msgspec import Struct

from satcheck import core
from satcheck.audit.asked.plan import Plan
from satcheck.audit.bodies.pair import Pair
from satcheck.audit.bodies.triangles import crossing_depth
from satcheck.audit.figures.verify import FREE, relation_after
from satcheck.audit.ladder.cheap_bounds import gap_around, way_out_of_hulls
from satcheck.audit.ladder.ladder import Contact
from satcheck.audit.report.report import Vector
from satcheck.audit.tolerances import EXACT_WIDTH
from satcheck.audit.vectors import scaled
from satcheck.core.tolerances import UNIT_ROUNDOFF, rounding_pad

# A way out that exceeds the tolerance by no more than this factor is tried again as long as that.
LITTLE_LONGER = 1 + EXACT_WIDTH
# Rounding makes a unit direction times the tolerance longer by at most this factor.
TO_ROUNDING = 1 + 16 * UNIT_ROUNDOFF
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


Side = Literal["open", "within", "deeper", "hidden"]


class Band(Struct, frozen=True):
    """Whether an overlap is within the tolerance. side: as of core.WayWithin. move: a translation
    of A, at most the tolerance long, after which it is free; None: none was found."""

    side: Side
    move: Vector | None = None


def touch_band(pair: Pair, contact: Contact, plan: Plan) -> Band:
    """For an overlap that the triangles decided."""
    if pair.tolerance == 0:
        return Band("deeper")
    if pair.curved:
        move = _move_off_mesh(pair, plan)
        return Band("open" if move is None else "within", move)
    lower, cost = _least_depth(pair, contact)
    if lower > pair.tolerance:
        plan.add("touch-band", "deeper", f"{_band(pair)}: at least {lower:.3g} deep", cost)
        return Band("deeper")
    found, spent = _way_within(pair, contact)
    if found.side == "deeper":
        detail = f"{_band(pair)}: at least {found.deepest:.3g} deep"
        plan.add("touch-band", "deeper", detail, cost + spent)
        return Band("deeper")
    band = Band(found.side, found.move)
    if band.side != "within":
        band = _searched(pair, lower, plan) or band
    if band.move is not None:
        result, detail = "within", f"{math.hypot(*band.move):.3g} frees A"
    elif band.side == "within":
        result, detail = "within", "the hulls of the whole meshes overlap by no more"
    elif band.side == "hidden":
        result, detail = "undecided", "a move as long as it, to rounding, frees A"
    else:
        result, detail = "not found", "no move within it frees A"
    plan.add("touch-band", result, f"{_band(pair)}: {detail}", cost + spent)
    return band


def _move_off_mesh(pair: Pair, plan: Plan) -> Vector | None:
    """For a curved shape and a mesh."""
    from satcheck.core.curved.freeing import move_off

    move = move_off(pair.a, pair.b, pair.tolerance, rounding_pad(pair.largest_coordinate))
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


def _searched(pair: Pair, lower: float, plan: Plan) -> Band | None:
    """By the search for the depth, with or without a depth asked for; None: it found nothing, or
    was not tried: in a narrow band the way off the triangles was sought."""
    hulls = way_out_of_hulls(pair)
    if pair.tolerance < NARROW_BAND * hulls.upper:
        return None
    from satcheck.audit.figures.concave_depth import search

    found = search(pair, lower, hulls.upper, plan).way_out
    return None if found is None else band_of(pair, found)


def band_of(pair: Pair, way_out: Vector) -> Band | None:
    """What a translation that frees A proves; None: nothing, it is longer than the tolerance."""
    length = math.hypot(*way_out)
    if not 0 < length <= pair.tolerance * LITTLE_LONGER:
        return None
    # One as long as the tolerance comes back a little longer.
    side: Side = "open"
    for move in (way_out, scaled(way_out, pair.tolerance / length)):
        is_short = _is_short(pair, move)
        to_rounding = math.hypot(*move) <= pair.tolerance * TO_ROUNDING
        if (is_short or to_rounding) and relation_after(pair, move) in FREE:
            if is_short:
                return Band("within", move)
            side = "hidden"
    return Band(side)


def _is_short(pair: Pair, move: Vector) -> bool:
    """Whether the translation, with what rounding adds to it, is within the tolerance: for either
    body, so that their order makes no difference."""
    back, length = scaled(move, -1.0), pair.tolerance
    if pair.curved:
        return math.hypot(*move) <= length
    return core.moves_within(pair.a.mesh, move, length) and core.moves_within(
        pair.b.mesh, back, length
    )
