"""`--split`: what a body is, and what the command says where there is only one."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import get_args

import pytest

from satcheck.cli import scene_option
from satcheck.scene.files.nodes import Split
from tests.cli.process import VALIDATOR, satcheck
from tests.plugin_marks import needs
from tests.plugins.usd.files import cube, stage
from tests.scene import files, graphs


def test_the_choices_are_those_of_the_loader() -> None:
    assert set(scene_option.SPLITS) == set(get_args(Split))


def test_one_file_alone_is_its_nodes() -> None:
    ran = satcheck("--format", "json", "--no-depth", "gripper.glb")
    VALIDATOR.validate(ran.document)
    bodies = ran.document["bodies"]
    assert [body["id"] for body in bodies] == [
        "gripper/palm",
        "gripper/left",
        "gripper/right",
        "payload",
    ]
    assert [body["path"] for body in bodies] == [body["id"] for body in bodies]
    assert {body["file"] for body in bodies} == {"gripper.glb"}
    assert len({body["sha256"] for body in bodies}) == 1
    assert ran.document["units"] == "meter"


def test_objects_of_obj_are_bodies_where_the_file_is_alone(tmp_path: Path) -> None:
    """Two cubes that overlap in `two.obj`; the cube in the other file is away."""
    middle = [(x + 0.5, y, z) for x, y, z in files.CUBE_POINTS]
    faces = [tuple(i + 8 for i in face) for face in files.CUBE]
    one = files.obj(), files.obj(middle, []), files.obj([], faces)
    (tmp_path / "two.obj").write_bytes(b"o one\n%bo two\n%b%b" % one)
    far = [(x + 9, y, z) for x, y, z in files.CUBE_POINTS]
    (tmp_path / "far.obj").write_bytes(b"o away\n" + files.obj(far))
    alone = satcheck("--format", "json", "two.obj", cwd=tmp_path)
    assert [body["id"] for body in alone.document["bodies"]] == ["one", "two"]
    assert [body["path"] for body in alone.document["bodies"]] == ["one", "two"]
    assert [each["relation"] for each in alone.document["findings"]] == ["penetrating"]
    together = satcheck("--format", "json", "two.obj", "far.obj", cwd=tmp_path)
    assert [body["id"] for body in together.document["bodies"]] == ["two", "far"]
    assert together.code == 0
    assert satcheck("batch", "two.obj", "far.obj", cwd=tmp_path).code == 1


def test_units_of_a_file_are_those_of_lengths() -> None:
    """In metres the payload is 0.5 under the palm: 600 mm is more, 400 mm is not."""
    for clearance, relation in (("600mm", "near"), ("400mm", "separated")):
        ran = satcheck("--format", "json", "--no-depth", "--clearance", clearance, "gripper.glb")
        found = {(one["a"], one["b"]): one["relation"] for one in ran.document["findings"]}
        assert found["gripper/palm", "payload"] == relation


@pytest.mark.parametrize("mode", [0, 1])
def test_a_node_of_lines_or_points_is_a_note(tmp_path: Path, mode: int) -> None:
    document, buffer = graphs.meshes("cube", "line")
    document["meshes"][1]["primitives"] = [{"attributes": {"POSITION": 0}, "mode": mode}]
    far = {"name": "c", "mesh": 0, "translation": [3, 0, 0]}
    document["nodes"] = [{"name": "a", "mesh": 0}, {"name": "b", "mesh": 1}, far]
    document["scenes"] = [{"nodes": [0, 1, 2]}]
    path = tmp_path / "lines.glb"
    path.write_bytes(files.glb(document, buffer))
    ran = satcheck("--format", "json", str(path))
    assert ran.code == 0
    assert [body["id"] for body in ran.document["bodies"]] == ["a", "c"]
    assert [issue["code"] for issue in ran.document["issues"]] == ["left-out"]


def test_components_of_a_plain_mesh(tmp_path: Path) -> None:
    path = tmp_path / "two.stl"
    path.write_bytes(files.binary_stl(files.TWO_CUBES_POINTS, files.TWO_CUBES))
    ran = satcheck("--format", "json", "--split", "components", str(path))
    assert ran.code == 0
    assert [body["id"] for body in ran.document["bodies"]] == ["two#1", "two#2"]
    assert [body["path"] for body in ran.document["bodies"]] == ["#1", "#2"]


@pytest.mark.parametrize(("shift", "code"), [(0.0, 0), (0.5, 1)])
def test_a_ball_in_a_cavity_is_free_until_it_meets_the_wall(
    tmp_path: Path, shift: float, code: int
) -> None:
    """A box of 3 with a cavity of 2 around a cube of 1, which has 0.5 on each side."""
    points: list[tuple[float, float, float]] = []
    faces: list[Sequence[int]] = []
    for k, (low, side) in enumerate(((-1.0, 3), (-0.5, 2), (shift, 1))):
        points += [
            (low + side * x, low + side * y, low + side * z) for x, y, z in files.CUBE_POINTS
        ]
        own = [face[::-1] for face in files.CUBE] if side == 2 else files.CUBE
        faces += [tuple(i + 8 * k for i in face) for face in own]
    (tmp_path / "box.obj").write_bytes(files.obj(points, faces))
    nearly = "--clearance", "0.1"
    ran = satcheck("--split", "components", *nearly, "--format", "json", "box.obj", cwd=tmp_path)
    assert ran.code == code
    assert [body["id"] for body in ran.document["bodies"]] == ["box#1", "box#2"]


@pytest.mark.parametrize(
    ("arguments", "told", "hinted"),
    [
        (["box.obj"], "one body alone", False),
        (["box.obj", "--split", "nodes"], "one body alone", False),
        (["gripper.glb", "--split", "none"], "one body alone", True),
        (["ring.glb"], "one body alone", False),
        (["box.obj", "--split", "components"], "box.obj is one piece", False),
        (["gone.glb"], "an input could not be used", False),
        (["workcell.json", "--split", "nodes"], "a scene says what its bodies are", False),
    ],
)
def test_one_body_alone_is_told_how_to_be_several(
    arguments: list[str], told: str, hinted: bool
) -> None:
    ran = satcheck(*arguments)
    assert ran.code == 2
    assert told in " ".join(ran.err.split())
    assert ran.err.rstrip().endswith("--split components") == hinted


def test_the_command_for_connected_pieces_works() -> None:
    told = satcheck("gripper.glb", "--split", "none").err.splitlines()[-1]
    ran = satcheck("--format", "json", *told.replace("satcheck:", "").split()[1:])
    assert len(ran.document["bodies"]) == 4


@needs("usd")
def test_one_body_alone_is_told_why_the_others_are_gone(tmp_path: Path) -> None:
    hidden = cube("Ghost", 'token visibility = "invisible"')
    (tmp_path / "a.usda").write_text(stage(cube("A"), hidden))
    ran = satcheck("a.usda", cwd=tmp_path)
    assert ran.code == 2
    assert "/Ghost: invisible" in ran.err
