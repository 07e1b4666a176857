"""Bodies put elsewhere in the text of a scene: the rest of it stays as it was."""

from __future__ import annotations

import difflib
import json

import pytest

from satcheck.scene.format.reading import read_scene_file
from satcheck.scene.format.writing import moved
from tests.scene.format.scenes import BOX, scene_of, write

TOML = """# The cell.
schema = "satcheck.scene/1"

[[bodies]]
id = "a"   # first
shape = {type = "box", size = [1, 1, 1]}
position = [
  1,    # along x
  2.5,  # along y
  3,
]
euler = [0, 0, 90]

  [[bodies]]  # indented
  id = "b"   # no position yet
  mesh = "cube.obj"
  scale = 2

[[bodies]]
shape.type = "box"
shape.size = [1, 1, 1]
matrix = [[0, -1, 0, 5], [1, 0, 0, 6],
          [0, 0, 1, 7], [0, 0, 0, 1]]
id = "c" """
JSON = json.dumps(
    scene_of(
        {"id": "a", "shape": BOX, "position": [1, 2.5, 3], "euler": [0, 0, 90]},
        {"id": "b", "mesh": "cube.obj", "scale": 2},
        {
            "id": "c",
            "shape": BOX,
            "matrix": [[0, -1, 0, 5], [1, 0, 0, 6], [0, 0, 1, 7], [0, 0, 0, 1]],
        },
    ),
    indent=2,
)
SIMPLE = json.dumps(
    {
        "schema": "satcheck-scene-1",
        "bodies": [
            {
                "id": "a",
                "transform": [[1, 0, 0, 1], [0, 1, 0, 2.5], [0, 0, 1, 3], [0, 0, 0, 1]],
                "mesh": "cube.obj",
            },
            {"id": "b", "mesh": "cube.obj"},
            {"id": "c", "mesh": "cube.obj", "transform": None},
        ],
    },
    indent=1,
)
INLINE = (
    'schema = "satcheck.scene/1"\nbodies = [{id = "a", mesh = "cube.obj"},\n'
    '  {mesh = "cube.obj", id = "b", position = [0, 0, 0]},\n'
    '  {position = [1, 1, 1], mesh = "cube.obj", id = "c"}]\n'
)
TEXTS = {
    "toml": ("cell.toml", TOML),
    "toml with CR": ("cell.toml", TOML.replace("\n", "\r\n")),
    "inline toml": ("cell.toml", INLINE),
    "json": ("cell.json", JSON),
    "json in one line": ("cell.json", json.dumps(json.loads(JSON))),
    "simple": ("cell.json", SIMPLE),
}
# Numbers without a short decimal form, tiny and large ones among them.
SHIFTS = {"a": (0.1, 1 / 3, -7e-9), "b": (1e17, -0.5, 2.0), "c": (0.0, -6.0, 1e-320)}


def load(folder, name, text):
    (folder / name).write_text(text, encoding="utf-8", newline="")
    return {body.id: body.transform for body in read_scene_file(name, folder / name).bodies}


def shifted(transform, shift):
    rows = list(transform or (1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1))
    for axis, step in enumerate(shift):
        rows[4 * axis + 3] += step
    return tuple(map(float, rows))


@pytest.mark.parametrize("name", TEXTS)
@pytest.mark.parametrize("ids", ["a", "b", "c", "abc"])
def test_the_new_text_gives_exactly_the_new_placements(tmp_path, name, ids):
    write(tmp_path, scene_of())
    file, text = TEXTS[name]
    before = load(tmp_path, file, text)
    wanted = {id_: shifted(before[id_], SHIFTS[id_]) for id_ in ids}
    new = moved(file, text, wanted)
    assert load(tmp_path, file, new) == before | wanted


@pytest.mark.parametrize("name", TEXTS)
def test_nothing_moved_is_nothing_changed(tmp_path, name):
    write(tmp_path, scene_of())
    file, text = TEXTS[name]
    same = {id_: shifted(at, (0, 0, 0)) for id_, at in load(tmp_path, file, text).items()}
    assert moved(file, text, same) == text


def test_comments_and_layout_stay(tmp_path):
    write(tmp_path, scene_of())
    before = load(tmp_path, "cell.toml", TOML)
    shifts = {"a": (0, 1, 0), "b": (1, 0, 0), "c": (0, 0, 0.5)}
    new = moved("cell.toml", TOML, {id_: shifted(before[id_], s) for id_, s in shifts.items()})
    lines = difflib.ndiff(TOML.splitlines(), new.splitlines())
    assert [line.rstrip() for line in lines if line[0] in "+-"] == [
        "-   2.5,  # along y",
        "+   3.5,  # along y",
        "+   position = [1.0, 0.0, 0.0]",
        "-           [0, 0, 1, 7], [0, 0, 0, 1]]",
        "+           [0, 0, 1, 7.5], [0, 0, 0, 1]]",
    ]


def test_a_turn_is_refused(tmp_path):
    write(tmp_path, scene_of())
    at = load(tmp_path, "cell.toml", TOML)["b"]
    with pytest.raises(ValueError, match="'b' is turned or scaled"):
        moved("cell.toml", TOML, {"b": (1.0, *at[1:])})


def test_a_stranger_is_refused():
    with pytest.raises(ValueError, match="no body 'x'"):
        moved("cell.toml", TOML, {"x": (1.0, *(0.0,) * 15)})
