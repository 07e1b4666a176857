"""References are counted, each thing once, before anything is expanded."""

from __future__ import annotations

from itertools import pairwise

import pytest

from satcheck.scene.errors import Refused
from satcheck.scene.files.limits import MAX_DEPTH, MAX_PLACEMENTS
from satcheck.scene.files.placing import refuse_explosion

Held = dict[str, list[tuple[str, int]]]


def refused(held: Held, size: int = 1) -> str | None:
    try:
        refuse_explosion(["root"], lambda key: held.get(key, []), lambda _: size, str, MAX_DEPTH)
    except Refused as error:
        return f"{error.code}: {error.message}"
    return None


def test_the_limit_is_of_all_copies_together() -> None:
    half = MAX_PLACEMENTS // 2
    assert refused({"root": [("a", half - 1), ("b", half)]}) is None
    assert str(refused({"root": [("a", half), ("b", half)]})).startswith("too-large")
    assert refused({"root": [("a", 1)]}, size=half) is None
    assert str(refused({"root": [("a", 2)]}, size=half)).startswith("too-large")


@pytest.mark.parametrize("steps", [1, 2, 5])
def test_a_circle_is_named(steps: int) -> None:
    names = [f"n{k}" for k in range(steps)]
    held: Held = {"root": [(names[0], 1)]}
    held |= {name: [(names[(k + 1) % steps], 1)] for k, name in enumerate(names)}
    assert refused(held) == "reference-cycle: n0 contains itself: a cycle"


def test_two_ways_to_one_thing_are_no_circle() -> None:
    assert refused({"root": [("a", 1), ("b", 1)], "a": [("c", 1)], "b": [("a", 1)]}) is None


def test_depth_has_a_limit() -> None:
    names = ["root", *map(str, range(MAX_DEPTH))]
    held: Held = {a: [(b, 1)] for a, b in pairwise(names)}
    assert str(refused(held)).startswith("too-large: elements are nested deeper")
    del held[names[-2]]
    assert refused(held) is None
