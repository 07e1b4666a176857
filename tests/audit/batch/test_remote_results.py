"""Results at a URL survive what local ones survive."""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import fsspec
import pytest

from satcheck.audit.batch.options import World
from satcheck.audit.batch.remote import local_results
from satcheck.audit.batch.results import PART, Head, ResultsFile
from satcheck.core.errors import SatcheckError
from tests.audit.batch.test_results import everything, result

URL = "memory://bucket/r.jsonl"
A, B = (result(name)[1] for name in "ab")


@pytest.fixture
def memory(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Iterator[Any]:
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    system = fsspec.filesystem("memory")
    yield system
    system.store.clear()


def stored(memory: Any) -> dict[str, bytes]:
    return {name: memory.cat_file(name) for name in memory.find("/bucket")}


def left(folder: Path) -> list[str]:
    return [each.name for each in folder.rglob("*")]


def test_a_finished_batch_is_at_the_url(memory: Any, tmp_path: Path) -> None:
    with local_results(URL, PART) as path, ResultsFile(path) as results:
        results.append([result("b"), result("a")])
        results.finish([("a",), ("b",)])
    assert stored(memory) == {"/bucket/r.jsonl": A + B}
    assert left(tmp_path) == []


def interrupted(*names: str) -> list[World]:
    """What a run has found, which is ended after it has added these results."""
    kept: list[Head] = []

    def run() -> None:
        with local_results(URL, PART) as path, ResultsFile(path) as results:
            kept.extend(results.keep(everything))
            results.append(map(result, names))
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        run()
    return [head.files for head in kept]


def test_an_ended_run_leaves_its_part(memory: Any, tmp_path: Path) -> None:
    interrupted("b")
    assert stored(memory) == {"/bucket/r.jsonl.part": B}
    assert left(tmp_path) == []
    assert interrupted("a") == [("b",)]
    assert stored(memory) == {"/bucket/r.jsonl.part": B + A}


def test_a_run_that_adds_nothing_leaves_nothing(memory: Any) -> None:
    interrupted()
    assert stored(memory) == {}


def test_a_finished_batch_stays_until_the_next_one_has_finished(memory: Any) -> None:
    memory.pipe_file("/bucket/r.jsonl", A)
    assert interrupted("b") == [("a",)]
    assert stored(memory) == {"/bucket/r.jsonl": A, "/bucket/r.jsonl.part": B}


def test_an_upload_that_fails_says_where_the_results_are(
    memory: Any, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    def full(*_: object) -> None:
        raise OSError("quota")

    def run() -> None:
        with local_results(URL, PART) as path, ResultsFile(path) as results:
            results.append([result("a")])
            results.finish([("a",)])
            monkeypatch.setattr(memory, "put_file", full)

    with pytest.raises(SatcheckError) as caught:
        run()
    assert caught.value.code == "cannot-write"
    assert "quota" in str(caught.value)
    (place,) = tmp_path.rglob("results.jsonl")
    assert str(place) in str(caught.value)
    assert place.read_bytes() == A


def test_what_cannot_be_written_fails_before_the_work(
    memory: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refused(*_: object) -> None:
        raise NotImplementedError

    monkeypatch.setattr(memory, "put_file", refused)
    with pytest.raises(SatcheckError) as caught, local_results(URL, PART):
        pass
    assert caught.value.code == "cannot-write"
