"""decompose/measure.py: the reported errors bound what dense sampling finds, and not by much."""

from __future__ import annotations

import numpy as np
import pytest

from satcheck.core import Mesh, Polytope, Surface
from satcheck.decompose import decompose
from satcheck.decompose.components import diagonal
from satcheck.decompose.measure import missing_error, outside_error
from tests.decompose.brute_force import solid_distance, surface_samples

STEPS = 3


def stretched(box: Mesh, x: float, y: float, z: float) -> Mesh:
    return Mesh(np.asarray(box.vertices) * [x, y, z], np.asarray(box.triangles))


@pytest.mark.parametrize("name", ["torus", "l_shape", "u_shape"])
def test_errors_bound_what_sampling_finds(name: str, request: pytest.FixtureRequest) -> None:
    mesh: Mesh = request.getfixturevalue(name)
    result = decompose(mesh, threshold=0.1)
    outside = max(
        solid_distance(surface_samples(part.to_mesh(), STEPS), mesh).max() for part in result.parts
    )
    on_mesh = surface_samples(mesh, STEPS)
    missing = np.min([solid_distance(on_mesh, p.to_mesh()) for p in result.parts], axis=0).max()
    rounding = 1e-12
    assert outside <= result.outside + rounding
    assert missing <= result.missing + rounding
    size = diagonal(mesh)
    assert result.outside <= outside + 0.01 * size
    assert result.missing <= missing + 0.0011 * size


def test_the_hull_of_an_l_sticks_out_by_the_depth_of_its_corner(l_shape: Mesh) -> None:
    hull = l_shape.convex_hull()
    outside = outside_error([hull], Surface(l_shape, True), 0.05)
    assert 0.5 <= outside <= 0.505  # from (1.5, 1.5) to the walls of the corner
    assert missing_error(l_shape, [hull]) == pytest.approx(0.0, abs=3e-3)


def test_what_the_parts_lack_is_missing(l_shape: Mesh, box: Mesh) -> None:
    foot: Polytope = stretched(box, 2.0, 1.0, 1.0).convex_hull()
    missing = missing_error(l_shape, [foot])
    assert 1.0 <= missing <= 1.003  # the arm ends at y = 2
    assert outside_error([foot], Surface(l_shape, True), 0.05) == pytest.approx(0.0, abs=0.004)


def test_overlapping_parts_hide_nothing(l_shape: Mesh, box: Mesh) -> None:
    parts = [
        stretched(box, 2.0, 1.0, 1.0).convex_hull(),
        stretched(box, 1.0, 2.0, 1.0).convex_hull(),
    ]
    assert missing_error(l_shape, parts) == pytest.approx(0.0, abs=3e-3)
