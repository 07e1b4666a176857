"""decompose/half_spaces.py: from a body to its planes and back."""

from __future__ import annotations

import numpy as np
import pytest

from satcheck.core import Mesh
from satcheck.decompose.half_spaces import HalfSpaces, around, points_as_mesh, vertices_of


def half_spaces_of(mesh: Mesh) -> HalfSpaces:
    hull = mesh.convex_hull()
    return around(np.asarray(hull.vertices), np.asarray(hull.triangles))


def test_a_box_comes_back_from_its_planes(box: Mesh) -> None:
    vertices = vertices_of(half_spaces_of(box), np.array([0.5, 0.5, 0.5]))
    expected = np.unique(np.asarray(box.vertices), axis=0)
    hull = points_as_mesh(vertices).convex_hull()
    np.testing.assert_allclose(
        np.unique(np.round(np.asarray(hull.vertices), 12), axis=0), expected, atol=1e-12
    )


def test_a_start_outside_the_body_is_good_enough(box: Mesh) -> None:
    vertices = vertices_of(half_spaces_of(box), np.array([1.4, 0.5, -0.3]))
    assert points_as_mesh(vertices).convex_hull().to_mesh().topology().volume == pytest.approx(1.0)


def test_a_random_polytope_keeps_its_volume() -> None:
    points = np.random.default_rng(1).normal(size=(60, 3))
    mesh = points_as_mesh(points)
    vertices = vertices_of(half_spaces_of(mesh), points.mean(axis=0))
    volume = points_as_mesh(vertices).convex_hull().to_mesh().topology().volume
    assert volume == pytest.approx(mesh.convex_hull().to_mesh().topology().volume, rel=1e-9)


def test_slack_is_positive_inside(box: Mesh) -> None:
    body = half_spaces_of(box)
    inside, outside = body.slack(np.array([[0.5, 0.5, 0.25], [0.5, 0.5, 1.5]]))
    assert inside.min() == pytest.approx(0.25)
    assert outside.min() == pytest.approx(-0.5)


def test_planes_without_a_common_inner_point_have_no_vertices(box: Mesh) -> None:
    body = half_spaces_of(box).cut(np.array([[1.0, 0.0, 0.0]]), np.array([-0.1]))
    assert vertices_of(body, np.array([0.5, 0.5, 0.5])).shape == (0, 3)
