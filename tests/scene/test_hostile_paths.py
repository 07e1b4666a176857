"""Names in files that lead elsewhere: other folders, links, pipes and devices."""

from __future__ import annotations

import json
import os

import pytest

from satcheck.core.errors import SatcheckError
from satcheck.scene import Refused, load_scene, opening
from satcheck.scene.files import limits
from tests.scene import files
from tests.scene.hostile import issues, needs_links, needs_pipes, write
from tests.scene.loading import refusal
from tests.scene.robot import robots

OUTSIDE_PATHS = ["../b.bin", "sub/../../b.bin", "%2e%2e/b.bin", "/etc/hostname", "C:/b.bin"]

OUTSIDE_PATHS += ["\\\\host\\b.bin", "file:///etc/hostname", "http://127.0.0.1:9/b.bin", "..\\b"]


@pytest.mark.parametrize("uri", OUTSIDE_PATHS)
def test_a_buffer_lies_in_the_folder_of_its_file(tmp_path, uri):
    document, buffer = files.gltf_document()
    (tmp_path / "b.bin").write_bytes(buffer)
    folder = tmp_path / "in"
    folder.mkdir()
    document["buffers"][0]["uri"] = uri
    found = refusal(folder, "a.gltf", json.dumps(document).encode())
    assert found[0] == "outside-path"


@needs_links
@pytest.mark.parametrize("target", ["../b.bin", "/dev/zero", "loop.bin", "/proc/self/mem"])
def test_a_link_to_a_buffer_does_not_leave_the_folder(tmp_path, target):
    document, buffer = files.gltf_document()
    (tmp_path / "b.bin").write_bytes(buffer)
    folder = tmp_path / "in"
    folder.mkdir()
    (folder / "loop.bin").symlink_to(target)
    document["buffers"][0]["uri"] = "loop.bin"
    found = refusal(folder, "a.gltf", json.dumps(document).encode())
    assert found[0] == ("missing-resource" if target == "loop.bin" else "outside-path")


@pytest.mark.parametrize("uri", ["A" * 5000, "\ud800.bin", "", ".", "a\nb.bin"])
def test_names_that_no_buffer_has(tmp_path, uri):
    document, _ = files.gltf_document()
    document["buffers"][0]["uri"] = uri
    content = json.dumps(document).encode()
    code = "not-a-file" if uri in ("", ".") else "missing-resource"
    assert refusal(tmp_path, "a.gltf", content)[0] == code


@needs_pipes
@pytest.mark.parametrize(("make", "what"), [("mkfifo", "a pipe"), ("mkdir", "a directory")])
def test_what_a_file_names_is_said_where_it_is_no_file(tmp_path, make, what):
    getattr(os, make)(tmp_path / "b.stl")
    document, _ = files.gltf_document()
    document["buffers"][0]["uri"] = "b.stl"
    mesh = '<collision><geometry><mesh filename="b.stl"/></geometry></collision>'
    robot = robots.robot_of(robots.link("a", mesh)).encode()
    for name, content in (("a.gltf", json.dumps(document).encode()), ("a.urdf", robot)):
        (found,) = issues(write(tmp_path, name, content))
        assert found[0] == "not-a-file"
        assert f"is {what}, not a file" in found[1]
    error = scene_error(tmp_path, "b.stl")
    assert (error.code, f"is {what}, not a file" in str(error)) == ("not-a-file", True)


def scene_with(mesh):
    bodies = [{"id": "a", "mesh": mesh}, {"id": "b", "mesh": mesh}]
    return json.dumps({"schema": "satcheck.scene/1", "bodies": bodies})


def scene_error(folder, mesh):
    (folder / "a.json").write_text(scene_with(mesh))
    with pytest.raises(Refused) as caught:
        load_scene([folder / "a.json"])
    return caught.value


@pytest.mark.parametrize("mesh", ["../c.obj", "/etc/c.obj", "in/../../c.obj"])
def test_a_mesh_lies_in_the_folder_of_its_scene(tmp_path, mesh):
    folder = tmp_path / "scene"
    folder.mkdir()
    (tmp_path / "c.obj").write_bytes(files.obj())
    error = scene_error(folder, mesh)
    assert error.code == "outside-path"
    assert "--allow-outside" in error.message


