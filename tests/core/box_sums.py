"""Solids made of boxes that overlap, cancel and touch: not all of the surface is boundary.

A solid is a sum of lattice boxes with a sign: the winding number of a cell is the sum of the signs
of the boxes that hold it, and the solid is where that is not 0. Its mesh is the boxes' faces, one
after another: faces inside the material, sheets and pockets behind them come about by themselves.
"""

from __future__ import annotations

import random
from collections import Counter
from dataclasses import dataclass

from satcheck.core import Mesh
from tests.core.voxel_solids import (
    FACES,
    IDENTITY,
    Cell,
    Matrix,
    Point,
    Square,
    apply,
    beside,
    mesh_of_soup,
)

# Three times a rotation, in integers: nothing stays parallel to an axis.
TURN: Matrix = ((2, -1, 2), (2, 2, -1), (-1, 2, 2))

Soup = list[tuple[Point, Point, Point]]


@dataclass(frozen=True)
class SignedBox:
    low: Cell
    high: Cell
    sign: int = 1

    def cells(self) -> list[Cell]:
        spans = [range(self.low[m], self.high[m]) for m in range(3)]
        return [(i, j, k) for i in spans[0] for j in spans[1] for k in spans[2]]

    def place(self, corner: Cell) -> Point:
        """A corner of the unit cell, moved to the corner of the box."""
        x, y, z = (float((self.low, self.high)[corner[m]][m]) for m in range(3))
        return (x, y, z)

    def soup(self, rng: random.Random) -> Soup:
        """Triangles with diagonals either way, some split at a point inside."""
        triangles: Soup = []
        for _, face in FACES:
            a, b, c, d = (self.place(corner) for corner in face)
            first = rng.random() < 0.5
            halves: Soup = [(a, b, c), (a, c, d)] if first else [(a, b, d), (b, c, d)]
            for half in halves:
                turned = half if self.sign > 0 else (half[2], half[1], half[0])
                triangles += split(turned, rng) if rng.random() < 0.2 else [turned]
        return triangles


def split(triangle: tuple[Point, Point, Point], rng: random.Random) -> Soup:
    """Three triangles around an inner point, in eighths: exact in float64."""
    u, v = rng.randrange(1, 7), rng.randrange(1, 7)
    if u + v > 7:
        u, v = 8 - u, 8 - v
    p, q, r = triangle
    if u + v == 8:
        return [triangle]
    x, y, z = (((8 - u - v) * p[m] + u * q[m] + v * r[m]) / 8 for m in range(3))
    inner = (x, y, z)
    return [(p, q, inner), (q, r, inner), (r, p, inner)]


@dataclass(frozen=True)
class BoxSum:
    boxes: tuple[SignedBox, ...]

    def unit_cells(self) -> frozenset[Cell]:
        """The cells of winding number other than 0."""
        winding: Counter[Cell] = Counter()
        for box in self.boxes:
            for cell in box.cells():
                winding[cell] += box.sign
        return frozenset(cell for cell, number in winding.items() if number)

    def sheets(self) -> frozenset[Square]:
        """The unit squares of all faces that have no filled cell on either side."""
        filled = self.unit_cells()
        squares: set[Square] = set()
        for box in self.boxes:
            cells = set(box.cells())
            for cell in cells:
                for step, _ in FACES:
                    i, j, k = (c + s for c, s in zip(cell, step, strict=True))
                    axis = [s != 0 for s in step].index(True)
                    if (i, j, k) not in cells:
                        squares.add((cell if sum(step) < 0 else (i, j, k), axis))
        return frozenset(s for s in squares if filled.isdisjoint(beside(s)))

    def surface_points(self) -> frozenset[Cell]:
        """The lattice points of the unit squares between filled and empty cells."""
        filled = self.unit_cells()
        points: set[Cell] = set()
        for i, j, k in filled:
            for step, face in FACES:
                if (i + step[0], j + step[1], k + step[2]) not in filled:
                    points.update((i + c[0], j + c[1], k + c[2]) for c in face)
        return frozenset(points)

    def mesh(self, matrix: Matrix = IDENTITY, seed: int = 0) -> Mesh:
        rng = random.Random(seed)
        soups = [box.soup(rng) for box in self.boxes]
        triangles = [triangle for soup in soups for triangle in soup]
        rng.shuffle(triangles)
        return mesh_of_soup(apply(matrix, corner) for triangle in triangles for corner in triangle)


def random_sum(rng: random.Random, most: int, extent: int) -> BoxSum:
    """Up to `most` boxes within a cube of the given extent; not empty."""
    while True:
        boxes = []
        for _ in range(rng.randrange(1, most + 1)):
            ends = [sorted(rng.sample(range(extent + 1), 2)) for _ in range(3)]
            low, high = ((e[0] for e in ends), (e[1] for e in ends))
            sign = rng.choice((1, 1, 1, -1))
            boxes.append(SignedBox((*low,), (*high,), sign))  # type: ignore[arg-type]
        result = BoxSum(tuple(boxes))
        if result.unit_cells():
            return result
