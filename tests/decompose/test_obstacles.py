"""decompose/obstacles.py: what of a surface is inside a body, and how near."""

from __future__ import annotations

import numpy as np
import pytest

from satcheck.core import Mesh
from satcheck.decompose.half_spaces import HalfSpaces, around
from satcheck.decompose.obstacles import nearest_points, surface_inside


@pytest.fixture
def unit_box(box: Mesh) -> HalfSpaces:
    return around(np.asarray(box.vertices), np.asarray(box.triangles))


def area(triangles: np.ndarray) -> float:
    a, b, c = np.moveaxis(triangles, 1, 0)
    return float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2.0)


def test_a_large_triangle_is_clipped_to_the_cross_section(unit_box: HalfSpaces) -> None:
    triangle = np.array([[[-9.0, -9.0, 0.5], [9.0, -9.0, 0.5], [0.0, 9.0, 0.5]]])
    pieces = surface_inside(triangle, unit_box)
    assert area(pieces) == pytest.approx(1.0)
    assert (unit_box.slack(pieces.reshape(-1, 3)) > -1e-12).all()


def test_a_triangle_inside_is_kept_whole(unit_box: HalfSpaces) -> None:
    triangle = np.array([[[0.1, 0.1, 0.1], [0.9, 0.1, 0.2], [0.1, 0.8, 0.3]]])
    np.testing.assert_array_equal(surface_inside(triangle, unit_box), triangle)


@pytest.mark.parametrize(
    "triangle",
    [
        [[0.0, 0.0, 1.0], [1.0, 0.0, 1.0], [0.0, 1.0, 1.0]],  # on a face
        [[0.0, 0.0, 1.5], [1.0, 0.0, 1.5], [0.0, 1.0, 1.5]],  # above it
        [[1.2, -0.5, 0.5], [1.2, 0.5, 0.5], [3.0, 0.0, 0.5]],  # beside it
        [[2.0, 0.5, 0.5], [0.5, 2.0, 0.5], [2.0, 2.0, 0.5]],  # across a corner, outside
    ],
)
def test_what_does_not_enter_is_no_obstacle(
    unit_box: HalfSpaces, triangle: list[list[float]]
) -> None:
    assert surface_inside(np.array([triangle]), unit_box).shape == (0, 3, 3)


def test_nearest_points_match_dense_sampling() -> None:
    random = np.random.default_rng(2)
    triangles = random.normal(size=(200, 3, 3)) + random.normal(size=(200, 1, 3))
    grid = np.array([(i, j, 60 - i - j) for i in range(61) for j in range(61 - i)]) / 60.0
    sampled = np.linalg.norm(np.einsum("gc,tcx->tgx", grid, triangles), axis=2).min(axis=1)
    found = np.linalg.norm(nearest_points(triangles), axis=1)
    assert (found <= sampled + 1e-12).all()
    longest = np.linalg.norm(triangles - np.roll(triangles, 1, axis=1), axis=2).max(axis=1)
    assert (sampled - found <= longest / 60.0).all()


@pytest.mark.parametrize(
    ("triangle", "expected"),
    [
        ([[1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 0.0, 0.0]], [1.0, 0.0, 0.0]),  # a point
        ([[1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [1.0, 0.5, 0.0]], [1.0, 0.0, 0.0]),  # a segment
    ],
)
def test_degenerate_triangles_have_nearest_points(
    triangle: list[list[float]], expected: list[float]
) -> None:
    np.testing.assert_allclose(nearest_points(np.array([triangle]))[0], expected)
