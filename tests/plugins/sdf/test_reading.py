"""Bodies of SDFormat files, and the pairs that the format does not check."""

from __future__ import annotations

import math
from itertools import combinations
from pathlib import Path

import numpy as np
import pytest

from satcheck.audit import Settings
from satcheck.audit.check import check
from satcheck.core.shapes import Box, Capsule, Cone, Cylinder, Ellipsoid, HalfSpace, Sphere
from satcheck.scene import Scene, load_scene
from satcheck.scene.bodies import IDENTITY
from satcheck.scene.robot.model import MeshReference, Refusal
from tests.plugins.sdf.files import (
    BOX,
    axis,
    codes,
    joint,
    link,
    model,
    read,
    refusal,
    sdf,
    world,
    write,
)


def shape(inside: str, name: str = "c", more: str = "") -> str:
    return f'<collision name="{name}"><geometry>{inside}</geometry>{more}</collision>'


def masked(bits: str) -> str:
    contact = f"<contact><collide_bitmask>{bits}</collide_bitmask></contact>"
    return shape("<box><size>1 1 1</size></box>", more=f"<surface>{contact}</surface>")


def geometry(folder: Path, inside: str) -> object:
    robot, _ = read(folder, sdf(model("m", link("a", inside=shape(inside)))))
    (collision,) = robot.links["m::a"].collisions
    return collision.geometry


def load(folder: Path, text: str) -> Scene:
    return load_scene([write(folder, text)])


def allowed(scene: Scene) -> dict[tuple[str, str], str]:
    """The pairs that rules exempt, with the reason of the last rule."""
    found = {}
    for pair in combinations(scene.bodies, 2):
        for rule in scene.rules:
            a, b = ({body.id for body in s.select(scene.bodies)} for s in (rule.a, rule.b))
            x, y = pair[0].id, pair[1].id
            if (x in a and y in b) or (y in a and x in b):
                found[x, y] = rule.reason
    return found


def test_the_shapes(tmp_path: Path) -> None:
    size = "<radius>1</radius><length>3</length>"
    assert geometry(tmp_path, "<box><size>1 2 3</size></box>") == Box((1.0, 2.0, 3.0))
    assert geometry(tmp_path, "<sphere><radius>2</radius></sphere>") == Sphere(2.0)
    assert geometry(tmp_path, f"<cylinder>{size}</cylinder>") == Cylinder(1.0, 3.0)
    assert geometry(tmp_path, f"<capsule>{size}</capsule>") == Capsule(1.0, 3.0)
    assert geometry(tmp_path, f"<cone>{size}</cone>") == Cone(1.0, 3.0)
    assert geometry(tmp_path, "<ellipsoid><radii>1 2 3</radii></ellipsoid>") == Ellipsoid(
        (1.0, 2.0, 3.0)
    )


@pytest.mark.parametrize("normal", [(0, 0, 1), (0, 0, -1), (1, 0, 0), (0, -1, 0), (1, 2, -2)])
def test_a_plane_is_a_half_space_below_its_normal(
    tmp_path: Path, normal: tuple[int, int, int]
) -> None:
    text = f"<plane><normal>{' '.join(map(str, normal))}</normal><size>1 1</size></plane>"
    (body,) = load(tmp_path, world(model("m", link("a", inside=shape(text))))).bodies
    assert isinstance(body.shape, HalfSpace)
    assert body.static
    transform = body.transform or IDENTITY
    length = math.hypot(*normal)
    assert transform[2:12:4] == pytest.approx([c / length for c in normal], abs=1e-15)
    x, y, z = (np.array(transform[k:12:4]) for k in range(3))
    assert np.cross(x, y) == pytest.approx(z, abs=1e-15)
    if sorted(map(abs, normal)) == [0, 0, 1]:
        assert set(transform) <= {-1.0, 0.0, 1.0}


def test_a_plane_without_a_normal_faces_up(tmp_path: Path) -> None:
    (body,) = load(tmp_path, world(model("m", link("a", inside=shape("<plane/>"))))).bodies
    assert (body.transform or IDENTITY) == IDENTITY


