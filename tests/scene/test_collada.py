"""COLLADA: every kind of polygons, and what a parser would misread."""

from __future__ import annotations

import pytest

from satcheck.scene import load_scene
from satcheck.scene.units import unit_of
from tests.scene import files
from tests.scene.loading import loaded, refusal, warnings

_STRIP_POINTS = [(0, 0, 0), (0, 1, 0), (1, 0, 0), (1, 1, 0), (2, 0, 0), (2, 1, 0)]
_INPUT = '<input semantic="VERTEX" source="#v" offset="0"/>'


def primitives(kind: str, *rows: str) -> str:
    indices = "".join(f"<p>{row}</p>" for row in rows)
    return f'<{kind} count="{len(rows)}">{_INPUT}{indices}</{kind}>'


def test_strips_keep_the_side_that_they_show(tmp_path):
    content = files.collada(points=_STRIP_POINTS, primitives=primitives("tristrips", "0 1 2 3 4 5"))
    mesh = loaded(tmp_path, "strip.dae", content).mesh
    assert mesh.triangle_count == 4
    for k in range(4):
        (ax, ay, _), (bx, by, _), (cx, cy, _) = mesh.corners(k)
        assert (bx - ax) * (cy - ay) - (by - ay) * (cx - ax) == -1  # all face -z


def test_a_cube_of_strips_and_fans_is_the_cube(tmp_path):
    strips = primitives("tristrips", "4 0 5 1 7 3 6 2 4 0")  # the sides
    fans = primitives("trifans", "0 2 3 1", "4 5 7 6")  # bottom and top
    corners = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 1, 0)]
    points = [*corners, *((x, y, 1) for x, y, _ in corners)]
    file = loaded(tmp_path, "a.dae", files.collada(points=points, primitives=strips + fans))
    assert file.mesh.triangle_count == 12
    assert file.health.closed
    assert file.health.oriented
    assert file.health.volume == 1.0


def test_several_kinds_of_polygons_in_one_mesh(tmp_path):
    rows = [" ".join(map(str, face)) for face in files.CUBE_QUADS]
    flat = " ".join(rows[1:3])
    mixed = (
        primitives("polygons", *rows[:1])
        + f'<polylist count="2">{_INPUT}<vcount>4 4</vcount><p>{flat}</p></polylist>'
        + primitives("trifans", *rows[3:])
        + f'<lines count="1">{_INPUT}<p>0 1</p></lines>'
    )
    file = loaded(tmp_path, "a.dae", files.collada(primitives=mixed))
    assert set(warnings(file)) == {"ignored-geometry"}
    assert file.health.volume == 1.0


@pytest.mark.parametrize(
    ("polygons", "code"),
    [
        (primitives("tristrips", "0 1"), "bad-record"),
        (primitives("tristrips", "0 1 2").replace('"1"', '"2"'), "count-mismatch"),
        (primitives("polygons", "0 1 2").replace("<p>", "<ph><p>"), None),
    ],
)
def test_wrong_polygons(tmp_path, polygons, code):
    if code is None:
        polygons = polygons.replace("</p>", "</p><h>0 1 2</h></ph>")
    found, _ = refusal(tmp_path, "a.dae", files.collada(primitives=polygons))
    assert found == (code or "unsupported-feature")


@pytest.mark.parametrize(
    ("was", "now"),
    [
        ('stride="3"', 'stride="4"'),
        ('stride="3"', 'stride="3" offset="1"'),
        ('stride="3"', ""),
        ('<param name="X" type="float"/><param name="Y"', '<param name="Y"/><param name="X"'),
        ('<param name="Z" type="float"/>', ""),
    ],
)
def test_positions_that_a_parser_misreads_are_refused(tmp_path, was, now):
    content = files.collada().decode()
    assert was in content
    code, message = refusal(tmp_path, "a.dae", content.replace(was, now).encode())
    assert code == "unsupported-feature"
    assert "X, Y, Z" in message


