"""Which of two bodies holds which, where their borders meet to the last digit."""

from __future__ import annotations

import math

import pytest

from satcheck.core.curved.nesting import box_holds
from satcheck.core.shapes import Box, Cylinder, Primitive, Sphere
from satcheck.scene import Body
from tests.core.curved.bodies import ask, moved, shape

LESS, MORE = math.nextafter(0.75, 0.0), math.nextafter(0.75, 1.0)


def relations(a: Body, b: Body) -> tuple[str | None, str | None]:
    return ask(a, b).exact_relation, ask(b, a).exact_relation


@pytest.mark.parametrize(
    ("outer", "inner"),
    [
        (Box((2.0, 2.0, 2.0)), Cylinder(0.5, 0.5)),
        (Cylinder(2.0, 2.0), Box((0.5, 0.5, 0.5))),
    ],
)
@pytest.mark.parametrize(
    ("z", "found"),
    [
        (0.75, ("penetrating", "penetrating")),
        (LESS, ("contains", "inside")),
        (MORE, ("penetrating", "penetrating")),
    ],
)
def test_flush_with_a_face_from_within(
    outer: Primitive, inner: Primitive, z: float, found: tuple[str, str]
) -> None:
    assert relations(shape("o", outer), shape("i", inner, moved(0.0, 0.0, z))) == found


def test_a_ball_that_fits_a_box() -> None:
    """It touches all six faces; half a box more on one side, and it still does the other four."""
    ball = shape("ball", Sphere(0.5))
    assert relations(shape("box", Box((1.0, 1.0, 1.0))), ball) == ("penetrating", "penetrating")
    wide = shape("box", Box((1.5, 1.5, math.nextafter(1.0, 2.0))))
    assert relations(wide, ball) == ("contains", "inside")


def test_a_can_in_a_can() -> None:
    outer = shape("o", Cylinder(2.0, 2.0))
    flush = shape("i", Cylinder(0.5, 0.5), moved(0.0, 0.0, 0.75))
    assert relations(outer, flush) == ("penetrating", "penetrating")


def test_the_same_can_twice_is_not_said_to_stick_out() -> None:
    a, b = shape("a", Cylinder(1.0, 1.0)), shape("b", Cylinder(1.0, 1.0))
    assert relations(a, b) == (None, None)


def test_a_closed_box_holds_itself() -> None:
    unit = ((0.0, 0.0, 0.0), (1.0, 1.0, 1.0))
    assert box_holds(unit, unit)
    assert box_holds(unit, ((0.5, 0.5, 0.5), (1.0, 0.6, 0.6)))
    assert not box_holds(unit, ((0.5, 0.5, 0.5), (1.1, 0.6, 0.6)))
