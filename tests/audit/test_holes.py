"""What a body is when its file holds sheets, cracks or holes: docs/bodies.md."""

from __future__ import annotations

import json
import math

import pytest

from satcheck.audit import Settings, check
from satcheck.scene import load_scene
from satcheck.verify import verify
from satcheck.verify.bodies import shape_of
from tests.audit.shapes import (
    BOX_FACES,
    Mesh,
    box,
    bracket,
    open_box,
    scene_of,
    unit_box,
    write,
)
from tests.audit.surfaces import (
    SQUARE,
    inverted,
    only,
    relation,
    split_square,
    together,
    triangulated,
    without,
)

HALF = box((0.5, 0.125, 0.125), (1.5, 0.875, 0.875))


@pytest.mark.parametrize("missing_a", range(12))
@pytest.mark.parametrize("missing_b", [0, 5, 11])
def test_boxes_that_overlap_do_so_without_a_triangle(tmp_path, missing_a, missing_b):
    a, b = without(unit_box(), missing_a), without(HALF, missing_b)
    report = check(scene_of(tmp_path, a=a, b=b))
    assert (report.summary.verdict, only(report).relation) == ("fail", "penetrating")
    low, high = only(report).depth_bounds
    assert low <= 0.5 <= high * (1 + 1e-12)
    assert only(report).mtv_verified


@pytest.mark.parametrize("missing", range(12))
def test_a_box_in_a_box_with_a_hole_is_inside_whatever_fills_the_hole(tmp_path, missing):
    outer = without(unit_box(edge=4.0), missing)
    assert relation(tmp_path, outer, unit_box(1, 1, 1)) == "contains"
    assert relation(tmp_path, unit_box(1, 1, 1), outer) == "inside"
    assert relation(tmp_path, outer, unit_box(5, 1, 1)) == "separated"


ROOM = together(inverted(unit_box(edge=4.0)), unit_box(1, 1, 1))  # with a table


@pytest.mark.parametrize(
    ("box_in_it", "expected"),
    [
        (box((1.25, 1.25, 1.25), (1.75, 1.75, 1.75)), "indeterminate"),  # or a cavity there
        (box((1.0, 1.25, 1.25), (1.75, 1.75, 1.75)), "indeterminate"),
        (box((2.5, 2.5, 2.5), (3.5, 3.5, 3.5)), "contains"),
        (box((1.5, 1.25, 1.25), (2.5, 1.75, 1.75)), "penetrating"),
        (box((5.0, 1.25, 1.25), (6.0, 1.75, 1.75)), "separated"),
    ],
)
@pytest.mark.parametrize("allow_open", [False, True])
def test_what_faces_outward_within_what_faces_inward_may_be_solid_or_a_cavity(
    tmp_path, box_in_it, expected, allow_open
):
    report = check(scene_of(tmp_path, a=ROOM, b=box_in_it), Settings(allow_open=allow_open))
    (finding,) = report.findings or [None]
    assert (finding.relation if finding else "separated") == expected
    assert report.summary.verdict == (
        "pass"
        if expected == "separated"
        else "incomplete"
        if expected == "indeterminate"
        else "fail"
    )
    if expected == "indeterminate":
        assert "may be solid or a cavity" in finding.reason
        assert finding.reason_code == "open-hole"