@pytest.mark.parametrize(
    ("move", "words"),
    [
        ("<translate>1 2</translate>", "should be 3 numbers"),
        ("<matrix>1 2 3</matrix>", "should be 16 numbers"),
        ("<scale>1 x 1</scale>", '"x" is not a finite number'),
    ],
)
def test_a_transform_that_a_parser_leaves_out_is_refused(tmp_path, move, words):
    nodes = f'<node id="n">{move}<instance_geometry url="#g"/></node>'
    code, message = refusal(tmp_path, "a.dae", files.collada(nodes=nodes))
    assert code == "bad-record"
    assert words in message


def test_a_material_that_is_not_there_costs_no_mesh(tmp_path):
    bound = (
        '<bind_material><technique_common><instance_material symbol="m" target="#gone"/>'
        "</technique_common></bind_material>"
    )
    nodes = f'<node id="n"><instance_geometry url="#g">{bound}</instance_geometry></node>'
    assert loaded(tmp_path, "a.dae", files.collada(nodes=nodes)).health.volume == 1.0
    nodes += f'<node id="o"><translate>5 0 0</translate>{nodes[13:]}'
    nodes = nodes.replace(bound, "<bind_material/>", 1)
    assert loaded(tmp_path, "a.dae", files.collada(nodes=nodes)).health.volume == 2.0


@pytest.mark.parametrize("beside", ["", '<node id="n"><instance_geometry url="#g"/></node>'])
def test_a_skin_or_a_morph_is_no_body(tmp_path, beside):
    nodes = beside + '<node id="s"><instance_controller url="#c"/></node>'
    found, message = refusal(tmp_path, "a.dae", files.collada(nodes=nodes))
    assert found == "unsupported-feature"
    assert "<instance_controller>: skins and morph targets are not read" in message


@pytest.mark.parametrize(
    ("was", "now", "code"),
    [
        ("mesh>", "convex_mesh>", "unsupported-feature"),
        ("<vertices", '<splines count="1"/><vertices', "unsupported-feature"),
        (
            '<node id="n">',
            '<node id="n"><matrix>1 0 0 0 0 1 0 0 0 0 1 0 0 0 1 1</matrix>',
            "bad-record",
        ),
        ('<node id="n">', '<node id="n"><rotate>0 0 0 9</rotate>', "bad-record"),
        ("<geometry ", '<geometry id="g"/><geometry ', "duplicate-id"),
        ('<node id="n">', '<noode/><node id="n">', "unsupported-feature"),
        ('<node id="n">', '<node id="n"><translte>1 0 0</translte>', "unsupported-feature"),
        ('meter="1"', 'meter="-1"', "bad-record"),
    ],
)
def test_what_is_not_certain_is_refused(tmp_path, was, now, code):
    nodes = '<node id="n"><instance_geometry url="#g"/></node>'
    content = files.collada(nodes=nodes).decode()
    assert was in content
    found, _ = refusal(tmp_path, "a.dae", content.replace(was, now).encode())
    assert found == code


def test_what_places_no_triangles_need_not_be_read(tmp_path):
    camera = '<node id="c"><lookat>5 0 0 5 0 -1 0 1 0</lookat></node>'
    extra = '<extra><technique profile="x"><geometry id="g"/></technique></extra>'
    nodes = camera + '<node id="n"><instance_geometry url="#g"/></node>' + extra
    assert loaded(tmp_path, "a.dae", files.collada(nodes=nodes)).health.volume == 1.0


@pytest.mark.parametrize(
    ("metre", "units", "size"), [("10", "m", 10.0), ("0.125", "m", 0.125), ("0.01", "cm", 1.0)]
)
def test_a_unit_without_a_name_becomes_metres(tmp_path, metre, units, size):
    nodes = '<node id="n"><translate>1 0 0</translate><instance_geometry url="#g"/></node>'
    content = files.collada(nodes=nodes).replace(b'meter="1"', f'meter="{metre}"'.encode())
    (tmp_path / "a.dae").write_bytes(content)
    scene = load_scene([tmp_path / "a.dae"])
    (body,) = scene.bodies
    assert unit_of(scene.units) == units
    assert body.world_mesh().bounds == ((size, 0.0, 0.0), (2 * size, size, size))


