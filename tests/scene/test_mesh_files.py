"""Files are read once; a part is found by the path that a report shows."""

from __future__ import annotations

import pytest

from satcheck.scene import MeshFile, MeshFileError, MeshFiles, load_scene, mesh_files
from satcheck.scene.loading import limits
from satcheck.scene.loading.nodes import Node
from tests.scene import files, graphs

NODES = [{"name": "rim", "mesh": 0}, {"name": "tyre", "mesh": 0, "translation": [5, 0, 0]}]


@pytest.fixture
def wheel(tmp_path):
    path = tmp_path / "wheel.glb"
    path.write_bytes(graphs.glb(NODES))
    return path


def test_a_part_is_the_node_where_the_file_places_it(wheel):
    read = MeshFiles()
    rim, tyre = (read.part("wheel.glb", wheel, name) for name in ("rim", "tyre"))
    assert isinstance(rim, Node)
    assert isinstance(tyre, Node)
    assert rim.file is tyre.file
    assert isinstance(rim.file, MeshFile)
    assert rim.file.path == "wheel.glb"
    assert (rim.transform, tyre.transform) == (
        None,
        (1, 0, 0, 5, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1),
    )


def test_a_part_that_is_not_there_is_an_error_with_a_suggestion(wheel):
    found = MeshFiles().part("wheel.glb", wheel, "tire")
    assert isinstance(found, MeshFileError)
    assert found.code == "unknown-part"
    assert "did you mean 'tyre'?" in found.message


def test_a_component_is_a_part_of_any_format(tmp_path):
    path = tmp_path / "two.obj"
    path.write_bytes(files.obj(files.TWO_CUBES_POINTS, files.TWO_CUBES))
    read = MeshFiles()
    found = read.part("two.obj", path, "#2")
    assert isinstance(found, Node)
    assert isinstance(found.file, MeshFile)
    assert found.file.mesh.bounds == ((3, 0, 0), (4, 1, 1))
    assert isinstance(read.part("two.obj", path, "#3"), MeshFileError)
    assert isinstance(read.part("two.obj", path, "two"), MeshFileError)


def test_a_file_is_read_once_whichever_way_it_is_named(wheel, monkeypatch):
    read = MeshFiles()
    first = read.whole("wheel.glb", wheel)
    part = read.part("wheel.glb", wheel, "rim")
    wheel.unlink()
    monkeypatch.chdir(wheel.parent)
    assert read.whole("wheel.glb", wheel.relative_to(wheel.parent)) is first
    assert read.part("wheel.glb", wheel, "rim") is part


def test_what_cannot_be_read_stays_so(tmp_path):
    read = MeshFiles()
    missing = read.part("gone.glb", tmp_path / "gone.glb", "a")
    assert isinstance(missing, MeshFileError)
    assert missing.code == "file-not-found"
    assert read.part("gone.glb", tmp_path / "gone.glb", "b") is missing


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
    refused = MeshFiles().whole("level.gltf", path)
    assert isinstance(refused, MeshFileError)
    assert refused.code == "outside-path"
    assert isinstance(MeshFiles(allow_outside=True).whole("level.gltf", path), MeshFile)
    (body,) = load_scene([path], allow_outside=True).bodies
    assert body.file.health.solid


def test_large_files_are_read_ahead_with_the_same_result(tmp_path, monkeypatch):
    monkeypatch.setattr(mesh_files, "LARGE_FILE_BYTES", 1)
    places = {name: tmp_path / name for name in ("a.obj", "b.obj", "bad.obj", "gone.obj", "c.glb")}
    places["a.obj"].write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    places["b.obj"].write_text("v 0 0 0\nv 2 0 0\nv 0 1 0\nf 1 2 3\n")
    places["bad.obj"].write_text("v 0 0 0\nf 1 2 3\n")
    places["c.glb"].write_bytes(graphs.glb(NODES))
    ahead, alone = MeshFiles(), MeshFiles()
    ahead.read_ahead(places.items())
    for name, place in places.items():
        found, expected = ahead.whole(name, place), alone.whole(name, place)
        if isinstance(expected, MeshFile):
            assert isinstance(found, MeshFile)
            assert found.mesh.to_bytes() == expected.mesh.to_bytes()
            assert found.health == expected.health
        else:
            assert isinstance(found, MeshFileError)
            assert (found.code, str(found)) == (expected.code, str(expected))
    assert isinstance(ahead.whole("bad.obj", places["bad.obj"]), MeshFileError)
