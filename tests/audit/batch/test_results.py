"""The file of results survives whatever ends the run that writes it."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from satcheck.audit.batch.results import Head, ResultsFile
from satcheck.core.errors import SatcheckError
from tests.cli.process import on_posix


def result(name: str) -> tuple[tuple[str, ...], bytes]:
    line = f'{{"files":["{name}"],"key":null,"verdict":"pass","inputs":[]}}\n'
    return (name,), line.encode()


def everything(_: Head) -> bool:
    return True


def test_a_finished_file_is_in_the_order_of_names(tmp_path: Path) -> None:
    path = tmp_path / "results.jsonl"
    with ResultsFile(path) as results:
        results.append([result("b")])
        results.append([result("c"), result("a")])
        assert not path.exists()
        results.finish([("c",), ("a",), ("b",)])
    assert path.read_bytes() == b"".join(line for _, line in map(result, "abc"))
    assert [each.name for each in tmp_path.iterdir()] == ["results.jsonl"]


def test_half_a_line_of_a_killed_run_is_cut_off(tmp_path: Path) -> None:
    path = tmp_path / "results.jsonl"
    part = tmp_path / "results.jsonl.part"
    whole = result("a")[1]
    part.write_bytes(whole + result("b")[1][:-7])
    with ResultsFile(path) as results:
        assert [head.files for head in results.keep(everything)] == [("a",)]
        assert part.read_bytes() == whole
        results.append([result("b")])
    assert part.read_bytes() == whole + result("b")[1]


def test_a_finished_batch_stays_until_the_next_one_has_finished(tmp_path: Path) -> None:
    path = tmp_path / "results.jsonl"
    path.write_bytes(result("b")[1])
    with ResultsFile(path) as results:
        assert [head.files for head in results.keep(everything)] == [("b",)]
        results.append([result("a")])
        assert path.read_bytes() == result("b")[1]
    with ResultsFile(path) as results:
        assert [head.files for head in results.keep(everything)] == [("b",), ("a",)]
        results.finish([("a",), ("b",)])
    assert path.read_bytes() == result("a")[1] + result("b")[1]


def test_of_two_results_the_valid_one_is_kept(tmp_path: Path) -> None:
    """A run with other options was ended before it had finished."""
    path = tmp_path / "results.jsonl"
    valid = result("a")[1]
    path.write_bytes(valid)
    (tmp_path / "results.jsonl.part").write_bytes(valid.replace(b"pass", b"fail"))
    with ResultsFile(path) as results:
        assert len(list(results.keep(lambda head: head.verdict == "pass"))) == 1
        results.finish([("a",)])
    assert path.read_bytes() == valid


def test_a_run_that_adds_nothing_leaves_no_file(tmp_path: Path) -> None:
    with ResultsFile(tmp_path / "results.jsonl"):
        pass
    assert list(tmp_path.iterdir()) == []


def test_two_runs_do_not_write_one_file(tmp_path: Path) -> None:
    path = tmp_path / "results.jsonl"
    with ResultsFile(path), pytest.raises(SatcheckError) as caught, ResultsFile(path):
        pass
    assert caught.value.code == "results-in-use"


def test_a_file_of_another_kind_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "results.jsonl"
    path.write_text('{"bodies": []}\n')
    with ResultsFile(path) as results, pytest.raises(SatcheckError) as caught:
        list(results.keep(everything))
    assert caught.value.code == "bad-results"
    assert path.read_text() == '{"bodies": []}\n'


def test_two_runs_do_not_write_one_file_through_a_link(tmp_path: Path) -> None:
    (tmp_path / "link").symlink_to("results.jsonl")
    with (
        ResultsFile(tmp_path / "results.jsonl"),
        pytest.raises(SatcheckError) as caught,
        ResultsFile(tmp_path / "link"),
    ):
        pass
    assert caught.value.code == "results-in-use"


@on_posix
def test_a_pipe_is_no_place_for_results(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe")
    with pytest.raises(SatcheckError) as caught, ResultsFile(tmp_path / "pipe"):
        pass
    assert caught.value.code == "cannot-write"
    assert [each.name for each in tmp_path.iterdir()] == ["pipe"]
