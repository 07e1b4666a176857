"""Strips, odd types and foreign elements of PLY files."""

from __future__ import annotations

import struct

import pytest

from tests.scene import files
from tests.scene.loading import loaded, refusal, warnings

# The tetrahedron in two strips, and all of it in one, which passes a corner twice to turn.
STRIPS = [0, 2, 1, 3, -1, 3, 2, 0, 3]
ONE_STRIP = [0, 2, 1, 3, 3, 0, 2]
CORNERS = "property list uchar int vertex_indices\n"


def header(kind: str, element: str, records: int, corners: str = CORNERS, points: int = 4) -> str:
    axes = "".join(f"property float {axis}\n" for axis in "xyz")
    return (
        f"ply\nformat {kind} 1.0\nelement vertex {points}\n{axes}"
        f"element {element} {records}\n{corners}end_header\n"
    )


def ascii_points(points: files.Points = files.TETRAHEDRON_POINTS) -> str:
    return "".join("{} {} {}\n".format(*point) for point in points)


def triangle_set(file) -> set[frozenset[tuple[float, float, float]]]:
    return {frozenset(file.mesh.corners(k)) for k in range(file.mesh.triangle_count)}


def test_triangle_strips_in_ascii(tmp_path):
    text = (
        header("ascii", "tristrips", 1) + ascii_points() + "9 " + " ".join(map(str, STRIPS)) + "\n"
    )
    file = loaded(tmp_path, "a.ply", text.encode())
    # 021, 231 turned, and 320, 203 turned: the last two are the same triangle.
    assert file.mesh.triangle_count == 4
    assert len(triangle_set(file)) == 3


@pytest.mark.parametrize("order", ["<", ">"])
def test_a_binary_strip_winds_as_its_triangles_do(tmp_path, order):
    kind = "binary_big_endian" if order == ">" else "binary_little_endian"
    corners = "property list int int vertex_indices\n"
    body = b"".join(struct.pack(f"{order}3f", *point) for point in files.CUBE_POINTS)
    strips = [i for a, b, c, d in files.CUBE_QUADS for i in (a, b, d, c, -1)]
    body += struct.pack(f"{order}{len(strips) + 1}i", len(strips), *strips)
    content = header(kind, "tristrips", 1, corners, points=8).encode() + body
    file = loaded(tmp_path, "a.ply", content)
    assert warnings(file) == {}
    assert file.health.oriented
    assert file.health.volume == 1.0


def test_a_repeated_corner_leads_on_without_a_triangle(tmp_path):
    text = (
        header("ascii", "tristrips", 1)
        + ascii_points()
        + "7 "
        + " ".join(map(str, ONE_STRIP))
        + "\n"
    )
    file = loaded(tmp_path, "a.ply", text.encode())
    assert file.health.degenerate_triangles == 0
    assert file.mesh.triangle_count == 3


def test_a_strip_names_no_vertex_that_is_not_there(tmp_path):
    for corner in (4, -2):
        text = header("ascii", "tristrips", 1) + ascii_points() + f"3 0 1 {corner}\n"
        assert refusal(tmp_path, "a.ply", text.encode())[0] == "index-out-of-range"


@pytest.mark.parametrize(
    ("corners", "length", "index"),
    [
        ("list char short vertex_index", "b", "h"),
        ("list ushort uchar vertex_index", "H", "B"),
        ("list uint32 uint64 vertex_indices", "I", "Q"),
        ("list int64 int64 vertex_indices", "q", "q"),
        ("list float double vertex_indices", "f", "d"),
    ],
)
def test_lists_of_odd_types(tmp_path, corners, length, index):
    body = b"".join(struct.pack("<3f", *point) for point in files.TETRAHEDRON_POINTS)
    for face in files.TETRAHEDRON:
        body += struct.pack(f"<{length}", 3) + struct.pack(f"<3{index}", *face)
    head = header("binary_little_endian", "face", 4, f"property {corners}\n")
    file = loaded(tmp_path, "a.ply", head.encode() + body)
    assert file.health.volume == pytest.approx(1 / 6, rel=1e-15)


