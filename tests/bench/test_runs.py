"""A run that goes on where it ended."""

from __future__ import annotations

from pathlib import Path

import pytest

from bench.accuracy import runs
from bench.accuracy.case import Case, Effort

EFFORT = Effort(repeat=1, rung_seconds=1.0, pair_seconds=1.0, part_triangles=0)
CASES = [Case(name, ("a.obj", "b.obj")) for name in ("one", "two", "three")]


@pytest.fixture
def asked(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """The pairs that a child was started for; `two` fails."""
    seen: list[str] = []

    def child(case: Case, effort: Effort) -> runs.Record:
        assert effort == EFFORT
        seen.append(case.id)
        return {"failure": "made up"} if case.id == "two" else {"size": 1.0}

    monkeypatch.setattr(runs, "_ask_child", child)
    monkeypatch.setattr(runs, "_processes", lambda *_: [])
    return seen


def test_what_is_there_is_not_measured_again(tmp_path: Path, asked: list[str]) -> None:
    results, told = tmp_path / "results.jsonl", list[str]()
    runs.measure_all(CASES[:2], EFFORT, results, told.append)
    assert asked == ["one", "two"]
    runs.measure_all(CASES, EFFORT, results, told.append)
    assert asked == ["one", "two", "three"]
    assert [line.split()[:2] for line in told] == [["1/2", "one"], ["2/2", "two"], ["3/3", "three"]]
    header, records = runs.load(results)
    assert header["effort"]["part_triangles"] == 0
    assert {"python", "numpy", "coacd", "manifold3d", "satcheck"} == set(
        header["environment"]["versions"]
    )
    assert list(records) == ["one", "two", "three"]
    assert records["two"]["failure"] == "made up"
    assert "process" not in records["two"]


def test_what_was_measured_otherwise_is_not_gone_on_with(tmp_path: Path, asked: list[str]) -> None:
    results = tmp_path / "results.jsonl"
    runs.measure_all(CASES[:1], EFFORT, results, lambda _: None)
    other = Effort(repeat=2, rung_seconds=1.0, pair_seconds=1.0, part_triangles=0)
    with pytest.raises(runs.OtherRun, match="'repeat': 1"):
        runs.measure_all(CASES, other, results, lambda _: None)
    assert asked == ["one"]


def test_a_line_that_was_cut_off_is_measured_again(tmp_path: Path, asked: list[str]) -> None:
    results = tmp_path / "results.jsonl"
    runs.measure_all(CASES, EFFORT, results, lambda _: None)
    whole = results.read_text(encoding="utf-8")
    results.write_text(whole[:-10], encoding="utf-8")
    runs.measure_all(CASES, EFFORT, results, lambda _: None)
    assert asked == ["one", "two", "three", "three"]
    assert list(runs.load(results)[1]) == ["one", "two", "three"]