@pytest.mark.parametrize(
    ("inside", "code"),
    [
        ("<box><size>1 1</size></box>", "bad-robot"),
        ("<box/>", "bad-robot"),
        ("a box of 2 2 2", "bad-robot"),
        ("<box><size>1 1 0</size></box>", "bad-robot"),
        ("<box><size>1 1 1</size><size>2 2 2</size></box>", "bad-robot"),
        ("<sphere><radius>-1</radius></sphere>", "bad-robot"),
        ("<box><size>1 1 1</size></box><sphere><radius>1</radius></sphere>", "bad-robot"),
        ("<mesh/>", "bad-robot"),
        ("<mesh><uri>m.stl</uri><scale>1 0 1</scale></mesh>", "singular-transform"),
        ("<mesh><uri>m.stl</uri><submesh><name>x</name></submesh></mesh>", "unsupported-feature"),
        ("<heightmap><uri>h.png</uri></heightmap>", "unsupported-feature"),
        ("<polyline><height>1</height></polyline>", "unsupported-feature"),
        ("<image><uri>i.png</uri></image>", "unsupported-feature"),
        ("<ball><radius>1</radius></ball>", "unsupported-feature"),
        ("<plane><normal>0 0 0</normal></plane>", "bad-robot"),
    ],
)
def test_geometry_that_is_not_read_refuses_its_body(tmp_path: Path, inside: str, code: str) -> None:
    found = geometry(tmp_path, inside)
    assert isinstance(found, Refusal)
    assert found.code == code


def test_what_has_no_body(tmp_path: Path) -> None:
    none = link("b", inside=shape("<empty/>"))
    bare = link("c", inside=shape(""))
    seen = link("d", inside="<visual name='v'><geometry/></visual>")
    text = world(model("m", none, bare, seen), '<actor name="x"/>')
    scene = load(tmp_path, text)
    assert scene.order == ()
    assert codes(tmp_path, text) == [
        "no-collision-geometry",
        "no-shape",
        "no-collision-geometry",
    ]


def test_ids(tmp_path: Path) -> None:
    two = shape("<sphere><radius>1</radius></sphere>", "x") + shape(
        "<sphere><radius>1</radius></sphere>", "y"
    )
    scene = load(tmp_path, sdf(model("m", link("a"), model("n", link("b", inside=two)))))
    assert scene.order == ("m::a", "m::n::b/x", "m::n::b/y")
    assert (scene.name, scene.units) == ("m", "m")


def test_a_collision_may_be_relative_to_another_frame(tmp_path: Path) -> None:
    posed = '<pose relative_to="__model__">0 0 0 0 0 0</pose>'
    text = link("a", "5 0 0 0 0 0", shape("<box><size>1 1 1</size></box>", more=posed))
    (body,) = load(tmp_path, sdf(model("m", text))).bodies
    assert body.transform is not None
    assert body.transform[3::4] == (0.0, 0.0, 0.0, 1.0)
    wrong = posed.replace("__model__", "x")
    text = link("a", inside=shape("<box><size>1 1 1</size></box>", more=wrong))
    (lost,) = load(tmp_path, sdf(model("m", text))).unreadable
    assert lost.issue.code == "index-out-of-range"


def test_visual_geometry_instead(tmp_path: Path) -> None:
    seen = "<visual name='v'><geometry><sphere><radius>2</radius></sphere></geometry></visual>"
    path = write(tmp_path, sdf(model("m", link("a", inside=BOX + seen), link("b"))))
    scene = load_scene([path], geometry="visual")
    assert [(body.id, body.shape) for body in scene.bodies] == [("m::a", Sphere(2.0))]
    assert [issue.code for issue in scene.issues] == ["visual-geometry", "no-collision-geometry"]


def test_a_visual_in_a_collision_blocks_a_pass_of_what_is_drawn(tmp_path: Path) -> None:
    drawn = BOX.replace("collision", "visual")
    odd = BOX.replace("<geometry>", f"{drawn}<geometry>")
    path = write(tmp_path, sdf(model("m", link("a", inside=drawn + odd))))
    (found,) = (i for i in load_scene([path], geometry="visual").issues if i.code == "unread")
    assert "<collision>: the visual in it is not read" in found.message


def test_links_of_one_model_and_static_models(tmp_path: Path) -> None:
    scene = load(
        tmp_path,
        world(
            model("m", link("a"), link("b"), link("c"), joint("j", "a", "b")),
            model("s", "<static>true</static>", link("l")),
            model("t", "<static>1</static>", link("l"), model("u", link("l"))),
        ),
    )
    of_m = "SDF: links of model m without self_collide"
    of_t = "SDF: links of model t without self_collide"
    assert allowed(scene) == {
        ("m::a", "m::b"): "SDF: joint m::j",
        ("m::a", "m::c"): of_m,
        ("m::b", "m::c"): of_m,
        ("s::l", "t::l"): "SDF: both static",
        ("s::l", "t::u::l"): "SDF: both static",
        ("t::l", "t::u::l"): of_t,
    }
    assert {body.id for body in scene.bodies if body.static} == {"s::l", "t::l", "t::u::l"}
    assert {rule.where for rule in scene.rules} == {str(tmp_path / "w.sdf")}


