"""Lengths compared exactly with distances and depths of shapes and surfaces."""

from __future__ import annotations

import math

import numpy as np
import pytest

from satcheck import core
from satcheck.core import Box, Capsule, Cylinder, Sphere

CUBE = Box((1.0, 1.0, 1.0))


@pytest.mark.parametrize(
    ("a", "b", "place", "distance"),
    [
        (CUBE, Sphere(0.5), (4.0, 5.0, 0.25), 4.5),  # over an edge
        (CUBE, Sphere(0.5), (3.0, 4.0, 7.0), 6.5),  # off a corner
        (CUBE, Sphere(0.5), (1.25, 0.0, 0.0), -0.25),  # its centre outside
        (CUBE, Sphere(0.5), (0.75, 0.0, 0.0), -0.75),  # its centre inside
        (CUBE, Sphere(0.5), (1.0, 0.25, 0.0), -0.5),  # its centre on the surface
        (Sphere(1.0), Sphere(2.0), (2.0, 3.0, 6.0), 4.0),
        (Capsule(0.5, 1.0), CUBE, (4.0, 5.0, 0.0), 4.5),
        (CUBE, CUBE, (1.5, 0.0, 1.25), -0.5),
        (CUBE, CUBE, (5.0, 6.0, 0.0), 5.0),
    ],
)
def test_the_side_of_a_signed_distance(
    a: core.Shape, b: core.Shape, place: tuple[float, float, float], distance: float
) -> None:
    back = (-place[0], -place[1], -place[2])
    for length, side in (
        (distance, 0),
        (math.nextafter(distance, math.inf), -1),
        (math.nextafter(distance, -math.inf), 1),
    ):
        assert core.compare_signed_distance(a, b, length, pose_b=place) == side
        assert core.compare_signed_distance(b, a, length, pose_b=back) == side


def test_other_curved_shapes_are_not_compared() -> None:
    assert core.compare_signed_distance(Cylinder(1.0, 1.0), CUBE, 0.5, pose_b=(9.0, 0, 0)) is None


def test_a_length_is_finite() -> None:
    with pytest.raises(ValueError, match="finite"):
        core.compare_signed_distance(CUBE, CUBE, math.inf)


def test_a_move_is_as_long_as_its_rounding_makes_it() -> None:
    points = np.array([(0.0, 0, 0), (1, 0, 0), (0, 1, 0)])
    mesh = core.Mesh(points, np.array([[0, 1, 2]], dtype=np.uint32))
    step = math.ulp(1.0)
    assert core.moves_within(mesh, (3 * step, 4 * step, 0.0), 5 * step)
    assert not core.moves_within(mesh, (3 * step, 4 * step, 0.0), math.nextafter(5 * step, 0.0))
    assert not core.moves_within(mesh, (step / 2, 0.0, 0.0), step / 2)  # 1 + step / 2 is 1
    assert core.moves_within(mesh, (step / 2, 0.0, 0.0), 2 * step)
