"""The report as JSON values: key order, no timings on request, no figure that is not finite."""

from __future__ import annotations

import json

import pytest
from msgspec.structs import replace

from satcheck.audit import Finding, Report, Settings
from satcheck.report.report import PairCounts, Stage, Summary, Tool

FINDING = Finding(
    id="0123456789ab",
    a="left",
    b="right",
    severity="error",
    relation="penetrating",
    exact_relation="penetrating",
    tolerance=1e-7,
    depth=1.0,
    depth_bounds=(1.0, 1.0),
    quality="exact",
    normal=(1.0, -0.0, 0.0),
    mtv=(-1.0, 0.0, 0.0),
    mtv_moves="a",
    mtv_verified=True,
    plan=(Stage("aabb", "meet", 1.5, ""),),
)
REPORT = Report(
    tool=Tool("satcheck", "0.0.0"),
    units=None,
    settings=Settings().stated(depth=True, thickness=True),
    summary=Summary("fail", PairCounts(1, 0, 1, 0, 0), {"penetrating": 1}),
    bodies=(),
    findings=(FINDING,),
    issues=(),
)
FINDING_KEYS = [
    "id",
    "a",
    "b",
    "rule",
    "severity",
    "message",
    "undecided",
    "relation",
    "placed_relation",
    "exact_relation",
    "tolerance",
    "distance",
    "distance_bounds",
    "depth",
    "depth_bounds",
    "quality",
    "normal",
    "mtv",
    "mtv_moves",
    "mtv_verified",
    "witness",
    "thickness",
    "thickness_bounds",
    "ball",
    "volume",
    "volume_error",
    "contacts",
    "components",
    "part_pairs",
    "motion",
    "certificate",
    "reason",
    "reason_code",
    "plan",
    "baseline_state",
]


def test_keys_come_in_the_order_of_the_schema():
    plain = REPORT.to_dict()
    assert list(plain) == (
        [
            "schema",
            "tool",
            "units",
            "settings",
            "summary",
            "message",
            "reading",
            "pose",
            "motions",
            "bodies",
            "exempt",
            "rules",
            "effects",
            "findings",
            "issues",
            "truncated",
            "baseline",
            "config",
        ]
    )
    assert list(plain["findings"][0]) == FINDING_KEYS
    assert list(plain["findings"][0]["plan"][0]) == ["stage", "result", "microseconds", "detail"]


def test_not_asked_is_null():
    plain = REPORT.to_dict()["findings"][0]
    assert plain["distance"] is None
    assert plain["witness"] is None


def test_timings_can_be_left_out():
    assert "microseconds" not in json.dumps(REPORT.to_dict(timings=False))


@pytest.mark.parametrize("value", [float("nan"), float("inf")])
def test_non_finite_numbers_are_refused(value):
    with pytest.raises(ValueError, match="finite"):
        replace(FINDING, depth=value)
    with pytest.raises(ValueError, match="finite"):
        replace(FINDING, thickness_bounds=(0.0, value))
    with pytest.raises(ValueError, match="finite"):
        replace(FINDING, mtv=(0.0, value, 0.0))
