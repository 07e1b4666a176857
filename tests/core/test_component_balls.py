"""The thickness of components: against closed forms, and against a search around each."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
import trimesh

from satcheck.core import (
    Mesh,
    Surface,
    ThicknessInterval,
    component_balls,
    overlap_components,
    search_thickness,
)

PLENTY = 10**6
creation: Any = trimesh.creation
transformations: Any = trimesh.transformations


def of(mesh: Any) -> Surface:
    return Surface(Mesh(np.array(mesh.vertices), np.array(mesh.faces, np.int64)), True)


def balls(a: Any, b: Any) -> list[ThicknessInterval]:
    return component_balls(of(a), of(b), overlap_components(of(a), of(b), PLENTY))


def bolt_and_hole(facets: int, *, turn: float = 0.0) -> tuple[Any, Any]:
    """Of radius 1, out of phase by half a facet."""
    alpha = math.pi / facets
    bolt = creation.cylinder(1, 4, sections=facets)
    bolt.apply_transform(transformations.rotation_matrix(alpha, (0, 0, 1)))
    hole = creation.annulus(1, 3, 2, sections=facets)
    away = (
        transformations.rotation_matrix(turn, (1, 2, 3)),
        transformations.translation_matrix((5, -9, 3)),
    )
    for mesh, matrix in ((mesh, matrix) for mesh in (bolt, hole) for matrix in away):
        mesh.apply_transform(matrix)
    return bolt, hole


@pytest.mark.parametrize("turn", [0.0, 0.7])
@pytest.mark.parametrize("facets", [8, 24, 48])
def test_slivers_between_facets(facets: int, turn: float) -> None:
    """A corner of the bolt sticks out by s through the chord of the hole: a triangle of height s
    whose corners at the chord have the angle alpha."""
    alpha = math.pi / facets
    truth = 2 * (1 - math.cos(alpha)) * math.cos(alpha) / (1 + math.cos(alpha))
    slivers = balls(*bolt_and_hole(facets, turn=turn))
    assert len(slivers) == facets
    # Coordinates near 10 are rounded to 1e-15; a wedge with an angle of 0.07 may move by 15 times
    # that, and both bounds allow for 6e-13 (component_search.cpp).
    rounding = 1e-11
    for sliver in slivers:
        assert truth - rounding <= sliver.lower <= sliver.upper <= truth + rounding


def test_a_slab_and_a_box_within() -> None:
    block = creation.box((4, 4, 4))
    slab = balls(block, creation.box((4, 4, 4)).apply_translation((3.75, 0.5, 0.25)))
    assert [(round(ball.lower, 9), round(ball.upper, 9)) for ball in slab] == [(0.25, 0.25)]
    within = balls(block, creation.box((1, 2, 3)))
    assert [(round(ball.lower, 9), round(ball.upper, 9)) for ball in within] == [(1, 1)]


def test_a_ring_is_thinner_than_its_hull() -> None:
    """The hull of a ring is thick, and its middle lies in no body."""
    pin, plate = creation.cylinder(1.01, 4, sections=16), creation.annulus(1, 3, 2, sections=16)
    (ball,) = balls(pin, plate)
    assert ball.centre is None
    assert ball.lower == 0
    assert ball.upper > 1


def test_a_ball_that_may_be_of_another_component_counts_for_none() -> None:
    """The hull of a ring holds the middle of a pin inside of it."""
    tube = creation.annulus(2, 3, 4, sections=16)
    core_pin = creation.cylinder(0.5, 4, sections=16)
    both = trimesh.util.concatenate([tube, core_pin])
    overlap = overlap_components(of(both), of(creation.box((9, 9, 1))), PLENTY)
    ring, pin = sorted(
        component_balls(of(both), of(creation.box((9, 9, 1))), overlap),
        key=lambda ball: ball.lower,
    )
    assert ring.lower == pin.lower == 0
    assert ring.upper == pytest.approx(1, abs=1e-9)


@pytest.mark.parametrize("place", range(4))
def test_a_search_in_the_bounds_of_a_component(place: int) -> None:
    """Boxes of four thicknesses, far apart."""
    blocks = [creation.box((1, 1, 4)).apply_translation((3 * k, 0, 0)) for k in range(4)]
    plates = [
        creation.box((2, 2, 0.2 * (k + 1))).apply_translation((3 * k, 0, 0)) for k in range(4)
    ]
    a, b = of(trimesh.util.concatenate(blocks)), of(trimesh.util.concatenate(plates))
    component = overlap_components(a, b, PLENTY).components[place]
    ball = search_thickness(a, b, width=0.01, work=10**9, within=component)
    truth = 0.2 * (place + 1)
    assert ball.lower <= truth + 1e-9
    assert truth - 1e-9 <= ball.upper <= 1.01 * truth + 1e-9


@pytest.mark.parametrize("swap", [False, True])
def test_a_search_looks_at_the_components(swap: bool) -> None:
    """A turned bolt in its hole: hulls of slivers are as thick as the slivers."""
    alpha = math.pi / 24
    truth = 2 * (1 - math.cos(alpha)) * math.cos(alpha) / (1 + math.cos(alpha))
    bolt, hole = (of(mesh) for mesh in bolt_and_hole(24, turn=0.7))
    pair = (hole, bolt) if swap else (bolt, hole)
    interval = search_thickness(*pair, width=1e-6, work=100_000_000)
    assert interval.stop == "narrow"
    assert 0.999999 * truth <= interval.lower <= truth + 1e-11
    assert truth - 1e-11 <= interval.upper <= 1.000002 * truth
    decided = search_thickness(*pair, width=0.0, work=100_000_000, limit=truth / 2)
    assert decided.stop == "decided"
