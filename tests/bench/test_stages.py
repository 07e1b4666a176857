"""Stages of plain checks, added up."""

from __future__ import annotations

import pytest

from bench.accuracy.stages import OTHER, grouped, process, settled_by, stage_times
from tests.bench.made import record


def test_every_second_is_in_a_group() -> None:
    spent = grouped(record())
    assert sum(spent.values()) == pytest.approx(0.008)
    assert spent["hulls"] == 0.002
    assert spent[OTHER] == 0
    odd = record()
    odd["stages"] = [{"reading": 1.0, "a stage of its own": 3.0}]
    assert grouped(odd)[OTHER] == 3.0


def test_shares_of_a_kind_add_up_to_one() -> None:
    rows = stage_times([record(), record(relation="separated"), record(picked="hull"), record()])
    assert [row.pairs for row in rows] == [1, 1, 2]
    for row in rows:
        assert sum(row.shares.values()) == pytest.approx(1.0)
        assert row.shares["hulls"] == pytest.approx(0.25)
        assert row.total.median == pytest.approx(0.008)


def test_what_settled_a_pair_is_counted_and_a_process_by_its_median() -> None:
    records = [record(), record(picked="hull"), record(relation=None), record()]
    assert settled_by(records) == {"exact": 2, "hull": 1, "nothing": 1}
    records[0]["process"] = [{"cpu": s, "wall": s, "megabytes": s} for s in (9.0, 0.3, 0.2)]
    found = process(records, "cpu")
    assert found is not None
    assert (found.low, found.high) == (0.1, 0.3)
