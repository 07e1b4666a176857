"""The touch band, one rule for every pair: the signed distance is proven to be within it.

A gap is within it when it is known to be no longer than the tolerance, an overlap when a verified
translation of A that is no longer than the tolerance ends it. Two convex bodies need no search.
For the others, what proves the contrary at once comes first: one crossing pair of triangles that is
deeper, a wider gap around a body inside another. Then the way out of the hulls is tried, then A is
nudged off the triangles it crosses, a third of the band at a time, so that a part in a corner can
leave three walls. A part that was set flush into another crosses it by the rounding of its file,
however deep it sits in the hull of the other. A wide band is searched as the depth is.
"""

from __future__ import annotations

import math

from satcheck import core
from satcheck.audit.cheap_bounds import WayOut, gap_around, way_out_of_hulls
from satcheck.audit.ladder import BAND, Contact
from satcheck.audit.pair import Pair
from satcheck.audit.plan import Plan
from satcheck.audit.report import Vector
from satcheck.audit.tolerances import rounding_pad
from satcheck.audit.triangles import Crossing, crossing_depth, triangle_normal
from satcheck.audit.vectors import added, scaled
from satcheck.audit.verify import FREE, relation_after

WALLS = 3
# A band narrower than this share of the way out of the hulls.
NARROW_BAND = 1 / 64
ORIGIN: Vector = (0.0, 0.0, 0.0)


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
    lower, cost = _least_depth(pair, contact)
    if lower > pair.tolerance:
        plan.add("touch-band", "deeper", f"{_band(pair)}: at least {lower:.3g} deep", cost)
        return None
    hulls = way_out_of_hulls(pair)
    nudges = _Nudges(pair)
    move = _out_of_hulls(pair, hulls) or nudges.off(contact.crossing)
    if move is None and nudges.deepest > pair.tolerance:
        plan.record("touch-band", "deeper", f"{_band(pair)}: at least {nudges.deepest:.3g} deep")
        return None
    move = move or _searched(pair, hulls, lower, plan)
    if move is None:
        plan.record("touch-band", "not found", f"{_band(pair)}: no move within it frees A")
    else:
        plan.record("touch-band", "within", f"{_band(pair)}: {math.hypot(*move):.3g} frees A")
    return move


def _least_depth(pair: Pair, contact: Contact) -> tuple[float, int]:
    """What proves a depth at once, and what it cost where the climb has looked for it."""
    found = contact.climb
    if found is not None and found.least_depth is not None:
        return found.least_depth, found.nanoseconds[BAND]
    return max(crossing_depth(pair, contact.crossing), gap_around(pair, contact)), 0


def _band(pair: Pair) -> str:
    source = "the input precision" if pair.asked.tolerance is None else "as asked"
    return f"tolerance {pair.tolerance:.3g}, {source}"


def _out_of_hulls(pair: Pair, hulls: WayOut) -> Vector | None:
    for length in (hulls.upper, hulls.upper + rounding_pad(pair.largest_coordinate)):
        move = scaled(hulls.normal, -length)
        if 0 < length <= pair.tolerance and relation_after(pair, move) in FREE:
            return move
    return None


def _searched(pair: Pair, hulls: WayOut, lower: float, plan: Plan) -> Vector | None:
    """By the search for the depth, with or without a depth asked for; not for a narrow band, which
    nudges can walk through."""
    from satcheck.audit.concave_depth import search

    if pair.tolerance < NARROW_BAND * hulls.upper:
        return None
    found = search(pair, lower, hulls.upper, plan).way_out
    return found if found is not None and math.hypot(*found) <= pair.tolerance else None


class _Nudges:
    """deepest: a lower bound of the depth, by the triangles that were found to cross."""

    def __init__(self, pair: Pair) -> None:
        self._pair = pair
        self.deepest = 0.0

    def off(
        self, crossing: Crossing | None, at: Vector = ORIGIN, walls: int = WALLS
    ) -> Vector | None:
        """Depth first: step off the crossing triangles, then off those that are then crossed."""
        if crossing is None:
            return None
        pair = self._pair
        for away in _ways_off(pair, crossing):
            there = added(at, scaled(away, pair.tolerance / WALLS))
            moved = pair.a.surface().refit(pair.a.mesh.translated(there))
            found = core.mesh_relation(moved, pair.b.surface())
            if found.proven and found.relation in FREE:
                return there
            if found.triangle_a < 0 or found.triangle_b < 0:
                continue
            blocking = (found.triangle_a, found.triangle_b)
            self.deepest = max(self.deepest, crossing_depth(pair, blocking))
            if self.deepest > pair.tolerance:
                return None
            further = self.off(blocking, there, walls - 1) if walls > 1 else None
            if further is not None:
                return further
        return None


def _ways_off(pair: Pair, crossing: Crossing) -> list[Vector]:
    """Unit directions for A: along B's outward normal, against its own; both ways if not solid."""
    ways = []
    for body, index, sign in ((pair.b, crossing[1], 1.0), (pair.a, crossing[0], -1.0)):
        normal = triangle_normal(body, index)
        if normal is None:
            continue
        for side in (sign,) if body.solid else (sign, -sign):
            ways.append(scaled(normal, side))
    return ways
