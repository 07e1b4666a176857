"""Solids of lattice cells on grid lines that are anything but even.

What is inside, and what touches, is a matter of whole numbers; the lines may then lie one ulp or
1e9 apart without changing it. The distance of two surfaces is that of two of their rectangles.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction

import numpy as np

from tests.core.voxel_solids import Cell, VoxelSolid
from tests.hard_cases.mesh_case import MeshData, mesh_of_polygons

# Lattice coordinates run from -MARGIN to COUNT - MARGIN.
MARGIN, COUNT = 6, 24
Lines = tuple[Sequence[float], Sequence[float], Sequence[float]]
SPACINGS = ("even", "ulps", "thin", "mixed", "far", "small", "large")


def grid_lines(rng: np.random.Generator, spacing: str) -> Lines:
    """COUNT strictly increasing lines an axis."""
    x, y, z = (_lines(rng, spacing) for _ in range(3))
    return x, y, z


def _lines(rng: np.random.Generator, spacing: str) -> list[float]:
    unit = {"small": 1e-9, "large": 1e9}.get(spacing, 1.0)
    steps: Sequence[float] = {
        "ulps": (0.0, 0.25),
        "thin": (1.0, 1e-6, 1e-12),
        "mixed": (1e-9, 1e-3, 1.0, 1e3),
        "far": (0.0, 0.5, 1.0),
    }.get(spacing, (1.0,))
    line = 1e6 if spacing == "far" else -MARGIN * unit
    lines = []
    for _ in range(COUNT):
        lines.append(line)
        line = max(line + unit * float(rng.choice(steps)), float(np.nextafter(line, np.inf)))
    return [float(c) for c in lines]


def grid_mesh(solid: VoxelSolid, lines: Lines, turn: int = 0) -> MeshData:
    def place(p: Cell) -> tuple[float, float, float]:
        return (lines[0][p[0] + MARGIN], lines[1][p[1] + MARGIN], lines[2][p[2] + MARGIN])

    return mesh_of_polygons([[place(p) for p in quad] for quad in solid.quads()], turn)


def squared_distance(a: VoxelSolid, b: VoxelSolid, lines: Lines) -> Fraction:
    """Of the two surfaces: float64 finds the rectangles that can be nearest, fractions decide."""
    boxes_a, boxes_b = (_rectangles(solid, lines) for solid in (a, b))
    low_a, high_a, low_b, high_b = (
        np.array([box[end] for box in boxes]) for boxes in (boxes_a, boxes_b) for end in (0, 1)
    )
    gaps = np.maximum(low_b[None] - high_a[:, None], low_a[:, None] - high_b[None])
    rough = (np.maximum(gaps, 0.0) ** 2).sum(axis=-1)
    # The coordinates are exact: differences, squares and sums are off by 4 roundoffs at most.
    near = np.argwhere(rough <= rough.min() * (1 + 1e-14))
    # Most of them are as far apart as others.
    return min(map(_squared, {_ends_of_gap(boxes_a[i], boxes_b[j]) for i, j in near}))


Corner = tuple[float, float, float]
Rectangle = tuple[Corner, Corner]


def _rectangles(solid: VoxelSolid, lines: Lines) -> list[Rectangle]:
    """Least and greatest corner of each boundary face."""
    boxes = []
    for quad in solid.quads():
        columns = [[lines[i][p[i] + MARGIN] for p in quad] for i in range(3)]
        (x, y, z), (u, v, w) = (tuple(f(c) for c in columns) for f in (min, max))
        boxes.append(((x, y, z), (u, v, w)))
    return boxes


def _ends_of_gap(one: Rectangle, other: Rectangle) -> tuple[tuple[float, float], ...]:
    """Two coordinates along each axis, as far apart as the rectangles are along it."""
    return tuple(
        (one[1][i], other[0][i])
        if one[1][i] < other[0][i]
        else (other[1][i], one[0][i])
        if other[1][i] < one[0][i]
        else (0.0, 0.0)
        for i in range(3)
    )


def _squared(gap: tuple[tuple[float, float], ...]) -> Fraction:
    return sum(((Fraction(high) - Fraction(low)) ** 2 for low, high in gap), Fraction(0))
