"""decompose/error_bounds.py, missing: the bound holds what dense sampling finds, not much more."""

from __future__ import annotations

import numpy as np
import pytest

from satcheck.core import Mesh, Surface, deviation
from satcheck.decompose import decompose
from satcheck.decompose.components import diagonal, merged
from satcheck.decompose.error_bounds import missing_error
from tests.decompose.brute_force import solid_distance, surface_samples

STEPS = 4
ROUNDING = 1e-12


def stretched(box: Mesh, x: float, y: float, z: float) -> Mesh:
    return Mesh(np.asarray(box.vertices) * [x, y, z], np.asarray(box.triangles))


@pytest.mark.parametrize("name", ["torus", "l_shape", "u_shape"])
def test_the_bound_holds_what_sampling_finds(name: str, request: pytest.FixtureRequest) -> None:
    mesh: Mesh = request.getfixturevalue(name)
    result = decompose(mesh, threshold=0.1)
    points = surface_samples(mesh, STEPS)
    sampled = np.min([solid_distance(points, part.to_mesh()) for part in result.parts], axis=0)
    assert sampled.max() <= result.missing + ROUNDING
    assert result.missing <= 4.0 * sampled.max() + 1e-4 * diagonal(mesh)


@pytest.mark.parametrize("name", ["torus", "u_shape"])
def test_the_bound_holds_what_branch_and_bound_finds(
    name: str, request: pytest.FixtureRequest
) -> None:
    mesh: Mesh = request.getfixturevalue(name)
    result = decompose(mesh, threshold=0.2)
    union = Surface(merged([part.to_mesh() for part in result.parts]), True)
    lower = deviation(mesh, [union], 1e-3 * diagonal(mesh))[0]
    assert lower <= result.missing


def test_what_the_parts_lack_is_missing(l_shape: Mesh, box: Mesh) -> None:
    foot = stretched(box, 2.0, 1.0, 1.0).convex_hull()
    assert missing_error(l_shape, [foot]) == pytest.approx(1.0, rel=1e-9)  # the arm ends at y = 2


def test_a_slit_between_parts_is_half_its_width(l_shape: Mesh, box: Mesh) -> None:
    slit = 1e-3
    foot = stretched(box, 2.0, 1.0, 1.0).convex_hull()
    arm = stretched(box, 1.0, 1.0 - slit, 1.0).translated((0.0, 1.0 + slit, 0.0)).convex_hull()
    assert slit / 2.0 <= missing_error(l_shape, [foot, arm]) <= slit


@pytest.mark.parametrize("apart", [0.0, 1e8])
def test_parts_that_cover_everything_miss_nothing(l_shape: Mesh, box: Mesh, apart: float) -> None:
    offset = (apart, 0.0, -apart)
    foot = stretched(box, 2.0, 1.0, 1.0).translated(offset).convex_hull()
    arm = stretched(box, 1.0, 2.0, 1.0).translated(offset).convex_hull()
    assert missing_error(l_shape.translated(offset), [foot, arm]) <= 1e-6 + 1e-14 * apart
    hull = l_shape.convex_hull()
    assert missing_error(l_shape, [hull]) == 0.0


@pytest.mark.parametrize("exponent", [-60, 60])
def test_the_bound_scales_with_the_mesh(l_shape: Mesh, box: Mesh, exponent: int) -> None:
    def scaled(mesh: Mesh) -> Mesh:
        return Mesh(np.ldexp(np.asarray(mesh.vertices), exponent), np.asarray(mesh.triangles))

    foot = stretched(box, 2.0, 0.75, 1.0)
    here = missing_error(l_shape, [foot.convex_hull()])
    there = missing_error(scaled(l_shape), [scaled(foot).convex_hull()])
    assert there == pytest.approx(np.ldexp(here, exponent), rel=1e-12)
