"""The bodies of a scene that move, along tracks or by joints, and the sweeps of its pairs."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import TYPE_CHECKING

from msgspec.structs import replace

from satcheck.audit.bodies import PlacedBodies
from satcheck.audit.body import PlacedBody
from satcheck.audit.close_pairs import ClosePairs
from satcheck.audit.motion.open_stretches import open_stretches
from satcheck.audit.motion.sweep import sweep
from satcheck.audit.motion.track_travel import TrackTravel
from satcheck.audit.pair import Moves, Pair
from satcheck.audit.planner import Planner
from satcheck.audit.posed_pairs import ball_around
from satcheck.core.errors import SatcheckError
from satcheck.report.report import Issue
from satcheck.report.sweep import StatedMotion
from satcheck.scene import Scene

if TYPE_CHECKING:
    from satcheck.audit.motion.open_stretches import Travel


class Movers:
    """Raises SatcheckError (`bad-pose`) for a scene that cannot be checked along a path of
    joints."""

    def __init__(self, scene: Scene, bodies: PlacedBodies, planner: Planner) -> None:
        placed = list(bodies.placed.values())
        self._bodies, self._planner, self._motions = bodies, planner, scene.motions
        self._clear = {id_ for motion in scene.motions if motion.clear for id_ in motion.bodies}
        self._travel: Travel = _travel_of(scene, placed, planner)

    def close(self) -> ClosePairs:
        """The pairs that may be as close as they ask, as placed or at some t."""
        travel, bodies, planner = self._travel, self._bodies, self._planner
        if not isinstance(travel, TrackTravel):
            return ClosePairs(bodies, planner, travel.bounds)

        def may_meet(i: int, j: int) -> bool:
            a, b = bodies.placed[i], bodies.placed[j]
            return travel.may_meet(a, b, planner.gap_limit(i, j, a.resolution + b.resolution))

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
        return TrackTravel(scene.motions, placed)
    from satcheck.audit.motion.joint_travel import JointTravel

    _require_answers(scene, planner)
    usable = replace(scene, bodies=tuple(body.body for body in placed))
    return JointTravel(usable, scene.joint_path, [ball_around(body) for body in placed])


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
