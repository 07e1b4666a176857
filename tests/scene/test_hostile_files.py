"""Files that try to cost much, to hang, or to reach beyond their folder: each has its own error."""

from __future__ import annotations

import base64
import io
import json
import os
import struct
import sys
import zipfile

import pytest

from satcheck.core.errors import SatcheckError
from satcheck.scene import SceneFileError, load_scene
from satcheck.scene.loading import limits, source
from tests.scene import files, graphs, test_threedxml
from tests.scene.loading import refusal
from tests.scene.robot import robots

DEEP = 100_000
needs_links = pytest.mark.skipif(sys.platform == "win32", reason="links need a privilege")
needs_pipes = pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="there are no named pipes")


def issues(path, **options):
    return [(issue.code, issue.message) for issue in load_scene([path], **options).issues]


def bomb(name, size=64 << 20):
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr(name, b" " * size)
    return stream.getvalue()


# ---- archives


@pytest.mark.parametrize(
    ("name", "part"),
    [("a.3mf", "3D/3dmodel.model"), ("a.zae", "a.dae"), ("a.3dxml", "Manifest.xml")],
)
def test_a_part_that_unpacks_to_a_thousand_times_its_size(tmp_path, name, part):
    code, message = refusal(tmp_path, name, bomb(part))
    assert code == "too-large"
    assert part in message


def test_an_archive_in_an_archive_is_not_opened(tmp_path):
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w") as archive:
        archive.writestr("a.dae", bomb("b.dae"))
    assert refusal(tmp_path, "a.zae", stream.getvalue())[0] in ("bad-encoding", "bad-record")


def test_entries_that_overlap(tmp_path):
    """Many names for one part (D. Fifield, "A better zip bomb", 2019): only what is placed is
    read."""
    data = bytearray(files.threemf())
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        start = archive.start_dir
    directory, end = data[start:-22], data[-22:]
    count = 20_000
    struct.pack_into("<HHI", end, 8, *(2 * count % 65536,) * 2, len(directory) * count)
    code_or_none = issues_of(tmp_path, "a.3mf", bytes(data[:start] + directory * count + end))
    assert code_or_none in ([], ["not-this-format"], ["bad-record"])


def issues_of(folder, name, content):
    (folder / name).write_bytes(content)
    return [code for code, _ in issues(folder / name)]


def test_an_archive_of_many_entries(tmp_path):
    stream = io.BytesIO(files.threemf())
    with zipfile.ZipFile(stream, "a") as archive:
        for k in range(20_000):
            archive.writestr(f"{k}.model", b"")
    assert issues_of(tmp_path, "a.3mf", stream.getvalue()) == []


@pytest.mark.parametrize("name", ["../x.dae", "/etc/x.dae", "C:\\x.dae", "\\\\host\\x.dae"])
def test_names_of_entries_are_no_paths(tmp_path, name):
    """An entry is read from the archive, whatever it is called, and nothing is unpacked."""
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w") as archive:
        archive.writestr(name, files.collada())
    assert issues_of(tmp_path, "a.zae", stream.getvalue()) == []
    assert [path.name for path in tmp_path.iterdir()] == ["a.zae"]


@pytest.mark.parametrize("target", ["../../etc/x", "/etc/x", "C:\\x", "%2e%2e/x"])
def test_a_3mf_names_only_its_own_parts(tmp_path, target):
    package = files.package_3mf({"3D/3dmodel.model": files.model_3mf("", "")}, target)
    assert refusal(tmp_path, "a.3mf", package)[0] == "missing-resource"


# ---- XML


LAUGHS = '<!DOCTYPE x [<!ENTITY a "ha"><!ENTITY b "&a;&a;&a;&a;">]>'
OUTSIDE = '<!DOCTYPE x [<!ENTITY a SYSTEM "file:///etc/passwd">]>'
REMOTE = '<!DOCTYPE x SYSTEM "http://127.0.0.1:9/x.dtd">'
XML = {
    "a.dae": files.collada(),
    "a.xaml": b"<Viewport3D/>",
    "a.urdf": robots.robot_of(robots.link("a")).encode(),
    "a.svg": b'<svg xmlns="http://www.w3.org/2000/svg"/>',
}


def code_of(folder, name, content):
    (folder / name).write_bytes(content)
    try:
        return next(iter(code for code, _ in issues(folder / name)), "read")
    except SatcheckError as error:
        return error.code


