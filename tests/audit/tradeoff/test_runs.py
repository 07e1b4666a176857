"""Where made-up climbs ended, and what is said of the way."""

from __future__ import annotations

from typing import Any

import pytest

from satcheck.audit.tradeoff.runs import climb_end
from satcheck.report.report import Finding, Stage

MEET = Stage("aabb", "meet", 1.0, "world boxes meet")
UNTURNED = Stage("obb", "skipped", 1.0, "not turned")
APART = Stage("hull", "separated", 1.0, "")


def finding(*plan: Stage, **known: Any) -> Finding:
    made: dict[str, Any] = {"relation": "separated", "exact_relation": "separated"} | known
    return Finding(id="f", a="a", b="b", severity="none", plan=plan, **made)


def test_the_last_rung_that_ran_ends_the_climb() -> None:
    found = climb_end(finding(MEET, UNTURNED, APART, Stage("verify", "separated", 1.0, "moved")))
    assert (found.rung, found.settled) == ("hull", True)
    assert found.why == "aabb meet (world boxes meet); obb skipped (not turned); hull separated"


def test_what_was_skipped_ended_nothing() -> None:
    assert climb_end(finding(MEET, UNTURNED)).rung == "aabb"
    assert climb_end(finding()).rung == "none"


@pytest.mark.parametrize(
    "known",
    [
        {"exact_relation": None},
        {"undecided": "inside"},
        {"relation": "indeterminate", "exact_relation": None, "undecided": "relation"},
    ],
)
def test_what_is_not_proven_of_the_bodies_is_not_settled(known: dict[str, Any]) -> None:
    found = climb_end(
        finding(MEET, Stage("triangles", "separated", 1.0, ""), reason="made up", **known)
    )
    assert (found.rung, found.settled) == ("exact", False)
    assert found.why.endswith("; made up")
