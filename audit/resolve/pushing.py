"""Push bodies apart: overlapping pairs along their verified ways out, the deepest first, until
none is left.

After M. Müller et al., "Position based dynamics" (2007), without time and velocities. Two bodies
share a push, unless one had to make way for a body that stays, directly or through others: it gives
way no more, as in the shock propagation of E. Guendelman et al., "Nonconvex Rigid Bodies with
Stacking" (2003). If pushing does not help, one body goes to a free place.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable

import numpy as np

from satcheck.audit.body import largest_coordinate
from satcheck.audit.resolve.free_place import AXES, extents, free_place
from satcheck.audit.resolve.layout import BodyPair, Layout
from satcheck.audit.resolve.pair_state import longer
from satcheck.audit.vectors import added, dot, scaled
from satcheck.core.conventions import Vector
from satcheck.core.rounding import rounding_pad

# A round pushes all overlaps if there are more than these; else at most one for each body, its
# deepest: shallow overlaps often end with the deep ones.
MANY = 64
# After HOLD pushes one body of a pair is held while the other makes way; after PATIENCE pushes one
# goes to a free place.
HOLD, PATIENCE = 3, 12
# Rounding may leave a rest of an overlap. Each push of a pair goes beyond it, by this factor more.
REPAIR_GROWTH = 4.0

Progress = Callable[[int, int], None]


class Pushing:
    """left: pairs that were given up, with the reason. rounds: so far."""

    def __init__(self, layout: Layout, longest: float) -> None:
        self._layout = layout
        self._longest = longest
        self._extents = np.stack([extents(body) for body in layout.home])
        self._pushes: Counter[BodyPair] = Counter()
        # 0: the body stays. k: it made way for a body of rank k - 1. inf: it is free to share.
        self._ranks = [math.inf if i in layout.movable else 0.0 for i in range(len(layout.home))]
        self.left: dict[BodyPair, str] = {}
        self.rounds = 0

    def run(self, most: int, progress: Progress | None = None) -> None:
        """Push until only pairs in `left` overlap, at most `most` rounds. Then move bodies that
        still overlap to free places."""
        started = 0
        while overlaps := self._overlaps():
            started = max(started, len(overlaps))
            if progress is not None:
                progress(started - len(overlaps), started)
            if self.rounds < most:
                self._push_all(overlaps)
                self.rounds += 1
            else:
                self._take_out(next(iter(overlaps)))

    def _overlaps(self) -> dict[BodyPair, Vector]:
        """The pushes of unresolved pairs with a movable body, the longest first."""
        layout = self._layout
        close = [
            pair
            for pair in layout.close_pairs()
            if pair not in self.left and not layout.movable.isdisjoint(pair)
        ]
        states = layout.states(close).items()
        pushes = {
            pair: state.push or (0.0, 0.0, 0.0) for pair, state in states if state.is_unresolved
        }
        return dict(sorted(pushes.items(), key=lambda entry: -math.hypot(*entry[1])))

    def _push_all(self, overlaps: dict[BodyPair, Vector]) -> None:
        goals = {
            pair: added(self._layout.offset(pair), self._farther(pair, push))
            for pair, push in overlaps.items()
        }
        taken: set[int] = set()
        stuck = []
        for pair, push in overlaps.items():
            if len(overlaps) <= MANY and not taken.isdisjoint(pair):
                continue
            taken.update(pair)
            self._pushes[pair] += 1
            hopeless = not any(push) or self._pushes[pair] > PATIENCE
            if hopeless or not self._push(pair, goals[pair], push):
                stuck.append(pair)
        taken.clear()
        for pair in stuck:
            if taken.isdisjoint(pair):
                taken.update(pair)
                self._take_out(pair)

    def _farther(self, pair: BodyPair, push: Vector) -> Vector:
        if not self._pushes[pair] or not any(push):
            return push
        pad = rounding_pad(largest_coordinate(*(self._layout.placed[i].bounds for i in pair)))
        return longer(push, pad * REPAIR_GROWTH ** self._pushes[pair])

    def _push(self, pair: BodyPair, goal: Vector, push: Vector) -> bool:
        """Push the pair as far as other pushes of the round have not. Return False where neither
        body may go so far."""
        layout, ranks, (a, b) = self._layout, self._ranks, pair
        rest = added(goal, scaled(layout.offset(pair), -1.0))
        along = dot(push, rest)
        if along <= 0.0:
            return True
        rest = scaled(push, along / dot(push, push))
        if ranks[a] == ranks[b] and self._pushes[pair] > HOLD:
            held, other = sorted(pair, key=lambda i: math.hypot(*layout.offsets[i]))
            ranks[held] = min(ranks[held], 1.0)
            ranks[other] = ranks[held] + 1.0
        usual = 0.5 if ranks[a] == ranks[b] else float(ranks[a] > ranks[b])
        for share in (usual, 1.0, 0.0):
            shares = {i: part for i, part in ((a, share), (b, share - 1.0)) if part}
            ways = {i: added(layout.offsets[i], scaled(rest, part)) for i, part in shares.items()}
            if all(ranks[i] and math.hypot(*way) <= self._longest for i, way in ways.items()):
                for i, j in ((a, b), (b, a)):
                    if j not in ways:
                        ranks[i] = min(ranks[i], ranks[j] + 1.0)
                layout.move(ways)
                return True
        return False

    def _take_out(self, pair: BodyPair) -> None:
        """Move the body with the shorter way to a free place, where it stays. If none has a free
        place, give up the pair."""
        ways = [(way, i) for i in pair if (way := self._free_place(i)) is not None]
        if not ways:
            self.left[pair] = "no free place was found within the longest motion allowed"
            return
        way, i = min(ways, key=lambda candidate: math.hypot(*candidate[0]))
        self._layout.move({i: way})
        self._ranks[i] = 0.0

    def _free_place(self, i: int) -> Vector | None:
        layout = self._layout
        if i not in layout.movable:
            return None
        others = [j for j in range(len(layout.home)) if j != i and layout.is_checked((i, j))]
        shifts = np.array([layout.offsets[j] for j in others]) @ AXES.T
        gaps = np.array([layout.clearance((i, j)) for j in others])
        there = self._extents[others] + shifts[:, None]
        return free_place(self._extents[i], there, gaps, self._longest)
