"""Results at a URL survive what local ones survive."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import fsspec
import pytest

from satcheck.audit.batch.check_options import World
from satcheck.audit.batch.results import Head, ResultsFile
from satcheck.audit.batch.spool import Spool
from satcheck.core.errors import SatcheckError
from satcheck.decompose.cache import DIRECTORY_VARIABLE
from tests.audit.batch.test_results import everything, result

URL = "memory://bucket/r.jsonl"
A, B, C = (result(name)[1] for name in "abc")


@pytest.fixture
def memory(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Iterator[Any]:
    monkeypatch.setenv(DIRECTORY_VARIABLE, str(tmp_path))
    system = fsspec.filesystem("memory")
    yield system
    system.store.clear()


def stored(memory: Any) -> dict[str, bytes]:
    return {name: memory.cat_file(name) for name in memory.find("/bucket")}


def spooled(folder: Path) -> list[str]:
    return [each.name for each in folder.rglob("*") if each.is_file() and each.suffix != ".lock"]


def test_a_finished_batch_is_at_the_url(memory: Any, tmp_path: Path) -> None:
    with Spool(URL) as spool, ResultsFile(spool.path) as results:
        results.append([result("b"), result("a")])
        results.finish([("a",), ("b",)])
    assert stored(memory) == {"/bucket/r.jsonl": A + B}
    assert spooled(tmp_path) == []


def interrupted(*names: str) -> list[World]:
    """What a run has found, which is ended after it has added these results."""
    kept: list[Head] = []

    def run() -> None:
        with Spool(URL) as spool, ResultsFile(spool.path) as results:
            kept.extend(results.keep(everything))
            results.append(map(result, names))
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        run()
    return [head.files for head in kept]


def test_an_ended_run_leaves_its_part(memory: Any, tmp_path: Path) -> None:
    interrupted("b")
    assert stored(memory) == {"/bucket/r.jsonl.part": B}
    assert spooled(tmp_path) == []
    assert interrupted("a") == [("b",)]
    assert stored(memory) == {"/bucket/r.jsonl.part": B + A}


def test_a_run_that_adds_nothing_leaves_nothing(memory: Any) -> None:
    interrupted()
    assert stored(memory) == {}


def test_a_finished_batch_stays_until_the_next_one_has_finished(memory: Any) -> None:
    memory.pipe_file("/bucket/r.jsonl", A)
    assert interrupted("b") == [("a",)]
    assert stored(memory) == {"/bucket/r.jsonl": A, "/bucket/r.jsonl.part": B}


def killed(*names: str) -> None:
    """As after the death of the process: the spool stays, and its part was uploaded once."""
    spool = Spool(URL)
    spool.__enter__()
    with ResultsFile(spool.path) as results:
        list(results.keep(everything))
        results.append(map(result, names))
    spool._lock.release()


def test_a_killed_run_is_continued_on_its_machine(memory: Any) -> None:
    killed("a")
    assert stored(memory) == {"/bucket/r.jsonl.part": b""}
    assert interrupted("b") == [("a",)]
    assert stored(memory) == {"/bucket/r.jsonl.part": A + B}


def test_what_another_machine_has_added_is_kept(memory: Any) -> None:
    killed("a")
    memory.pipe_file("/bucket/r.jsonl.part", B)
    assert sorted(interrupted("c")) == [("a",), ("b",)]


@pytest.mark.usefixtures("memory")
def test_two_runs_do_not_write_one_url() -> None:
    first = Spool(URL)
    first.__enter__()
    with pytest.raises(SatcheckError) as caught, Spool(URL):
        pass
    assert caught.value.code == "results-in-use"
    first._lock.release()


def test_an_upload_that_fails_says_where_the_results_are(
    memory: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(*_: object) -> None:
        raise OSError("quota")

    spool = Spool(URL)
    spool.__enter__()
    with ResultsFile(spool.path) as results:
        results.append([result("a")])
        results.finish([("a",)])
    monkeypatch.setattr(memory, "put_file", full)
    with pytest.raises(SatcheckError) as caught:
        spool.__exit__(None, None, None)
    assert caught.value.code == "cannot-write"
    assert "quota" in str(caught.value)
    assert str(spool.path) in str(caught.value)
    assert spool.path.read_bytes() == A


def test_what_cannot_be_written_fails_before_the_work(
    memory: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refused(*_: object) -> None:
        raise NotImplementedError

    monkeypatch.setattr(memory, "put_file", refused)
    with pytest.raises(SatcheckError) as caught, Spool(URL):
        pass
    assert caught.value.code == "cannot-write"