@pytest.mark.parametrize(
    ("room_faces_inward", "table_faces_inward", "expected", "with_allow_open"),
    [
        (True, False, "indeterminate", "contains"),
        (True, True, "contains", "contains"),
        (False, False, "contains", "contains"),
        (False, True, "separated", "contains"),  # a cavity; with --allow-open a part inside out
    ],
)
@pytest.mark.parametrize("beside", [None, unit_box(10, edge=9.0)])
def test_a_part_within_an_open_one_is_judged_like_one_within_a_closed_one(
    tmp_path, room_faces_inward, table_faces_inward, expected, with_allow_open, beside
):
    points, faces = unit_box(edge=4.0)
    room = points, [f for f in faces if any(points[v][2] != 4 for v in f)]
    table = unit_box(1, 1, 1)
    parts = [
        inverted(room) if room_faces_inward else room,
        inverted(table) if table_faces_inward else table,
    ]
    mesh = together(*parts, *([beside] if beside else []))
    part = box((1.25, 1.25, 1.25), (1.75, 1.75, 1.75))
    for allow_open, relation_then in ((False, expected), (True, with_allow_open)):
        report = check(scene_of(tmp_path, a=mesh, b=part), Settings(allow_open=allow_open))
        (finding,) = report.findings or [None]
        assert (finding.relation if finding else "separated") == relation_then


def test_a_wall_of_a_cavity_that_is_open_does_not_make_the_cavity_solid(tmp_path):
    """The wall of the cavity of a block, read as a sheet, would leave the block without a cavity.
    In the cavity is a box that faces inward, with one in it that faces outward."""
    points, faces = inverted(box((1, 1, 1), (10, 10, 10)))
    wall = points, [face for face in faces if any(points[v][2] != 10 for v in face)]
    boxes = unit_box(edge=11.0), wall, inverted(unit_box(2, 2, 2, 7.0)), unit_box(3, 3, 3, 5.0)
    body = together(*boxes)
    assert relation(tmp_path, body, unit_box(4, 4, 4)) == "indeterminate"
    assert relation(tmp_path, body, unit_box(2.5, 4, 4, 0.25)) == "contains"


def test_a_box_in_the_hole_is_indeterminate_and_the_hole_is_named(tmp_path):
    report = check(scene_of(tmp_path, shell=open_box(), part=unit_box(1, 1, 3.5)))
    finding = only(report)
    assert (finding.relation, finding.severity) == ("indeterminate", "warning")
    assert "the hole of shell, in a box 5.66 from corner to corner at (2, 2, 4)" in finding.reason
    assert report.summary.verdict == "incomplete"
    scene = scene_of(tmp_path, shell=open_box(), part=unit_box(1, 1, 3.5))
    meant = check(scene, Settings(allow_open=True))
    assert (only(meant).relation, meant.summary.verdict) == ("separated", "pass")


def test_open_parts_that_are_meant_have_no_inside(tmp_path):
    assert relation(tmp_path, open_box(), unit_box(1, 1, 1)) == "contains"
    assert relation(tmp_path, open_box(), unit_box(1, 1, 1), allow_open=True) == "separated"
    assert relation(tmp_path, open_box(), unit_box(1, 1, -0.5), allow_open=True) == "penetrating"
    beside = together(SQUARE, unit_box(20, edge=4.0))
    assert relation(tmp_path, beside, unit_box(21, 1, 1), allow_open=True) == "contains"


@pytest.mark.parametrize("wall", [(0, 1, 7), (0, 1, 7, 6)], ids=["ends within", "all around"])
@pytest.mark.parametrize("allow_open", [False, True])
def test_a_wall_within_a_box_leaves_it_its_inside(tmp_path, wall, allow_open):
    points, faces = triangulated(unit_box(edge=4.0))
    small = unit_box(2.5, 2.5, 0.25, edge=0.5)  # below the wall
    walled = points, [*faces, wall]
    assert relation(tmp_path, walled, small, allow_open=allow_open) == "contains"


def test_a_body_on_a_holed_face_touches_by_what_is_there(tmp_path):
    """One of the two triangles of the upper face is missing."""
    points, faces = triangulated(unit_box())
    upper = [k for k, face in enumerate(faces) if all(points[v][2] == 1 for v in face)]
    for missing in upper:
        holed = points, [face for k, face in enumerate(faces) if k != missing]
        assert relation(tmp_path, holed, unit_box(z=1)) == "touching"