def test_self_collide(tmp_path: Path) -> None:
    own = "<self_collide>true</self_collide>"
    text = model("m", link("a", inside=BOX + own), link("b"), link("c"), joint("j", "a", "b"))
    assert allowed(load(tmp_path, sdf(text))) == {
        ("m::a", "m::b"): "SDF: joint m::j",
        ("m::b", "m::c"): "SDF: links of model m without self_collide",
    }
    text = model("m", own, link("a"), link("b"), link("c"), joint("j", "a", "b"))
    assert allowed(load(tmp_path, sdf(text))) == {("m::a", "m::b"): "SDF: joint m::j"}


def test_bit_masks(tmp_path: Path) -> None:
    names = {"a": "0x01", "b": "2", "c": "0x03", "d": "0"}
    models = [model(name, link("l", inside=masked(bits))) for name, bits in names.items()]
    found = allowed(load(tmp_path, world(*models, model("e", link("l")))))
    assert set(found) == {
        ("a::l", "b::l"),
        ("a::l", "d::l"),
        ("b::l", "d::l"),
        ("c::l", "d::l"),
        ("d::l", "e::l"),
    }
    assert found["a::l", "b::l"] == (
        "SDF: collide_bitmask 0x0001 and collide_bitmask 0x0002 share no bit"
    )


@pytest.mark.parametrize("bits", ["0b01", "1_0", "0o10", "0x", "9" * 5000])
def test_a_mask_that_is_no_number_of_the_format_is_not_guessed(tmp_path: Path, bits: str) -> None:
    (lost,) = load(tmp_path, sdf(model("m", link("a", inside=masked(bits))))).unreadable
    assert "should be a whole number" in lost.issue.message


def test_two_files_keep_their_rules_apart(tmp_path: Path) -> None:
    (tmp_path / "x.sdf").write_text(sdf(model("m", link("a"), link("b"))))
    scene = load_scene([tmp_path / "x.sdf", write(tmp_path, sdf(model("m", link("a"))))])
    assert set(allowed(scene)) == {("m::a", "m::b")}
    assert check(scene, Settings(depth=False)).summary.verdict == "fail"


def test_every_rule_has_an_effect(tmp_path: Path) -> None:
    ground = model("g", "<static>true</static>", link("l"))
    scene = load(tmp_path, world(ground, model("m", link("a", "5 0 0 0 0 0"))))
    assert scene.rules == ()
    assert check(scene, Settings(depth=False)).issues == ()


def test_a_joint_through_a_link_without_geometry_needs_no_note(tmp_path: Path) -> None:
    text = model("m", link("a"), link("b"), joint("j", "a", "b", "revolute", axis()))
    assert codes(tmp_path, sdf(text)) == []


@pytest.mark.parametrize(
    ("text", "code", "words"),
    [
        ("<gazebo version='1.0'/>", "unsupported-feature", "gz sdf"),
        ("<html/>", "not-this-format", " or <sdf>"),
        ('<sdf version="1.0"/>', "unsupported-feature", "gz sdf"),
        ("<sdf/>", "bad-robot", "version"),
        (f'<sdf version="{"1" * 5000}"/>', "bad-robot", "is no version"),
        (sdf(link("a")), "bad-robot", "in a model"),
        (sdf('<world name="a"/>', '<world name="b"/>'), "bad-robot", "a second <world>"),
        (sdf("<model/>"), "bad-robot", "name"),
        (sdf("<model name='a'>"), "bad-record", "not well-formed"),
        (sdf("<% 3.times do %>"), "xacro", "ERB"),
        (
            '<sdf version="1.9" xmlns:xacro="http://ros.org/wiki/xacro"><xacro:m/></sdf>',
            "xacro",
            "expand",
        ),
    ],
)
def test_a_file_that_is_refused(tmp_path: Path, text: str, code: str, words: str) -> None:
    path = write(tmp_path, text)
    with pytest.raises(Exception, match=r"w\.sdf: ") as caught:
        load_scene([path])
    assert caught.value.code == code  # type: ignore[attr-defined]
    assert words in str(caught.value)


