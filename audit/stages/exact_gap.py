"""The gap of meshes to the last rounding, where float64 leaves more of it open: needles, and bodies
that are very close for their size."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from fractions import Fraction
from typing import Any

from msgspec import Struct

from satcheck import core
from satcheck.audit.pair import Pair
from satcheck.audit.stages.exact_hulls import nearest_point
from satcheck.report.judge import EXACT_WIDTH
from satcheck.report.report import Vector, Witness
from satcheck.verify.exact import Point, dot, nearest_to_origin, root, sub
from satcheck.verify.pairs import pair_of


class ExactGap(Struct, frozen=True):
    """lower <= the distance of the points <= upper, with at most one rounding between them.
    distance: rounded. normal: unit, from A to B."""

    lower: float
    upper: float
    distance: float
    normal: Vector
    witness: Witness


def gap_of_hulls(pair: Pair) -> ExactGap | None:
    """The gap of two convex meshes; None: they have a common point."""
    a, b = pair.a.checked(), pair.b.checked()
    if a.world is None or b.world is None:
        raise AssertionError("a placed body has a world mesh")
    # Of faces that face each other many points are nearest. The order of A and B chooses none.
    swapped = pair.b.mesh.to_bytes() < pair.a.mesh.to_bytes()
    placed = pair_of(b, a, b.world, a.world) if swapped else pair_of(a, b, a.world, b.world)
    weights = nearest_point(placed).weights
    unit = 1 << placed.a.k
    ends = (
        _blend(((w, placed.a.points[i]) for (i, _), w in weights.items()), unit),
        _blend(((w, placed.b.points[j]) for (_, j), w in weights.items()), unit),
    )
    return _of_points(*(reversed(ends) if swapped else ends))


def gap_of_triangles(pair: Pair, near: core.MeshDistance) -> ExactGap | None:
    """The gap of the two triangles that float64 calls nearest: at least that of the surfaces."""
    of_a = _exact(pair.a.mesh.corners(near.triangle_a))
    of_b = _exact(pair.b.mesh.corners(near.triangle_b))
    swapped = of_b < of_a  # as in gap_of_hulls
    corners = (of_b, of_a) if swapped else (of_a, of_b)
    ends = [(i, j) for i in range(3) for j in range(3)]
    steps: Any = [sub(corners[0][i], corners[1][j]) for i, j in ends]
    _, weights = nearest_to_origin(steps)
    nearest = (
        _blend(((w, corners[0][ends[k][0]]) for k, w in weights.items()), 1),
        _blend(((w, corners[1][ends[k][1]]) for k, w in weights.items()), 1),
    )
    return _of_points(*(reversed(nearest) if swapped else nearest))


def narrowed(
    lower: float, upper: float, compare: Callable[[float], int | None]
) -> tuple[float, float]:
    """The bounds of a positive length, as narrow as rounding if the comparisons can tell. compare:
    the exact sign of (length - a number); None: unknown."""
    while upper - lower > EXACT_WIDTH * upper:
        # Bounds that are far apart first agree on the power of two.
        middle = 0.5 * (lower + upper) if upper < 4 * lower else _between(lower, upper)
        if not lower < middle < upper:
            break
        side = compare(middle)
        if side is None:
            break
        lower, upper = (middle if side >= 0 else lower), (middle if side <= 0 else upper)
    return lower, upper


def _between(lower: float, upper: float) -> float:
    return math.sqrt(max(lower, math.nextafter(0.0, 1.0))) * math.sqrt(upper)


def _exact(points: Sequence[Vector]) -> list[Point]:
    return [(Fraction(x), Fraction(y), Fraction(z)) for x, y, z in points]


def _blend(points: Iterable[tuple[Fraction, Sequence[Any]]], unit: int) -> Point:
    x = y = z = Fraction(0)
    for weight, p in points:
        x, y, z = x + weight * p[0], y + weight * p[1], z + weight * p[2]
    return x / unit, y / unit, z / unit


def _of_points(a: Point, b: Point) -> ExactGap | None:
    step: Point = sub(b, a)
    squared = Fraction(dot(step, step))
    if squared == 0:
        return None
    length = root(squared)[0]
    distance = float(length)
    side = Fraction(distance) ** 2 - squared
    lower = distance if side <= 0 else math.nextafter(distance, 0.0)
    upper = distance if side >= 0 else math.nextafter(distance, math.inf)
    x, y, z = (float(c / length) for c in step)
    return ExactGap(lower, upper, distance, (x, y, z), Witness(_rounded(a), _rounded(b)))


def _rounded(p: Point) -> Vector:
    return float(p[0]), float(p[1]), float(p[2])
