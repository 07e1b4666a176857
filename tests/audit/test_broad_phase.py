"""The sweep against all pairs, on both of its paths."""

from __future__ import annotations

import random

import pytest

from satcheck.audit import broad_phase
from satcheck.audit.boxes import box_gap


def random_boxes(seed, count, span):
    random_source = random.Random(seed)
    boxes = []
    for _ in range(count):
        low = [random_source.uniform(0, span) for _ in range(3)]
        boxes.append((tuple(low), tuple(c + random_source.uniform(0, 1) for c in low)))
    return boxes


def all_pairs(boxes, asked):
    return [
        (i, j)
        for i in range(len(boxes))
        for j in range(i + 1, len(boxes))
        if box_gap(boxes[i], boxes[j]) <= asked[i] + asked[j]
    ]


@pytest.mark.parametrize("array_sweep", [0, 10**9], ids=["arrays", "plain"])
@pytest.mark.parametrize("asked", [0.0, 0.25])
@pytest.mark.parametrize(("seed", "span"), [(1, 2), (2, 5), (3, 20)])
def test_sweep_finds_exactly_the_close_pairs(monkeypatch, array_sweep, asked, seed, span):
    monkeypatch.setattr(broad_phase, "ARRAY_SWEEP", array_sweep)
    boxes = random_boxes(seed, 90, span)
    reach = [asked] * len(boxes)
    assert broad_phase.close_pairs(boxes, reach) == all_pairs(boxes, reach)


@pytest.mark.parametrize("array_sweep", [0, 10**9], ids=["arrays", "plain"])
def test_touching_boxes_are_close(monkeypatch, array_sweep):
    monkeypatch.setattr(broad_phase, "ARRAY_SWEEP", array_sweep)
    row = [((float(k), 0.0, 0.0), (k + 1.0, 1.0, 1.0)) for k in range(5)]
    assert broad_phase.close_pairs(row, [0.0] * 5) == [(0, 1), (1, 2), (2, 3), (3, 4)]


def test_one_box_has_no_pair():
    assert broad_phase.close_pairs([((0, 0, 0), (1, 1, 1))], [0.0]) == []
