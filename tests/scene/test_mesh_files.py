"""Files are read once; a part is found by the path that a report shows."""

from __future__ import annotations

import gc
from threading import Thread

import pytest

from satcheck.core import worker
from satcheck.scene import MeshFile, MeshFiles, Refused, load_scene, mesh_files
from satcheck.scene.access import ANYWHERE
from satcheck.scene.document import FilePart
from satcheck.scene.files import limits
from satcheck.scene.files.readers import ReadLimits
from satcheck.scene.files.reading_children import ReadingChildren
from tests.scene import files, graphs

NODES = [{"name": "rim", "mesh": 0}, {"name": "tyre", "mesh": 0, "translation": [5, 0, 0]}]


@pytest.fixture
def wheel(tmp_path):
    path = tmp_path / "wheel.glb"
    path.write_bytes(graphs.glb(NODES))
    return path


def test_a_part_is_the_node_where_the_file_places_it(wheel):
    read = MeshFiles()
    rim, tyre = (read.item(FilePart("wheel.glb", str(wheel), name)) for name in ("rim", "tyre"))
    assert rim.shape is tyre.shape
    assert isinstance(rim.shape, MeshFile)
    assert rim.shape.path == "wheel.glb"
    assert (rim.transform, tyre.transform) == (
        None,
        (1, 0, 0, 5, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1),
    )


def test_a_part_that_is_not_there_is_an_error_with_a_suggestion(wheel):
    found = MeshFiles().item(FilePart("wheel.glb", str(wheel), "tire")).shape
    assert isinstance(found, Refused)
    assert found.code == "unknown-part"
    assert "did you mean 'tyre'?" in found.message


def test_a_component_is_a_part_of_any_format(tmp_path):
    path = tmp_path / "two.obj"
    path.write_bytes(files.obj(files.TWO_CUBES_POINTS, files.TWO_CUBES))
    read = MeshFiles()
    found = read.item(FilePart("two.obj", str(path), "#2"))
    assert isinstance(found.shape, MeshFile)
    assert found.shape.mesh.bounds == ((3, 0, 0), (4, 1, 1))
    assert isinstance(read.item(FilePart("two.obj", str(path), "#3")).shape, Refused)
    assert isinstance(read.item(FilePart("two.obj", str(path), "two")).shape, Refused)


def test_a_file_is_read_once_whichever_way_it_is_named(wheel, monkeypatch):
    monkeypatch.chdir(wheel.parent)
    read = MeshFiles()
    first = read.item(FilePart("wheel.glb", str(wheel)))
    part = read.item(FilePart("wheel.glb", str(wheel), "rim"))
    wheel.unlink()
    assert read.item(FilePart("wheel.glb", str(wheel.relative_to(wheel.parent)))) is first
    assert read.item(FilePart("wheel.glb", str(wheel), "rim")) is part


def test_what_cannot_be_read_stays_so(tmp_path):
    read = MeshFiles()
    missing = read.item(FilePart("gone.glb", str(tmp_path / "gone.glb"), "a")).shape
    assert isinstance(missing, Refused)
    assert missing.code == "file-not-found"
    assert read.item(FilePart("gone.glb", str(tmp_path / "gone.glb"), "b")).shape is missing


@pytest.mark.parametrize("in_process", [True, False])
def test_buffers_outside_of_the_folder_are_read_where_that_is_allowed(
    tmp_path, monkeypatch, in_process
):
    if not in_process:
        monkeypatch.setattr(limits, "IN_PROCESS_BYTES", 0)
    document, buffer = files.gltf_document()
    document["buffers"][0]["uri"] = "../shared.bin"
    (tmp_path / "shared.bin").write_bytes(buffer)
    path = tmp_path / "level" / "level.gltf"
    path.parent.mkdir()
    path.write_bytes(graphs.gltf(document))
    refused = MeshFiles().item(FilePart("level.gltf", str(path))).shape
    assert isinstance(refused, Refused)
    assert refused.code == "outside-path"
    allowed = ReadLimits(permitted=ANYWHERE)
    assert isinstance(MeshFiles(allowed).item(FilePart("level.gltf", str(path))).shape, MeshFile)
    (body,) = load_scene([path], allow_outside=True).bodies
    assert body.file.health.solid


def refused(_):
    raise RuntimeError("can't start new thread")


@pytest.mark.parametrize("granted", [True, False])
def test_large_files_are_read_ahead_with_the_same_result(tmp_path, monkeypatch, granted):
    monkeypatch.setattr(mesh_files, "LARGE_FILE_BYTES", 1)
    if not granted:
        monkeypatch.setattr(Thread, "start", refused)
    places = {name: tmp_path / name for name in ("a.obj", "b.obj", "bad.obj", "gone.obj", "c.glb")}
    places["a.obj"].write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    places["b.obj"].write_text("v 0 0 0\nv 2 0 0\nv 0 1 0\nf 1 2 3\n")
    places["bad.obj"].write_text("v 0 0 0\nf 1 2 3\n")
    places["c.glb"].write_bytes(graphs.glb(NODES))
    ahead, alone = MeshFiles(), MeshFiles()
    ahead.read_ahead(places.items())
    for name, place in places.items():
        found, expected = (read.item(FilePart(name, str(place))).shape for read in (ahead, alone))
        if isinstance(expected, MeshFile):
            assert isinstance(found, MeshFile)
            assert found.mesh.to_bytes() == expected.mesh.to_bytes()
            assert found.health == expected.health
        else:
            assert isinstance(found, Refused)
            assert (found.code, str(found)) == (expected.code, str(expected))
    assert isinstance(ahead.item(FilePart("bad.obj", str(places["bad.obj"]))).shape, Refused)


def test_the_children_end_when_the_scene_is_loaded(tmp_path, monkeypatch):
    """Also those whose file was refused, and before anything is collected."""
    (tmp_path / "a.dae").write_text("no XML")
    monkeypatch.setattr(mesh_files, "ReadingChildren", ReadingChildren)  # none that others share
    monkeypatch.setattr(worker, "_children", set())
    gc.disable()
    try:
        scene = load_scene([tmp_path / "a.dae"])
        left = len(worker._children)
    finally:
        gc.enable()
    assert [body.issue.code for body in scene.unreadable] == ["bad-encoding"]
    assert left == 0
