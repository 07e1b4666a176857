"""`satcheck decompose` for engines: limits, presets, parts that enclose, and robots."""

from __future__ import annotations

import json
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
import trimesh

from satcheck.decompose import ENGINES
from satcheck.scene import load_scene
from tests.cli.process import SAMPLES, private_cache, satcheck
from tests.cli.test_decompose import parts
from tests.oracles.covered import uncovered_triangles

MESHES = ("l_bracket.obj", "ring.glb", "peg_in_notch.ply", "fin_box.obj")


@pytest.fixture(scope="module")
def cached(tmp_path_factory: pytest.TempPathFactory) -> dict[str, str]:
    """Variables of a cache for all these tests: CoACD splits each mesh once."""
    return private_cache(tmp_path_factory.mktemp("cache"))


@pytest.mark.parametrize("engine", ENGINES)
def test_presets_keep_their_limits_in_the_file(
    engine: str, tmp_path: Path, cached: dict[str, str]
) -> None:
    ico = tmp_path / "ico.obj"
    trimesh.creation.icosphere(3).export(ico)
    output = tmp_path / "parts.glb"
    arguments = (*MESHES, str(ico), "--for", engine, "--units", "m", "-o", str(output))
    ran = satcheck("decompose", "--format", "json", *arguments, env=cached)
    assert ran.code == 0
    limits = ENGINES[engine]
    stated = ran.document["settings"]
    assert (stated["max_parts"], stated["max_vertices"]) == (limits.parts, limits.vertices)
    written = parts(output)
    for body in ran.document["bodies"]:
        assert len(body["parts"]) <= (limits.parts or 1000)
        for part in body["parts"]:
            points = written[part["name"]].vertices
            assert part["vertices"] == len(points) <= limits.vertices
            assert part["triangles"] == 2 * part["vertices"] - 4
            assert len(trimesh.convex.convex_hull(points).vertices) <= limits.vertices


def test_the_presets_keep_limits_on_faces() -> None:
    """By Euler's formula a hull of v vertices has at most 2 v - 4 triangles."""
    assert 2 * ENGINES["unity"].vertices - 4 <= 255
    assert 2 * ENGINES["isaac"].vertices - 4 <= 64
    assert ENGINES["isaac"].vertices - 1 <= 32  # around a vertex, and in a polygon


def test_what_is_given_overrides_the_preset(cached: dict[str, str]) -> None:
    arguments = ("l_bracket.obj", "--for", "unreal", "--max-parts", "1", "--max-vertices", "5")
    ran = satcheck("decompose", "--format", "json", *arguments, env=cached)
    (body,) = ran.document["bodies"]
    (part,) = body["parts"]
    assert part["vertices"] == 5
    assert body["encloses"] is None
    assert body["missing"] > 0


@pytest.mark.parametrize("suffix", [".glb", ".obj"])
def test_what_is_written_encloses_the_mesh(
    suffix: str, tmp_path: Path, cached: dict[str, str]
) -> None:
    output, mesh = tmp_path / f"parts{suffix}", tmp_path / "turned.obj"
    trimesh.load_mesh(SAMPLES / "l_bracket.obj").apply_transform(
        trimesh.transformations.euler_matrix(0.3, 0.5, 0.7)
    ).export(mesh, digits=12)
    given = (str(mesh), "--enclose", "--max-vertices", "8", "-o", str(output))
    ran = satcheck("decompose", "--format", "json", *given, env=cached)
    (body,) = ran.document["bodies"]
    assert (body["encloses"], body["missing"], ran.document["rounding"]) == (True, 0.0, 0.0)
    world = load_scene([mesh], split="none").bodies[0].world_mesh()
    triangles = np.asarray(world.vertices)[np.asarray(world.triangles)].tolist()
    hulls = [part.vertices for part in parts(output).values()]
    assert max(map(len, hulls)) <= 8
    assert uncovered_triangles(triangles, hulls) == []
    table = satcheck("decompose", *given, env=cached).out
    assert "0, proven" in table


