"""Short ways out for A, guessed on convex parts: candidates for an upper bound of the depth.

With parts A_i and B_j the forbidden translations of A are the union of the convex sets
C_ij = B_j (-) A_i. We look for points of least norm outside that union: leave it along a direction,
keep the facet that was left last, and project the origin onto it; where another C_ij still covers
the projection, keep its nearest facet too and project onto the intersection of their half-spaces,
until nothing covers it. Every start ends in a local minimum or is dropped. The method is that of
PolyDepth (Changsoo Je, Min Tang, Youngeun Lee, Minkyoung Lee, Young J. Kim, "PolyDepth: Real-Time
Penetration Depth Computation Using Iterative Contact-Space Projection", 2012), with convex parts
in the place of its continuous collision detection between meshes.

Nothing here is proven: the caller checks each candidate on the meshes.
"""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from satcheck import core
from satcheck.audit.report import Vector
from satcheck.audit.vectors import dot

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

    from satcheck.audit.parts import Part

    Array = npt.NDArray[np.float64]

PENETRATING = 2  # the outcome's number in batched results
TRACE_STEPS = 24
PROJECTIONS = 12
# A facet nearly parallel to the way out would be left only far away: step as if at this cosine.
LEAST_COSINE = 0.05
# Part pairs that overlap by less than this fraction of the reach count as free: the projection
# lies on facets, where rounding alone would otherwise find an overlap for ever.
FREE_FRACTION = 1e-12


@dataclass(frozen=True, slots=True)
class Wall:
    """The half-space out . t >= offset of translations t that one pair of parts does not forbid."""

    out: Vector
    offset: float


class PartPairs:
    """All pairs of parts, and how deep the deepest of them overlaps once A is translated."""

    def __init__(self, parts_a: list[Part], parts_b: list[Part], reach: float) -> None:
        import numpy as np

        self._shapes = [part.shape for part in (*parts_a, *parts_b)]
        self._low_a, self._high_a = np.array([part.bounds for part in parts_a]).transpose(1, 0, 2)
        self._low_b, self._high_b = np.array([part.bounds for part in parts_b]).transpose(1, 0, 2)
        self._free = FREE_FRACTION * reach

    def wall_at(self, t: Vector) -> Wall | None:
        """The nearest facet of the deepest forbidden set at t; None where t is free."""
        import numpy as np

        shift = np.array(t)
        meets = (self._low_a[:, None] + shift <= self._high_b[None]) & (
            self._low_b[None] <= self._high_a[:, None] + shift
        )
        index_a, index_b = np.nonzero(meets.all(axis=2))
        if not len(index_a):
            return None
        poses = np.zeros((len(index_a), 7))
        poses[:, 6] = 1.0
        still = poses.copy()
        poses[:, :3] = shift
        found = core.check_pairs(
            self._shapes,
            index_a.astype(np.uint32),
            (index_b + len(self._low_a)).astype(np.uint32),
            poses,
            still,
            query="depth",
            threads=1,
        )
        depth = np.where(found.outcome == PENETRATING, -found.distance, 0.0)
        deepest = int(np.argmax(depth))
        if depth[deepest] <= self._free:
            return None
        out = -found.normal[deepest]
        return Wall(_vector(out), float(out @ shift + depth[deepest]))


def short_ways_out(pairs: PartPairs, ways: list[Vector], reach: float) -> list[Vector]:
    """Translations that free A's parts from B's, shortest first.

    ways: unit directions to start in; reach: nothing longer is of interest.
    """
    found = (_way_out(pairs, way, reach) for way in ways)
    out = {t for t in found if t is not None and math.hypot(*t) <= reach}
    return sorted(out, key=lambda t: (math.hypot(*t), t))


def _way_out(pairs: PartPairs, way: Vector, reach: float) -> Vector | None:
    last = _last_wall(pairs, way, reach)
    if last is None:
        return None
    walls = [last]
    for _ in range(PROJECTIONS):
        nearest = nearest_point(walls)
        if nearest is None or math.hypot(*nearest) > reach:
            return None
        wall = pairs.wall_at(nearest)
        if wall is None:
            return nearest
        walls.append(wall)
    return None


def _last_wall(pairs: PartPairs, way: Vector, reach: float) -> Wall | None:
    """The wall behind the first free translation along the way; None if there is none in reach."""
    length, last = 0.0, None
    for _ in range(TRACE_STEPS):
        wall = pairs.wall_at((length * way[0], length * way[1], length * way[2]))
        if wall is None:
            return last
        cosine = dot(wall.out, way)
        length += (wall.offset - length * cosine) / max(cosine, LEAST_COSINE)
        last = wall
        if length > reach / LEAST_COSINE:
            return None
    return None


def nearest_point(walls: list[Wall]) -> Vector | None:
    """The point of least norm beyond all walls, the newest of which it lies on; None if there is
    none: at most three walls hold it, so all such sets are tried."""
    import numpy as np

    normals = np.array([wall.out for wall in walls])
    offsets = np.array([wall.offset for wall in walls])
    slack = FREE_FRACTION * float(np.abs(offsets).max())
    newest, best = len(walls) - 1, None
    for count in range(min(3, len(walls))):
        for others in itertools.combinations(range(newest), count):
            chosen = [*others, newest]
            gram = normals[chosen] @ normals[chosen].T
            try:
                weights = np.linalg.solve(gram, offsets[chosen])
            except np.linalg.LinAlgError:
                continue
            point = weights @ normals[chosen]
            beyond = bool((normals @ point >= offsets - slack).all())
            if beyond and (best is None or point @ point < best @ best):
                best = point
    return None if best is None else _vector(best)


def _vector(values: Array) -> Vector:
    return float(values[0]), float(values[1]), float(values[2])