@pytest.mark.parametrize("name", XML)
@pytest.mark.parametrize("doctype", [LAUGHS, OUTSIDE])
def test_entities_are_refused(tmp_path, name, doctype):
    content = XML[name].split(b"?>", 1)[-1]
    assert code_of(tmp_path, name, doctype.encode() + content) == "entity-declaration"


@pytest.mark.parametrize("name", XML)
def test_a_remote_document_type_is_not_fetched(tmp_path, name):
    content = XML[name].split(b"?>", 1)[-1]
    expected = code_of(tmp_path, name, content)
    assert code_of(tmp_path, name, REMOTE.encode() + content) == expected


@pytest.mark.parametrize("name", XML)
def test_deep_xml(tmp_path, name):
    root = XML[name].split(b"?>", 1)[-1].split(b">")[0].strip(b" /") + b">"
    end = b"</" + root.split()[0].strip(b"<>") + b">"
    content = root + b"<a>" * DEEP + b"</a>" * DEEP + end
    assert code_of(tmp_path, name, content) == "too-large"


def test_deep_archives_of_xml(tmp_path):
    deep = "<Root>" + "<Rep>" * DEEP
    found = load_scene([write(tmp_path, "a.3dxml", test_threedxml.threedxml(cube=deep))])
    assert {issue.code for issue in found.issues} == {"too-large"}


def write(folder, name, content):
    (folder / name).write_bytes(content)
    return folder / name


# ---- JSON and TOML


@pytest.mark.parametrize("opening", ["[", '{"a":'])
@pytest.mark.parametrize("name", ["a.json", "a.gltf"])
def test_deep_json(tmp_path, name, opening):
    assert code_of(tmp_path, name, (opening * DEEP).encode()) in ("bad-scene", "bad-record")


TOML = ["a = " + "[" * DEEP, "a." * DEEP + "b = 1", "[" + "a." * DEEP + "b]"]
TOML += ["'a' . " * DEEP + "b = 1", '"a".' * DEEP + "b = 1", "a" * DEEP * 100, "'" * DEEP * 100]


@pytest.mark.parametrize("text", TOML, ids=range(len(TOML)))
def test_deep_toml(tmp_path, text):
    assert code_of(tmp_path, "a.toml", text.encode()) == "bad-scene"


@pytest.mark.parametrize("digits", [5000, 1_000_000])
def test_numbers_of_many_digits(tmp_path, digits):
    number = "1" * digits
    body = f'{{"id": "a", "mesh": "a.obj", "position": [{number}, 0, 0]}}'
    scene = f'{{"schema": "satcheck.scene/1", "bodies": [{body}]}}'
    assert code_of(tmp_path, "a.json", scene.encode()) == "bad-scene"
    gltf = f'{{"asset": {{"version": "2.0"}}, "scene": {number}}}'
    assert code_of(tmp_path, "a.gltf", gltf.encode()) == "bad-record"


# ---- graphs


def test_nodes_that_double_at_each_level(tmp_path):
    """2^50,000 nodes in 2 MB; the count itself would have 15,000 digits."""
    depth = 50_000
    nodes = [{"children": [k + 1, k + 1]} for k in range(depth)] + [{"mesh": 0}]
    code, message = refusal(tmp_path, "a.glb", graphs.glb(nodes, roots=[0]))
    assert code == "too-large"
    assert "more than 1000000" in message


@pytest.mark.parametrize("children", [[[0]], [[1], [0]], [[1], [2], [0]]])
def test_nodes_in_a_circle(tmp_path, children):
    nodes = [{"children": each, "mesh": 0} for each in children]
    assert refusal(tmp_path, "a.glb", graphs.glb(nodes, roots=[0]))[0] == "reference-cycle"


def test_a_chain_of_nodes_with_a_mesh_each(tmp_path):
    """Paths are cut, so their lengths do not add up to the square of the depth."""
    count = 3000
    nodes = [{"mesh": 0, "name": "n" * 80, "children": [k + 1]} for k in range(count)]
    scene = load_scene([write(tmp_path, "a.glb", graphs.glb([*nodes, {"mesh": 0}]))])
    assert len(scene.bodies) == count + 1
    assert max(len(body.id) for body in scene.bodies) < 300


