"""References are counted, each thing once, before anything is expanded."""

from __future__ import annotations

from itertools import pairwise

import pytest

from satcheck.scene.errors import Refused
from satcheck.scene.files.limits import MAX_PLACEMENTS
from satcheck.scene.files.placing import refuse_explosion

Held = dict[str, list[str]]


def refused(held: Held) -> str | None:
    try:
        refuse_explosion(["root"], lambda key: held.get(key, []), str)
    except Refused as error:
        return f"{error.code}: {error.message}"
    return None


def test_the_limit_is_of_all_copies_together() -> None:
    most = MAX_PLACEMENTS - 1  # beside the root
    assert refused({"root": ["a"] * most}) is None
    assert str(refused({"root": ["a"] * most + ["b"]})).startswith("too-large")


def test_what_doubles_at_each_step_is_refused_before_it_is_expanded() -> None:
    names = ["root", *map(str, range(100))]
    held: Held = {a: [b, b] for a, b in pairwise(names)}
    assert str(refused(held)).startswith("too-large")


@pytest.mark.parametrize("steps", [1, 2, 5])
def test_a_circle_is_named(steps: int) -> None:
    names = [f"n{k}" for k in range(steps)]
    held: Held = {"root": [names[0]]}
    held |= {name: [names[(k + 1) % steps]] for k, name in enumerate(names)}
    assert refused(held) == "reference-cycle: n0 contains itself: a cycle"


def test_two_ways_to_one_thing_are_no_circle() -> None:
    assert refused({"root": ["a", "b"], "a": ["c"], "b": ["a"]}) is None
