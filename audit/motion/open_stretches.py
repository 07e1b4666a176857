"""When moving bodies may meet, by bisection of t.

In the middle of an interval the core proves two bodies apart by more than they travel until its
ends. Then they are apart in all of the interval. Else the interval is halved, until they travel
little: a sweep goes through it. Schwarzer, Saha, Latombe (2005), see `travel.py`. All pairs
are asked at once, on joints as on tracks.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from itertools import pairwise
from math import inf

import numpy as np
from msgspec import Struct
from numpy.typing import NDArray

from satcheck.audit.motion.moving_pair import OpenStretches, Stretch, holed
from satcheck.audit.motion.travel import Moments, Numbers, Travel
from satcheck.audit.pair import STEPS_OF_SCENE, STEPS_OF_TRIANGLE, Pair
from satcheck.audit.posed_pairs import APART, PosedPairs

Flags = NDArray[np.bool_]

# Poses that the core takes at a time, and placements and pairs in all of them.
TOGETHER = 4096
ENTRIES = 2**22
# Travels, as shares of the smaller body, at which an interval is left to a sweep, and for bodies
# with holes, whose fills a sweep does not see.
NEAR = 1 / 256
NEAREST = 2.0**-20
# The most intervals of one pair, and so many for each piece of the path.
INTERVALS = 16
INTERVALS_A_PIECE = 8
# Steps of all intervals, beside those of a scene: so many for each piece of the path and each pair.
STEPS_A_PIECE = 10_000


class _Intervals(Struct, frozen=True):
    """active: which pairs are asked in them, shape (intervals, pairs)."""

    start: Numbers
    end: Numbers
    active: Flags

    def at(self, rows: slice) -> _Intervals:
        return _Intervals(self.start[rows], self.end[rows], self.active[rows])

    def halved(self, active: Flags) -> _Intervals:
        """Both halves of those with an active pair."""
        rows = active.any(axis=1)
        start, end = self.start[rows], self.end[rows]
        middle = 0.5 * (start + end)
        starts, ends = np.stack((start, middle)), np.stack((middle, end))
        return _Intervals(starts.T.ravel(), ends.T.ravel(), np.repeat(active[rows], 2, axis=0))


def open_stretches(travel: Travel, pairs: Sequence[Pair]) -> list[OpenStretches]:
    """Return of each pair when it is not proven farther apart than its tolerance and its clearance.

    Below exact nothing is asked, and a sweep goes through all of the motion.
    """
    if not pairs or pairs[0].may("exact"):
        return _bisected(travel, pairs) if pairs else []
    return [OpenStretches(tuple(pairwise(travel.times.tolist())))] * len(pairs)


def _bisected(travel: Travel, pairs: Sequence[Pair]) -> list[OpenStretches]:
    times = travel.times
    bodies = {body.id: body for pair in pairs for body in (pair.a, pair.b)}
    ids, posed = list(bodies), PosedPairs(list(bodies.values()), pairs)
    bands = [travel.band(pair) for pair in pairs]
    near = [
        (NEAREST if holed(pair) else NEAR) * min(pair.a.diagonal, pair.b.diagonal) for pair in pairs
    ]
    together = max(min(TOGETHER, ENTRIES // (len(ids) + len(pairs))), 1)
    most = INTERVALS + INTERVALS_A_PIECE * (len(times) - 1)
    found: list[list[Stretch]] = [[] for _ in pairs]
    steps = np.zeros(len(found), int)
    left = STEPS_OF_SCENE + STEPS_A_PIECE * (len(times) - 1) * len(found)
    left += sum(STEPS_OF_TRIANGLE * body.shared.triangles for body in bodies.values())
    waiting = [_Intervals(times[:-1], times[1:], np.ones((len(times) - 1, len(found)), bool))]
    while waiting:
        part = waiting.pop()
        if len(part.start) > together:
            waiting += (part.at(slice(together, None)), part.at(slice(together)))
            continue
        steps += part.active.sum(axis=0)
        middle = 0.5 * (part.start + part.end)
        at = travel.at(middle)
        half = np.nextafter(np.maximum(part.end - middle, middle - part.start), inf)
        travelled = _travelled(travel, at, pairs, half, part.active)
        codes, spent = posed.sift(at.placements(ids, len(middle)), travelled + bands, max(left, 0))
        left -= spent
        unproven = part.active & (codes != APART)
        worth = (travelled > near) & (steps < most)
        worth &= left > 0
        for row, k in np.argwhere(unproven & ~worth).tolist():
            found[k].append((float(part.start[row]), float(part.end[row])))
        if (unproven & worth).any():
            waiting.append(part.halved(unproven & worth))
    ends = set(times.tolist())
    gaps = (
        max(band, pair.request.clearance or 0.0) for band, pair in zip(bands, pairs, strict=True)
    )
    return [
        OpenStretches(_joined(stretches, ends), asked_of, gap)
        for stretches, asked_of, gap in zip(found, steps.tolist(), gaps, strict=True)
    ]


def _travelled(
    travel: Travel, at: Moments, pairs: Sequence[Pair], half: Numbers, active: Flags
) -> Numbers:
    """Return how far each pair travels in the time `half` from `at`, NaN where it is not active."""
    travelled = np.full(active.shape, np.nan)
    for k in np.flatnonzero(active.any(axis=0)).tolist():
        own = travel.between(at, half, pairs[k])
        travelled[:, k] = np.where(active[:, k], own, np.nan)
    return travelled


def _joined(stretches: list[Stretch], times: Collection[float]) -> tuple[Stretch, ...]:
    """Joins those that follow each other in the same piece of the path."""
    joined: list[Stretch] = []
    for start, end in sorted(stretches):
        if joined and joined[-1][1] == start and start not in times:
            joined[-1] = joined[-1][0], end
        else:
            joined.append((start, end))
    return tuple(joined)
