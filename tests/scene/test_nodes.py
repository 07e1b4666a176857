"""A file taken apart: which bodies it gives, where they are, and what becomes of a broken one."""

from __future__ import annotations

import numpy as np
import pytest

from satcheck.core.worker import WorkerTimeout
from satcheck.scene import load_scene
from satcheck.scene.document import Document, Item, RawMesh, RawPart
from satcheck.scene.errors import Refused
from satcheck.scene.files import limits
from satcheck.scene.files.nodes import concatenate
from satcheck.scene.files.reading_children import ReadingChildren
from tests.scene import files, graphs


def scene_of(folder, name, content, split=None):
    path = folder / name
    path.write_bytes(content)
    return load_scene([path], split=split)


def bounds(scene):
    return {body.id: body.world_mesh().bounds for body in scene.bodies}


def test_a_node_with_a_mesh_is_a_body_where_the_hierarchy_places_it(tmp_path):
    nodes = [
        {"name": "base", "mesh": 0, "children": [1, 2]},
        {"name": "arm", "translation": [10, 0, 0], "children": [3]},
        {"name": "empty"},
        {"name": "hand", "mesh": 0, "scale": [-2, 1, 1], "rotation": [0, 0, 0, 1]},
    ]
    scene = scene_of(tmp_path, "robot.glb", graphs.glb(nodes))
    assert bounds(scene) == {
        "base": ((0, 0, 0), (1, 1, 1)),
        "base/arm/hand": ((8, 0, 0), (10, 1, 1)),
    }
    base, hand = scene.bodies
    assert base.file is hand.file
    assert base.file.part == "cube"
    assert (base.path, hand.path) == ("base", "base/arm/hand")
    assert (base.transform, scene.units, scene.name) == (None, "meter", "robot")
    assert hand.world_mesh().topology().volume == 2.0  # a mirror turns the winding


def test_a_matrix_of_the_hierarchy_is_the_product_from_the_root_on(tmp_path):
    turned = {"rotation": [0, 0, 0.5**0.5, 0.5**0.5], "children": [1]}  # a quarter, x to y
    nodes = [turned, {"name": "b", "matrix": graphs.MOVED, "mesh": 0}]
    (low, high) = bounds(scene_of(tmp_path, "a.glb", graphs.glb(nodes)))["node0/b"]
    assert low == pytest.approx((-1, 5, 0), abs=4e-15)
    assert high == pytest.approx((0, 6, 1), abs=4e-15)


def test_ids_are_unique_printable_and_stable(tmp_path):
    nodes = [
        {"name": "wheel", "mesh": 0},
        {"name": "wheel", "mesh": 0},
        {"mesh": 1},
        {"mesh": 0},
        {"name": "a\nb#1\ud800", "mesh": 0},
        {"name": "wheel-2", "mesh": 0},
        {"children": [7]},
        {"name": " ", "mesh": 0},
    ]
    scene = scene_of(tmp_path, "a.glb", graphs.glb(nodes, "cube", None))
    ids = [body.id for body in scene.bodies]
    assert ids == ["wheel", "wheel-2", "node2", "cube", "a b1", "wheel-2-2", "node6/cube"]
    assert [body.file.part for body in scene.bodies][:3] == ["cube", "cube", "mesh1"]
    assert [body.path for body in scene.bodies] == ids


def test_a_name_with_a_slash_collides_with_no_path(tmp_path):
    nodes = [{"name": "a/b", "mesh": 0}, {"name": "a", "children": [2]}, {"name": "b", "mesh": 0}]
    scene = scene_of(tmp_path, "a.glb", graphs.glb(nodes))
    assert [body.id for body in scene.bodies] == ["a/b", "a/b-2"]


def test_long_paths_are_cut_in_front(tmp_path):
    deep = [{"name": "n" * 70, "children": [k + 1], "mesh": 0} for k in range(500)]
    scene = scene_of(tmp_path, "a.glb", graphs.glb([*deep, {"mesh": 0}]))
    assert len({body.id for body in scene.bodies}) == 501
    assert max(len(body.id) for body in scene.bodies) <= 210
    assert scene.bodies[-1].id.startswith("...")


