"""The form satcheck-scene-1: what it places, and what it is refused for."""

from __future__ import annotations

import json

import pytest

from satcheck.scene import Refused, load_scene
from satcheck.scene.rules import Selector
from tests.scene import files
from tests.scene.scene_file.scenes import read

IDENTITY = [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]
SHIFT = [[1, 0, 0, 5], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]


def scene_of(*bodies, **more):
    return {"schema": "satcheck-scene-1", "bodies": list(bodies), **more}


def body(id_, **more):
    return {"id": id_, "mesh": "../meshes/cube.obj", "transform": IDENTITY, **more}


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "meshes").mkdir()
    (tmp_path / "scenes").mkdir()
    (tmp_path / "meshes" / "cube.obj").write_bytes(files.obj())
    (tmp_path / "meshes" / "broken.obj").write_bytes(b"f 1 2 3\n")
    (tmp_path / "secret").write_text("root:x:0:0\n")
    return tmp_path


def load(folder, document):
    path = folder / "scenes" / "test.json"
    path.write_text(document if isinstance(document, str) else json.dumps(document))
    return load_scene([path])


def test_bodies_groups_and_allowed_pairs(folder):
    scene = load(
        folder,
        scene_of(
            body("a", static=True),
            body("b", transform=SHIFT, group="robot"),
            {"id": "c", "mesh": "../meshes/cube.obj"},
            name="cell",
            units="mm",
            ignore_within_groups=["robot"],
            allowed_pairs=[["b", "a", "bolted"], ["a", "c"]],
        ),
    )
    assert (scene.name, scene.units) == ("cell", "mm")
    a, b, c = scene.bodies
    assert (a.id, a.static, a.groups) == ("a", True, ())
    assert (b.id, b.static, b.groups) == ("b", False, ("robot",))
    assert b.world_mesh().bounds == ((5, 0, 0), (6, 1, 1))
    assert c.transform is None
    assert scene.ignore_within_groups == {"robot"}
    assert scene.composed
    assert [(rule.a.text, rule.b.text, rule.reason) for rule in scene.rules] == [
        ("b", "a", "bolted"),
        ("a", "c", ""),
    ]
    assert all(rule.allowed for rule in scene.rules)
    assert scene.rules[1].where.endswith(": allowed_pairs[1]")
    assert scene.issues == ()


def test_a_mesh_used_by_many_bodies_is_loaded_once(folder):
    scene = load(
        folder, scene_of(body("a"), body("b"), body("c", mesh="../meshes/../meshes/cube.obj"))
    )
    assert scene.bodies[0].file is scene.bodies[1].file
    assert len({b.file.path for b in scene.bodies}) == 1


def test_a_broken_mesh_is_a_lost_body_and_the_rest_is_loaded(folder):
    scene = load(folder, scene_of(body("a"), body("b", mesh="../meshes/broken.obj")))
    assert [b.id for b in scene.bodies] == ["a"]
    (lost,) = scene.unreadable
    assert lost.id == "b"
    assert lost.issue.code == "index-out-of-range"
    assert scene.issues == (lost.issue,)


def test_an_unknown_id_in_allowed_pairs_is_a_warning(folder):
    scene = load(folder, scene_of(body("a"), body("b"), allowed_pairs=[["a", "nobody", "x"]]))
    (issue,) = scene.issues
    assert (issue.code, issue.severity) == ("unknown-body", "warning")
    assert "'nobody'" in issue.message
    assert scene.rules == ()


def test_what_a_scene_says_of_its_origin_is_no_warning(folder):
    more = dict.fromkeys(("description", "source", "licence", "original"), "text")
    assert load(folder, scene_of(body("a"), units="mm (as in the file)", **more)).issues == ()


MISSPELT = {
    "key": ({"allowed_pair": []}, "unknown-key", "'allowed_pairs'"),
    "foreign key": ({"gravity": 9.81}, "unknown-key", "'gravity'"),
    "group": ({"ignore_within_groups": ["robo"]}, "unknown-group", "mean 'robot'?"),
    "units": ({"units": "furlong"}, "unknown-units", "'furlong'"),
}


@pytest.mark.parametrize("name", MISSPELT)
def test_a_typo_at_the_top_is_a_warning(folder, name):
    more, code, told = MISSPELT[name]
    (issue,) = load(folder, scene_of(body("a", group="robot"), **more)).issues
    assert (issue.code, issue.severity) == (code, "warning")
    assert told in issue.message


