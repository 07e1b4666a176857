"""Sheets: what crosses, touches and holds them, at every rung."""

from __future__ import annotations

import math

import numpy as np
import pytest

from satcheck.audit import Settings, check
from satcheck.audit.meshes import check_meshes
from tests.audit.shapes import (
    Mesh,
    box,
    placed_scene,
    pose,
    scene_of,
    unit_box,
    write,
)
from tests.audit.surfaces import (
    DOUBLE,
    SHEET_AND_BOX,
    SQUARE,
    only,
    relation,
    together,
    with_reverse,
)


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


def test_a_flat_part_within_a_solid_is_no_boundary_of_it(tmp_path):
    around, part = unit_box(-3, -3, -3, edge=6.0), box((-0.5, -0.5, -0.5), (0.5, 0.5, 0.5))
    for sheet in (SQUARE, DOUBLE):
        points, faces = sheet
        small = [(x / 5, y / 5, z) for x, y, z in points], faces
        assert relation(tmp_path, together(around, small), part) == "contains"


def test_a_wall_with_a_window_stays_a_sheet_where_it_is_turned(tmp_path):
    """Rounding bends it, and a rod stands in the window."""
    outer, inner = ([(x * k, y * k, 0) for x, y, _ in SQUARE[0]] for k in (1.0, 0.4))
    ring = [(k, (k + 1) % 4, 4 + (k + 1) % 4, 4 + k) for k in range(4)]
    rod = box((-1, -1, -4), (1, 1, 4))
    write(tmp_path, wall=(outer + inner, ring), rod=rod)
    c, s = math.cos(0.5), math.sin(0.5)
    turned = [[c, -s * c, s * s, 0], [s, c * c, -c * s, 0], [0, s, c, 0], [0, 0, 0, 1]]
    for rows in (pose(), turned):
        bodies = [(name, f"{name}.obj", rows) for name in ("wall", "rod")]
        assert only(check(placed_scene(tmp_path, bodies))).relation == "separated"


@pytest.mark.parametrize("accuracy", ["aabb", "obb", "hull", "parts"])
@pytest.mark.parametrize("sheet", [SQUARE, DOUBLE, SHEET_AND_BOX], ids=["open", "double", "beside"])
def test_no_rung_leaves_a_sheet_out(tmp_path, accuracy, sheet):
    """A rung below the triangles may err towards an overlap only."""
    settings = Settings(accuracy=accuracy, cache=False)
    report = check(scene_of(tmp_path, a=sheet, b=unit_box(z=-0.5)), settings)
    assert (only(report).relation, report.summary.verdict) == ("penetrating", "fail")


def test_triangles_that_close_cracks_are_no_sheets():
    """Turned boxes with T-junctions on an edge: what closes these may lie on itself. As long as
    that counts as a sheet, the overlap has no thickness."""
    points, sides = box((0.0, 0.0, 0.0), (3.0, 3.0, 1.0))
    sides = [side for side in sides if any(points[k][2] < 1.0 for k in side)]
    points += [(0, 3, 1), (0, 0, 1), (1, 0, 1), (2, 0, 1), (3, 0, 1), (3, 3, 1)]
    other = unit_box(1, 1, 0.5)
    for seed in range(40):
        turn = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))[0]
        turn[:, 0] *= np.linalg.det(turn)
        pair = [
            (
                np.array(mesh[0]) @ turn.T,
                [(f[0], *f[k : k + 2]) for f in mesh[1] for k in range(1, len(f) - 1)],
            )
            for mesh in ((points, [*sides, range(8, 14)]), other)
        ]
        finding = check_meshes(*pair, settings=Settings(depth=True))
        assert finding.thickness == pytest.approx(0.5, rel=0.01), seed
