"""`load_scene` over several inputs: ids, units, issues, and what must not be imported."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import pytest

from satcheck.core.errors import SatcheckError
from satcheck.core.shapes import Box
from satcheck.scene import CODES, load_scene
from tests.scene import files, graphs
from tests.scene.scene_file.scenes import scene_of, write

# What costs more to import than reading an OBJ and an STL file takes.
EXPENSIVE = {
    "numpy",
    "trimesh",
    "scipy",
    "zipfile",
    "xml.parsers.expat",
    "lxml",
    "networkx",
    "subprocess",
    "multiprocessing",
    "concurrent.futures",
    "asyncio",
    "importlib.metadata",
    "email",
}


def test_only_the_very_same_file_gets_a_number(tmp_path):
    (tmp_path / "other").mkdir()
    paths = [tmp_path / "a.obj", tmp_path / "other" / "a.obj", tmp_path / "a.obj"]
    for path in paths:
        path.write_bytes(files.obj())
    scene = load_scene(paths)
    first = f"{tmp_path.name}/a"
    assert [body.id for body in scene.bodies] == [first, "other/a", f"{first}-2"]
    assert [body.name for body in scene.bodies] == ["a", "a", "a"]
    assert scene.bodies[0].file is scene.bodies[2].file


def test_the_order_given_holds_for_unreadable_files_too(tmp_path):
    (tmp_path / "b.obj").write_bytes(files.obj())
    scene = load_scene([tmp_path / name for name in ("c.obj", "b.obj", "a.txt")])
    assert scene.order == ("c", "b", "a")
    assert [one.id for one in scene.in_order()] == ["c", "b", "a"]
    assert [body.id for body in scene.bodies] == ["b"]


def test_ids_of_two_scenes_keep_their_allowed_pairs(tmp_path):
    (tmp_path / "cube.obj").write_bytes(files.obj())
    document = {
        "schema": "satcheck-scene-1",
        "units": "mm",
        "bodies": [{"id": id_, "mesh": "cube.obj"} for id_ in "ab"],
        "allowed_pairs": [["a", "b", "glued"]],
    }
    for name in ("one.json", "two.json"):
        (tmp_path / name).write_text(json.dumps(document))
    scene = load_scene([tmp_path / "one.json", tmp_path / "two.json"])
    assert [body.id for body in scene.bodies] == ["a", "b", "a-2", "b-2"]
    assert [(rule.a.text, rule.b.text) for rule in scene.rules] == [("a", "b"), ("a-2", "b-2")]
    assert scene.units == "mm"
    document["units"] = "m"
    (tmp_path / "two.json").write_text(json.dumps(document))
    assert load_scene([tmp_path / "one.json", tmp_path / "two.json"]).units == "mm"


def test_a_warning_names_the_body_where_it_is_the_only_one(tmp_path):
    (tmp_path / "open.obj").write_bytes(files.obj(faces=files.CUBE[1:]))
    once = load_scene([tmp_path / "open.obj"])
    twice = load_scene([tmp_path / "open.obj"] * 2)
    assert [(issue.code, issue.body) for issue in once.issues] == [("not-closed", "open")]
    assert [(issue.code, issue.body) for issue in twice.issues] == [("not-closed", None)]


def test_sha256_and_format(tmp_path):
    (tmp_path / "cube.stl").write_bytes(files.binary_stl())
    file = load_scene([str(tmp_path / "cube.stl")]).bodies[0].file
    assert file.format == "stl"
    assert file.path == str(tmp_path / "cube.stl")
    assert len(file.sha256) == 64


def test_without_a_hash_everything_else_is_the_same(tmp_path):
    (tmp_path / "cube.stl").write_bytes(files.binary_stl())
    hashed, plain = (
        load_scene([tmp_path / "cube.stl"], hashed=want).bodies[0].file for want in (True, False)
    )
    assert plain.sha256 is None
    assert plain.mesh.to_bytes() == hashed.mesh.to_bytes()
    assert (plain.health, plain.resolution, plain.issues) == (
        hashed.health,
        hashed.resolution,
        hashed.issues,
    )


def test_results_are_frozen(tmp_path):
    (tmp_path / "cube.stl").write_bytes(files.binary_stl())
    body = load_scene([tmp_path / "cube.stl"]).bodies[0]
    with pytest.raises(AttributeError, match="immutable"):
        body.id = "x"  # type: ignore[misc]


def test_codes_are_kebab_case_with_one_sentence_each():
    for name, code in CODES.items():
        assert name == code.name
        assert name.replace("-", "").isalnum()
        assert name == name.lower()
        assert code.severity in ("error", "warning", "note")
        assert code.meaning.endswith(".")
        assert code.meaning.count(". ") == 0


def test_reading_obj_and_stl_imports_nothing_expensive(tmp_path):
    (tmp_path / "a.obj").write_bytes(files.obj())
    (tmp_path / "b.stl").write_bytes(files.binary_stl())
    script = (
        "import sys; before = set(sys.modules)\n"
        "from satcheck.scene import load_scene\n"
        "assert len(load_scene(sys.argv[1:]).bodies) == 2\n"
        "print(*(set(sys.modules) - before))"
    )
    paths = [str(tmp_path / name) for name in ("a.obj", "b.stl")]
    run = subprocess.run(
        [sys.executable, "-c", script, *paths], capture_output=True, text=True, check=True
    )
    assert EXPENSIVE.isdisjoint(run.stdout.split())


def test_a_scene_of_shapes_and_meshes(tmp_path):
    box = {"type": "box", "size": [1, 2, 3]}
    document = scene_of(
        {"id": "a", "shape": box, "static": True},
        {"id": "b", "shape": box | {"size": [1.0, 2.0, 3.0]}, "pinned": True},
        {"id": "c", "mesh": "cube.obj", "position": [5, 0, 0], "groups": ["g"]},
        {"id": "d", "shape": {"type": "box", "size": [1e300, 1, 1]}, "groups": ["g"]},
        motion=[{"bodies": ["b", "group:g"], "translation": [1, 0, 0]}],
    )
    scene = load_scene([write(tmp_path, document, "toml")])
    a, b, c = scene.bodies
    assert a.file is b.file
    assert (a.file.format, a.shape, c.shape) == ("shape", Box((1, 2, 3)), None)
    assert a.file.path.endswith("cell.toml")
    assert (a.static, b.pinned, c.pinned) == (True, True, False)
    assert c.world_mesh().bounds == ((5, 0, 0), (6, 1, 1))
    (lost,) = scene.unreadable
    assert (lost.id, lost.issue.code, lost.groups) == ("d", "out-of-range", ("g",))
    assert (scene.check_static, scene.composed) == (False, True)
    assert scene.motions[0].bodies == ("b", "c", "d")


def test_static_pairs_are_checked_where_one_of_the_scenes_asks_for_them(tmp_path):
    box = {"type": "box", "size": [1, 2, 3]}
    document = scene_of({"id": "a", "shape": box, "static": True})
    quiet = write(tmp_path, document, name="quiet")
    asks = write(tmp_path, document | {"check_static": True}, name="asks")
    assert not load_scene([quiet, quiet]).check_static
    assert load_scene([quiet, asks]).check_static
    assert load_scene([tmp_path / "cube.obj"]).check_static


def test_motions_follow_their_bodies_to_new_ids(tmp_path):
    document = scene_of(
        {"id": "a", "mesh": "cube.obj"}, motion=[{"bodies": "a", "translation": [1, 0, 0]}]
    )
    path = write(tmp_path, document)
    scene = load_scene([path, path])
    assert [motion.bodies for motion in scene.motions] == [("a",), ("a-2",)]


def test_a_part_of_a_mesh_file_stays_where_the_file_places_it(tmp_path):
    nodes = [
        {"name": "crane", "translation": [10, 0, 0], "children": [1]},
        {"name": "hook", "mesh": 0, "translation": [0, 5, 0]},
        {"name": "base", "mesh": 0},
    ]
    (tmp_path / "crane.glb").write_bytes(graphs.glb(nodes))
    document = {
        "schema": "satcheck.scene/1",
        "bodies": [
            {"id": "as-is", "mesh": "crane.glb", "part": "crane/hook"},
            {"id": "up", "mesh": "crane.glb", "part": "crane/hook", "position": [0, 0, 7]},
            {"id": "base", "mesh": "crane.glb", "part": "base", "position": [0, 0, 7]},
            {"id": "all", "mesh": "crane.glb"},
            {"id": "gone", "mesh": "crane.glb", "part": "crane"},
        ],
    }
    (tmp_path / "scene.json").write_text(json.dumps(document))
    scene = load_scene([tmp_path / "scene.json"])
    assert {body.id: body.world_mesh().bounds for body in scene.bodies} == {
        "as-is": ((10, 5, 0), (11, 6, 1)),
        "up": ((10, 5, 7), (11, 6, 8)),
        "base": ((0, 0, 7), (1, 1, 8)),
        "all": ((0, 0, 0), (11, 6, 1)),
    }
    hook, up, base, _ = scene.bodies
    assert hook.file is up.file is base.file
    assert [body.path for body in scene.bodies] == ["crane/hook", "crane/hook", "base", None]
    assert [lost.issue.code for lost in scene.unreadable] == ["unknown-part"]


@pytest.mark.parametrize("one", ["cube.obj", Path("cube.obj")])
def test_one_path_is_no_list_of_paths(one):
    with pytest.raises(SatcheckError, match="a list of paths"):
        load_scene(one)
