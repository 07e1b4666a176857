"""`satcheck resolve` as a whole process: what it writes, its documents and exit codes."""

from __future__ import annotations

import json
import shutil
import tomllib
from pathlib import Path

import pytest
from jsonschema import Draft202012Validator

from satcheck.cli.commands.schema import text
from tests.audit.shapes import open_box, unit_box, write
from tests.cli.process import APART, PUSHED, SAMPLES, satcheck
from tests.plugin_marks import needs
from tests.plugins.usd.files import at, cube, stage
from tests.scene.files import glb, gltf_document

# The box from (0, 0, 0) to (1, 1, 1).
BOX = "".join(f"v {x} {y} {z}\n" for z in (0, 1) for y in (0, 1) for x in (0, 1)) + (
    "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n"
)
SCHEMA = json.loads(text("resolution"))


def scene_of_boxes(folder: Path, *xs: float, **extra: object) -> str:
    (folder / "box.obj").write_text(BOX)
    rows = [[0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]
    bodies = [
        {"id": f"box{k}", "mesh": "box.obj", "transform": [[1, 0, 0, x], *rows]}
        for k, x in enumerate(xs)
    ]
    path = folder / "scene.json"
    path.write_text(json.dumps({"schema": "satcheck-scene-1", "bodies": bodies, **extra}))
    return str(path)


def test_a_dry_run_shows_the_moves() -> None:
    ran = satcheck("resolve", *PUSHED, "--pin", "box")
    assert ran.code == 0, ran.err
    assert "box_pushed" in ran.out
    assert "(1, 0, 0)" in ran.out
    assert "1 overlap: 1 body moved, by 1 in total and 1 at most" in ran.out
    assert "1 body had to stay" in ran.out
    assert ran.out.endswith("1 touching.\nPASS: no collision.\n")


def test_a_scene_without_an_input_is_not_written(tmp_path: Path) -> None:
    """A check of it could pass, although a body is missing."""
    shutil.copy(SAMPLES / "box.obj", tmp_path)
    output = tmp_path / "moved.toml"
    paths = [str(tmp_path / name) for name in ("box.obj", "lost.obj")]
    ran = satcheck("resolve", *paths, "-o", str(output))
    assert ran.code == 2
    assert "lost could not be read, and a scene file cannot state it" in ran.err
    assert not output.exists()


def test_no_option_is_named_that_resolve_lacks(tmp_path: Path) -> None:
    ran = satcheck("resolve", str(scene_of_boxes(tmp_path, 0, 0.7)), "--pin", "*")
    assert ran.code == 1
    assert "penetrating" in ran.out
    assert "--depth" not in ran.out


def test_what_was_moved_out_of_a_hole_is_counted(tmp_path: Path) -> None:
    """A cube in the rim of a box without a lid."""
    paths = [str(path) for path in write(tmp_path, tray=open_box(), cube=unit_box(1, 1, 3.5))]
    ran = satcheck("resolve", *paths)
    assert ran.code == 0, ran.err
    assert "1 pair left open by a hole: 2 bodies moved, by 0.5 in total" in ran.out
    assert "nothing was moved" not in ran.out
    found = satcheck("resolve", *paths, "--format", "json").document
    Draft202012Validator(SCHEMA).validate(found)
    summary = found["summary"]
    assert (summary["conflicts"], summary["open"], summary["moved"]) == (1, 1, 2)


def test_a_pair_that_is_left_is_named_as_it_is(tmp_path: Path) -> None:
    paths = [str(path) for path in write(tmp_path, shell=unit_box(edge=4), cube=unit_box(1, 1, 1))]
    ran = satcheck("resolve", *paths, "--pin", "*")
    assert ran.code == 1
    assert "not resolved: shell contains cube: both bodies stay" in ran.out


def test_what_is_written_passes_a_check(tmp_path: Path) -> None:
    scene, moved = scene_of_boxes(tmp_path, 0, 0.7, 1.4, units="mm"), str(tmp_path / "moved.toml")
    assert satcheck("--no-depth", scene).code == 1
    ran = satcheck("resolve", scene, "-o", moved, "--clearance", "10um")
    assert ran.code == 0, ran.err
    assert f"{moved}, checked again: 3 bodies, 3 pairs" in " ".join(ran.out.split())
    assert satcheck("--no-depth", "--clearance", "10um", moved).code == 0


def test_the_document_follows_its_schema(tmp_path: Path) -> None:
    output = tmp_path / "moved.toml"
    ran = satcheck("resolve", *(str(SAMPLES / name) for name in PUSHED), "--format", "json")
    assert ran.code == 0, ran.err
    Draft202012Validator(SCHEMA).validate(ran.document)
    assert ran.document["summary"]["total_motion"] == 1.0
    assert [move["translation"] for move in ran.document["moves"]] == [[-0.5, 0, 0], [0.5, 0, 0]]
    scene = scene_of_boxes(tmp_path, 0, 0.5)
    written = satcheck("resolve", scene, "-o", str(output), "--format", "json")
    Draft202012Validator(SCHEMA).validate(written.document)
    assert written.document["output"] == str(output)


def test_the_same_scene_gives_the_same_bytes(tmp_path: Path) -> None:
    scene, output = scene_of_boxes(tmp_path, 0, 0.3, 0.8, 1.1), tmp_path / "moved.toml"
    seen = set()
    arguments = ("resolve", scene, "-o", str(output), "--format", "json")
    for jobs in ("1", "3"):
        ran = satcheck(*arguments, "--jobs", jobs, env={"PYTHONHASHSEED": jobs})
        seen.add((ran.out, output.read_bytes()))
    assert len(seen) == 1


def test_the_schema_is_printed() -> None:
    assert satcheck("schema", "resolution").document == SCHEMA


def test_nothing_to_do_is_said() -> None:
    ran = satcheck("resolve", *APART)
    assert ran.code == 0
    assert "nothing was moved" in ran.out


def test_what_cannot_be_resolved_is_said(tmp_path: Path) -> None:
    scene = scene_of_boxes(tmp_path, 0, 0.5)
    ran = satcheck("resolve", scene, "--pin", "*")
    assert ran.code == 1
    assert "not resolved: box0 and box1 overlap: both bodies stay" in ran.out


def test_the_longest_motion_is_in_units(tmp_path: Path) -> None:
    scene = scene_of_boxes(tmp_path, 0, 0.5, units="m")
    assert satcheck("resolve", scene, "--max-motion", "26cm").code == 0
    ran = satcheck("resolve", scene, "--max-motion", "24cm")
    assert ran.code == 1
    assert "longest motion" in ran.out


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ((), "give two or more"),
        (("box.obj",), "one body alone"),
        (("missing.json",), "no such file"),
        ((*PUSHED, "--pin", "boks"), "no body is boks: there are box, box_pushed"),
        ((*PUSHED, "-o", "moved.obj"), ".scene.json, .txt, .json"),
        ((*PUSHED, "workcell.json", "-o", "moved.toml"), "or files without joints"),
        ((*PUSHED, "--max-motion", "1mm"), "no units"),
        (("arm.urdf", "arm.srdf", "-o", "moved.toml"), "links of robots are not moved"),
        (("cell.toml", "-o", "cell.toml"), "overwrite an input"),
        (("workcell.json", "-o", "nowhere/moved.toml"), "does not exist"),
    ],
)
def test_wrong_usage(arguments: tuple[str, ...], said: str) -> None:
    ran = satcheck("resolve", *arguments)
    assert ran.code == 2
    assert said in ran.err