def test_two_runs_write_the_same_bytes_in_any_order(tmp_path: Path) -> None:
    """With a cache, without one, and with the inputs the other way round."""
    meshes = ("l_bracket.obj", "ring.glb")
    written = []
    for number, (own, cache) in enumerate(
        [
            (meshes, private_cache(tmp_path)),
            (meshes, private_cache(tmp_path)),
            (meshes, {"SATCHECK_CACHE": "off"}),
            (meshes[::-1], {"SATCHECK_CACHE": "off"}),
        ]
    ):
        output = tmp_path / f"{number}.obj"
        arguments = (*own, "--units", "m", "--for", "isaac", "--enclose", "-o", str(output))
        assert satcheck("decompose", *arguments, env=cache).code == 0
        written.append(output)
    first, again, uncached, turned = written
    assert first.read_bytes() == again.read_bytes() == uncached.read_bytes()
    assert {name: mesh.vertices.tolist() for name, mesh in parts(first).items()} == {
        name: mesh.vertices.tolist() for name, mesh in parts(turned).items()
    }


def test_a_mesh_that_32_bit_numbers_cannot_hold_fails_alone(tmp_path: Path) -> None:
    huge = tmp_path / "huge.obj"
    text = (SAMPLES / "box.obj").read_text().splitlines()
    huge.write_text("\n".join(f"{line}e39" if line.startswith("v ") else line for line in text))
    ran = satcheck("decompose", "--enclose", "--format", "json", "box.obj", str(huge))
    assert ran.code == 3
    box, failed = ran.document["bodies"]
    assert box["encloses"] is True
    assert failed["failure"]["code"] == "decomposition-not-enclosed"
    assert failed["encloses"] is None


ROBOT = """<?xml version="1.0"?>
<!-- unchanged -->
<robot name="r">
  <link name="a">
    <visual><geometry><mesh filename="meshes/l.obj"/></geometry></visual>
    <collision name="c>d" group="2">
      <origin xyz="0 0 1" rpy="0 0 0.5"/><geometry><mesh filename="meshes/l.obj"/></geometry>
      <verbose value="x"/>
    </collision>
    <collision><geometry><box size="1 1 1"/></geometry></collision>
  </link>
  <link name="b/1"><collision>
    <geometry><mesh filename="meshes/l.obj" scale="-1 1 2"/></geometry></collision></link>
  <link name="c"><collision name="c>d">
    <origin xyz="0 0 1" rpy="0 0 0.5"/><geometry><mesh filename="meshes/l.obj"/></geometry>
  </collision></link>
  <link name="bare">
    <visual><geometry><mesh filename="package://r/meshes/l.obj"/></geometry></visual>
    <visual><origin xyz="0 0 9"/><geometry><sphere radius="2"/></geometry></visual>
  </link>
  <joint name="j" type="fixed"><origin xyz="9 0 0"/><parent link="a"/><child link="b/1"/></joint>
  <joint name="k" type="fixed"><origin xyz="0 9 0"/><parent link="a"/><child link="c"/></joint>
  <joint name="l" type="fixed"><origin xyz="0 0 9"/><parent link="a"/><child link="bare"/></joint>
  <transmission name="t"><odd/></transmission>
</robot>
"""


@pytest.fixture
def robot(tmp_path: Path) -> Path:
    folder = tmp_path / "r"
    (folder / "meshes").mkdir(parents=True)
    (folder / "meshes" / "l.obj").write_bytes((SAMPLES / "l_bracket.obj").read_bytes())
    (folder / "r.urdf").write_text(ROBOT)
    return folder / "r.urdf"


def test_a_robot_gets_its_parts_as_collisions(
    robot: Path, tmp_path: Path, cached: dict[str, str]
) -> None:
    output = tmp_path / "out" / "parts.urdf"
    output.parent.mkdir()
    arguments = ("decompose", str(robot), "--enclose", "-o", str(output), "--format", "json")
    ran = satcheck(*arguments, env=cached)
    assert ran.code == 0
    assert [body["id"] for body in ran.document["bodies"]] == ["a/c>d", "b/1", "c"]
    old, new = ElementTree.fromstring(ROBOT), ElementTree.parse(output).getroot()
    # Equal meshes in equal places share their files; the mirrored one has its own.
    files = {path.name for path in (output.parent / "parts").iterdir()}
    assert files == {"a_c_d-1.obj", "a_c_d-2.obj", "b_1-1.obj", "b_1-2.obj"}
    first, second, box = new.findall("link/[@name='a']/collision")
    assert first.attrib == {"name": "c>d-1", "group": "2"}
    assert (second.attrib["name"], first.find("origin")) == ("c>d-2", None)
    assert first.find("geometry/mesh").attrib == {"filename": "parts/a_c_d-1.obj"}  # type: ignore[union-attr]
    assert ElementTree.tostring(box) == ElementTree.tostring(old.findall("link/collision")[1])
    for each in ("joint", "transmission", "link/[@name='bare']"):
        assert list(map(ElementTree.tostring, new.findall(each))) == list(
            map(ElementTree.tostring, old.findall(each))
        )
    visual = new.find("link/[@name='a']/visual/geometry/mesh")
    assert visual is not None
    assert (output.parent / visual.attrib["filename"]).samefile(robot.parent / "meshes/l.obj")
    assert "<!-- unchanged -->" in output.read_text()


