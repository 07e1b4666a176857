"""The rule of the contract: what may change, and what breaks it."""

from __future__ import annotations

from copy import deepcopy
from typing import Any

import pytest

from tests.contract.compare import bounds_problem, differences

PINNED: dict[str, Any] = {
    "exit": 1,
    "verdict": "fail",
    "pairs": {"total": 3, "decided": 2, "allowed": 1},
    "issues": ["warning not-closed lid", "warning not-closed lid"],
    "findings": {
        "a | b": {
            "relation": "penetrating",
            "severity": "error",
            "quality": "bounded",
            "depth": [1.0, 2.0],
            "mtv_verified": True,
            "motion": {"relation": "penetrating", "time_of_impact": [0.25, 0.5]},
            "components": {"items": [{"thickness": [0.5, 0.75]}, {"thickness": [0.0, 0.25]}]},
        },
        "a | c": {"relation": "separated", "severity": "none", "quality": "exact"},
    },
    "total_motion": 4.0,
}
# A place within the facts, and its new value.
Change = tuple[tuple[str | int, ...], Any]
A_B = ("findings", "a | b")


def changed(*changes: Change) -> list[str]:
    facts = deepcopy(PINNED)
    for place, value in changes:
        table: Any = facts
        for key in place[:-1]:
            table = table[key]
        if value is None:
            del table[place[-1]]
        else:
            table[place[-1]] = value
    return differences(PINNED, facts)


@pytest.mark.parametrize(
    "changes",
    [
        [],
        [((*A_B, "depth"), [1.5, 1.5])],
        [((*A_B, "depth"), [0.96, 2.04])],
        [((*A_B, "thickness"), [0.5, 0.6])],
        [((*A_B, "thickness"), [0.5, 0.6]), ((*A_B, "quality"), "estimate")],
        [((*A_B, "quality"), "exact")],
        [((*A_B, "exact_relation"), "penetrating")],
        [(("findings", "a | c", "mtv_verified"), True)],
        [((*A_B, "motion", "time_of_impact"), [0.3, 0.4])],
        [(("total_motion",), 5.0)],
        [(("total_motion",), 1.0)],
    ],
)
def test_it_may_change(changes: list[Change]) -> None:
    assert changed(*changes) == []


@pytest.mark.parametrize(
    ("place", "value"),
    [
        (("exit",), 0),
        (("exit",), None),
        (("verdict",), "incomplete"),
        (("pairs", "allowed"), 2),
        (("pairs", "allowed"), None),
        (("pairs", "indeterminate"), 1),
        (("issues",), ["warning not-closed lid"]),
        (("issues",), ["warning not-closed lid"] * 3),
        (("issues",), ["warning not-closed lid", "error not-closed lid"]),
        (("findings", "a | c"), None),
        (("findings", "b | c"), {"relation": "separated"}),
        ((*A_B, "relation"), "touching"),
        ((*A_B, "severity"), "warning"),
        ((*A_B, "quality"), "estimate"),
        ((*A_B, "quality"), None),
        ((*A_B, "undecided"), "limit"),
        ((*A_B, "depth"), None),
        ((*A_B, "depth"), [0.94, 2.0]),
        ((*A_B, "depth"), [1.0, 2.06]),
        ((*A_B, "depth"), [2.01, 2.02]),
        ((*A_B, "depth"), [0.98, 0.99]),
        ((*A_B, "depth"), [1.6, 1.5]),
        ((*A_B, "mtv_verified"), False),
        ((*A_B, "mtv_verified"), None),
        (("findings", "a | c", "mtv_verified"), False),
        ((*A_B, "motion"), None),
        ((*A_B, "motion", "relation"), "touching"),
        ((*A_B, "motion", "time_of_impact"), [0.2, 0.5]),
        ((*A_B, "components", "items", 0, "thickness"), [0.4, 0.75]),
        ((*A_B, "components", "items"), [{"thickness": [0.5, 0.75]}]),
        (("total_motion",), 5.1),
    ],
)
def test_it_breaks_the_contract(place: tuple[str | int, ...], value: Any) -> None:
    assert changed((place, value))


@pytest.mark.parametrize(
    ("old", "new", "kept"),
    [
        ([3.0, 3.0], [3.0, 3.0], True),
        ([3.0, 3.0], [3.0 - 2e-9, 3.0 + 2e-9], True),
        ([3.0, 3.0], [3.0 - 4e-9, 3.0], False),
        ([3.0, 3.0], [3.0 + 4e-9, 3.0 + 4e-9], False),
        ([0.0, 0.0], [0.0, 0.0], True),
        ([0.0, 0.0], [0.0, 1e-12], False),
        ([0.0, 1e-6], [0.0, 1.04e-6], True),
        ([0.0, 1e-6], [0.0, 1.06e-6], False),
    ],
)
def test_exact_figures_may_differ_by_rounding(
    old: list[float], new: list[float], kept: bool
) -> None:
    assert (bounds_problem(old, new) is None) == kept


def test_each_problem_is_named_once_with_its_place() -> None:
    assert changed((("issues",), ["warning not-closed lid"])) == [
        "issues: warning not-closed lid is lost"
    ]
    (problem,) = changed(((*A_B, "motion", "relation"), "touching"))
    assert problem == "findings: a | b: motion: relation: penetrating became touching"
