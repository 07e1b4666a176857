"""One pair over the whole motion: when it first overlaps, and its worst pose."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

from msgspec.structs import replace

from satcheck.audit.motion.impact import Impact, first_impact, impact_point, possible_overlap
from satcheck.audit.motion.moving_pair import MovingPair, Unanswerable
from satcheck.audit.motion.track import STANDS, track_of
from satcheck.audit.motion.worst import (
    Worst,
    deepest_pose,
    least_distance,
    least_hull_distance,
)
from satcheck.audit.pair import Pair
from satcheck.report.sweep import Joints, Place, Sweep, SweptRelation, WorstPose
from satcheck.scene.motion import Path, Rotation, Translation

Places = Callable[[float], tuple[Place, ...]]


def sweep(pair: Pair, path_a: Path | None, path_b: Path | None) -> Sweep:
    """path_a, path_b: the motions of the bodies; None: at rest. The bodies must not share a path,
    because then they do not move relative to each other.
    """
    tracks = [STANDS if path is None else track_of(path) for path in (path_a, path_b)]
    try:
        moving = MovingPair(pair, *tracks)
    except Unanswerable as why:
        return swept(Impact(0.0, None, 0.0, reason=str(why)), pair.tolerance, 0)

    def places(t: float) -> tuple[Place, ...]:
        paths = ((pair.a.id, path_a), (pair.b.id, path_b))
        return tuple(_place(body, path, t) for body, path in paths if path is not None)

    if not pair.may("hull"):
        reason = f"bodies are not swept at --accuracy {pair.settings.accuracy}"
        impact = Impact(0.0, None, 0.0, reason=reason)
    else:
        impact = first_impact(moving, _gaps(moving))
    if impact.upper is not None:
        return _hit(moving, impact, impact.upper, places)
    if impact.reason is None:
        return _free(moving, impact, places)
    # An overlap of boxes, hulls or parts instead of the bodies is no proof.
    hit = None if pair.may("exact") else possible_overlap(moving, impact.reached)
    if hit is None:
        return swept(impact, moving.tolerance, moving.steps)
    impact = replace(impact, upper=hit, reason=None)
    shown = {"at": places(hit), "proven": False}
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


def relation_apart(
    impact: Impact, worst: Worst | None, tolerance: float, clearance: float | None
) -> SweptRelation:
    """The relation of bodies that stay apart, or within the touch band, during the whole motion.
    worst: the nearest pose, as far as it is known."""
    upper = math.inf if worst is None else worst.upper
    if impact.contact is not None or upper <= tolerance:
        return "touching"
    return "near" if upper < (clearance or 0.0) else "separated"


def worst_pose(
    worst: Worst | None, places: Places, joints: Joints | None = None
) -> WorstPose | None:
    """Return the worst pose as a report states it. joints: there, on a path of joints."""
    if worst is None:
        return None
    at = places(worst.time)
    if worst.upper < 0.0:
        return WorstPose(worst.time, at, joints, depth=(-worst.upper, -worst.lower))
    return WorstPose(worst.time, at, joints, distance=(max(worst.lower, 0.0), worst.upper))


def _gaps(pair: MovingPair) -> tuple[float, ...]:
    """The lengths that decide the relation of bodies that stay apart. If a body has holes, only
    hulls that have no common point prove that no fill is entered."""
    return () if pair.holed else (pair.tolerance, pair.pair.request.clearance or 0.0)


def _hit(pair: MovingPair, impact: Impact, upper: float, places: Places) -> Sweep:
    worst, request = None, pair.pair.request
    if request.wants("depth") or request.max_thickness is not None:
        worst = least_distance(pair) if pair.convex else deepest_pose(pair, upper)
    return swept(
        impact,
        pair.tolerance,
        pair.steps,
        "penetrating",
        at=places(upper),
        point=impact_point(pair.placed(upper), pair.path_length(impact.lower, upper)),
        worst=worst_pose(worst, places),
    )


def _free(pair: MovingPair, impact: Impact, places: Places) -> Sweep:
    worst, clearance = _nearest(pair, impact), pair.pair.request.clearance
    relation = relation_apart(impact, worst, pair.tolerance, clearance)
    if pair.holed and not pair.hulls_apart:
        unfilled = f"the fills of the holes of {' and '.join(pair.holed)} were not swept"
        impact = replace(impact, reason=unfilled)
    if worst is not None and pair.holed and clearance:
        # The fill of a hole may be nearer than the surfaces, but not nearer than the hulls.
        hulls = least_hull_distance(pair, worst.upper, clearance)
        worst = replace(worst, lower=min(worst.lower, hulls))
    return swept(
        impact,
        pair.tolerance,
        pair.steps,
        relation,
        worst=worst_pose(worst, places),
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


def _place(body: str, path: Path, t: float) -> Place:
    if isinstance(path, Rotation):
        return Place(body, "degrees", path.degrees * t)
    if isinstance(path, Translation):
        return Place(body, "length", math.hypot(*path.vector) * t)
    return Place(body, "t", t)
