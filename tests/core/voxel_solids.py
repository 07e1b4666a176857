"""Solids made of lattice cells: every contact is degenerate, every truth is a set operation.

A solid is a set of unit cells ``(i, j, k)``. Its mesh is the boundary of their union, two triangles
to a face of edge length ``size``, with diagonals either way. Lattice points go through an integer
affine map, so that coordinates stay exact in float64 while faces need not be axis-aligned.
"""

from __future__ import annotations

import random
import struct
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Protocol

from satcheck.core import Mesh

Cell = tuple[int, int, int]
Point = tuple[float, float, float]
Quad = tuple[Cell, Cell, Cell, Cell]
Matrix = tuple[tuple[int, int, int], tuple[int, int, int], tuple[int, int, int]]

IDENTITY: Matrix = ((1, 0, 0), (0, 1, 0), (0, 0, 1))
SHEAR: Matrix = ((2, 1, 0), (-1, 3, 1), (1, -1, 2))  # determinant 17

# Each face of the cell [0, 1]^3, counter-clockwise seen from outside, and the way to the neighbour.
FACES: tuple[tuple[Cell, Quad], ...] = (
    ((-1, 0, 0), ((0, 0, 0), (0, 0, 1), (0, 1, 1), (0, 1, 0))),
    ((1, 0, 0), ((1, 0, 0), (1, 1, 0), (1, 1, 1), (1, 0, 1))),
    ((0, -1, 0), ((0, 0, 0), (1, 0, 0), (1, 0, 1), (0, 0, 1))),
    ((0, 1, 0), ((0, 1, 0), (0, 1, 1), (1, 1, 1), (1, 1, 0))),
    ((0, 0, -1), ((0, 0, 0), (0, 1, 0), (1, 1, 0), (1, 0, 0))),
    ((0, 0, 1), ((0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1))),
)


@dataclass(frozen=True)
class VoxelSolid:
    """Cells of edge length ``size`` on the lattice, the cell (0, 0, 0) starting at ``origin``."""

    cells: frozenset[Cell]
    size: int = 1
    origin: Cell = (0, 0, 0)

    def unit_cells(self) -> frozenset[Cell]:
        """The unit cells that are filled."""
        o, n = self.origin, self.size
        return frozenset(
            (o[0] + n * i + a, o[1] + n * j + b, o[2] + n * k + c)
            for i, j, k in self.cells
            for a in range(n)
            for b in range(n)
            for c in range(n)
        )

    def quads(self) -> list[Quad]:
        """The boundary faces in lattice coordinates, counter-clockwise seen from outside."""
        o, n = self.origin, self.size

        def place(cell: Cell, corner: Cell) -> Cell:
            x, y, z = (o[m] + n * (cell[m] + corner[m]) for m in range(3))
            return (x, y, z)

        quads = []
        for cell in sorted(self.cells):
            for step, face in FACES:
                neighbour = (cell[0] + step[0], cell[1] + step[1], cell[2] + step[2])
                if neighbour not in self.cells:
                    a, b, c, d = (place(cell, corner) for corner in face)
                    quads.append((a, b, c, d))
        return quads

    def mesh(self, matrix: Matrix = IDENTITY, seed: int = 0) -> Mesh:
        """The boundary as a welded mesh; ``seed`` chooses the diagonals."""
        rng = random.Random(seed)
        soup: list[Cell] = []
        for a, b, c, d in self.quads():
            soup += (a, b, c, a, c, d) if rng.random() < 0.5 else (a, b, d, b, c, d)
        return mesh_of_soup(apply(matrix, p) for p in soup)

    def surface_points(self) -> frozenset[Cell]:
        """All lattice points on the boundary: unit squares meet where they share one of these."""
        points: set[Cell] = set()
        for corners in self.quads():
            low = [min(p[m] for p in corners) for m in range(3)]
            high = [max(p[m] for p in corners) for m in range(3)]
            points.update(
                (x, y, z)
                for x in range(low[0], high[0] + 1)
                for y in range(low[1], high[1] + 1)
                for z in range(low[2], high[2] + 1)
            )
        return frozenset(points)


def apply(matrix: Matrix, p: Cell | Point) -> Point:
    x, y, z = (float(sum(r * c for r, c in zip(row, p, strict=True))) for row in matrix)
    return (x, y, z)


def mesh_of_soup(corners: Iterable[Point]) -> Mesh:
    """Three corners to a triangle, welded."""
    flat = [c for corner in corners for c in corner]
    count = len(flat) // 3
    return Mesh.from_bytes(
        struct.pack(f"<{len(flat)}d", *flat), struct.pack(f"<{count}I", *range(count))
    ).welded()


def box(low: Cell, high: Cell) -> VoxelSolid:
    """All unit cells between two corners."""
    return VoxelSolid(
        frozenset(
            (i, j, k)
            for i in range(low[0], high[0])
            for j in range(low[1], high[1])
            for k in range(low[2], high[2])
        )
    )


class Cells(Protocol):
    """A union of unit cells; ``surface_points`` are the lattice points on its boundary."""

    def unit_cells(self) -> frozenset[Cell]: ...
    def surface_points(self) -> frozenset[Cell]: ...
    def mesh(self, matrix: Matrix = ..., seed: int = ...) -> Mesh: ...


def true_relation(a: Cells, b: Cells) -> str:
    """The relation by set operations."""
    cells_a, cells_b = a.unit_cells(), b.unit_cells()
    if cells_a == cells_b:
        return "coincident"
    contact = not a.surface_points().isdisjoint(b.surface_points())
    if cells_a.isdisjoint(cells_b):
        return "touching" if contact else "separated"
    if contact:
        return "penetrating"
    if cells_b < cells_a:
        return "contains"
    return "inside" if cells_a < cells_b else "penetrating"
