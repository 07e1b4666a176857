"""The file of results survives whatever ends the run that writes it."""

from __future__ import annotations

from pathlib import Path

import pytest

from satcheck.batch.results import ResultsFile
from satcheck.core.errors import SatcheckError


def result(name: str) -> tuple[tuple[str, ...], bytes]:
    line = f'{{"files":["{name}"],"key":null,"verdict":"pass","inputs":[]}}\n'
    return (name,), line.encode()


def test_a_finished_file_is_in_the_order_of_names(tmp_path: Path) -> None:
    path = tmp_path / "results.jsonl"
    with ResultsFile(path) as results:
        results.append([result("b")])
        results.append([result("c"), result("a")])
        results.finish([("c",), ("a",), ("b",)])
    assert path.read_bytes() == b"".join(line for _, line in map(result, "abc"))
    assert [each.name for each in tmp_path.iterdir()] == ["results.jsonl"]


def test_half_a_line_of_a_killed_run_is_cut_off(tmp_path: Path) -> None:
    path = tmp_path / "results.jsonl"
    whole = result("a")[1]
    path.write_bytes(whole + result("b")[1][:-7])
    with ResultsFile(path) as results:
        assert [head.files for head in results.known()] == [("a",)]
        assert path.read_bytes() == whole
        results.append([result("b")])
    assert path.read_bytes() == whole + result("b")[1]


def test_two_runs_do_not_write_one_file(tmp_path: Path) -> None:
    path = tmp_path / "results.jsonl"
    with ResultsFile(path), pytest.raises(SatcheckError) as caught, ResultsFile(path):
        pass
    assert caught.value.code == "results-in-use"


def test_a_file_of_another_kind_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "results.jsonl"
    path.write_text('{"bodies": []}\n')
    with ResultsFile(path) as results, pytest.raises(SatcheckError) as caught:
        list(results.known())
    assert caught.value.code == "bad-results"
    assert path.read_text() == '{"bodies": []}\n'