def test_several_files_are_one_body_each_unless_asked(tmp_path):
    nodes = [{"name": "a", "mesh": 0}, {"name": "b", "mesh": 0, "translation": [3, 0, 0]}]
    for name in ("one.glb", "two.glb"):
        (tmp_path / name).write_bytes(graphs.glb(nodes))
    (tmp_path / "plain.obj").write_bytes(files.obj())
    paths = [tmp_path / name for name in ("one.glb", "two.glb", "plain.obj")]
    assert [body.id for body in load_scene(paths).bodies] == ["one", "two", "plain"]
    nodes = load_scene(paths, split="nodes")
    assert [body.id for body in nodes.bodies] == ["one/a", "one/b", "two/a", "two/b", "plain"]
    assert nodes.units is None
    assert load_scene(paths[:2]).units == "meter"
    (alone,) = load_scene(paths[:1], split="none").bodies
    assert (alone.id, alone.path, alone.file.part) == ("one", None, None)


def test_components_are_numbered_by_their_lowest_corners(tmp_path):
    content = files.binary_stl(
        files.TWO_CUBES_POINTS[::-1], [tuple(15 - i for i in f) for f in files.TWO_CUBES]
    )
    scene = scene_of(tmp_path, "pair.stl", content, "components")
    assert bounds(scene) == {
        "pair#1": ((0, 0, 0), (1, 1, 1)),
        "pair#2": ((3, 0, 0), (4, 1, 1)),
    }
    assert [(body.path, body.file.part) for body in scene.bodies] == [("#1", "#1"), ("#2", "#2")]
    assert len({body.file.sha256 for body in scene.bodies}) == 1


def test_components_of_nodes_share_their_meshes(tmp_path):
    items = '<item objectid="1"/><item objectid="2" transform="1 0 0 0 1 0 0 0 1 0 9 0"/>'
    two = graphs.named_3mf(1, "two", points=files.TWO_CUBES_POINTS, faces=files.TWO_CUBES)
    resources = two + files.components_3mf(2, '<component objectid="1"/>') + files.object_3mf(3)
    items += '<item objectid="3" transform="1 0 0 0 1 0 0 0 1 0 0 9"/>'
    scene = scene_of(tmp_path, "a.3mf", files.threemf(resources, items), "components")
    assert bounds(scene) == {
        "two#1": ((0, 0, 0), (1, 1, 1)),
        "two#2": ((3, 0, 0), (4, 1, 1)),
        "object2/two#1": ((0, 9, 0), (1, 10, 1)),
        "object2/two#2": ((3, 9, 0), (4, 10, 1)),
        "object3": ((0, 0, 9), (1, 1, 10)),
    }
    assert scene.bodies[0].file is scene.bodies[2].file


def test_loose_pieces_without_area_are_left_out_with_a_warning(tmp_path):
    points = [*files.TWO_CUBES_POINTS, (9, 0, 0), (10, 0, 0), (11, 0, 0)]
    content = files.obj(points, [*files.TWO_CUBES, (16, 17, 18)])
    scene = scene_of(tmp_path, "a.obj", content, "components")
    assert [body.id for body in scene.bodies] == ["a#1", "a#2"]
    assert [(issue.code, issue.body) for issue in scene.issues] == [("degenerate-triangles", None)]


def nested_boxes(*sides: float) -> bytes:
    """Cubes about the origin with these sides; of a negative side: its wall faces inward."""
    points, faces = [], []
    for k, side in enumerate(sides):
        points += [tuple(abs(side) * (c - 0.5) for c in point) for point in files.CUBE_POINTS]
        own = files.CUBE if side > 0 else [face[::-1] for face in files.CUBE]
        faces += [tuple(i + 8 * k for i in face) for face in own]
    return files.obj(points, faces)


@pytest.mark.parametrize(
    ("sides", "volumes"),
    [
        ((8, -4), [448.0]),
        ((8, -4, 2), [448.0, 8.0]),
        ((-4, 2, 8), [448.0, 8.0]),
        ((8, -6, 4, -2), [296.0, 56.0]),
    ],
)
def test_the_wall_of_a_cavity_belongs_to_the_solid_around_it(tmp_path, sides, volumes):
    scene = scene_of(tmp_path, "a.obj", nested_boxes(*sides), "components")
    assert [body.file.health.volume for body in scene.bodies] == volumes
    assert scene.issues == ()


