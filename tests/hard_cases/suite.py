"""The whole suite: every family, judged, one score a category."""

from __future__ import annotations

from collections.abc import Iterable

from tests.hard_cases.families import FAMILIES
from tests.hard_cases.judge_convex import judge, judge_batch
from tests.hard_cases.score import Score


def convex_scores(seeds: Iterable[int]) -> list[Score]:
    """Each category over all seeds."""
    seeds = list(seeds)
    scores = []
    for family in FAMILIES:
        score = Score(family.CATEGORY)
        for seed in seeds:
            pairs = list(family.cases(seed))
            for pair in pairs:
                judge(pair, score)
            judge_batch(pairs, score)
        scores.append(score)
    return scores
