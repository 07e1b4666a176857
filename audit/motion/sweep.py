"""One pair over the whole motion: when it first overlaps, and its worst pose."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING, Any

from msgspec.structs import replace

from satcheck.audit.motion.impact import Impact, first_impact, impact_point, possible_overlap
from satcheck.audit.motion.moving_pair import MovingPair, OpenStretches, Posed, Unanswerable, holed
from satcheck.audit.motion.worst import (
    Worst,
    deepest_pose,
    least_distance,
    least_hull_distance,
)
from satcheck.audit.pair import Pair
from satcheck.report.sweep import Sweep, SweptRelation, WorstPose
from satcheck.scene.half_spaces import holds

if TYPE_CHECKING:
    from satcheck.audit.motion.open_stretches import Travel

Poses = Callable[[float], Posed]


def sweep(pair: Pair, travel: Travel, found: OpenStretches) -> Sweep:
    """Return the sweep of a pair through the stretches of t in which it may meet."""
    try:
        if found.stretches:
            _require_reach(pair, travel)
            ways = travel.ways(pair.a.id, pair.b.id)
            moving = MovingPair(pair, *ways, found)
            return swept_along(moving, partial(travel.posed, pair))
    except Unanswerable as why:
        return swept(Impact(0.0, None, 0.0, reason=str(why)), pair.tolerance, found.steps)
    free = Impact(1.0, None, 1.0, gap=found.gap)
    return swept(free, pair.tolerance, found.steps, "separated", distance_at_least=found.gap)


def _require_reach(pair: Pair, travel: Travel) -> None:
    for floor, other in ((pair.a, pair.b), (pair.b, pair.a)):
        if floor.endless and not holds(floor.body, travel.bounds(other.id, other.bounds)):
            raise Unanswerable(f"{other.id} moves beyond the reach of the half space")


def swept_along(moving: MovingPair, posed: Poses) -> Sweep:
    """The sweep of two bodies on their ways. posed: their poses for the report."""
    pair = moving.pair
    if not pair.may("hull"):
        reason = f"bodies are not swept at --accuracy {pair.settings.accuracy}"
        impact = Impact(0.0, None, 0.0, reason=reason)
    else:
        impact = first_impact(moving, _gaps(moving))
    if impact.upper is not None:
        return _hit(moving, impact, impact.upper, posed)
    if impact.reason is None:
        return _free(moving, impact, posed)
    # An overlap of boxes, hulls or parts instead of the bodies is no proof.
    hit = None if pair.may("exact") else possible_overlap(moving, impact.reached)
    if hit is None:
        return swept(impact, moving.tolerance, moving.steps)
    impact = replace(impact, upper=hit, reason=None)
    shown = {"at": posed(hit).at, "proven": False}
    return swept(impact, moving.tolerance, moving.steps, "penetrating", **shown)


def swept(
    impact: Impact,
    tolerance: float,
    steps: int,
    relation: SweptRelation = "indeterminate",
    **figures: Any,
) -> Sweep:
    """The sweep that found the impact."""
    return Sweep(
        relation=relation,
        time_of_impact=None if impact.upper is None else (impact.lower, impact.upper),
        reached=impact.reached,
        contact=impact.contact,
        reason=impact.reason,
        tolerance=tolerance,
        steps=steps,
        **figures,
    )


def _relation_apart(
    impact: Impact, worst: Worst | None, tolerance: float, clearance: float | None
) -> SweptRelation:
    """The relation of bodies that stay apart, or within the touch band, during the whole motion.
    worst: the nearest pose, as far as it is known."""
    upper = math.inf if worst is None else worst.upper
    if impact.contact is not None or upper <= tolerance:
        return "touching"
    return "near" if upper < (clearance or 0.0) else "separated"


def _worst_pose(worst: Worst | None, poses: Poses) -> WorstPose | None:
    """Return the worst pose as a report states it."""
    if worst is None:
        return None
    posed = poses(worst.time)
    if worst.upper < 0.0:
        depth = -worst.upper, -worst.lower
        return WorstPose(worst.time, posed.at, posed.joints, depth=depth)
    distance = max(worst.lower, 0.0), worst.upper
    return WorstPose(worst.time, posed.at, posed.joints, distance=distance)


def _gaps(pair: MovingPair) -> tuple[float, ...]:
    """The lengths that decide the relation of bodies that stay apart. If a body has holes, only
    hulls that have no common point prove that no fill is entered."""
    return () if holed(pair.pair) else (pair.tolerance, pair.pair.request.clearance or 0.0)


def _hit(pair: MovingPair, impact: Impact, upper: float, poses: Poses) -> Sweep:
    worst, request = None, pair.pair.request
    if request.wants("depth") or request.max_thickness is not None:
        worst = least_distance(pair) if pair.convex else deepest_pose(pair, upper)
    posed = poses(upper)
    return swept(
        impact,
        pair.tolerance,
        pair.steps,
        "penetrating",
        at=posed.at,
        joints=posed.joints,
        poses=posed.poses,
        point=impact_point(pair.placed(upper), pair.path_length(impact.lower, upper)),
        worst=_worst_pose(worst, poses),
    )


def _free(pair: MovingPair, impact: Impact, poses: Poses) -> Sweep:
    worst, clearance = _nearest(pair, impact), pair.pair.request.clearance
    relation = _relation_apart(impact, worst, pair.tolerance, clearance)
    holes = holed(pair.pair)
    if holes and not pair.hulls_apart:
        unfilled = f"the fills of the holes of {' and '.join(holes)} were not swept"
        impact = replace(impact, reason=unfilled)
    if worst is not None and holes and clearance:
        # The fill of a hole may be nearer than the surfaces, but not nearer than the hulls.
        hulls = least_hull_distance(pair, worst.upper, clearance)
        worst = replace(worst, lower=min(worst.lower, hulls))
    return swept(
        impact,
        pair.tolerance,
        pair.steps,
        relation,
        worst=_worst_pose(worst, poses),
        distance_at_least=impact.gap if worst is None and impact.gap > 0.0 else None,
    )


def _nearest(pair: MovingPair, impact: Impact) -> Worst | None:
    """The nearest pose, as narrowly as the relation and the clearance need it; None: they do not
    need it, or it is unknown."""
    contact, clearance = impact.contact, pair.pair.request.clearance
    if not pair.convex and not pair.pair.may("exact"):
        return None
    if contact is None:
        lengths = (pair.tolerance, clearance or 0.0)
        if impact.gap >= max(lengths):
            return None
        return least_distance(pair, lengths, narrow=bool(clearance))
    try:
        gap = pair.least_gap(contact, contact)[1] if clearance else None
    except Unanswerable:
        return None
    return None if gap is None else Worst(contact, 0.0, max(gap, 0.0))
