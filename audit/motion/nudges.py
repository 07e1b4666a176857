"""Contact of bodies that are not both convex: a translation of A, shorter than the touch band,
after which they stay apart for a while. They then overlap by no more than its length meanwhile,
for moving A by it ends the overlap: that is what depth means.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

from satcheck.audit.cheap_bounds import way_out_of_hulls
from satcheck.audit.motion.limits import SHORTEST_STEP
from satcheck.audit.motion.moving_pair import MovingPair
from satcheck.audit.motion.turn import applied
from satcheck.audit.pair import Pair
from satcheck.audit.report import Vector
from satcheck.audit.triangles import triangle_normal
from satcheck.audit.vectors import added, scaled
from satcheck.audit.verify import FREE, relation_after

# A part in a corner has to leave three walls.
WALLS = 3
# Of the touch band: a nudge that leaves room for rounding, and a shorter one, which what stands on
# the other side is less likely to be in the way of.
SHARES = (0.9, 0.3)
ORIGIN: Vector = (0.0, 0.0, 0.0)


class Nudges:
    """Keeps the nudge that served last: a contact goes on as it was, as a rule."""

    def __init__(self, pair: MovingPair) -> None:
        self._pair = pair
        self._last: Vector | None = None
        self._proven_until = -1.0

    def safe_time(self, t: float, end: float) -> float:
        """For how long after t the bodies, nudged, have no common point; 0.0: no nudge helps."""
        if self._last is not None:
            on = self._pair.apart(t, end, self._last).time
            seamless = self._proven_until >= t
            if _is_step(on, t, end) and (seamless or self._frees(self._pair.placed(t), self._last)):
                return self._keep(self._last, t, on)
        placed = self._pair.placed(t)
        for nudge in self._candidates(t, end, placed):
            on = self._pair.apart(t, end, nudge).time
            if _is_step(on, t, end) and self._frees(placed, nudge):
                return self._keep(nudge, t, on)
        self._last = None
        return 0.0

    def _keep(self, nudge: Vector, t: float, on: float) -> float:
        self._last, self._proven_until = nudge, t + on
        return on

    @staticmethod
    def _frees(placed: Pair, nudge: Vector) -> bool:
        return relation_after(placed, nudge) in FREE

    def _candidates(self, t: float, end: float, placed: Pair) -> Iterator[Vector]:
        hulls = way_out_of_hulls(placed)
        for share in SHARES:
            length = share * self._pair.tolerance
            if hulls.upper < length:
                yield scaled(hulls.normal, -length)
            yield self._off_the_walls(t, end, length, leave_b=True)
            yield self._off_the_walls(t, end, length, leave_b=False)

    def _off_the_walls(self, t: float, end: float, length: float, *, leave_b: bool) -> Vector:
        """Off the triangles of B that stop A one after the other (or A's, off B), equal shares."""
        nudge = ORIGIN
        for _ in range(WALLS):
            obstacle = self._pair.apart(t, end, nudge)
            if obstacle.triangles is None or _is_step(obstacle.time, t, end):
                break
            normal = self._normal(t, obstacle.triangles, leave_b=leave_b)
            if normal is None:
                break
            nudge = added(nudge, scaled(normal, length / WALLS))
        return nudge

    def _normal(self, t: float, triangles: tuple[int, int], *, leave_b: bool) -> Vector | None:
        body, track = (
            (self._pair.pair.b, self._pair.track_b)
            if leave_b
            else (self._pair.pair.a, self._pair.track_a)
        )
        normal = triangle_normal(body, triangles[1] if leave_b else triangles[0])
        if normal is None:
            return None
        turned = applied(track.pose_at(t)[0], normal)
        return scaled(turned, (1.0 if leave_b else -1.0) / math.hypot(*turned))


def _is_step(step: float, t: float, end: float) -> bool:
    return step >= SHORTEST_STEP or t + step >= end
