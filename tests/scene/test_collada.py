"""COLLADA: every kind of polygons, skins and morph targets, and what a parser would misread."""

from __future__ import annotations

from collections.abc import Sequence

import pytest

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
    "move", ["<translate>1 2</translate>", "<matrix>1 2 3</matrix>", "<scale>1 x 1</scale>"]
)
def test_a_transform_that_a_parser_leaves_out_is_refused(tmp_path, move):
    nodes = f'<node id="n">{move}<instance_geometry url="#g"/></node>'
    code, message = refusal(tmp_path, "a.dae", files.collada(nodes=nodes))
    assert code == "bad-record"
    assert "finite numbers" in message


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


def floats(id_: str, numbers: Sequence[float], name: str, width: int = 1) -> str:
    kind = "float4x4" if width == 16 else "float"
    return (
        f'<source id="{id_}"><float_array id="{id_}a" count="{len(numbers)}">'
        f"{' '.join(map(str, numbers))}</float_array><technique_common><accessor "
        f'source="#{id_}a" count="{len(numbers) // width}" stride="{width}">'
        f'<param name="{name}" type="{kind}"/></accessor></technique_common></source>'
    )


def names(id_: str, values: Sequence[str], name: str, kind: str = "Name") -> str:
    return (
        f'<source id="{id_}"><{kind}_array id="{id_}a" count="{len(values)}">{" ".join(values)}'
        f'</{kind}_array><technique_common><accessor source="#{id_}a" count="{len(values)}">'
        f'<param name="{name}" type="{kind}"/></accessor></technique_common></source>'
    )


def moved(x: float, y: float, z: float) -> list[float]:
    return [1, 0, 0, x, 0, 1, 0, y, 0, 0, 1, z, 0, 0, 0, 1]


def skin(
    influences: Sequence[Sequence[tuple[int, int]]],
    *,
    weights: Sequence[float] = (1.0, 0.5),
    inverse: Sequence[float] = (*moved(0, 0, 0), *moved(0, 0, -1)),
) -> str:
    """Two joints; influences: (joint, weight) of each vertex."""
    bind = " ".join(map(str, moved(0, 0, 0)))
    counts = " ".join(str(len(given)) for given in influences)
    flat = " ".join(f"{joint} {weight}" for given in influences for joint, weight in given)
    return (
        f'<controller id="c"><skin source="#g"><bind_shape_matrix>{bind}</bind_shape_matrix>'
        + names("j", ["low", "high"], "JOINT")
        + floats("i", inverse, "TRANSFORM", 16)
        + floats("w", weights, "WEIGHT")
        + '<joints><input semantic="JOINT" source="#j"/>'
        '<input semantic="INV_BIND_MATRIX" source="#i"/></joints>'
        f'<vertex_weights count="{len(influences)}">'
        '<input semantic="JOINT" source="#j" offset="0"/>'
        '<input semantic="WEIGHT" source="#w" offset="1"/>'
        f"<vcount>{counts}</vcount><v>{flat}</v></vertex_weights></skin></controller>"
    )


BONES = (
    '<node id="bones" sid="low" type="JOINT"><translate>10 0 0</translate>'
    '<node sid="high" type="JOINT"><translate>0 0 3</translate></node></node>'
)
SKINNED = (
    '<node id="n"><translate>500 0 0</translate><instance_controller url="#c">'
    "<skeleton>#bones</skeleton></instance_controller></node>"
)
BY_HEIGHT = [[(1 if point[2] else 0, 0)] for point in files.CUBE_POINTS]


def test_a_skin_lies_where_its_joints_stand_and_not_where_its_node_does(tmp_path):
    content = files.collada(nodes=BONES + SKINNED, controllers=skin(BY_HEIGHT))
    file = loaded(tmp_path, "a.dae", content)
    # The upper joint stands 2 higher than it was bound.
    assert file.mesh.bounds == ((10, 0, 0), (11, 1, 3))
    assert file.health.volume == 3.0
    assert warnings(file) == {"rest-shape": "joints stand as the file stores them"}


def test_weights_blend_and_need_not_add_up_to_one(tmp_path):
    half = [[(0, 0), (1, 0)] for _ in files.CUBE_POINTS]
    content = files.collada(nodes=BONES + SKINNED, controllers=skin(half))
    assert loaded(tmp_path, "a.dae", content).mesh.bounds == ((10, 0, 1), (11, 1, 2))


def test_the_bind_shape_itself_can_have_a_weight(tmp_path):
    bound = [[(-1, 0)] for _ in files.CUBE_POINTS]
    content = files.collada(nodes=BONES + SKINNED, controllers=skin(bound))
    assert loaded(tmp_path, "a.dae", content).mesh.bounds == ((0, 0, 0), (1, 1, 1))


@pytest.mark.parametrize(
    ("content", "code", "said"),
    [
        (
            files.collada(nodes=SKINNED, controllers=skin(BY_HEIGHT)),
            "index-out-of-range",
            "no joint 'low'",
        ),
        (
            files.collada(nodes=BONES + SKINNED, controllers=skin(BY_HEIGHT[:-1])),
            "count-mismatch",
            "a skin of 7 vertices on a mesh of 8",
        ),
        (
            files.collada(nodes=BONES + SKINNED, controllers=skin([*BY_HEIGHT[:-1], []])),
            "bad-record",
            "no joint",
        ),
        (
            files.collada(
                nodes=BONES + SKINNED, controllers=skin(BY_HEIGHT, weights=(float("nan"),))
            ),
            "non-finite",
            "float_array",
        ),
        (
            files.collada(
                nodes=BONES.replace("0 0 3", "0 3") + SKINNED, controllers=skin(BY_HEIGHT)
            ),
            "bad-record",
            "<translate>",
        ),
        (files.collada(nodes=SKINNED), "index-out-of-range", "<controller> have the id 'c'"),
    ],
)
def test_wrong_skins(tmp_path, content, code, said):
    found, message = refusal(tmp_path, "a.dae", content)
    assert found == code
    assert said in message


def morph(method: str, weight: float) -> str:
    return (
        f'<controller id="c"><morph source="#g" method="{method}">'
        + names("t", ["g"], "IDREF", "IDREF")
        + floats("w", [weight], "MORPH_WEIGHT")
        + '<targets><input semantic="MORPH_TARGET" source="#t"/>'
        '<input semantic="MORPH_WEIGHT" source="#w"/></targets></morph></controller>'
    )


@pytest.mark.parametrize(
    ("method", "weight", "size"),
    [("NORMALIZED", 0.0, 1), ("NORMALIZED", 0.5, 1), ("RELATIVE", 0.0, 1), ("RELATIVE", 1.0, 2)],
)
def test_morph_targets_have_the_weights_of_the_file(tmp_path, method, weight, size):
    nodes = '<node id="n"><translate>5 0 0</translate><instance_controller url="#c"/></node>'
    content = files.collada(nodes=nodes, controllers=morph(method, weight))
    file = loaded(tmp_path, "a.dae", content)
    assert file.mesh.bounds == ((5, 0, 0), (5 + size, size, size))
    assert set(warnings(file)) == {"rest-shape"}


def test_mirrored_nodes_turn_the_faces_of_what_morphs_too(tmp_path):
    nodes = '<node id="n"><scale>-1 1 1</scale><instance_controller url="#c"/></node>'
    content = files.collada(nodes=nodes, controllers=morph("NORMALIZED", 0.0))
    assert set(warnings(loaded(tmp_path, "a.dae", content))) == {"rest-shape"}


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
