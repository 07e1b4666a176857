"""Which files of a folder are assets."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from satcheck.core.errors import SatcheckError
from satcheck.scene import asset_files as module
from satcheck.scene.access import Permitted
from satcheck.scene.asset_files import asset_files
from satcheck.scene.foreign_formats import is_foreign
from tests.cli.process import on_posix
from tests.plugin_marks import needs


@on_posix
def test_linked_folders_are_followed_once(tmp_path: Path) -> None:
    (tmp_path / "far").mkdir()
    (tmp_path / "far" / "a.obj").touch()
    folder = tmp_path / "folder"
    folder.mkdir()
    (folder / "again").symlink_to(folder)
    (folder / "link").symlink_to(tmp_path / "far")
    assert asset_files([str(folder)]).files == [(folder / "link" / "a.obj").as_posix()]


def test_a_folder_that_cannot_be_listed_stands_for_itself(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    closed = tmp_path / "closed"
    closed.mkdir()
    scandir = os.scandir

    def refuse(path: str) -> object:
        if Path(path) == closed:
            raise PermissionError(13, "Permission denied", str(path))
        return scandir(path)

    monkeypatch.setattr(os, "scandir", refuse)
    assert asset_files([str(tmp_path)]).files == [closed.as_posix()]


@pytest.mark.parametrize(
    ("content", "assets"),
    [
        (b'{"schema": "satcheck.scene/1"}', 1),
        (rb'{"schema": "satcheck.scene\/1"}', 1),
        (b'{"bodies": [{"id": "a", "mesh": "a.obj"}]}', 1),
        (b'{"bodies": [{"id": "a", "mass": 1}]}', 0),
        (b'{"bodies": [{"id": "a", "mesh": "a.obj"}', 0),
        (b"{}", 0),
    ],
)
def test_json_is_an_asset_if_it_is_a_scene(content: bytes, assets: int, tmp_path: Path) -> None:
    (tmp_path / "a.obj").touch()
    (tmp_path / "scene.json").write_bytes(content)
    assert len(asset_files([str(tmp_path)]).files) == 1 + assets


@needs("sdf")
@pytest.mark.parametrize("name", ["model.sdf", "yard.world"])
def test_files_of_other_programs_with_the_endings_of_sdformat_are_no_assets(
    name: str, tmp_path: Path
) -> None:
    (tmp_path / "a.obj").touch()
    (tmp_path / name).write_text("define floorplan model")
    assert len(asset_files([str(tmp_path)]).files) == 1
    (tmp_path / name).write_text('<?xml version="1.0"?><sdf version="1.9"/>')
    assert len(asset_files([str(tmp_path)]).files) == 2


def test_an_unreadable_scene_is_an_asset(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "scene.toml").touch()
    monkeypatch.setattr(module, "content_of", lambda *_: None)
    assert asset_files([str(tmp_path)]).files == [(tmp_path / "scene.toml").as_posix()]


def test_a_file_beyond_the_limit_counts_as_its_reader_has_to_refuse_it(tmp_path: Path) -> None:
    (tmp_path / "a.obj").touch()
    (tmp_path / "data.json").write_bytes(b"1" * 300_000)
    assert len(asset_files([str(tmp_path)]).files) == 1
    assert len(asset_files([str(tmp_path)], (), Permitted(megabytes=1)).files) == 2


@needs("mjcf")
def test_xml_is_an_asset_if_it_is_a_model_of_mujoco(tmp_path: Path) -> None:
    (tmp_path / "junit.xml").write_text("<testsuites/>")
    (tmp_path / "notes.xml").write_text("mujoco")
    (tmp_path / "arm.xml").write_text('<?xml version="1.0"?>\n<!-- a --><mujoco model="arm"/>')
    assert asset_files([str(tmp_path)]).files == [(tmp_path / "arm.xml").as_posix()]


def test_a_pattern_with_a_root_can_be_excluded_from(tmp_path: Path) -> None:
    for name in ("a.obj", "b.obj"):
        (tmp_path / name).touch()
    found = asset_files([str(tmp_path / "*.obj")], ["b.*"])
    assert (found.files, found.excluded) == ([(tmp_path / "a.obj").as_posix()], 1)


def test_an_empty_pattern_excludes_nothing_and_is_refused(tmp_path: Path) -> None:
    with pytest.raises(SatcheckError) as caught:
        asset_files([str(tmp_path)], [""])
    assert caught.value.code == "bad-pattern"


@pytest.mark.parametrize("schema", ["satcheck.scene/2", "satcheck.scen/1", "satcheck-scene-2"])
def test_a_scene_of_another_version_is_an_asset(tmp_path: Path, schema: str) -> None:
    (tmp_path / "a.json").write_text(f'{{"schema": "{schema}"}}')
    assert asset_files([str(tmp_path)]).files == [(tmp_path / "a.json").as_posix()]


def test_a_report_is_no_asset(tmp_path: Path) -> None:
    """It has bodies, which name files, as a scene."""
    (tmp_path / "a.obj").touch()
    bodies = '[{"id": "a", "mesh": "a.obj"}]'
    (tmp_path / "r.json").write_text(f'{{"schema": "satcheck.report/1", "bodies": {bodies}}}')
    assert asset_files([str(tmp_path)]).files == [(tmp_path / "a.obj").as_posix()]
    (tmp_path / "s.json").write_text(f'{{"bodies": {bodies}}}')
    assert (tmp_path / "s.json").as_posix() in asset_files([str(tmp_path)]).files


@pytest.mark.parametrize(
    ("name", "known"),
    [
        ("arm.urdf.xacro", True),
        ("bolt.prt.12", True),
        ("bolt.asm.1", True),
        ("part.stl.gz", True),
        ("part.FBX.xz", True),
        ("arm.urdf.bz2", True),
        ("level.tscn", True),
        ("house.xkt", True),
        ("parts.tar.gz", True),
        ("parts.zip", True),
        ("town.city.json", True),
        ("notes.txt.gz", False),
        ("photo.12", False),
        ("drawing.drw.3", False),
        ("town.json", False),
        ("scene.bin", False),
        ("a.obj", False),
    ],
)
def test_what_may_hold_geometry_is_known_by_the_end_of_its_name(name: str, known: bool) -> None:
    assert is_foreign(name) == known
