"""What meshes cover, seen along an axis."""

from __future__ import annotations

import numpy as np

from satcheck.core import Mesh
from satcheck.core.shape_mesh import mesh_of
from satcheck.core.shapes import Box
from satcheck.scene.planar.region import convex_corners, region_of
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
