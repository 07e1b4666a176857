"""The exact common volume, held against counted cells and against closed forms."""

from __future__ import annotations

from fractions import Fraction
from itertools import product

import numpy as np
import pytest

from satcheck.core import Mesh
from satcheck.core.exact_volume import exact_common_volume
from tests.core.test_mesh_relation import (
    CELL,
    COMB,
    CUBE,
    HOLLOW,
    L_SHAPE,
    PLATE_WITH_HOLE,
    SMALL,
    STAIRS,
    moved,
)
from tests.core.voxel_solids import VoxelSolid

SOLIDS = {
    "cube": CUBE,
    "small": SMALL,
    "L": L_SHAPE,
    "plate": PLATE_WITH_HOLE,
    "stairs": STAIRS,
    "comb": COMB,
}
OFFSETS = [(0, 0, 0), (1, 1, 0), (2, 0, 1)]


def cells(solid: VoxelSolid, offset: tuple[int, int, int]) -> set[tuple[int, ...]]:
    return {tuple(c + o for c, o in zip(cell, offset, strict=True)) for cell in solid.cells}


@pytest.mark.parametrize("first", SOLIDS)
@pytest.mark.parametrize("second", ["cube", "small", "L"])
def test_of_solids_made_of_cells(first: str, second: str) -> None:
    a, b = SOLIDS[first], SOLIDS[second]
    for offset in OFFSETS:
        common = len(cells(a, (0, 0, 0)) & cells(b, offset))
        one, other = a.mesh(), moved(b, *offset).mesh()
        assert exact_common_volume(one, other) == common
    assert exact_common_volume(other, one) == common


def test_of_a_hollow_body() -> None:
    assert exact_common_volume(HOLLOW.mesh(), moved(CELL, 0, 2, 2).mesh()) == 1
    assert exact_common_volume(HOLLOW.mesh(), moved(CELL, 2, 2, 2).mesh()) == 0
    half = CUBE.mesh().translated((0.5, 0.5, 0.5))
    assert exact_common_volume(HOLLOW.mesh(), half) == 4**3 - 3**3


def tetrahedron(scale: float) -> Mesh:
    points = np.array([(0, 0, 0), (scale, 0, 0), (0, scale, 0), (0, 0, scale)], dtype=float)
    return Mesh(points, np.array([(0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)]))


@pytest.mark.parametrize("shift", list(product((0.0, 0.1, 0.25), repeat=3)))
def test_of_two_corners(shift: tuple[float, float, float]) -> None:
    """x, y, z >= the shift and x + y + z <= 1: a corner again, of what the shift leaves of 1."""
    left = 1 - sum(map(Fraction, shift))
    moved_one = tetrahedron(1.0).translated(shift)
    found = exact_common_volume(tetrahedron(1.0), moved_one)
    # The coordinates of the moved one are rounded sums: its far corners do not matter here.
    assert found == left**3 / 6


def test_too_much_work_is_refused() -> None:
    assert exact_common_volume(HOLLOW.mesh(), moved(HOLLOW, 1, 1, 0).mesh()) is None
