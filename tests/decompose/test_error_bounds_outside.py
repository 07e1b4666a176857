"""decompose/error_bounds.py, outside: the bound holds what dense sampling finds, not much more."""

from __future__ import annotations

import numpy as np
import pytest

from satcheck.core import Mesh, Surface
from satcheck.decompose import decompose
from satcheck.decompose.components import diagonal
from satcheck.decompose.error_bounds import outside_error
from tests.decompose.brute_force import solid_distance, surface_samples

STEPS = 3
ROUNDING = 1e-12


@pytest.mark.parametrize("name", ["torus", "l_shape", "u_shape"])
def test_the_bound_holds_what_sampling_finds(name: str, request: pytest.FixtureRequest) -> None:
    mesh: Mesh = request.getfixturevalue(name)
    result = decompose(mesh, threshold=0.1)
    sampled = max(
        solid_distance(surface_samples(part.to_mesh(), STEPS), mesh).max() for part in result.parts
    )
    assert sampled <= result.outside + ROUNDING
    assert result.outside <= sampled + 0.01 * diagonal(mesh)


def test_the_hull_of_an_l_sticks_out_by_the_depth_of_its_corner(l_shape: Mesh) -> None:
    outside = outside_error([l_shape.convex_hull()], Surface(l_shape, True), 0.05)
    assert 0.5 <= outside <= 0.505  # from (1.5, 1.5) to the walls of the corner


def test_a_part_in_the_mesh_sticks_out_by_next_to_nothing(l_shape: Mesh, box: Mesh) -> None:
    assert outside_error([box.convex_hull()], Surface(l_shape, True), 0.05) < 1e-3


def test_without_an_inside_the_distance_is_to_the_surface(l_shape: Mesh, box: Mesh) -> None:
    kernel = Mesh(np.asarray(box.vertices) * 0.5 + 0.25, np.asarray(box.triangles)).convex_hull()
    # Farthest in the middle of its face x = 3/4: 1/2 from y = 0, z = 0 and z = 1.
    corners = np.asarray(l_shape.vertices)[np.asarray(l_shape.triangles)]
    away = np.linalg.norm(corners.mean(axis=1) - (0.75, 0.5, 0.5), axis=1)
    holed = Mesh(l_shape.vertices, np.delete(np.asarray(l_shape.triangles), away.argmax(), axis=0))
    assert outside_error([kernel], Surface(holed, False), 0.05) == pytest.approx(0.5, rel=0.02)
