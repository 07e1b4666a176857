"""One pair over the whole motion: when it first overlaps, and its worst pose."""

from __future__ import annotations

import math

from msgspec.structs import replace

from satcheck.audit.bodies.pair import Pair
from satcheck.audit.motion.impact import Impact, first_impact, impact_point, possible_overlap
from satcheck.audit.motion.moving_pair import MovingPair, Unanswerable
from satcheck.audit.motion.track import STANDS, track_of
from satcheck.audit.motion.worst import (
    Worst,
    deepest_pose,
    least_distance,
    least_hull_distance,
)
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
        return Sweep(
            relation="indeterminate", tolerance=pair.tolerance, reached=0.0, reason=str(why)
        )
    impact = first_impact(moving, _gaps(moving)) if pair.may("hull") else _not_swept(pair)
    answer = _Answer(moving, impact, {pair.a.id: path_a, pair.b.id: path_b})
    if impact.reason is None:
        return answer.sweep()
    possible = None if pair.may("exact") else possible_overlap(moving, impact.reached)
    return _undecided(moving, impact) if possible is None else answer.possible_hit(possible)


def _gaps(pair: MovingPair) -> tuple[float, ...]:
    """The lengths that decide the relation of bodies that stay apart. If a body has holes, only
    hulls that have no common point prove that no fill is entered."""
    return () if pair.holed else (pair.tolerance, pair.pair.request.clearance or 0.0)


def _not_swept(pair: Pair) -> Impact:
    reason = f"bodies are not swept at --accuracy {pair.settings.accuracy}"
    return Impact(0.0, None, 0.0, reason=reason)


def _undecided(pair: MovingPair, impact: Impact) -> Sweep:
    return Sweep(
        relation="indeterminate",
        tolerance=pair.tolerance,
        reached=impact.reached,
        contact=impact.contact,
        reason=impact.reason,
        steps=pair.steps,
    )


class _Answer:
    def __init__(self, pair: MovingPair, impact: Impact, paths: dict[str, Path | None]) -> None:
        self._pair = pair
        self._impact = impact
        self._paths = paths

    def sweep(self) -> Sweep:
        return self._hit(self._impact.upper) if self._impact.upper is not None else self._free()

    def possible_hit(self, upper: float) -> Sweep:
        """An overlap of boxes, hulls or parts instead of the bodies; no proof."""
        return Sweep(
            relation="penetrating",
            tolerance=self._pair.tolerance,
            reached=self._impact.reached,
            time_of_impact=(self._impact.lower, upper),
            at=self._places(upper),
            contact=self._impact.contact,
            steps=self._pair.steps,
            proven=False,
        )

    def _hit(self, upper: float) -> Sweep:
        pair, impact = self._pair, self._impact
        worst = None
        request = pair.pair.request
        if request.wants("depth") or request.max_thickness is not None:
            worst = least_distance(pair) if pair.convex else deepest_pose(pair, upper)
        return Sweep(
            relation="penetrating",
            tolerance=pair.tolerance,
            reached=impact.reached,
            time_of_impact=(impact.lower, upper),
            at=self._places(upper),
            point=impact_point(pair.placed(upper), pair.path_length(impact.lower, upper)),
            contact=impact.contact,
            worst=None if worst is None else self._pose(worst),
            steps=pair.steps,
        )

    def _free(self) -> Sweep:
        pair, impact = self._pair, self._impact
        worst = self._nearest()
        return Sweep(
            relation=self._relation(worst),
            tolerance=pair.tolerance,
            reached=1.0,
            contact=impact.contact,
            worst=None if worst is None else self._pose(self._with_fills(worst)),
            distance_at_least=impact.gap if worst is None and impact.gap > 0.0 else None,
            reason=self._unfilled(),
            steps=pair.steps,
        )

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
