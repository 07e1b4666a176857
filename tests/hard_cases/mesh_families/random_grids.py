"""Random lattice solids on uneven grids: every contact is degenerate."""

from __future__ import annotations

import random
from collections.abc import Iterator
from fractions import Fraction

import numpy as np

from tests.core.voxel_solids import Cell, VoxelSolid, true_relation
from tests.hard_cases.grid_solids import SPACINGS, grid_lines, grid_mesh, squared_distance
from tests.hard_cases.mesh_case import MEETING, MeshPair

CATEGORY = "random solids on a grid"

PAIRS = 140


def cases(seed: int) -> Iterator[MeshPair]:
    source, rng = random.Random(seed), np.random.default_rng(seed)
    for number in range(PAIRS):
        spacing = SPACINGS[number % len(SPACINGS)]
        lines = grid_lines(rng, spacing)
        a, b = random_solid(source), random_solid(source)
        relation = true_relation(a, b)
        turn = number % 3
        if relation == "same":
            continue
        yield MeshPair(
            CATEGORY,
            f"pair {number}, {spacing}",
            grid_mesh(a, lines, turn),
            grid_mesh(b, lines),
            relation,
            Fraction(0) if relation in MEETING else squared_distance(a, b, lines),
        )


def random_solid(source: random.Random) -> VoxelSolid:
    """Up to 14 cells, mostly connected, within five of the middle of the grid."""
    cells: set[Cell] = {(source.randrange(3), source.randrange(3), source.randrange(3))}
    for _ in range(source.randrange(2, 14)):
        i, j, k = source.choice(sorted(cells))
        axis, way = source.randrange(3), source.choice((-1, 1))
        step = [way if axis == n else 0 for n in range(3)]
        cells.add((i + step[0], j + step[1], k + step[2]))
    if source.random() < 0.2:
        cells.add((source.randrange(4), source.randrange(4), source.randrange(4)))
    inside = {c for c in cells if all(-MOST <= n <= MOST for n in c)}
    return VoxelSolid(frozenset(inside))


MOST = 5