@pytest.mark.parametrize(
    "mesh", ["A" * 5000 + ".obj", "\ud800.obj", "a\nb.obj", "a/" * 3000 + ".obj"]
)
def test_names_that_no_mesh_has(tmp_path, mesh):
    assert scene_error(tmp_path, mesh).code in ("missing-resource", "unsupported-format")


@needs_links
def test_links_in_a_circle(tmp_path):
    for a, b in (("a.obj", "b.obj"), ("b.obj", "a.obj")):
        (tmp_path / a).symlink_to(b)
    assert scene_error(tmp_path, "a.obj").code in ("missing-resource", "outside-path")
    assert [code for code, _ in issues(tmp_path / "a.obj")] == ["unreadable-file"]
    folder = tmp_path / "folder"
    folder.symlink_to("folder")
    assert issues(folder / "a.obj")[0][0] in ("unreadable-file", "file-not-found")


@needs_links
def test_a_link_to_a_mesh_does_not_leave_the_folder(tmp_path):
    folder = tmp_path / "scene"
    folder.mkdir()
    (tmp_path / "c.obj").write_bytes(files.obj())
    (folder / "c.obj").symlink_to("../c.obj")
    assert scene_error(folder, "c.obj").code == "outside-path"


@needs_pipes
@pytest.mark.parametrize("name", ["a.obj", "a.glb", "a.json", "a.toml", "a.urdf", "a.dae"])
def test_a_named_pipe_is_not_opened(tmp_path, name):
    os.mkfifo(tmp_path / name)
    try:
        found = [code for code, _ in issues(tmp_path / name)]
    except SatcheckError as error:
        found = [error.code]
    assert found == ["not-a-file"]


@needs_pipes
def test_a_pipe_beside_a_robot_is_not_opened(tmp_path):
    """The search for packages reads package.xml of the folders around the robot."""
    (tmp_path / "other").mkdir()
    os.mkfifo(tmp_path / "other" / "package.xml")
    mesh = '<collision><geometry><mesh filename="package://p/a.obj"/></geometry></collision>'
    (tmp_path / "urdf").mkdir()
    path = tmp_path / "urdf" / "a.urdf"
    path.write_text(robots.robot_of(robots.link("a", mesh)))
    assert [code for code, _ in issues(path)] == ["missing-resource"]


@needs_links
@pytest.mark.parametrize("device", ["/dev/zero", "/dev/stdin", "/dev/random", "/proc/self/fd/0"])
@pytest.mark.parametrize("name", ["a.stl", "a.gltf", "a.json"])
def test_a_link_to_a_device_is_not_read(tmp_path, device, name):
    (tmp_path / name).symlink_to(device)
    try:
        found = [code for code, _ in issues(tmp_path / name)]
    except SatcheckError as error:
        found = [error.code]
    assert found[0] in ("not-a-file", "bad-scene", "not-this-format", "empty-mesh", "bad-record")


def test_a_file_that_states_no_size_is_read_up_to_the_limit(tmp_path, monkeypatch):
    """As those of /proc do, and files that grow."""
    monkeypatch.setattr(opening, "size_of", lambda _: 0)
    assert issues(write(tmp_path, "a.obj", files.obj())) == []
    (found,) = issues(write(tmp_path, "b.obj", b"#" * (5 << 20)), megabytes_per_file=16)
    assert found[0] == "too-large"
    assert "--limit megabytes" in found[1]


def test_a_buffer_elsewhere_that_the_user_allows(tmp_path, monkeypatch):
    """Also of a file that a child process reads."""
    monkeypatch.setattr(limits, "IN_PROCESS_BYTES", 0)
    document, buffer = files.gltf_document()
    (tmp_path / "b.bin").write_bytes(buffer)
    document["buffers"][0]["uri"] = (tmp_path / "b.bin").as_posix()
    folder = tmp_path / "in"
    folder.mkdir()
    path = write(folder, "a.gltf", json.dumps(document).encode())
    assert issues(path, allow_outside=True) == []
    assert [code for code, _ in issues(path)] == ["outside-path"]
