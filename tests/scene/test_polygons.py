"""Polygons become triangles that cover them, also where they are not convex."""

from __future__ import annotations

from array import array
from fractions import Fraction

import pytest

from satcheck._native import readers
from satcheck.audit import check
from satcheck.scene import load_scene
from tests.scene import files

U = [(0, 0), (3, 0), (3, 3), (2, 3), (2, 1), (1, 1), (1, 3), (0, 3)]
POLYGONS = {
    "u": U,
    "arrow": [(0, 0), (2, 1), (0, 2), (1, 1)],
    "corners in a line": [(0, 0), (1, 0), (2, 0), (2, 2), (1, 2), (0, 2), (0, 1)],
    "comb": [(0, -1), (0, 5), (1, 0), (2, 7), (3, 0), (4, 9), (5, 0), (6, 3), (6, -1)],
    "bridge to a hole": [
        *((0, 0), (4, 0), (4, 4), (0, 4), (0, 0)),
        *((1, 1), (1, 3), (3, 3), (3, 1), (1, 1)),
    ],
    "one ulp from straight": [(0, 0), (1, 2.0**-52), (2, 0), (2, 1), (1, 1 - 2.0**-53), (0, 1)],
}
PLANES = {
    "xy": lambda x, y: (x, y, 0),
    "yx": lambda x, y: (y, x, 0),
    "yz": lambda x, y: (5, x, y),
    "xz": lambda x, y: (x, 7, y),
    "slanted": lambda x, y: (x, y, x / 4 - y / 2),
}


def area(points):
    """Twice the signed area, exactly."""
    corners = [(Fraction(x), Fraction(y)) for x, y in points]
    pairs = zip(corners, corners[1:] + corners[:1], strict=True)
    return sum(ax * by - bx * ay for (ax, ay), (bx, by) in pairs)


@pytest.mark.parametrize("plane", PLANES)
@pytest.mark.parametrize("name", POLYGONS)
def test_triangles_turn_as_their_polygon_and_have_its_area(name, plane):
    polygon = POLYGONS[name]
    for shift in range(len(polygon)):
        for corners in (
            polygon[shift:] + polygon[:shift],
            (polygon[shift:] + polygon[:shift])[::-1],
        ):
            points = [PLANES[plane](x, y) for x, y in corners]
            mesh = readers.read_obj(files.obj(points, [range(len(points))]))
            numbers = array("I", bytes(mesh.triangles))
            areas = [
                area([corners[k] for k in numbers[i : i + 3]]) for i in range(0, len(numbers), 3)
            ]
            whole = area(corners)
            assert len(areas) == len(corners) - 2
            assert all(part * whole > 0 for part in areas)
            assert sum(areas) == whole


def test_a_face_may_name_corners_that_come_later():
    points = [(x, y, 0) for x, y in U]
    later = files.obj(points, [range(len(points))]).splitlines(keepends=True)
    mesh = readers.read_obj(b"".join([*later[8:], *later[:8]]))
    assert sorted(mesh.triangles) == sorted(readers.read_obj(b"".join(later)).triangles)


@pytest.mark.parametrize("shift", range(len(U)))
def test_a_rod_through_the_notch_of_a_sheet_is_apart(tmp_path, shift):
    sheet = [(x, y, 0) for x, y in U[shift:] + U[:shift]]
    (tmp_path / "sheet.obj").write_bytes(files.obj(sheet, [range(len(sheet))]))
    rod = [(x / 2 + 1.25, y + 1.5, z - 0.5) for x, y, z in files.CUBE_POINTS]
    (tmp_path / "rod.obj").write_bytes(files.obj(rod))
    (pair,) = check([tmp_path / "sheet.obj", tmp_path / "rod.obj"]).findings
    assert pair.relation == "separated"


@pytest.mark.parametrize("shift", range(len(U)))
def test_those_of_collada_are_cut_alike(tmp_path, shift):
    sheet = [(x, y, 0) for x, y in U[shift:] + U[:shift]]
    content = files.collada(points=sheet, faces=[range(len(sheet))])
    (tmp_path / "sheet.dae").write_bytes(content)
    (body,) = load_scene([tmp_path / "sheet.dae"]).bodies
    mesh = body.file.mesh
    cut = [[(x, y) for x, y, _ in mesh.corners(k)] for k in range(mesh.triangle_count)]
    assert sum(abs(area(triangle)) for triangle in cut) == abs(area(U))


def test_a_polygon_that_crosses_itself_keeps_all_its_corners():
    mesh = readers.read_obj(files.obj([(0, 0, 0), (2, 2, 0), (2, 0, 0), (0, 2, 0)], [range(4)]))
    assert set(array("I", bytes(mesh.triangles))) == {0, 1, 2, 3}


def test_thousands_of_corners():
    teeth = [(i, (i * 7919) % 97 + 1, 0) for i in range(3000)]
    comb = [*teeth, (2999, -1, 0), (0, -1, 0)]
    mesh = readers.read_obj(files.obj(comb, [range(len(comb))]))
    assert len(mesh.triangles) == 12 * (len(comb) - 2)
