"""The touch band: whether the signed distance of a pair is proven to be within the tolerance.

A gap is within the band if it is at most the tolerance. An overlap is within the band if a verified
translation of A, at most as long as the tolerance, ends it. The core looks for one out of the hulls
or off the triangles that A crosses (`core/native/ladder/way_within.hpp`). An overlap of closed
bodies is within it, too, if no ball thicker than the tolerance lies in both; one point of such a
ball is the quick proof of the contrary (`core/native/ladder/touch_proof.hpp`), else that is
searched (`explained.py`). Of other bodies the proof is a crossing pair of triangles that is deeper,
or a wider gap around a body inside another, and a wide band is searched as the depth is.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from msgspec.structs import replace

from satcheck import core
from satcheck.audit.draft import Band, Draft, Side
from satcheck.audit.pair import Pair
from satcheck.audit.stages.depth import FREE, relation_after, way_out_of_hulls
from satcheck.audit.stages.gap import compare_convex
from satcheck.audit.vectors import scaled
from satcheck.core.rounding import UNIT_ROUNDOFF, rounding_pad
from satcheck.report.judge import EXACT_WIDTH
from satcheck.report.report import Vector

if TYPE_CHECKING:
    from satcheck.core.curved.signed import Signed

# A way out that exceeds the tolerance by no more than this factor is tried again as long as that.
LITTLE_LONGER = 1 + EXACT_WIDTH
# Rounding makes a unit direction times the tolerance longer by at most this factor.
TO_ROUNDING = 1 + 16 * UNIT_ROUNDOFF
# A band narrower than this share of the way out of the hulls.
NARROW_BAND = 1 / 64


def estimate_is_within(draft: Draft) -> bool:
    """Whether the shapes that a capped ladder ends with overlap by no more than the tolerance.

    The bodies inside them then overlap by no more than that; how far apart they are stays open.
    """
    pair = draft.pair
    out = way_out_of_hulls(pair)
    within = out.upper <= pair.tolerance
    if within:
        draft.record("touch-band", "within", f"{_band(pair)}: the {out.by} overlap by no more")
    return within


def touch_band(draft: Draft) -> Band:
    """Return whether an overlap is within the tolerance: because surfaces that may be off explain
    it, whatever the way out, or because a move within the tolerance frees A."""
    explained = _explained(draft)
    if explained is not None and explained.side in ("within", "deeper"):
        return explained
    band = _by_moves(draft)
    if explained is None:
        return band
    if explained.side == "hidden":
        return band if band.side == "within" else explained
    return replace(band, unexcused=explained.unexcused)


def _explained(draft: Draft) -> Band | None:
    """Return whether that explains the overlap of closed bodies that hold no ball thicker than the
    tolerance; None: not asked."""
    climb = draft.climb
    if climb is None or climb.thick is not False or climb.band == "within":
        return None
    from satcheck.audit.stages.explained import explain, may_be_explained

    return explain(draft, climb.band_nanoseconds) if may_be_explained(draft.pair) else None


def _by_moves(draft: Draft) -> Band:
    pair = draft.pair
    climb = draft.climb
    if draft.signed is not None:
        if climb is None or (pair.on_half_space and climb.band != "within"):
            return Band(_side_by_depth(pair, draft.signed))
        return Band(climb.band or "open")
    if not pair.may("exact"):
        return Band("within" if estimate_is_within(draft) else "open")
    if max(pair.off) == 0:
        return Band("deeper")
    if pair.curved:
        move = _move_off_mesh(draft)
        return Band("open" if move is None else "within", move)
    if climb is None:
        raise AssertionError("the core settles what two meshes are")
    return _band_of_meshes(draft, climb)


def _side_by_depth(pair: Pair, signed: core.PairResult | Signed) -> Side:
    least, most = -(signed.upper or 0.0), -(signed.lower or 0.0)
    if pair.tolerance == 0 or least > pair.tolerance:
        return "deeper"
    if most <= pair.tolerance:
        return "within"
    sign = compare_convex(pair, -pair.tolerance)
    if sign is None:
        return "open"
    return "within" if sign >= 0 else "deeper"


def _band_of_meshes(draft: Draft, climb: core.Climb) -> Band:
    """What the core found, and where that leaves the band open, what a search finds."""
    pair = draft.pair
    cost = climb.band_nanoseconds
    band = Band(climb.band or "open", climb.way_out)
    if band.side == "deeper":
        deep = (
            "a point lies deeper in both" if climb.thick else f"at least {climb.deepest:.3g} deep"
        )
        draft.add("touch-band", "deeper", f"{_band(pair)}: {deep}", cost)
        return band
    if band.side != "within":
        band = _searched(draft, climb.least_depth or 0.0) or band
    if band.side == "open" and climb.too_few_steps:
        band = Band("hidden", why="looking for a move within the tolerance takes too many steps")
        draft.add("touch-band", "undecided", f"{_band(pair)}: {band.why}", cost)
        return band
    if band.move is not None:
        result, detail = "within", f"{math.hypot(*band.move):.3g} frees A"
    elif band.side == "within":
        result, detail = "within", "the hulls of the whole meshes overlap by no more"
    elif band.side == "hidden":
        result, detail = "undecided", "a move as long as it, to rounding, frees A"
    else:
        result, detail = "not found", "no move within it frees A"
    draft.add("touch-band", result, f"{_band(pair)}: {detail}", cost)
    return band


def _move_off_mesh(draft: Draft) -> Vector | None:
    """For a curved shape and a mesh."""
    pair = draft.pair
    from satcheck.core.curved.freeing import move_off

    move = move_off(pair.a, pair.b, pair.tolerance, rounding_pad(pair.largest_coordinate))
    if move is None:
        draft.record("touch-band", "not found", f"{_band(pair)}: no move within it frees A")
    else:
        draft.record("touch-band", "within", f"{_band(pair)}: {math.hypot(*move):.3g} frees A")
    return move


def _band(pair: Pair) -> str:
    source = "the input precision" if pair.request.tolerance is None else "as asked"
    return f"tolerance {pair.tolerance:.3g}, {source}"


def _searched(draft: Draft, lower: float) -> Band | None:
    """By the search for the depth, with or without a depth asked for; None: it found nothing, or
    was not tried: in a narrow band the way off the triangles was sought."""
    pair = draft.pair
    hulls = way_out_of_hulls(pair)
    if pair.tolerance < NARROW_BAND * hulls.upper:
        return None
    from satcheck.audit.stages.concave_depth import search

    limit = pair.tolerance * LITTLE_LONGER
    way_out = search(draft, lower, hulls.upper, limit=limit).way_out
    return None if way_out is None else band_of(pair, way_out)


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