def test_what_faces_inward_is_turned_before_it_bounds_a_cavity(tmp_path):
    boxes = nested_boxes(8, -6, -4)
    scene = scene_of(tmp_path, "a.obj", boxes, "components")
    assert [body.file.mesh.topology().volume for body in scene.bodies] == [296.0, 64.0]
    assert {issue.code for issue in scene.issues} == {"inside-out"}
    (whole,) = scene_of(tmp_path, "a.obj", boxes, "none").bodies
    assert whole.file.mesh.topology().volume == 360.0


@pytest.mark.parametrize(
    ("sides", "doubtful", "codes"),
    [
        ((-8, 4), [True], {"doubtful-cavity"}),
        ((4, -8), [True], {"doubtful-cavity"}),
        ((-8, 6, -4), [True, False], {"doubtful-cavity", "inside-out"}),
    ],
)
def test_what_may_be_a_cavity_stays_with_the_solid_around_it(tmp_path, sides, doubtful, codes):
    scene = scene_of(tmp_path, "a.obj", nested_boxes(*sides), "components")
    assert [body.file.health.doubtful for body in scene.bodies] == doubtful
    assert {issue.code for issue in scene.issues} == codes
    (whole,) = scene_of(tmp_path, "a.obj", nested_boxes(*sides), "none").bodies
    assert whole.file.health.doubtful


def test_a_broken_mesh_loses_its_own_nodes_alone(tmp_path):
    scene = scene_of(tmp_path, "a.glb", graphs.with_broken_mesh())
    assert [body.id for body in scene.bodies] == ["a", "c"]
    (lost,) = scene.unreadable
    assert (lost.id, lost.path, lost.issue.code) == ("b", "b", "index-out-of-range")
    assert "mesh 'bad': mesh 1: index out of range: 8 of 8 vertices" in lost.issue.message
    assert scene.order == ("a", "b", "c")
    whole = scene_of(tmp_path, "a.glb", graphs.with_broken_mesh(), "none")
    assert [lost.issue.code for lost in whole.unreadable] == ["index-out-of-range"]


@pytest.mark.parametrize(
    ("bad", "code"),
    [
        (graphs.named_3mf(2, "bad", faces=[(0, 1, 8)]), "index-out-of-range"),
        (graphs.named_3mf(2, "bad", points=[(float("nan"), 0, 0)] * 3), "non-finite"),
        (graphs.named_3mf(2, "bad").replace('v3="', 'v3="x', 1), "bad-record"),
        (graphs.named_3mf(2, "bad", points=[(0, 0, 0)] * 8), "only-degenerate"),
    ],
)
def test_a_broken_object_loses_its_own_items_alone(tmp_path, bad, code):
    resources = graphs.named_3mf(1, "good") + bad
    items = '<item objectid="2"/><item objectid="1"/>'
    scene = scene_of(tmp_path, "a.3mf", files.threemf(resources, items))
    assert [body.id for body in scene.bodies] == ["good"]
    assert [(lost.id, lost.issue.code) for lost in scene.unreadable] == [("bad", code)]
    assert scene.units == "inch"


@pytest.mark.parametrize("scale", [[1, 0, 1], [0, 0, 0]])
def test_a_node_that_flattens_its_mesh_is_unreadable(tmp_path, scale):
    nodes = [{"name": "a", "mesh": 0}, {"name": "b", "mesh": 0, "scale": scale}]
    scene = scene_of(tmp_path, "a.glb", graphs.glb(nodes))
    assert [body.id for body in scene.bodies] == ["a"]
    assert [lost.issue.code for lost in scene.unreadable] == ["singular-transform"]


def test_a_file_of_which_nothing_can_be_used_is_one_unreadable_body(tmp_path):
    document, _ = graphs.meshes("a", "b")
    document["nodes"] = [{"mesh": 0}, {"mesh": 1}]
    document["scenes"] = [{"nodes": [0, 1]}]
    document["buffers"][0]["uri"] = "gone.bin"
    scene = scene_of(tmp_path, "level.gltf", graphs.gltf(document))
    assert [(lost.id, lost.path) for lost in scene.unreadable] == [("level", None)]
    assert [issue.code for issue in scene.issues] == ["missing-resource"]


