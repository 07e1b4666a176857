"""The difference of two reports: worse and better are proven, and nothing is passed over."""

from __future__ import annotations

import pytest
from msgspec.structs import replace

from satcheck.audit.difference import finding_changes
from satcheck.report.report import Finding, Report
from tests.cli.reports import BLOCK, PENETRATING, SEPARATED, UNDECIDED, report

A, B = PENETRATING.a, PENETRATING.b
HIT = replace(PENETRATING, thickness=None, thickness_bounds=None, volume=None, volume_error=None)
FREE = replace(SEPARATED, a=A, b=B)
OPEN = replace(UNDECIDED, a=A, b=B)
WARNED = replace(OPEN, severity="warning")


def depth(lower: float, upper: float, **more: str) -> Finding:
    return replace(HIT, depth=upper, depth_bounds=(lower, upper), **more)


def of(*findings: Finding, bodies: tuple[str, ...] = (A, B)) -> Report:
    return report(*findings, bodies=tuple(replace(BLOCK, id=id_) for id_ in bodies))


def states(before: Report, now: Report) -> list[str | None]:
    return [each and each.state for each in finding_changes(before, now)]


@pytest.mark.parametrize(
    ("before", "now", "state"),
    [
        (depth(1, 1), depth(1, 1), None),
        (depth(1, 2), depth(1, 2), None),
        (depth(1, 2), depth(1.2, 1.8), None),
        (depth(1, 2), depth(2.1, 3), "worse"),
        (depth(2.1, 3), depth(1, 2), "better"),
        (depth(1, 2), depth(1.5, 2.5), "undecided"),
        (depth(1.5, 2.5), depth(1, 2), None),
        (depth(1, 1), depth(1, 1, relation="contains"), "worse"),
        (depth(1, 1, relation="contains"), depth(1, 1), "better"),
        (depth(1, 1), OPEN, "undecided"),
        (depth(1, 1), WARNED, "undecided"),
        (FREE, depth(1, 1), "new"),
        (depth(1, 1), FREE, "gone"),
    ],
)
def test_states(before: Finding, now: Finding, state: str | None) -> None:
    assert states(of(before), of(now)) == [state]


def test_what_fails_in_neither_is_left_out() -> None:
    assert states(of(FREE), of(FREE)) == []
    assert states(of(WARNED), of(FREE)) == []


def test_a_pair_whose_body_is_gone_is_unchecked() -> None:
    (change,) = finding_changes(of(HIT), of(bodies=(A,)))
    assert change is not None
    assert (change.state, change.now) == ("unchecked", None)
    assert change.before is not None
    assert change.before.depth == HIT.depth


def test_a_pair_that_is_no_longer_asked_about_is_unchecked() -> None:
    near = replace(FREE, relation="near", severity="error", distance=0.5)
    asked = of(near)
    asked = replace(asked, settings=replace(asked.settings, clearance=1.0))
    assert states(asked, of(FREE)) == ["unchecked"]
    still = replace(of(FREE), settings=asked.settings)
    assert states(asked, still) == ["gone"]


def test_the_order_of_the_bodies_does_not_matter() -> None:
    assert states(of(HIT), of(replace(HIT, a=B, b=A))) == [None]


def test_both_findings_are_stated() -> None:
    (change,) = finding_changes(of(depth(1, 2)), of(depth(3, 4)))
    assert change is not None
    assert change.before is not None
    assert change.now is not None
    assert (change.a, change.b, change.before.depth, change.now.depth) == (A, B, 2, 4)
