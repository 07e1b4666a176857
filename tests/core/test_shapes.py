"""Shapes by their sizes."""

from __future__ import annotations

import math

import pytest

from satcheck.core.shapes import (
    Box,
    Capsule,
    Cone,
    Cylinder,
    Ellipsoid,
    Primitive,
    Sphere,
    is_curved,
    primitive_of,
    support,
    values_of,
)

BOX = Box((1.0, 2.0, 3.0))
CURVED = (
    Sphere(0.3),
    Capsule(0.3, 1.1),
    Cylinder(0.7, 1.3),
    Cone(1.1, 3.0),
    Ellipsoid((1.0, 2.0, 0.7)),
)
SHAPES = (BOX, *CURVED)


def test_all_but_the_box_are_curved() -> None:
    assert [is_curved(shape) for shape in SHAPES] == [False, *[True] * len(CURVED)]


def test_the_support_of_a_box_is_its_farthest_corner() -> None:
    assert support(BOX, (1.0, -2.0, 3.0)) == 0.5 * (1.0 + 4.0 + 9.0)


@pytest.mark.parametrize("shape", SHAPES, ids=str)
def test_values_are_those_of_a_scene_file(shape: Primitive) -> None:
    assert primitive_of(values_of(shape)) == shape


def test_whole_numbers_state_the_same_shape() -> None:
    assert values_of(Box((1, 2, 3))) == values_of(BOX) == {"type": "box", "size": (1.0, 2.0, 3.0)}
    assert Box((1, 2, 3)) == BOX


WRONG: dict[str, tuple[object, str]] = {
    "no object": ("box", "not a shape"),
    "type": ({"type": "cube"}, "type should be one of box, sphere"),
    "no type": ({}, "not None"),
    "missing": ({"type": "capsule", "radius": 1.0}, "radius and length, not radius"),
    "foreign": ({"type": "sphere", "radius": 1.0, "height": 2.0}, "a sphere has radius, not"),
    "two": ({"type": "box", "size": [1.0, 2.0]}, "size should be three numbers"),
    "scalar": ({"type": "box", "size": 1.0}, "size should be three numbers"),
    "list": ({"type": "sphere", "radius": [1.0]}, "radius should be a number"),
    "huge": ({"type": "sphere", "radius": 10**400}, "radius should be positive and finite"),
    "zero": ({"type": "sphere", "radius": 0.0}, "radius should be positive and finite"),
    "negative": ({"type": "box", "size": [1.0, -1.0, 1.0]}, "size should be positive and finite"),
    "infinite": ({"type": "cone", "radius": 1.0, "height": math.inf}, "height should be positive"),
    "nan": ({"type": "cone", "radius": math.nan, "height": 1.0}, "radius should be positive"),
    "text": ({"type": "sphere", "radius": "1"}, "should contain only numbers"),
    "true": ({"type": "sphere", "radius": True}, "should contain only numbers"),
}


@pytest.mark.parametrize("name", WRONG)
def test_what_states_no_shape_is_refused(name: str) -> None:
    values, message = WRONG[name]
    with pytest.raises(ValueError, match=message):
        primitive_of(values)