def test_the_new_scene_keeps_what_the_scene_states(tmp_path: Path) -> None:
    (tmp_path / "box.obj").write_text(BOX)
    (tmp_path / "lost.obj").write_text("no mesh\n")
    scene, moved = tmp_path / "scene.toml", tmp_path / "elsewhere" / "moved.toml"
    moved.parent.mkdir()
    scene.write_text("""\
schema = "satcheck.scene/1"
units = "mm"
ignore_within_groups = ["steel"]
statics = { gravity = [0, 0, -9.81], friction = 0.25, tolerance = 0.5 }
bodies = [
    {id = "a", mesh = "box.obj", pinned = true, groups = ["steel"]},
    {id = "b", mesh = "box.obj", position = [0.75, 0, 0]},
    {id = "c", mesh = "box.obj", position = [0, 0.5, 0], static = true, groups = ["steel"]},
    {id = "lost", mesh = "lost.obj"},
]
rules = [
    {a = "b", b = "c", allowed = true, reason = "a press fit"},
    {bodies = "b", supported = true, reason = "it stands"},
]
motion = [{bodies = "b", translation = [5, 0, 0]}]
""")
    arguments = ("resolve", "scene.toml", "-o", "elsewhere/moved.toml", "--allow-outside")
    ran = satcheck(*arguments, cwd=tmp_path)
    assert ran.code == 2, ran.err  # a body is unreadable, as in the source
    before, after = (tomllib.loads(path.read_text()) for path in (scene, moved))
    for entry in before["bodies"]:
        entry["mesh"] = f"../{entry['mesh']}"
    before["bodies"][1]["position"] = [1.0, 0, 0]
    before["motion"][0]["bodies"] = ["b"]
    assert after == before


