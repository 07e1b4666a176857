"""Pushing bodies apart, in rounds: walls where pairs overlap, then the least motion that keeps
them.

The method follows M. Müller et al., "Position based dynamics" (2007), without time and velocities:
each round derives constraints from the current places and satisfies them by a projection. Where we
deviate: every projection starts at home and keeps the walls of earlier rounds, so the result is one
least motion and not the sum of many small ones.

A wall is a half space of translations. The translations that free a pair usually form no half
space, so walls may contradict each other. If two walls of one pair do, a wall between the hulls
replaces both, or the bodies are locked together. If walls of several pairs do, one body is moved to
a free place and gets new walls there.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Sequence

from satcheck.audit.bodies.boxes import largest_coordinate
from satcheck.audit.bodies.pair import Pair
from satcheck.audit.figures.escape import FREE, relation_after
from satcheck.audit.resolve.free_places import FreePlaces
from satcheck.audit.resolve.layout import Layout
from satcheck.audit.resolve.pair_state import PairState, longer, out_of_hull
from satcheck.audit.resolve.pull_back import swept, walled
from satcheck.audit.resolve.walls import ORIGIN, BodyPair, Wall, connected, least_motion
from satcheck.audit.vectors import added, dot, scaled, unit
from satcheck.core.conventions import Vector
from satcheck.core.rounding import rounding_pad

# After LOCAL_WALLS rounds with an overlap, one wall between the hulls replaces all walls of a pair,
# unless the way out of the hulls is MUCH_LONGER. After PATIENCE rounds one body is taken out.
LOCAL_WALLS = 3
MUCH_LONGER = 2.0
PATIENCE = 8
# How often a round may take out a body because walls contradict each other, and how many of the
# contradicting walls name the candidates.
CONFLICTS = 12
CANDIDATES = 2
# An overlap below REPAIR_SHARE of the coordinates is a remainder: rounding, or a wall that is
# nearly right. Each repair of the same pair raises its walls REPAIR_GROWTH times more, at most
# REPAIRS times.
REPAIR_SHARE = 1e-5
REPAIR_GROWTH = 4.0
REPAIRS = 16
# A wall that is missed by less than ROUNDING_SHARE of the coordinates counts as kept. It is raised
# in ROUNDING_STEPS steps, each REPAIR_GROWTH times the last.
ROUNDING_SHARE = 1e-9
ROUNDING_STEPS = 8

AXES: tuple[Vector, ...] = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))

Progress = Callable[[int, int], None]


class Rounds:
    """deepest_first: each round makes at most one wall for a body, for its deepest overlap; shallow
    overlaps often end with the deep ones. left: pairs that were given up, with the reason. count:
    rounds so far.
    """

    def __init__(self, layout: Layout, longest: float, *, deepest_first: bool = False) -> None:
        self._layout = layout
        self._longest = longest
        self._deepest_first = deepest_first
        self._places = FreePlaces(layout.home)
        self._walls: dict[BodyPair, list[Wall]] = {}
        self._locked: set[BodyPair] = set()
        self._seen: Counter[BodyPair] = Counter()
        self._repairs: Counter[BodyPair] = Counter()
        self.left: dict[BodyPair, str] = {}
        self.count = 0

    @property
    def walls(self) -> list[Wall]:
        return [wall for pair in sorted(self._walls) for wall in self._walls[pair]]

    def run(self, most: int, progress: Progress | None = None) -> None:
        """Push until only pairs in `left` overlap, at most `most` rounds; then take out the bodies
        that still overlap."""
        started = 0
        while overlaps := self.overlaps():
            started = max(started, len(overlaps))
            if progress is not None:
                progress(started - len(overlaps), started)
            if self.count == most:
                self._take_out_all()
                return
            self._push_apart(_deepest(overlaps) if self._deepest_first else overlaps)
            self.count += 1

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
        stuck = [pair for pair, state in overlaps.items() if not self._add_wall(pair, state)]
        done: set[int] = set()
        for pair in stuck:
            if done.isdisjoint(pair):
                taken = self._take_out(pair)
                done.update(taken)
                if not taken:
                    self._give_up(pair)
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
        layout = self._layout
        offsets = dict.fromkeys(sorted(layout.movable), ORIGIN)
        conflicts = []
        for group in connected(self.walls, layout.movable):
            bodies = {body for wall in group for body in (wall.a, wall.b)}
            held = {body: layout.offsets[body] for body in bodies - layout.movable}
            solution = least_motion(group, held)
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
        newest. Else take out one of the bodies; if no place is free, give up the pair."""
        pair = (blamed[0].a, blamed[0].b)
        if len(self._walls[pair]) > 1 and pair not in self._locked:
            self._walls[pair] = self._walls[pair][-1:]
            return
        worst = blamed[:CANDIDATES]
        bodies = dict.fromkeys(body for wall in worst for body in (wall.a, wall.b))
        if not self._take_out(tuple(bodies)):
            self._give_up(pair)

    def _add_wall(self, pair: BodyPair, state: PairState) -> bool:
        """Give the pair a wall, or raise its walls; False: stop trying walls for this pair.

        A wall between concave bodies is valid nearby only. A remainder of an overlap raises the
        walls of the pair. If walls contradict each other, or become too many, a wall between the
        hulls, which is valid everywhere, replaces them, or the bodies are locked together."""
        push, size = state.push, self._size(pair)
        if push is None or not any(push):
            return False
        walls, length = self._walls.get(pair, []), math.hypot(*push)
        if pair not in self._locked and self._raised(pair, walls):
            return True
        if walls and length < REPAIR_SHARE * size:
            more = (length + rounding_pad(size)) * REPAIR_GROWTH ** self._repairs[pair]
            self._repairs[pair] += 1
            if pair in self._locked:
                self._lock(pair, longer(push, more))
            for wall in walls if pair not in self._locked else ():
                wall.least += more
            return self._repairs[pair] <= REPAIRS
        self._seen[pair] += 1
        opposed = any(dot(wall.normal, push) < 0 for wall in walls)
        if pair in self._locked:
            self._lock(pair, push)
        elif opposed or self._seen[pair] > LOCAL_WALLS:
            hull = out_of_hull(self._layout.pair(pair))
            if math.hypot(*hull) <= MUCH_LONGER * max([length, *(wall.least for wall in walls)]):
                self._walls[pair] = [self._wall(pair, hull)]
            else:
                self._lock(pair, push)
        else:
            there = added(self._layout.offset(pair), push)
            kept = [wall for wall in walls if wall.slack(there) >= -ROUNDING_SHARE * size]
            self._walls[pair] = [*kept, self._wall(pair, push)]
        return self._seen[pair] <= PATIENCE

    def _raised(self, pair: BodyPair, walls: Sequence[Wall]) -> bool:
        """Raise one wall by very little if that frees the pair; whether it did. The pair then keeps
        all its walls, and only rounding made it overlap."""
        layout, there, size = (
            self._layout,
            self._layout.offset(pair),
            self._size(pair),
        )
        placed = layout.pair(pair)
        if placed.request.limited or placed.request.clearance or self._repairs[pair] > REPAIRS:
            return False
        if any(wall.slack(there) < -ROUNDING_SHARE * size for wall in walls):
            return False
        steps = [rounding_pad(size) * REPAIR_GROWTH**k for k in range(ROUNDING_STEPS)]
        for wall in reversed(walls):
            if _is_free_after(placed, wall.normal, steps[-1]):
                least = next(s for s in steps if _is_free_after(placed, wall.normal, s))
                wall.least += least * REPAIR_GROWTH ** self._repairs[pair]
                self._repairs[pair] += 1
                return True
        return False

    def _wall(self, pair: BodyPair, push: Vector) -> Wall:
        normal = unit(push)
        return Wall(*pair, normal, dot(normal, added(self._layout.offset(pair), push)))

    def _lock(self, pair: BodyPair, push: Vector) -> None:
        """Keep the bodies just where the push puts one from the other."""
        there = added(self._layout.offset(pair), push)
        self._locked.add(pair)
        self._walls[pair] = [
            Wall(*pair, scaled(axis, side), side * dot(axis, there))
            for axis in AXES
            for side in (1.0, -1.0)
        ]

    def _size(self, pair: BodyPair) -> float:
        return largest_coordinate(*(self._layout.placed[i].bounds for i in pair))

    def _take_out(self, bodies: Sequence[int]) -> tuple[int, ...]:
        """Move one of these bodies to a free place: the body with the shortest way. Returns it, or
        an empty tuple if no body has a free place."""
        ways = [(way, i) for i in bodies if (way := self._free_place(i)) is not None]
        if not ways:
            return ()
        way, i = min(ways, key=lambda candidate: math.hypot(*candidate[0]))
        self.put(i, way)
        return (i,)

    def put(self, i: int, way: Vector) -> None:
        """Move the body there, and keep it from all that is on its way home."""
        self._layout.move({i: way})
        self._wall_in(i)

    def _give_up(self, pair: BodyPair) -> None:
        self.left[pair] = "no free place was found within the longest motion allowed"
        self._walls.pop(pair, None)

    def _free_place(self, i: int) -> Vector | None:
        layout = self._layout
        if i not in layout.movable:
            return None
        others = [j for j in range(len(layout.home)) if j != i and layout.is_checked((i, j))]
        gaps = [layout.clearance((i, j)) for j in others]
        return self._places.free(i, others, layout.offsets, gaps, self._longest)

    def _wall_in(self, i: int) -> None:
        """Make the walls of a body anew, from where it is, to all that is on its way home."""
        layout = self._layout
        self._walls = {pair: walls for pair, walls in self._walls.items() if i not in pair}
        self._locked = {pair for pair in self._locked if i not in pair}
        way = swept(layout.home[i].bounds, layout.placed[i].bounds)
        boxes = [way if j == i else other.bounds for j, other in enumerate(layout.placed)]
        for pair in layout.close_pairs(boxes):
            if i in pair:
                self._seen[pair] = self._repairs[pair] = 0
                wall = walled(layout, pair)
                if wall is not None:
                    self._walls[pair] = [wall]

    def _take_out_all(self) -> None:
        """Without another push: a body that still overlaps goes to a place that is free of all
        others, wherever these are now, so that the number of overlaps only falls."""
        taken: set[int] = set()
        while overlaps := self.overlaps():
            pair = next(iter(overlaps))
            out = self._take_out([i for i in pair if i not in taken])
            taken.update(out)
            if not out:
                self._give_up(pair)


def _is_free_after(pair: Pair, normal: Vector, length: float) -> bool:
    return relation_after(pair, scaled(normal, length)) in FREE


def _deepest(overlaps: dict[BodyPair, PairState]) -> dict[BodyPair, PairState]:
    """Chooses overlaps from the deepest on, at most one for each body."""
    chosen: dict[BodyPair, PairState] = {}
    taken: set[int] = set()
    for pair in sorted(overlaps, key=lambda pair: -math.hypot(*(overlaps[pair].push or ()))):
        if taken.isdisjoint(pair):
            chosen[pair] = overlaps[pair]
            taken.update(pair)
    return chosen
