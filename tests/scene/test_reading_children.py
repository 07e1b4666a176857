"""One child process for all files of a run, and what a file that kills it costs."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import pytest

from satcheck.core import worker
from satcheck.core.worker import WorkerCrashed, WorkerOutOfMemory, WorkerTimeout
from satcheck.scene import load_scene, mesh_files
from satcheck.scene.files.reading_children import ReadingChildren
from tests.scene import files

SERVER = "misbehaving_server"
SERVER_FOLDER = Path(__file__).parents[1] / "core" / "serve_modules"


@pytest.fixture(autouse=True)
def _server_importable(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PYTHONPATH", str(SERVER_FOLDER), prepend=os.pathsep)


@pytest.fixture
def started(monkeypatch: pytest.MonkeyPatch) -> list[worker._Child]:
    """The children that were started."""
    children: list[worker._Child] = []

    class Recorded(worker._Child):
        def __init__(self, *arguments: Any) -> None:
            super().__init__(*arguments)
            children.append(self)

    monkeypatch.setattr(worker, "_Child", Recorded)
    monkeypatch.setattr(mesh_files, "ReadingChildren", ReadingChildren)  # none that others share
    return children


def test_all_files_of_a_run_share_a_child_that_ends_with_it(
    tmp_path: Path, started: list[worker._Child]
) -> None:
    for k in range(4):
        (tmp_path / f"{k}.dae").write_bytes(files.collada())
        (tmp_path / f"{k}.3mf").write_bytes(files.threemf())
    scene = load_scene(sorted(tmp_path.iterdir()))
    assert len(scene.bodies) == 8
    (child,) = started
    assert child._process.returncode is not None  # reaped: no zombie


def test_a_file_that_hangs_costs_itself_alone(started: list[worker._Child]) -> None:
    children = ReadingChildren(512, SERVER)
    assert children.ask(b"echo a", seconds=20.0) == b"a"
    with pytest.raises(WorkerTimeout):
        children.ask(b"hang", seconds=0.5)
    assert children.ask(b"echo b", seconds=20.0) == b"b"
    assert len(started) == 2


@pytest.mark.parametrize(
    ("request_", "error"), [(b"abort", WorkerCrashed), (b"eat_memory 4096", WorkerOutOfMemory)]
)
def test_what_a_used_child_cannot_read_a_fresh_one_decides(
    request_: bytes, error: type[Exception], started: list[worker._Child]
) -> None:
    children = ReadingChildren(512, SERVER)
    with pytest.raises(error):
        children.ask(request_, seconds=20.0)
    assert len(started) == 1  # it was fresh: its answer counts
    assert children.ask(b"echo a", seconds=20.0) == b"a"
    with pytest.raises(error):
        children.ask(request_, seconds=20.0)
    assert len(started) == 3


def test_children_end_with_their_owner(started: list[worker._Child]) -> None:
    children = ReadingChildren(512, SERVER)
    children.ask(b"echo a", seconds=20.0)
    assert started[0]._process.poll() is None
    del children
    assert started[0]._process.returncode is not None
