"""The bodies of a scene that move, along tracks or by joints, and the sweep of each pair over the
whole motion: when it first overlaps, and its worst pose."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import partial

from msgspec.structs import replace

from satcheck.audit.bodies import PlacedBodies
from satcheck.audit.body import PlacedBody
from satcheck.audit.close_pairs import ClosePairs
from satcheck.audit.motion.impact import first_impact, impact_point, open_sweep, possible_overlap
from satcheck.audit.motion.moving_pair import MovingPair, OpenStretches, Unanswerable, holed
from satcheck.audit.motion.open_stretches import open_stretches
from satcheck.audit.motion.travel import Travel
from satcheck.audit.motion.worst import (
    Worst,
    deepest_pose,
    least_distance,
    least_hull_distance,
)
from satcheck.audit.pair import Moves, Pair
from satcheck.audit.planner import Planner
from satcheck.core.errors import SatcheckError
from satcheck.report.report import Issue
from satcheck.report.sweep import StatedMotion, Sweep, SweptRelation, WorstPose
from satcheck.report.values import Interval
from satcheck.scene import Scene
from satcheck.scene.half_spaces import holds


def sweep(pair: Pair, travel: Travel, found: OpenStretches) -> Sweep:
    """Return the sweep of a pair through the stretches of t in which it may meet."""
    try:
        if found.stretches:
            _require_reach(pair, travel)
            return _swept_along(MovingPair(pair, travel, found))
    except Unanswerable as why:
        return Sweep(
            relation="indeterminate",
            reached=0.0,
            reason=str(why),
            tolerance=pair.tolerance,
            steps=found.steps,
        )
    return Sweep(
        relation="separated",
        reached=1.0,
        distance_at_least=found.gap,
        tolerance=pair.tolerance,
        steps=found.steps,
    )


def _require_reach(pair: Pair, travel: Travel) -> None:
    for floor, other in ((pair.a, pair.b), (pair.b, pair.a)):
        if floor.endless and not holds(floor.body, travel.bounds(other.id)):
            raise Unanswerable(f"{other.id} moves beyond the reach of the half space")


def _swept_along(moving: MovingPair) -> Sweep:
    """Return the sweep of two bodies on their ways."""
    pair = moving.pair
    if not pair.may("hull"):
        reason = f"bodies are not swept at --accuracy {pair.settings.accuracy}"
        swept = open_sweep(moving, 0.0, reason=reason)
    else:
        swept = first_impact(moving, _gap(moving))
    if swept.time_of_impact is not None:
        swept = _hit(moving, swept, swept.time_of_impact)
    elif swept.reason is None:
        swept = _free(moving, swept)
    elif not pair.may("exact"):
        # An overlap of boxes, hulls or parts instead of the bodies is no proof.
        hit = possible_overlap(moving, swept.reached)
        if hit is not None:
            shown = open_sweep(moving, swept.reached, (swept.reached, hit), swept.contact)
            swept = replace(shown, at=moving.posed(hit)["at"], proven=False)
    return replace(swept, steps=moving.steps)


def _worst_pose(pair: MovingPair, worst: Worst | None) -> WorstPose | None:
    """Return the worst pose as a report states it."""
    if worst is None:
        return None
    posed = pair.posed(worst.time)
    posed.pop("poses", None)
    if worst.upper < 0.0:
        return WorstPose(worst.time, **posed, depth=(-worst.upper, -worst.lower))
    return WorstPose(worst.time, **posed, distance=(max(worst.lower, 0.0), worst.upper))


def _gap(pair: MovingPair) -> float:
    """Return the length that decides the relation of bodies that stay apart. If a body has holes,
    only hulls that have no common point prove that no fill is entered."""
    return 0.0 if holed(pair.pair) else max(pair.tolerance, pair.pair.request.clearance or 0.0)


def _hit(pair: MovingPair, swept: Sweep, impact: Interval) -> Sweep:
    worst, request = None, pair.pair.request
    if request.wants("depth") or request.max_thickness is not None:
        worst = least_distance(pair) if pair.convex else deepest_pose(pair, impact[1])
    point = impact_point(pair.placed(impact[1]), pair.path_length(*impact))
    return replace(swept, **pair.posed(impact[1]), point=point, worst=_worst_pose(pair, worst))


def _free(pair: MovingPair, swept: Sweep) -> Sweep:
    worst, clearance = _nearest(pair, swept), pair.pair.request.clearance
    if worst is not None and clearance and worst.lower < clearance <= worst.upper:
        worst = _as_placed(pair, worst, clearance)
    upper = math.inf if worst is None else worst.upper
    relation: SweptRelation = "near" if upper < (clearance or 0.0) else "separated"
    if swept.contact is not None or upper <= pair.tolerance:
        relation = "touching"
    holes, reason = holed(pair.pair), None
    if holes and not pair.hulls_apart:
        reason = f"the fills of the holes of {' and '.join(holes)} were not swept"
    if worst is not None and holes and clearance:
        # The fill of a hole may be nearer than the surfaces, but not nearer than the hulls.
        hulls = least_hull_distance(pair, worst.upper, clearance)
        worst = replace(worst, lower=min(worst.lower, hulls))
    return replace(swept, relation=relation, reason=reason, worst=_worst_pose(pair, worst))


def _nearest(pair: MovingPair, swept: Sweep) -> Worst | None:
    """Return the nearest pose, as narrowly as the relation and the clearance need it; None: they do
    not need it, or it is unknown."""
    contact, clearance = swept.contact, pair.pair.request.clearance
    if swept.distance_at_least or not (pair.convex or pair.pair.may("exact")):
        return None
    if contact is None:
        lengths = (pair.tolerance, clearance or 0.0)
        return least_distance(pair, lengths, narrow=bool(clearance))
    try:
        gap = pair.least_gap(contact, contact)[1] if clearance else None
    except Unanswerable:
        return None
    return None if gap is None else Worst(contact, 0.0, max(gap, 0.0))


def _as_placed(pair: MovingPair, worst: Worst, clearance: float) -> Worst:
    """The worst pose. If it, or an end of the motion, is nearer than the clearance as a pose at
    rest, which is exact, it is that one."""
    try:
        times = (worst.time, 0.0, 1.0)
        near = next((t for t in times if pair.found_at(t, clearance).relation == "near"), None)
    except Unanswerable:
        return worst
    if near is None:
        return worst
    return replace(worst, time=near, upper=math.nextafter(clearance, 0.0))


class Movers:
    """Raises SatcheckError (`bad-pose`) for a scene that cannot be checked along a path of
    joints."""

    def __init__(self, scene: Scene, bodies: PlacedBodies, planner: Planner) -> None:
        placed = list(bodies.placed.values())
        self._bodies, self._planner, self._motions = bodies, planner, scene.motions
        self._clear = {id_ for motion in scene.motions if motion.clear for id_ in motion.bodies}
        self._travel = _travel_of(scene, placed, planner)

    def close(self) -> ClosePairs:
        """Return the pairs that may be as close as they ask, as placed or at some t."""
        travel, bodies, planner = self._travel, self._bodies, self._planner

        def may_meet(i: int, j: int) -> bool:
            a, b = bodies.placed[i], bodies.placed[j]
            limit = planner.gap_limit(i, j, a.resolution + b.resolution)
            return travel.may_meet(a.id, b.id, limit)

        return ClosePairs(bodies, planner, travel.bounds, may_meet)

    def add_sweeps(self, pairs: Sequence[Pair]) -> None:
        """Gives each pair whose bodies move relative to each other its sweep."""
        travel = self._travel
        moving = [pair for pair in pairs if travel.moves(pair.a.id, pair.b.id)]
        found = open_stretches(travel, moving)
        for pair, stretches in zip(moving, found, strict=True):
            clear = not self._clear.isdisjoint((pair.a.id, pair.b.id))
            pair.moves = Moves(partial(sweep, travel=travel, found=stretches), clear)

    def stated(self) -> tuple[StatedMotion, ...]:
        """The motions as a report states them."""
        return self._travel.stated()

    def issues(self) -> list[Issue]:
        """Warnings about motions of bodies that do not exist."""
        lost = {id_ for motion in self._motions for id_ in motion.bodies} - set(self._bodies.ids)
        message = "a motion names {!r}, and no body has this id"
        return [
            Issue("unknown-body", "warning", None, None, message.format(body))
            for body in sorted(lost)
        ]


def _travel_of(scene: Scene, placed: Sequence[PlacedBody], planner: Planner) -> Travel:
    if scene.joint_path is None:
        from satcheck.audit.motion.track import TrackTravel

        return TrackTravel(scene.motions, placed)
    from satcheck.audit.motion.joint_travel import JointTravel

    _require_answers(scene, planner)
    usable = replace(scene, bodies=tuple(body.body for body in placed))
    return JointTravel(usable, scene.joint_path, placed)


def _require_answers(scene: Scene, planner: Planner) -> None:
    settings = planner.settings
    refused = {
        "--planar": settings.planar is not None,
        f"--accuracy {settings.accuracy}": settings.accuracy != "exact",
        "rules about single bodies": bool(scene.body_rules),
        "motions of a scene": bool(scene.motions),
    }
    for what in (what for what, given in refused.items() if given):
        raise SatcheckError("bad-pose", f"a path of joints cannot be checked with {what}")
