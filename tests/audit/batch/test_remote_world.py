"""Which files of a remote world are copied, and what they are called."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import fsspec
import pytest

from satcheck.audit.batch import remote
from satcheck.audit.batch.remote import Copies, make_room
from tests.plugin_marks import needs

WORLD = ("memory://bucket/scenes/a.toml",)

pytestmark = pytest.mark.usefixtures("memory")


@pytest.fixture
def memory() -> Iterator[Any]:
    system = fsspec.filesystem("memory")
    for name in ("scenes/a.toml", "scenes/m/box.obj", "meshes/box.obj", "package.xml"):
        system.pipe_file(f"/bucket/{name}", name.encode())
    yield system
    system.store.clear()


def test_the_layout_is_kept(tmp_path: Path) -> None:
    copy = Copies(tmp_path, WORLD, anywhere=False)
    scene = copy.path(WORLD[0])
    mesh = str(Path(scene).parent / "m" / "box.obj")
    assert copy.fetch([scene, mesh])
    assert not copy.fetch([scene, mesh])
    assert Path(mesh).read_text() == "scenes/m/box.obj"
    assert copy.url(mesh) == "memory://bucket/scenes/m/box.obj"
    assert copy.path("here.obj") == "here.obj"
    assert copy.url("here.obj") is None
    assert copy.url(str(Path(scene).parents[3])) is None


def test_what_lies_outside_of_the_root_is_not_fetched(tmp_path: Path) -> None:
    outside = "../../bucket/meshes/box.obj"
    near = Copies(tmp_path / "near", WORLD, anywhere=False)
    assert not near.fetch([str(Path(near.path(WORLD[0])).parent / outside)])
    far = Copies(tmp_path / "far", WORLD, anywhere=True)
    assert far.fetch([str(Path(far.path(WORLD[0])).parent / outside)])


def test_no_host_beside_that_of_the_world_is_asked(memory: Any, tmp_path: Path) -> None:
    memory.pipe_file("/other/box.obj", b"")
    copy = Copies(tmp_path, WORLD, anywhere=True)
    outside = Path(copy.path(WORLD[0])).parents[2] / "other" / "box.obj"
    assert copy.url(str(outside)) == "memory://other/box.obj"
    assert not copy.fetch([str(outside)])
    assert not copy.fetch([str(outside.parents[1] / ".." / ".." / "x.obj"), "/etc/none.obj"])


def test_a_name_cannot_leave_the_folder_of_copies(tmp_path: Path) -> None:
    world = ("memory://bucket/../../../x.toml",)
    place = Path(Copies(tmp_path, world, anywhere=True).path(world[0]))
    assert ".." not in place.parts
    assert place.is_relative_to(tmp_path.resolve())


@pytest.mark.parametrize(
    ("name", "fetched"),
    [
        ("a.urdf", True),
        pytest.param("a.sdf", True, marks=needs("sdf")),
        pytest.param("a.WORLD", True, marks=needs("sdf")),
        pytest.param("a.xml", True, marks=needs("mjcf")),
        ("a.toml", False),
        ("urdf", False),
    ],
)
def test_files_beside_the_folder_of_a_robot_are_fetched(
    memory: Any, tmp_path: Path, name: str, fetched: bool
) -> None:
    memory.pipe_file(f"/bucket/scenes/{name}", b"")
    copy = Copies(tmp_path, (f"memory://bucket/scenes/{name}",), anywhere=False)
    robot = Path(copy.path(f"memory://bucket/scenes/{name}"))
    assert copy.fetch([str(robot.parents[1] / "meshes" / "box.obj")]) == fetched


def test_worlds_of_other_roots_share_no_copies(tmp_path: Path) -> None:
    """Else the answer for a world would depend on the worlds before it."""
    robot = Copies(tmp_path, ("memory://bucket/robot/a.urdf",), anywhere=False)
    manifest = Path(robot.path("memory://bucket/package.xml"))
    assert robot.fetch([str(manifest)])
    other = Copies(tmp_path, WORLD, anywhere=False)
    assert not Path(other.path("memory://bucket/package.xml")).exists()
    again = Copies(tmp_path, ("memory://bucket/robot/b.urdf",), anywhere=False)
    assert Path(again.path("memory://bucket/package.xml")) == manifest


def test_copies_that_are_too_many_are_removed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    copy = Copies(tmp_path, WORLD, anywhere=False)
    copy.fetch([copy.path(WORLD[0])])
    make_room(tmp_path)
    assert Path(copy.path(WORLD[0])).exists()
    monkeypatch.setattr(remote, "_MOST_BYTES", 1)
    make_room(tmp_path)
    assert not Path(copy.path(WORLD[0])).exists()
    make_room(tmp_path)
    assert copy.fetch([copy.path(WORLD[0])])


def test_a_report_names_urls(tmp_path: Path) -> None:
    copy = Copies(tmp_path / 'a "folder"', WORLD, anywhere=False)
    text = json.dumps({"message": f"{copy.path(WORLD[0])}: broken"}).encode()
    assert json.loads(copy.with_urls(text)) == {"message": f"{WORLD[0]}: broken"}
