"""New scene files: they state what the scene states, and are read back as it stood."""

from __future__ import annotations

import base64
import json
import struct
from pathlib import Path

import pytest
from msgspec.structs import replace

from satcheck.scene import Scene, load_scene
from satcheck.scene.access import ANYWHERE
from satcheck.scene.files.readers import ReadLimits
from satcheck.scene.mesh_files import MeshFiles
from satcheck.scene.new_scene_file import left_out_of, new_scene_file
from satcheck.scene.robot import posed
from tests.audit.shapes import unit_box, write
from tests.plugin_marks import skip_without

SAMPLES = Path(__file__).parents[2] / "sample_meshes"
BY = (0.1 + 0.2, -2.5e-300, 1 / 3)
SCENE = """\
schema = "satcheck.scene/1"
units = "mm"
check_static = true
ignore_within_groups = ["bolts"]
statics = { gravity = [0, 0, -9.81], friction = 0.25, tolerance = 0.5 }

[[bodies]]
id = "a [*]"
mesh = "a.obj"
groups = ["bolts", "steel"]
euler = [10, 20, 30]
scale = 2
static = true
surface_tolerance = 0.25

[[bodies]]
id = "ball"
shape = { type = "sphere", radius = 0.1 }
position = [0.1, 0.2, 0.3]
pinned = true

[[bodies]]
id = "swing"
mesh = "a.obj"
units = "m"

[[bodies]]
id = "door"
mesh = "a.obj"

[[bodies]]
id = "drone"
mesh = "a.obj"

[[rules]]
a = "group:bolts"
b = "ball"
allowed = true
reason = "press fit"

[[rules]]
a = "*"
b = "ball"
clearance = 0.5
max_volume = 2
severity = "note"

[[rules]]
bodies = "group:*"
stable = true
density = 2.5
reason = "it stands"

[[motion]]
bodies = "swing"
translation = [1, 2, 3]
clear = true

[[motion]]
bodies = "door"
rotation = { axis = [0, 0, 1], point = [1, 0, 0], degrees = 90 }

[[motion]]
bodies = "drone"
path = [{ time = 0, position = [0, 0, 0] }, { time = 1, position = [1, 0, 0], euler = [0, 0, 45] }]
"""


