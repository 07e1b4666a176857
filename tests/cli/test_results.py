"""`satcheck view` of results: what the results of a batch say."""

from __future__ import annotations

import csv
import json
import re
import shutil
from pathlib import Path

import pytest
from jsonschema import Draft202012Validator

from satcheck.cli.commands.schema import text
from satcheck.cli.formats.registry import formats
from satcheck.report.report import without_timings
from tests.cli.process import SAMPLES, Ran, satcheck

_HASH = re.compile('"[0-9a-f]{64}"')
# x of a box beside a pushed one, by the name of the scene. In this order they are ever worse.
SCENES = {"a": 9.0, "b": 0.5, "c": 0.0}


def write_scene(folder: Path, name: str, x: float) -> Path:
    path = folder / f"{name}.toml"
    path.write_text(
        'schema = "satcheck.scene/1"\n'
        '[[bodies]]\nid = "one"\nmesh = "box.obj"\n'
        f'[[bodies]]\nid = "two"\nmesh = "box_pushed.stl"\nposition = [{x}, 0, 0]\n'
    )
    return path


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A scene that passes, two that fail, one that is broken."""
    for name in ("box.obj", "box_pushed.stl"):
        shutil.copy(SAMPLES / name, tmp_path)
    for name, x in SCENES.items():
        write_scene(tmp_path, name, x)
    (tmp_path / "broken.toml").write_text("bodies = 1\n")
    return tmp_path


def batch(folder: Path, names: str, output: str, *options: str) -> Path:
    scenes = [f"{name}.toml" for name in names.split()]
    ran = satcheck("batch", *scenes, "-o", output, "--depth", *options, cwd=folder)
    assert "Traceback" not in ran.err
    return folder / output


def report(folder: Path, *arguments: str) -> Ran:
    given = () if {"-o", "--format"} & set(arguments) else ("--format", "table")
    return satcheck("view", *arguments, *given, cwd=folder)


def test_a_line_follows_its_schema(folder: Path) -> None:
    validator = Draft202012Validator(json.loads(text("result")))
    for line in batch(folder, "a b broken", "all.jsonl").read_text().splitlines():
        validator.validate(json.loads(line))


def test_the_table_lists_the_worst_scene_first(folder: Path) -> None:
    batch(folder, "a b c broken", "all.jsonl")
    ran = report(folder, "all.jsonl")
    rows = [line.split() for line in ran.out.splitlines() if ".toml  " in line]
    assert [row[0] for row in rows] == ["broken.toml", "c.toml", "b.toml"]
    assert "ERROR: 4 assets: 1 has errors (broken.toml), 2 fail (c.toml, b.toml), 1" in ran.out
    assert ran.code == 2


@pytest.mark.parametrize(
    ("names", "code"), [("a", 0), ("a b", 1), ("a b broken", 2), ("a broken", 2)]
)
def test_the_exit_code_is_that_of_each(names: str, code: int, folder: Path) -> None:
    batch(folder, names, "all.jsonl")
    assert report(folder, "all.jsonl").code == code
    assert report(folder, "all.jsonl", "--exit-zero").code == (0 if code == 1 else code)


@pytest.mark.parametrize("form", ["json", *formats(("reports",))])
def test_every_format_is_that_of_each(form: str, folder: Path) -> None:
    scenes = [f"{name}.toml" for name in ["a", "b", "broken", "c"]]
    batch(folder, "a b broken c", "all.jsonl")
    expected = satcheck("batch", *scenes, "--depth", "--format", form, cwd=folder)
    found = report(folder, "all.jsonl", "--format", form)
    assert found.code == expected.code
    assert comparable(found.out, form) == comparable(expected.out, form)


def comparable(document: str, form: str) -> object:
    """A batch writes no times, and the SHA-256 of every mesh."""
    if form == "json":
        return without_timings(json.loads(document))
    return [_HASH.sub("null", line) for line in document.splitlines()]


def test_shards_are_one_report(folder: Path) -> None:
    batch(folder, "a b broken c", "all.jsonl")
    batch(folder, "b broken", "1.jsonl")
    batch(folder, "c a", "2.jsonl")
    whole = report(folder, "all.jsonl", "--format", "json")
    assert report(folder, "2.jsonl", "1.jsonl", "--format", "json") == whole
    assert report(folder, "2.jsonl", "1.jsonl", "all.jsonl", "--format", "json") == whole
    Draft202012Validator(json.loads(text("assets"))).validate(whole.document)


def test_top_is_the_worst_of_every_format_and_all_count(folder: Path) -> None:
    batch(folder, "a b c", "all.jsonl")
    document = report(folder, "all.jsonl", "--top", "1", "--format", "json").document
    assert [each["file"] for each in document["assets"]] == ["c.toml"]
    assert document["counts"]["total"] == 3
    rows = list(
        csv.DictReader(
            report(folder, "all.jsonl", "--top", "2", "--format", "csv").out.splitlines()
        )
    )
    assert [row["\ufeffasset"] for row in rows] == ["c.toml", "b.toml"]
    table = report(folder, "all.jsonl", "--top", "1").out
    assert "1 more asset not shown: see --top" in table
    assert "FAIL: 3 assets: 2 fail" in table


def test_a_batch_that_did_not_finish_is_no_pass(folder: Path) -> None:
    path = batch(folder, "a", "all.jsonl")
    with path.open("ab") as file:
        file.write(b'{"schema":')
    table = report(folder, "all.jsonl")
    assert "INCOMPLETE: 1 asset: 1 passes." in table.out
    assert "warning: all.jsonl: the batch did not finish" in table.out
    assert table.code == 3
    document = report(folder, "all.jsonl", "--format", "json").document
    assert document["verdict"] == "incomplete"
    assert [issue["code"] for issue in document["issues"]] == ["unfinished-results"]
    rows = report(folder, "all.jsonl", "--format", "csv")
    assert (rows.code, "did not finish" in rows.err) == (3, True)


def test_a_scene_of_the_manifest_without_a_result_is_no_pass(folder: Path) -> None:
    batch(folder, "a", "all.jsonl")
    (folder / "list").write_text("a.toml\n")
    assert report(folder, "all.jsonl", "--manifest", "list").code == 0
    (folder / "list").write_text("a.toml\nb.toml\n")
    ran = report(folder, "all.jsonl", "--manifest", "list")
    assert ran.code == 3
    assert "b.toml: no result in these files [missing-results]" in ran.out


def test_a_file_of_another_kind_is_an_error(folder: Path) -> None:
    shutil.copy(folder / "box.obj", folder / "box.jsonl")
    ran = report(folder, "box.jsonl")
    assert ran.code == 2
    assert "error: box.jsonl:1: no result of a batch [bad-result]" in ran.out


def test_a_missing_file_is_an_error(folder: Path) -> None:
    ran = report(folder, "gone.jsonl")
    assert (ran.code, ran.out) == (2, "")
    assert "gone.jsonl" in ran.err


def test_the_report_is_written_to_a_file(folder: Path) -> None:
    batch(folder, "a b", "all.jsonl")
    ran = report(folder, "all.jsonl", "-o", "report.sarif")
    assert json.loads((folder / "report.sarif").read_text())["runs"][0]["results"]
    assert "Report: report.sarif" in ran.err
    assert report(folder, "all.jsonl", "-o", "all.jsonl").code == 2