def split_edge(at: float, lift: float = 0.0) -> Mesh:
    """The unit box whose lower face has one more vertex on an edge of another face."""
    points, faces = unit_box()
    (lower,) = [face for face in faces if all(points[v][2] == 0 for v in face)]
    i = next(k for k in range(4) if points[lower[k]][1] == points[lower[k - 1]][1] == 0)
    new = [*lower[:i], len(points), *lower[i:]]
    return [*points, (at, 0.0, lift)], [*(f for f in faces if f != lower), tuple(new)]


@pytest.mark.parametrize("lift", [0.0, 1e-9], ids=["on the edge", "rounded"])
def test_a_t_junction_leaves_a_box_the_solid_that_it_is(tmp_path, lift):
    """The digits of the file say how far a vertex may be off: 1e-9 here."""
    a = split_edge(0.3, lift)
    settings = Settings(certificate=True)
    report = check(scene_of(tmp_path, a=a, b=unit_box(0.25, 0.25, 0.25, edge=0.5)), settings)
    assert only(report).exact_relation == "contains"
    assert only(report).certificate is not None
    health = report.bodies[0].health
    assert (health.closed, health.solid) == (True, True)
    assert (health.cracks, health.holes) == (1, 0)
    assert [issue.code for issue in report.issues] == ["cracks"]
    over = check(scene_of(tmp_path, a=a, b=unit_box(0.5, 0.25, 0.25)))
    assert only(over).depth_bounds == pytest.approx((0.5, 0.5))


def test_a_seam_within_the_precision_of_the_file_is_no_hole(tmp_path):
    """The left half of a box and the right half, whose rims differ in the last digit."""
    quads = [*tube(0.0, 0.5), *tube(0.5000001, 1.0)]
    quads += [tuple((0.0, *p) for p in SIDES), tuple((1.0, *p) for p in SIDES[::-1])]
    corners = list(dict.fromkeys(p for quad in quads for p in quad))
    halves = corners, [tuple(corners.index(p) for p in quad) for quad in quads]
    report = check(scene_of(tmp_path, a=halves, b=unit_box(0.25, 0.25, 0.25, edge=0.5)))
    assert report.bodies[0].health.holes == 0
    assert only(report).relation == "contains"


SIDES = [(0.0, 0.0), (0.0, 1.0), (1.0, 1.0), (1.0, 0.0)]


def tube(x0: float, x1: float) -> list[tuple[tuple[float, float, float], ...]]:
    """The four walls along x of the unit box, from x0 to x1."""
    turns = zip(SIDES, [*SIDES[1:], SIDES[0]], strict=True)
    return [((x0, *p), (x1, *p), (x1, *q), (x0, *q)) for p, q in turns]


def test_a_turned_triangle_is_a_hole_of_its_own_at_most(tmp_path):
    """Mixed winding and copies of a triangle: far from them nothing is open."""
    points, faces = triangulated(unit_box(edge=4.0))
    for broken in ([faces[0][::-1], *faces[1:]], [*faces, faces[0]], [*faces, faces[0], faces[0]]):
        assert relation(tmp_path, (points, broken), unit_box(1, 1, 1)) == "contains"
        assert relation(tmp_path, (points, broken), unit_box(3.5, 1, 1)) == "penetrating"


def test_the_report_counts_holes_and_gives_the_largest(tmp_path):
    mesh = together(without(unit_box(), 0), without(unit_box(8, edge=2.0), 0, 3))
    report = check(scene_of(tmp_path, a=mesh, b=unit_box(4)))
    health = json.loads(json.dumps(report.to_dict()))["bodies"][0]["health"]
    assert health["holes"] == 3
    assert health["largest_hole"] == pytest.approx(2 * 2**0.5)
    (message,) = [issue.message for issue in report.issues if issue.code == "not-closed"]
    assert message == "open mesh (3 holes, largest 2.83 across)"


BAR = box((1, 1, 1), (3, 5, 3))  # from the bracket into its notch


