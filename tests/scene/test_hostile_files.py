"""Files that try to cost much, to hang, or to reach beyond their folder: each has its own error."""

from __future__ import annotations

import base64
import io
import json
import struct
import zipfile

import pytest

from satcheck.scene import load_scene
from satcheck.scene.files import limits
from tests.plugin_marks import needs
from tests.plugins.ifc.models import Model
from tests.scene import files, graphs
from tests.scene.hostile import code_of, issues, issues_of, write
from tests.scene.loading import refusal
from tests.scene.robot import robots

DEEP = 100_000


def bomb(name, stated=1 << 30):
    """An archive whose part says that it unpacks to so many bytes."""
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr(name, b" " * 100_000)
    data = bytearray(stream.getvalue())
    directory = data.rindex(b"PK\x01\x02")
    struct.pack_into("<I", data, directory + 24, stated)
    return bytes(data)


@pytest.mark.parametrize(
    ("name", "part"),
    [("a.3mf", "3D/3dmodel.model"), pytest.param("a.ifczip", "a.ifc", marks=needs("ifc"))],
)
def test_a_part_that_unpacks_to_more_than_a_file_may_have(tmp_path, name, part):
    code, message = refusal(tmp_path, name, bomb(part))
    assert code == "too-large"
    assert part in message
    assert "--limit megabytes" in message


@needs("ifc")
def test_an_archive_in_an_archive_is_not_opened(tmp_path):
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w") as archive:
        archive.writestr("a.ifc", bomb("b.ifc"))
    assert refusal(tmp_path, "a.ifczip", stream.getvalue())[0] == "not-this-format"


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


def test_an_archive_of_many_entries(tmp_path):
    stream = io.BytesIO(files.threemf())
    with zipfile.ZipFile(stream, "a") as archive:
        for k in range(20_000):
            archive.writestr(f"{k}.model", b"")
    assert issues_of(tmp_path, "a.3mf", stream.getvalue()) == ["left-out"]


@needs("ifc")
@pytest.mark.parametrize("name", ["../x.ifc", "/etc/x.ifc", "C:\\x.ifc", "\\\\host\\x.ifc"])
def test_names_of_entries_are_no_paths(tmp_path, name):
    """An entry is read from the archive, whatever it is called, and nothing is unpacked."""
    model = Model()
    model.box((1, 1, 1))
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w") as archive:
        archive.writestr(name, model.text())
    assert issues_of(tmp_path, "a.ifczip", stream.getvalue()) == []
    assert [path.name for path in tmp_path.iterdir()] == ["a.ifczip"]


@pytest.mark.parametrize("target", ["../../etc/x", "/etc/x", "C:\\x", "%2e%2e/x"])
def test_a_3mf_names_only_its_own_parts(tmp_path, target):
    package = files.package_3mf({"3D/3dmodel.model": files.model_3mf("", "")}, target)
    assert refusal(tmp_path, "a.3mf", package)[0] == "missing-resource"


LAUGHS = '<!DOCTYPE x [<!ENTITY a "ha"><!ENTITY b "&a;&a;&a;&a;">]>'


OUTSIDE = '<!DOCTYPE x [<!ENTITY a SYSTEM "file:///etc/passwd">]>'


REMOTE = '<!DOCTYPE x SYSTEM "http://127.0.0.1:9/x.dtd">'


XML = {
    "a.dae": files.collada(),
    "a.urdf": robots.robot_of(robots.link("a")).encode(),
}


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


def test_nodes_that_double_at_each_level(tmp_path):
    """2^50,000 nodes in 2 MB; the count itself would have 15,000 digits."""
    depth = 50_000
    nodes = [{"children": [k + 1, k + 1]} for k in range(depth)] + [{"mesh": 0}]
    code, message = refusal(tmp_path, "a.glb", graphs.glb(nodes, roots=[0]))
    assert code == "too-large"
    assert "more than 200000" in message


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
    assert "--limit megabytes" in found[1] or "--limit seconds" in found[1]


def test_indices_that_name_their_data_again_and_again(tmp_path, monkeypatch):
    content = files.glb(*with_primitives(100))
    assert load_scene([write(tmp_path, "a.glb", content)]).bodies
    monkeypatch.setattr(limits, "MAX_REPEATED", 0)
    monkeypatch.setattr(limits, "ANY_REPEATED", 120)
    code, message = refusal(tmp_path, "b.glb", content)
    assert (code, "indices name the data" in message) == ("too-large", True)


def test_a_buffer_that_is_named_again_and_again(tmp_path, monkeypatch):
    monkeypatch.setattr(limits, "IN_PROCESS_WORK", 1 << 20)
    document, buffer = files.gltf_document()
    document["buffers"] = [{"uri": "big.bin", "byteLength": 1 << 24} for _ in range(64)]
    document["bufferViews"] = [{**view, "buffer": 63} for view in document["bufferViews"]]
    (tmp_path / "big.bin").write_bytes(buffer.ljust(1 << 24, b"\0"))
    path = write(tmp_path, "a.gltf", json.dumps(document).encode())
    assert issues(path) == []


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


def test_an_integer_of_thousands_of_digits(tmp_path):
    content = f'{{"asset": {{"version": "2.0"}}, "scene": {"9" * 5000}}}'.encode()
    code, message = refusal(tmp_path, "a.gltf", content)
    assert code == "bad-record"
    assert message.endswith("JSON: a number of more than 4300 digits")


@pytest.mark.parametrize("count", ["2147483648", "9223372036854775808", "-1", "9" * 5000])
def test_collada_counts_that_lie(tmp_path, count):
    content = files.collada().replace(b'count="24"', f'count="{count}"'.encode())
    assert refusal(tmp_path, "a.dae", content)[0] in ("count-mismatch", "bad-record")
