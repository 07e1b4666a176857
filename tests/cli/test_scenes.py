"""Scene files on the command line."""

from __future__ import annotations

import json
import shutil
import tomllib
from pathlib import Path

from jsonschema import Draft202012Validator

from tests.cli.process import SAMPLES, VALIDATOR, satcheck
from tests.scene import files
from tests.scene.scene_file.scenes import BOX, scene_of, toml_document, write

JSON = ("--format", "json", "--no-timings")


def test_the_schema_describes_the_sample() -> None:
    schema = satcheck("schema", "scene").document
    sample = tomllib.loads((SAMPLES / "cell.toml").read_text(encoding="utf-8"))
    Draft202012Validator(schema).validate(sample)


def test_toml_and_json_say_the_same(tmp_path: Path) -> None:
    shutil.copy(SAMPLES / "box.obj", tmp_path)
    sample = tomllib.loads((SAMPLES / "cell.toml").read_text(encoding="utf-8"))
    (tmp_path / "cell.json").write_text(json.dumps(sample), encoding="utf-8")
    (tmp_path / "cell.toml").write_text(toml_document(sample), encoding="utf-8")
    found = []
    for name in ("cell.json", "cell.toml"):
        ran = satcheck(*JSON, name, cwd=tmp_path)
        assert ran.code == 0, ran.err
        VALIDATOR.validate(ran.document)
        found.append(ran.document["findings"])
    assert [(f["a"], f["b"], f["relation"], f["depth"]) for f in found[0]] == [
        (f["a"], f["b"], f["relation"], f["depth"]) for f in found[1]
    ]


def test_all_errors_are_told_a_line_each(tmp_path: Path) -> None:
    document = scene_of(
        {"id": "a", "shape": BOX, "position": [1, 2]},
        {"shape": BOX},
        {"id": "c", "mesh": "gone.stl"},
    )
    write(tmp_path, document, "toml")
    ran = satcheck("cell.toml", cwd=tmp_path)
    assert (ran.code, ran.out) == (2, "")
    assert [line.removeprefix("satcheck: error: ") for line in ran.err.splitlines()] == [
        "cell.toml:6: bodies[0].position: a list of 3 expected, not a list of 2 [bad-scene]",
        'cell.toml:8: bodies[1]: "id" is missing [bad-scene]',
        "cell.toml:13: bodies[2].mesh: mesh file 'gone.stl' is missing [missing-resource]",
    ]


def test_files_outside_of_the_folder_are_read_where_that_is_allowed(tmp_path: Path) -> None:
    (tmp_path / "scenes").mkdir()
    shutil.copy(SAMPLES / "box.obj", tmp_path)
    bodies = ({"id": id_, "mesh": "../box.obj"} for id_ in "ab")
    write(tmp_path / "scenes", scene_of(*bodies))
    refused = satcheck(*JSON, "scenes/cell.json", cwd=tmp_path)
    assert refused.code == 2
    assert "allow it with --allow-outside" in refused.err
    read = satcheck(*JSON, "--allow-outside", "scenes/cell.json", cwd=tmp_path)
    assert read.code == 1
    assert read.document["bodies"][0]["file"] == "box.obj"


def test_buffers_of_gltf_files_too_in_every_command_that_reads_them(tmp_path: Path) -> None:
    document, data = files.gltf_document()
    document["buffers"][0]["uri"] = "../cube.bin"
    (tmp_path / "meshes").mkdir()
    (tmp_path / "cube.bin").write_bytes(data)
    for name in ("a.gltf", "b.gltf"):
        (tmp_path / "meshes" / name).write_text(json.dumps(document), encoding="utf-8")
    pair = ("meshes/a.gltf", "meshes/b.gltf")
    report = "report.json"
    calls = {
        ("--no-depth", "--certificate", "-o", report, *pair): 1,
        ("verify", report): 0,
        ("decompose", *pair): 0,
    }
    for arguments, code in calls.items():
        assert satcheck(*arguments, "--allow-outside", cwd=tmp_path).code == code, arguments
        refused = satcheck(*arguments, cwd=tmp_path)
        assert refused.code != code
        assert "outside" in refused.out + refused.err
        satcheck(*arguments, "--allow-outside", cwd=tmp_path)  # the report as it was


