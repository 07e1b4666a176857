"""The depth of two meshes by dense sampling: exact mesh checks, nothing of the search.

Along each direction the translations of A are bisected between one that frees it and one that does
not. What comes out frees A, so it is an upper bound; and no translation that frees A may be shorter
than a lower bound that somebody claims.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

from satcheck.core import Mesh, Surface, mesh_relation

Vector = tuple[float, float, float]

GOLDEN_ANGLE = math.pi * (3 - math.sqrt(5))
BISECTIONS = 40
SCAN = 48


def directions(count: int) -> Iterator[Vector]:
    """Unit vectors evenly over the sphere: a Fibonacci lattice."""
    for k in range(count):
        z = 1 - (2 * k + 1) / count
        r = math.sqrt(1 - z * z)
        yield (r * math.cos(k * GOLDEN_ANGLE), r * math.sin(k * GOLDEN_ANGLE), z)


def is_free(a: Mesh, b: Surface, t: Vector, solid: bool = True) -> bool:
    relation = mesh_relation(Surface(a.translated(t), solid), b).relation
    return relation in ("separated", "touching")


def along(way: Vector, length: float) -> Vector:
    return (way[0] * length, way[1] * length, way[2] * length)


def sampled_depth(a: Mesh, b: Surface, reach: float, count: int) -> float:
    """The shortest translation found that frees A; `reach` is a length that frees it somewhere.

    Every way is scanned outward first, for a body may be free before it collides again.
    """
    best = reach
    for way in directions(count):
        step = best / SCAN
        for k in range(SCAN):
            if is_free(a, b, along(way, k * step)):
                low, high = (k - 1) * step, k * step
                for _ in range(BISECTIONS):
                    middle = 0.5 * (low + high)
                    if is_free(a, b, along(way, middle)):
                        high = middle
                    else:
                        low = middle
                best = min(best, high)
                break
    return best
