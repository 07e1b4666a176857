"""`satcheck batch` with URLs: file:// goes through fsspec as s3:// does."""

from __future__ import annotations

import json
import re
import shutil
from pathlib import Path
from typing import Any

import pytest
import trimesh

from tests.audit.batch.worlds import make_worlds
from tests.cli.process import SAMPLES, private_cache, satcheck

_KEY = re.compile(r'"key":"\w+"')


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    scenes = tmp_path / "scenes"
    scenes.mkdir()
    return scenes


def checked(folder: Path, *arguments: str) -> dict[str, Any]:
    """The results by the names of the scenes."""
    output = folder.parent / "results.jsonl"
    satcheck("batch", *arguments, "-o", str(output))
    lines = [json.loads(line) for line in output.read_text().splitlines()]
    output.unlink()
    return {line["files"][0]: line for line in lines}


def text(folder: Path, *arguments: str) -> str:
    output = folder.parent / "results.jsonl"
    satcheck("batch", *arguments, "-o", str(output))
    made = output.read_text()
    output.unlink()
    return made


def scene(folder: Path, mesh: str) -> str:
    (folder / "a.toml").write_text(
        f'schema = "satcheck.scene/1"\n[[bodies]]\nid = "a"\nmesh = "{mesh}"\n'
        '[[bodies]]\nid = "b"\nmesh = "box.obj"\n'
    )
    shutil.copy(SAMPLES / "box.obj", folder)
    return (folder / "a.toml").as_uri()


def test_a_table_needs_no_file_of_results(folder: Path) -> None:
    shutil.copy(SAMPLES / "rack.3mf", folder)
    ran = satcheck("batch", f"{folder.as_uri()}/*.3mf", cwd=folder)
    assert ran.code == 1
    last = " ".join(ran.out.split())
    assert last.endswith(f"FAIL: 1 asset: 1 fails ({folder.as_uri()}/rack.3mf).")
    assert "Next:" not in ran.out  # a check takes no URL


def test_results_are_those_of_the_same_files_here(folder: Path) -> None:
    """But for the names, and the keys, which depend on names."""
    make_worlds(folder, 12)
    (folder / "broken.toml").write_text("bodies = 1\n")
    near = text(folder, f"{folder}/*.toml")
    far = text(folder, f"{folder.as_uri()}/*.toml")
    assert folder.as_uri() in far
    assert _KEY.sub("", far.replace("file:///", "/")) == _KEY.sub("", near)


def test_a_file_that_a_file_names_is_fetched(folder: Path) -> None:
    (folder / "m").mkdir()
    for name, data in trimesh.creation.box().scene().export(file_type="gltf").items():
        (folder / "m" / name).write_bytes(data)
    mesh = next((folder / "m").glob("*.gltf")).name
    (result,) = checked(folder, scene(folder, f"m/{mesh}")).values()
    assert {issue["severity"] for issue in result["report"]["issues"]} == {"warning"}
    named = {Path(file["path"]).suffix for file in result["inputs"]}
    assert named == {".toml", ".obj", ".gltf", ".bin"}


def test_a_robot_finds_its_meshes(folder: Path) -> None:
    robot = folder / "urdf" / "arm.urdf"
    robot.parent.mkdir()
    shutil.copy(SAMPLES / "arm.urdf", robot)
    near = checked(folder, str(robot))[str(robot)]
    far = checked(folder, robot.as_uri())[robot.as_uri()]
    assert far["verdict"] == near["verdict"]
    assert far["report"]["summary"] == near["report"]["summary"]


def test_nothing_outside_of_the_folder_is_fetched(folder: Path) -> None:
    shutil.copy(SAMPLES / "box_pushed.stl", folder.parent)
    url = scene(folder, "../box_pushed.stl")
    (refused,) = checked(folder, url).values()
    assert refused["verdict"] == "error"
    assert "outside-path" in {issue["code"] for issue in refused["report"]["issues"]}
    (allowed,) = checked(folder, url, "--allow-outside").values()
    assert allowed["verdict"] == "fail"


def test_a_missing_file_has_its_url(folder: Path) -> None:
    (result,) = checked(folder, scene(folder, "none.obj")).values()
    assert result["verdict"] == "error"
    assert any("missing" in issue["message"] for issue in result["report"]["issues"])
    assert f"{folder.as_uri()}/none.obj" in {file["path"] for file in result["inputs"]}
    assert "satcheck-" not in json.dumps(result)


def test_a_url_that_cannot_be_reached_is_an_error_of_its_scene(folder: Path) -> None:
    url = scene(folder, "box.obj")
    results = checked(folder, url, "nowhere://a/b.toml")
    assert results[url]["verdict"] == "fail"
    (issue,) = results["nowhere://a/b.toml"]["report"]["issues"]
    assert issue["code"] == "unreachable-url"
    assert results["nowhere://a/b.toml"]["key"] is None


def test_manifest_and_results_at_urls(folder: Path) -> None:
    make_worlds(folder, 3)
    manifest = folder.parent / "manifest"
    manifest.write_text("".join(f"{path.as_uri()}\n" for path in folder.glob("*.toml")))
    output = folder.parent / "r.jsonl"
    call = ["batch", "--manifest", manifest.as_uri(), "-o", output.as_uri()]
    cache = private_cache(folder.parent / "cache")
    first = satcheck(*call, env=cache)
    assert f"Results: {output.as_uri()}" in first.err
    assert len(output.read_text().splitlines()) == 3
    assert not output.with_name("r.jsonl.part").exists()
    again = satcheck(*call, env=cache)
    assert again.code == 2
    assert f"{output.as_uri()}: has results" in again.err
    before = output.read_bytes()
    (folder / "0001.toml").write_text("bodies = 1\n")
    resumed = satcheck(*call, "--resume", env=cache)
    assert "1 has errors" in resumed.err
    assert "2 kept" in resumed.err
    assert output.read_bytes() != before


def test_a_pattern_without_a_match_is_told(folder: Path) -> None:
    ran = satcheck("batch", f"{folder.as_uri()}/*.toml", "-o", str(folder / "r"))
    assert ran.code == 2
    assert "no file matches" in ran.err
