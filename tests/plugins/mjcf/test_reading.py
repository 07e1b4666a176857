"""Bodies of MJCF files, their poses, and what is not read."""

from __future__ import annotations

from pathlib import Path

import mujoco
import pytest
from msgspec.structs import replace

from satcheck.audit import check
from satcheck.core.shapes import Box, Capsule, Cylinder, Ellipsoid, HalfSpace, Sphere
from satcheck.plugins.mjcf.readers import read_mjcf
from satcheck.scene import MeshFile, Refused, load_scene
from satcheck.scene.document import FilePart
from satcheck.scene.files import readers
from satcheck.scene.files.readers import File
from satcheck.scene.mesh_files import MeshFiles
from tests.cli.process import satcheck
from tests.plugins.mjcf.files import (
    TETRAHEDRON,
    body,
    centres,
    codes,
    geom,
    load,
    model,
    read,
    refusal,
    relations,
    write,
)

MESH = '<asset><mesh name="t" file="t.obj"/></asset>'
MESH_GEOM = '<geom name="g" type="mesh" mesh="t"/>'
INLINE = '<asset><mesh name="own" vertex="0 0 0 1 0 0 0 1 0 0 0 1"/></asset>'
# A notch: a wall along x and one along y, 1 thick, 4 long and 1 high.
CORNERS = "0 0 0 4 0 0 4 1 0 1 1 0 1 4 0 0 4 0 0 0 1 4 0 1 4 1 1 1 1 1 1 4 1 0 4 1"
NOTCH = "".join(
    ("v " if number == 0 else " " if number < 3 else "") + word + ("\n" if number == 2 else "")
    for group in zip(*[iter(CORNERS.split())] * 3, strict=True)
    for number, word in enumerate(group)
) + (
    "f 1 4 3 2\nf 1 6 5 4\nf 7 8 9 10\nf 7 10 11 12\n"
    "f 1 2 8 7\nf 2 3 9 8\nf 3 4 10 9\nf 4 5 11 10\nf 5 6 12 11\nf 6 1 7 12\n"
)


@pytest.mark.parametrize(
    ("kind", "size", "shape"),
    [
        ("box", "1 2 3", Box((2.0, 4.0, 6.0))),
        ("sphere", "2", Sphere(2.0)),
        ("capsule", "1 2", Capsule(1.0, 4.0)),
        ("cylinder", "1 2", Cylinder(1.0, 4.0)),
        ("ellipsoid", "1 2 3", Ellipsoid((1.0, 2.0, 3.0))),
    ],
)
def test_sizes_are_half_sizes(tmp_path: Path, kind: str, size: str, shape: object) -> None:
    robot = read(tmp_path, model(body("b", geom("g", kind=kind, size=size))))
    (collision,) = robot.links["b"].collisions
    assert collision.geometry == shape


def test_names_are_those_of_mujoco(tmp_path: Path) -> None:
    two = '<geom size="1"/><geom name="right" size="1"/>'
    scene = load(tmp_path, model(geom("wall"), f"<body>{two}</body>", body("b", geom("g"))))
    assert [each.id for each in scene.bodies] == ["world", "body1/geom1", "body1/right", "b"]


def test_bodies_stand_where_frames_and_parents_put_them(tmp_path: Path) -> None:
    inner = body("b", geom("g", 'pos="0 0 1"'), pos="0 2 0")
    frame = f'<frame pos="1 0 0" euler="0 0 90">{body("a", geom("f"), inner, pos="1 0 0")}</frame>'
    assert centres(load(tmp_path, model(frame))) == {"a": (1, 1, 0), "b": (-1, 1, 1)}


def test_a_mesh_file_is_placed_as_written_and_read_once(tmp_path: Path) -> None:
    (tmp_path / "t.obj").write_text(TETRAHEDRON)
    asset = (
        '<asset><mesh name="t" file="t.obj"/><mesh name="m" file="t.obj" scale="-2 1 1"/></asset>'
    )
    mirrored = body("c", '<geom type="mesh" mesh="m"/>')
    bodies = body("a", MESH_GEOM, pos="2 0 0"), body("b", MESH_GEOM.replace("g", "h", 1))
    scene = load(tmp_path, model(bodies[0], mirrored, before=asset))
    a, c = scene.bodies
    assert centres(scene) == {"a": (2.5, 0.5, 0.5), "c": (-1, 0.5, 0.5)}
    assert a.file is c.file
    assert a.file.path == (tmp_path / "t.obj").as_posix()