def test_a_bad_skin_loses_its_own_nodes(tmp_path):
    nodes = [{"name": "a", "mesh": 0, "skin": 0}, {"name": "b", "mesh": 1}]
    scene = scene_of(tmp_path, "a.glb", graphs.glb(nodes, "skinned", "stiff"))
    assert [body.id for body in scene.bodies] == ["b"]
    assert [(lost.id, lost.issue.code) for lost in scene.unreadable] == [
        ("a", "index-out-of-range")
    ]


def lines_beside_a_cube():
    document, buffer = graphs.meshes("cube", "line")
    lines = {"attributes": {"POSITION": 0}, "mode": 1}
    document["meshes"][1]["primitives"] = [lines]
    document["nodes"] = [{"name": "a", "mesh": 0}, {"name": "b", "mesh": 1}]
    document["scenes"] = [{"nodes": [0, 1]}]
    return files.glb(document, buffer)


@pytest.mark.parametrize("split", ["nodes", "none"])
def test_a_node_of_lines_beside_meshes_is_a_note(tmp_path, split):
    (tmp_path / "a.glb").write_bytes(lines_beside_a_cube())
    scene = load_scene([tmp_path / "a.glb"], split=split)
    assert len(scene.bodies) == 1
    assert not scene.unreadable
    (note,) = scene.issues
    assert (note.code, note.severity) == ("left-out", "note")
    assert note.message.startswith("b without triangles")


def test_a_shared_mesh_names_itself_in_its_one_warning(tmp_path):
    document, buffer = graphs.meshes("sheet")
    document["accessors"][1]["count"] -= 3
    document["nodes"] = [{"mesh": 0}, {"mesh": 0, "translation": [2, 0, 0]}]
    document["scenes"] = [{"nodes": [0, 1]}]
    (issue,) = scene_of(tmp_path, "a.glb", files.glb(document, buffer)).issues
    assert (issue.code, issue.body) == ("not-closed", None)
    assert issue.message.startswith("mesh 'sheet': open mesh (1 hole")


def test_the_child_process_gives_the_same_nodes(tmp_path, monkeypatch):
    nodes = [
        {"name": "a", "mesh": 0, "skin": 0},
        {"name": "b", "mesh": 1, "rotation": [0.1, 0.2, 0.3, 0.4], "children": [2]},
        {"name": "c", "mesh": 0, "scale": [2, 3, -4]},
    ]
    for content in (graphs.glb(nodes, "one", "two"), graphs.with_broken_mesh()):
        here = scene_of(tmp_path, "a.glb", content)
        with monkeypatch.context() as patch:
            patch.setattr(limits, "IN_PROCESS_BYTES", 0)
            there = scene_of(tmp_path, "a.glb", content)
        assert [(b.id, b.transform, b.file.part) for b in here.bodies] == [
            (b.id, b.transform, b.file.part) for b in there.bodies
        ]
        assert [b.file.mesh.to_bytes() for b in here.bodies] == [
            b.file.mesh.to_bytes() for b in there.bodies
        ]
        assert here.issues == there.issues
        assert here.units == there.units


def test_limits_of_the_child_hold_for_nodes_too(tmp_path, monkeypatch):
    """The child never answers: a real one may answer before any limit, however short."""

    def wait(_children, _request, *, seconds):
        raise WorkerTimeout("reader", seconds)

    monkeypatch.setattr(ReadingChildren, "ask", wait)
    path = tmp_path / "a.3mf"
    path.write_bytes(files.threemf())
    (issue,) = load_scene([path], seconds_per_file=0.25).issues
    assert issue.code == "reader-timeout"
    assert "0.25 s (raise it with --limit seconds=N)" in issue.message


