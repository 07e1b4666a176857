"""The depth of a pair of which one body at least is not convex: a proven interval.

The hulls of the whole meshes are an upper bound, and so is every translation that was found to free
the meshes. A crossing pair of triangles on which both bodies end is a lower bound, because a free A
has none, and so is the gap around a body inside another. Between the two the translations
themselves are searched (core.search_depth), with convex regions inside the meshes, grown where they
are needed, as the proof that a translation leaves an overlap. A ladder that ends below the meshes
has convex parts for that.
"""

from __future__ import annotations

import math

from satcheck import core
from satcheck.audit.draft import Depth, Draft, Escape
from satcheck.audit.pair import Pair
from satcheck.audit.stages.depth import (
    frees_boxes,
    gap_around,
    length_and_normal,
    verified_escape,
    way_out_of_hulls,
)
from satcheck.audit.stages.parts import depth_of_parts
from satcheck.core.rounding import UNIT_ROUNDOFF
from satcheck.report.judge import EXACT_WIDTH
from satcheck.report.report import Vector

# An interval on both sides of a limit is narrowed again, each time by this factor.
NARROWER = 8
# Length, normal, and the translation of a search.
_Way = tuple[float, Vector, Vector | None]


def concave_depth(draft: Draft) -> Depth:
    """The depth of an overlapping pair of which the hulls do not say everything: the largest lower
    and the least upper bound of all that was tried, beside the shortest verified translation."""
    pair = draft.pair
    hulls = way_out_of_hulls(pair)
    draft.record("depth", "upper bound", f"at most {hulls.upper:.6g} by the {hulls.by}")
    lower, upper = _cheap_lower_bound(draft), hulls.upper
    ways: list[_Way] = [(hulls.length, hulls.normal, None)]
    if pair.may("exact"):
        lower, upper, way_out = _searched(draft, lower, upper)
        if way_out is not None:
            ways.insert(0, (*length_and_normal(way_out), way_out))
    elif draft.exact_proven and pair.may("parts"):
        lower = max(lower, depth_of_parts(draft))
    escape = _shortest_escape(draft, ways)
    if frees_boxes(pair, hulls.length, hulls.normal):
        upper = min(upper, hulls.length)
    upper = min(upper, escape.bound)
    return Depth(min(lower, upper), upper, escape)


def _shortest_escape(draft: Draft, ways: list[_Way]) -> Escape:
    """Return the shortest of these ways out once verified. ways: the shortest first. The next is
    tried only if verification made the best one longer than it."""
    shortest = verified_escape(draft, *ways[0])
    for length, normal, found in ways[1:]:
        if shortest.bound > length:
            escape = verified_escape(draft, length, normal, found)
            shortest = min(shortest, escape, key=lambda each: each.bound)
    return shortest


def _searched(draft: Draft, lower: float, upper: float) -> tuple[float, float, Vector | None]:
    """Bounds and a way out that are narrow enough, also to decide a limit of the depth, as far as
    the budget goes."""
    pair = draft.pair
    work, width = pair.work, pair.settings.width
    interval = search(draft, lower, upper)
    way_out, upper = interval.way_out, min(upper, interval.bound)
    while interval.stop == "narrow" and width > EXACT_WIDTH and _straddles(pair, interval):
        width, work = width / NARROWER, work - interval.work
        if work <= 0:
            break
        interval = search(draft, interval.lower, interval.upper, width=width, work=work)
        way_out, upper = interval.way_out or way_out, min(upper, interval.bound)
    return max(lower, interval.lower), upper, way_out


def _straddles(pair: Pair, interval: core.DepthInterval) -> bool:
    limit = pair.request.max_depth
    return limit is not None and interval.lower <= limit < interval.upper


def search(
    draft: Draft,
    lower: float,
    upper: float,
    *,
    width: float | None = None,
    work: int | None = None,
    limit: float = math.inf,
) -> core.DepthInterval:
    """The interval between known bounds narrowed, by translations of A that free the meshes and by
    proofs that others do not. width, work: those of the settings. limit: the search also ends when
    the depth is proven to be at least this."""
    pair = draft.pair
    with pair.searching("depth") as progress:
        interval = core.search_depth(
            pair.a.surface(),
            pair.b.surface(),
            upper=upper,
            lower=min(lower, upper),
            width=pair.settings.width if width is None else width,
            work=pair.work if work is None else work,
            across=pair.settings.across,
            limit=limit,
            progress=progress,
        )
    draft.work += interval.work
    spent = interval.stop == "work spent"
    reason = "; the budget ended the search" if spent else ""
    draft.record(
        "search",
        "budget spent" if spent else interval.stop,
        f"from {interval.lower:.6g} to {interval.upper:.6g} by {interval.boxes} boxes "
        f"of translations, {interval.sets} convex sets of them, "
        f"{interval.mesh_tests} tests of the meshes{reason}",
    )
    return interval


def _cheap_lower_bound(draft: Draft) -> float:
    if not draft.exact_proven:
        return 0.0
    gap = gap_around(draft)
    if gap > 0:
        draft.record("depth", "lower bound", f"at least {gap:.6g} by the gap around the inner body")
    return max(gap, _crossing_depth(draft))


def depth_by_move(draft: Draft, move: Vector) -> Depth:
    """The depth of a pair that a verified translation of A within the touch band frees.

    A wide tolerance must not make the figures coarser: a shorter move is then searched, as without
    a band. Within the input precision there is nothing to refine.
    """
    pair = draft.pair
    if pair.request.tolerance is None:
        return depth_of_move(pair, move, _crossing_depth(draft))
    depth = concave_depth(draft)
    if depth.escape.verified and depth.upper <= math.hypot(*move):
        return depth
    return depth_of_move(pair, move, depth.lower)


def depth_of_move(pair: Pair, move: Vector, lower: float) -> Depth:
    """Of a pair that a verified translation of A frees."""
    length, normal = length_and_normal(move)
    upper = length + 2 * UNIT_ROUNDOFF * pair.largest_coordinate
    return Depth(min(lower, upper), upper, Escape(move, normal, True, upper))


def _crossing_depth(draft: Draft) -> float:
    """Return a proven lower bound of the depth from one pair of triangles that cross; 0.0 without
    one."""
    pair = draft.pair
    if draft.crossing is None:
        return 0.0
    return core.crossing_depth(pair.a.surface(), pair.b.surface(), *draft.crossing)