MISSPELT = [
    ("<link name='a'><colision/></link>", "<link>: unknown colision (did you mean collision?)"),
    ("<lnk name='a'/>", "<model>: unknown lnk (did you mean link?)"),
    ("<self_colide>true</self_colide>", "<model>: unknown self_colide"),
    ("<selfCollide>true</selfCollide>", "<model>: unknown selfCollide"),
    ("<link name='a'/><pose relativ_to='a'/>", "attribute of <pose>: unknown relativ_to"),
    ("<incude><uri>m</uri></incude>", "<model>: unknown incude (did you mean include?)"),
]


@pytest.mark.parametrize(("inside", "said"), MISSPELT)
def test_a_misspelt_name_is_refused(tmp_path: Path, inside: str, said: str) -> None:
    code, message = refusal(tmp_path, sdf(model("m", inside)))
    assert code == "misspelt"
    assert said in message


def test_a_misspelt_name_in_a_collision_refuses_its_body(tmp_path: Path) -> None:
    for inside in ("<pse>1 0 0 0 0 0</pse>", "<surface><contat/></surface>"):
        part = BOX.replace("<geometry>", f"{inside}<geometry>")
        robot, _ = read(tmp_path, sdf(model("m", link("a", inside=part))))
        (collision,) = robot.links["m::a"].collisions
        assert isinstance(collision.geometry, Refusal)
        assert collision.geometry.code == "misspelt"


SIZE = "<size>1 1 1</size>"
START = "<initial_position>1</initial_position>"
UNREAD = [
    ("<mine:x/>", "<model>: mine:x is not read"),
    ("<scale>2 2 2</scale>", "<model>: scale is not read"),
    ("<drake:joint name='j'/>", "<model>: drake:joint is not read"),
    ("<link name='b'><fence/></link>", "<link>: fence is not read"),
    ("<link name='b'><origin>1 0 0</origin></link>", "<link>: origin is not read"),
    ("<link name='b' pose='1'/>", "attribute of <link>: pose is not read"),
    (link("b", inside=BOX.replace("<size>", "<size unit='mm'>")), "attribute of <size>: unit is"),
    (link("b", inside=BOX.replace(SIZE, SIZE + "<scale>2</scale>")), "<box>: scale is not read"),
    (link("b", inside=BOX.replace("<geom", "<offset>1</offset><geom")), "offset is not read"),
    ("<link name='b'/><pose mirror='x'/>", "attribute of <pose>: mirror is not read"),
    (
        f"<plugin name='p'><model><link>{BOX}</link></model></plugin>",
        "<link>: the collision in it is not read",
    ),
    ("<frame name='f'><offset/></frame>", "<frame>: offset is not read"),
    (
        link("b") + joint("j", "a", "b", "revolute", axis(inside=START)),
        "<axis>: initial_position is not read",
    ),
    (link("b") + joint("j", "a", "b", inside="<drake:mimic/>"), "<joint>: drake:mimic is not read"),
    ("<frame name='f'>1 0 0 0 0 0</frame>", "<frame>: the text '1 0 0 0 0 0' is not read"),
    (
        link("b") + joint("j", "a", "b", "revolute", "<axis>1 0 0</axis>"),
        "<axis>: the text '1 0 0'",
    ),
]


@pytest.mark.parametrize(("inside", "said"), UNREAD)
def test_what_may_hold_or_move_a_body_blocks_a_pass(tmp_path: Path, inside: str, said: str) -> None:
    _, issues = read(tmp_path, sdf(model("m", link("a"), inside)))
    assert [issue.code for issue in issues] == ["unread"]
    assert said in issues[0].message


def test_a_stored_insertion_blocks_a_pass(tmp_path: Path) -> None:
    stored = "<state world_name='w'><insertions>{}</insertions></state>"
    cube = model("m", link("a"))
    assert codes(tmp_path, world(cube, stored.format(""))) == []
    assert codes(tmp_path, world(cube, stored.format(model("n", link("a"))))) == ["unread"]