def test_what_a_new_scene_cannot_state_is_refused(tmp_path: Path) -> None:
    """Without the file that is missing the new scene would pass."""
    for name in PUSHED:
        shutil.copy(SAMPLES / name, tmp_path)
    moved = tmp_path / "moved.toml"
    ran = satcheck("resolve", *PUSHED, "gone.obj", "-o", str(moved), cwd=tmp_path)
    assert ran.code == 2
    assert "gone could not be read" in " ".join(ran.err.split())
    assert not moved.exists()


def test_overlaps_and_gaps_are_counted_apart(tmp_path: Path) -> None:
    scene = scene_of_boxes(tmp_path, 0, 0.75, 5, 6.25)
    ran = satcheck("resolve", scene, "--clearance", "0.5")
    assert ran.code == 0, ran.err
    assert "1 overlap, 1 gap below its clearance: 4 bodies moved" in ran.out


def test_a_hit_on_the_way_is_said_to_be_left(tmp_path: Path) -> None:
    scene = tmp_path / "door.toml"
    scene.write_text("""\
schema = "satcheck.scene/1"
bodies = [
    {id = "door", shape = {type = "box", size = [1, 1, 1]}},
    {id = "post", shape = {type = "box", size = [1, 1, 1]}, position = [3, 0, 0]},
]
motion = [{bodies = "door", translation = [5, 0, 0]}]
""")
    ran = satcheck("resolve", str(scene))
    assert ran.code == 1
    assert (
        "not resolved: door hits post at 2 of travel, near (2.5, 0.5, -0.5): only while they move,"
        in ran.out
    )
    assert "Nothing overlaps as the bodies are placed: nothing was moved." in ran.out


def test_mesh_files_become_a_scene_in_toml(tmp_path: Path) -> None:
    for name in PUSHED:
        shutil.copy(SAMPLES / name, tmp_path)
    moved = tmp_path / "moved.toml"
    ran = satcheck("resolve", *(str(tmp_path / name) for name in PUSHED), "-o", str(moved))
    assert ran.code == 0, ran.err
    document = tomllib.loads(moved.read_text())
    assert document["schema"] == "satcheck.scene/1"
    assert [body["position"] for body in document["bodies"]] == [[-0.5, 0, 0], [0.5, 0, 0]]
    assert satcheck("--no-depth", str(moved)).code == 0


