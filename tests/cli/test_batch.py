"""`satcheck batch`: many scenes in processes that may die."""

from __future__ import annotations

import json
import shutil
from pathlib import Path
from typing import Any

import pytest

from satcheck.audit.batch.stored import merge
from tests.cli.process import SAMPLES, satcheck


@pytest.fixture
def scenes(tmp_path: Path) -> Path:
    """A folder with a scene that fails, one that passes, and one that is broken."""
    folder = tmp_path / "scenes"
    folder.mkdir()
    for name in ("box.obj", "box_pushed.stl"):
        shutil.copy(SAMPLES / name, folder)
    for name, x in (("hit", 0), ("free", 9)):
        (folder / f"{name}.toml").write_text(
            'schema = "satcheck.scene/1"\n'
            '[[bodies]]\nid = "a"\nmesh = "box.obj"\n'
            f'[[bodies]]\nid = "b"\nmesh = "box_pushed.stl"\nposition = [{x}, 0, 0]\n'
        )
    (folder / "broken.toml").write_text("bodies = 1\n")
    return folder


def results(path: Path) -> dict[str, Any]:
    lines = map(json.loads, path.read_text().splitlines())
    return {Path(line["files"][0]).name: line for line in lines}


def run(scenes: Path, *options: str) -> tuple[int, dict[str, Any]]:
    output = scenes.parent / "results.jsonl"
    ran = satcheck("batch", f"{scenes}/*.toml", "-o", str(output), *options)
    return ran.code, results(output)


def test_each_scene_has_its_own_result(scenes: Path) -> None:
    code, made = run(scenes)
    verdicts = {name: result["verdict"] for name, result in made.items()}
    assert verdicts == {"hit.toml": "fail", "free.toml": "pass", "broken.toml": "error"}
    assert list(made) == sorted(made)
    assert code == 2


def test_resume_checks_what_changed_and_nothing_else(scenes: Path) -> None:
    output = scenes.parent / "results.jsonl"
    run(scenes)
    before = output.read_bytes()
    again = satcheck("batch", f"{scenes}/*.toml", "-o", str(output), "--resume")
    assert "3 kept" in again.err
    assert output.read_bytes() == before
    shutil.copy(SAMPLES / "box.obj", scenes / "box_pushed.stl")  # no STL file any more
    again = satcheck("batch", f"{scenes}/*.toml", "-o", str(output), "--resume")
    assert "1 kept" in again.err
    assert results(output)["free.toml"]["verdict"] == "error"


def test_other_options_make_other_answers(scenes: Path) -> None:
    run(scenes)
    output = scenes.parent / "results.jsonl"
    more = ["--resume", "--clearance", "100"]
    again = satcheck("batch", f"{scenes}/*.toml", "-o", str(output), *more)
    assert "kept" not in again.err
    assert results(output)["free.toml"]["verdict"] == "fail"


def test_results_are_not_overwritten(scenes: Path) -> None:
    run(scenes)
    output = scenes.parent / "results.jsonl"
    again = satcheck("batch", f"{scenes}/*.toml", "-o", str(output))
    assert again.code == 2
    assert "results-exist" in again.err
    assert "--resume" in again.err


def test_a_manifest_that_names_nothing_is_told(tmp_path: Path) -> None:
    manifest = tmp_path / "manifest"
    manifest.write_text("\n\n")
    ran = satcheck("batch", "--manifest", str(manifest), "-o", str(tmp_path / "r.jsonl"))
    assert ran.code == 2
    assert f"{manifest}: it names no scene [no-assets]" in ran.err


def test_results_do_not_go_to_standard_output(scenes: Path, tmp_path: Path) -> None:
    ran = satcheck("batch", str(scenes), "-o", "-", "--format", "results", cwd=tmp_path)
    assert ran.code == 2
    assert "name it, -o results.jsonl" in ran.err
    assert not (tmp_path / "-").exists()


def test_a_manifest_names_files_that_are_one_scene(scenes: Path) -> None:
    output = scenes.parent / "results.jsonl"
    manifest = scenes.parent / "manifest"
    pair = json.dumps([f"{scenes}/box.obj", f"{scenes}/box_pushed.stl"])
    manifest.write_text(f"{scenes}/free.toml\n\n{pair}\n")
    ran = satcheck("batch", "--manifest", str(manifest), "-o", str(output))
    made = results(output)
    assert ran.code == 1
    assert {name: result["verdict"] for name, result in made.items()} == {
        "free.toml": "pass",
        "box.obj": "fail",
    }
    assert len(made["box.obj"]["files"]) == 2


