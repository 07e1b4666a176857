"""decompose/inner_parts.py, regions: large, in the part, free of the surface but for rounding."""

from __future__ import annotations

import numpy as np
import pytest

from satcheck.core import Mesh, Polytope, Surface
from satcheck.decompose.inner_parts import free_region


def volume(polytope: Polytope) -> float:
    return polytope.to_mesh().topology().volume


def depth_in(body: Polytope, point: tuple[float, float, float]) -> float:
    surface = Surface(body.to_mesh(), True)
    distance, _ = surface.nearest(point)
    return distance if surface.winding_number(point) == 1 else -distance


def test_the_hull_of_an_l_becomes_a_body_inside_the_l(l_shape: Mesh) -> None:
    region = free_region(l_shape.convex_hull(), Surface(l_shape, True))
    assert region is not None
    assert volume(region) > 1.5  # the L has 3, the largest box in it 2
    assert all(depth_in(region, (1.0, 1.0, z)) < 1e-6 for z in (0.0, 0.5, 1.0))  # the inner edge
    assert all(depth_in(l_shape.convex_hull(), p) > -1e-6 for p in region.vertices.tolist())


def test_a_part_that_the_surface_does_not_enter_is_filled(l_shape: Mesh, box: Mesh) -> None:
    foot = Mesh(np.asarray(box.vertices) * [2.0, 1.0, 1.0], np.asarray(box.triangles))
    region = free_region(foot.convex_hull(), Surface(l_shape, True))
    assert region is not None
    assert volume(region) == pytest.approx(2.0)


def test_a_part_outside_the_mesh_has_none(l_shape: Mesh, box: Mesh) -> None:
    part = box.translated((1.5, 1.5, 0.0)).convex_hull()
    assert free_region(part, Surface(l_shape, True)) is None


@pytest.mark.parametrize("exponent", [-140, -30, 30, 140])
def test_the_region_scales_with_the_mesh(l_shape: Mesh, exponent: int) -> None:
    def scaled(mesh: Mesh) -> Mesh:
        return Mesh(np.ldexp(np.asarray(mesh.vertices), exponent), np.asarray(mesh.triangles))

    here = free_region(l_shape.convex_hull(), Surface(l_shape, True))
    there = free_region(scaled(l_shape).convex_hull(), Surface(scaled(l_shape), True))
    assert here is not None
    assert there is not None
    np.testing.assert_allclose(
        np.ldexp(np.asarray(there.vertices), -exponent), np.asarray(here.vertices), atol=1e-9
    )