IN_BOTH = box((1.25, 1.25, 1.5), (1.75, 1.75, 2.5))


@pytest.mark.parametrize("first", range(12))
def test_what_two_parts_enclose_is_material_whichever_way_they_face(tmp_path, first):
    """Of a file with a mirrored part, whose faces look inward: whatever triangle it starts with."""
    points, faces = triangulated(inverted(BAR))
    part = points, [*faces[first:], *faces[:first]]
    for mesh in (together(bracket(), part), together(part, bracket())):
        assert relation(tmp_path, mesh, IN_BOTH) == "contains"


def test_parts_with_holes_and_beside_sheets_are_turned_as_solids_are(tmp_path):
    holed = together(without(bracket(), 0), without(inverted(BAR), 3))
    beside = together(bracket(), inverted(BAR), (SQUARE[0], SQUARE[1]))
    for mesh in (holed, beside):
        assert relation(tmp_path, mesh, IN_BOTH) == "contains"


def test_a_wall_within_a_body_with_a_hole_is_no_boundary(tmp_path):
    """Two boxes that overlap, one without a triangle far away: the part crosses a wall in both."""
    mesh = together(unit_box(edge=4.0), without(box((1, 1, 1), (8, 3, 3)), 7))
    for part in (box((0.5, 1.5, 1.5), (1.5, 2.5, 2.5)), box((1.5, 1.5, 0.5), (2, 2, 1.5))):
        assert relation(tmp_path, mesh, part) == "contains"


def test_a_crack_does_not_part_components(tmp_path):
    """A solid whose faces meet in T-junctions alone is one body, and what it holds another."""
    faces = [triangulated(split_square(axis, at)) for axis in range(3) for at in (0.0, 4.0)]
    (path,) = write(tmp_path, both=together(*faces, unit_box(1, 1, 1)))
    report = check(load_scene([path], split="components"))
    assert [body.id for body in report.bodies] == ["both#1", "both#2"]
    assert only(report).relation == "contains"


def over_the_hole(folder, body, **extra):
    """A cup with a mouth of 4 x 4 at z = 4, and a body of size 1 about (1.5, 1.5, 6.5)."""
    write(folder, cup=open_box(), box=box((-0.5, -0.5, -0.5), (0.5, 0.5, 0.5)))
    placed = {"id": "b", **body, "position": [1.5, 1.5, 6.5]}
    scene = {
        "schema": "satcheck.scene/1",
        "bodies": [{"id": "cup", "mesh": "cup.obj"}, placed],
        **extra,
    }
    path = folder / "scene.json"
    path.write_text(json.dumps(scene), encoding="utf-8")
    return load_scene([path])


BALL_OR_BOX = [{"mesh": "box.obj"}, {"shape": {"type": "sphere", "radius": 0.5}}]


@pytest.mark.parametrize("body", BALL_OR_BOX, ids=["box", "ball"])
@pytest.mark.parametrize(
    ("clearance", "undecided"), [(1.9, None), (2.1, "limit")], ids=["kept", "open"]
)
def test_what_fills_a_hole_may_break_a_clearance(tmp_path, body, clearance, undecided):
    """The rim is more than 2.2 away, and a lid within its hull 2."""
    finding = only(check(over_the_hole(tmp_path, body), Settings(clearance=clearance)))
    assert (finding.relation, finding.undecided) == ("separated", undecided)
    motion = [{"bodies": "b", "translation": [0, 0, 3]}]
    report = check(over_the_hole(tmp_path, body, motion=motion), Settings(clearance=clearance))
    assert (only(report).relation, only(report).undecided) == ("separated", undecided)
    assert report.summary.verdict == ("incomplete" if undecided else "pass")


