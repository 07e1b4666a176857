"""Regions in a plane, exact signs there, and prisms: closed, and as wound as their triangles."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest

from satcheck.core import Mesh, Surface
from satcheck.core.shape_mesh import mesh_of
from satcheck.core.shapes import Box
from satcheck.scene.planar.region import convex_corners, prism, region_of, turns
from tests.scene.planar.flat import sheet

L_SHAPE = [(0.0, 0.0), (2.0, 0.0), (2.0, 1.0), (1.0, 1.0), (1.0, 2.0), (0.0, 2.0)]


def area(mesh: Mesh, solid: bool, plane: str) -> float:
    region = region_of(mesh, solid, plane)  # type: ignore[arg-type]
    a, b, c = (region.points[region.triangles[:, k]] for k in range(3))
    cross = (b[:, 0] - a[:, 0]) * (c[:, 1] - a[:, 1]) - (b[:, 1] - a[:, 1]) * (c[:, 0] - a[:, 0])
    assert (cross > 0).all()
    return float(cross.sum() / 2)


def test_a_solid_is_seen_by_its_near_side_alone() -> None:
    box = mesh_of(Box((1.0, 2.0, 4.0)))
    assert [area(box, True, plane) for plane in ("xy", "yz", "xz")] == [2.0, 8.0, 4.0]
    assert area(box, False, "xy") == 4.0  # both sides, which cover the same


def test_triangles_seen_edge_on_are_left_out() -> None:
    flat = sheet([(0.0, 0.0), (1.0, 0.0), (1.0, 1.0)])
    assert len(region_of(flat, False, "xz").triangles) == 0


def test_convex_corners_of_what_is_convex_only() -> None:
    box = mesh_of(Box((1.0, 2.0, 4.0)))
    corners = convex_corners(region_of(box, True, "yz"))
    assert corners is not None
    assert sorted(map(tuple, corners.tolist())) == [(-1, -2), (-1, 2), (1, -2), (1, 2)]
    bent = sheet(L_SHAPE, [(0, 1, 2), (0, 2, 3), (0, 3, 5), (3, 4, 5)])
    assert convex_corners(region_of(bent, False, "xy")) is None


def test_a_region_covered_twice_is_not_taken_for_convex() -> None:
    """Two triangles, one over part of the other: the same hull, another multiplicity."""
    twice = sheet([(0.0, 0.0), (4.0, 0.0), (0.0, 4.0), (1.0, 1.0)], [(0, 1, 2), (0, 1, 3)])
    assert convex_corners(region_of(twice, False, "xy")) is None


def test_a_spike_without_area_adds_no_corner() -> None:
    """From a corner of a triangle to a point outside of it, and back."""
    spiked = sheet([(0.0, 0.0), (2.0, 0.0), (0.0, 2.0), (-3.0, 2.0)], [(0, 1, 2), (2, 3, 2)])
    corners = convex_corners(region_of(spiked, False, "xy"))
    assert corners is not None
    assert sorted(map(tuple, corners.tolist())) == [(0, 0), (0, 2), (2, 0)]


def test_points_that_coincide_in_the_plane_are_one() -> None:
    box = mesh_of(Box((1.0, 1.0, 1.0)))
    assert len(region_of(box, True, "xy").points) == 4
    assert not np.signbit(region_of(box, True, "xy").points[0][0] * 0.0 + 0.0)


SQUARE = np.array([(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0)])
HALVES = np.array([(0, 1, 2), (0, 2, 3)])


def winding(points: np.ndarray, triangles: np.ndarray, x: float, y: float) -> int | None:
    return Surface(prism(points, triangles, 8.0).welded(), True).winding_number((x, y, 3.0))


def test_a_square() -> None:
    mesh = prism(SQUARE, HALVES, 8.0).welded()
    assert mesh.topology().solid
    assert mesh.topology().volume == 4 * 4 * 16
    assert mesh.bounds == ((0.0, 0.0, -8.0), (4.0, 4.0, 8.0))


def test_winding_numbers_add_up() -> None:
    points = np.concatenate((SQUARE, SQUARE / 2))
    inner = HALVES + 4
    over = np.concatenate((HALVES, inner))
    hole = np.concatenate((HALVES, inner[:, ::-1]))
    assert [winding(points, over, x, 1.5) for x in (1.0, 3.0, 5.0)] == [2, 1, 0]
    assert [winding(points, hole, x, 1.5) for x in (1.0, 3.0, 5.0)] == [0, 1, 0]


def test_no_wall_between_neighbours() -> None:
    assert prism(SQUARE, HALVES, 8.0).triangle_count == 2 * 2 + 4 * 2


TRIANGLE = np.array([[0, 1, 2]])


@pytest.mark.parametrize("scale", [1.0, 2.0**-500, 2.0**500, 5e-324 * 2**60])
def test_signs(scale: float) -> None:
    points = np.array([(0.0, 0.0), (1.0, 0.0), (0.5, 1.0)]) * scale
    assert turns(points, TRIANGLE).tolist() == [1]
    assert turns(points, TRIANGLE[:, ::-1]).tolist() == [-1]
    assert turns(np.array([(0.0, 0.0), (1.0, 1.0), (3.0, 3.0)]) * scale, TRIANGLE).tolist() == [0]


def test_one_unit_in_the_last_place_decides() -> None:
    """Corners on a line through three floats, one of them a single step off it."""
    rng = np.random.default_rng(7)
    for _ in range(200):
        start, step = rng.uniform(-1, 1, 2), rng.uniform(-1, 1, 2)
        points = np.array([start, start + step, start + 2 * step])
        points[2, 1] = np.nextafter(points[2, 1], rng.choice([-np.inf, np.inf]))
        exact = [[Fraction(x) for x in p] for p in points.tolist()]
        (ax, ay), (bx, by), (cx, cy) = exact
        value = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
        assert turns(points, TRIANGLE).tolist() == [(value > 0) - (value < 0)]
