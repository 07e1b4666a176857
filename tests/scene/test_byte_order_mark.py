"""Text reads the same with a byte order mark, in the encoding that the mark tells of, and with NUL
bytes after its end."""

from __future__ import annotations

import codecs
import json
import struct

import pytest

from satcheck.scene import Refused, load_scene
from tests.scene import files
from tests.scene.loading import loaded, refusal, warnings

DOCUMENT, BUFFER = files.gltf_document()
TEXTS = {
    "cube.obj": files.obj(),
    "cube.stl": files.ascii_stl(),
    "cube.ply": files.ascii_ply(),
    "cube.off": files.off(),
    "cube.gltf": json.dumps(
        {**DOCUMENT, "buffers": [{"byteLength": len(BUFFER), "uri": "cube.bin"}]}
    ).encode(),
    "cube.dae": files.collada(),
}
ENCODINGS = {
    "utf-8": codecs.BOM_UTF8,
    "utf-16-le": codecs.BOM_UTF16_LE,
    "utf-16-be": codecs.BOM_UTF16_BE,
}


def marked(content: bytes, encoding: str) -> bytes:
    text = content.decode()
    if encoding != "utf-8":
        text = text.replace('encoding="utf-8"', 'encoding="utf-16"')
        text = text.replace('encoding="UTF-8"', 'encoding="UTF-16"')
    return ENCODINGS[encoding] + text.encode(encoding)


@pytest.mark.parametrize("encoding", ENCODINGS)
@pytest.mark.parametrize("name", TEXTS)
def test_a_mesh_keeps_its_first_vertex(tmp_path, name, encoding):
    (tmp_path / "cube.bin").write_bytes(BUFFER)
    file = loaded(tmp_path, name, marked(TEXTS[name], encoding))
    assert warnings(file) == {}
    assert file.mesh.vertex_count == 8
    assert file.health.volume == 1.0


@pytest.mark.parametrize("encoding", ENCODINGS)
def test_the_parts_of_a_3mf_package(tmp_path, encoding):
    model = files.model_3mf(files.object_3mf(1), '<item objectid="1"/>')
    content = files.package_3mf({"3D/3dmodel.model": marked(model, encoding)})
    assert loaded(tmp_path, "cube.3mf", content).health.volume == 1.0


def test_the_json_of_a_glb_file(tmp_path):
    glb = files.glb()
    size = int.from_bytes(glb[12:16], "little")
    text = codecs.BOM_UTF8 + glb[20 : 20 + size] + b" "
    content = glb[:8] + (len(glb) + 4).to_bytes(4, "little") + len(text).to_bytes(4, "little")
    content += glb[16:20] + text + glb[20 + size :]
    assert loaded(tmp_path, "cube.glb", content).health.volume == 1.0


def test_a_binary_ply_behind_a_mark(tmp_path):
    content = codecs.BOM_UTF8 + files.binary_ply()
    assert loaded(tmp_path, "cube.ply", content).health.volume == 1.0


def test_a_binary_stl_whose_header_looks_like_a_mark(tmp_path):
    for mark in ENCODINGS.values():
        content = files.binary_stl(header=mark)
        assert loaded(tmp_path, "cube.stl", content).health.volume == 1.0


def test_text_that_is_not_what_its_mark_says(tmp_path):
    code, message = refusal(tmp_path, "cube.obj", codecs.BOM_UTF16_LE + files.obj() + b"\xd8")
    assert code == "bad-encoding"
    assert "UTF-16" in message


BODY = '{"id": "a", "shape": {"type": "sphere", "radius": 1}}'
PLACED = {
    "cell.json": f'{{"schema": "satcheck.scene/1", "bodies": [{BODY}]}}',
    "cell.toml": 'schema = "satcheck.scene/1"\n[[bodies]]\nid = "a"\n'
    'shape = {type = "sphere", radius = 1}\n',
    "arm.urdf": '<robot name="r"><link name="a"><collision><geometry><sphere radius="1"/>'
    "</geometry></collision></link></robot>",
}


