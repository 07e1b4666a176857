"""The bodies of robots whose joints move along a path, and the sweep of each pair."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial

from msgspec.structs import replace

from satcheck.audit.bodies import PlacedBodies
from satcheck.audit.body import Box, around_both
from satcheck.audit.close_pairs import ClosePairs
from satcheck.audit.motion.impact import Impact
from satcheck.audit.motion.joint_travel import Travel
from satcheck.audit.motion.moving_pair import MovingPair, Unanswerable, holed
from satcheck.audit.motion.open_stretches import OpenStretches, open_stretches
from satcheck.audit.motion.sweep import Posed, swept, swept_along
from satcheck.audit.pair import Moves, Pair
from satcheck.audit.planner import Planner
from satcheck.audit.posed_pairs import PosedPairs
from satcheck.audit.settings import Settings
from satcheck.core.errors import SatcheckError
from satcheck.report.motions import JointPath as StatedPath
from satcheck.report.motions import JointWaypoint, StatedMotion
from satcheck.report.report import Issue
from satcheck.report.sweep import Place, Sweep
from satcheck.scene import Scene
from satcheck.scene.half_spaces import holds
from satcheck.scene.robot import JointPath

# Travels, as shares of the smaller body, at which an interval is left to a sweep, and for bodies
# with holes, whose fills a sweep does not see.
NEAR = 1 / 256
NEAREST = 2.0**-20


class JointMovers:
    """Raises SatcheckError (`bad-pose`) for a scene that cannot be checked along a path."""

    def __init__(
        self, scene: Scene, path: JointPath, bodies: PlacedBodies, planner: Planner
    ) -> None:
        _require_answers(scene, planner.settings)
        usable = {bodies.ids[k] for k in bodies.placed}
        scene = replace(scene, bodies=tuple(body for body in scene.bodies if body.id in usable))
        self._path = path
        self._ids = [body.id for body in scene.bodies]
        self._place = {id_: k for k, id_ in enumerate(self._ids)}
        self._pairs = PosedPairs(scene, bodies, planner)
        self._travel = Travel(scene, path, self._pairs.around())
        self._moving = self._travel.moving()
        self._sweeps: dict[tuple[str, str], Callable[[Pair], Sweep]] = {}

    def close(self, bodies: PlacedBodies, planner: Planner) -> ClosePairs:
        """The pairs whose boxes over the whole path are close. `moves` has those that move."""
        close, ids, place = ClosePairs(bodies, planner, self._bounds), bodies.ids, self._place
        moves = self._travel.moves
        self._pairs.choose((i, j) for i, j in close if moves(place[ids[i]], place[ids[j]]))
        placed = [self._pairs.as_placed(k) for k in range(len(self._pairs.pairs))]
        near = [
            (NEAREST if holed(pair) else NEAR) * min(pair.a.diagonal, pair.b.diagonal)
            for pair in placed
        ]
        found = open_stretches(self._travel, self._pairs, [p.tolerance for p in placed], near)
        for pair, stretches in zip(self._pairs.pairs, found, strict=True):
            self._sweeps[pair.ids] = partial(self._sweep, pair.places, stretches)
        return close

    def _bounds(self, body: str, placed: Box) -> Box:
        return around_both(placed, self._travel.boxes.get(body, placed))

    def moves(self, a: str, b: str) -> Moves | None:
        """None: the bodies do not move relative to each other."""
        sweep = self._sweeps.get((a, b))
        return None if sweep is None else Moves(sweep)

    def stated(self) -> tuple[StatedMotion, ...]:
        """The path as a report states it."""
        if not self._moving:
            return ()
        waypoints = (JointWaypoint(float(t), self._path.pose(t)) for t in self._path.times)
        return (StatedPath(tuple(self._moving), False, tuple(waypoints)),)

    def issues(self, _: Sequence[str]) -> list[Issue]:
        return []

    def _sweep(self, places: tuple[int, int], found: OpenStretches, pair: Pair) -> Sweep:
        """The sweep of a pair through the stretches of the path in which it may meet."""
        gap = max(pair.tolerance, pair.request.clearance or 0.0)
        if not found.stretches:
            free = Impact(1.0, None, 1.0, gap=gap)
            return swept(free, pair.tolerance, found.steps, "separated", distance_at_least=gap)
        try:
            self._require_reach(pair)
            moving = MovingPair(pair, *self._travel.ways(*places), found.stretches, gap)
        except Unanswerable as why:
            return swept(Impact(0.0, None, 0.0, reason=str(why)), pair.tolerance, found.steps)
        moving.steps = found.steps
        return swept_along(moving, partial(self._posed, places))

    def _require_reach(self, pair: Pair) -> None:
        for floor, other in ((pair.a, pair.b), (pair.b, pair.a)):
            if floor.endless and not holds(floor.body, self._bounds(other.id, other.bounds)):
                raise Unanswerable(f"{other.id} moves beyond the reach of the half space")

    def _posed(self, places: tuple[int, int], t: float) -> Posed:
        mover = next(self._ids[k] for k in places if self._ids[k] in self._moving)
        return Posed((Place(mover, "t", t),), self._path.pose(t), self._path.poses_around(t))


def _require_answers(scene: Scene, settings: Settings) -> None:
    refused = {
        "--planar": settings.planar is not None,
        f"--accuracy {settings.accuracy}": settings.accuracy != "exact",
        "rules about single bodies": bool(scene.body_rules),
        "motions of a scene": bool(scene.motions),
    }
    for what in (what for what, given in refused.items() if given):
        raise SatcheckError("bad-pose", f"a path of joints cannot be checked with {what}")
