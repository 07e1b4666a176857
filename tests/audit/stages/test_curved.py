"""The depth of curved shapes where the ladder ends below them."""

from __future__ import annotations

import math

import pytest

from satcheck.core.shapes import Box, Cylinder, Sphere
from tests.core.curved.bodies import ask, bracket, moved, shape, tilted

# Figures are sums and differences of coordinates below 8.
ROUNDING = 64 * 2.0**-50


@pytest.mark.parametrize("accuracy", ["aabb", "obb", "hull", "exact"])
def test_no_rung_claims_less_than_two_shapes_overlap(accuracy: str) -> None:
    ball = shape("ball", Sphere(1.0))
    post = shape("post", Cylinder(1.0, 3.0), moved(1.5, 0.2, 0.3))
    depth = 2.0 - math.hypot(1.5, 0.2)
    found = ask(ball, post, accuracy=accuracy)
    assert found.relation == "penetrating"
    assert found.depth_bounds is not None
    low, high = found.depth_bounds
    assert low - ROUNDING <= depth <= high + ROUNDING
    if found.mtv_verified:
        assert found.mtv is not None
        x, y, _ = found.mtv
        assert math.hypot(1.5 - x, 0.2 - y) >= 2.0 - ROUNDING


@pytest.mark.parametrize("accuracy", ["aabb", "exact"])
def test_a_shape_in_a_mesh_moves_off_its_face(accuracy: str) -> None:
    ball = shape("ball", Sphere(0.5), moved(3.0, 0.0, 1.25))
    found = ask(ball, bracket(), accuracy=accuracy)
    assert found.depth_bounds is not None
    assert found.depth_bounds[1] == pytest.approx(0.25, abs=ROUNDING)
    assert found.mtv_verified


@pytest.mark.parametrize("accuracy", ["aabb", "obb"])
def test_boxes_that_meet_have_a_depth_where_oriented_boxes_are_apart(accuracy: str) -> None:
    """A shape has no oriented box, so the meshes that stand for it are asked without."""
    slab = shape("slab", Box((1.0, 8.0, 1.0)), tilted(45.0, 0.0, 0.0, 0.0))
    ball = shape("ball", Sphere(0.5), moved(0.0, 2.5, -2.5))
    found = ask(ball, slab, accuracy=accuracy, tolerance=0.0)
    assert (found.relation, found.quality) == ("penetrating", "estimate")
    assert found.depth_bounds is not None
    assert found.depth_bounds[0] == 0.0