def test_reference_pose_of_a_mesh_comes_before_its_scale(tmp_path: Path) -> None:
    """A vertex v is at scale * R^-1 (v - refpos), as in the documentation; here R turns x to y."""
    (tmp_path / "t.obj").write_text(TETRAHEDRON)
    given = 'refpos="1 0 0" refquat="0.7071067811865476 0 0 0.7071067811865476" scale="1 3 1"'
    asset = f'<asset><mesh name="t" file="t.obj" {given}/></asset>'
    # x from 0 to 1 goes to y from 3 to 0, y from 0 to 1 to x from 0 to 1.
    scene = load(tmp_path, model(body("a", MESH_GEOM), before=asset))
    assert centres(scene) == {"a": (0.5, 1.5, 0.5)}


def test_a_mesh_in_the_file_itself_is_a_part_of_it(tmp_path: Path) -> None:
    text = model(body("a", MESH_GEOM.replace('"t"', '"own"'), pos="1 1 1"), before=INLINE)
    scene = load(tmp_path, text)
    (only,) = scene.bodies
    assert (only.file.path, only.path) == ((tmp_path / "m.xml").as_posix(), "own")
    assert centres(scene)["a"] == pytest.approx((1.5, 1.5, 1.5), abs=1e-6)


def test_triangles_or_convex_hulls_of_meshes(tmp_path: Path) -> None:
    """A ball in a notch is apart from the walls, and inside of their convex hull."""
    (tmp_path / "t.obj").write_text(NOTCH)
    ball = body("ball", geom("s", kind="sphere", size=".2"), "<freejoint/>", pos="1.5 1.5 .5")
    path = write(tmp_path, model(body("notch", MESH_GEOM), ball, before=MESH))
    triangles = load_scene([path])
    hulls = load_scene([path], reading={"mesh_hulls": True})
    assert relations(triangles) == {("notch", "ball"): "separated"}
    assert relations(hulls) == {("notch", "ball"): "contains"}
    for scene, said in ((triangles, "triangles of meshes are"), (hulls, "hulls of meshes are")):
        (note,) = (i for i in scene.issues if i.code == "mesh-or-hull")
        assert said in note.message
    assert next(b for b in hulls.bodies if b.id == "notch").path == "#hull"


@pytest.mark.parametrize("part", ["own", "own#hull"])
def test_a_part_is_read_again_by_its_name(tmp_path: Path, part: str) -> None:
    """As `satcheck verify` does."""
    text = model(body("a", MESH_GEOM.replace('"t"', '"own"')), before=INLINE)
    options = {"mesh_hulls": part.endswith("hull")}
    (only,) = load_scene([write(tmp_path, text)], reading=options).bodies
    assert only.path == part
    again = MeshFiles().mesh(FilePart(only.file.path, only.file.path, part))
    assert isinstance(again, MeshFile)
    assert again.mesh.to_bytes() == only.file.mesh.to_bytes()


def test_a_flex_may_not_read_files_elsewhere(tmp_path: Path) -> None:
    (tmp_path / "t.obj").write_text(TETRAHEDRON)
    cloth = '<flexcomp name="f" type="mesh" file="t.obj" dim="2" radius=".1"/>'
    before = '<compiler meshdir="../.."/>'
    inside = tmp_path / "package" / "robot"
    assert refusal(inside, model(body("c", cloth), before=before))[0] == "outside-path"


def test_visual_geometry_is_what_collides_with_nothing(tmp_path: Path) -> None:
    looks = geom("v", 'contype="0" conaffinity="0"', kind="sphere")
    path = write(tmp_path, model(body("a", looks, geom("c")), body("b", geom("d"))))
    assert [each.id for each in load_scene([path]).bodies] == ["a", "b"]
    visual = load_scene([path], geometry="visual")
    assert [(each.id, each.shape) for each in visual.bodies] == [("a", Sphere(0.5))]
    assert "no-collision-geometry" in codes(visual)


def test_a_plane_is_a_half_space(tmp_path: Path) -> None:
    """The rendered size of a plane bounds no contact."""
    floor = geom("floor", 'pos="0 0 -0.5"', kind="plane", size="1 1 1")
    scene = load(tmp_path, model(floor, body("b", geom("g"), "<freejoint/>")))
    world, ball = scene.bodies
    assert isinstance(world.shape, HalfSpace)
    assert (world.static, world.pinned) == (True, True)
    assert set(relations(scene).values()) == {"touching"}
    away = replace(ball, transform=(1, 0, 0, 9, 0, 1, 0, 0, 0, 0, 1, -0.25, 0, 0, 0, 1))
    assert set(relations(replace(scene, bodies=(world, away))).values()) == {"penetrating"}


