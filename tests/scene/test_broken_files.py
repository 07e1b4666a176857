"""Each class of defect: refused with a stable code and the reason, or loaded with a warning."""

from __future__ import annotations

import json
import os
import struct

import pytest

from satcheck.scene import CODES
from tests.scene import files
from tests.scene.loading import loaded, refusal, warnings

NAN = float("nan")
CUBE = files.obj()
STL = files.binary_stl()
PLY = files.binary_ply()
ASCII_PLY = files.ascii_ply()
ASCII_STL = files.ascii_stl()
OFF = files.off()
GLB = files.glb()


def glb_of(*kinds: bytes) -> bytes:
    """A GLB file with a chunk of each kind. Each holds the JSON of a cube."""
    text = GLB[20 : 20 + int.from_bytes(GLB[12:16], "little")]
    chunks = b"".join(struct.pack("<I4s", len(text), kind) + text for kind in kinds)
    return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


def with_document(**changes):
    document, buffer = files.gltf_document()
    for path, value in changes.items():
        *keys, last = path.split("__")
        owner = document
        for key in keys:
            owner = owner[int(key) if key.isdecimal() else key]
        owner[int(last) if last.isdecimal() else last] = value
    return files.glb(document, buffer)


def gltf_with_uri(uri):
    document, _ = files.gltf_document()
    document["buffers"][0]["uri"] = uri
    return json.dumps(document).encode()


def points_with(value):
    return [(value, 0, 0), *files.CUBE_POINTS[1:]]


_CUBE_NODE = '<node id="n">{}<instance_geometry url="#g"/></node>'
_OTHER = "http://schemas.example.com/another"