def two_nodes() -> str:
    """A glTF file in which two nodes show one box, one of them elsewhere."""
    points, quads = unit_box()
    corners = [k for quad in quads for k in (quad[0], *quad[1:3], quad[0], *quad[2:])]
    data = b"".join(struct.pack("<3f", *point) for point in points)
    data += struct.pack(f"<{len(corners)}H", *corners)
    uri = f"data:application/octet-stream;base64,{base64.b64encode(data).decode()}"
    mesh = {"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}
    return json.dumps(
        {
            "asset": {"version": "2.0"},
            "scene": 0,
            "scenes": [{"nodes": [0, 1]}],
            "nodes": [
                {"name": "one", "mesh": 0},
                {"name": "two", "mesh": 0, "translation": [0.5, 0.25, 0]},
            ],
            "meshes": [mesh],
            "buffers": [{"uri": uri, "byteLength": len(data)}],
            "bufferViews": [
                {"buffer": 0, "byteOffset": 0, "byteLength": 96},
                {"buffer": 0, "byteOffset": 96, "byteLength": len(data) - 96},
            ],
            "accessors": [
                {
                    "bufferView": 0,
                    "componentType": 5126,
                    "count": 8,
                    "type": "VEC3",
                    "min": [0, 0, 0],
                    "max": [1, 1, 1],
                },
                {
                    "bufferView": 1,
                    "componentType": 5123,
                    "count": len(corners),
                    "type": "SCALAR",
                },
            ],
        }
    )


def written(output: Path, scene: Scene, **moves: tuple[float, float, float]) -> Scene:
    text = new_scene_file(output, scene, MeshFiles(ReadLimits(permitted=ANYWHERE)), moves)
    output.write_text(text, encoding="utf-8")
    return load_scene([output], allow_outside=True)


def assert_alike(made: Scene, scene: Scene) -> None:
    """But for the places of files and lines."""
    kept = ("id", "groups", "static", "pinned", "shape", "units", "surface_tolerance")
    assert [[getattr(body, key) for key in kept] for body in made.bodies] == [
        [getattr(body, key) for key in kept] for body in scene.bodies
    ]
    assert [body.id for body in made.unreadable] == [body.id for body in scene.unreadable]
    assert made.units == scene.units
    if any(body.static for body in scene.bodies):
        assert made.check_static == scene.check_static
    assert made.ignore_within_groups == scene.ignore_within_groups
    assert made.motions == scene.motions
    nowhere = {"where": "", "file": None, "line": None}
    assert [replace(rule, **nowhere) for rule in made.rules] == [
        replace(rule, **nowhere) for rule in scene.rules
    ]
    assert [replace(rule, **nowhere) for rule in made.body_rules] == [
        replace(rule, **nowhere) for rule in scene.body_rules
    ]
    assert made.statics == scene.statics
    for new, old in zip(made.bodies, scene.bodies, strict=True):
        assert new.world_mesh().to_bytes() == old.world_mesh().to_bytes(), new.id


@pytest.mark.parametrize("ending", ["toml", "json"])
def test_a_scene_file_is_written_as_it_was_read(tmp_path, ending) -> None:
    write(tmp_path, a=unit_box())
    source = tmp_path / "scene.toml"
    source.write_text(SCENE)
    scene = load_scene([source])
    assert len(scene.motions) == 3
    assert_alike(written(tmp_path / f"made.{ending}", scene), scene)


@pytest.mark.parametrize(
    "sample", sorted(p.name for p in SAMPLES.iterdir() if p.suffix in (".toml", ".urdf", ".sdf"))
)
def test_each_sample_is_written_as_it_was_read(tmp_path, sample) -> None:
    skip_without([sample])
    scene = load_scene([SAMPLES / sample])
    assert_alike(written(tmp_path / "made.toml", scene), scene)


def test_a_robot_is_written_in_its_pose(tmp_path) -> None:
    scene = load_scene([SAMPLES / "arm.urdf"])
    joint, *_ = scene.posture.joints
    turned = posed(scene, {joint: [0.125]})
    made = written(tmp_path / "made.toml", turned)
    assert_alike(made, turned)
    rest = {body.id: body.transform for body in scene.bodies}
    assert any(body.transform != rest[body.id] for body in made.bodies)


def test_mesh_files_become_a_scene(tmp_path) -> None:
    scene = load_scene(write(tmp_path, a=unit_box(), b=unit_box(2)))
    output = tmp_path / "made.json"
    made = written(output, scene, b=BY)
    assert [body.id for body in made.bodies] == ["a", "b"]
    assert made.bodies[0].transform is None
    assert made.bodies[1].transform[3::4] == (*BY, 1)


def test_nodes_of_a_file_become_parts(tmp_path) -> None:
    (tmp_path / "asm.gltf").write_text(two_nodes())
    scene = load_scene([tmp_path / "asm.gltf"])
    output = tmp_path / "made.json"
    made = written(output, scene, **{scene.bodies[1].id: BY})
    assert [body.id for body in made.bodies] == [body.id for body in scene.bodies]
    assert made.units == scene.units
    assert made.bodies[0].world_mesh().bounds == scene.bodies[0].world_mesh().bounds
    (x, y, z), _ = scene.bodies[1].world_mesh().bounds
    assert made.bodies[1].world_mesh().bounds[0] == (x + BY[0], y + BY[1], z + BY[2])


def test_units_of_meshes_that_state_none_are_written(tmp_path) -> None:
    write(tmp_path, a=unit_box())
    inches = tmp_path / "scene.toml"
    inches.write_text(
        'schema = "satcheck.scene/1"\nunits = "in"\n[[bodies]]\nid = "x"\nmesh = "a.obj"\n'
        "[[bodies]]\nid = 'y'\nmesh = 'a.obj'\nunits = 'mm'\nposition = [3, 0, 0]\n"
    )
    scene = load_scene([inches])
    assert_alike(written(tmp_path / "made.json", scene), scene)


def test_a_broken_file_stays_a_body_and_a_lost_one_is_named(tmp_path) -> None:
    paths = write(tmp_path, a=unit_box())
    broken = tmp_path / "broken.obj"
    broken.write_text("v 0 0 nowhere\n")
    scene = load_scene([*paths, broken, tmp_path / "lost.obj"])
    assert [body.id for body in scene.unreadable] == ["broken", "lost"]
    assert left_out_of(scene) == ["lost"]
    made = written(tmp_path / "made.toml", scene)
    assert [body.id for body in made.unreadable] == ["broken"]
