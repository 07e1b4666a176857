"""Results of shards become those of the whole batch."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from satcheck.audit.batch.stored import merge
from satcheck.core.errors import SatcheckError


def lines(*names: str, verdict: str = "pass") -> str:
    results = ({"files": [name], "key": None, "verdict": verdict} for name in names)
    return "".join(json.dumps(result) + "\n" for result in results)


def shards(folder: Path, *texts: str) -> list[Path]:
    paths = [folder / f"{number}.jsonl" for number in range(len(texts))]
    for path, text in zip(paths, texts, strict=True):
        path.write_text(text)
    return paths


def refused(folder: Path, *texts: str) -> SatcheckError:
    out = folder / "all.jsonl"
    with pytest.raises(SatcheckError) as caught:
        merge(shards(folder, *texts), out)
    assert not out.exists()
    return caught.value


def test_lines_are_in_the_order_of_names(tmp_path: Path) -> None:
    """Of file names as Python sorts them, not of the lines as text."""
    texts = lines("a", "a/b", "\u00e9"), lines(), lines("A", 'a"b')
    merge(shards(tmp_path, *texts), tmp_path / "all.jsonl")
    merged = (tmp_path / "all.jsonl").read_text()
    assert merged == lines("A", "a", 'a"b', "a/b", "\u00e9")


def test_a_result_in_two_files_counts_once(tmp_path: Path) -> None:
    merge(shards(tmp_path, lines("a", "b"), lines("b", "c")), tmp_path / "all.jsonl")
    assert (tmp_path / "all.jsonl").read_text() == lines("a", "b", "c")


def test_two_answers_for_one_world_are_refused(tmp_path: Path) -> None:
    error = refused(tmp_path, lines("a"), lines("a", verdict="fail"))
    assert error.code == "results-differ"
    assert str(error) == "a: different results in several files"


@pytest.mark.parametrize("text", [lines("b", "a"), lines("a", "a"), lines("a")[:-1]])
def test_a_file_that_is_not_finished_is_refused(tmp_path: Path, text: str) -> None:
    assert refused(tmp_path, lines("c"), text).code == "unfinished-results"


def test_a_file_of_another_kind_is_refused(tmp_path: Path) -> None:
    error = refused(tmp_path, lines("a") + "[]\n")
    assert error.code == "bad-results"
    assert "0.jsonl:2" in str(error)


def test_a_missing_shard_is_refused(tmp_path: Path) -> None:
    with pytest.raises(SatcheckError) as caught:
        merge([*shards(tmp_path, lines("a")), tmp_path / "none"], tmp_path / "all.jsonl")
    assert caught.value.code == "unreadable-file"


def test_more_shards_than_a_process_may_open(tmp_path: Path) -> None:
    names = [f"{number:04}" for number in range(3000)]
    merge(shards(tmp_path, *map(lines, names)), tmp_path / "all.jsonl")
    assert (tmp_path / "all.jsonl").read_text() == lines(*names)


def test_a_part_and_a_file_beside_its_part_are_refused(tmp_path: Path) -> None:
    (path,) = shards(tmp_path, lines("a"))
    part = path.with_name("0.jsonl.part")
    part.write_text(lines("b"))
    for each in (path, part):
        with pytest.raises(SatcheckError) as caught:
            merge([each], tmp_path / "all.jsonl")
        assert caught.value.code == "unfinished-results"


def test_names_that_are_no_text(tmp_path: Path) -> None:
    text = json.dumps({"files": ["\udcff.obj"], "key": None}) + "\n"
    merge(shards(tmp_path, text), tmp_path / "all.jsonl")
    assert (tmp_path / "all.jsonl").read_text() == text