def test_a_scene_does_not_override_a_unit_without_a_name(tmp_path):
    (tmp_path / "a.dae").write_bytes(files.collada().replace(b'meter="1"', b'meter="10"'))
    body = '[[bodies]]\nid = "a"\nmesh = "a.dae"\n'
    for more, lost in (("", 0), ('units = "cm"\n', 1)):
        (tmp_path / "s.toml").write_text('schema = "satcheck.scene/1"\n' + body + more)
        assert len(load_scene([tmp_path / "s.toml"]).unreadable) == lost


def test_physics_blocks_a_pass(tmp_path):
    physics = b'<instance_physics_scene url="#P"/></scene>'
    content = files.collada().replace(b"</scene>", physics)
    assert set(warnings(loaded(tmp_path, "a.dae", content))) == {"unread"}


def test_an_animation_is_a_note(tmp_path):
    content = files.collada().replace(b"<scene>", b"<library_animations/><scene>")
    (issue,) = loaded(tmp_path, "a.dae", content).issues
    assert (issue.code, issue.severity) == ("time-sampled", "note")


@pytest.mark.parametrize(
    ("old", "new", "code"),
    [
        (b'meter="1"/>', b'meters="1"/>', "misspelt"),
        (b"<scene>", b"<scene><instance_phsyics_scene/>", "unread"),
        (b"<scene>", b"<scene><instance_kinematics_scene/>", "unread"),
        (b"</COLLADA>", b"<scene/></COLLADA>", "unread"),
        (b"<mesh>", b'<asset><unit meter="0.1"/></asset><mesh>', "unread"),
        (b"</geometry>", b"<mesh/></geometry>", "unread"),
        (b"</geometry>", b"<brep/></geometry>", "unread"),
        (b'<node id="n">', b'<node id="n" matrix="2">', "unread"),
        (b"</polylist>", b"<pp>0</pp></polylist>", "unread"),
        (b'<accessor source="#a"', b'<accessor source="#b"', "bad-record"),
    ],
)
def test_what_nobody_reads_blocks_a_pass_or_is_refused(tmp_path, old, new, code):
    content = files.collada()
    assert old in content
    (tmp_path / "a.dae").write_bytes(content.replace(old, new, 1))
    assert code in [issue.code for issue in load_scene([tmp_path / "a.dae"]).issues]


def test_a_name_that_many_elements_have_is_one_issue(tmp_path):
    node = '<node id="n{}" matrix="2"><instance_geometry url="#g"/></node>'
    nodes = "".join(map(node.format, range(100)))
    found = warnings(loaded(tmp_path, "a.dae", files.collada(nodes=nodes)))
    assert "(100 times)" in found["unread"]


Y_UP = files.collada().replace(b"Z_UP", b"Y_UP")


@pytest.mark.parametrize(("axis", "codes"), [("Y_UP", ["up-axis"]), ("Z_UP", [])])
def test_an_axis_turns_nothing_and_is_named(tmp_path, axis, codes):
    (tmp_path / "a.dae").write_bytes(files.collada().replace(b"Z_UP", axis.encode()))
    assert [issue.code for issue in load_scene([tmp_path / "a.dae"]).issues] == codes


@pytest.mark.parametrize(
    ("other", "content", "unclear"),
    [("b.obj", files.obj(), 1), ("b.dae", Y_UP, 0), ("b.glb", files.glb(), 0)],
)
def test_beside_a_file_that_names_no_axis_it_blocks_a_pass(tmp_path, other, content, unclear):
    (tmp_path / "a.dae").write_bytes(Y_UP)
    (tmp_path / other).write_bytes(content)
    scene = load_scene([tmp_path / "a.dae", tmp_path / other])
    assert [issue.code for issue in scene.issues].count("axes-unclear") == unclear
