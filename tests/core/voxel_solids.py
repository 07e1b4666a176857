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
# A unit square: the cell above it, and the axis across it.
Square = tuple[Cell, int]
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

    def sheets(self) -> frozenset[Square]:
        return frozenset()

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
    """A union of unit cells, and sheets: unit squares of its mesh with no cell on either side.

    ``surface_points`` are the lattice points on the boundary of the cells.
    """

    def unit_cells(self) -> frozenset[Cell]: ...
    def surface_points(self) -> frozenset[Cell]: ...
    def sheets(self) -> frozenset[Square]: ...
    def mesh(self, matrix: Matrix = ..., seed: int = ...) -> Mesh: ...


def true_relation(a: Cells, b: Cells) -> str:
    """The relation by set operations."""
    cells_a, cells_b, sheets_a, sheets_b = a.unit_cells(), b.unit_cells(), a.sheets(), b.sheets()
    if (cells_a, sheets_a) == (cells_b, sheets_b):
        return "coincident"
    points_a = a.surface_points().union(*map(corners_of, sheets_a))
    points_b = b.surface_points().union(*map(corners_of, sheets_b))
    contact = not points_a.isdisjoint(points_b)
    common = (
        not cells_a.isdisjoint(cells_b)
        or any(cells_b.issuperset(beside(square)) for square in sheets_a)
        or any(cells_a.issuperset(beside(square)) for square in sheets_b)
        or sheets_cross(sheets_a, sheets_b)
    )
    if not common:
        return "touching" if contact else "separated"
    a_alone, b_alone = is_alone(a, b), is_alone(b, a)
    if not (a_alone or b_alone):
        return "coincident"
    if contact or (a_alone and b_alone):
        return "penetrating"
    return "contains" if a_alone else "inside"


def beside(square: Square) -> tuple[Cell, Cell]:
    """The cells on both sides of a unit square."""
    above, axis = square
    i, j, k = (c - (m == axis) for m, c in enumerate(above))
    return above, (i, j, k)


def corners_of(square: Square) -> list[Cell]:
    (i, j, k), axis = square
    spans = [(0, 1) if m != axis else (0,) for m in range(3)]
    return [(i + x, j + y, k + z) for x in spans[0] for y in spans[1] for z in spans[2]]


def is_alone(x: Cells, y: Cells) -> bool:
    """Whether a cell or a sheet of x lies outside of y."""
    cells, sheets = y.unit_cells(), y.sheets()
    outside = (s for s in x.sheets() if s not in sheets and cells.isdisjoint(beside(s)))
    return not x.unit_cells() <= cells or next(outside, None) is not None


def sheets_cross(sheets_a: frozenset[Square], sheets_b: frozenset[Square]) -> bool:
    """Whether sheets pass through each other along an edge of the lattice: both go on beyond it."""
    for (i, j, k), axis in sheets_a:
        for along in {0, 1, 2} - {axis}:
            across = 3 - axis - along  # from the square to the next one in its plane
            next_one = (i - (across == 0), j - (across == 1), k - (across == 2))
            if (next_one, axis) not in sheets_a:
                continue
            # The edge runs along `along` from the corner (i, j, k).
            down = (i - (axis == 0), j - (axis == 1), k - (axis == 2))
            if ((i, j, k), across) in sheets_b and (down, across) in sheets_b:
                return True
    return False
