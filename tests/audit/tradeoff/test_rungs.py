"""How several rungs are named at once."""

from __future__ import annotations

import pytest

from satcheck.audit.tradeoff import RUNGS, labels_of


@pytest.mark.parametrize(
    "labels",
    [
        "",
        "aabb",
        "aabb, obb",
        "parts 0.5 .. 0.01",
        "obb, parts 0.2 .. 0.1, exact",
        "parts 0.5, parts 0.1, parts 0.02 .. 0.01",
        "parts 0.01, exact",
    ],
)
def test_neighbouring_thresholds_are_one(labels: str) -> None:
    order = [rung.label for rung in RUNGS]
    chosen = []
    for label in filter(None, labels.split(", ")):
        first, _, last = label.partition(" .. ")
        ends = order.index(first), order.index(f"parts {last}" if last else first)
        chosen += RUNGS[ends[0] : ends[1] + 1]
    assert labels_of(chosen[::-1]) == labels
