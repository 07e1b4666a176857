"""Rotations: exact quarters, right-handed, one rotation however it is written."""

from __future__ import annotations

import math

import pytest

from satcheck.core.transform import (
    about,
    about_fixed_axes,
    compose,
    cos_sin,
    placed,
    quaternion_matrix,
)

# Roundings of an entry: sine, cosine, axis and nine products.
ERROR = 32 * 2.0**-53
HALF = math.sqrt(0.5)
QUARTER_ABOUT_Z = (0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0)


@pytest.mark.parametrize(
    ("degrees", "expected"),
    [(90, (0, 1)), (180, (-1, 0)), (270, (0, -1)), (-90, (0, -1)), (450, (0, 1)), (-180, (-1, 0))],
)
def test_quarters_are_exact(degrees: float, expected: tuple[float, float]) -> None:
    assert cos_sin(degrees) == expected


@pytest.mark.parametrize("degrees", [1.0, 44.9, 45.0, 45.1, 134.0, 226.0, 359.0, -1.0, -200.0])
def test_against_the_library(degrees: float) -> None:
    cosine, sine = cos_sin(degrees)
    assert abs(cosine - math.cos(math.radians(degrees))) <= ERROR
    assert abs(sine - math.sin(math.radians(degrees))) <= ERROR


@pytest.mark.parametrize("length", [1.0, 3.0, 1e-200, 1e200])
def test_a_quarter_turn_is_exact_however_it_is_written(length: float) -> None:
    assert quaternion_matrix(0.0, 0.0, HALF * length, HALF * length) == QUARTER_ABOUT_Z
    assert about((0.0, 0.0, 1.0), cos_sin(90.0)) == QUARTER_ABOUT_Z
    assert about_fixed_axes(cos_sin(0.0), cos_sin(0.0), cos_sin(90.0)) == QUARTER_ABOUT_Z


@pytest.mark.parametrize("degrees", [10.0, 123.0, -77.0])
def test_about_an_axis_as_the_quaternion_says(degrees: float) -> None:
    axis = (2 / 7, 3 / 7, 6 / 7)
    cosine, sine = cos_sin(degrees / 2)
    x, y, z = (sine * c for c in axis)
    assert quaternion_matrix(x, y, z, cosine) == pytest.approx(
        about(axis, cos_sin(degrees)), abs=ERROR
    )


def test_fixed_axes_in_their_order() -> None:
    x, y, z = cos_sin(20.0), cos_sin(-35.0), cos_sin(130.0)
    axes = [(1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)]
    roll, pitch, yaw = (
        placed(about(axis, angle), (0.0, 0.0, 0.0))
        for axis, angle in zip(axes, (x, y, z), strict=True)
    )
    expected = compose(yaw, compose(pitch, roll))
    turned = placed(about_fixed_axes(x, y, z), (0.0, 0.0, 0.0))
    assert turned == pytest.approx(expected, abs=ERROR)


def test_the_inner_placement_comes_first() -> None:
    quarter = placed(QUARTER_ABOUT_Z, (0.0, 0.0, 0.0))
    shift = placed((1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0), (1.0, 2.0, 3.0))
    assert compose(quarter, shift)[3:12:4] == (-2.0, 1.0, 3.0)
    assert compose(shift, quarter)[3:12:4] == (1.0, 2.0, 3.0)
