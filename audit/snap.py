"""The last touch on a way out: along the normal of a blocking face, to the length of a vertex."""

from __future__ import annotations

import math
from collections.abc import Iterator

from satcheck.audit.pair import Pair
from satcheck.audit.report import Vector
from satcheck.audit.trials import Trials
from satcheck.audit.triangles import Crossing, triangle_normal
from satcheck.audit.vectors import dot, scaled

# Where to look for the face that blocks the way: a little before its end. Only a face that the way
# leaves nearly along its normal can offer a shorter one.
BLOCKED_FRACTION = 0.98
SNAP_COSINE = 0.9


def snapped(pair: Pair, best: Vector, lower: float, trials: Trials) -> Vector:
    """The way out along the normal of a face that blocks a slightly shorter one, if that is
    shorter: A is then free exactly where a vertex leaves the plane of that face, so these lengths
    are searched, not the lengths in between."""
    length = math.hypot(*best)
    way = scaled(best, 1 / length)
    found = trials.relation_at(scaled(best, BLOCKED_FRACTION))
    if found is None or found.triangle_a < 0 or found.triangle_b < 0:
        return best
    for out, lengths in planes_left(pair, (found.triangle_a, found.triangle_b)):
        if dot(out, way) < SNAP_COSINE:
            continue
        shorter = [s for s in lengths if lower <= s < length]
        free = _least_free(out, shorter, trials)
        if free is not None:
            best, length = free, math.hypot(*free)
    return best


def planes_left(pair: Pair, crossing: Crossing) -> Iterator[tuple[Vector, list[float]]]:
    """Per triangle: the direction in which A leaves its plane, and the lengths, ascending, at which
    one vertex of the other body after another has left it."""
    import numpy as np

    for body, other, index, side in (
        (pair.b, pair.a, crossing[1], 1.0),
        (pair.a, pair.b, crossing[0], -1.0),
    ):
        normal = triangle_normal(body, index)
        if normal is None:
            continue
        heights = (other.mesh.vertices - body.mesh.corners(index)[0]) @ np.array(normal)
        yield scaled(normal, side), np.unique(-heights[heights < 0]).tolist()


def _least_free(way: Vector, lengths: list[float], trials: Trials) -> Vector | None:
    """Binary search, as if every longer translation along the way were free as well."""
    best = None
    start, end = 0, len(lengths)
    while start < end and trials.left:
        middle = (start + end) // 2
        t = scaled(way, lengths[middle])
        if trials.frees(t):
            best, end = t, middle
        else:
            start = middle + 1
    return best