def test_more_bodies_than_the_limit_are_refused(tmp_path, monkeypatch):
    monkeypatch.setattr(limits, "MAX_PLACEMENTS", 9)
    nodes = [{"children": [2, 2, 2]}, {"mesh": 0}, {"children": [1, 1, 1]}]
    scene = scene_of(tmp_path, "a.glb", graphs.glb(nodes, roots=[0]))
    assert [issue.code for issue in scene.issues] == ["too-large"]
    monkeypatch.setattr(limits, "MAX_PLACEMENTS", 1)
    scene = scene_of(
        tmp_path, "a.obj", files.obj(files.TWO_CUBES_POINTS, files.TWO_CUBES), "components"
    )
    assert [issue.code for issue in scene.issues] == ["too-large"]
    scene = scene_of(tmp_path, "b.obj", cubes_of_objects("o a", "o b"))
    assert "more than 1 objects" in scene.issues[0].message


def test_a_thousand_nodes_read_each_mesh_once(tmp_path, monkeypatch):
    from satcheck.scene import inspect
    from satcheck.scene.files import gltf

    counts = {"read": 0, "examined": 0}

    def counted(name, function):
        def call(*arguments, **options):
            counts[name] += 1
            return function(*arguments, **options)

        return call

    monkeypatch.setattr(gltf.GltfScene, "mesh", counted("read", gltf.GltfScene.mesh))
    monkeypatch.setattr(inspect, "_examined", counted("examined", inspect._examined))
    nodes = [{"mesh": k % 2, "name": "n", "translation": [2 * k, 0, 0]} for k in range(1000)]
    scene = scene_of(tmp_path, "a.glb", graphs.glb(nodes, "a", "b"))
    assert len(scene.bodies) == len({body.id for body in scene.bodies}) == 1000
    assert counts == {"read": 2, "examined": 2}


def test_plain_formats_and_files_of_one_object_have_no_nodes(tmp_path):
    named = b"o cube\n" + files.obj() + b"o nothing\n"
    for name, content in (
        ("a.dae", files.collada()),
        ("b.stl", files.binary_stl()),
        ("c.obj", named),
    ):
        (body,) = scene_of(tmp_path, name, content, "nodes").bodies
        assert (body.id, body.path, body.file.part) == (name[0], None, None)


def cubes_of_objects(*heads: str) -> bytes:
    """A cube after each of these lines, 3 beside the one before."""
    text = []
    for k, head in enumerate(heads):
        points = [(x + 3 * k, y, z) for x, y, z in files.CUBE_POINTS]
        faces = [tuple(i + 8 * k for i in face) for face in files.CUBE]
        vertices, corners = (files.obj(points, []), files.obj([], faces))
        text.append(vertices + head.encode() + b"\n" + corners)
    return b"".join(text)


def test_an_object_of_obj_is_a_body_and_a_group_is_none(tmp_path):
    content = cubes_of_objects("g first", "o crate", "g side", "o crate", "o", "o a/b #1")
    scene = scene_of(tmp_path, "a.obj", content)
    assert bounds(scene) == {
        "object1": ((0, 0, 0), (1, 1, 1)),
        "crate": ((3, 0, 0), (7, 1, 1)),
        "crate-2": ((9, 0, 0), (10, 1, 1)),
        "object4": ((12, 0, 0), (13, 1, 1)),
        "a/b": ((15, 0, 0), (16, 1, 1)),
    }
    assert [body.path for body in scene.bodies] == [body.id for body in scene.bodies]
    assert [body.file.health.volume for body in scene.bodies] == [1.0, 2.0, 1.0, 1.0, 1.0]
    assert [body.file.mesh.vertex_count for body in scene.bodies] == [8, 16, 8, 8, 8]
    (whole,) = scene_of(tmp_path, "a.obj", content, "none").bodies
    assert (whole.id, whole.path, whole.file.health.volume) == ("a", None, 6.0)
    pieces = scene_of(tmp_path, "a.obj", content, "components")
    assert [body.id for body in pieces.bodies][:3] == ["object1", "crate#1", "crate#2"]


def test_an_object_keeps_a_polygon_whose_vertices_come_later(tmp_path):
    square, below = "f 1 2 3 4\n", "f 5 6 7\n"
    late = "".join(f"v {x} {y} 0\n" for x, y in ((0, 0), (4, 0), (4, 4), (0, 4)))
    content = "o one\n" + square + "o two\n" + late + "v 0 0 9\nv 1 0 9\nv 0 1 9\n" + below
    scene = scene_of(tmp_path, "a.obj", content.encode())
    assert bounds(scene) == {"one": ((0, 0, 0), (4, 4, 0)), "two": ((0, 0, 9), (1, 1, 9))}


