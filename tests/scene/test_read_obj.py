"""Which statements of an OBJ file count, and that none which could be geometry is passed over."""

from __future__ import annotations

import pytest

from satcheck.scene import load_scene
from tests.scene import files
from tests.scene.loading import loaded, refusal, warnings

CUBE = files.obj()


@pytest.mark.parametrize(
    "statement",
    [
        "V 0 0 9",
        "F 1 2 3",
        "vertex 0 0 9",
        "face 1 2 3",
        "fp 1 2 3",
        "v: 0 0 9",
        "1 2 3",
        "tri 1 2 3",
    ],
)
def test_an_unknown_statement_is_an_error(tmp_path, statement):
    content = CUBE + statement.encode() + b"\n"
    code, message = refusal(tmp_path, "a.obj", content)
    assert code == "bad-record"
    assert "line 21: unknown statement" in message


@pytest.mark.parametrize(
    "statement", ["surf 0 1 0 1 1", "bsp 1 2 3 4", "cdp 1", "call a.obj", "csh ls"]
)
def test_geometry_that_is_not_read_is_an_error(tmp_path, statement):
    code, _ = refusal(tmp_path, "a.obj", CUBE + statement.encode() + b"\n")
    assert code == "unsupported-feature"


def test_names_and_looks_are_no_geometry(tmp_path):
    names = b"mtllib a b.mtl\nusemtl \\\nc\ng a f b\no v 1\n"
    looks = b"s off\nmg 1 2\nlod 3\nbevel on\nvw 1 0 1\nt crease 2/1/0 1 2 3.5\nvt 0 0\nvn 0 0 1\n"
    assert warnings(loaded(tmp_path, "a.obj", CUBE + names + looks)) == {}


@pytest.mark.parametrize("statement", ["l 1 2", "p 1", "curv 0 1 1 2", "cdc 1 2"])
def test_what_has_no_area_is_a_warning(tmp_path, statement):
    file = loaded(tmp_path, "a.obj", CUBE + statement.encode() + b"\n")
    assert set(warnings(file)) == {"ignored-geometry"}
    assert file.health.volume == 1.0


def test_lines_alone_are_an_empty_mesh(tmp_path):
    code, _ = refusal(tmp_path, "a.obj", files.obj(faces=[]) + b"l 1 2\n")
    assert code == "empty-mesh"


def test_a_name_that_ends_with_a_backslash_swallows_no_face(tmp_path):
    content = CUBE.replace(b"f 1 2 4\n", b"usemtl C:\\new\\\nf 1 2 4\n")
    code, message = refusal(tmp_path, "a.obj", content)
    assert code == "bad-record"
    assert "takes in 'f'" in message


def test_counts_before_all_statements_are_a_warning(tmp_path):
    file = loaded(tmp_path, "a.obj", b"8 12\n" + CUBE)
    assert set(warnings(file)) == {"unknown-statement"}
    assert file.health.volume == 1.0
    for head in (b"1 2 3\n", b"8 -12\n"):
        code, _ = refusal(tmp_path, "a.obj", head + CUBE)
        assert code == "not-this-format"


def test_two_vertices_in_a_line_are_an_error(tmp_path):
    code, message = refusal(tmp_path, "a.obj", CUBE.replace(b"v 0 0 0\n", b"v 0 0 0 v 1 2 3\n"))
    assert code == "bad-record"
    assert "'v'" in message


@pytest.mark.parametrize("statement", ["usemtl C:\\tex\\", "s off \\", "l 1 2 \\"])
def test_a_backslash_takes_in_no_object(tmp_path, statement):
    content = files.obj() + f"{statement}\no B\n".encode()
    code, message = refusal(tmp_path, "a.obj", content)
    assert (code, "takes in 'o'" in message) == ("bad-record", True)


def test_groups_are_no_bodies_and_a_file_of_several_says_so(tmp_path):
    one, two = (f"g {name}\n".encode() + files.obj() for name in "ab")
    for content, codes in ((one + two, ["left-out"]), (one + one, []), (b"o a\n" + one, [])):
        (tmp_path / "a.obj").write_bytes(content)
        issues = load_scene([tmp_path / "a.obj"]).issues
        assert [each.code for each in issues if each.code == "left-out"] == codes
