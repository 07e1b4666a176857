"""A hard pair of meshes and the truth about it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise
from typing import Protocol

from tests.hard_cases.case import Vertices, vertices

Triangles = tuple[tuple[int, int, int], ...]
# Relations of bodies whose surfaces have a common point.
MEETING = frozenset({"touching", "penetrating", "coincident"})
MIRRORED = {"contains": "inside", "inside": "contains"}


@dataclass(frozen=True, slots=True)
class MeshData:
    """Triangles counter-clockwise seen from outside."""

    vertices: Vertices
    triangles: Triangles


@dataclass(frozen=True, slots=True)
class MeshPair:
    """Two closed meshes. relation: as `core.mesh_relation` names it; squared: the square of the
    distance of the surfaces, None where the truth does not give it."""

    category: str
    name: str
    a: MeshData
    b: MeshData
    relation: str
    squared: Fraction | None = None


class MeshFamily(Protocol):
    """A module of `mesh_families`."""

    CATEGORY: str

    def cases(self, seed: int) -> Iterator[MeshPair]: ...


def mesh_of_polygons(polygons: Sequence[Sequence[Sequence[float]]], turn: int = 0) -> MeshData:
    """Convex polygons as fans, equal corners shared; `turn` chooses where the fans start."""
    index: dict[tuple[float, float, float], int] = {}
    triangles = []
    for number, polygon in enumerate(polygons):
        corners = [index.setdefault(p, len(index)) for p in vertices(polygon)]
        start = (turn + number) % len(corners) if turn else 0
        corners = corners[start:] + corners[:start]
        triangles += [(corners[0], q, r) for q, r in pairwise(corners[1:])]
    return MeshData(tuple(index), tuple(triangles))
