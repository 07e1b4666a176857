"""`satcheck convert` as a whole process: the files it writes are read as the scene was."""

from __future__ import annotations

import shutil
from pathlib import Path

import numpy as np
import pytest
import trimesh

from satcheck.scene import load_scene
from tests.cli.process import SAMPLES, satcheck
from tests.scene.usd.files import at, cube, stage

ROBOT = "arm.urdf"
RELATIONS = ("a", "b", "relation")


@pytest.mark.parametrize("scene", [ROBOT, "cell.toml", "workcell.json", "yard.sdf", "gripper.glb"])
def test_a_check_of_the_written_scene_says_the_same(tmp_path: Path, scene: str) -> None:
    output = tmp_path / "made.toml"
    assert satcheck("convert", scene, "-o", str(output)).code == 0
    before, after = (
        satcheck("--format", "json", "--allow-outside", path) for path in (scene, str(output))
    )
    assert after.code == before.code
    for kind in ("findings", "motions"):
        said = [
            [[finding.get(key) for key in RELATIONS] for finding in ran.document.get(kind) or ()]
            for ran in (before, after)
        ]
        assert said[0] == said[1]


def test_a_glb_has_the_vertices_of_the_scene(tmp_path: Path) -> None:
    output = tmp_path / "made.glb"
    ran = satcheck("convert", ROBOT, "-o", str(output))
    assert ran.code == 0
    assert "GLB has no rules" in ran.err
    read = trimesh.load_scene(output)
    for body in load_scene([SAMPLES / ROBOT]).bodies:
        matrix, geometry = read.graph[body.id]
        points = trimesh.transform_points(read.geometry[geometry].vertices, matrix)
        bounds = np.array([points.min(axis=0), points.max(axis=0)])
        # Coordinates, matrix entries and their products are rounded to float32 or better.
        largest = np.abs(bounds).max()
        assert np.abs(bounds - np.array(body.world_mesh().bounds)).max() <= 4 * 2.0**-24 * largest


def test_what_is_not_in_the_file_is_named(tmp_path: Path) -> None:
    shutil.copy(SAMPLES / "box.obj", tmp_path)
    (tmp_path / "broken.obj").write_text("v 0 0 nowhere\n")
    given = [str(tmp_path / name) for name in ("box.obj", "broken.obj")]
    ran = satcheck("convert", *given, "-o", str(tmp_path / "made.glb"))
    assert ran.code == 3
    assert "broken is not in" in ran.err
    assert list(trimesh.load_scene(tmp_path / "made.glb").geometry) == ["box"]
    ran = satcheck("convert", *given, "-o", str(tmp_path / "made.toml"))
    assert ran.code == 0
    assert "2 bodies" in ran.err


@pytest.mark.parametrize("output", ["made.obj", "made", "no/where.toml"])
def test_files_that_cannot_be_written_are_refused_early(tmp_path: Path, output: str) -> None:
    ran = satcheck("convert", ROBOT, "-o", str(tmp_path / output))
    assert ran.code == 2
    assert not (tmp_path / output).exists()


def test_an_input_is_not_overwritten(tmp_path: Path) -> None:
    scene = tmp_path / "cell.toml"
    shutil.copy(SAMPLES / "cell.toml", scene)
    before = scene.read_bytes()
    assert satcheck("convert", str(scene), "-o", str(scene)).code == 2
    assert scene.read_bytes() == before


def test_a_scene_keeps_the_options_with_which_its_files_are_read(tmp_path: Path) -> None:
    api, hidden = '"PhysicsCollisionAPI"', 'token purpose = "guide"\n'
    source = tmp_path / "stage.usda"
    source.write_text(stage(*(cube(n, hidden + at(x), api) for n, x in (("E", 20), ("F", 20.5)))))
    for ending in ("toml", "json"):
        output = str(tmp_path / f"made.{ending}")
        assert satcheck("convert", str(source), "--geometry", "collision", "-o", output).code == 0
        again = satcheck(output, "--format", "json")
        assert again.code == 1
        assert again.document["findings"][0]["relation"] == "penetrating"
        assert again.document["reading"]["geometry"] == "collision"


def test_what_a_scene_leaves_out_is_told(tmp_path: Path) -> None:
    """The floor is a half space."""
    ran = satcheck("convert", "lift.xml", "-o", str(tmp_path / "made.toml"))
    assert ran.code == 3
    assert "floor is not in" in ran.err
