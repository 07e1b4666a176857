"""The headers of OFF files."""

from __future__ import annotations

import pytest

from tests.scene import files
from tests.scene.loading import loaded, refusal

COUNTS = "8 6 12"
FACES = "".join("4 {} {} {} {}\n".format(*face) for face in files.CUBE_QUADS)


def cube(header: str, columns: str = "", colour: str = "") -> bytes:
    """columns: behind each position. colour: behind each face."""
    points = "".join("{} {} {}{}\n".format(*point, columns) for point in files.CUBE_POINTS)
    return (header + points + FACES.replace("\n", colour + "\n")).encode()


@pytest.mark.parametrize(
    "content",
    [
        cube(f"OFF\n{COUNTS}\n"),
        cube(f"OFF {COUNTS}\n"),
        cube(f"OFF{COUNTS}\n"),
        cube("OFF8 6\n"),
        cube(f"{COUNTS}\n"),
        cube(f"# made by hand\n\nOFF # a cube\n  {COUNTS}  # counts\n\n", " # a corner"),
        cube(f"NOFF\n{COUNTS}\n", " 0 0 1"),
        cube(f"COFF\n{COUNTS}\n", " 255 0 0 255", " 0.5 0.5 0.5 1"),
        cube(f"CNOFF\n{COUNTS}\n", " 0 0 1 255 0 0"),
        cube(f"NCOFF\n{COUNTS}\n", " 0 0 1 255 0 0"),
        cube(f"STOFF\n{COUNTS}\n", " 0.5 0.5"),
        cube(f"STCNOFF {COUNTS}\n", " 0 0 1 1 0 0 1 0.5 0.5"),
        cube(f"nOFF\n3\n{COUNTS}\n"),
        cube(f"nOFF 3\n{COUNTS}\n"),
        cube("OFF 8 6 -1\n", colour=" 3"),
    ],
)
def test_headers(tmp_path, content):
    file = loaded(tmp_path, "a.off", content)
    assert file.mesh.triangle_count == 12
    assert file.health.volume == 1.0


@pytest.mark.parametrize(
    ("header", "code"),
    [
        (f"4OFF\n{COUNTS}\n", "unsupported-feature"),
        (f"C4nOFF\n3\n{COUNTS}\n", "unsupported-feature"),
        (f"nOFF\n4\n{COUNTS}\n", "unsupported-feature"),
        (f"OFFSET\n{COUNTS}\n", "bad-record"),
        (f"XOFF\n{COUNTS}\n", "not-this-format"),
        (f"OFF\n{COUNTS} 0 0 0\n", "bad-record"),
        ("OFF BINARY\n", "bad-record"),
    ],
)
def test_refused_headers(tmp_path, header, code):
    assert refusal(tmp_path, "a.off", cube(header))[0] == code


def test_records_may_go_on_in_the_next_lines(tmp_path):
    content = f"OFF {COUNTS}\n".encode() + cube("").replace(b" ", b"\n")
    assert loaded(tmp_path, "a.off", content).health.volume == 1.0


def test_a_corner_that_lacks_takes_none_of_the_next_face(tmp_path):
    content = cube(f"OFF {COUNTS}\n").replace(b"4 0 1 3 2\n", b"4 0 1 3\n")
    assert refusal(tmp_path, "a.off", content)[0] == "bad-record"


def test_words_behind_a_record_are_an_error(tmp_path):
    for content in (cube(f"OFF\n{COUNTS}\n", " red"), cube(f"OFF\n{COUNTS}\n", colour=" red")):
        code, message = refusal(tmp_path, "a.off", content)
        assert code == "bad-record"
        assert "'red'" in message