def test_the_parts_of_a_robot_enclose_what_it_had(robot: Path, cached: dict[str, str]) -> None:
    output = robot.parent / "parts.urdf"
    given = ("decompose", str(robot), "--enclose", "-o", str(output))
    assert satcheck(*given, env=cached).code == 0
    meshes = {body.id: body.world_mesh() for body in load_scene([robot]).bodies}
    read = load_scene([output], geometry="collision").bodies
    # Placed in the world, which rounds: in the frame of the link they enclose it exactly.
    for link, own in (("a/c>d", "a/c>d-"), ("b/1", "b/1/"), ("c", "c/")):
        around = [body.world_mesh() for body in read if body.id.startswith(own)]
        points = np.asarray(meshes[link].vertices)
        assert len(around) == 2
        above = [
            (points[:, None] - hull.triangles_center) @ hull.face_normals.T
            for hull in (trimesh.Trimesh(each.vertices, each.triangles) for each in around)
        ]
        nearest = np.min([np.einsum("pff->pf", each).max(axis=1) for each in above], axis=0)
        assert nearest.max() < 1e-12


def test_visual_geometry_replaces_the_collisions(robot: Path, cached: dict[str, str]) -> None:
    output = robot.parent / "visual.urdf"
    given = ("decompose", str(robot), "--geometry", "visual", "-o", str(output))
    assert satcheck(*given, env=cached).code == 0
    root = ElementTree.parse(output).getroot()
    shapes = {
        link.attrib["name"]: [shape[0].tag for shape in link.findall("collision/geometry")]
        for link in root.findall("link")
    }
    assert shapes == {"a": ["mesh"] * 2, "b/1": [], "c": [], "bare": ["mesh", "mesh", "sphere"]}
    assert len(root.findall("link/visual")) == 3


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("box.obj", "-o", "{}/parts.urdf"), "are those of one robot"),
        (("arm.urdf", "box.obj", "--units", "m", "-o", "{}/parts.urdf"), "are those of one robot"),
        (("box.obj", "--max-parts", "0"), "--max-parts"),
        (("box.obj", "--max-vertices", "3"), "--max-vertices"),
        (("box.obj", "--for", "quake"), "--for"),
    ],
)
def test_refusals(arguments: tuple[str, ...], words: str, tmp_path: Path) -> None:
    ran = satcheck("decompose", *(each.format(tmp_path) for each in arguments))
    assert ran.code == 2
    assert words in ran.err
    assert "Traceback" not in ran.err
    assert not list(tmp_path.iterdir())


def test_a_mesh_in_many_places_is_split_once(robot: Path, tmp_path: Path) -> None:
    scene = tmp_path / "many.toml"
    scene.write_text(
        "\n".join(
            ['schema = "satcheck.scene/1"']
            + [
                f'[[bodies]]\nid = "b{n}"\nmesh = "r/meshes/l.obj"\nposition = [{9 * n}, 0, 0]'
                for n in range(3)
            ]
        )
    )
    assert robot.exists()
    places = tmp_path / "cache"
    ran = satcheck("decompose", str(scene), "--format", "json", env=private_cache(places))
    assert ran.code == 0
    bodies = ran.document["bodies"]
    assert len({json.dumps([part["vertices"] for part in body["parts"]]) for body in bodies}) == 1
    assert len(list(places.glob("decompositions/*.parts"))) == 1
