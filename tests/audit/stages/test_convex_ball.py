"""Balls in two convex bodies: known ones, and against the search for the thickness."""

from __future__ import annotations

import math

import numpy as np
import pytest

from satcheck import core
from satcheck.audit.stages.convex_ball import holds_thicker_ball
from tests.audit.shapes import box

Polytope = core.Polytope


def hull(points: object) -> Polytope:
    faces = np.array([[0, 1, 2]], dtype=np.uint32)
    return core.Mesh(np.array(points, dtype=np.float64), faces).convex_hull()


def down(x: float) -> float:
    return math.nextafter(x, -math.inf)


@pytest.mark.parametrize("thick", [0.5, 2.0**-40, 2.0**-1000])
def test_a_slab_is_as_thick_as_it_is_to_the_last_bit(thick: float) -> None:
    block, slab = hull(box((0, 0, 0), (3, 3, 3))[0]), hull(box((1, 1, 0), (2, 2, thick))[0])
    assert holds_thicker_ball(block, slab, down(thick)) is True
    assert holds_thicker_ball(slab, block, thick) is False


def test_the_ball_in_the_corner_of_a_cube() -> None:
    """A corner x + y + z <= 1 holds a ball of radius 1 / (3 + sqrt(3))."""
    cube = hull(box((0, 0, 0), (2, 2, 2))[0])
    corner = hull([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)])
    diameter = 2 / (3 + math.sqrt(3))
    assert holds_thicker_ball(cube, corner, diameter * (1 - 1e-15)) is True
    assert holds_thicker_ball(cube, corner, diameter * (1 + 1e-15)) is False


def test_bodies_that_are_apart_hold_none() -> None:
    assert (
        holds_thicker_ball(
            hull(box((0, 0, 0), (1, 1, 1))[0]), hull(box((2, 0, 0), (3, 1, 1))[0]), 0.0
        )
        is False
    )


def test_as_the_search_for_the_thickness_finds_it() -> None:
    draw = np.random.default_rng(5)
    for _ in range(12):
        hulls = [hull(draw.normal(size=(20, 3)) + shift) for shift in (0.0, draw.uniform(0, 0.8))]
        surfaces = [core.Surface(one.to_mesh(), True) for one in hulls]
        found = core.search_thickness(*surfaces, width=1e-6, work=10**8)
        for diameter, thicker in ((found.lower * (1 - 1e-9), True), (found.upper, False)):
            if diameter > 0:
                assert holds_thicker_ball(*hulls, diameter) is thicker


def test_beams_that_all_but_lie_along_each_other() -> None:
    """Turned by 1e-15 and sunk by 1e-9: the overlap is a wedge as thick as that at most."""
    beam = np.array(box((-5, -1, -1), (5, 1, 1))[0], dtype=np.float64)
    over = beam + np.array([0.0, 0.0, 2.0 - 1e-9])
    over[:, 2] += 1e-15 * over[:, 0]
    assert holds_thicker_ball(hull(beam), hull(over), 0.9e-9) is True
    assert holds_thicker_ball(hull(beam), hull(over), 1.1e-9) is False