REFUSED = {
    # name: (content, code, what the message must say)
    "empty.obj": (b"", "empty-mesh", "no vertices"),
    "cloud.obj": (b"v 0 0 0\nv 1 0 0\nv 0 1 0\n", "empty-mesh", "3 vertices but no triangles"),
    "text.obj": (b"Dear all,\nplease find\n", "not-this-format", "'Dear'"),
    "binary.obj": (b"v 0 0\0", "not-this-format", "binary"),
    "zero.obj": (CUBE + b"f 0 1 2\n", "index-out-of-range", "line 21: face index out of range: 0"),
    "high.obj": (CUBE + b"f 1 2 9\n", "index-out-of-range", "line 21"),
    "low.obj": (CUBE + b"f 1 2 -9\n", "index-out-of-range", "-9 of 8"),
    "huge.obj": (CUBE + b"f 1 2 99999999999999999999\n", "index-out-of-range", "line 21"),
    "forward.obj": (b"f 1 2 3\nv 0 0 0\nv 1 0 0\n", "index-out-of-range", "line 1"),
    "nan.obj": (b"v 0 0 0\nv nan 0 0\n", "non-finite", "line 2"),
    "inf.obj": (b"v 0 -Inf 0\n", "non-finite", "line 1"),
    "overflow.obj": (b"v 0 0 1e999\n", "non-finite", "too large"),
    "comma.obj": (b"v 0,0 0 0\n", "bad-record", "'0,0'"),
    "short_vertex.obj": (b"v 0 0\n", "bad-record", "3 coordinates"),
    "bad_corner.obj": (CUBE + b"f 1 2 x\n", "bad-record", "line 21"),
    "bad_slash.obj": (CUBE + b"f 1 2 3/x\n", "bad-record", "'3/x'"),
    "stl.obj": (STL, "format-mismatch", "binary STL"),
    "png.stl": (b"\x89PNG\r\n\x1a\n" + b"\0" * 90, "format-mismatch", "PNG"),
    "pointer.glb": (
        b"version https://git-lfs.github.com/spec/v1\noid sha256:0\nsize 9\n",
        "format-mismatch",
        "git lfs pull",
    ),
    "short.stl": (b"hello", "not-this-format", "5 bytes"),
    "empty.stl": (b"", "not-this-format", "0 bytes"),
    "obj.stl": (CUBE, "format-mismatch", "looks like an OBJ file"),
    "off.stl": (OFF, "format-mismatch", "looks like an OFF file"),
    "ply.stl": (ASCII_PLY, "format-mismatch", "is a PLY file"),
    "prose.stl": (b"words about a cube\n" * 9, "format-mismatch", "not start with solid"),
    "no_facets.stl": (b"solid a\nendsolid a\n", "empty-mesh", "no triangles"),
    "no_facets_binary.stl": (files.binary_stl(faces=[]), "empty-mesh", "no triangles"),
    "cut.stl": (STL[:447], "truncated", "promises 12 facets, the file has room for 7"),
    "more.stl": (STL + b"12345678", "trailing-data", "byte 684"),
    "lying.stl": (files.binary_stl(count=2**32 - 1), "truncated", "4294967295"),
    "nan.stl": (files.binary_stl(points_with(NAN)), "non-finite", "facet 1"),
    "cut_ascii.stl": (ASCII_STL[: ASCII_STL.index(b"endloop")], "truncated", "endloop"),
    "no_end.stl": (ASCII_STL.replace(b"endsolid cube", b""), "truncated", "endsolid"),
    "bad_ascii.stl": (ASCII_STL.replace(b"outer", b"inner", 1), "bad-record", "line 3"),
    "nan_ascii.stl": (files.ascii_stl(points_with(NAN)), "non-finite", "line 4"),
    "after.stl": (ASCII_STL + b"garbage\n", "trailing-data", "'garbage'"),
    "point.stl": (files.binary_stl([(1, 1, 1)] * 8), "only-degenerate", "12"),
    "not.ply": (b"plyx\n", "not-this-format", "ply"),
    "no_end.ply": (b"ply\nformat ascii 1.0\n", "truncated", "end_header"),
    "huge.ply": (files.ply_header("ascii", 4 * 10**9, 4 * 10**9), "count-mismatch", "4000000000"),
    "huge_binary.ply": (
        files.ply_header("binary_little_endian", 10**12, 1),
        "count-mismatch",
        "1000000000000",
    ),
    "cloud.ply": (files.ascii_ply(faces=[]), "empty-mesh", "8 vertices"),
    "no_axes.ply": (ASCII_PLY.replace(b"float z", b"float w"), "bad-record", "x, y and z"),
    "format.ply": (ASCII_PLY.replace(b"ascii", b"asci"), "unsupported-feature", "'asci'"),
    "type.ply": (ASCII_PLY.replace(b"float x", b"half x"), "bad-record", "'half'"),
    "cut.ply": (PLY[:-3], "truncated", "'face' records"),
    "more.ply": (PLY + b"x", "trailing-data", "1 bytes more"),
    "high.ply": (files.binary_ply(faces=[(0, 1, 8)]), "index-out-of-range", "8 of 8"),
    "low.ply": (files.ascii_ply(faces=[(0, 1, -1)]), "index-out-of-range", "line 19"),
    "nan.ply": (files.binary_ply(points_with(NAN)), "non-finite", "byte"),
    "few.ply": (ASCII_PLY.replace(b"0 0 0\n", b"0 0\n"), "bad-record", "line 11"),
    "not.off": (b"OF\n1 1 1\n", "not-this-format", "'OF'"),
    "four.off": (b"4OFF\n1 1 1\n", "unsupported-feature", "three-dimensional"),
    "binary.off": (OFF[:-1] + b"\0", "unsupported-feature", "binary"),
    "huge.off": (b"OFF\n4000000000 1 0\n", "count-mismatch", "4000000000"),
    "cut.off": (OFF[:-20], "truncated", "face 5 of 6"),
    "more.off": (OFF + b"3 0 1 2\n", "trailing-data", "line 18"),
    "garbage.off": (b"OFF\n3 1\n0 0 0\n1 0 0\n0 1 0\n3 0\n", "truncated", "face 1 of 1"),
    "high.off": (files.off(faces=[(0, 1, 20)]), "index-out-of-range", "20 of 8"),
    "not.glb": (b"{}", "not-this-format", "glTF"),
    "version.glb": (b"glTF" + struct.pack("<II", 1, 12), "unsupported-feature", "version 1"),
    "cut.glb": (GLB[:-8], "truncated", "bytes"),
    "more.glb": (GLB + b"1234", "trailing-data", "bytes"),
    "two_json.glb": (glb_of(b"JSON", b"JSON"), "bad-record", "a JSON chunk"),
    "two_binary.glb": (glb_of(b"JSON", b"BIN\0", b"BIN\0"), "bad-record", "a binary chunk"),
    "late_binary.glb": (glb_of(b"JSON", b"MORE", b"BIN\0"), "bad-record", "a binary chunk"),
    "chunk.glb": (
        GLB[:12] + struct.pack("<I", 2**31 - 1) + GLB[16:],
        "truncated",
        "chunk length 2147483647 exceeds the file",
    ),
    "overrun.glb": (
        with_document(accessors__0__count=800),
        "index-out-of-range",
        "accessor 0 exceeds its buffer view 0",
    ),
    "view.glb": (
        with_document(bufferViews__0__byteLength=10**6),
        "index-out-of-range",
        "beyond buffer 0",
    ),
    "buffer.glb": (with_document(buffers__0__byteLength=10**6), "truncated", "buffer 0"),
    "index.glb": (
        files.glb(*files.gltf_document(faces=[(0, 1, 8)])),
        "index-out-of-range",
        "8 of 8 vertices",
    ),
    "inf.glb": (
        files.glb(*files.gltf_document(points_with(float("inf")))),
        "non-finite",
        "coordinates",
    ),
    "cycle.glb": (
        with_document(nodes=[{"children": [1]}, {"children": [0]}]),
        "reference-cycle",
        "cycle",
    ),
    "node.glb": (with_document(scenes=[{"nodes": [5]}]), "index-out-of-range", "node 5"),
    "no_triangles.glb": (with_document(nodes=[{}]), "empty-mesh", "nothing that the file places"),
    "extension.glb": (
        with_document(extensionsRequired=["EXT_unheard_of"]),
        "unsupported-feature",
        "EXT_unheard_of",
    ),
    "moved.glb": (with_document(extensionsUsed=["CESIUM_RTC"]), "unsupported-feature", "RTC"),
    "sparse.glb": (with_document(accessors__0__sparse={}), "bad-record", "sparse"),
    "types.glb": (with_document(nodes={"0": 1}), "bad-record", "array"),
    "scale.glb": (
        with_document(nodes=[{"mesh": 0, "scale": [1, 0, 1]}]),
        "singular-transform",
        "placed",
    ),
    "far.glb": (
        with_document(nodes=[{"mesh": 0, "scale": [1e30, 1, 1], "translation": [1e46, 0, 0]}]),
        "out-of-range",
        "placed",
    ),
    "nan.gltf": (b'{"asset": {"version": NaN}}', "bad-record", "NaN"),
    "cut.gltf": (b'{"asset": ', "bad-record", "line 1"),
    "other.gltf": (b"[]", "not-this-format", "asset"),
    "encoding.gltf": (b'{"asset": "\xff"}', "bad-encoding", "UTF-8"),
    "deep.gltf": (b"[" * 200_000, "bad-record", "deep"),
    "missing.gltf": (gltf_with_uri("gone.bin"), "missing-resource", "'gone.bin'"),
    "outside.gltf": (gltf_with_uri("../a.bin"), "outside-path", "refused"),
    "absolute.gltf": (gltf_with_uri("/etc/passwd"), "outside-path", "refused"),
    "remote.gltf": (gltf_with_uri("https://example.org/a.bin"), "outside-path", "refused"),
    "text.3mf": (b"this is not a zip file", "not-this-format", "zip"),
    "no_model.3mf": (files.package_3mf({}), "missing-resource", "3dmodel.model"),
    "id.3mf": (files.threemf(items='<item objectid="14"/>'), "index-out-of-range", "'14'"),
    "no_items.3mf": (files.threemf(items=""), "empty-mesh", "nothing that the file places"),
    "cycle.3mf": (
        files.threemf(
            files.components_3mf(1, '<component objectid="2"/>')
            + files.components_3mf(2, '<component objectid="1"/>')
        ),
        "reference-cycle",
        "contains itself",
    ),
    "explosion.3mf": (
        files.threemf(
            files.object_3mf(0)
            + "".join(
                files.components_3mf(i, f'<component objectid="{i - 1}"/>' * 10)
                for i in range(1, 12)
            ),
            '<item objectid="11"/>',
        ),
        "too-large",
        "references expand",
    ),
    "encoding.3mf": (
        files.package_3mf(
            {
                "3D/3dmodel.model": files.model_3mf(files.object_3mf(1), "").replace(
                    b"UTF-8", b"ISO-8859-1"
                )
            }
        ),
        "bad-encoding",
        "ISO-8859-1",
    ),
    "not_xml.3mf": (files.package_3mf({"3D/3dmodel.model": b"\xff\xff"}), "bad-encoding", "XML"),
    "index.3mf": (
        files.threemf(files.object_3mf(1, faces=[(0, 1, 8)])),
        "index-out-of-range",
        "8 of 8 vertices",
    ),
    "nan.3mf": (files.threemf(files.object_3mf(1, points_with(NAN))), "non-finite", "'nan'"),
    "lacks.3mf": (
        files.threemf('<object id="1"><mesh><vertices><vertex x="1"/></vertices></mesh></object>'),
        "bad-record",
        "'y'",
    ),
    "transform.3mf": (
        files.threemf(items='<item objectid="1" transform="1 2 3"/>'),
        "bad-record",
        "12 finite numbers",
    ),
    "laughs.dae": (
        files.collada(doctype='<!DOCTYPE l [<!ENTITY a "aa"><!ENTITY b "&a;&a;">]>'),
        "entity-declaration",
        "entity declarations are refused",
    ),
    "xxe.dae": (
        files.collada(doctype='<!DOCTYPE x [<!ENTITY e SYSTEM "file:///etc/passwd">]>'),
        "entity-declaration",
        "entity declarations are refused",
    ),
    "html.dae": (b"<html/>", "not-this-format", "<html>"),
    "cut.dae": (files.collada()[:-40], "bad-record", "not well-formed"),
    "floats.dae": (files.collada(float_count=99), "count-mismatch", "promises 99"),
    "nan.dae": (files.collada(points=points_with(NAN)), "non-finite", "float_array"),
    "negative.dae": (files.collada(faces=[(0, 1, -1)]), "index-out-of-range", "negative"),
    "high.dae": (files.collada(faces=[(0, 1, 99)]), "index-out-of-range", "vertex 99 of 8"),
    "cycle.dae": (
        files.collada(
            nodes='<node id="n"><instance_node url="#l"/></node>',
            library_nodes='<node id="l"><instance_node url="#l"/></node>',
        ),
        "reference-cycle",
        "contains itself",
    ),
    "no_offset.dae": (
        files.collada().replace(b'offset="0"', b""),
        "bad-record",
        'attribute "offset" is missing',
    ),
    "lookat.dae": (
        files.collada(nodes=_CUBE_NODE.format("<lookat>5 0 0 5 0 -1 0 1 0</lookat>")),
        "unsupported-feature",
        "<lookat>: a transform that is not read",
    ),
    "skew.dae": (
        files.collada(nodes=_CUBE_NODE.format("<skew>45 0 1 0 1 0 0</skew>")),
        "unsupported-feature",
        "<skew>: a transform that is not read",
    ),
    "boolean.3mf": (
        files.threemf(
            files.object_3mf(1) + f'<object id="2"><booleanshape xmlns="{_OTHER}"/></object>',
            '<item objectid="1"/><item objectid="2"/>',
        ),
        "empty-mesh",
        "object '2' has no triangles",
    ),
    "hollow.3mf": (
        files.threemf(
            files.object_3mf(1) + '<object id="2"/>', '<item objectid="1"/><item objectid="2"/>'
        ),
        "empty-mesh",
        "object '2' has no triangles",
    ),
    "surf.obj": (CUBE + b"surf 0 1 0 1 1\n", "unsupported-feature", "free-form surface"),
    "call.obj": (CUBE + b"call more.obj\n", "unsupported-feature", "another file"),
    "nothing.dae": (files.collada(nodes=""), "empty-mesh", "no triangles"),
    "passwd": (b"root:x:0:0\n", "unsupported-format", "unsupported format"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_refused(tmp_path, name):
    content, code, words = REFUSED[name]
    found, message = refusal(tmp_path, name, content)
    assert (found, words in message) == (code, True), message
    assert CODES[found].severity == "error"


WARNED = {
    "short_face.obj": (CUBE + b"f 1 2\n", {"short-face"}),
    "unknown.obj": (b"6540\n" + CUBE, {"unknown-statement"}),
    "curve.obj": (CUBE + b"cstype bezier\n", {"ignored-geometry"}),
    "lines.obj": (CUBE + b"l 1 2 3\np 4\n", {"ignored-geometry"}),
    "open.obj": (files.obj(faces=files.CUBE[1:]), {"not-closed"}),
    "inside_out.obj": (files.obj(faces=[face[::-1] for face in files.CUBE]), {"inside-out"}),
    "one_turned.obj": (
        files.obj(faces=[files.CUBE[0][::-1], *files.CUBE[1:]]),
        {"misoriented"},
    ),
    "double_sided.obj": (
        files.obj(faces=[*files.CUBE, *(face[::-1] for face in files.CUBE)]),
        {"double-sided"},
    ),
    "flat.obj": (
        files.obj([(x, y, 0) for x, y, _ in files.TETRAHEDRON_POINTS[:3]], [(0, 1, 2)]),
        {"not-closed", "flat"},
    ),
    "collapsed.obj": (CUBE + b"f 1 1 2\n", {"degenerate-triangles"}),
}


@pytest.mark.parametrize("name", WARNED)
def test_loaded_with_a_warning(tmp_path, name):
    content, codes = WARNED[name]
    assert set(warnings(loaded(tmp_path, name, content))) == codes


def test_a_path_to_no_file_says_what_is_there(tmp_path):
    from satcheck.scene import load_scene

    (tmp_path / "folder.obj").mkdir()
    (tmp_path / "folder").mkdir()
    (tmp_path / "notes.txt").write_text("x")
    names = ["gone.stl", "gone.txt", "folder.obj", "folder", "notes.txt"]
    scene = load_scene([*(tmp_path / name for name in names), "-"])
    told = [(lost.id, lost.issue.code) for lost in scene.unreadable]
    assert told == [
        ("gone.stl", "file-not-found"),
        ("gone.txt", "file-not-found"),
        ("folder.obj", "not-a-file"),
        ("folder", "not-a-file"),
        ("notes", "unsupported-format"),
        ("-", "not-a-file"),
    ]
    assert scene.issues[0].message.endswith("no such file")
    assert scene.issues[2].message.endswith("is a directory, not a file")
    assert "standard input is not read" in scene.issues[-1].message


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no pipes in this file system")
def test_a_pipe_is_refused_without_waiting_for_a_writer(tmp_path):
    from satcheck.scene import Refused, load_scene

    for name in ("pipe.stl", "pipe.json"):
        os.mkfifo(tmp_path / name)
    (issue,) = load_scene([tmp_path / "pipe.stl"]).issues
    assert issue.code == "not-a-file"
    assert "is a pipe" in issue.message
    with pytest.raises(Refused, match="is a pipe"):
        load_scene([tmp_path / "pipe.json"])


def test_a_file_beyond_the_memory_limit_is_not_read(tmp_path):
    from satcheck.scene import load_scene

    path = tmp_path / "large.obj"
    path.write_bytes(CUBE + b"#" * (1 << 20))
    scene = load_scene([path], megabytes_per_file=1)
    assert scene.issues[0].code == "too-large"
