"""The gap of two bodies without a common interior, if the request needs it."""

from __future__ import annotations

import math
from functools import partial
from typing import TYPE_CHECKING

from satcheck import core
from satcheck.audit.draft import Draft, Gap
from satcheck.audit.pair import Pair
from satcheck.core.rounding import rounding_pad
from satcheck.report.judge import EXACT_WIDTH, keeps
from satcheck.report.report import Vector, Witness

if TYPE_CHECKING:
    from collections.abc import Callable

    from satcheck.core.curved.signed import Signed

    # The sign of (distance - length), exactly; None where it is not known.
    Compare = Callable[[float], int | None]


def measure_gap(draft: Draft) -> Gap:
    """The distance of a separated or touching pair, as far as the clearance or the band asks."""
    pair = draft.pair
    if draft.signed is not None:
        if pair.request.wants("distance"):
            draft.record("distance", "measured", "with the hulls")
        return _convex_gap(draft, draft.signed)
    if draft.exact == "touching":
        witness = draft.point and Witness(draft.point, draft.point)
        return Gap(0.0, 0.0, True, not pair.request.clearance, 0.0, None, witness)
    climb = draft.climb
    if climb is None or climb.gap is None:
        if climb is not None and climb.too_few_steps:
            stage = "distance" if pair.wants_distance else "touch-band"
            draft.add(stage, "undecided", "too many steps", climb.band_nanoseconds)
        return _at_least(pair, draft.gap_lower)
    return _surface_gap(draft, climb, climb.gap)


def _surface_gap(draft: Draft, climb: core.Climb, surfaces: core.MeshDistance) -> Gap:
    pair = draft.pair
    # A clearance wants the figure; the touch band only wants to know whether it is inside.
    asked = pair.wants_distance
    stage, limit = ("distance", math.inf) if asked else ("touch-band", pair.tolerance)
    cost, hole_gap = climb.band_nanoseconds, climb.gap_of_holes
    if math.isinf(surfaces.distance):
        draft.add(stage, "beyond", f"more than {limit:.6g} apart", cost)
        beyond = math.nextafter(limit, math.inf)
        return _at_least(pair, beyond if hole_gap is None else hole_gap)
    draft.add(stage, "measured", f"triangles {surfaces.triangle_a} and {surfaces.triangle_b}", cost)
    rounding = rounding_pad(pair.largest_coordinate)
    nearest = surfaces.distance if hole_gap is None else hole_gap
    lower, upper = max(nearest - rounding, 0.0), surfaces.distance + rounding

    def side(length: float, sure: tuple[int, ...]) -> int | None:
        """The sign of (distance - length). What fills a hole may be nearer than the surfaces, so
        that only some signs are sure. None too if it takes too many steps."""
        try:
            sign = core.compare_gap(pair.a.surface(), pair.b.surface(), length)
        except core.TooManySteps:
            return None
        return sign if hole_gap is None or sign in sure else None

    distance = surfaces.distance
    normal = _direction(surfaces.witness_a, surfaces.witness_b)
    witness = Witness(surfaces.witness_a, surfaces.witness_b)
    if asked and hole_gap is None and not _is_narrow(lower, upper):
        from satcheck.audit.stages.exact_gap import gap_of_triangles, narrowed

        nearest_points = gap_of_triangles(pair, surfaces)
        if nearest_points is not None:
            normal, witness = nearest_points.normal, nearest_points.witness
            upper = nearest_points.upper
            least = nearest_points.lower
            if side(least, sure=(-1, 0, 1)) in (0, 1):
                lower = least
            lower, upper = narrowed(min(lower, least), upper, partial(side, sure=(-1, 0, 1)))
            distance = min(max(nearest_points.distance, lower), upper)

    tolerance, clearance = pair.tolerance, pair.request.clearance
    within = _is_within(lower, upper, tolerance, lambda length: side(length, sure=(-1, 0)))
    kept = _is_kept(lower, upper, clearance, lambda length: side(length, sure=(-1,)))
    return Gap(
        lower,
        upper,
        within,
        kept,
        _on_its_side(distance, pair, within, kept),
        normal,
        witness,
    )