def test_a_scene_that_could_not_be_read_is_not_written(tmp_path: Path) -> None:
    meshes = [str(SAMPLES / name) for name in PUSHED]
    moved = tmp_path / "moved.toml"
    ran = satcheck("resolve", *meshes, "-o", str(moved))
    assert ran.code == 2
    assert "write it into a folder that contains the meshes" in " ".join(ran.err.split())
    assert not moved.exists()
    ran = satcheck("resolve", *meshes, "-o", str(moved), "--allow-outside")
    assert ran.code == 0, ran.err
    assert "give --allow-outside" in ran.err
    assert satcheck("--no-depth", "--allow-outside", str(moved)).code == 0


def test_the_links_of_a_robot_are_said_to_stay(tmp_path: Path) -> None:
    box = '<collision><geometry><box size="1 1 1"/></geometry></collision>'
    robot = tmp_path / "robot.urdf"
    robot.write_text(f"""\
<robot name="r"><link name="base">{box}</link><link name="slide">{box}</link>
<joint name="j" type="prismatic"><parent link="base"/><child link="slide"/>
<axis xyz="1 0 0"/><limit lower="0" upper="2" effort="1" velocity="1"/></joint></robot>
""")
    ran = satcheck("resolve", str(robot), "--pose", '{"j": 0.5}')
    assert ran.code == 1
    assert "base and slide overlap: links of a robot stay where" in " ".join(ran.out.split())
    assert satcheck("resolve", str(robot), "--pose", '{"j": 1.5}').code == 0
    refused = satcheck("resolve", str(robot), "--pose", '[{"j": 0}, {"j": 1}]')
    assert "takes one pose" in refused.err


def test_the_report_goes_where_that_of_any_command_goes(tmp_path: Path) -> None:
    report, moved = tmp_path / "report.json", tmp_path / "moved.toml"
    scene = scene_of_boxes(tmp_path, 0, 0.5)
    ran = satcheck("resolve", scene, "-o", str(moved), "-o", str(report))
    assert (ran.code, ran.out) == (0, ""), ran.err
    assert ran.err.endswith(f"Report: {report}\n")
    document = json.loads(report.read_text(encoding="utf-8"))
    Draft202012Validator(SCHEMA).validate(document)
    assert document["output"] == str(moved)
    assert satcheck("--no-depth", str(moved)).code == 0


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("-o", "x.json", "-o", "y.json"), "x.json is named for that"),
        (("-o", "moved.toml", "-o", "moved.scene.json"), "moved.toml is named for that"),
    ],
)
def test_outputs_that_make_no_sense(arguments: tuple[str, ...], said: str) -> None:
    ran = satcheck("resolve", *PUSHED, *arguments)
    assert ran.code == 2
    assert said in " ".join(ran.err.split())


@needs("usd")
def test_the_parts_of_a_usd_file_become_a_scene(tmp_path: Path) -> None:
    source, output = tmp_path / "scene.usda", tmp_path / "moved.toml"
    source.write_text(stage(cube("A"), cube("B", at(0.75))))
    ran = satcheck("resolve", str(source), "-o", str(output))
    assert ran.code == 0, ran.err
    assert "checked again: 2 bodies, 1 pair: 1 touching" in " ".join(ran.out.split())
    assert satcheck(str(output)).code == 0
    refused = satcheck("resolve", str(source), "-o", str(tmp_path / "moved.usda"))
    assert refused.code == 2
    assert "this command writes .toml, .scene.json" in " ".join(refused.err.split())


def test_the_nodes_of_a_gltf_file_become_a_scene(tmp_path: Path) -> None:
    source, output = tmp_path / "scene.glb", tmp_path / "moved.toml"
    document, _ = gltf_document()
    document["nodes"] = [{"mesh": 0, "name": "a"}, {"mesh": 0, "name": "b", "scale": [2, 2, 2]}]
    document["scenes"] = [{"nodes": [0, 1]}]
    source.write_bytes(glb(document))
    ran = satcheck("resolve", str(source), "-o", str(output))
    assert ran.code == 0, ran.err
    assert "checked again: 2 bodies, 1 pair: 1 touching" in " ".join(ran.out.split())
    assert satcheck(str(output)).code == 0