HARMLESS = [
    "<plugin name='p'><pose>1 0 0 0 0 0</pose></plugin>",
    "<static>true</static><allow_auto_disable>1</allow_auto_disable><enable_wind>0</enable_wind>",
    "<scale>1 1 1</scale><selfCollide>false</selfCollide><gripper name='g'/>",
    "<link name='b'><inertial><pose>1</pose></inertial><sensor/><light/><static>1</static></link>",
    link("b", inside=BOX.replace("<geom", "<max_contacts>1</max_contacts><laser_retro/><geom")),
    link("b", inside=BOX.replace("<geom", "<surface><friction><ode/></friction></surface><geom")),
    "<drake:collision_filter_group name='g'/>",
]


@pytest.mark.parametrize("inside", HARMLESS)
def test_what_places_nothing_is_no_issue(tmp_path: Path, inside: str) -> None:
    assert read(tmp_path, sdf(model("m", link("a"), inside)))[1] == ()


def test_what_is_placed_by_chance_or_a_script(tmp_path: Path) -> None:
    walker = f'<actor name="walker"><link name="l">{BOX}</link></actor>'
    text = world(walker, '<population name="cans"/>', "<state><model name='m'/></state>")
    scene = load(tmp_path, text)
    assert [body.id for body in scene.unreadable] == ["walker", "cans"]
    assert "stored-state" in [issue.code for issue in scene.issues]


def test_a_mesh_that_a_simulator_replaces(tmp_path: Path) -> None:
    """By its hull, which is checked, or by parts that nobody knows."""
    mesh = '<mesh optimization="{}"><uri>m.stl</uri></mesh>'
    for how, hull, blocking in (
        ("", False, []),
        ("convex_hull", True, []),
        ("convex_decomposition", False, ["unread"]),
    ):
        inside = shape(mesh.format(how))
        robot, issues = read(tmp_path, sdf(model("m", link("a", inside=inside))))
        geometry = robot.links["m::a"].collisions[0].geometry
        assert isinstance(geometry, MeshReference)
        assert geometry.hull == hull
        assert [issue.code for issue in issues] == blocking


def test_too_many_frames(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("satcheck.plugins.sdf.frames.MOST_FRAMES", 2)
    assert refusal(tmp_path, sdf(model("m", link("a"), link("b"))))[0] == "too-large"


def test_comments_that_xml_does_not_allow(tmp_path: Path) -> None:
    text = "<!-- ours -->\n<?xml version='1.0'?>\n" + sdf(model("m", "<!-- 1 -- 2 -->", link("a")))
    assert list(read(tmp_path, text)[0].links) == ["m::a"]
    broken = text.replace("</model>", "")
    assert "line 8: not well-formed" in refusal_of(tmp_path, broken)


def refusal_of(folder: Path, text: str) -> str:
    with pytest.raises(Exception, match=r"w\.sdf: ") as caught:
        load_scene([write(folder, text)])
    return str(caught.value)


def test_the_outermost_element_of_early_versions(tmp_path: Path) -> None:
    text = f'<gazebo version="1.2">{model("m", link("a"))}</gazebo>'
    assert list(read(tmp_path, text)[0].links) == ["m::a"]


def test_a_placeholder_beside_a_uri(tmp_path: Path) -> None:
    mesh = "<mesh><uri>m.stl</uri><uri>__default__</uri></mesh>"
    assert geometry(tmp_path, mesh) == MeshReference("m.stl", (1.0, 1.0, 1.0))
    found = geometry(tmp_path, "<mesh><uri>m.stl</uri><uri>n.stl</uri></mesh>")
    assert isinstance(found, Refusal)


def test_nothing_excuses_a_body_that_is_not_read(tmp_path: Path) -> None:
    """Its model may have self_collide, other links than the joined one, and any mask."""
    far = model("far", link("l", inside=masked("0x10000")))
    gone = "<include><uri>model://gone</uri></include>"
    text = model("m", link("a"), gone, joint("j", "a", "gone::l"))
    report = check(load(tmp_path, world(text, far)), Settings(depth=False))
    relations = {(f.a, f.b): f.relation for f in report.findings}
    assert relations[("m::a", "m::gone")] == "indeterminate"
    assert relations[("m::gone", "far::l")] == "indeterminate"


def test_a_mask_that_is_not_read_excuses_nothing_but_0(tmp_path: Path) -> None:
    models = [
        model(name, link("l", inside=masked(b)))
        for name, b in (("a", "nonsense"), ("b", "0x10000"), ("c", "0"))
    ]
    report = check(load(tmp_path, world(*models)), Settings(depth=False))
    assert [(f.a, f.b, f.relation) for f in report.findings] == [("a::l", "b::l", "indeterminate")]
