"""The pinned files belong to the calls, and the adapter reads every kind of document."""

from __future__ import annotations

import csv
import json

import pytest

from tests.contract.adapter import facts_of
from tests.contract.cases import DATA, GROUPS
from tests.contract.runs import PINNED, pinned, written


@pytest.mark.parametrize("group", GROUPS)
def test_every_call_is_pinned_and_nothing_else(group: str) -> None:
    names = [call.name for call in GROUPS[group]()]
    assert len(set(names)) == len(names)
    assert set(pinned(group)) == set(names)


@pytest.mark.parametrize("group", GROUPS)
def test_a_pinned_file_is_as_it_is_written(group: str) -> None:
    text = (PINNED / f"{group}.json").read_text(encoding="utf-8")
    assert written(json.loads(text)) == text


def test_sources_name_files_that_are_there() -> None:
    with (DATA / "sources.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert rows
    assert [row["file"] for row in rows if not (DATA / row["file"]).is_file()] == []
    assert all(row["source"] and row["licence"] for row in rows)


def test_two_findings_of_a_pair_are_refused() -> None:
    finding = {"a": "x", "b": "y", "relation": "separated", "outcome": "accepted"}
    proven = {"depth": False, "mtv": False, "thickness": False}
    report = {
        "schema": "satcheck.verification/1",
        "accepted": True,
        "findings": [finding | proven] * 2,
        "faults": [],
    }
    with pytest.raises(ValueError, match=r"x \| y"):
        facts_of(json.dumps(report))


def test_no_document_has_no_facts() -> None:
    assert facts_of("") == {}
