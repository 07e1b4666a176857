"""Fits convex parts to limits: few parts, few vertices in each.

Parts are merged, the two first whose hull adds the least volume. CoACD has limits of its own
(`max_convex_hull`, `max_ch_vertex`); it crashes on some meshes with the first (its issues 63 and
71), and does not count vertices after its hulls are made.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations
from typing import TYPE_CHECKING

import numpy as np

from satcheck.core import Mesh, Polytope
from satcheck.decompose import errors
from satcheck.decompose.error_bounds import highest, planes_of
from satcheck.decompose.errors import Deadline, DecompositionError
from satcheck.decompose.settings import LEAST_VERTICES

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]


def merged_parts(parts: Sequence[Polytope], most: int, deadline: Deadline) -> tuple[Polytope, ...]:
    """Return at most so many parts, which contain the given ones. Raises DecompositionError at the
    deadline."""
    bodies = list(parts)
    volumes = [volume(body) for body in bodies]
    added = np.full((len(bodies), len(bodies)), np.inf)

    def compare(a: int, b: int) -> None:
        deadline.check()
        added[a, b] = volume(_joined(bodies[a], bodies[b])) - volumes[a] - volumes[b]

    left = list(range(len(bodies)))
    for a, b in combinations(left, 2) if len(left) > most else ():
        compare(a, b)
    while len(left) > most:
        a, b = divmod(int(added.argmin()), len(bodies))
        bodies[a] = _joined(bodies[a], bodies[b])
        volumes[a] = volume(bodies[a])
        left.remove(b)
        added[b], added[:, b] = np.inf, np.inf
        for other in left:
            if other != a:
                compare(min(a, other), max(a, other))
    return tuple(bodies[number] for number in left)


def simplified(points: Floats, most: int, deadline: Deadline) -> Polytope:
    """Return a hull of at most so many of the points (n, 3), the farthest from the hull of those
    before it first. Raises DecompositionError if the points are flat, and at the deadline."""
    whole = hull_of(points)
    if whole.dimension == 3 and whole.vertex_count <= most:
        return whole
    chosen = _corners(points)
    while True:
        deadline.check()
        hull = hull_of(points[chosen])
        if hull.dimension < 3:
            raise DecompositionError(errors.FLAT, "a part is too thin for the numbers of the file")
        heights = highest(points, *planes_of(hull, deadline), deadline)
        farthest = int(heights.argmax())
        if len(chosen) >= most or heights[farthest] <= 0.0 or farthest in chosen:
            return hull
        chosen.append(farthest)


def hull_of(points: Floats) -> Polytope:
    """Return the exact hull of points (n, 3)."""
    return Mesh(np.ascontiguousarray(points), np.zeros((0, 3), np.uint32)).convex_hull()


def _corners(points: Floats) -> list[int]:
    """Return the numbers of points that are far from those before them, from the first of them on,
    from their line, and from their plane."""
    chosen = [int(np.lexsort(points.T)[0])]
    apart = points - points[chosen[0]]
    while len(chosen) < LEAST_VERTICES:
        farthest = int(np.einsum("ij,ij->i", apart, apart).argmax())
        chosen.append(farthest)
        axis = apart[farthest] / (np.linalg.norm(apart[farthest]) or 1.0)
        apart = apart - np.outer(apart @ axis, axis)
    return chosen


def _joined(a: Polytope, b: Polytope) -> Polytope:
    return hull_of(np.concatenate([a.vertices, b.vertices]))


def volume(body: Polytope) -> float:
    return body.to_mesh().topology().volume