def test_a_typo_in_a_body_is_refused_with_the_key_meant(folder):
    typo = {"id": "b", "mesh": "../meshes/cube.obj", "transfrom": SHIFT}
    with pytest.raises(Refused, match=r"bodies\[1\].transfrom: .*mean 'transform'\?"):
        load(folder, scene_of(body("a"), typo))
    with pytest.raises(Refused, match=r"bodies\[0\].ide: .*mean 'id'\?"):
        load(folder, scene_of({"ide": "b", "mesh": "../meshes/cube.obj"}))
    with pytest.raises(Refused, match=r"\"bodies\" is missing .*'bodys'"):
        load(folder, {"schema": "satcheck-scene-1", "bodys": []})


def test_null_is_named_as_such(folder):
    with pytest.raises(Refused, match=r"bodies\[0\].id: a text expected, not null"):
        load(folder, scene_of({"id": None, "mesh": "../meshes/cube.obj"}))


SINGULAR = [[1, 0, 0, 0], [1, 0, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]
ZERO = [[0, 0, 0, 3], [0, 0, 0, 0], [0, 0, 0, 0], [0, 0, 0, 1]]
NOT_A_NUMBER = [*SHIFT[:2], [0, 0, float("nan"), 0], SHIFT[3]]
TOO_LARGE = [*SHIFT[:2], [0, 0, 10**400, 0], SHIFT[3]]
TEXT = [["1", 0, 0, 0], *IDENTITY[1:]]
PROJECTIVE = [*IDENTITY[:3], [0, 0, 0.1, 1]]
REFUSED = {
    "missing mesh": (scene_of(body("b", mesh="gone.stl")), "missing-resource", "b"),
    "traversal": (scene_of(body("b", mesh="../secret")), "unsupported-format", "b"),
    "absolute": (scene_of(body("b", mesh="/nowhere/cube.obj")), "missing-resource", "b"),
    "duplicate id": (scene_of(body("b"), body("b")), "duplicate-id", "b"),
    "nan": (scene_of(body("b", transform=NOT_A_NUMBER)), "non-finite", "b"),
    "inf": (scene_of(body("b", transform=TOO_LARGE)), "non-finite", "b"),
    "zero scale": (scene_of(body("b", transform=ZERO)), "singular-transform", "b"),
    "singular": (scene_of(body("b", transform=SINGULAR)), "singular-transform", "b"),
    "projective": (scene_of(body("b", transform=PROJECTIVE)), "singular-transform", "b"),
    "3x4": (scene_of(body("b", transform=IDENTITY[:3])), "bad-scene", "b"),
    "text in transform": (scene_of(body("b", transform=TEXT)), "bad-scene", "b"),
    "no mesh": (scene_of({"id": "b"}), "bad-scene", "b"),
    "no id": (scene_of({"mesh": "../meshes/cube.obj"}), "bad-scene", None),
    "not a body": (scene_of(3), "bad-scene", None),
    "bodies": ({"schema": "satcheck-scene-1", "bodies": {}}, "bad-scene", None),
    "allowed": (scene_of(body("b"), allowed_pairs=["bc"]), "bad-scene", None),
    "schema": ({"schema": "other"}, "bad-scene", None),
    "list": ([], "bad-scene", None),
    "json": ('{"schema": ', "bad-scene", None),
    "repeated": ('{"schema": "satcheck-scene-1", "bodies": [], "bodies": []}', "bad-scene", None),
    "deep": ("[" * 200_000, "bad-scene", None),
}


@pytest.mark.parametrize("name", REFUSED)
def test_refused(folder, name):
    document, code, culprit = REFUSED[name]
    with pytest.raises(Refused) as caught:
        load(folder, document)
    assert caught.value.code == code
    assert "test.json" in str(caught.value)
    assert "root:" not in str(caught.value)
    if culprit:
        assert "bodies[" in str(caught.value)


def test_a_missing_scene_file_and_a_wrong_encoding(folder):
    with pytest.raises(Refused) as caught:
        load_scene([folder / "gone.json"])
    assert caught.value.code == "file-not-found"
    (folder / "latin.json").write_bytes(b'{"schema": "\xe9"}')
    with pytest.raises(Refused) as caught:
        load_scene([folder / "latin.json"])
    assert caught.value.code == "bad-encoding"


def test_allowed_pairs_are_rules(tmp_path):
    bodies = [{"id": id_, "mesh": "cube.obj", "static": True} for id_ in ("a", "group:b")]
    document = {
        "schema": "satcheck-scene-1",
        "bodies": bodies,
        "allowed_pairs": [["group:b", "a", "bolted"]],
    }
    scene = read(tmp_path, document)
    (rule,) = scene.rules
    assert [body.id for body in rule.a.select(scene.items)] == ["group:b"]
    assert rule.b == Selector("a")
    assert (rule.allowed, rule.reason, rule.where) == (
        True,
        "bolted",
        "cell.json: allowed_pairs[0]",
    )
    assert scene.check_static
