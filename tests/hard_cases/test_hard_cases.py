"""Every category: no wrong verdict, nothing undecided, every figure within its proven bound."""

from __future__ import annotations

from functools import cache

import pytest

from tests.hard_cases.families import FAMILIES
from tests.hard_cases.score import Score
from tests.hard_cases.suite import convex_scores

SHOWN = 20


@cache
def scores() -> dict[str, Score]:
    return {score.category: score for score in convex_scores([0])}


@pytest.mark.parametrize("category", [family.CATEGORY for family in FAMILIES])
def test_no_failure(category: str) -> None:
    failures = scores()[category].failures
    assert not failures, "\n".join(failures[:SHOWN])


def test_names_are_unique() -> None:
    for family in FAMILIES:
        names = [pair.name for pair in family.cases(0)]
        assert len(names) == len(set(names)), family.CATEGORY


def test_a_seed_fixes_the_cases() -> None:
    for family in FAMILIES:
        assert list(family.cases(3)) == list(family.cases(3))
