"""Converts convex bodies to intersections of half-spaces normal . x <= offset."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np
from msgspec import Struct

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

# Limit on points times planes, and on points: at most 32 MiB.
_ENTRIES_AT_ONCE: Final = 1 << 22
_POINTS_AT_ONCE: Final = 1 << 12


class HalfSpaces(Struct, frozen=True):
    """normals: (f, 3), unit, outward; offsets: (f,)."""

    normals: Floats
    offsets: Floats

    @property
    def points_at_once(self) -> int:
        """The number of points that can be compared with all planes in little memory."""
        return max(1, min(_POINTS_AT_ONCE, _ENTRIES_AT_ONCE // len(self.offsets)))

    def slack(self, points: Floats) -> Floats:
        """(n, f): the distance of each point (n, 3) below each plane; negative outside."""
        slack: Floats = self.offsets - points @ self.normals.T
        return slack

    def heights(self, points: Floats) -> Floats:
        """(n,): the height of each point (n, 3) above the highest plane; at most 0 inside."""
        chunks = [
            -self.slack(points[first : first + self.points_at_once]).min(axis=1)
            for first in range(0, len(points), self.points_at_once)
        ]
        return np.concatenate(chunks)


def around(corners: Floats, triangles: NDArray[np.integer]) -> HalfSpaces:
    """The half-spaces of a convex body with vertices (n, 3) and outward triangles (m, 3)."""
    a, b, c = np.moveaxis(corners[triangles], 1, 0)
    normals = np.cross(b - a, c - a)
    lengths = np.linalg.norm(normals, axis=1)
    normals = normals[lengths > 0.0] / lengths[lengths > 0.0, None]
    return HalfSpaces(normals, (normals @ corners.T).max(axis=1))
