"""The first moment at which bodies of robots overlap on a path of joints, by bisection of t.

In the middle of an interval the core proves two bodies apart by more than they travel until its
ends. Then they are apart in all of the interval; no moment is skipped. Else the interval is halved.
Schwarzer, Saha, Latombe (2005), see `travel.py`. All pairs are asked at once.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import inf

import numpy as np
from msgspec import Struct
from msgspec.structs import replace
from numpy.typing import NDArray

from satcheck.audit.motion.impact import Impact, impact_point
from satcheck.audit.motion.joint_travel import Interval, Middle, Numbers, Travel
from satcheck.audit.motion.moving_pair import PADS_IN_BAND, STEPS, found, overlaps
from satcheck.audit.motion.worst import Worst
from satcheck.audit.pair import Pair
from satcheck.audit.planner import ALWAYS
from satcheck.audit.posed_pairs import APART, DEEP, PosedPairs
from satcheck.audit.stages.depth import FREE
from satcheck.core.conventions import Vector
from satcheck.report.report import Effect, Finding
from satcheck.report.request import Request
from satcheck.scene.robot import JointPath

Flags = NDArray[np.bool_]

# Poses that the core takes at a time.
TOGETHER = 4096
# A pair climbs the ladder in the middle of an interval if it travels less than this share of the
# smaller body: the quick proofs of the core are then too coarse, or the bodies are in contact.
NEAR = 1 / 256
# The most intervals of one pair, and the most that climb: those of a sweep, and so many for each
# piece of the path.
STEPS_A_PIECE = 64
CLIMBS = 96
CLIMBS_A_PIECE = 8
# An interval of t is halved down to this length. A travel of its length is within the touch band,
# which is at least this share of the smaller body.
SHORTEST = 2.0**-46
FINEST = 1e-10
# A touch counts within a band that is wider than the tolerance of the pair, up to this share of the
# smaller body: far poses and far limits of joints make the rounding of a path large.
WIDEST = 1e-6
# The nearest distance is narrowed to this share of itself, and measured so often in a round.
MEASURED = 4
NARROWED = 0.99


class SweptPair(Struct):
    """The knowledge of one pair. hit: a t with an overlap; free_until: before this t there is none.
    touch: the first t at which the bodies may touch. nearest: if a clearance asks for it.
    tolerance: half the width of the touch band. is_spent: whether the budget ended the search."""

    tolerance: float
    hit: float = inf
    free_until: float = inf
    touch: float = inf
    steps: int = 0
    climbs: int = 0
    is_spent: bool = False
    nearest: Worst | None = None

    @property
    def impact(self) -> Impact:
        since = min(self.free_until, self.hit)
        if self.hit < inf:
            return Impact(since, self.hit, since, since)
        if since < inf:
            return Impact(since, None, since, since, self._reason())
        return Impact(1.0, None, 1.0, None if self.touch == inf else self.touch)

    def _reason(self) -> str:
        at = f"at t = {self.free_until:.6g}"
        if self.is_spent:
            return f"the budget of the sweep was spent, {at}"
        return f"nothing proves that the bodies stay apart, or within the tolerance, {at}"


# (the intervals whose earlier half stays unknown, those whose later half does)
Settle = Callable[[Interval, Flags, Middle, list[SweptPair]], tuple[Flags, Flags]]


class Search:
    """pairs, travel: of the same scene."""

    def __init__(self, path: JointPath, travel: Travel, pairs: PosedPairs) -> None:
        self._path, self._travel, self._pairs = path, travel, pairs
        self._sizes = np.array(pairs.sizes())
        pieces = len(path.times) - 1
        self._steps = STEPS + STEPS_A_PIECE * pieces
        self._climbs = CLIMBS + CLIMBS_A_PIECE * pieces

    def first_overlaps(self, asked: Flags) -> list[SweptPair]:
        """asked: which pairs."""
        at = self._travel.middle(Interval(self._path.times[:-1], self._path.times[1:]))
        swept = [
            SweptPair(max(self._pairs.tolerance(k), self._band(at, k)))
            for k in range(len(self._pairs.pairs))
        ]
        self._bisect(asked, swept, self._settle)
        return swept

    def narrow(self, asked: Flags, swept: list[SweptPair]) -> None:
        """Narrows the least distances of these pairs, which do not overlap, as far as their
        clearances ask."""
        for k in np.flatnonzero(asked).tolist():
            swept[k].nearest = Worst(0.0, self._pairs.pairs[k].request.clearance or 0.0, inf)
            swept[k].steps = 0
        self._bisect(asked, swept, self._compare)

    def _bisect(self, asked: Flags, swept: list[SweptPair], settle: Settle) -> None:
        """Halves the pieces of the path until all asked pairs are settled in all intervals."""
        times = self._path.times
        intervals, active = Interval(times[:-1], times[1:]), np.tile(asked, (len(times) - 1, 1))
        while len(intervals.start):
            halves: list[tuple[Interval, Flags]] = []
            for k in range(0, len(intervals.start), TOGETHER):
                rows = slice(k, k + TOGETHER)
                part = Interval(intervals.start[rows], intervals.end[rows])
                at = self._travel.middle(part)
                earlier, later = settle(part, active[rows], at, swept)
                halves += (
                    (Interval(part.start, part.middle), earlier),
                    (Interval(part.middle, part.end), later),
                )
            intervals, active = _joined(halves)
            active = self._worth_it(intervals, active, swept)
            intervals, active = _kept(intervals, active)

    def impact_point(self, k: int, lower: float, hit: float) -> Vector | None:
        """A point of both bodies of a pair at `hit`. Before `lower` they do not overlap. Only the
        piece of the path that ends with the hit counts as their way."""
        piece = max(int(np.searchsorted(self._path.times, hit)) - 1, 0)
        start, end = np.array([max(lower, self._path.times[piece])]), np.array([hit])
        at, way = (self._travel.middle(Interval(since, end)) for since in (end, start))
        moved = 2.0 * float(self._travel.between(way, *self._pairs.pairs[k].places)[0])
        return impact_point(self._pair(at, 0, k, self._pairs.tolerance(k), 0.0), moved)

    def _margins(self, active: Flags, at: Middle) -> Numbers:
        """Return how far each pair travels; NaN where it is not active."""
        margins = np.full(active.shape, np.nan)
        for k in np.flatnonzero(active.any(axis=0)).tolist():
            travelled = self._travel.between(at, *self._pairs.pairs[k].places)
            margins[:, k] = np.where(active[:, k], travelled, np.nan)
        return margins

    def _settle(
        self, part: Interval, active: Flags, at: Middle, swept: list[SweptPair]
    ) -> tuple[Flags, Flags]:
        """(intervals that stay unknown, those whose later half does, too)"""
        margins = self._margins(active, at)
        codes = self._pairs.sift(at.matrices, margins, [f.tolerance for f in swept])
        middles = part.middle
        for row, k in np.argwhere(active & (codes == DEEP)).tolist():
            swept[k].hit = min(swept[k].hit, float(middles[row]))
        unknown = active & (codes != APART)
        later = unknown & (codes != DEEP)
        for row, k in np.argwhere(later & (margins <= NEAR * self._sizes)).tolist():
            if middles[row] >= swept[k].hit or swept[k].climbs >= self._climbs:
                continue
            swept[k].climbs += 1
            pair = self._pair(at, row, k, swept[k].tolerance, float(margins[row, k]))
            finding = found(pair)
            if overlaps(finding):
                swept[k].hit, later[row, k] = float(middles[row]), False
            elif _is_clear(finding):
                unknown[row, k] = later[row, k] = False
            elif self._stays_within(at, row, k, swept[k].tolerance, float(margins[row, k])):
                swept[k].touch = min(swept[k].touch, float(part.start[row]))
                unknown[row, k] = later[row, k] = False
        return unknown, later

    def _stays_within(
        self, at: Middle, row: int, k: int, tolerance: float, travelled: float
    ) -> bool:
        """Return whether no overlap in the interval is beyond the tolerance, because none in its
        middle is beyond what the bodies do not travel."""
        widest = max(self._pairs.tolerance(k), WIDEST * float(self._sizes[k]))
        if travelled >= tolerance or tolerance > widest:
            return False
        pair = self._pair(at, row, k, tolerance - travelled, 0.0)
        return found(pair).relation in FREE

    def _compare(
        self, part: Interval, active: Flags, at: Middle, swept: list[SweptPair]
    ) -> tuple[Flags, Flags]:
        """The intervals in which the pairs may be nearer than the least known distance, twice."""
        travelled = self._margins(active, at)
        limits = np.array([f.nearest.lower if f.nearest else 0.0 for f in swept])
        codes = self._pairs.sift(at.matrices, travelled + limits, [f.tolerance for f in swept])
        unknown: Flags = active & (codes != APART)
        worth = unknown & (travelled <= np.maximum(0.25 * limits, NEAR * self._sizes))
        for k in np.flatnonzero(worth.any(axis=0)).tolist():
            rows = np.flatnonzero(worth[:, k])
            nearest = swept[k].nearest
            assert nearest is not None
            for row in rows[:: -(-len(rows) // MEASURED)].tolist():
                enough = nearest.lower + float(travelled[row, k])
                pair = self._pair(at, row, k, swept[k].tolerance, enough)
                finding = found(pair)
                unknown[row, k] = not _is_clear(finding)
                if finding.distance is not None and finding.distance < nearest.upper:
                    lower = min(nearest.lower, NARROWED * finding.distance)
                    nearest = Worst(float(part.middle[row]), lower, finding.distance)
            swept[k].nearest = nearest
        return unknown, unknown

    def _pair(self, at: Middle, row: int, k: int, tolerance: float, clearance: float) -> Pair:
        (pair,) = self._pairs.at(at.matrices, row, [k])
        by: dict[Effect, str] = {"overlap": ALWAYS, "distance": ALWAYS}
        request = Request(by, clearance=clearance, tolerance=tolerance)
        return replace(pair, request=request)

    def _band(self, at: Middle, k: int) -> float:
        return max(PADS_IN_BAND * at.pad, FINEST * float(self._sizes[k]))

    def _worth_it(self, intervals: Interval, active: Flags, swept: list[SweptPair]) -> Flags:
        """The intervals to ask about: no later than a known overlap, within the budget of the pair,
        and not too short. Others leave the pair open from their start on."""
        active = active & (intervals.start[:, None] < np.array([f.hit for f in swept]))
        short = intervals.end - intervals.start <= SHORTEST
        for k in np.flatnonzero(active.any(axis=0)).tolist():
            swept[k].steps += int(active[:, k].sum())
            swept[k].is_spent = swept[k].steps > self._steps
            ends = active[:, k] if swept[k].is_spent else active[:, k] & short
            if not ends.any():
                continue
            since = float(intervals.start[ends].min())
            nearest = swept[k].nearest
            if nearest is None:
                swept[k].free_until = min(swept[k].free_until, since)
            else:
                swept[k].nearest = replace(nearest, lower=0.0)
            active[:, k] &= ~ends
        return active


def _is_clear(finding: Finding) -> bool:
    return finding.relation == "separated" and finding.undecided is None


def _joined(halves: Sequence[tuple[Interval, Flags]]) -> tuple[Interval, Flags]:
    """The intervals with an open pair, in the order of t."""
    start = np.concatenate([part.start for part, _ in halves])
    end = np.concatenate([part.end for part, _ in halves])
    active = np.concatenate([own for _, own in halves])
    order = np.argsort(start, kind="stable")
    return _kept(Interval(start[order], end[order]), active[order])


def _kept(intervals: Interval, active: Flags) -> tuple[Interval, Flags]:
    rows = active.any(axis=1)
    return Interval(intervals.start[rows], intervals.end[rows]), active[rows]
