"""Whole reports: true ones are accepted, and what is said of them follows from the findings."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from satcheck.verify import Rejected, is_certified, verify
from tests.cli.process import VALIDATOR
from tests.verify.reports import PAIRS, Json, report_of, verified


@pytest.mark.parametrize("name", PAIRS)
def test_a_true_report_is_accepted(name: str) -> None:
    relation, kind, *_ = PAIRS[name]
    document = report_of(name)
    finding = document["findings"][0]
    assert finding["exact_relation"] == relation
    assert finding["certificate"]["relation"]["kind"] == kind
    VALIDATOR.validate(document)
    found = verified(document)
    assert found.accepted
    assert [one.outcome for one in found.findings] == ["accepted"]


def raise_count(pairs: Json, key: str) -> None:
    pairs[key] += 1


FORGED: dict[str, Callable[[Json], Any]] = {
    "verdict": lambda d: d["summary"].update(verdict="pass"),
    "total": lambda d: raise_count(d["summary"]["pairs"], "total"),
    "decided": lambda d: raise_count(d["summary"]["pairs"], "decided"),
    "allowed": lambda d: raise_count(d["summary"]["pairs"], "allowed"),
    "pruned": lambda d: raise_count(d["summary"]["pairs"], "pruned"),
    "indeterminate": lambda d: raise_count(d["summary"]["pairs"], "indeterminate"),
    "by relation": lambda d: d["summary"].update(by_relation={"separated": 1}),
    "surfaces only": lambda d: d["summary"].update(surfaces_only=1),
    "file": lambda d: d["bodies"][0].update(sha256="0" * 64),
    "another file": lambda d: d["bodies"][0].update(file=d["bodies"][1]["file"]),
    "pose": lambda d: d["bodies"][0].update(
        transform=[1, 0, 0, 9, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]
    ),
    "no solid": lambda d: d["bodies"][0]["health"].update(solid=False),
    "no findings": lambda d: d.update(findings=[]),
    "twice": lambda d: d["findings"].append(d["findings"][0]),
    "tolerance": lambda d: d["findings"][0].update(tolerance=10.0),
    "severity": lambda d: d["findings"][0].update(severity="none"),
    "swapped": lambda d: d["findings"][0].update(a="b", b="a"),
    "stranger": lambda d: d["findings"][0].update(b="c"),
}


@pytest.mark.parametrize(
    ("scale", "fault"), [(1e300, "its resolution is"), (1.5e308, "a coordinate is not finite")]
)
def test_a_placement_out_of_range_proves_nothing(scale: float, fault: str) -> None:
    document = report_of("boxes-apart")
    document["findings"] = []
    document["bodies"][1]["transform"] = [
        *(scale, scale, 0, 9),
        *(-scale, scale, 0, 0),
        *(0, 0, scale, 0),
        *(0, 0, 0, 1),
    ]
    faults = verified(document).faults
    assert any(fault in said for said in faults)
    assert any("not apart by their boxes" in said for said in faults)


@pytest.mark.parametrize("setting", ["tolerance", "clearance"])
def test_a_number_out_of_range_is_no_length(setting: str) -> None:
    document = report_of("box-in-arm")
    document["settings"][setting] = 10**400
    with pytest.raises(Rejected, match="out of range"):
        verified(document)


@pytest.mark.parametrize("lie", FORGED)
def test_a_lie_about_the_rest_is_found(lie: str) -> None:
    document = report_of("box-in-arm")
    FORGED[lie](document)
    assert not verified(document).accepted


def test_a_dropped_finding_is_missed() -> None:
    document = report_of("box-in-arm")
    document["findings"] = []
    document["summary"]["pairs"].update(total=1, pruned=1, decided=0)
    document["summary"].update(verdict="pass", by_relation={"separated": 1})
    assert verified(document).faults


@pytest.mark.parametrize("name", ["boxes-apart", "boxes-overlap"])
def test_bodies_of_different_units_have_no_relation(name: str) -> None:
    document = report_of(name)
    document["bodies"][0]["units"] = "m"
    found = verified(document)
    assert [one.outcome for one in found.findings] == ["rejected"]
    assert "different units" in str(found.findings[0].reason)
    document["findings"] = []
    document["bodies"][1]["units"] = "mm"
    assert "0 pairs as indeterminate, not 1" in " ".join(verified(document).faults)


def test_without_a_certificate_nothing_is_certified() -> None:
    document = report_of("boxes-apart")
    document["findings"][0]["certificate"] = None
    found = verified(document)
    assert is_certified(found, document)  # they were asked for
    assert not found.accepted
    for effect in document["effects"]:
        effect["asked_by"] = []
    assert not is_certified(verified(document), document)


@pytest.mark.parametrize("document", [None, [], {}, {"schema": "satcheck.report/1"}, 3, "x"])
def test_what_is_no_report_is_refused(document: Any) -> None:
    with pytest.raises(Rejected):
        verify(document, Path("/"))
