"""The worst pose of a motion: the deepest overlap or the smallest gap.

Branch and bound on t: S. A. Piyavskii, "An Algorithm for Finding the Absolute Extremum of a
Function" (1972); Bruno O. Shubert, "A Sequential Method Seeking the Global Maximum of a Function"
(1972). Where we deviate: each interval has its own bound, from the motion of the bodies in it along
the axis between them, instead of one constant for the whole motion.
"""

from __future__ import annotations

import heapq
import math
from collections.abc import Callable, Sequence
from itertools import chain

from msgspec import Struct
from msgspec.structs import replace

from satcheck.audit.motion.moving_pair import MovingPair, Unanswerable
from satcheck.audit.planner import ALWAYS
from satcheck.report.judge import keeps
from satcheck.report.report import OVERLAPS

Bounds = Callable[[float, float, float], tuple[float, float]]
# The search ends when the interval is narrower than this share of the figure.
WIDTH = 0.01
# The most intervals of t. For bodies that are not both convex, the most poses whose depth is
# measured coarsely, and the most measured as narrowly as the depth of a pair.
INTERVALS = 512
DEPTHS = 24
REFINED = 2
# An interval with a bound below this share of the best figure is always halved.
WORTHLESS = 0.5


class Worst(Struct, frozen=True):
    """lower <= least signed distance over the motion <= upper, the distance at `time`."""

    time: float
    lower: float
    upper: float


def least_distance(
    pair: MovingPair, lengths: Sequence[float] = (), *, narrow: bool = True
) -> Worst | None:
    """The least signed distance of two convex bodies, or the least distance of other surfaces.

    lengths: the search goes on until it is proven for each whether the distance is less. narrow:
    unless it is proven to be no less than all of them, the search also goes on until the interval
    is narrow. None: the budget was spent before any figure was proven.
    """
    return _least(pair, pair.least_gap, lengths, narrow=narrow)


def least_hull_distance(pair: MovingPair, most: float, enough: float) -> float:
    """A lower bound of the least distance of the hulls. most: an upper bound of the distance. The
    search goes on until the clearance `enough` is proven kept or broken."""
    gap = _least(pair, lambda s, e, _: (pair.least_hull_gap(s, e), most), (enough,))
    return 0.0 if gap is None else max(gap.lower, 0.0)


def deepest_pose(pair: MovingPair, impact: float) -> Worst | None:
    """The negative depth of bodies that are not both convex and overlap at t = impact.

    The depth of such a pair is not continuous in t. It is measured at several poses, and more
    narrowly at the pose with the longest way out. The lower bound is that of the hulls over the
    motion.
    """
    budget = pair.pair.settings.budget
    step = (1.0 - impact) / (DEPTHS - 1)
    times = [min(impact + step * k, 1.0) for k in range(DEPTHS)]
    try:
        depths = [(*_depth_at(pair, t, budget / DEPTHS), t) for t in times]
        longest = sorted(depths, key=lambda depth: -depth[1])[:REFINED]
        depths += [(*_depth_at(pair, t, budget), t) for _, _, t in longest]
    except Unanswerable:
        return None
    deepest, _, time = max(depths, key=lambda depth: depth[0])
    hulls = _least(pair, lambda s, e, _: (pair.least_hull_gap(s, e), -deepest), ())
    return hulls and Worst(time, min(hulls.lower, -deepest), -deepest)


def _least(
    pair: MovingPair, bounds: Bounds, lengths: Sequence[float], *, narrow: bool = True
) -> Worst | None:
    """Halves the interval of t with the least bound, until the bounds answer the question or no
    longer improve."""
    queue: list[tuple[float, float, float]] = []  # (lower bound, start, end), over the motion
    best = Worst(0.0, math.inf, math.inf)

    def look(start: float, end: float) -> tuple[float, float, float]:
        nonlocal best
        floor = WORTHLESS * best.upper if 0.0 < best.upper < math.inf else 0.0
        lower, upper = bounds(start, end, floor)
        if upper < best.upper:
            best = Worst(0.5 * (start + end), upper, upper)
        return lower, start, end

    def so_far() -> Worst:
        return replace(best, lower=min(queue[0][0], best.lower, pair.free_gap))

    try:
        for end in sorted(set(chain.from_iterable(pair.stretches))):
            look(end, end)
        for start, end in pair.stretches:
            heapq.heappush(queue, look(start, end))
    except Unanswerable:
        return None
    try:
        for _ in range(INTERVALS):
            if _answers(so_far(), pair.pad, lengths, narrow=narrow):
                break
            _, start, end = queue[0]
            middle = 0.5 * (start + end)
            halves = look(start, middle), look(middle, end)
            heapq.heapreplace(queue, halves[0])
            heapq.heappush(queue, halves[1])
    except Unanswerable:
        pass
    return so_far()


def _answers(found: Worst, pad: float, lengths: Sequence[float], *, narrow: bool) -> bool:
    width = found.upper - found.lower
    if width <= 4 * pad:
        return True
    kept = [keeps(length, found.lower, found.upper) for length in lengths]
    if None in kept:
        return False
    is_narrow = width <= WIDTH * abs(found.upper)
    return not narrow or (bool(kept) and all(kept)) or is_narrow


def _depth_at(pair: MovingPair, t: float, budget: float) -> tuple[float, float]:
    """Proven bounds of the depth; 0.0 if the bodies do not overlap."""
    placed = pair.placed(t)
    request = replace(placed.request, by={"overlap": ALWAYS, "depth": ALWAYS})
    settings = replace(placed.settings, budget=budget)
    finding = pair.found(replace(placed, settings=settings, request=request))
    if finding.relation not in OVERLAPS or finding.depth_bounds is None:
        return 0.0, 0.0
    return finding.depth_bounds
