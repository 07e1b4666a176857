"""`satcheck report --against`: the difference of two batches."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import pytest
from jsonschema import Draft202012Validator

from satcheck.cli.formats.schema import text
from tests.cli.process import SAMPLES, Ran, satcheck

# x of a box beside a pushed one, in the older and in the newer batch.
OLD = {"same": 0.5, "worse": 0.5, "better": 0.2, "gone": 0.0, "new": 9.0, "removed": 0.0}
NEW = {"same": 0.5, "worse": 0.2, "better": 0.5, "gone": 9.0, "new": 0.0, "added": 9.0}


def scene(folder: Path, name: str, x: float) -> None:
    (folder / f"{name}.toml").write_text(
        'schema = "satcheck.scene/1"\n'
        '[[bodies]]\nid = "one"\nmesh = "box.obj"\n'
        f'[[bodies]]\nid = "two"\nmesh = "box_pushed.stl"\nposition = [{x}, 0, 0]\n'
    )


def batch(folder: Path, output: str, **scenes: float) -> None:
    for name, x in scenes.items():
        scene(folder, name, x)
    names = [f"{name}.toml" for name in scenes]
    satcheck("batch", *names, "--depth", "-o", output, cwd=folder)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    for name in ("box.obj", "box_pushed.stl"):
        shutil.copy(SAMPLES / name, tmp_path)
    return tmp_path


def compare(folder: Path, *arguments: str) -> Ran:
    return satcheck("report", "new.jsonl", "--against", "old.jsonl", *arguments, cwd=folder)


@pytest.fixture
def both(folder: Path) -> Path:
    batch(folder, "old.jsonl", **OLD)
    batch(folder, "new.jsonl", **NEW)
    return folder


def test_the_document_lists_what_changed(both: Path) -> None:
    ran = compare(both, "--format", "json")
    Draft202012Validator(json.loads(text("difference"))).validate(ran.document)
    found = {
        change["file"].removesuffix(".toml"): [each["state"] for each in change["findings"]]
        for change in ran.document["changes"]
    }
    assert found == {
        **{name: [name] for name in ("worse", "better", "gone", "new")},
        "added": [],
        "removed": [],
    }
    assert ran.document["scenes"] == {"added": 1, "removed": 1, "changed": 4, "same": 1}
    assert ran.document["findings"] == {
        **{"new": 1, "worse": 1, "undecided": 0, "unchecked": 0},
        **{"better": 1, "gone": 1, "unchanged": 1},
    }
    assert (ran.document["verdict"], ran.code) == ("fail", 1)


def test_the_table_lists_the_worst_first(both: Path) -> None:
    out = compare(both).out
    rows = [[cell.strip() for cell in line.split("│")[1:-1]] for line in out.splitlines()]
    changes = [(row[0], row[1]) for row in rows if len(row) == 6][1:]
    assert changes[:4] == [
        *(("new", "new.toml"), ("worse", "worse.toml")),
        *(("better", "better.toml"), ("gone", "gone.toml")),
    ]
    # Then scenes whose verdict changed.
    assert {name for _, name in changes[4:]} == {
        "new.toml", "gone.toml", "added.toml", "removed.toml"
    }  # fmt: skip
    assert "penetrating, depth 0.5, thickness 0.5" in out
    assert "penetrating, depth 0.8, thickness 0.8" in out
    assert out.splitlines()[-1] == (
        "FAIL: failing findings: 1 new, 1 worse, 1 better, 1 gone, 1 unchanged; "
        "scenes: 1 added, 1 removed, 4 changed, 1 same."
    )


def test_markdown_has_the_same_rows(both: Path) -> None:
    lines = compare(both, "--format", "markdown", "--top", "2").out.splitlines()
    rows = [line for line in lines if line.startswith("| ")]
    assert [row.split(" | ")[0] for row in rows] == ["| change", "| new", "| worse"]
    assert "6 more changes not shown" in "".join(lines)


def test_a_name_is_no_markup(folder: Path) -> None:
    name = "a|<b>*c"
    batch(folder, "old.jsonl", **{name: 9.0})
    batch(folder, "new.jsonl", **{name: 0.0})
    out = compare(folder, "--format", "markdown").out
    assert r"a\|\<b\>\*c.toml" in out


@pytest.mark.parametrize(
    ("old", "new", "code"),
    [(0.0, 0.5, 0), (0.5, 0.5, 0), (0.0, 9.0, 0), (0.5, 0.0, 1), (9.0, 0.0, 1)],
)
def test_only_what_is_new_or_worse_fails(old: float, new: float, code: int, folder: Path) -> None:
    batch(folder, "old.jsonl", a=old)
    batch(folder, "new.jsonl", a=new)
    assert compare(folder).code == code
    assert compare(folder, "--exit-zero").code == 0


def test_a_scene_that_cannot_be_read_any_more_is_an_error(folder: Path) -> None:
    batch(folder, "old.jsonl", a=0.0)
    (folder / "a.toml").write_text("bodies = 1\n")
    satcheck("batch", "a.toml", "-o", "new.jsonl", cwd=folder)
    ran = compare(folder, "--format", "json")
    assert ran.code == 2
    (change,) = ran.document["changes"]
    assert (change["before"], change["now"]) == ("fail", "error")
    assert [each["state"] for each in change["findings"]] == ["unchecked"]


def test_a_new_scene_that_fails_is_new(folder: Path) -> None:
    batch(folder, "old.jsonl", a=9.0)
    batch(folder, "new.jsonl", a=9.0, b=0.0)
    ran = compare(folder, "--format", "json")
    assert (ran.code, ran.document["findings"]["new"]) == (1, 1)


def test_an_unfinished_batch_is_incomplete(folder: Path) -> None:
    batch(folder, "old.jsonl", a=9.0)
    batch(folder, "new.jsonl", a=9.0)
    with (folder / "old.jsonl").open("ab") as file:
        file.write(b"{")
    ran = compare(folder)
    assert ran.code == 3
    assert "old.jsonl: the batch did not finish" in ran.out


def test_shards_of_both_are_joined(both: Path) -> None:
    whole = compare(both, "--format", "json").document
    lines = (both / "old.jsonl").read_bytes().splitlines(keepends=True)
    for name, part in (("1", lines[:2]), ("2", lines[2:])):
        (both / name).write_bytes(b"".join(part))
    ran = satcheck(
        *("report", "new.jsonl", "--against", "1", "--against", "2", "--format", "json"), cwd=both
    )
    assert ran.document == whole


def test_other_formats_are_refused(folder: Path) -> None:
    batch(folder, "old.jsonl", a=9.0)
    batch(folder, "new.jsonl", a=9.0)
    assert "table, json, markdown" in compare(folder, "--format", "sarif").err
    assert compare(folder, "--sql", "SELECT 1").code == 2
