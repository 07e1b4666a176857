"""Which assets changed since a revision."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path
from xml.sax.saxutils import escape

import pytest
from msgspec.structs import replace

from satcheck.core.errors import SatcheckError
from satcheck.scene.access import NOTHING_ELSE
from satcheck.scene.changed_assets import changed_since
from tests.cli.process import on_posix

IDENTITY = ("-c", "user.name=a", "-c", "user.email=a@b.c", "-c", "protocol.file.allow=always")


def git(folder: Path, *arguments: str) -> None:
    subprocess.run(("git", *IDENTITY, *arguments), cwd=folder, check=True, capture_output=True)


def commit(folder: Path, files: dict[str, str]) -> None:
    for name, text in files.items():
        (folder / name).parent.mkdir(exist_ok=True, parents=True)
        (folder / name).write_text(text)
    git(folder, "init", "-q")
    git(folder, "add", ".")
    git(folder, "commit", "-q", "-m", "first")


def changed(folder: Path, *names: str) -> list[str]:
    listed = changed_since("HEAD", [str(folder / name) for name in names], NOTHING_ELSE)
    return [Path(path).relative_to(folder).as_posix() for path in listed]


def test_a_file_that_is_too_large_to_search_counts_as_changed(tmp_path: Path) -> None:
    commit(tmp_path, {"scene.toml": "#" * (1 << 20) + "a.obj", "a.obj": "v 1 2 3\n", "b.toml": ""})
    (tmp_path / "a.obj").write_text("v 1 2 4\n")
    small = replace(NOTHING_ELSE, megabytes=1)
    listed = changed_since("HEAD", [str(tmp_path / f"{n}.toml") for n in ("scene", "b")], small)
    assert listed == [str(tmp_path / "scene.toml")]


def test_the_old_name_of_a_renamed_file_is_a_change(tmp_path: Path) -> None:
    commit(tmp_path, {"scene.toml": "a.obj", "a.obj": "v 1 2 3\n" * 9})
    assert changed(tmp_path, "scene.toml") == []
    git(tmp_path, "mv", "a.obj", "b.obj")
    assert changed(tmp_path, "scene.toml") == ["scene.toml"]


@pytest.mark.parametrize(
    "text",
    [
        "é & ü.bin",
        "%C3%A9%20%26%20%C3%BC.bin",
        json.dumps("é & ü.bin"),
        json.dumps("é & ü.bin").replace("e9", "E9"),
        escape("é & ü.bin"),
    ],
)
def test_names_as_they_stand_in_files(text: str, tmp_path: Path) -> None:
    commit(tmp_path, {"a.gltf": text, "other.gltf": "u.bin", "é & ü.bin": "1"})
    (tmp_path / "é & ü.bin").write_text("2")
    assert changed(tmp_path, "a.gltf", "other.gltf") == ["a.gltf"]


def test_a_name_without_an_ending(tmp_path: Path) -> None:
    commit(tmp_path, {"a.gltf": '"uri": "buffer"', "buffer": "1"})
    (tmp_path / "buffer").write_text("2")
    assert changed(tmp_path, "a.gltf") == ["a.gltf"]


def test_a_change_counts_through_files_that_are_no_assets_here(tmp_path: Path) -> None:
    commit(
        tmp_path,
        {"scenes/s.toml": "../meshes/p.gltf", "meshes/p.gltf": "p.bin", "meshes/p.bin": "1"},
    )
    assert changed(tmp_path, "scenes/s.toml") == []
    (tmp_path / "meshes" / "p.bin").write_text("2")
    assert changed(tmp_path, "scenes/s.toml") == ["scenes/s.toml"]


def test_ignored_files_have_changed(tmp_path: Path) -> None:
    commit(tmp_path, {".gitignore": "made", "scene.toml": "made/a.obj", "made/a.obj": "v 1 2 3"})
    assert changed(tmp_path, "scene.toml", "made/a.obj") == ["scene.toml", "made/a.obj"]


@on_posix
def test_a_link_that_leads_to_another_folder_changes_its_assets(tmp_path: Path) -> None:
    for name in ("old", "new"):
        (tmp_path / name).mkdir()
    (tmp_path / "link").symlink_to("old")
    commit(tmp_path, {"old/a.obj": "v 1 2 3", "new/a.obj": "v 4 5 6"})
    assert changed(tmp_path, "link/a.obj") == []
    (tmp_path / "link").unlink()
    (tmp_path / "link").symlink_to("new")
    assert changed(tmp_path, "link/a.obj") == ["link/a.obj"]


def test_an_asset_in_a_submodule_is_refused(tmp_path: Path) -> None:
    commit(tmp_path / "inner", {"a.obj": "v 1 2 3"})
    commit(tmp_path / "outer", {"b.obj": "v 1 2 3"})
    git(tmp_path / "outer", "submodule", "add", str(tmp_path / "inner"), "sub")
    with pytest.raises(SatcheckError, match="check the submodule by itself"):
        changed(tmp_path / "outer", "sub/a.obj")


def test_a_shallow_clone_says_how_to_get_the_revision(tmp_path: Path) -> None:
    commit(tmp_path / "full", {"a.obj": "v 1 2 3"})
    (tmp_path / "full" / "a.obj").write_text("v 4 5 6")
    git(tmp_path / "full", "commit", "-q", "-a", "-m", "second")
    git(tmp_path, "clone", "-q", "--depth", "1", (tmp_path / "full").as_uri(), "shallow")
    with pytest.raises(SatcheckError, match="git fetch --unshallow"):
        changed_since("HEAD~1", [str(tmp_path / "shallow" / "a.obj")], NOTHING_ELSE)
