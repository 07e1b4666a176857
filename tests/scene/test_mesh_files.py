"""Files are read once; a part is found by the path that a report shows."""

from __future__ import annotations

import gc
import struct
from threading import Thread

import pytest

from satcheck.core import worker
from satcheck.scene import MeshFile, MeshFiles, Refused, load_scene, mesh_files, opening
from satcheck.scene.document import FilePart
from satcheck.scene.files import limits
from satcheck.scene.files.native_formats import read_native
from satcheck.scene.files.readers import ReadLimits, required_reader
from satcheck.scene.files.reading_children import ReadingChildren
from satcheck.scene.opening import ANYWHERE, open_file
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


def stl_of(triangles: int) -> bytes:
    """A fan."""
    facet = struct.Struct("<12f2x")
    corners = ((0, 0, 0, k, 1, 0, k + 1, 1, 0, 0, 0, -1) for k in range(triangles))
    return b" " * 80 + struct.pack("<I", triangles) + b"".join(facet.pack(*c) for c in corners)


@pytest.mark.parametrize("damage", ["none", "infinite", "short", "long", "png", "text"])
def test_a_large_stl_file_is_read_in_pieces_with_the_same_result(tmp_path, monkeypatch, damage):
    monkeypatch.setattr(opening, "LARGE_FILE_BYTES", 1)
    content = bytearray(stl_of(300))
    if damage == "infinite":
        content[84 + 50 * 200 + 12 : 84 + 50 * 200 + 16] = struct.pack("<f", float("inf"))
    elif damage == "short":
        del content[-1:]
    elif damage == "long":
        content += b"x"
    elif damage == "png":
        content[:6] = b"\x89PNG\r\n"
    elif damage == "text":
        content = bytearray(b"solid x\nendsolid x\n" * 10)
    path = tmp_path / "fan.stl"
    path.write_bytes(content)
    pieces = MeshFiles(ReadLimits(hashed=False)).item(FilePart("fan.stl", str(path))).shape
    whole = MeshFiles().item(FilePart("fan.stl", str(path))).shape
    if damage == "none":
        assert isinstance(pieces, MeshFile)
        assert isinstance(whole, MeshFile)
        _, file = open_file("", path, required_reader, ReadLimits(1, hashed=False))
        assert file.in_pieces
        assert pieces.sha256 is None
        assert pieces.mesh.to_bytes() == whole.mesh.to_bytes()
        assert (pieces.health, pieces.resolution) == (whole.health, whole.resolution)
    else:
        assert isinstance(pieces, Refused)
        assert isinstance(whole, Refused)
        assert (pieces.code, str(pieces)) == (whole.code, str(whole))


def test_a_large_stl_file_that_shrinks_while_it_is_read_is_refused(tmp_path, monkeypatch):
    monkeypatch.setattr(opening, "LARGE_FILE_BYTES", 1)
    path = tmp_path / "fan.stl"
    path.write_bytes(stl_of(300))
    _, file = open_file("fan.stl", path, required_reader, ReadLimits(1, hashed=False))
    assert file.in_pieces
    path.write_bytes(stl_of(300)[:1000])
    with pytest.raises(Refused, match="byte 1000: truncated while it was read"):
        read_native(file)
    path.unlink()
    with pytest.raises(Refused, match="cannot be read: No such file"):
        read_native(file)


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
