"""What a hard case is: two shapes, a category, and the truth about them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from tests.oracles.exact_distance import Truth, exact_truth

Points = NDArray[np.float64]
Vertices = tuple[tuple[float, float, float], ...]


@dataclass(frozen=True, slots=True)
class ConvexPair:
    """The convex hulls of two point sets, world frame, coordinates as they are.

    expected: the outcome where the construction fixes it; the oracle has to agree.
    """

    category: str
    name: str
    a: Vertices
    b: Vertices
    expected: str | None = None

    def truth(self) -> Truth:
        return exact_truth(self.a, self.b)

    @property
    def size(self) -> float:
        """The largest side of the box around both: what errors are compared with."""
        return extent((*self.a, *self.b))


class Family(Protocol):
    """A module of `families`: one category, all of its cases from a seed."""

    CATEGORY: str

    def cases(self, seed: int) -> Iterator[ConvexPair]: ...


def pair(
    category: str,
    name: str,
    a: Points | Sequence[Sequence[float]],
    b: Points | Sequence[Sequence[float]],
    expected: str | None = None,
) -> ConvexPair:
    return ConvexPair(category, name, vertices(a), vertices(b), expected)


def vertices(points: Points | Sequence[Sequence[float]]) -> Vertices:
    """Plain floats, without negative zeros."""
    return tuple((float(x) + 0.0, float(y) + 0.0, float(z) + 0.0) for x, y, z in points)


def extent(points: Vertices) -> float:
    """The largest side of the box around the points."""
    columns = list(zip(*points, strict=True))
    return float(max(Fraction(max(c)) - Fraction(min(c)) for c in columns))
