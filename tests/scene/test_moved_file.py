"""Scene files of moved bodies: what changed, what did not, and that they are read back as meant."""

from __future__ import annotations

import json
from pathlib import Path

from satcheck.scene import load_scene
from satcheck.scene.moved_file import moved_scene_file, scene_file_of
from tests.audit.shapes import unit_box, write

PLACED = (
    1.0,
    0.0,
    0.0,
    0.1 + 0.2,
    0.0,
    1.0,
    0.0,
    -2.5e-300,
    0.0,
    0.0,
    1.0,
    1 / 3,
    0.0,
    0.0,
    0.0,
    1.0,
)
ROWS = [list(PLACED[4 * row : 4 * row + 4]) for row in range(4)]


def scene_file(folder: Path) -> Path:
    write(folder, a=unit_box(), b=unit_box(2))
    content = {
        "source": "by hand",
        "schema": "satcheck-scene-1",
        "units": "mm",
        "bodies": [
            {"mesh": "a.obj", "id": "a", "static": True},
            {"id": "ä", "mesh": "./b.obj", "group": "g", "transform": [[1, 0, 0, 7], *ROWS[1:]]},
        ],
        "allowed_pairs": [["a", "ä", "why"]],
        "ignore_within_groups": ["g"],
    }
    path = folder / "scene.json"
    path.write_text(json.dumps(content), encoding="utf-8")
    return path


def test_nothing_but_the_placement_changes(tmp_path) -> None:
    source = scene_file(tmp_path)
    expected = json.loads(source.read_text("utf-8"))
    expected["bodies"][1]["transform"] = ROWS
    text = moved_scene_file(source, tmp_path / "out.json", {"ä": PLACED})
    assert json.loads(text) == expected
    assert list(json.loads(text)) == list(expected)
    assert [list(body) for body in json.loads(text)["bodies"]] == [
        list(body) for body in expected["bodies"]
    ]


def test_the_placement_is_read_back_to_the_last_bit(tmp_path) -> None:
    source, output = scene_file(tmp_path), tmp_path / "out.json"
    output.write_text(moved_scene_file(source, output, {"ä": PLACED}), encoding="utf-8")
    assert load_scene([output]).bodies[1].transform == PLACED


def test_mesh_paths_lead_from_where_the_file_is_written(tmp_path) -> None:
    (tmp_path / "in").mkdir()
    (tmp_path / "out").mkdir()
    source, output = scene_file(tmp_path / "in"), tmp_path / "out" / "moved.json"
    output.write_text(moved_scene_file(source, output, {}), encoding="utf-8")
    bodies = json.loads(output.read_text("utf-8"))["bodies"]
    assert [body["mesh"] for body in bodies] == ["../in/a.obj", "../in/b.obj"]
    assert len(load_scene([output]).bodies) == 2


def test_mesh_files_become_a_scene(tmp_path) -> None:
    paths = write(tmp_path, a=unit_box(), b=unit_box(2))
    bodies = {body.id: body for body in load_scene(paths).bodies}
    output = tmp_path / "made.json"
    output.write_text(scene_file_of(output, bodies, {"b": PLACED}), encoding="utf-8")
    scene = load_scene([output])
    assert [body.id for body in scene.bodies] == ["a", "b"]
    assert [body.transform for body in scene.bodies] == [None, PLACED]
