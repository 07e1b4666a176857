"""XML that is cut off, is something else, or is meant to do harm."""

from __future__ import annotations

from pathlib import Path

import pytest

from satcheck.scene import Refused
from satcheck.scene.access import NOTHING_ELSE
from satcheck.scene.robot.reading import read_tree
from tests.scene.robot.robots import SAMPLES, refusal


def test_wherever_a_robot_is_cut_off_it_is_refused(tmp_path: Path) -> None:
    whole = (SAMPLES / "arm.urdf").read_text().rstrip()
    for length in range(0, len(whole), 97):
        code, message = refusal(tmp_path, whole[:length])
        assert code in ("bad-record", "bad-encoding")
        assert "XML" in message


def test_what_was_open_is_named(tmp_path: Path) -> None:
    _, message = refusal(tmp_path, '<robot name="r">\n<link name="a">\n')
    assert message.startswith("line 3: not well-formed XML: no element found")
    assert message.endswith("<link> of line 2 was still open")


@pytest.mark.parametrize(
    ("text", "code"),
    [
        ("<html/>", "not-this-format"),
        ('<!DOCTYPE r [<!ENTITY a "b">]><robot name="r">&a;</robot>', "entity-declaration"),
        ('<robot name="r"/><robot name="s"/>', "bad-record"),
        ("solid x", "bad-encoding"),
    ],
)
def test_what_is_no_robot(tmp_path: Path, text: str, code: str) -> None:
    assert refusal(tmp_path, text)[0] == code


def test_an_ampersand_that_begins_no_reference_stands_for_itself(tmp_path: Path) -> None:
    path = tmp_path / "r.urdf"
    path.write_text('<robot name="nuts & bolts">\n<link name="a&amp;b&#33;"/>&\n<link/></robot>')
    root = read_tree(str(path), NOTHING_ELSE, "robot")
    assert root.attributes["name"] == "nuts & bolts"
    first, second = root.children
    assert (first.attributes["name"], first.line, second.line) == ("a&b!", 2, 3)
    assert "XML" in refusal(tmp_path, '<robot name="r&gone;"/>')[1]


@pytest.mark.parametrize(("name", "code"), [("gone", "file-not-found"), ("", "not-a-file")])
def test_what_is_no_file(tmp_path: Path, name: str, code: str) -> None:
    with pytest.raises(Refused) as caught:
        read_tree(str(tmp_path / name), NOTHING_ELSE, "robot")
    assert caught.value.code == code
    assert caught.value.file == str(tmp_path / name)