def test_a_turned_plane_faces_along_z_of_its_geom(tmp_path: Path) -> None:
    wall = geom("wall", 'pos="-0.5 0 0" zaxis="1 0 0"', kind="plane", size="0 0 1")
    scene = load(tmp_path, model(wall, body("b", geom("g"), "<freejoint/>")))
    assert set(relations(scene).values()) == {"touching"}


def test_a_height_field_is_an_unreadable_body(tmp_path: Path) -> None:
    field = '<asset><hfield name="h" nrow="2" ncol="2" size="1 1 1 1" elevation="0 1 1 0"/></asset>'
    ground = '<geom name="ground" type="hfield" hfield="h"/>'
    scene = load(tmp_path, model(ground, body("b", geom("g"), "<freejoint/>"), before=field))
    (lost,) = scene.unreadable
    assert (lost.id, lost.issue.code) == ("world", "unsupported-feature")
    assert set(relations(scene).values()) == {"indeterminate"}


def test_a_flex_is_an_unreadable_body(tmp_path: Path) -> None:
    cloth = '<flexcomp name="cloth" type="grid" count="3 3 1" spacing="1 1 1" dim="2" radius=".1"/>'
    scene = load(tmp_path, model(body("b", geom("g")), body("c", cloth, pos="0 0 5")))
    assert [(lost.id, lost.issue.code) for lost in scene.unreadable] == [
        ("flex cloth", "unsupported-feature")
    ]
    assert "line 0" not in scene.unreadable[0].issue.message


def test_a_body_without_a_line_is_part_of_the_report_of_a_folder(tmp_path: Path) -> None:
    cloth = '<flexcomp name="cloth" type="grid" count="3 3 1" spacing="1 1 1" dim="2" radius=".1"/>'
    write(tmp_path, model(body("b", geom("g")), body("c", cloth, pos="0 0 5")))
    ran = satcheck("batch", ".", "--format", "json", cwd=tmp_path)
    (asset,) = ran.document["assets"]
    assert (ran.code, asset["report"]["bodies"][1]["stated_at"]) == (2, None)


def test_points_alone_are_the_hull_that_mujoco_makes(tmp_path: Path) -> None:
    (tmp_path / "t.obj").write_text(TETRAHEDRON.partition("f")[0])
    scene = load(tmp_path, model(body("a", MESH_GEOM), before=MESH))
    (only,) = scene.bodies
    assert (only.path, only.file.mesh.triangle_count) == ("t", 4)


def test_a_shape_may_be_fitted_to_a_mesh(tmp_path: Path) -> None:
    """The half sizes of the box have the inertia of the mesh. A mesh that is missing makes the
    shape unknown."""
    (tmp_path / "t.obj").write_text(NOTCH)
    path = write(tmp_path, model(body("a", MESH_GEOM.replace('"mesh"', '"box"')), before=MESH))
    compiled = mujoco.MjModel.from_xml_path(str(path))
    (only,) = load_scene([path]).bodies
    assert only.shape == Box(tuple((2 * compiled.geom_size[0]).tolist()))
    (tmp_path / "t.obj").unlink()
    (lost,) = load_scene([path]).unreadable
    assert lost.issue.code == "missing-resource"


def test_what_places_no_geometry_may_be_broken(tmp_path: Path) -> None:
    texture = '<asset><texture name="x" type="2d" file="no.png"/>'
    material = '<material name="y" texture="x"/></asset>'
    motor = '<actuator><muscle name="a" tendon="no"/></actuator>'
    light = body("b", geom("g", 'material="y" mass="0"'), '<joint name="j"/>')
    scene = load(tmp_path, model(light, before=texture + material))
    assert [each.id for each in scene.bodies] == ["b"]
    assert refusal(tmp_path, model(light, after=motor))[0] == "bad-robot"


def test_equality_constraints_are_not_solved_and_a_warning_says_so(tmp_path: Path) -> None:
    after = '<equality><weld body1="a" body2="b"/></equality>'
    scene = load(tmp_path, model(body("a", geom("g")), body("b", geom("h")), after=after))
    assert "constraint-not-solved" in codes(scene)


def test_a_missing_mesh_loses_only_its_body(tmp_path: Path) -> None:
    scene = load(tmp_path, model(body("a", MESH_GEOM), body("b", geom("h")), before=MESH))
    (lost,) = scene.unreadable
    assert (lost.id, lost.issue.code) == ("a", "missing-resource")
    assert "t.obj" in lost.issue.message
    assert [each.id for each in scene.bodies] == ["b"]


