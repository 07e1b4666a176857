"""IFC: how much of two joined walls their boxes can share."""

from __future__ import annotations

import math

import numpy as np
import pytest

from satcheck.plugins.ifc.kernel import Shape
from satcheck.plugins.ifc.relations import meet_in_a_corner
from satcheck.scene.document import RawMesh

TRIANGLE = np.array([0, 1, 2], "<u4").tobytes()


def wall(degrees: float = 0.0, at: tuple[float, float, float] = (0, 0, 0)) -> Shape:
    """4 long, 0.2 thick, 2 high, from its start on the axis of the wall, turned about z."""
    corners = [(x, y, z) for x in (0.0, 4.0) for y in (-0.1, 0.1) for z in (0.0, 2.0)]
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    x, y, z = at
    matrix = (c, -s, 0.0, x, s, c, 0.0, y, 0.0, 0.0, 1.0, z, 0.0, 0.0, 0.0, 1.0)
    vertices = np.array(corners).astype("<f8").tobytes()
    return Shape(RawMesh(vertices, TRIANGLE, "written-digits"), matrix)


@pytest.mark.parametrize(
    ("degrees", "at", "expected"),
    [
        (90, (0, 0, 0), True),
        (45, (0, 0, 0), True),
        (-135, (2, 0, 0), True),
        (90, (0, 0, 2), True),  # on top
        (90, (9, 0, 0), True),  # apart
        (0, (0, 0, 0), False),
        (180, (4, 0, 0), False),  # the same, drawn from its other end
        (0.5, (0, 0, 0), False),
        (0, (1.9, 0, 0), False),  # 2.1 of 4 are shared
        (0, (2.1, 0, 0), True),
    ],
)
def test_walls_share_a_corner_or_most_of_one(
    degrees: float, at: tuple[float, float, float], expected: bool
) -> None:
    far = (1e3, -2e4, 5.0)
    placed = wall(degrees, tuple(a + b for a, b in zip(at, far, strict=True)))  # type: ignore[arg-type]
    assert meet_in_a_corner(wall(0, far), placed) is expected
    assert meet_in_a_corner(placed, wall(0, far)) is expected
