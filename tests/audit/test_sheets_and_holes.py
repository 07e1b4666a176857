"""What a body is when its file holds sheets, cracks or holes: docs/bodies.md."""

from __future__ import annotations

import json

import pytest

from satcheck.audit import Settings, check
from tests.audit.shapes import Mesh, box, open_box, scene_of, unit_box

SQUARE: Mesh = ([(-5, -5, 0), (5, -5, 0), (5, 5, 0), (-5, 5, 0)], [(0, 1, 2, 3)])


def only(report):
    (finding,) = report.findings
    return finding


def relation(folder, a: Mesh, b: Mesh, **settings):
    finding = only(check(scene_of(folder, a=a, b=b), Settings(**settings)))
    assert finding.quality in ("exact", "bounded", None)
    return finding.relation


def together(*meshes: Mesh) -> Mesh:
    points, faces = [], []
    for more_points, more_faces in meshes:
        faces += [tuple(len(points) + k for k in face) for face in more_faces]
        points += more_points
    return points, faces


def triangulated(mesh: Mesh) -> Mesh:
    points, faces = mesh
    return points, [(f[0], f[k], f[k + 1]) for f in faces for k in range(1, len(f) - 1)]


def without(mesh: Mesh, *triangles: int) -> Mesh:
    points, faces = triangulated(mesh)
    return points, [face for k, face in enumerate(faces) if k not in triangles]


def with_reverse(mesh: Mesh) -> Mesh:
    points, faces = mesh
    return points, [*faces, *(face[::-1] for face in faces)]


DOUBLE = with_reverse(SQUARE)
SHEET_AND_BOX = together(DOUBLE, unit_box(20))


@pytest.mark.parametrize("sheet", [SQUARE, DOUBLE, SHEET_AND_BOX], ids=["open", "double", "beside"])
@pytest.mark.parametrize(
    ("z", "expected"),
    [(-0.5, "penetrating"), (0.0, "touching"), (-1.0, "touching"), (0.25, "separated")],
)
def test_a_sheet_is_material_that_a_box_crosses(tmp_path, sheet, z, expected):
    assert relation(tmp_path, sheet, unit_box(z=z)) == expected
    assert relation(tmp_path, unit_box(z=z), sheet) == expected


@pytest.mark.parametrize("sheet", [SQUARE, DOUBLE, SHEET_AND_BOX], ids=["open", "double", "beside"])
def test_a_sheet_can_lie_within_a_solid(tmp_path, sheet):
    around = box((-9, -9, -9), (30, 9, 9))
    assert relation(tmp_path, around, sheet) == "contains"
    assert relation(tmp_path, sheet, around) == "inside"


def test_nothing_hides_in_a_double_sided_shell(tmp_path):
    shell = with_reverse(unit_box(edge=4.0))
    assert relation(tmp_path, shell, unit_box(1, 1, 1)) == "separated"
    assert relation(tmp_path, shell, unit_box(1, 1, 3.5)) == "penetrating"


@pytest.mark.parametrize("turned", [False, True])
def test_sheets_cross_along_their_edges(tmp_path, turned):
    """Two squares of four triangles about a middle line: no two triangles cross, the squares do."""
    flat = [(-1, 0, 0), (1, 0, 0), (1, 1, 0), (-1, 1, 0), (1, -1, 0), (-1, -1, 0)]
    faces = [(0, 1, 2, 3), (0, 5, 4, 1)]
    a = with_reverse(([(x, y, z) for x, y, z in flat], faces))
    b = with_reverse(([(x, z, y) if turned else (x, z, y * y) for x, y, z in flat], faces))
    assert relation(tmp_path, a, b) == ("penetrating" if turned else "touching")


def test_flush_sheets_touch(tmp_path):
    """Tiles that overlap in one plane: moved by however little, they are apart."""
    tile: Mesh = ([(0, 0, 0), (3, 0, 0), (3, 3, 0), (0, 3, 0)], [(0, 1, 2, 3)])
    for sheet in (tile, with_reverse(tile)):
        assert relation(tmp_path, SQUARE, sheet) == "touching"
        assert relation(tmp_path, DOUBLE, sheet) == "touching"


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


def test_a_box_in_the_hole_is_indeterminate_and_the_hole_is_named(tmp_path):
    report = check(scene_of(tmp_path, shell=open_box(), part=unit_box(1, 1, 3.5)))
    finding = only(report)
    assert (finding.relation, finding.severity) == ("indeterminate", "warning")
    assert "the hole of shell, 5.66 across at (2, 2, 4)" in finding.reason
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
    assert (health["closed"], health["solid"]) == (True, True)
    assert (health["cracks"], health["holes"]) == (1, 0)
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
    assert report.bodies[0].health["holes"] == 0
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
    assert message.startswith("3 holes, the largest 2.83 across")
