"""The narrow phase on convex pairs, judged by exact truth: every query, every method, no tolerance.

The derived bound of a figure is the interval that the core reports with it: it has to hold the true
signed distance, compared in rationals, and it is never wider than WIDEST.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from fractions import Fraction
from typing import Literal

import numpy as np

from satcheck import core
from tests.hard_cases.case import ConvexPair, Vertices
from tests.hard_cases.score import Score
from tests.hard_cases.variants import SCALE, VARIANTS
from tests.oracles.exact_distance import Truth

Method = Literal["auto", "sat", "gjk"]
Query = Literal["overlap", "depth", "distance"]
QUERIES: tuple[Query, ...] = ("overlap", "depth", "distance")

# `kWidestInterval` of core/native/base/rounding.hpp, a fraction of the scale: the sum of the
# largest coordinates of A and B, each in its own frame, and of the offset of these. A frame lies in
# the middle of its shape, or up to 2 sizes from its far end: the sum is at most 6 sizes of the
# pair.
WIDEST = 6e-12

# SAT looks at every pair of edges: beyond this many vertices a pair takes it seconds.
SAT_VERTICES = 64


def judge(pair: ConvexPair, score: Score) -> None:
    """All queries and methods on one pair, and the default ones on its isometric variants."""
    truth = pair.truth()
    score.cases += 1
    if pair.expected not in (None, truth.outcome):
        raise ValueError(f"{pair.name}: built as {pair.expected}, the oracle says {truth.outcome}")
    methods: list[Method] = ["auto", "gjk"]
    if max(len(pair.a), len(pair.b)) <= SAT_VERTICES:
        methods.append("sat")
    a, b = hulls(pair)
    for method in methods:
        for query in QUERIES:
            result = core.check_pair(a, b, query=query, method=method)
            judge_result(pair, truth, result, f"{pair.name} ({query}, {method})", score)
    judge_variants(pair, truth, core.check_pair(a, b), score)


def hulls(pair: ConvexPair) -> tuple[core.Hull, core.Hull]:
    return core.Hull(np.array(pair.a)), core.Hull(np.array(pair.b))


def judge_result(
    pair: ConvexPair, truth: Truth, result: core.PairResult, what: str, score: Score
) -> None:
    score.answers += 1
    if result.outcome == "undecided":
        score.fail("undecided", f"{what}: {result.reason}")
    elif result.outcome != truth.outcome:
        score.fail("wrong", f"{what}: {result.outcome}, in truth {truth.outcome}")
    if result.distance is None:
        return
    assert result.lower is not None
    assert result.upper is not None
    interval = f"{result.lower!r} <= {result.distance!r} <= {result.upper!r}"
    ordered = result.lower <= result.distance <= result.upper
    if not (
        ordered and Fraction(result.lower) <= truth.low and truth.high <= Fraction(result.upper)
    ):
        score.fail("outside", f"{what}: {interval}, in truth {float(truth.low)!r}")
    if result.upper - result.lower > WIDEST * pair.size:
        score.fail("outside", f"{what}: {interval} is too wide an interval")
    error = truth.error_of(result.distance)
    if error > 0:
        granted = max(result.upper - result.distance, result.distance - result.lower)
        score.error = max(score.error, error / pair.size)
        score.share = max(score.share, error / granted if granted > 0 else float("inf"))
    if truth.outcome == "penetrating" and not separates(pair, result.normal, result.lower):
        score.fail("blocked", f"{what}: {-result.lower!r} along {result.normal} is not enough")


def separates(pair: ConvexPair, normal: Sequence[float] | None, lower: float) -> bool:
    """Does moving A by the proven upper bound of the depth against the normal leave no common
    interior? Exactly: a plane across the normal has all of A on one side, all of B on the other."""
    if normal is None:
        return False
    n = [Fraction(c) for c in normal]
    move = Fraction(lower) * sum(c * c for c in n)
    backwards = [-c for c in n]
    return reach(pair.a, n) + move <= -reach(pair.b, backwards)


def reach(points: Vertices, direction: Sequence[Fraction]) -> Fraction:
    """The largest dot product: exact, of the points that float64 cannot tell from the farthest."""
    array, axis = np.array(points), np.array([float(c) for c in direction])
    rough = (array * axis).sum(axis=1)
    slack = 16 * np.finfo(float).eps * float(np.abs(array).max())
    near = np.flatnonzero(rough >= rough.max() - slack)
    return max(
        sum((c * Fraction(x) for c, x in zip(direction, points[i], strict=True)), Fraction(0))
        for i in near
    )


def judge_variants(pair: ConvexPair, truth: Truth, original: core.PairResult, score: Score) -> None:
    """The same outcome under every exact motion; the same figures, bit by bit, under a change of
    scale or of the order of the vertices; the truth within the interval under the others."""
    for name, vary in VARIANTS.items():
        variant = vary(pair)
        result = core.check_pair(*hulls(variant))
        score.answers += 1
        if result.outcome != original.outcome:
            score.fail("varied", f"{pair.name}, {name}: {result.outcome}, not {original.outcome}")
        if name in ("scaled", "reordered"):
            factor = SCALE if name == "scaled" else 1.0
            assert original.distance is not None
            if result.distance != original.distance * factor or result.normal != original.normal:
                score.fail("varied", f"{pair.name}, {name}: {result.distance!r}")
        else:
            judge_result(variant, truth, result, f"{pair.name}, {name}", score)


def judge_batch(pairs: Iterable[ConvexPair], score: Score) -> None:
    """A batch answers as its pairs do one by one."""
    shapes: list[core.Shape] = [hull for pair in pairs for hull in hulls(pair)]
    index = np.arange(len(shapes), dtype=np.uint32)
    poses = np.tile([0.0, 0, 0, 0, 0, 0, 1], (len(shapes) // 2, 1))
    for query in QUERIES:
        together = core.check_pairs(
            shapes, index[::2].copy(), index[1::2].copy(), poses, poses, query=query
        )
        for i in range(len(together)):
            alone = core.check_pair(shapes[2 * i], shapes[2 * i + 1], query=query)
            mine, yours = together[i], alone
            if (mine.outcome, mine.distance, mine.normal) != (
                (yours.outcome, yours.distance, yours.normal)
            ):
                score.fail("varied", f"pair {i} in a batch ({query})")
