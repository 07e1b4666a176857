"""Results files, read back: in order, a result for each world, and what is wrong with them."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import pytest

from satcheck.audit.batch.check_world import lost_asset
from satcheck.audit.batch.results import ResultsFile
from satcheck.audit.batch.stored import Stored, StoredResults, least_of
from satcheck.core.errors import SatcheckError
from satcheck.core.steps import Loss
from satcheck.report.assets import AssetVerdict, Result
from satcheck.report.json import line_of
from tests.cli.reports import PENETRATING, report


def line(*files: str, key: str | None = "0", reason: str = "lost") -> bytes:
    report = lost_asset(files[0], Loss("worker-died", reason)).report
    made = None if key is None else key * 64
    result = Result(files=files, key=made, verdict="incomplete", inputs=(), report=report)
    return line_of(result)


def write(path: Path, *lines: bytes) -> Path:
    path.write_bytes(b"".join(lines))
    return path


def read(*paths: Path) -> tuple[list[Stored], list[str], AssetVerdict]:
    with StoredResults(paths) as results:
        listed = list(results)
        assert len(listed) == len(results)
        assert list(results) == listed
        return listed, [issue.code for issue in results.issues], least_of(results.issues)


def reason(stored: Stored) -> str:
    return stored.asset.report.issues[0].message


def names(listed: Sequence[Stored]) -> list[str]:
    return [each.asset.file for each in listed]


def test_shards_are_one_in_the_order_of_names(tmp_path: Path) -> None:
    one = write(tmp_path / "1", line("a"), line("c"), line("c", "b"))
    two = write(tmp_path / "2", line("b"), line("d"))
    listed, issues, least = read(two, one)
    assert names(listed) == ["a", "b", "c", "c, b", "d"]
    assert (issues, least) == ([], "pass")


def test_of_a_batch_under_way_the_part_is_read(tmp_path: Path) -> None:
    path = tmp_path / "results"
    with ResultsFile(path) as results:
        results.append([(("b",), line("b")), (("a",), line("a"))])
        listed, issues, least = read(path)
        assert (names(listed), issues, least) == (["a", "b"], ["unfinished-results"], "incomplete")
        results.finish([("a",), ("b",)])
    listed, issues, least = read(path)
    assert (names(listed), issues, least) == (["a", "b"], [], "pass")


def test_a_batch_that_finishes_while_it_is_read_ends_the_reading(tmp_path: Path) -> None:
    """Its part is emptied."""
    part = write(tmp_path / "1.part", *(line(name) for name in "abc"))
    with StoredResults([tmp_path / "1"]) as results:
        part.write_bytes(b"")
        assert list(results) == []


def test_of_a_resumed_batch_the_part_counts(tmp_path: Path) -> None:
    path = write(tmp_path / "1", line("a", reason="old"), line("b", reason="old"))
    write(tmp_path / "1.part", line("b", reason="new"))
    listed, issues, _ = read(path)
    assert [reason(each)[-3:] for each in listed] == ["old", "new"]
    assert issues == ["unfinished-results"]


@pytest.mark.parametrize(
    "lines",
    [(line("a"), line("b")[:-1]), (line("a"), line("b")[:70]), (line("b"), line("a"))],
    ids=["cut at the end", "cut", "not sorted"],
)
def test_a_batch_that_did_not_finish(lines: tuple[bytes, ...], tmp_path: Path) -> None:
    """Its results are read as far as they go, and it is no pass."""
    listed, issues, least = read(write(tmp_path / "1", *lines))
    assert names(listed) == ["a"] if lines[0] == line("a") else ["a", "b"]
    assert (issues, least) == (["unfinished-results"], "incomplete")


def test_in_one_file_the_last_result_counts(tmp_path: Path) -> None:
    path = write(tmp_path / "1", line("a"), line("b"), line("a", key="1", reason="newer"))
    listed, issues, _ = read(path)
    assert names(listed) == ["a", "b"]
    assert "newer" in reason(listed[0])
    assert issues == ["unfinished-results"]


@pytest.mark.parametrize(
    ("keys", "counts", "issues"),
    [
        ("00", "file 1", []),
        ("01", "file 1", ["different-results"]),
        ("0-", "file 1", ["different-results"]),
        ("-0", "file 1", ["different-results"]),
    ],
)
def test_a_world_in_two_files(keys: str, counts: str, issues: list[str], tmp_path: Path) -> None:
    """-: a check that was lost."""
    paths = [
        write(tmp_path / f"{n}", line("a", key=None if key == "-" else key, reason=f"file {n}"))
        for n, key in enumerate(keys)
    ]
    listed, found, least = read(*paths)
    assert len(listed) == 1
    assert counts in reason(listed[0])
    assert (found, least) == (issues, "pass")


def test_lines_that_are_no_results_are_errors(tmp_path: Path) -> None:
    """Of any kind; the other results are there."""
    of_other_version = line("b").replace(b'"exempt":{', b'"exempt":{"more":1,')
    path = write(tmp_path / "1", line("a"), of_other_version, b"{\n", b"\xff\n", line("c"))
    listed, issues, least = read(path)
    assert [each.asset.verdict for each in listed] == ["incomplete", "error", "incomplete"]
    assert "no result of this version" in reason(listed[1])
    assert (issues, least) == (["bad-result"] * 2, "error")


def test_a_finding_about_no_body_is_an_error(tmp_path: Path) -> None:
    result = Result(
        files=("a",), key=None, verdict="fail", inputs=(), report=report(PENETRATING, bodies=())
    )
    (stored,), _, _ = read(write(tmp_path / "1", line_of(result)))
    assert stored.asset.verdict == "error"
    assert "no body is block" in reason(stored)


def test_a_result_about_no_file_is_none(tmp_path: Path) -> None:
    bad = line("a").replace(b'"files":["a"]', b'"files":[]')
    assert read(write(tmp_path / "1", bad, line("b")))[1] == ["bad-result"]


def test_only_some_bad_lines_are_named(tmp_path: Path) -> None:
    with StoredResults([write(tmp_path / "1", b"no\n" * 25)]) as results:
        assert [issue.line for issue in results.issues] == [*range(1, 11), None, None]
        assert "15 more lines" in results.issues[10].message
        assert results.issues[11].code == "no-results"


def test_no_result_is_no_pass(tmp_path: Path) -> None:
    assert read(write(tmp_path / "1")) == ([], ["no-results"], "incomplete")


@pytest.mark.parametrize(
    ("expected", "told"),
    [
        ([("a",), ("c", "b")], None),
        ([("a",), ("b",)], "b: no result"),
        ([("b",), ("a",), ("c",)], "b and 1 more: no result"),
    ],
)
def test_a_world_that_is_expected_and_has_no_result(
    expected: list[tuple[str, ...]], told: str | None, tmp_path: Path
) -> None:
    path = write(tmp_path / "1", line("a"), line("c", "b"))
    with StoredResults([path], iter(expected)) as results:
        messages = [issue.message for issue in results.issues]
        assert messages == ([] if told is None else [f"{told} in these files"])
        assert least_of(results.issues) == ("pass" if told is None else "incomplete")


def test_names_that_are_not_utf8(tmp_path: Path) -> None:
    (stored,), issues, _ = read(write(tmp_path / "1", line("a\udcff")))
    assert (stored.files, issues) == (("a\udcff",), [])


@pytest.mark.parametrize(
    "value",
    ['"\\ud800"', '"\\udcff\\ud800"', "[" * 100_000 + "]" * 100_000],
    ids=["half", "mixed", "deep"],
)
def test_values_that_nothing_can_write_are_no_result(value: str, tmp_path: Path) -> None:
    bad = line("a").replace(b'"key":', f'"more":{value},"key":'.encode())
    listed, issues, _ = read(write(tmp_path / "1", bad, line("b")))
    assert (names(listed), issues) == (["b"], ["bad-result"])


def test_a_file_that_is_not_there(tmp_path: Path) -> None:
    with pytest.raises(SatcheckError) as caught, StoredResults([tmp_path / "gone"]):
        pass
    assert caught.value.code == "unreadable-file"


def test_lines_that_are_longer_than_a_block(tmp_path: Path) -> None:
    lines = [line(f"{n:03}", reason="x" * 10_000) for n in range(40)]
    for order in (lines, lines[::-1]):
        listed, _, _ = read(write(tmp_path / "1", *order))
        assert names(listed) == [f"{n:03}" for n in range(40)]


def test_a_part_beside_the_file_behind_a_link_is_seen(tmp_path: Path) -> None:
    write(tmp_path / "results", line("a"))
    write(tmp_path / "results.part", line("b"))
    (tmp_path / "link").symlink_to("results")
    listed, issues, least = read(tmp_path / "link")
    assert [each.files for each in listed] == [("a",), ("b",)]
    assert (issues, least) == (["unfinished-results"], "incomplete")
