"""Every category: no wrong verdict, nothing undecided, every figure within its proven bound."""

from __future__ import annotations

import re
from functools import cache
from pathlib import Path

import pytest

from tests.hard_cases import mesh_families
from tests.hard_cases.families import FAMILIES
from tests.hard_cases.score import HEAD, Score, row
from tests.hard_cases.suite import CATEGORIES, all_scores

PAGE = Path(__file__).resolve().parents[2] / "bench" / "README.md"
SHOWN = 20


@cache
def scores() -> dict[str, Score]:
    return {score.category: score for score in all_scores([0])}


@pytest.mark.parametrize("category", CATEGORIES)
def test_no_failure(category: str) -> None:
    failures = scores()[category].failures
    assert not failures, "\n".join(failures[:SHOWN])


def test_names_are_unique_and_a_seed_fixes_the_cases() -> None:
    for family in FAMILIES:
        pairs = list(family.cases(3))
        assert len({pair.name for pair in pairs}) == len(pairs), family.CATEGORY
        assert pairs == list(family.cases(3))
    for mesh_family in mesh_families.FAMILIES:
        meshes = list(mesh_family.cases(3))
        assert len({pair.name for pair in meshes}) == len(meshes), mesh_family.CATEGORY
        assert meshes == list(mesh_family.cases(3))


def printed_rows() -> dict[str, list[str]]:
    """The table of this suite by category; those of other libraries have several counts a cell."""
    lines = PAGE.read_text(encoding="utf-8").splitlines()
    rows = [re.split(r"\s*\|\s*", line.strip("| ")) for line in lines if line.startswith("|")]
    return {cells[0]: cells for cells in rows if cells[0] in scores() and cells[2].isdigit()}


@pytest.mark.parametrize("category", CATEGORIES)
def test_the_page_shows_these_figures(category: str) -> None:
    """The counts are the same; no error is larger than the one printed."""
    printed, measured = printed_rows()[category], row(scores()[category])
    assert printed[1:4] == list(measured[1:4])
    for shown, found in zip(printed[4 : len(HEAD)], measured[4:], strict=True):
        assert float(found) <= float(shown)
