"""Where made-up climbs ended."""

from __future__ import annotations

from satcheck.audit.tradeoff.runs import last_rung
from satcheck.report.report import Finding, Stage

MEET = Stage("aabb", "meet", 1.0, "world boxes meet")
UNTURNED = Stage("obb", "skipped", 1.0, "not turned")
APART = Stage("hull", "separated", 1.0, "")
TRIANGLES = Stage("triangles", "separated", 1.0, "")
VERIFIED = Stage("verify", "separated", 1.0, "moved")


def finding(*plan: Stage) -> Finding:
    return Finding(id="f", a="a", b="b", severity="none", relation="separated", plan=plan)


def test_the_last_rung_that_ran_ends_the_climb() -> None:
    assert last_rung(finding(MEET, UNTURNED, APART, VERIFIED)) == "hull"
    assert last_rung(finding(MEET, UNTURNED, TRIANGLES)) == "exact"


def test_what_was_skipped_ended_nothing() -> None:
    assert last_rung(finding(MEET, UNTURNED)) == "aabb"
    assert last_rung(finding()) is None
