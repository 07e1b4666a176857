"""Translations that free a ball, by as much as it is in."""

from __future__ import annotations

import math

import pytest

from satcheck.core.curved.freeing import frees, move_off
from satcheck.core.shapes import Sphere
from tests.core.curved.bodies import l_bracket
from tests.core.curved.worlds import World, at

BRACKET = World(l_bracket())
SUNK = at(Sphere(0.5), (2.5, 0.0, 1.25))  # 0.25 below the upper face of an arm


@pytest.mark.parametrize(("x", "free"), [(-0.5, True), (-0.49999, False), (0.5, False)])
def test_convex_bodies(x: float, free: bool) -> None:
    a, b = at(Sphere(1.0), (0.0, 0.0, 0.0)), at(Sphere(1.0), (1.5, 0.0, 0.0))
    assert frees(a, b, (x, 0.0, 0.0)) == free


@pytest.mark.parametrize(("z", "free"), [(0.25, True), (0.24999, False), (-0.25, False)])
def test_a_mesh_that_is_not_convex(z: float, free: bool) -> None:
    assert frees(SUNK, BRACKET, (0.0, 0.0, z)) == free
    assert frees(BRACKET, SUNK, (0.0, 0.0, -z)) == free


def test_the_way_off_is_across_the_nearest_face() -> None:
    up, down = move_off(SUNK, BRACKET, 0.3, 1e-9), move_off(BRACKET, SUNK, 0.3, 1e-9)
    assert up is not None
    assert down is not None
    assert frees(SUNK, BRACKET, up)
    assert frees(BRACKET, SUNK, down)
    for move in (up, down):
        # At least as far as it is in, and no more than the bounds and the pad add.
        assert 0.25 <= math.hypot(*move) <= 0.25 + 2e-9


def test_no_way_off_is_longer_than_asked() -> None:
    assert move_off(SUNK, BRACKET, 0.24, 1e-9) is None
