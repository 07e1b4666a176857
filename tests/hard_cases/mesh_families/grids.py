"""Rings, links, pegs, shells, plates, combs on grids whose lines are an ulp to 1e3 apart."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction

import numpy as np

from tests.core.voxel_solids import VoxelSolid, box, true_relation
from tests.hard_cases.grid_solids import SPACINGS, grid_lines, grid_mesh, squared_distance
from tests.hard_cases.mesh_case import MEETING, MeshPair

CATEGORY = "rings, pegs, shells, plates"


def union(*solids: VoxelSolid) -> VoxelSolid:
    return VoxelSolid(frozenset().union(*(s.unit_cells() for s in solids)))


def minus(a: VoxelSolid, b: VoxelSolid) -> VoxelSolid:
    return VoxelSolid(a.unit_cells() - b.unit_cells())


RING = minus(box((0, 0, 2), (5, 5, 3)), box((1, 1, 2), (4, 4, 3)))
LINK = minus(box((2, 2, 0), (9, 3, 5)), box((3, 2, 1), (8, 3, 4)))
PLATE = minus(box((0, 0, 0), (7, 7, 1)), box((2, 2, 0), (5, 5, 1)))
SHELL = minus(box((0, 0, 0), (9, 9, 9)), box((1, 1, 1), (8, 8, 8)))
INNER_SHELL = minus(box((2, 2, 2), (7, 7, 7)), box((3, 3, 3), (6, 6, 6)))
COMB = union(box((0, 0, 0), (9, 1, 1)), *(box((i, 0, 0), (i + 1, 4, 1)) for i in (0, 4, 8)))
COMB_ABOVE = union(box((1, 5, 0), (8, 6, 1)), *(box((i, 2, 0), (i + 1, 5, 1)) for i in (2, 6)))
WIDE_COMB = union(box((1, 5, 0), (8, 6, 1)), *(box((i, 2, 0), (i + 3, 5, 1)) for i in (1, 5)))
HOOK = union(box((0, 0, 0), (6, 1, 1)), box((5, 0, 0), (6, 4, 1)), box((3, 3, 0), (6, 4, 1)))
OTHER_HOOK = union(
    box((3, 1, -2), (4, 2, 3)), box((1, 1, 2), (4, 2, 3)), box((1, 1, -2), (4, 2, -1))
)
L_SHAPE = union(box((0, 0, 0), (4, 1, 1)), box((0, 0, 0), (1, 4, 1)))
TWO_BLOCKS = union(box((0, 0, 0), (2, 4, 2)), box((4, 0, 0), (6, 4, 2)))

PAIRS: dict[str, tuple[VoxelSolid, VoxelSolid]] = {
    "rod through a ring": (RING, box((2, 2, -2), (3, 3, 7))),
    "rod along the wall of a ring": (RING, box((1, 2, -2), (2, 3, 7))),
    "rod in the corner of a ring": (RING, box((1, 1, 0), (2, 2, 5))),
    "rod through the wall of a ring": (RING, box((0, 2, -2), (1, 3, 7))),
    "interlocked links": (RING, LINK),
    "links that touch": (RING, minus(box((2, 2, 0), (9, 3, 5)), box((3, 2, 1), (8, 3, 2)))),
    "peg in a hole, free": (PLATE, box((3, 3, -2), (4, 4, 3))),
    "peg that fits": (PLATE, box((2, 2, -2), (5, 5, 3))),
    "plug that fits": (PLATE, box((2, 2, 0), (5, 5, 1))),
    "peg too wide": (PLATE, box((2, 2, -2), (6, 5, 3))),
    "peg too wide all round": (PLATE, box((1, 1, -2), (6, 6, 3))),
    "shell in a shell": (SHELL, INNER_SHELL),
    "core in two shells": (union(SHELL, INNER_SHELL), box((4, 4, 4), (5, 5, 5))),
    "core that fills": (INNER_SHELL, box((3, 3, 3), (6, 6, 6))),
    "shell in a block": (box((-1, -1, -1), (10, 10, 10)), SHELL),
    "block in a wall": (
        minus(box((0, 0, 0), (9, 9, 9)), box((3, 3, 3), (8, 8, 8))),
        box((1, 1, 1), (2, 2, 2)),
    ),
    "plates apart": (box((0, 0, 0), (9, 9, 1)), box((0, 0, 2), (9, 9, 3))),
    "plates on each other": (box((0, 0, 0), (9, 9, 1)), box((2, 2, 1), (9, 12, 2))),
    "plates in each other": (box((0, 0, 0), (9, 9, 2)), box((2, 2, 1), (9, 12, 3))),
    "plates crossed": (box((0, 0, 2), (9, 9, 3)), box((4, 0, 0), (5, 9, 7))),
    "combs, free": (COMB, COMB_ABOVE),
    "combs that fit": (COMB, WIDE_COMB),
    "hooks": (HOOK, OTHER_HOOK),
    "nested angles": (L_SHAPE, VoxelSolid(L_SHAPE.cells, 1, (1, 1, 0))),
    "bar between two blocks": (TWO_BLOCKS, box((2, 1, -1), (4, 2, 3))),
    "bar free between two blocks": (TWO_BLOCKS, box((3, -1, -1), (4, 5, 3))),
    "edges that meet": (box((0, 0, 0), (2, 2, 2)), box((2, 2, 0), (4, 4, 2))),
    "corners that meet": (box((0, 0, 0), (2, 2, 2)), box((2, 2, 2), (4, 4, 4))),
}


def cases(seed: int) -> Iterator[MeshPair]:
    rng = np.random.default_rng(seed)
    for name, (a, b) in PAIRS.items():
        relation = true_relation(a, b)
        for spacing in SPACINGS:
            lines = grid_lines(rng, spacing)
            turn = int(rng.integers(3))
            yield MeshPair(
                CATEGORY,
                f"{name}, {spacing}",
                grid_mesh(a, lines, turn),
                grid_mesh(b, lines),
                relation,
                Fraction(0) if relation in MEETING else squared_distance(a, b, lines),
            )