def test_every_failure_is_counted_and_told_with_its_limit(tmp_path: Path) -> None:
    """Beside an overlap within its limit, and one on the way, clearances are not lost."""
    at = {"floor": [0, 0, 0], "near": [0, 0, 1.25], "deep": [5, 0, 0], "deeper": [5.75, 0, 0]}
    at |= {"mover": [0, 9, 0], "post": [0, 11.5, 0]}
    document = scene_of(
        *({"id": id_, "shape": BOX, "position": position} for id_, position in at.items()),
        units="mm",
        rules=[
            {"a": "floor", "b": "near", "clearance": 0.5, "reason": "heat"},
            {"a": "deep", "b": "deeper", "max_depth": 0.375},
        ],
        motion=[{"bodies": "mover", "translation": [0, 3, 0]}],
    )
    write(tmp_path, document)
    ran = satcheck("cell.json", cwd=tmp_path)
    assert ran.code == 1
    remarks = [line for line in ran.out.splitlines() if " by cell.json:" in line]
    (remark,) = remarks
    assert remark.startswith("floor and near: error by ")
    assert remark.endswith(", clearance 0.5 mm (heat)")
    assert "1 allowed, " in ran.out
    counts, last, _ = ran.out.splitlines()[-3:]
    assert counts.endswith("1 pair hits in motion.")
    assert last.startswith("FAIL: 1 of 15 pairs hits in motion, 1 is too close; worst: mover hits")
    assert "hits post at 1.5 mm of travel" in last


def test_what_curved_shapes_lack_is_said_once_for_all_pairs(tmp_path: Path) -> None:
    ball = '[[bodies]]\nid = "{}"\nshape = {{type = "sphere", radius = 1}}\n'
    scene = 'schema = "satcheck.scene/1"\n' + "".join(map(ball.format, "abc"))
    (tmp_path / "c.toml").write_text(scene, encoding="utf-8")
    ran = satcheck("--volume", str(tmp_path / "c.toml"))
    said = "volume: not known of 3 pairs with a curved shape, which has no triangles"
    assert ran.out.splitlines().count(said) == 1
    assert "not known" not in satcheck(str(tmp_path / "c.toml")).out


def test_one_body_alone_may_be_asked_whether_it_is_held(tmp_path: Path) -> None:
    """There is no pair to check, and an answer all the same."""
    scene = tmp_path / "scene.toml"
    text = (
        'schema = "satcheck.scene/1"\nunits = "m"\n'
        '[[bodies]]\nid = "lamp"\nshape = { type = "box", size = [1, 1, 1] }\n'
        '[[rules]]\nbodies = "*"\nsupported = true\n'
    )
    scene.write_text(text)
    floats = satcheck(str(scene))
    assert (floats.code, "lamp is not supported: it floats" in floats.out) == (1, True)
    scene.write_text(text + "mounted = true\n")
    holds = satcheck(str(scene))
    assert holds.code == 0


def test_a_way_that_must_be_clear_is_touched_by_nothing_new(tmp_path: Path) -> None:
    """The crate slides on the floor, which touches it as placed, up to a wall."""
    scene = tmp_path / "scene.toml"
    text = (
        'schema = "satcheck.scene/1"\nunits = "m"\n'
        '[[bodies]]\nid = "floor"\nshape = { type = "box", size = [9, 9, 1] }\n'
        "position = [0, 0, -0.5]\n"
        '[[bodies]]\nid = "crate"\nshape = { type = "box", size = [1, 1, 1] }\n'
        "position = [0, 0, 0.5]\n"
        '[[bodies]]\nid = "wall"\nshape = { type = "box", size = [1, 1, 1] }\n'
        "position = [3, 0, 0.5]\n"
        '[[motion]]\nbodies = "crate"\ntranslation = [2, 0, 0]\n'
    )
    scene.write_text(text)
    assert satcheck(str(scene)).code == 0
    scene.write_text(text + "clear = true\n")
    ran = satcheck(str(scene), "--format", "json")
    report = json.loads(ran.out)
    severities = {(f["a"], f["b"]): (f["severity"], f["rule"]) for f in report["findings"]}
    assert ran.code == 1
    assert severities["crate", "wall"] == ("error", "clear")
    assert severities["floor", "crate"] == ("note", None)
    assert [motion["clear"] for motion in report["motions"]] == [True]