def test_merged_shards_have_the_bytes_of_one_run(scenes: Path) -> None:
    """Most shards are empty: there are three scenes."""
    run(scenes)
    whole = scenes.parent / "results.jsonl"
    parts = [scenes.parent / f"{number}.jsonl" for number in range(1, 9)]
    for number, part in enumerate(parts, 1):
        satcheck("batch", f"{scenes}/*.toml", "-o", str(part), "--shard", f"{number}/8")
    assert [part.read_bytes() for part in parts].count(b"") >= 5
    merge(parts, scenes.parent / "merged.jsonl")
    assert (scenes.parent / "merged.jsonl").read_bytes() == whole.read_bytes()


@pytest.mark.parametrize("shard", ["0/8", "9/8", "1/0", "1", "a/b"])
def test_no_shard_of_that_number(scenes: Path, shard: str) -> None:
    ran = satcheck("batch", str(scenes), "-o", str(scenes / "r.jsonl"), "--shard", shard)
    assert ran.code == 2
    assert "--shard" in ran.err


@pytest.mark.parametrize(
    "options",
    [
        (),
        ("--clearance", "2 m", "--units", "m"),
        ("--depth", "--volume", "--contacts"),
        ("--accuracy", "hull"),
        ("--fail-on", "warning"),
        ("--rules", "rules.toml"),
        ("--baseline", "baseline.json"),
        ("--baseline", "baseline.json", "--exit-zero"),
    ],
)
def test_a_report_is_that_of_each(
    scenes: Path, monkeypatch: pytest.MonkeyPatch, options: tuple[str, ...]
) -> None:
    monkeypatch.chdir(scenes.parent)
    Path("rules.toml").write_text(
        '[[rules]]\na = "a"\nb = "b"\nallowed = true\nreason = "known"\n'
        '[[rules]]\na = "none"\nb = "b"\nallowed = true\nreason = "unused"\n'
    )
    Path("satcheck.toml").write_text("width = 0.5\n")
    here = scenes.parent
    satcheck("batch", "scenes", "-o", "report.json", cwd=here)
    satcheck("baseline", "write", "baseline.json", "report.json", cwd=here)
    ran = satcheck("batch", "scenes/*.toml", "-o", "results.jsonl", *options, cwd=here)
    form = ["--format", "json", "--no-timings"]
    each = satcheck("batch", "scenes/*.toml", *form, *options, cwd=here)
    assert ran.code == each.code, ran.err
    assert each.out, each.err
    asked = {Path(asset["file"]).name: asset for asset in each.document["assets"]}
    made = results(Path("results.jsonl"))
    assert {name: result["verdict"] for name, result in made.items()} == {
        name: asset["verdict"] for name, asset in asked.items()
    }
    assert {name: result["report"] for name, result in made.items()} == {
        name: asset["report"] for name, asset in asked.items()
    }


def test_certificates_are_in_the_results(scenes: Path) -> None:
    _, made = run(scenes, "--certificate")
    (finding,) = made["hit.toml"]["report"]["findings"]
    assert finding["certificate"]["relation"]


def test_a_baseline_that_changes_calls_for_new_checks(scenes: Path) -> None:
    output, baseline = scenes.parent / "results.jsonl", scenes.parent / "baseline.json"
    baseline.write_text('{"schema": "satcheck.baseline/1", "findings": []}')
    again = ["batch", f"{scenes}/*.toml", "-o", str(output), "--baseline", str(baseline)]
    satcheck(*again)
    assert "3 kept" in satcheck(*again, "--resume").err
    baseline.write_text('{"schema":"satcheck.baseline/1","findings":[]}')
    assert "kept" not in satcheck(*again, "--resume").err


def test_a_baseline_that_is_none_is_refused(scenes: Path) -> None:
    output, baseline = scenes.parent / "results.jsonl", scenes.parent / "baseline.json"
    baseline.write_text("{}")
    ran = satcheck("batch", f"{scenes}/*.toml", "-o", str(output), "--baseline", str(baseline))
    assert ran.code == 2
    assert "bad-baseline" in ran.err
    assert not output.exists()