@pytest.mark.parametrize("name", PLACED)
def test_scenes_and_robots(tmp_path, name):
    (tmp_path / name).write_bytes(codecs.BOM_UTF8 + PLACED[name].encode())
    assert [body.id for body in load_scene([tmp_path / name]).bodies] == ["a"]


@pytest.mark.parametrize("name", ["cell.json", "cell.toml"])
def test_a_scene_in_utf_16_is_refused(tmp_path, name):
    (tmp_path / name).write_bytes(marked(PLACED[name].encode(), "utf-16-le"))
    with pytest.raises(Refused, match="not UTF-8"):
        load_scene([tmp_path / name])


def test_what_goes_with_a_robot(tmp_path):
    from satcheck.scene.robot import read_srdf

    path = tmp_path / "arm.srdf"
    path.write_bytes(codecs.BOM_UTF8 + b'<robot name="r"/>')
    assert read_srdf(str(path)).robot == "r"


@pytest.mark.parametrize("name", TEXTS)
def test_nul_bytes_after_the_end_of_a_text_are_no_text(tmp_path, name):
    (tmp_path / "cube.bin").write_bytes(BUFFER)
    file = loaded(tmp_path, name, TEXTS[name] + b"\0\0\0")
    assert warnings(file) == {}
    assert file.health.volume == 1.0


@pytest.mark.parametrize("name", ["cube.obj", "cube.stl", "cube.ply", "cube.off", "cube.gltf"])
def test_a_nul_byte_within_a_text_is_an_error(tmp_path, name):
    (tmp_path / "cube.bin").write_bytes(BUFFER)
    text = TEXTS[name]
    assert refusal(tmp_path, name, text[:-2] + b"\0" + text[-2:])


def test_the_last_byte_of_binary_data_may_be_the_only_nul(tmp_path):
    """It is the number of a vertex, after that of vertex 10, a line feed."""
    header = files.ply_header("binary_little_endian", 11, 1).replace(b"uchar int", b"uchar uchar")
    points = [(1.1 + k, 1.1, 1.1 + k * k) for k in range(11)]
    rows = b"".join(struct.pack("<3f", *point) for point in points) + bytes((3, 1, 10, 0))
    content = header + rows
    assert content.index(b"\0") == len(content) - 1
    assert loaded(tmp_path, "a.ply", content).mesh.triangle_count == 1


@pytest.mark.parametrize(
    ("name", "text"),
    [
        (
            "a.json",
            '{"schema": "satcheck.scene/1", "bodies": '
            '[{"id": "a", "shape": {"type": "box", "size": [1, 1, 1]}}]}',
        ),
        (
            "a.urdf",
            '<robot name="r"><link name="a"><collision><geometry><box size="1 1 1"/></geometry>'
            "</collision></link></robot>",
        ),
    ],
)
def test_nul_bytes_after_a_scene_or_a_robot_are_no_text(tmp_path, name, text):
    (tmp_path / name).write_bytes(text.encode() + b"\0")
    assert [body.id for body in load_scene([tmp_path / name]).bodies] == ["a"]


def test_a_toml_scene_with_nul_bytes_may_have_lost_bodies(tmp_path):
    body = '[[bodies]]\nid = "a"\nshape = {type = "box", size = [1, 1, 1]}\n'
    (tmp_path / "a.toml").write_bytes(f'schema = "satcheck.scene/1"\n{body}'.encode() + b"\0" * 90)
    with pytest.raises(Refused, match="NUL bytes") as error:
        load_scene([tmp_path / "a.toml"])
    assert error.value.line == 5


def test_a_json_scene_that_lost_its_end_is_never_whole(tmp_path):
    text = b'{"schema": "satcheck.scene/1", "bodies": [\n{"id": "a"}\n' + b"\0" * 90
    (tmp_path / "a.json").write_bytes(text)
    with pytest.raises(Refused, match="not well-formed JSON"):
        load_scene([tmp_path / "a.json"])
