"""Pushing bodies apart, in rounds: walls where pairs overlap, then the least motion that keeps
them.

The method follows M. Müller et al., "Position based dynamics" (2007), without time and velocities:
each round derives constraints from the current places and satisfies them by a projection. Where we
deviate: every projection starts at home and keeps the walls of earlier rounds, so the result is one
least motion and not the sum of many small ones.

A wall is a half space of translations. The translations that free a concave pair form no half
space, so its walls are valid nearby only. If pushing such a pair does not help, its bodies are
locked together, where they are free. If walls exclude each other, one body goes to a free place and
is no longer pushed.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Collection

from satcheck.audit.bodies.boxes import largest_coordinate
from satcheck.audit.resolve.free_places import FreePlaces
from satcheck.audit.resolve.layout import Layout
from satcheck.audit.resolve.pair_state import PairState, longer
from satcheck.audit.resolve.walls import ORIGIN, BodyPair, Wall, connected, least_motion
from satcheck.audit.vectors import added, dot, scaled, unit
from satcheck.core.conventions import Vector
from satcheck.core.rounding import rounding_pad

# A round pushes all overlaps if there are more than these; else at most one for each body, its
# deepest: shallow overlaps often end with the deep ones.
MANY = 64
# After LOCAL_WALLS pushes a pair that still overlaps is locked; after PATIENCE pushes one of its
# bodies is taken out.
LOCAL_WALLS = 3
PATIENCE = 12
# How often a round may take out a body because walls contradict each other, and how many of the
# contradicting walls name the candidates.
CONFLICTS = 12
CANDIDATES = 2
# An overlap below REMAINDER of the coordinates is rounding, or a wall that is nearly right. Its
# pair is pushed farther, by REPAIR_GROWTH times more each time.
REMAINDER = 1e-5
REPAIR_GROWTH = 4.0

AXES: tuple[Vector, ...] = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))

Progress = Callable[[int, int], None]


class Rounds:
    """left: pairs that were given up, with the reason. count: rounds so far."""

    def __init__(self, layout: Layout, longest: float) -> None:
        self._layout = layout
        self._longest = longest
        self._places = FreePlaces(layout.home)
        self._walls: dict[BodyPair, list[Wall]] = {}
        self._locked: set[BodyPair] = set()
        self._pushes: Counter[BodyPair] = Counter()
        # The bodies that may still be pushed: not those that went to a free place.
        self._pushed = set(layout.movable)
        self.left: dict[BodyPair, str] = {}
        self.count = 0

    def run(self, most: int, progress: Progress | None = None) -> None:
        """Push until only pairs in `left` overlap, at most `most` rounds; then take out the bodies
        that still overlap."""
        started = 0
        while overlaps := self.overlaps():
            started = max(started, len(overlaps))
            if progress is not None:
                progress(started - len(overlaps), started)
            if self.count < most:
                self._push_apart(overlaps if len(overlaps) > MANY else _deepest(overlaps))
                self.count += 1
            else:
                self._take_out(next(iter(overlaps)))

    def overlaps(self) -> dict[BodyPair, PairState]:
        """Pairs with at least one movable body, in a fixed order."""
        layout = self._layout
        states = layout.states(
            [
                pair
                for pair in layout.close_pairs()
                if pair not in self.left and not layout.movable.isdisjoint(pair)
            ]
        )
        unresolved = ("overlap", "near", "open")
        return {pair: state for pair, state in states.items() if state.kind in unresolved}

    def _push_apart(self, overlaps: dict[BodyPair, PairState]) -> None:
        taken: set[int] = set()
        for pair, state in overlaps.items():
            self._pushes[pair] += 1
            if state.push is not None and any(state.push) and self._pushes[pair] <= PATIENCE:
                self._add_wall(pair, state.push)
            elif taken.isdisjoint(pair):
                taken.update(pair)
                self._take_out(pair)
        for _ in range(CONFLICTS):
            conflicts = self._project()
            if not conflicts:
                return
            for walls in conflicts:
                self._settle(walls)
        self._project()

    def _project(self) -> list[list[Wall]]:
        """Move each group of bodies so that it keeps its walls. A group stays if no motion keeps
        them, or only one that is too long: returns the walls to blame of each, worst first."""
        layout, pushed = self._layout, self._pushed
        walls = [
            wall
            for pair in sorted(self._walls)
            for wall in self._walls[pair]
            if not pushed.isdisjoint(pair)
        ]
        offsets = dict.fromkeys(sorted(pushed), ORIGIN)
        conflicts = []
        for group in connected(walls, pushed):
            bodies = {body for wall in group for body in (wall.a, wall.b)}
            solution = least_motion(group, {i: layout.offsets[i] for i in bodies - pushed})
            blamed = solution.broken or self._too_hard(group, solution.offsets)
            if blamed:
                conflicts.append(list(blamed))
                for wall in group:
                    wall.multiplier = 0.0
                for body in solution.offsets:
                    del offsets[body]
            else:
                offsets.update(solution.offsets)
        layout.move(offsets)
        return conflicts

    def _too_hard(self, walls: list[Wall], offsets: dict[int, Vector]) -> list[Wall]:
        """The walls of the body that is pushed the farthest, if that is too far."""
        body = max(offsets, key=lambda i: math.hypot(*offsets[i]))
        if math.hypot(*offsets[body]) <= self._longest:
            return []
        own = [wall for wall in walls if body in (wall.a, wall.b)]
        return sorted(own, key=lambda wall: -wall.multiplier)

    def _settle(self, blamed: list[Wall]) -> None:
        """Resolve a contradiction. If the pair of the first wall has several walls, keep only the
        newest. Else take out one of the bodies."""
        pair = (blamed[0].a, blamed[0].b)
        if len(self._walls[pair]) > 1 and pair not in self._locked:
            self._walls[pair] = self._walls[pair][-1:]
        else:
            worst = blamed[:CANDIDATES]
            self._take_out(dict.fromkeys(body for wall in worst for body in (wall.a, wall.b)), pair)

    def _add_wall(self, pair: BodyPair, push: Vector) -> None:
        """Give the pair a wall, or raise its walls, or lock it."""
        size = largest_coordinate(*(self._layout.placed[i].bounds for i in pair))
        walls, length = self._walls.get(pair, []), math.hypot(*push)
        is_rest = bool(walls) and length < REMAINDER * size
        more = 0.0
        if is_rest:
            more = (length + rounding_pad(size)) * REPAIR_GROWTH ** self._pushes[pair]
        there = added(self._layout.offset(pair), longer(push, more))
        if pair in self._locked or (not is_rest and self._pushes[pair] > LOCAL_WALLS):
            self._locked.add(pair)
            self._walls[pair] = [
                Wall(*pair, scaled(axis, side), side * dot(axis, there))
                for axis in AXES
                for side in (1.0, -1.0)
            ]
        elif is_rest:
            for wall in walls:
                wall.least += more
        else:
            normal = unit(push)
            kept = [wall for wall in walls if wall.slack(there) >= -REMAINDER * size]
            self._walls[pair] = [*kept, Wall(*pair, normal, dot(normal, there))]

    def _take_out(self, bodies: Collection[int], pair: BodyPair | None = None) -> None:
        """Move one of these bodies to a free place: the body with the shortest way. It is no longer
        pushed. If no body has a free place, give up the pair."""
        ways = [(way, i) for i in bodies if (way := self._free_place(i)) is not None]
        if not ways:
            a, b = pair or bodies
            self.left[a, b] = "no free place was found within the longest motion allowed"
            self._walls.pop((a, b), None)
            return
        way, i = min(ways, key=lambda candidate: math.hypot(*candidate[0]))
        self._layout.move({i: way})
        self._pushed.discard(i)
        self._walls = {pair: walls for pair, walls in self._walls.items() if i not in pair}

    def _free_place(self, i: int) -> Vector | None:
        layout = self._layout
        if i not in layout.movable:
            return None
        others = [j for j in range(len(layout.home)) if j != i and layout.is_checked((i, j))]
        gaps = [layout.clearance((i, j)) for j in others]
        return self._places.free(i, others, layout.offsets, gaps, self._longest)


def _deepest(overlaps: dict[BodyPair, PairState]) -> dict[BodyPair, PairState]:
    """Chooses overlaps from the deepest on, at most one for each body."""
    chosen: dict[BodyPair, PairState] = {}
    taken: set[int] = set()
    for pair in sorted(overlaps, key=lambda pair: -math.hypot(*(overlaps[pair].push or ()))):
        if taken.isdisjoint(pair):
            chosen[pair] = overlaps[pair]
            taken.update(pair)
    return chosen
