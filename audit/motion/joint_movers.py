"""The bodies of robots whose joints move along a path, and the sweep of each pair."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

import numpy as np
from msgspec.structs import replace

from satcheck.audit.bodies import PlacedBodies
from satcheck.audit.body import Box, around_both
from satcheck.audit.close_pairs import ClosePairs
from satcheck.audit.motion.joint_search import Search, SweptPair
from satcheck.audit.motion.joint_travel import Interval, Travel
from satcheck.audit.motion.sweep import relation_apart, swept, worst_pose
from satcheck.audit.pair import Moves
from satcheck.audit.planner import Planner
from satcheck.audit.posed_pairs import PosedPairs
from satcheck.audit.settings import Settings
from satcheck.core.errors import SatcheckError
from satcheck.report.motions import JointPath as StatedPath
from satcheck.report.motions import JointWaypoint, StatedMotion
from satcheck.report.report import Issue
from satcheck.report.sweep import Place, Sweep
from satcheck.scene import Scene
from satcheck.scene.robot import JointPath
from satcheck.scene.robot.kinematics import Numbers

# Parts of each piece of the path that get a box of their own for the broad phase.
PARTS = 8


class JointMovers:
    """Raises SatcheckError (`bad-pose`) for a scene that cannot be checked along a path."""

    def __init__(
        self, scene: Scene, path: JointPath, bodies: PlacedBodies, planner: Planner
    ) -> None:
        _require_answers(scene, planner.settings)
        usable = {bodies.ids[k] for k in bodies.placed}
        scene = replace(scene, bodies=tuple(body for body in scene.bodies if body.id in usable))
        self._path = path
        self._pairs = PosedPairs(scene, bodies, planner)
        self._travel = Travel(scene, path, self._pairs.around())
        self._search = Search(path, self._travel, self._pairs)
        self._moving = self._travel.moving()
        self._boxes = self._swept_boxes(scene)
        self._sweeps: dict[tuple[str, str], Sweep] = {}

    def close(self, bodies: PlacedBodies, planner: Planner) -> ClosePairs:
        """The pairs whose boxes over the whole path are close, swept; `moves` has the results."""
        close = ClosePairs(bodies, planner, self._bounds)
        wanted = {(bodies.ids[i], bodies.ids[j]) for i, j in close}
        pairs = self._pairs.pairs
        moves = np.array([p.ids in wanted and self._travel.moves(*p.places) for p in pairs], bool)
        found = self._search.first_overlaps(moves)
        clearances = np.array([bool(pair.request.clearance) for pair in pairs], bool)
        near = moves & clearances & np.array([pair.impact.free for pair in found], bool)
        if near.any():
            self._search.narrow(near, found)
        for k in np.flatnonzero(moves).tolist():
            self._sweeps[pairs[k].ids] = self._swept(k, found[k])
        return close

    def _bounds(self, body: str, placed: Box) -> Box:
        return around_both(placed, self._boxes.get(body, placed))

    def moves(self, a: str, b: str) -> Moves | None:
        """None: the bodies do not move relative to each other."""
        sweep = self._sweeps.get((a, b))
        return None if sweep is None else Moves(lambda _: sweep)

    def stated(self) -> tuple[StatedMotion, ...]:
        """The path as a report states it."""
        if not self._moving:
            return ()
        waypoints = (JointWaypoint(float(t), self._path.pose(t)) for t in self._path.times)
        return (StatedPath(tuple(self._moving), False, tuple(waypoints)),)

    def issues(self, _: Sequence[str]) -> list[Issue]:
        return []

    def _swept(self, k: int, pair: SweptPair) -> Sweep:
        impact, nearest = pair.impact, pair.nearest
        if impact.upper is not None:
            return swept(
                impact,
                pair.tolerance,
                pair.steps,
                "penetrating",
                at=self._places(k, impact.upper),
                point=self._search.impact_point(k, impact.lower, impact.upper),
                joints=self._path.pose(impact.upper),
                poses=self._path.poses_around(impact.upper),
            )
        if impact.reason is not None:
            return swept(impact, pair.tolerance, pair.steps)
        clearance = self._pairs.pairs[k].request.clearance or 0.0
        worst = nearest if nearest is not None and nearest.upper < clearance else None
        joints = None if worst is None else self._path.pose(worst.time)
        return swept(
            impact,
            pair.tolerance,
            pair.steps,
            relation_apart(impact, worst, pair.tolerance, clearance),
            worst=worst_pose(worst, partial(self._places, k), joints),
            distance_at_least=None if nearest is None or worst is not None else nearest.lower,
        )

    def _places(self, k: int, time: float) -> tuple[Place, ...]:
        mover = next(id_ for id_ in self._pairs.pairs[k].ids if id_ in self._moving)
        return (Place(mover, "t", time),)

    def _swept_boxes(self, scene: Scene) -> dict[str, Box]:
        at = self._travel.middle(_parts(self._path.times))
        boxes: dict[str, Box] = {}
        for number, body in enumerate(scene.bodies):
            if body.id in self._moving:
                low, high = self._travel.in_world(at, number)
                boxes[body.id] = (tuple(low.tolist()), tuple(high.tolist()))
        return boxes


def _require_answers(scene: Scene, settings: Settings) -> None:
    refused = {
        "--planar": settings.planar is not None,
        f"--accuracy {settings.accuracy}": settings.accuracy != "exact",
        "rules about single bodies": bool(scene.body_rules),
        "motions of a scene": bool(scene.motions),
    }
    for what in (what for what, given in refused.items() if given):
        raise SatcheckError("bad-pose", f"a path of joints cannot be checked with {what}")


def _parts(times: Numbers) -> Interval:
    shares = np.linspace(0.0, 1.0, PARTS + 1)
    start, end = times[:-1, None], times[1:, None]
    grid = start + (end - start) * shares
    grid[:, -1] = times[1:]
    return Interval(grid[:, :-1].ravel(), grid[:, 1:].ravel())