def test_an_object_that_cannot_be_used_is_lost_alone(tmp_path):
    content = cubes_of_objects("o a", "o b") + b"o flat\nf 1 1 2\no lines\nl 1 2\nf 1 2\n"
    scene = scene_of(tmp_path, "a.obj", content)
    assert [body.id for body in scene.bodies] == ["a", "b"]
    (lost,) = scene.unreadable
    assert (lost.id, lost.path, lost.issue.code) == ("flat", "flat", "only-degenerate")
    assert {"ignored-geometry", "short-face"} < {issue.code for issue in scene.issues}


def test_a_node_of_collada_is_a_body_where_the_hierarchy_places_it(tmp_path):
    shown = '<instance_geometry url="#g"/>'
    moved = "<translate>10 0 0</translate>"
    lamp = f'<node id="lamp"><translate>0 5 0</translate>{shown}</node>'
    hung = '<instance_node url="#lamp"/>'
    nodes = (
        f'<node id="n1" name="base">{shown}<node name="arm">{moved}{hung}</node></node>'
        f'<node id="n2" name="base">{moved}{shown}{shown}</node>'
    )
    content = files.collada(nodes=nodes, library_nodes=lamp)
    scene = scene_of(tmp_path, "a.dae", content)
    assert bounds(scene) == {
        "base": ((0, 0, 0), (1, 1, 1)),
        "base/arm/lamp": ((10, 5, 0), (11, 6, 1)),
        "base-2": ((10, 0, 0), (11, 1, 1)),
    }
    assert [body.path for body in scene.bodies] == [body.id for body in scene.bodies]
    assert scene.bodies[0].file is scene.bodies[1].file
    assert scene.units == "meters"
    (whole,) = scene_of(tmp_path, "a.dae", content, "none").bodies
    assert (whole.id, whole.path, whole.file.health.triangles) == ("a", None, 48)


@pytest.mark.parametrize(
    ("parts", "nodes", "said"),
    [
        (1, [("a", 0), ("a", 0)], "reader-failed"),
        (1, [("a", 1)], "reader-failed"),
        (1, [], "empty-mesh"),
    ],
)
def test_what_no_reader_may_return_is_refused(parts, nodes, said):
    """As one of another package may: a body would vanish without a word."""
    mesh = RawPart("m", RawMesh(b"", b"", "float64"))
    scene = Document((mesh,) * parts, tuple(Item(number, path) for path, number in nodes))
    with pytest.raises(Refused) as caught:
        scene.check()
    assert caught.value.code == said


def test_a_corner_beyond_its_mesh_is_no_corner_of_the_next():
    points = np.eye(3).tobytes()
    triangles = np.array([0, 1, 2], "<u4").tobytes()
    beyond = np.array([0, 1, 3], "<u4").tobytes()
    with pytest.raises(ValueError, match="names vertex 3 of 3"):
        concatenate([(points, beyond, None), (points, triangles, None)])


def test_a_small_file_places_fewer_bodies(tmp_path, monkeypatch):
    """However few bytes it takes to state them: one more body for eight bytes of the file."""
    nodes = [{"mesh": 0} for _ in range(40)]
    content = graphs.glb(nodes, roots=[*range(40)])
    for spare, few in ((0, True), (-1, False)):
        most = 40 - len(content) // limits.BYTES_OF_BODY + spare
        monkeypatch.setattr(limits, "ANY_BODIES", most)
        scene = scene_of(tmp_path, "a.glb", content)
        assert [issue.code for issue in scene.issues] == ([] if few else ["too-large"])


def test_copies_that_make_one_body_are_few_times_what_the_file_holds(tmp_path, monkeypatch):
    content = graphs.glb([{"mesh": 0} for _ in range(1200)], roots=[*range(1200)])
    assert not scene_of(tmp_path, "a.glb", content, "none").unreadable
    monkeypatch.setattr(limits, "ANY_COPIED", 0)
    (refused,) = scene_of(tmp_path, "a.glb", content, "none").unreadable
    assert "triangles in all instances exceed" in str(refused)
