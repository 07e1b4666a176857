"""Scene files of moved bodies: what changed, what did not, and that they are read back as meant."""

from __future__ import annotations

import json
import os
from pathlib import Path

from satcheck.scene import load_scene
from satcheck.scene.moved.scene_file import moved_scene_file
from tests.audit.shapes import unit_box, write

TOML = """\
# what stands where
schema = "satcheck.scene/1"

[[bodies]]
id = "a"  # the first
mesh = "a.obj"

[[bodies]]
id = "b"
mesh = "a.obj"
position = [1, 2, 3]  # beside it
"""
ROWS = [[0, -2, 0, 7], [2, 0, 0, 0], [0, 0, 1, 0.5], [0, 0, 0, 1]]
BY = (0.1 + 0.2, -2.5e-300, 1 / 3)


def scene_file(folder: Path) -> Path:
    write(folder, a=unit_box(), b=unit_box(2))
    content = {
        "source": "by hand",
        "schema": "satcheck-scene-1",
        "units": "mm",
        "bodies": [
            {"mesh": "a.obj", "id": "a", "static": True},
            {"id": "ä", "mesh": "./b.obj", "group": "g", "transform": ROWS},
        ],
        "allowed_pairs": [["a", "ä", "why"]],
        "ignore_within_groups": ["g"],
    }
    path = folder / "scene.json"
    path.write_text(json.dumps(content), encoding="utf-8")
    return path


def test_nothing_but_the_translation_changes(tmp_path) -> None:
    source = scene_file(tmp_path)
    expected = json.loads(source.read_text("utf-8"))
    for row in range(3):
        expected["bodies"][1]["transform"][row][3] += BY[row]
    text = moved_scene_file(str(source), tmp_path / "out.json", {"ä": BY})
    assert json.loads(text) == expected
    assert list(json.loads(text)) == list(expected)


def test_the_placement_is_read_back_to_the_last_bit(tmp_path) -> None:
    source, output = scene_file(tmp_path), tmp_path / "out.json"
    text = moved_scene_file(str(source), output, {"a": BY, "ä": BY})
    output.write_text(text, encoding="utf-8")
    a, b = load_scene([output]).bodies
    assert a.transform == (1, 0, 0, BY[0], 0, 1, 0, BY[1], 0, 0, 1, BY[2], 0, 0, 0, 1)
    assert b.transform[3::4] == (7 + BY[0], BY[1], 0.5 + BY[2], 1)


def test_mesh_paths_lead_from_where_the_file_is_written(tmp_path) -> None:
    (tmp_path / "in").mkdir()
    (tmp_path / "out").mkdir()
    source, output = scene_file(tmp_path / "in"), tmp_path / "out" / "moved.json"
    output.write_text(moved_scene_file(os.path.relpath(source), output, {}), encoding="utf-8")
    bodies = json.loads(output.read_text("utf-8"))["bodies"]
    assert [body["mesh"] for body in bodies] == ["../in/a.obj", "../in/b.obj"]
    assert len(load_scene([output]).bodies) == 2


def test_a_toml_scene_keeps_its_comments(tmp_path) -> None:
    write(tmp_path, a=unit_box())
    source, output = tmp_path / "scene.toml", tmp_path / "out.toml"
    source.write_text(TOML)
    output.write_text(moved_scene_file(str(source), output, {"b": (0.5, 0.0, 0.0)}))
    assert output.read_text() == TOML.replace("[1, 2, 3]", "[1.5, 2, 3]")
    assert load_scene([output]).bodies[1].transform[3::4] == (1.5, 2, 3, 1)
