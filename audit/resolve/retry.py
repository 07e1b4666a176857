"""Shorter answers than the rounds gave: other starts, and each body by itself once more.

The rounds push from home, so they end at a least motion near there. Where one body has a short way
out of everything, the sum of squares may be less when it goes first and the others only make room
for what is left. And a body that was pushed about may have a shorter way to a place that is free
now. Both ask for the shortest way of one body among others that stay (`way_alone`), which is no
matter of what is near. What comes out is kept where it is shorter and proven free.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable

from satcheck.audit.report.report import Vector
from satcheck.audit.resolve.alone import way_alone
from satcheck.audit.resolve.crowd import ORIGIN, Crowd
from satcheck.audit.resolve.pull_back import pull_back, swept
from satcheck.audit.resolve.rounds import Rounds
from satcheck.audit.resolve.wall import BodyPair
from satcheck.audit.vectors import dot

# So many bodies are tried as the first to go, and so many moved bodies by themselves, so often.
STARTS = 16
SINGLES = 32
PASSES = 3
# What gains less of the sum of squares than this share is no gain.
LEAST_GAIN = 1e-6


def retry(crowd: Crowd, overlaps: Collection[BodyPair], longest: float, iterations: int) -> None:
    """Shorten what the bodies of a scene were moved by, which are free of each other.

    overlaps: pairs that were not at home."""
    tried = 0
    for group in _groups(crowd, overlaps):
        first = sorted({i for pair in overlaps for i in pair if i in group})
        for i in first[: STARTS - tried]:
            tried += 1
            _start_with(crowd, i, group, longest, iterations)
    for _ in range(PASSES):
        if not _each_alone(crowd):
            return
        pull_back(crowd, (), longest)


def _groups(crowd: Crowd, overlaps: Iterable[BodyPair]) -> list[frozenset[int]]:
    """The bodies that moved or overlapped, those together that have to do with each other; the
    longest motions first."""
    ways = [swept(a.bounds, b.bounds) for a, b in zip(crowd.home, crowd.placed, strict=True)]
    moved = {i for i, offset in enumerate(crowd.offsets) if offset != ORIGIN}
    moved |= {i for pair in overlaps for i in pair} & crowd.movable
    group = {i: {i} for i in moved}
    for i, j in (*overlaps, *crowd.close_pairs(ways)):
        if i in moved and j in moved and group[i] is not group[j]:
            group[i] |= group[j]
            group.update(dict.fromkeys(group[j], group[i]))
    found = {min(members): frozenset(members) for members in group.values()}
    return sorted(found.values(), key=lambda one: (-_squares(crowd, one), min(one)))


def _squares(crowd: Crowd, bodies: Iterable[int]) -> float:
    return math.fsum(dot(crowd.offsets[i], crowd.offsets[i]) for i in bodies)


def _start_with(
    crowd: Crowd, i: int, group: frozenset[int], longest: float, iterations: int
) -> None:
    """One body goes by itself, the others of its group only as far as they then have to. Bodies
    moved for other groups stay where they are."""
    before, movable = list(crowd.offsets), crowd.movable
    elsewhere = {j for j, offset in enumerate(before) if offset != ORIGIN and j not in group}
    squares = _squares(crowd, range(len(before)))
    crowd.movable = movable - elsewhere
    crowd.move(dict.fromkeys(group, ORIGIN))
    way = way_alone(crowd, i, min(longest, math.sqrt(squares)))
    if way is not None:
        rounds = Rounds(crowd, longest)
        rounds.put(i, way)
        rounds.run(iterations)
        pull_back(crowd, rounds.left, longest)
    crowd.movable = movable
    worse = _squares(crowd, range(len(before))) > squares * (1 - LEAST_GAIN)
    if way is None or rounds.left or worse:
        crowd.move(dict(enumerate(before)))


def _each_alone(crowd: Crowd) -> bool:
    """Give each moved body the shortest way that there is among the others; whether one gained."""
    moved = [i for i, offset in enumerate(crowd.offsets) if offset != ORIGIN]
    moved.sort(key=lambda i: -math.hypot(*crowd.offsets[i]))
    return sum(_goes_alone(crowd, i) for i in moved[:SINGLES]) > 0


def _goes_alone(crowd: Crowd, i: int) -> bool:
    before: Vector = crowd.offsets[i]
    way = way_alone(crowd, i, (1 - LEAST_GAIN) * math.hypot(*before))
    if way is None:
        return False
    crowd.move({i: way})
    around = [pair for pair in crowd.close_pairs() if i in pair]
    if all(said.kind == "free" for said in crowd.opinions(around).values()):
        return True
    crowd.move({i: before})
    return False
