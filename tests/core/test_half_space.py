"""Heights over a plane, exactly."""

from __future__ import annotations

import math
import random
from fractions import Fraction

import numpy as np
import pytest

from satcheck.core.half_space import (
    Plane,
    gap_of_planes,
    heights_of_points,
    heights_of_shape,
    plane_of,
)
from satcheck.core.shapes import (
    Capsule,
    Cone,
    Cylinder,
    Ellipsoid,
    Primitive,
    Sphere,
    image_of,
    support,
)

FLOOR = plane_of(None)


def at(x: float, y: float, z: float) -> tuple[float, ...]:
    return (1.0, 0.0, 0.0, x, 0.0, 1.0, 0.0, y, 0.0, 0.0, 1.0, z, 0.0, 0.0, 0.0, 1.0)


def tilted(rise: float, z: float = 0.0) -> tuple[float, ...]:
    """The plane through (0, 0, z) and (1, 0, z + rise): no rotation, but its image is a plane."""
    return (1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, rise, 0.0, 1.0, z, 0.0, 0.0, 0.0, 1.0)


def test_the_nearest_vertex_of_many_that_rounding_confuses() -> None:
    rng = random.Random(1)
    plane = plane_of(tilted(0.75))
    points = [[4 * k, float(k), 3 * k + 2.0**-50 * rng.randint(1, 99)] for k in range(50)]
    low, high = heights_of_points(plane, np.array(points))
    over = [(4 * Fraction(z) - 3 * Fraction(x)) / 5 for x, _, z in points]
    assert low.value == float(min(over))
    assert high.value == float(max(over))
    assert list(low.point) == points[over.index(min(over))]
    assert low.compare(low.value) == (min(over) > Fraction(low.value)) - (
        min(over) < Fraction(low.value)
    )


def test_a_height_without_a_rational_value() -> None:
    """1 / sqrt(2) over a plane of 45 degrees."""
    low, _ = heights_of_points(plane_of(tilted(1.0)), np.array([[0.0, 0.0, 1.0]]))
    assert low.value == math.sqrt(0.5)
    assert low.compare(math.sqrt(0.5)) == (
        1 if Fraction(math.sqrt(0.5)) ** 2 < Fraction(1, 2) else -1
    )
    assert low.compare(math.nextafter(math.sqrt(0.5), 1)) == -1


@pytest.mark.parametrize(
    "shape",
    [
        Sphere(0.5),
        Capsule(0.25, 2.0),
        Cylinder(0.5, 1.0),
        Cone(0.5, 1.0),
        Ellipsoid((1.0, 2.0, 0.5)),
    ],
)
def test_a_shape_rests_on_the_floor(shape: Primitive) -> None:
    down, up = support(shape, (0.0, 0.0, -1.0)), support(shape, (0.0, 0.0, 1.0))
    low, high = heights_of_shape(FLOOR, image_of(shape, at(3.0, -2.0, down)))
    assert low.compare(0.0) == 0
    assert low.value == 0.0
    assert low.point[2] == 0.0
    assert high.value == up + down
    lifted, _ = heights_of_shape(FLOOR, image_of(shape, at(3.0, -2.0, math.nextafter(down, 9))))
    assert lifted.compare(0.0) == 1


def test_a_sphere_touches_a_tilted_plane_exactly() -> None:
    """The normal is (-3, 0, 4) / 5: a centre 5 / 4 r above the plane touches it."""
    plane = plane_of(tilted(0.75))
    for centre, sign in ((1.25, 0), (math.nextafter(1.25, 2), 1), (math.nextafter(1.25, 1), -1)):
        low, _ = heights_of_shape(plane, image_of(Sphere(1.0), at(0.0, 0.0, centre)))
        assert low.compare(0.0) == sign
    low, _ = heights_of_shape(plane, image_of(Sphere(1.0), at(0.0, 0.0, 2.5)))
    assert low.value == 1.0
    assert low.compare(1.0) == 0
    assert low.point == pytest.approx((0.6, 0.0, 1.7), abs=1e-15)


def test_a_cylinder_on_its_edge() -> None:
    """Its support value has a square root, and so has the length of the normal."""
    rng = random.Random(3)
    for _ in range(50):
        rise, height = rng.uniform(-2, 2), rng.uniform(2, 9)
        plane = plane_of(tilted(rise))
        low, high = heights_of_shape(plane, image_of(Cylinder(1.0, 1.0), at(0.0, 0.0, height)))
        length = math.hypot(rise, 1.0)
        reach = (abs(rise) + 0.5) / length
        assert low.value == pytest.approx(height / length - reach, abs=4e-15)
        assert high.value == pytest.approx(height / length + reach, abs=4e-15)


def test_a_mirrored_placement_keeps_the_side() -> None:
    matrix = (-1.0, *at(0.0, 0.0, 0.0)[1:])
    assert plane_of(matrix).unit == (0.0, 0.0, 1.0)
    flipped = (*at(0.0, 0.0, 0.0)[:10], -1.0, *at(0.0, 0.0, 0.0)[11:])
    assert plane_of(flipped).unit == (0.0, 0.0, -1.0)


def test_a_flattened_placement_has_no_plane() -> None:
    flat = (*at(0.0, 0.0, 0.0)[:10], 0.0, *at(0.0, 0.0, 0.0)[11:])
    with pytest.raises(ValueError, match="no boundary plane"):
        plane_of(flat)


def test_two_planes() -> None:
    floor, zero = FLOOR, (Fraction(0),) * 3

    def ceiling(z: float) -> Plane:
        return Plane((zero[0], zero[1], Fraction(z)), (zero[0], zero[1], Fraction(-2)))

    assert gap_of_planes(floor, ceiling(1.0)) == 1
    assert gap_of_planes(ceiling(1.0), floor) == 1
    assert gap_of_planes(floor, ceiling(0.0)) == 0
    assert gap_of_planes(floor, ceiling(-1.0)) == -1
    assert gap_of_planes(floor, floor) is None
    assert gap_of_planes(floor, plane_of(tilted(1e-300))) is None