@pytest.mark.parametrize(
    ("element", "corners", "record", "code"),
    [
        ("face", "property list uchar int corners\n", "3 0 1 2", "bad-record"),
        ("face", CORNERS + CORNERS, "3 0 1 2 3 0 1 2", "bad-record"),
        ("face", CORNERS + CORNERS.replace("indices", "index"), "3 0 1 2 3 0 1 2", "bad-record"),
        ("faces", CORNERS, "3 0 1 2", "unsupported-feature"),
        ("range_grid", CORNERS, "1 0", "unsupported-feature"),
        ("vertex", "property float x\n", "0", "bad-record"),
        ("face", "property list float int vertex_indices\n", "2.5 0 1 2", "bad-record"),
        ("face", "property list char int n\n" + CORNERS, "-1 3 0 1 2", "bad-record"),
    ],
)
def test_what_could_be_geometry_is_not_passed_over(tmp_path, element, corners, record, code):
    text = header("ascii", element, 1, corners) + ascii_points() + f"{record}\n"
    assert refusal(tmp_path, "a.ply", text.encode())[0] == code


def test_edges_are_a_warning(tmp_path):
    head = files.ply_header("ascii", 4, 4).decode()
    head = head.replace(
        "end_header", "element edge 1\nproperty int vertex1\nproperty int vertex2\nend_header"
    )
    faces = "".join("3 {} {} {}\n".format(*face) for face in files.TETRAHEDRON)
    file = loaded(tmp_path, "a.ply", (head + ascii_points() + faces + "0 1\n").encode())
    assert set(warnings(file)) == {"ignored-geometry"}


@pytest.mark.parametrize("ascii", [True, False])
def test_faces_may_stand_before_the_vertices(tmp_path, ascii):
    """A polygon of more than three corners waits for its positions."""
    head = files.ply_header("ascii" if ascii else "binary_little_endian", 8, 6).decode()
    first, *elements = head.removesuffix("end_header\n").split("element ")
    head = "element ".join([first, *reversed(elements)]) + "end_header\n"
    assert head.index("element face") < head.index("element vertex")
    if ascii:
        faces = "".join("4 {} {} {} {}\n".format(*quad) for quad in files.CUBE_QUADS)
        body = (faces + ascii_points(files.CUBE_POINTS)).encode()
    else:
        body = b"".join(struct.pack("<B4i", 4, *quad) for quad in files.CUBE_QUADS)
        body += b"".join(struct.pack("<3f", *point) for point in files.CUBE_POINTS)
    file = loaded(tmp_path, "a.ply", head.encode() + body)
    assert file.health.volume == 1.0
    assert file.health.oriented


def test_blanks_behind_the_first_word(tmp_path):
    content = files.ascii_ply().replace(b"ply\n", b"ply \n", 1)
    assert loaded(tmp_path, "a.ply", content).health.volume == 1.0


@pytest.mark.parametrize(
    ("element", "record"),
    [
        ("element quad 1\nproperty list uchar int verts\n", "3 0 1 2\n"),
        ("element cell 1\nproperty int v0\nproperty int v1\n", "0 1\n"),
    ],
)
def test_a_list_of_another_name_blocks_a_pass(tmp_path, element, record):
    content = files.ascii_ply().replace(b"end_header\n", element.encode() + b"end_header\n")
    assert set(warnings(loaded(tmp_path, "a.ply", content + record.encode()))) == {"unread"}


@pytest.mark.parametrize(("name", "codes"), [("radius", set()), ("scale_0", {"unread"})])
def test_the_radius_of_a_scan_is_no_geometry_and_the_scale_of_a_splat_is(tmp_path, name, codes):
    points = [(*point, 0.5) for point in files.CUBE_POINTS]
    content = files.ascii_ply(points).replace(
        b"element face", f"property float {name}\nelement face".encode()
    )
    file = loaded(tmp_path, "a.ply", content)
    assert set(warnings(file)) == codes
