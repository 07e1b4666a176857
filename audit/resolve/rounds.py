"""Pushing bodies apart: walls where pairs overlap, the shortest translations that keep them, again.

The frame is that of M. Müller et al., "Position based dynamics" (2007), without time and without
velocities: constraints are found where the bodies are, satisfied by projections, and found again.
Unlike there every projection starts at home and keeps the walls of earlier rounds, so that what
comes out is a least motion and not the sum of many small ones.

A wall is a half space of translations. The pair of bodies behind it is not convex as a rule, so a
wall may be in the way: of another wall, or of a body that stays. Then one body of the pair is taken
out to a free slot, its walls are made anew there, and the rounds go on.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Iterable

from satcheck.audit.boxes import largest_coordinate
from satcheck.audit.report import Vector
from satcheck.audit.resolve.crowd import ORIGIN, Crowd, Opinion
from satcheck.audit.resolve.free_slot import free_slot
from satcheck.audit.resolve.hildreth import project
from satcheck.audit.resolve.islands import islands
from satcheck.audit.resolve.pull_back import swept, walled
from satcheck.audit.resolve.wall import BodyPair, Wall
from satcheck.audit.tolerances import LENGTHENING_ULPS, UNIT_ROUNDOFF
from satcheck.audit.vectors import added, dot, scaled

# After so many rounds in which a pair overlaps, one of its bodies is taken out.
PATIENCE = 6
# Walls of one pair whose normals are this close are one wall, moved.
SAME_NORMAL = 1 - 1e-9
# An overlap below this share of the coordinates comes from rounding.
ROUNDING_SHARE = 1e-9

Progress = Callable[[int, int], None]


class Rounds:
    """left: pairs that are not to be resolved any more, with the reason. count: rounds so far."""

    def __init__(self, crowd: Crowd, longest: float) -> None:
        self._crowd = crowd
        self._longest = longest
        self._walls: dict[BodyPair, list[Wall]] = {}
        self._seen: Counter[BodyPair] = Counter()
        self._repairs: Counter[BodyPair] = Counter()
        self.left: dict[BodyPair, str] = {}
        self.count = 0

    @property
    def walls(self) -> list[Wall]:
        return [wall for pair in sorted(self._walls) for wall in self._walls[pair]]

    def run(self, most: int, progress: Progress | None = None) -> bool:
        """Whether nothing is left to push apart, after `most` rounds of pushing at most and, where
        these do not suffice, taking out what still overlaps."""
        started = 0
        for self.count in range(most):
            overlaps = self.overlaps()
            started = max(started, len(overlaps))
            if progress is not None:
                progress(started - len(overlaps), started)
            if not overlaps:
                return True
            self._push_apart(overlaps)
        return self._take_out_all()

    def overlaps(self) -> dict[BodyPair, Opinion]:
        """Pairs of which one body at least can be moved, in a fixed order."""
        crowd = self._crowd
        found = crowd.opinions(
            [
                pair
                for pair in crowd.close_pairs()
                if pair not in self.left and not crowd.movable.isdisjoint(pair)
            ]
        )
        return {pair: said for pair, said in found.items() if said.kind in ("overlap", "near")}

    def _push_apart(self, overlaps: dict[BodyPair, Opinion]) -> None:
        stuck = [pair for pair, opinion in overlaps.items() if not self._add_wall(pair, opinion)]
        self._take_out_one_each(stuck)
        self._project(range(3))

    def _project(self, attempts: Iterable[int]) -> None:
        """Move the bodies; walls that exclude each other cost a body its place."""
        for _ in attempts:
            offsets, broken = self._solution()
            self._crowd.move(offsets)
            if not broken:
                return
            self._take_out_one_each(broken)

    def _solution(self) -> tuple[dict[int, Vector], list[BodyPair]]:
        offsets = dict.fromkeys(sorted(self._crowd.movable), ORIGIN)
        broken = []
        for island in islands(self.walls, self._crowd.movable):
            held = {
                body: ORIGIN
                for wall in island
                for body in (wall.a, wall.b)
                if body not in self._crowd.movable
            }
            found = project(island, held)
            offsets.update(found.offsets)
            too_far = [i for i, t in found.offsets.items() if math.hypot(*t) > self._longest]
            if found.broken:
                broken.append((found.broken[0].a, found.broken[0].b))
            elif too_far:
                longest = max(too_far, key=lambda i: math.hypot(*found.offsets[i]))
                walls = [wall for wall in island if longest in (wall.a, wall.b)]
                worst = max(walls, key=lambda wall: wall.multiplier)
                broken.append((worst.a, worst.b))
        return offsets, broken

    def _add_wall(self, pair: BodyPair, opinion: Opinion) -> bool:
        """Whether the pair has a wall that is worth a try."""
        push = opinion.push
        length = 0.0 if push is None else math.hypot(*push)
        if push is None or not length > 0:
            return False
        size = self._size(pair)
        if length < ROUNDING_SHARE * size:
            step = LENGTHENING_ULPS[min(self._repairs[pair], len(LENGTHENING_ULPS) - 1)]
            self._repairs[pair] += 1
            push = scaled(push, 1 + step * 2 * UNIT_ROUNDOFF * size / length)
        else:
            self._seen[pair] += 1
        normal = scaled(push, 1 / length)
        offset = self._crowd.offset(pair)
        there = added(offset, push)
        wall = Wall(*pair, normal, dot(normal, there))
        kept = [
            other
            for other in self._walls.get(pair, [])
            if other.slack(there) >= -ROUNDING_SHARE * size
        ]
        for other in kept:
            if dot(other.normal, normal) > SAME_NORMAL:
                other.least = max(other.least, wall.least)
                break
        else:
            kept.append(wall)
        self._walls[pair] = kept
        return self._seen[pair] <= PATIENCE

    def _size(self, pair: BodyPair) -> float:
        return largest_coordinate(*(self._crowd.placed[i].bounds for i in pair))

    def _take_out_one_each(self, pairs: Iterable[BodyPair]) -> None:
        """One body of each of these pairs, unless one of them was taken out just now."""
        done: set[int] = set()
        for pair in pairs:
            if done.isdisjoint(pair):
                done.update(self._take_out(pair))

    def _take_out(self, pair: BodyPair) -> BodyPair | tuple[int] | tuple[()]:
        """Put the body that has the shorter way to a free slot there."""
        ways = [(way, i) for i in pair if (way := self._slot(i)) is not None]
        if not ways:
            self.left[pair] = "no free place was found within the longest motion allowed"
            self._walls.pop(pair, None)
            return ()
        way, i = min(ways, key=lambda found: math.hypot(*found[0]))
        self._crowd.move({i: way})
        self._wall_in(i)
        return (i,)

    def _slot(self, i: int) -> Vector | None:
        crowd = self._crowd
        if i not in crowd.movable:
            return None
        others = [
            other for j, other in enumerate(crowd.placed) if j != i and crowd.is_asked(i, j)
        ]
        return free_slot(crowd.home[i], others, crowd.clearance, self._longest)

    def _wall_in(self, i: int) -> None:
        """Make the walls of a body anew, from where it is, to all that is on its way home."""
        crowd = self._crowd
        self._walls = {pair: walls for pair, walls in self._walls.items() if i not in pair}
        way = swept(crowd.home[i].bounds, crowd.placed[i].bounds)
        boxes = [way if j == i else other.bounds for j, other in enumerate(crowd.placed)]
        for pair in crowd.close_pairs(boxes):
            if i in pair:
                self._seen[pair] = 0
                wall = walled(crowd, pair)
                if wall is not None:
                    self._walls[pair] = [wall]

    def _take_out_all(self) -> bool:
        """Without another push: each body that still overlaps goes to a slot that is free of all
        others, wherever these are now, so that the number of overlaps only falls."""
        while overlaps := self.overlaps():
            self._take_out(next(iter(overlaps)))
        return True
