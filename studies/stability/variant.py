"""One other way to ask about a pair: its bodies, the way back, and what it may change."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal, get_args

import numpy as np
from msgspec import Struct
from numpy.typing import NDArray

from satcheck.scene import Body, MeshFile

Family = Literal[
    "scale", "order", "axes", "swap", "translation", "retessellation", "motion", "noise"
]
FAMILIES: tuple[Family, ...] = get_args(Family)

Points = NDArray[np.float64]
Rows = tuple[tuple[float, float, float], ...]
IDENTITY: Rows = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
UNMOVED = (0.0, 0.0, 0.0)


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
    """The pair as asked: two mesh files, in place."""

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
