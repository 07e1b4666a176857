"""One variant of a pair: its bodies, the map back, and the bound of the change.

Bounds are derived; u is the unit roundoff of float64. The signed distance of two convex bodies, and
any gap, changes by at most the sum of how far the two surfaces are moved against each other: their
support functions do, and so do closest points.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from fractions import Fraction
from typing import get_args

import numpy as np
from msgspec import Struct
from numpy.typing import NDArray

from satcheck.core.rounding import UNIT_ROUNDOFF
from satcheck.report.stability import Family as Family
from satcheck.scene import Body, MeshFile

FAMILIES: tuple[Family, ...] = get_args(Family)

Points = NDArray[np.float64]
Rows = tuple[tuple[float, float, float], ...]
IDENTITY: Rows = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
UNMOVED = (0.0, 0.0, 0.0)

# A figure of the convex tier lies in its proven bounds. They close to two support errors of 40 u
# and 16 u of slack, all times the scale of the pair: the extents of both and their offset, each at
# most twice the largest coordinate. The chain of operations of the mesh tier, 64 u, is shorter.
FIGURE_ROUNDOFFS = (2 * 40 + 16) * 6

# A vertex of which each coordinate is off by one unit is off by the square root of 3.
VERTEX = math.sqrt(3.0)


class Variant(Struct, frozen=True):
    """how: for people. a, b: in the order asked.

    turn, scale, swapped: the variant's world is scale * turn * the asked world, moved; answers are
    taken back by them. displacement: world units of the variant, how far the surfaces of a and b
    together lie at most from where the exact map puts them. identical: the answer, taken back,
    must be the same bits.
    """

    family: Family
    how: str
    a: Body
    b: Body
    turn: Rows = IDENTITY
    scale: float = 1.0
    swapped: bool = False
    displacement: float = 0.0
    identical: bool = False


class Question(Struct, frozen=True):
    """The pair as given: two mesh files, in place."""

    a: MeshFile
    b: MeshFile

    @property
    def files(self) -> tuple[MeshFile, MeshFile]:
        return self.a, self.b

    @property
    def points(self) -> Points:
        """(n, 3): the vertices of both."""
        return np.concatenate([self.a.mesh.vertices, self.b.mesh.vertices])

    @property
    def diagonal(self) -> float:
        """Of the box around both: more than the distance of any two of their points."""
        points = self.points
        return float(np.linalg.norm(points.max(axis=0) - points.min(axis=0)))


def body(id_: str, file: MeshFile, turn: Rows = IDENTITY, by: Sequence[float] = UNMOVED) -> Body:
    """The file placed by a 3x3 matrix and a translation; untouched where they do nothing."""
    if turn == IDENTITY and not any(by):
        return Body(id_, id_, file)
    rows = [(*row, offset) for row, offset in zip(turn, by, strict=True)]
    matrix = tuple(entry for row in (*rows, (0.0, 0.0, 0.0, 1.0)) for entry in row)
    return Body(id_, id_, file, matrix)


def rounding_of_figures(largest_coordinate: float) -> float:
    """What a computed gap or depth may be off by."""
    return FIGURE_ROUNDOFFS * UNIT_ROUNDOFF * largest_coordinate


def rounded_once(largest_coordinate: float) -> float:
    """How far rounding each coordinate to nearest moves a vertex."""
    return VERTEX * UNIT_ROUNDOFF * largest_coordinate


def one_ulp(largest_coordinate: float) -> float:
    """How far a vertex moves when each coordinate goes to its neighbour: at most 2 u of it."""
    return 2 * VERTEX * UNIT_ROUNDOFF * largest_coordinate


def stretch(turn: Rows) -> float:
    """By how much, relatively, a matrix that is nearly a rotation changes a length, at most.

    Its singular values differ from 1 by at most the norm of M^T M - 1, here computed exactly.
    """
    rows = [[Fraction(entry) for entry in row] for row in turn]
    excess = [
        sum(rows[k][i] * rows[k][j] for k in range(3)) - (i == j)
        for i in range(3)
        for j in range(3)
    ]
    return math.hypot(*(float(part) for part in excess)) * (1 + 8 * UNIT_ROUNDOFF)
