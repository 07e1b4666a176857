"""Distances and deviations of meshes in closed form."""

from __future__ import annotations

import math

import pytest

from satcheck.core import Surface, deviation, mesh_distance
from tests.core.voxel_solids import VoxelSolid, box

CUBE = Surface(box((0, 0, 0), (1, 1, 1)).mesh(), True)
NOTCH = VoxelSolid(
    box((0, 0, 0), (4, 1, 1)).cells
    | box((0, 1, 0), (1, 3, 1)).cells
    | box((3, 1, 0), (4, 3, 1)).cells
)


@pytest.mark.parametrize(
    ("offset", "gap"),
    [((3, 0, 0), 2.0), ((4, 5, 0), 5.0), ((2, 3, 3), 3.0), ((1, 0, 0), 0.0), ((0.5, 0, 0), 0.0)],
)
def test_gap_of_two_cubes(offset: tuple[float, float, float], gap: float) -> None:
    other = Surface(CUBE.mesh.translated(offset), True)
    found = mesh_distance(CUBE, other)
    assert found.distance == gap
    assert math.dist(found.witness_a, found.witness_b) == gap
    assert CUBE.nearest(found.witness_a)[0] == 0
    assert other.nearest(found.witness_b)[0] == 0
    reverse = mesh_distance(other, CUBE)
    assert reverse.distance == gap


def test_beyond_the_limit_there_is_no_distance() -> None:
    other = Surface(CUBE.mesh.translated((3, 0, 0)), True)
    assert mesh_distance(CUBE, other, 1.99).distance == math.inf
    assert mesh_distance(CUBE, other, 1.99).triangle_a == -1
    assert mesh_distance(CUBE, other, 2.0).distance == 2
    with pytest.raises(ValueError, match="limit"):
        mesh_distance(CUBE, other, -1.0)


@pytest.mark.parametrize("tolerance", [0.1, 0.001])
def test_deviation_brackets_the_truth(tolerance: float) -> None:
    notch = Surface(NOTCH.mesh(), True)
    cases = [
        (box((0, 0, 0), (4, 3, 1)).mesh(), 1.0),  # the lid over the notch, 1 from both walls
        (NOTCH.mesh(), 0.0),
        (box((0, 0, 0), (4, 3, 2)).mesh(), math.sqrt(2)),
    ]
    for outer, truth in cases:
        lower, upper = deviation(outer, [notch], tolerance)[:2]
        assert lower <= truth <= upper
        assert upper - lower <= tolerance * 1.001
    with pytest.raises(ValueError, match="tolerance"):
        deviation(CUBE.mesh, [CUBE], 0.0)


def test_convexity_defect_covers_the_depth_of_the_notch() -> None:
    # The middle of the notch is 1 from both walls.
    mesh = VoxelSolid(NOTCH.cells, 3).mesh()
    assert mesh.convexity_defect(0.0) == math.inf
    assert mesh.convexity_defect(2.9) == math.inf
    assert mesh.convex_hull().to_mesh().convexity_defect(0.0) == 0.0