def with_primitives(count, vertices=1000):
    """One mesh that names the same vertices again and again."""
    points = [*files.TETRAHEDRON_POINTS, *((k, k, k) for k in range(vertices))]
    document, buffer = files.gltf_document(points, files.TETRAHEDRON)
    document["meshes"][0]["primitives"] *= count
    return document, buffer


def test_numbers_that_are_named_again_and_again(tmp_path, monkeypatch):
    """Few bytes name many numbers, so a child with a limit on its memory reads them."""
    monkeypatch.setattr(limits, "IN_PROCESS_WORK", 1 << 20)
    content = files.glb(*with_primitives(100))
    assert load_scene([write(tmp_path, "a.glb", content)]).bodies
    content = files.glb(*with_primitives(5000, 10_000))
    path = write(tmp_path, "b.glb", content)
    (found,) = issues(path, megabytes_per_file=256)
    assert found[0] in ("reader-out-of-memory", "reader-timeout")
    assert "--megabytes-per-file" in found[1] or "--seconds-per-file" in found[1]


def test_a_buffer_that_is_named_again_and_again(tmp_path, monkeypatch):
    monkeypatch.setattr(limits, "IN_PROCESS_WORK", 1 << 20)
    document, buffer = files.gltf_document()
    document["buffers"] = [{"uri": "big.bin", "byteLength": 1 << 24} for _ in range(64)]
    document["bufferViews"] = [{**view, "buffer": 63} for view in document["bufferViews"]]
    (tmp_path / "big.bin").write_bytes(buffer.ljust(1 << 24, b"\0"))
    path = write(tmp_path, "a.gltf", json.dumps(document).encode())
    assert issues(path) == []


# ---- paths


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
    assert refusal(tmp_path, "a.gltf", content)[0] == "missing-resource"


def scene_with(mesh):
    bodies = [{"id": "a", "mesh": mesh}, {"id": "b", "mesh": mesh}]
    return json.dumps({"schema": "satcheck.scene/1", "bodies": bodies})


def scene_error(folder, mesh):
    (folder / "a.json").write_text(scene_with(mesh))
    with pytest.raises(SceneFileError) as caught:
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
@pytest.mark.parametrize("name", ["a.obj", "a.glb", "a.json", "a.toml", "a.urdf", "a.svg", "a.dae"])
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
    monkeypatch.setattr(source, "size_of", lambda _: 0)
    assert issues(write(tmp_path, "a.obj", files.obj())) == []
    (found,) = issues(write(tmp_path, "b.obj", b"#" * (5 << 20)), megabytes_per_file=16)
    assert found[0] == "too-large"
    assert "--megabytes-per-file" in found[1]


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


# ---- lying counts


@pytest.mark.parametrize("count", [1 << 31, 1 << 32, 1 << 63, 1 << 64, -1, 10**400])
@pytest.mark.parametrize("key", ["count", "byteOffset"])
def test_accessors_that_promise_much(tmp_path, count, key):
    document, buffer = files.gltf_document()
    document["accessors"][0][key] = count
    code, _ = refusal(tmp_path, "a.glb", files.glb(document, buffer))
    assert code in ("index-out-of-range", "bad-record")


@pytest.mark.parametrize("count", [1 << 31, 1 << 63, 10**400])
@pytest.mark.parametrize("key", ["byteLength", "byteOffset", "byteStride"])
def test_views_that_promise_much(tmp_path, count, key):
    document, buffer = files.gltf_document()
    document["bufferViews"][0][key] = count
    code, _ = refusal(tmp_path, "a.glb", files.glb(document, buffer))
    assert code in ("index-out-of-range", "bad-record", "truncated")


def test_data_uris_that_are_no_data(tmp_path):
    document, buffer = files.gltf_document()
    good = base64.b64encode(buffer).decode()
    for uri in (f"data:;base64,{good[:-5]}", f"data:,{good}", "data:", f"data:;base64,{good}é"):
        document["buffers"][0]["uri"] = uri
        content = json.dumps(document).encode()
        assert refusal(tmp_path, "a.gltf", content)[0] in ("bad-record", "truncated")


@pytest.mark.parametrize("count", ["2147483648", "9223372036854775808", "-1", "9" * 5000])
def test_collada_counts_that_lie(tmp_path, count):
    content = files.collada().replace(b'count="24"', f'count="{count}"'.encode())
    assert refusal(tmp_path, "a.dae", content)[0] in ("count-mismatch", "bad-record")
