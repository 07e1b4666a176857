"""Mesh files in memory: those of several scenes are kept, and read again when they have changed."""

from __future__ import annotations

import os
import shutil
from collections.abc import Callable
from pathlib import Path

import pytest

from satcheck.core import worker
from satcheck.scene import Scene, load_scene, mesh_files
from satcheck.scene.access import files_read
from satcheck.scene.files.reading_children import ReadingChildren
from satcheck.scene.loader import LoadOptions
from satcheck.scene.mesh_files import KnownMeshes
from tests.cli.process import SAMPLES
from tests.scene import files


@pytest.fixture(autouse=True)
def _settled(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """Every file but those of `fresh` counts as old."""
    monkeypatch.setattr("satcheck.scene.access._GRAIN_NS", -(10**12))
    monkeypatch.chdir(tmp_path)


def load(known: KnownMeshes, *names: str) -> Scene:
    return LoadOptions().load(names, known=known)


def known_of(triangles: int, *names: str) -> KnownMeshes:
    """Of files for which scenes have asked before."""
    known = KnownMeshes(triangles)
    load(known, *names)
    return known


def mesh(scene: Scene) -> object:
    return scene.bodies[0].file.mesh


def facts(scene: Scene) -> object:
    return [(body.id, body.file.sha256, body.file.health) for body in scene.bodies], [
        (body.id, body.issue) for body in scene.unreadable
    ]


def copied(name: str, to: str | None = None) -> str:
    return shutil.copy(SAMPLES / name, to or name)


@pytest.mark.parametrize("split", [False, True])
def test_a_file_is_read_once(split: bool) -> None:
    names = [copied("box.obj")] if split else [copied("box.obj"), copied("cube.off")]
    known = known_of(1000, *names)
    with files_read() as first:
        before = load(known, *names)
    with files_read() as second:
        after = load(known, *names)
    assert mesh(after) is mesh(before)
    assert list(second) == list(first)
    assert facts(load_scene(names)) == facts(after)


@pytest.mark.parametrize(
    "change",
    [
        lambda: copied("cube.off", "cube2.off") and Path("cube2.off").replace("box.off"),
        lambda: copied("kettle.obj", "box.off"),
        lambda: Path("box.off").unlink(),
        lambda: os.utime("box.off"),
    ],
)
def test_a_file_that_changed_is_read_again(change: Callable[[], object]) -> None:
    copied("cube.off", "box.off")
    known = known_of(1000, "box.off", copied("box.obj"))
    before = load(known, "box.off", "box.obj")
    change()
    after = load(known, "box.off", "box.obj")
    assert mesh(after) is not mesh(before)
    assert facts(after) == facts(load_scene(["box.off", "box.obj"]))


def test_a_fresh_file_is_read_again(monkeypatch: pytest.MonkeyPatch) -> None:
    """It may change once more without another time of change."""
    monkeypatch.setattr("satcheck.scene.access._GRAIN_NS", 10**15)
    known = known_of(1000, copied("box.obj"))
    before = load(known, "box.obj")
    assert mesh(load(known, "box.obj")) is not mesh(before)


def test_files_of_the_longest_ago_make_room() -> None:
    names = [copied(name) for name in ("box.obj", "cube.off", "box_pushed.stl")]
    known = KnownMeshes(250)  # two of them
    for name in names:
        load(known, name)
    meshes = [mesh(load(known, name)) for name in names]
    again = [mesh(load(known, name)) for name in reversed(names)]
    assert [new is old for new, old in zip(reversed(again), meshes, strict=True)] == [
        False,
        True,
        True,
    ]


def test_a_file_of_one_scene_is_not_kept() -> None:
    known = KnownMeshes(1000)
    first = mesh(load(known, copied("box.obj")))
    assert mesh(load(known, "box.obj")) is not first


def test_a_file_that_fails_fails_again() -> None:
    Path("box.obj").write_text("v 1\n")
    known = KnownMeshes(1000)
    first = load(known, "box.obj", copied("cube.off")).unreadable
    assert load(known, "box.obj", "cube.off").unreadable == first
    copied("box.obj")
    assert not load(known, "box.obj", "cube.off").unreadable


def test_scenes_share_the_child_that_reads_their_files(monkeypatch: pytest.MonkeyPatch) -> None:
    """It ends with what is known of them."""
    monkeypatch.setattr(mesh_files, "ReadingChildren", ReadingChildren)  # none that others share
    monkeypatch.setattr(worker, "_children", set())
    known = KnownMeshes(1000)
    seen = set()
    for name in ("a.dae", "b.dae"):
        Path(name).write_bytes(files.collada())
        assert len(load(known, name).bodies) == 1
        seen |= worker._children
    assert len(seen) == 1
    del known
    assert not worker._children