def _convex_gap(draft: Draft, result: core.PairResult | Signed) -> Gap:
    pair = draft.pair
    distance = max(result.distance or 0.0, 0.0)
    witness = None
    if result.witness_a is not None and result.witness_b is not None:
        witness = Witness(result.witness_a, result.witness_b)
    lower, upper = max(result.lower or 0.0, 0.0), max(result.upper or 0.0, distance)
    normal = result.normal
    if draft.exact == "touching" and draft.exact_proven:
        lower = upper = distance = 0.0
    elif pair.on_half_space and distance > 0:
        # A height, rounded once: only the block that stands for the half space is off.
        lower = upper = distance
    elif pair.wants_distance and not (pair.curved or _is_narrow(lower, upper)):
        from satcheck.audit.stages.exact_gap import gap_of_hulls, narrowed

        nearest = None if pair.settings.planar else gap_of_hulls(pair)
        if nearest is not None:
            lower, upper, distance = nearest.lower, nearest.upper, nearest.distance
            normal, witness = nearest.normal, nearest.witness
        lower, upper = narrowed(lower, upper, partial(compare_convex, pair))
        distance = min(max(distance, lower), upper)

    def compare(length: float) -> int | None:
        return compare_convex(pair, length)

    within = _is_within(lower, upper, pair.tolerance, compare)
    kept = _is_kept(lower, upper, pair.request.clearance, compare)
    distance = _on_its_side(distance, pair, within, kept)
    return Gap(lower, upper, within, kept, distance, normal, witness)


def _is_narrow(lower: float, upper: float) -> bool:
    return upper - lower <= EXACT_WIDTH * upper


def _at_least(pair: Pair, lower: float) -> Gap:
    """Of bodies without a common point, of which no more is known."""
    beyond = lower > pair.tolerance or pair.tolerance == 0
    kept = True if lower >= (pair.request.clearance or 0.0) else None
    return Gap(lower, math.inf, False if beyond else None, kept)


def compare_convex(pair: Pair, length: float) -> int | None:
    """The sign of (signed distance - length) of two convex bodies, exactly; None where the rounding
    of a curved shape leaves it open, or where exact arithmetic takes too many steps."""
    if pair.on_half_space:
        from satcheck.audit.stages.half_space import above

        return above(pair).compare(length)
    if not pair.curved:
        return core.compare_signed_distance(pair.a.hull_shape(), pair.b.hull_shape(), length)
    from satcheck.core.curved.signed import compare

    return compare(pair.a, pair.b, length)


def _is_within(lower: float, upper: float, tolerance: float, compare: Compare) -> bool | None:
    if upper <= tolerance or lower > tolerance:
        return upper <= tolerance
    side = compare(tolerance)
    return None if side is None else side <= 0


def _is_kept(lower: float, upper: float, clearance: float | None, compare: Compare) -> bool | None:
    if not clearance or lower >= clearance:
        return True
    side = -1 if upper < clearance else compare(clearance)
    return keeps(clearance, lower, upper) if side is None else side >= 0


def _on_its_side(distance: float, pair: Pair, within: bool | None, kept: bool | None) -> float:
    """The rounded distance, no further than the tolerance and the clearance that it is proven to be
    at most, or at least."""
    clearance = pair.request.clearance or 0.0
    if within:
        distance = min(distance, pair.tolerance)
    elif within is False:
        distance = max(distance, pair.tolerance)
    if clearance and kept is not None:
        distance = max(distance, clearance) if kept else min(distance, clearance)
    return distance


def _direction(start: Vector, end: Vector) -> Vector | None:
    step = (end[0] - start[0], end[1] - start[1], end[2] - start[2])
    length = math.hypot(*step)
    return None if length == 0 else (step[0] / length, step[1] / length, step[2] / length)
