"""The whole suite: every family, judged, one score a category."""

from __future__ import annotations

from collections.abc import Iterable

from tests.hard_cases import curved, defects, mesh_families
from tests.hard_cases.families import FAMILIES
from tests.hard_cases.judge_convex import judge, judge_batch
from tests.hard_cases.judge_mesh import judge_mesh
from tests.hard_cases.score import Score

CATEGORIES = (
    *(family.CATEGORY for family in FAMILIES),
    curved.CATEGORY,
    *(family.CATEGORY for family in mesh_families.FAMILIES),
    defects.CATEGORY,
)


def all_scores(seeds: Iterable[int]) -> list[Score]:
    """Each category over all seeds, in the order of CATEGORIES."""
    seeds = list(seeds)
    return [*convex_scores(seeds), curved_score(seeds), *mesh_scores(seeds), defects_score()]


def convex_scores(seeds: list[int]) -> list[Score]:
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


def curved_score(seeds: list[int]) -> Score:
    score = Score(curved.CATEGORY)
    for seed in seeds:
        for pair in curved.cases(seed):
            curved.judge_curved(pair, score)
    return score


def mesh_scores(seeds: list[int]) -> list[Score]:
    scores = []
    for family in mesh_families.FAMILIES:
        score = Score(family.CATEGORY)
        for seed in seeds:
            for pair in family.cases(seed):
                judge_mesh(pair, score)
        scores.append(score)
    return scores


def defects_score() -> Score:
    """The same files whatever the seed."""
    score = Score(defects.CATEGORY)
    defects.judge_defects(score)
    return score