@pytest.mark.parametrize("body", BALL_OR_BOX, ids=["box", "ball"])
def test_what_comes_near_a_hole_on_its_way_may_break_a_clearance(tmp_path, body):
    """Down to where a lid would be 1.5 away."""
    motion = [{"bodies": "b", "translation": [0, 0, -0.5]}]
    scene = over_the_hole(tmp_path, body, motion=motion)
    for clearance, undecided in ((1.4, None), (1.6, "limit")):
        assert only(check(scene, Settings(clearance=clearance))).undecided == undecided


def test_a_sweep_along_a_body_without_holes_needs_no_hull(tmp_path):
    """A sheet on its own beside a solid encloses nothing."""
    mesh = together(SQUARE, unit_box(20))
    write(tmp_path, a=mesh, b=unit_box(0, 0, 2))
    scene = {
        "schema": "satcheck.scene/1",
        "bodies": [{"id": "a", "mesh": "a.obj"}, {"id": "b", "mesh": "b.obj"}],
        "motion": [{"bodies": "b", "translation": [14, 0, -1.5]}],
    }
    path = tmp_path / "scene.json"
    path.write_text(json.dumps(scene), encoding="utf-8")
    report = check(load_scene([path]))
    assert (only(report).relation, report.summary.verdict) == ("separated", "pass")


@pytest.mark.parametrize("sides", [3, 4, 8])
@pytest.mark.parametrize("times", [1, 2, 3])
def test_copies_of_an_open_surface_face_the_same_way(tmp_path, sides, times):
    """A cone without its base, all of it once or several times over: none of it is a back."""
    turns = [math.tau * k / sides for k in range(sides)]
    points = [*((3 * math.cos(t), 3 * math.sin(t), 0.0) for t in turns), (0.0, 0.0, 4.0)]
    walls: list[tuple[int, ...]] = [(k, (k + 1) % sides, sides) for k in range(sides)]
    cone = points, walls * times
    part = box((-0.25, -0.25, 0.5), (0.25, 0.25, 1))
    assert relation(tmp_path, cone, part) == "contains"
    back_to_back = points, [*walls, *(wall[::-1] for wall in walls)]
    assert relation(tmp_path, back_to_back, part) == "separated"


def test_pieces_of_one_surface_keep_their_winding(tmp_path):
    """The hollow in a block has come apart from the block, and is a little too wide for its mouth:
    its walls look inward, cross the block, and are no part that was turned inside out."""
    block = triangulated(unit_box(edge=4.0))
    mouth = [(1, 1, 4), (3, 1, 4), (3, 3, 4), (1, 3, 4)]
    rim = [(0, 0, 4), (4, 0, 4), (4, 4, 4), (0, 4, 4)]
    ring = rim + mouth, [(k, (k + 1) % 4, 4 + (k + 1) % 4, 4 + k) for k in range(4)]
    sides = block[0], [f for f in block[1] if any(block[0][v][2] != 4 for v in f)]
    points, faces = box((0.99, 0.99, 1), (3.01, 3.01, 4.01))
    hollow = points, [face[::-1] for face in faces if face != BOX_FACES[1]]
    body = together(sides, ring, hollow)
    assert relation(tmp_path, body, box((1.5, 1.5, 1.5), (2.5, 2.5, 2))) == "separated"
    assert relation(tmp_path, body, box((0.25, 0.25, 0.25), (0.5, 0.5, 0.5))) == "contains"


def test_a_triangle_that_comes_twice_leaves_a_solid_what_it_is(tmp_path):
    """Beside a floor, so that the mesh stays open without the copy."""
    points, faces = triangulated(unit_box(edge=4.0))
    for copy in faces:
        twice = points, [*faces, copy]
        beside = together(twice, ([(x, y, 9) for x, y, _ in SQUARE[0]], SQUARE[1]))
        for allow_open in (False, True):
            found = relation(tmp_path, beside, unit_box(1, 1, 1), allow_open=allow_open)
            assert found == "contains"