def test_included_files_stay_in_the_package(tmp_path: Path) -> None:
    inside = tmp_path / "package" / "robot"
    write(inside, "<mujoco><default/></mujoco>", "part.xml")
    write(tmp_path, "<mujoco><default/></mujoco>", "out.xml")
    good = model('<include file="part.xml"/>', body("b", geom("g")))
    text = good.replace("<worldbody>\n<include", "<include").replace(
        '"/>\n<body', '"/><worldbody>\n<body'
    )
    assert [each.id for each in load(inside, text).bodies] == ["b"]
    away = text.replace("part.xml", "../../out.xml")
    assert refusal(inside, away)[0] == "outside-path"
    assert [each.id for each in load(inside, away, allow_outside=True).bodies] == ["b"]
    assert refusal(inside, text.replace("part.xml", "none.xml"))[0] == "missing-resource"


def test_meshes_stay_in_the_package(tmp_path: Path) -> None:
    (tmp_path / "t.obj").write_text(TETRAHEDRON)
    before = MESH.replace("t.obj", "../../t.obj")
    inside = tmp_path / "package" / "robot"
    scene = load(inside, model(body("a", MESH_GEOM), body("b", geom("h")), before=before))
    assert [(lost.id, lost.issue.code) for lost in scene.unreadable] == [("a", "outside-path")]


@pytest.mark.parametrize(
    ("text", "code", "message"),
    [
        (model(body("b", geom("g", kind="cone"))), "bad-robot", "cone"),
        (model(body("b", geom("g"), geom("g"))), "bad-robot", "repeated name 'g'"),
        (model(body("b", geom("g", 'pos="nan 0 0"'))), "non-finite", "finite"),
        (model(body("b", geom("g", 'colour="1 1 1"'))), "bad-robot", "colour"),
        (model(body("b", geom("g")))[:-20], "bad-record", "not well-formed"),
    ],
)
def test_a_wrong_file_is_refused(tmp_path: Path, text: str, code: str, message: str) -> None:
    found = refusal(tmp_path, text)
    assert found[0] == code
    assert message in found[1]


def test_an_included_file_may_not_declare_entities(tmp_path: Path) -> None:
    write(tmp_path, '<!DOCTYPE m [<!ENTITY e "x">]>\n<mujoco/>', "part.xml")
    text = f'<mujoco><include file="part.xml"/>{model(body("b", geom("g"))).partition(">")[2]}'
    path = write(tmp_path, text)
    with pytest.raises(Refused) as caught:
        load_scene([path])
    assert caught.value.code == "entity-declaration"


def test_a_file_of_another_ending_is_refused(tmp_path: Path) -> None:
    path = write(tmp_path, model(body("b", geom("g"))), "m.txt")
    with pytest.raises(Refused) as caught:
        load_scene([path])
    assert caught.value.code == "unsupported-format"


def test_without_mujoco_the_error_says_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    def missing(name: str) -> None:
        raise ModuleNotFoundError(f"No module named {name!r}", name=name)

    monkeypatch.setattr(readers, "import_module", missing)
    with pytest.raises(Refused, match=r"pip install 'satcheck\[mjcf\]'") as caught:
        read_mjcf(File("mjcf", "", "m.xml", b"", path="m.xml"))
    assert caught.value.code == "missing-extra"


def copied(count: int, inside: str) -> str:
    return f'<replicate count="{count}">{inside}</replicate>'


@pytest.mark.parametrize("times", [10, 100])
def test_copies_are_counted_before_mujoco_makes_them(tmp_path: Path, times: int) -> None:
    inner = f"<mujoco><worldbody>{copied(times, body('b', geom('g')))}</worldbody></mujoco>"
    write(tmp_path, inner, "inner.xml")
    part = '<asset><model name="part" file="inner.xml"/></asset>'
    attached = copied(times, '<frame><attach model="part" prefix="p"/></frame>')
    nested = copied(times, copied(times, body("b", geom("g"))))
    for text in (f"<mujoco>{part}<worldbody>{attached}</worldbody></mujoco>", model(nested)):
        if times == 10:
            assert len(load(tmp_path, text).bodies) == 100
        else:
            code, message = refusal(tmp_path, text)
            assert (code, "copies make more than 10000 elements" in message) == ("too-large", True)


def test_many_geoms_of_a_body_share_one_rule(tmp_path: Path) -> None:
    """Beside the rule for the two bodies, which do not move."""
    for count, rules in ((100, 100 * 99 // 2), (101, 1)):
        text = model(body("a", *["<geom size='1'/>"] * count), body("b", geom("g")))
        scene = load(tmp_path, text)
        assert len(scene.rules) == rules + 1
        pairs = check(scene).summary.pairs
        assert pairs.allowed == pairs.total == count * (count + 1) // 2
