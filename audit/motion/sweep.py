"""One pair over the whole motion: when it first overlaps, and its worst pose."""

from __future__ import annotations

import math
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
from satcheck.report.sweep import Place, Sweep, SweptRelation, WorstPose
from satcheck.scene.motion import Path, Rotation, Translation


def sweep(pair: Pair, path_a: Path | None, path_b: Path | None) -> Sweep:
    """path_a, path_b: the motions of the bodies; None: at rest. The bodies must not share a path,
    because then they do not move relative to each other.
    """
    tracks = [STANDS if path is None else track_of(path) for path in (path_a, path_b)]
    try:
        moving = MovingPair(pair, *tracks)
    except Unanswerable as why:
        return swept(Impact(0.0, None, 0.0, reason=str(why)), pair.tolerance, 0)
    impact = first_impact(moving, _gaps(moving)) if pair.may("hull") else _not_swept(pair)
    answer = _Answer(moving, impact, {pair.a.id: path_a, pair.b.id: path_b})
    if impact.upper is not None:
        return answer.hit(impact.upper)
    if impact.reason is None:
        return answer.free()
    possible = None if pair.may("exact") else possible_overlap(moving, impact.reached)
    return answer.possible_hit(possible)


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


def _gaps(pair: MovingPair) -> tuple[float, ...]:
    """The lengths that decide the relation of bodies that stay apart. If a body has holes, only
    hulls that have no common point prove that no fill is entered."""
    return () if pair.holed else (pair.tolerance, pair.pair.request.clearance or 0.0)


def _not_swept(pair: Pair) -> Impact:
    reason = f"bodies are not swept at --accuracy {pair.settings.accuracy}"
    return Impact(0.0, None, 0.0, reason=reason)


class _Answer:
    def __init__(self, pair: MovingPair, impact: Impact, paths: dict[str, Path | None]) -> None:
        self._pair = pair
        self._impact = impact
        self._paths = paths

    def possible_hit(self, upper: float | None) -> Sweep:
        """An overlap of boxes, hulls or parts instead of the bodies; no proof. None: undecided."""
        if upper is None:
            return self._swept(self._impact)
        hit = replace(self._impact, upper=upper, reason=None)
        return self._swept(hit, "penetrating", at=self._places(upper), proven=False)

    def hit(self, upper: float) -> Sweep:
        pair, impact = self._pair, self._impact
        worst = None
        request = pair.pair.request
        if request.wants("depth") or request.max_thickness is not None:
            worst = least_distance(pair) if pair.convex else deepest_pose(pair, upper)
        return self._swept(
            impact,
            "penetrating",
            at=self._places(upper),
            point=impact_point(pair.placed(upper), pair.path_length(impact.lower, upper)),
            worst=None if worst is None else self._pose(worst),
        )

    def free(self) -> Sweep:
        impact, worst = self._impact, self._nearest()
        return self._swept(
            replace(impact, reason=self._unfilled()),
            self._relation(worst),
            worst=None if worst is None else self._pose(self._with_fills(worst)),
            distance_at_least=impact.gap if worst is None and impact.gap > 0.0 else None,
        )

    def _swept(
        self, impact: Impact, relation: SweptRelation = "indeterminate", **figures: Any
    ) -> Sweep:
        return swept(impact, self._pair.tolerance, self._pair.steps, relation, **figures)

    def _nearest(self) -> Worst | None:
        """The nearest pose, as narrowly as the relation and the clearance need it; None: they do
        not need it, or it is unknown."""
        pair, contact = self._pair, self._impact.contact
        clearance = pair.pair.request.clearance
        if not pair.convex and not pair.pair.may("exact"):
            return None
        if contact is not None:
            return self._nearest_at(contact) if clearance else None
        lengths = (pair.tolerance, clearance or 0.0)
        if self._impact.gap >= max(lengths):
            return None
        return least_distance(pair, lengths, narrow=bool(clearance))

    def _nearest_at(self, contact: float) -> Worst | None:
        try:
            return Worst(contact, 0.0, max(self._pair.least_gap(contact, contact)[1], 0.0))
        except Unanswerable:
            return None

    def _with_fills(self, worst: Worst) -> Worst:
        """The fill of a hole may be nearer than the surfaces, but not nearer than the hulls."""
        clearance = self._pair.pair.request.clearance
        if not clearance or not self._pair.holed:
            return worst
        hulls = least_hull_distance(self._pair, worst.upper, clearance)
        return replace(worst, lower=min(worst.lower, hulls))

    def _relation(self, worst: Worst | None) -> SweptRelation:
        """The relation of bodies that stay apart, or within the touch band, during the whole
        motion."""
        upper = math.inf if worst is None else worst.upper
        if self._impact.contact is not None or upper <= self._pair.tolerance:
            return "touching"
        return "near" if upper < (self._pair.pair.request.clearance or 0.0) else "separated"

    def _unfilled(self) -> str | None:
        """Which holes leave open whether a body entered the other one: fills are not swept."""
        holed = self._pair.holed
        if not holed or self._pair.hulls_apart:
            return None
        return f"the fills of the holes of {' and '.join(holed)} were not swept"

    def _pose(self, worst: Worst) -> WorstPose:
        at = self._places(worst.time)
        if worst.upper < 0.0:
            return WorstPose(worst.time, at, depth=(-worst.upper, -worst.lower))
        return WorstPose(worst.time, at, distance=(max(worst.lower, 0.0), worst.upper))

    def _places(self, t: float) -> tuple[Place, ...]:
        return tuple(
            _place(body, path, t) for body, path in self._paths.items() if path is not None
        )


def _place(body: str, path: Path, t: float) -> Place:
    if isinstance(path, Rotation):
        return Place(body, "degrees", path.degrees * t)
    if isinstance(path, Translation):
        return Place(body, "length", math.hypot(*path.vector) * t)
    return Place(body, "t", t)
