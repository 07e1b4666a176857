"""Points deep in two outlines: room to the edges, and what it proves."""

from __future__ import annotations

import numpy as np
import pytest

from satcheck.audit import Settings
from satcheck.audit.bodies.placed_bodies import place
from satcheck.audit.bodies.placed_body import PlacedBody
from satcheck.audit.figures.deep_point import Outline, depth_around
from satcheck.scene.planar.flat_scene import flat_scene
from tests.scene.planar.flat import Corners, scene, sheet

SQUARE = [(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0)]


def placed(*outlines: Corners) -> list[PlacedBody]:
    flat = flat_scene(scene(*map(sheet, outlines)), "xy")
    return list(place(flat, Settings(planar="xy")).placed.values())


@pytest.mark.parametrize(
    ("point", "room"),
    [((2.0, 2.0), 2.0), ((0.5, 3.0), 0.5), ((4.5, 2.0), 0.0), ((-1.0, 0.0), 0.0)],
)
def test_room_inside(point: tuple[float, float], room: float) -> None:
    (body, _) = placed(SQUARE, SQUARE)
    assert Outline(body, "xy").room(np.array(point)) == room


@pytest.mark.parametrize("off", [0.0, 0.01, 0.1])
def test_the_depth_of_squares(off: float) -> None:
    right = [(x + 3.0, y) for x, y in SQUARE]
    a, b = placed(SQUARE, right)
    found = depth_around((a, b), (off, off), (3.5, 0.1, 0.0), 0.5, "xy")
    assert found == pytest.approx(1.0 - 2 * off, abs=1e-12)


def test_nothing_is_shown_of_what_may_not_overlap() -> None:
    right = [(x + 3.9, y) for x, y in SQUARE]
    a, b = placed(SQUARE, right)
    assert depth_around((a, b), (0.06, 0.06), (3.95, 2.0, 0.0), 0.1, "xy") == 0.0
