"""What SAT costs against GJK + EPA on the convex hulls of a pair, by their number of vertices."""

from __future__ import annotations

from time import perf_counter
from typing import Literal

import numpy as np
from msgspec import Struct
from numpy.typing import NDArray

from satcheck import core
from satcheck.scene import Body

# Hulls of so many vertices, and last those of the bodies themselves, up to MOST.
COUNTS = (4, 8, 16, 32, 64, 128)
MOST = 256
_ROUNDS = 5
# A round takes about this long, in seconds, and asks at most so often.
_ROUND = 0.002
_MOST_QUERIES = 1000

Method = Literal["sat", "gjk"]
METHODS: tuple[Method, ...] = ("sat", "gjk")


class MethodCost(Struct, frozen=True):
    """The depth of two hulls, asked by both methods; nanoseconds a query, the fastest of rounds.

    vertices: of the hull of A and of B. agree: both methods say the same relation.
    """

    vertices: tuple[int, int]
    sat: float
    gjk: float
    agree: bool


def method_costs(a: Body, b: Body, seconds: float) -> tuple[MethodCost, ...]:
    """Of hulls of ever more vertices, begun within so many seconds. Empty for flat bodies."""
    start = perf_counter()
    hulls = [body.world_mesh().convex_hull() for body in (a, b)]
    if any(hull.dimension < 3 for hull in hulls):
        return ()
    points = [hull.vertices for hull in hulls]
    wanted = [count for count in COUNTS if count < max(map(len, points))]
    if max(map(len, points)) <= MOST:
        wanted.append(MOST)
    costs: list[MethodCost] = []
    for count in wanted:
        if perf_counter() - start >= seconds:
            break
        costs.append(_cost([core.Hull(_spread(each, count)) for each in points]))
    return tuple(costs)


def _spread(points: NDArray[np.float64], count: int) -> NDArray[np.float64]:
    """At most `count` of the points, far from each other: each next one is the farthest from those
    before it (Gonzalez, Clustering to minimize the maximum intercluster distance, 1985)."""
    if len(points) <= count:
        return points
    chosen = [0]
    distance = np.linalg.norm(points - points[0], axis=1)
    while len(chosen) < count:
        chosen.append(int(distance.argmax()))
        distance = np.minimum(distance, np.linalg.norm(points - points[chosen[-1]], axis=1))
    return np.ascontiguousarray(points[chosen])


def _cost(shapes: list[core.Shape]) -> MethodCost:
    best = dict.fromkeys(METHODS, float("inf"))
    relations = {}
    for _ in range(_ROUNDS):
        for method in METHODS:
            seconds, relations[method] = _timed(shapes, method, 1)
            queries = int(min(max(_ROUND / max(seconds, 1e-9), 1), _MOST_QUERIES))
            seconds, _outcome = _timed(shapes, method, queries)
            best[method] = min(best[method], seconds / queries)
    return MethodCost(
        vertices=(shapes[0].vertex_count, shapes[1].vertex_count),
        sat=best["sat"] * 1e9,
        gjk=best["gjk"] * 1e9,
        agree=relations["sat"] == relations["gjk"],
    )


def _timed(shapes: list[core.Shape], method: Method, queries: int) -> tuple[float, int]:
    """(seconds for all, the outcome)."""
    a, b = np.zeros(queries, np.uint32), np.ones(queries, np.uint32)
    still = np.tile([0.0, 0, 0, 0, 0, 0, 1], (queries, 1))
    start = perf_counter()
    results = core.check_pairs(shapes, a, b, still, still, query="depth", method=method, threads=1)
    return perf_counter() - start, int(results.outcome[0])
