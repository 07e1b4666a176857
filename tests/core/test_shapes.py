"""Shapes by their sizes."""

from __future__ import annotations

import math
from typing import Any

import pytest
from msgspec import ValidationError, convert

from satcheck.core.shapes import (
    Box,
    Capsule,
    Cone,
    Cylinder,
    Ellipsoid,
    Primitive,
    Sphere,
    is_curved,
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
    assert convert(values_of(shape), Primitive) == shape


def test_whole_numbers_state_the_same_shape() -> None:
    assert values_of(Box((1, 2, 3))) == values_of(BOX) == {"type": "box", "size": (1.0, 2.0, 3.0)}
    assert Box((1, 2, 3)) == BOX


# Each with what the message says.
WRONG: dict[str, tuple[object, str]] = {
    "no object": ("box", "object"),
    "type": ({"type": "cube"}, "cube"),
    "no type": ({}, "type"),
    "missing": ({"type": "capsule", "radius": 1.0}, "length"),
    "foreign": ({"type": "sphere", "radius": 1.0, "height": 2.0}, "height"),
    "two": ({"type": "box", "size": [1.0, 2.0]}, r"\$.size"),
    "scalar": ({"type": "box", "size": 1.0}, r"\$.size"),
    "list": ({"type": "sphere", "radius": [1.0]}, r"\$.radius"),
    "huge": ({"type": "sphere", "radius": 10**400}, r"\$.radius"),
    "zero": ({"type": "sphere", "radius": 0.0}, r"\$.radius"),
    "negative": ({"type": "box", "size": [1.0, -1.0, 1.0]}, r"\$.size\[1\]"),
    "infinite": ({"type": "cone", "radius": 1.0, "height": math.inf}, "height should be positive"),
    "nan": ({"type": "cone", "radius": math.nan, "height": 1.0}, r"\$.radius"),
    "text": ({"type": "sphere", "radius": "1"}, r"\$.radius"),
    "true": ({"type": "sphere", "radius": True}, r"\$.radius"),
}


@pytest.mark.parametrize("name", WRONG)
def test_what_states_no_shape_is_refused(name: str) -> None:
    values, message = WRONG[name]
    with pytest.raises(ValidationError, match=message):
        convert(values, Primitive)


@pytest.mark.parametrize(
    "size", [(1.0, 2.0), 1.0, (1.0, 0.0, 1.0), (1.0, math.inf, 1.0), ("1",) * 3]
)
def test_a_box_of_no_size_is_refused(size: Any) -> None:
    with pytest.raises(ValueError, match="size should"):
        Box(size)