def test_open_parts_that_cross_overlap_whatever_touches_there(tmp_path):
    """A face of A lies in faces of B, and edges of both meet its corners."""
    points, faces = triangulated(box((4, 2, 1), (7, 4, 4)))
    floor = [(2, 2, 0), (6, 2, 0), (6, 5, 0), (2, 5, 0)], [(0, 1, 2, 3)]
    a = together(floor, (points, [*faces, faces[4]]))
    points, faces = triangulated(box((2, 2, 1), (6, 4, 2)))
    last = points, [*faces, faces[4]]
    first = triangulated(box((2, 3, 0), (3, 5, 3)))
    b = together(without(first, 9), triangulated(box((2, 1, 2), (4, 5, 3))), last)
    for meshes in ((a, b), (b, a)):
        assert relation(tmp_path, *meshes, allow_open=True, tolerance=0.0) == "penetrating"


def in_pieces(mesh: Mesh, shrink: float = 1e-3) -> Mesh:
    """Each face by itself, and a little smaller: no rim is within the precision of another."""
    points, faces = mesh
    pieces = []
    for face in faces:
        middle = [sum(points[k][axis] for k in face) / len(face) for axis in range(3)]
        corners = [
            tuple(c + (m - c) * shrink for c, m in zip(points[k], middle, strict=True))
            for k in face
        ]
        pieces.append((corners, [tuple(range(len(face)))]))
    return together(*pieces)


@pytest.mark.parametrize("body", ["box", "ball"])
def test_what_open_pieces_surround_is_not_proven_apart(tmp_path, body):
    write(tmp_path, pieces=in_pieces(unit_box(edge=4.0)), box=unit_box())
    own = {"mesh": "box.obj"} if body == "box" else {"shape": {"type": "sphere", "radius": 0.5}}

    def finding(x: float, **settings):
        bodies = [{"id": "a", "mesh": "pieces.obj"}, {"id": "b", "position": [x, 1, 1], **own}]
        content = {"schema": "satcheck.scene/1", "bodies": bodies}
        (tmp_path / "s.json").write_text(json.dumps(content), encoding="utf-8")
        report = check(load_scene([tmp_path / "s.json"]), Settings(**settings))
        return only(report), report.summary.verdict

    surrounded, verdict = finding(1.0)
    assert (surrounded.relation, verdict) == ("indeterminate", "incomplete")
    assert "open pieces of a surround b" in surrounded.reason
    assert finding(1.0, allow_open=True)[0].relation == "separated"
    assert finding(9.0)[0].relation == "separated"
    assert finding(3.7)[0].relation == "penetrating"


def test_a_corner_of_a_room_surrounds_nothing(tmp_path):
    points, faces = unit_box(edge=4.0)
    corner = in_pieces((points, [faces[0], faces[2], faces[4]]))
    assert relation(tmp_path, corner, unit_box(1.5, 1.5, 1.5)) == "separated"


def test_verify_does_not_accept_that_what_is_surrounded_is_apart(tmp_path):
    scene = scene_of(tmp_path, a=in_pieces(unit_box(edge=4.0)), b=unit_box(1, 1, 1))
    honest = check(scene, Settings(allow_open=True, certificate=True)).to_dict()
    document = json.loads(json.dumps(honest))
    assert [f.outcome for f in verify(document, tmp_path).findings] == ["accepted"]
    document["settings"]["allow_open"] = False
    (finding,) = verify(document, tmp_path).findings
    assert (finding.outcome, finding.reason) == ("rejected", "open pieces of a surround b")


def test_verify_takes_an_undecided_pair_as_open(tmp_path):
    scene = scene_of(tmp_path, a=ROOM, b=box((1.25, 1.25, 1.25), (1.75, 1.75, 1.75)))
    document = json.loads(json.dumps(check(scene, Settings(certificate=True)).to_dict()))
    report = verify(document, tmp_path)
    assert ([finding.outcome for finding in report.findings], report.accepted) == (["open"], True)
    assert shape_of(scene.bodies[0].file).holed
