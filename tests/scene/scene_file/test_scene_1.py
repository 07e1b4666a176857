"""The form satcheck.scene/1: what it says, and what it is refused for."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from satcheck.core.shapes import Box, Capsule
from satcheck.scene import Refused
from satcheck.scene.access import ANYWHERE
from satcheck.scene.document import FilePart
from satcheck.scene.motion import PosePath, Rotation, Translation
from satcheck.scene.rules import Rule, Selector
from tests.scene import files
from tests.scene.scene_file.scenes import BOX, errors, full, read, scene_of, write

FORMS = ["json", "toml"]


@pytest.mark.parametrize("form", FORMS)
def test_one_of_everything(tmp_path, form):
    scene = read(tmp_path, full(), form)
    assert (scene.name, scene.units, scene.check_static) == ("cell", "mm", True)
    assert scene.ignore_within_groups == {"arm"}
    assert scene.issues == ()
    floor, one, two, tool, bin_ = scene.items
    assert (floor.id, floor.shape, floor.static, floor.pinned) == (
        "floor",
        Box((1, 1, 1)),
        True,
        False,
    )
    assert one.shape == FilePart("cube.obj", "cube.obj")
    assert one.shape is two.shape
    assert one.groups == ("arm", "robot")
    assert one.transform == (0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1)
    assert (two.pinned, two.transform[0]) == (True, 2.0)
    assert tool.shape == Capsule(1, 2)
    assert bin_.transform[3] == 5.0


@pytest.mark.parametrize("form", FORMS)
def test_rules_know_where_they_are_written(tmp_path, form):
    rules = read(tmp_path, full(), form).rules
    lines = (tmp_path / f"cell.{form}").read_text().splitlines()
    expected = [
        {"a": "floor", "b": "arm/*", "allowed": True, "reason": "bolted"},
        {"a": "group:robot", "b": "*", "max_depth": 0.5, "clearance": 2.0, "severity": "note"},
        {"a": "*", "b": "*", "tolerance": 0.0, "max_volume": 3.5},
    ]
    for rule, values in zip(rules, expected, strict=True):
        values |= {"a": Selector(values["a"]), "b": Selector(values["b"])}
        assert rule.where == f"{rule.file}:{rule.line}"
        assert rule == Rule(**values, where=rule.where, file=rule.file, line=rule.line)
        file, line = rule.where.split(":")
        assert file == f"cell.{form}"
        near = "".join(lines[int(line) - 1 : int(line) + 1])
        assert values["a"].text in near


@pytest.mark.parametrize("form", FORMS)
def test_motions(tmp_path, form):
    along, about, through = read(tmp_path, full(), form).motions
    assert (along.bodies, along.path) == (("arm/1",), Translation((0, 0, 1)))
    assert (about.bodies, about.path) == (("arm/2",), Rotation((1, 0, 0), (0, 0, 1), -30))
    assert through.bodies == ("tool", "bin")
    assert isinstance(through.path, PosePath)
    first, second, third = through.path.waypoints
    assert first.orientation == (0, 0, 0, 1)
    assert second.orientation == pytest.approx((0.5**0.5, 0, 0, 0.5**0.5), abs=2.0**-52)
    assert third.orientation == (1, 0, 0, 0)


def test_a_motion_of_a_group(tmp_path):
    bodies = [{"id": id_, "shape": BOX, "groups": ["g"]} for id_ in "ab"]
    move = {"bodies": "group:g", "translation": [1, 0, 0]}
    (motion,) = read(tmp_path, scene_of(*bodies, motion=[move])).motions
    assert motion.bodies == ("a", "b")


def test_defaults(tmp_path):
    scene = read(tmp_path, scene_of({"id": "a", "shape": BOX}))
    assert (scene.name, scene.units, scene.check_static) == ("cell", None, False)
    (body,) = scene.items
    assert (body.transform, body.groups, body.path) == (None, (), None)


def test_useless_declarations_are_warnings(tmp_path):
    document = scene_of(
        {"id": "a", "shape": BOX, "groups": ["robot"]},
        units="furlong",
        ignore_within_groups=["robo"],
    )
    units, group = read(tmp_path, document).issues
    assert (units.code, group.code) == ("unknown-units", "unknown-group")
    assert "mean 'robot'?" in group.message


def changed(*way, **new):
    """FULL with the keys of the table at `way` set; None: left out."""

    def change(document):
        table = document
        for key in way:
            table = table[key]
        for key, value in new.items():
            if value is None:
                del table[key]
            else:
                table[key] = value

    return change


def outline(*points):
    return changed("bodies", 0, shape={"type": "outline", "points": list(points)})


TURN = {"axis": [0, 0, 1], "degrees": 1}

# name: (change, where it is said to be wrong, what is said, code)
WRONG = {
    "no bodies": (changed(bodies=None), "", "is missing", "bad-scene"),
    "bodies": (changed(bodies={}), "bodies", "a list expected, not keys and values", "bad-scene"),
    "body": (changed(bodies=[3]), "bodies[0]", "a table expected, not 3", "bad-scene"),
    "top key": (
        changed(check_static=None, chek_static=True),
        "chek_static",
        "mean 'check_static'?",
        "bad-scene",
    ),
    "name": (changed(name=3), "name", "a text expected, not 3", "bad-scene"),
    "units": (changed(units="", rules=[]), "units", "a non-empty text", "bad-scene"),
    "check_static": (changed(check_static="no"), "check_static", "true or false", "bad-scene"),
    "ignored": (
        changed(ignore_within_groups="arm"),
        "ignore_within_groups",
        "a list expected, not 'arm'",
        "bad-scene",
    ),
    "ignored item": (
        changed(ignore_within_groups=["arm", 1]),
        "ignore_within_groups[1]",
        "a text expected, not 1",
        "bad-scene",
    ),
    "no id": (changed("bodies", 3, id=None), "bodies[3]", '"id" is missing', "bad-scene"),
    "empty id": (changed("bodies", 3, id=""), "bodies[3].id", "a non-empty text", "bad-scene"),
    "same id": (changed("bodies", 2, id="arm/1"), "bodies[2].id", "'arm/1'", "duplicate-id"),
    "key": (changed("bodies", 3, positon=[0]), "bodies[3].positon", "mean 'position'", "bad-scene"),
    "old key": (changed("bodies", 3, group="a"), "bodies[3].group", "mean 'groups'", "bad-scene"),
    "two sources": (changed("bodies", 1, shape=BOX), "bodies[1]", "exactly one of", "bad-scene"),
    "no source": (changed("bodies", 1, mesh=None), "bodies[1]", "exactly one of", "bad-scene"),
    "part of a shape": (
        changed("bodies", 3, part="x"),
        "bodies[3].part",
        'or "shape"',
        "bad-scene",
    ),
    "missing": (
        changed("bodies", 1, mesh="a.stl"),
        "bodies[1].mesh",
        "missing",
        "missing-resource",
    ),
    "no mesh": (changed("bodies", 1, mesh="a"), "bodies[1].mesh", "format", "unsupported-format"),
    "outside": (changed("bodies", 1, mesh="../a.stl"), "bodies[1].mesh", "outside", "outside-path"),
    "long turn": (
        changed("motion", 2, "path", 1, euler=[0, 0, -181]),
        "motion[2].path[1].euler",
        "more than half a turn",
        "bad-scene",
    ),
    "shape": (changed("bodies", 0, shape=1), "bodies[0].shape", "a table expected", "bad-scene"),
    "cube": (
        changed("bodies", 0, "shape", type="cube"),
        "bodies[0].shape.type",
        "box",
        "bad-scene",
    ),
    "size": (
        changed("bodies", 0, "shape", size=[1, 0, 1]),
        "bodies[0].shape.size[1]",
        "a number above 0",
        "bad-scene",
    ),
    "two sizes": (
        changed("bodies", 0, "shape", size=[1, 1]),
        "bodies[0].shape.size",
        "a list of 3",
        "bad-scene",
    ),
    "radius": (
        changed("bodies", 0, "shape", radius=1),
        "bodies[0].shape.radius",
        "unknown key",
        "bad-scene",
    ),
    "reach": (
        changed("bodies", 0, shape={"type": "half-space", "reach": 1}),
        "bodies[0].shape.reach",
        "unknown key",
        "bad-scene",
    ),
    "no type": (
        changed("bodies", 0, shape={}),
        "bodies[0].shape",
        '"type" is missing',
        "bad-scene",
    ),
    "units of a shape": (
        changed("bodies", 3, units="mm"),
        "bodies[3].units",
        'or "shape"',
        "bad-scene",
    ),
    "matrix and scale": (changed("bodies", 4, scale=2), "bodies[4].scale", "matrix", "bad-scene"),
    "row": (
        lambda document: document["bodies"][4]["matrix"][1].pop(),
        "bodies[4].matrix[1]",
        "a list of 4 expected, not a list of 3",
        "bad-scene",
    ),
    "null": (
        lambda document: document["bodies"][1].update(euler=None),
        "bodies[1].euler",
        "null is no value",
        "bad-scene",
    ),
    "$schema": (changed(**{"$schema": 3}), "'$schema'", "a text", "bad-scene"),
    "two points": (
        outline([0, 0], [1, 0]),
        "bodies[0].shape.points",
        "a list of at least 3",
        "bad-scene",
    ),
    "repeated point": (
        outline([0, 0], [1, 0], [0, 1], [0, 0]),
        "bodies[0].shape",
        "points[3] repeats points[0]",
        "bad-scene",
    ),
    "point in space": (
        outline([0, 0], [1, 0], [0, 1, 0]),
        "bodies[0].shape.points[2]",
        "a list of 2 expected",
        "bad-scene",
    ),
    "crossing": (
        outline([0, 0], [1, 1], [1, 0], [0, 1]),
        "bodies[0].shape",
        "points[0] and points[2] cross",
        "bad-scene",
    ),
    "static": (changed("bodies", 0, static=1), "bodies[0].static", "true or false", "bad-scene"),
    "groups": (
        changed("bodies", 0, groups="a"),
        "bodies[0].groups",
        "a list expected",
        "bad-scene",
    ),
    "position": (
        changed("bodies", 0, position=[1, 2]),
        "bodies[0].position",
        "a list of 3 expected, not a list of 2",
        "bad-scene",
    ),
    "scale": (changed("bodies", 2, scale=0), "bodies[2].scale", "0", "singular-transform"),
    "selector": (changed("rules", 1, a=""), "rules[1].a", "is empty", "bad-rule"),
    "group selector": (changed("rules", 1, b="group:"), "rules[1].b", "is empty", "bad-rule"),
    "no selector": (changed("rules", 1, b=None), "rules[1]", '"b" is missing', "bad-scene"),
    "rule key": (changed("rules", 1, reson=""), "rules[1].reson", "mean 'reason'?", "bad-scene"),
    "no reason": (changed("rules", 0, reason=None), "rules[0]", "why may", "bad-scene"),
    "allowed": (changed("rules", 0, clearance=1), "rules[0]", "is not checked", "bad-rule"),
    "negative": (changed("rules", 1, max_depth=-1), "rules[1].max_depth", ">= 0", "bad-scene"),
    "volume": (
        changed("rules", 2, max_volume="1mm"),
        "rules[2].max_volume",
        "a number",
        "bad-scene",
    ),
    "length": (changed("rules", 1, clearance="1mile"), "rules[1].clearance", "length", "bad-scene"),
    "no length": (
        changed("rules", 1, clearance=[1]),
        "rules[1].clearance",
        "a number or a text expected, not a list of 1",
        "bad-scene",
    ),
    "no selectors": (
        changed("motion", 0, bodies=[]),
        "motion[0].bodies",
        "a selector or a list of selectors expected",
        "bad-scene",
    ),
    "second selector": (
        changed("motion", 2, bodies=["tool", "group:"]),
        "motion[2].bodies[1]",
        "is empty",
        "bad-rule",
    ),
    "null in a list": (
        lambda document: document["bodies"][1]["euler"].append(None),
        "bodies[1].euler[3]",
        "null is no value",
        "bad-scene",
    ),
    "severity": (
        changed("rules", 1, severity="warn"),
        "rules[1].severity",
        "mean 'warning'?",
        "bad-scene",
    ),
    "nobody": (changed("motion", 0, bodies="x*"), "motion[0].bodies", "no body", "bad-motion"),
    "half of them": (
        changed("motion", 2, bodies=["tool", "bn"]),
        "motion[2].bodies",
        "no body matches 'bn'",
        "bad-motion",
    ),
    "moved twice": (
        changed("motion", 2, bodies="*/1"),
        "motion[2].bodies",
        "moved by motion[0] already",
        "bad-motion",
    ),
    "static moves": (
        changed("motion", 0, bodies=["arm/1", "floor"]),
        "motion[0].bodies",
        "'floor' is static",
        "bad-motion",
    ),
    "two paths": (changed("motion", 0, rotation=TURN), "motion[0]", "exactly one of", "bad-scene"),
    "no path": (changed("motion", 0, translation=None), "motion[0]", "exactly one of", "bad-scene"),
    "rotation": (changed("motion", 1, rotation=3), "motion[1].rotation", "a table", "bad-scene"),
    "no axis": (
        changed("motion", 1, "rotation", axis=None),
        "motion[1].rotation",
        "axis",
        "bad-scene",
    ),
    "axis": (changed("motion", 1, "rotation", axis=[0, 0, 0]), "motion[1]", "axis", "bad-motion"),
    "angle": (
        changed("motion", 1, "rotation", degree=3),
        "motion[1].rotation.degree",
        "unknown key",
        "bad-scene",
    ),
    "times": (changed("motion", 2, "path", 1, time=0), "motion[2]", "increase", "bad-motion"),
    "no time": (
        changed("motion", 2, "path", 0, time=None),
        "motion[2].path[0]",
        "time",
        "bad-scene",
    ),
    "waypoint": (
        changed("motion", 2, "path", 1, position=[1]),
        "motion[2].path[1].position",
        "a list of 3 expected, not a list of 1",
        "bad-scene",
    ),
    "two turns": (
        changed("motion", 2, "path", 1, quaternion=[1, 0, 0, 0]),
        "motion[2].path[1].euler",
        "remove this key",
        "bad-scene",
    ),
}


@pytest.mark.parametrize("form", FORMS)
@pytest.mark.parametrize("name", WRONG)
def test_refused_at_its_key_and_line(tmp_path, name, form):
    change, where, said, code = WRONG[name]
    if form == "toml" and name in ("null", "null in a list", "$schema"):
        pytest.skip("not written in TOML here")
    document = full()
    change(document)
    first, *others = errors(tmp_path, document, form)
    assert others == []
    assert (first.code, first.file) == (code, f"cell.{form}")
    at, _, message = str(first).removeprefix(f"cell.{form}:").partition(": ")
    assert message.startswith(f"{where}: " if where else '"')
    assert said in message
    last = re.findall(r"\w+", where)[-1:] if where else []
    if last and not last[0].isdigit():
        line = (tmp_path / f"cell.{form}").read_text().splitlines()[int(at) - 1]
        assert last[0] in line


def test_the_errors_of_all_tables_are_told_at_once_in_the_order_of_the_file(tmp_path):
    document = full()
    for name in ("severity", "position", "nobody"):
        WRONG[name][0](document)
    found = errors(tmp_path, document)
    assert [error.line for error in found] == sorted(error.line for error in found)
    assert [str(error).split(": ")[1] for error in found] == [
        "bodies[0].position",
        "rules[1].severity",
    ]


def test_a_file_full_of_errors_is_told_of_in_part(tmp_path):
    document = scene_of(*({"id": f"b{k}", "shape": BOX, "position": k} for k in range(50)))
    found = errors(tmp_path, document)
    assert len(found) == 21
    assert str(found[-1]) == "cell.json: 30 more errors"


def test_a_key_given_twice_is_wrong_in_json_too(tmp_path):
    text = '{"schema": "satcheck.scene/1",\n"bodies": [],\n"units": "mm",\n"units": "m"}'
    (error,) = errors(tmp_path, text)
    assert str(error) == "cell.json:4: units: a second value for this key"
    (error,) = errors(tmp_path, 'schema = "satcheck.scene/1"\nunits = "m"\nunits = "mm"\n', "toml")
    assert (error.code, error.line) == ("bad-scene", 3)


def test_lengths_with_a_unit_need_declared_ones(tmp_path):
    document = full()
    del document["units"]
    (error,) = errors(tmp_path, document)
    assert "rules[1].clearance: 2mm: no units are declared" in str(error)
    assert "or declare `units` in this file" in str(error)


@pytest.mark.parametrize(
    ("text", "form", "said"),
    [
        ("schema = ", "toml", ":1: not well-formed TOML"),
        ("a = 1\nb = [\n", "toml", ": not well-formed TOML"),
        ("a = " + "[" * 100_000, "toml", ": not readable TOML"),
        ("a = " + "9" * 5000, "toml", ": not readable TOML: a number of more than 4300 digits"),
        (f'{{"a": {"9" * 5000}}}', "json", "not readable JSON: a number of more than 4300 digits"),
        ('{"schema": ', "json", ":1: not well-formed JSON"),
        ("[]", "json", ': not a scene file: "schema" is not "satcheck.scene/1"'),
        ('schema = "satcheck-scene-1"', "toml", "but 'satcheck-scene-1'"),
        ('schema = "satcheck.scene/2"', "toml", "but 'satcheck.scene/2'"),
        ('units = "m"\nschema = "satcheck.scene/2"', "toml", "cell.toml:2: not a scene file"),
        ('{"units": "m",\n\n"schema": 1}', "json", "cell.json:3: not a scene file"),
        ("[[rule]]\nallowed = true\n", "toml", "; rule is unknown (did you mean 'rules'?)"),
        ("[[rules]]\nmax_depth = 2 mm\n", "toml", ":2: a length with a unit stands in quotes: "),
    ],
)
def test_what_is_no_scene_at_all(tmp_path, text, form, said):
    (error,) = errors(tmp_path, text, form)
    assert error.code == "bad-scene"
    assert said in str(error)


def test_nesting_does_not_break_the_search_for_lines(tmp_path):
    depth = 200
    text = 'schema = "satcheck.scene/1"\nbodies = ' + "[" * depth + "]" * depth
    (error,) = errors(tmp_path, text, "toml")
    assert str(error) == "cell.toml:2: bodies[0]: a table expected, not a list of 1"


def test_a_mesh_outside_of_the_folder_needs_to_be_allowed(tmp_path):
    folder = tmp_path / "scenes"
    folder.mkdir()
    write(tmp_path, scene_of())
    document = scene_of({"id": "a", "mesh": "../cube.obj"})
    (error,) = errors(folder, document)
    assert error.code == "outside-path"
    (body,) = read(folder, document, permitted=ANYWHERE).items
    assert body.shape.path == "../cube.obj"


def test_a_link_that_leads_outside_lies_outside(tmp_path):
    folder = tmp_path / "scenes"
    folder.mkdir()
    write(tmp_path, scene_of())
    try:
        (folder / "link.obj").symlink_to(tmp_path / "cube.obj")
        (folder / "inner").symlink_to(folder)
    except OSError:
        pytest.skip("no links on this file system")
    (error,) = errors(folder, scene_of({"id": "a", "mesh": "link.obj"}))
    assert error.code == "outside-path"
    assert read(folder, scene_of({"id": "a", "mesh": "inner/cube.obj"})).items


def test_nothing_of_a_file_outside_is_told(tmp_path):
    """Neither whether it is there nor what it holds."""
    told = {
        str(error)
        for mesh in ("/etc/hosts.obj", "/no/such/place.obj")
        for error in errors(tmp_path, scene_of({"id": "a", "mesh": mesh}))
    }
    assert len({re.sub(r"'.*'", "", text) for text in told}) == 1


def test_the_error_is_one_of_the_scene(tmp_path):
    with pytest.raises(Refused):
        read(tmp_path, scene_of(3))


def test_the_example_of_the_documentation_is_one(tmp_path):
    text = (Path(__file__).parents[3] / "docs" / "scenes.md").read_text(encoding="utf-8")
    example = text.partition("```toml\n")[2].partition("```")[0]
    (tmp_path / "finger.obj").write_bytes(files.obj())
    scene = read(tmp_path, example, "toml")
    assert (len(scene.items), len(scene.rules), len(scene.motions)) == (2, 1, 1)
    assert scene.issues == ()
