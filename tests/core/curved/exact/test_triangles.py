"""Curved shapes that stand flush on a mesh which is not convex, or in one."""

from __future__ import annotations

import math

import pytest

from satcheck.core.shapes import Capsule, Cone, Cylinder, Ellipsoid, Primitive, Sphere
from tests.core.curved.bodies import ask, bracket, hollow_box, shape
from tests.core.curved.exact.contacts import ACROSS, LYING, UPRIGHT, UPSIDE_DOWN, Columns

# On the lower arm of the bracket, whose top is z = 1 and ends at x = 4: how high above it the
# centre is, and how far out it still touches.
STANDING: tuple[tuple[Primitive, Columns, float, float], ...] = (
    (Cylinder(0.5, 1.0), UPRIGHT, 0.5, 4.5),
    (Cylinder(0.5, 20.0), ACROSS, 0.5, 4.0),
    (Cone(0.5, 1.0), UPRIGHT, 0.5, 4.5),
    (Cone(0.5, 1.0), UPSIDE_DOWN, 0.5, 4.0),
    (Ellipsoid((0.5, 1.0, 0.25)), UPRIGHT, 0.25, 4.0),
    (Capsule(0.25, 1.0), LYING, 0.25, 4.5),
    (Sphere(0.25), UPRIGHT, 0.25, 4.0),
)
# Bounds of spheres are as wide as float64 rounds; coordinates are below 8.
ROUNDING = 64 * 2.0**-50


def turned(columns: Columns, x: float, y: float, z: float) -> tuple[float, ...]:
    rows = [[*(float(column[k]) for column in columns), (x, y, z)[k]] for k in range(3)]
    return (*rows[0], *rows[1], *rows[2], 0.0, 0.0, 0.0, 1.0)


@pytest.mark.parametrize(("primitive", "columns", "height", "most"), STANDING)
def test_flush_on_a_concave_mesh(
    primitive: Primitive, columns: Columns, height: float, most: float
) -> None:
    top = 1.0 + height
    for z, relation in (
        (top, "touching"),
        (math.nextafter(top, 3.0), "separated"),
        (math.nextafter(top, 0.0), "penetrating"),
    ):
        body = shape("a", primitive, turned(columns, 2.25, 0.25, z))
        for pair in ((body, bracket()), (bracket(), body)):
            found = ask(*pair, tolerance=0.0, budget=0.1)
            assert found.exact_relation == relation
            if relation == "penetrating":
                assert found.mtv_verified
                assert found.depth_bounds is not None
                assert found.depth_bounds[0] <= top - z <= found.depth_bounds[1] < ROUNDING
            else:
                assert (found.relation, found.quality) == (relation, "exact")
            within = ask(*pair, depth=False, tolerance=1e-12)
            assert (within.relation, within.exact_relation) == ("touching", relation)
    for x, relation in ((most, "touching"), (math.nextafter(most, 5.0), "separated")):
        body = shape("a", primitive, turned(columns, x, 0.25, top))
        assert ask(body, bracket(), tolerance=0.0).exact_relation == relation


def test_in_the_notch() -> None:
    """A can that stands in it touches two walls; within one ulp of the upright one it is free."""
    can = Cylinder(0.5, 1.0)
    at = turned(UPRIGHT, 1.5, 0.0, 1.5)
    assert ask(shape("a", can, at), bracket(), tolerance=0.0).exact_relation == "touching"
    into = turned(UPRIGHT, math.nextafter(1.5, 0.0), 0.0, 1.5)
    assert ask(shape("a", can, into), bracket(), tolerance=0.0).exact_relation == "penetrating"


def test_flush_from_within() -> None:
    """The walls are 1 thick: what fills them from one side to the other is not inside."""
    wall = shape("a", Cylinder(0.25, 1.0), turned(LYING, 1.5, 0.0, 0.0))
    found = ask(wall, hollow_box())
    assert (found.relation, found.exact_relation) == ("penetrating", "penetrating")
    thinner = shape("a", Cylinder(0.25, math.nextafter(1.0, 0.0)), turned(LYING, 1.5, 0.0, 0.0))
    assert ask(thinner, hollow_box()).exact_relation == "inside"
