"""A URDF with other collisions: all else stays."""

from __future__ import annotations

from pathlib import Path

import pytest

from satcheck.scene import load_scene
from satcheck.scene.errors import Refused
from satcheck.scene.robot.written_urdf import urdf_of_parts
from tests.cli.process import SAMPLES

TEXT = (
    '<robot name="r">\n<link name="a"><collision name="x"><origin/><geometry>'
    '<mesh filename="box.obj"/></geometry></collision><collision><geometry>'
    '<mesh filename="box.obj"/></geometry></collision>{more}</link></robot>'
)


def rewritten(folder: Path, text: str, encoding: str = "utf-8", back: str = "") -> bytes:
    """With a file for the first collision, and two for the second."""
    (folder / "box.obj").write_bytes((SAMPLES / "box.obj").read_bytes())
    path = folder / "r.urdf"
    path.write_bytes(text.encode(encoding))
    scene = load_scene([path])
    (robot,) = scene.robots
    lines = {id_: entry.line for id_, entry in scene.entries.items()}
    parts = {"a/x": ["p/1.obj"], "a/2": ["p/2.obj", "p/ü&.obj"]}
    return urdf_of_parts(path.read_bytes(), robot, lines, parts, "collision", back)


def test_shapes_in_one_line_keep_their_order(tmp_path: Path) -> None:
    assert rewritten(tmp_path, TEXT.format(more="<!-- ü -->")).decode() == (
        '<?xml version="1.0" encoding="utf-8"?>\n<robot name="r">\n<link name="a">'
        '<collision name="x-1"><geometry><mesh filename="p/1.obj" /></geometry></collision>'
        '<collision><geometry><mesh filename="p/2.obj" /></geometry></collision>'
        '<collision><geometry><mesh filename="p/ü&amp;.obj" /></geometry></collision>'
        "<!-- ü --></link></robot>\n"
    )


def test_a_shape_without_geometry_in_the_line_is_refused(tmp_path: Path) -> None:
    with pytest.raises(Refused, match="give each a line of its own"):
        rewritten(tmp_path, TEXT.format(more="<collision/>"))


def test_other_encodings_and_undeclared_prefixes_are_kept(tmp_path: Path) -> None:
    text = TEXT.format(more='<gazebo:odd a:b="&#38;&gt;"/>')
    expected = rewritten(tmp_path, text)
    declared = f'<?xml version="1.0" encoding="utf-16"?>{text}'
    assert rewritten(tmp_path, declared, "utf-16") == expected
    assert b'<gazebo:odd a:b="&amp;&gt;" />' in expected


def test_characters_that_a_reader_would_change_stay_references(tmp_path: Path) -> None:
    head = "<!-- licence -->\n"
    text = head + TEXT.format(more="").replace('name="r"', 'name="a&#10;b&#9;c"')
    made = rewritten(tmp_path, text)
    assert b'name="a&#10;b&#09;c"' in made
    assert head.encode() in made


def test_what_stands_on_lines_of_its_own_stays_so(tmp_path: Path) -> None:
    text = TEXT.replace("<collision", "\n  <collision").replace("</link>", "\n</link>")
    assert rewritten(tmp_path, text.format(more="")).decode().split("\n")[2:] == [
        '<link name="a">',
        '  <collision name="x-1"><geometry><mesh filename="p/1.obj" /></geometry></collision>',
        '  <collision><geometry><mesh filename="p/2.obj" /></geometry></collision>',
        '  <collision><geometry><mesh filename="p/ü&amp;.obj" /></geometry></collision>',
        "</link></robot>",
        "",
    ]


def test_relative_names_lead_from_the_new_folder(tmp_path: Path) -> None:
    more = "".join(
        f'<visual><geometry><mesh filename="{name}"/></geometry></visual>'
        for name in ("box.obj", "/abs.obj", "package://p/q.obj", "file://x.obj", "C:/x.obj")
    )
    made = rewritten(tmp_path, TEXT.format(more=more), back="../a&b").decode()
    assert '"../a&amp;b/box.obj"' in made
    assert made.count("../a") == 1
    assert made.count('"p/') == 3
