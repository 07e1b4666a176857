"""Pairs of outlines for bench/outlines.py, with their truth in rational arithmetic."""

from __future__ import annotations

import math
from collections.abc import Callable
from fractions import Fraction
from typing import Any

import numpy as np
from msgspec import Struct
from numpy.typing import NDArray

Polygon = NDArray[np.float64]
PolygonPair = tuple[Polygon, Polygon]
# Heights and distances in float64 that are this close to the best one, as a share of the size,
# compete in rational arithmetic.
CLOSE = 1e-9


class PairSet(Struct):
    """signed: the gap, or minus the depth; -1.0 for concave outlines that overlap. Concave outlines
    may be lists of loops: an outer one, and holes in it."""

    title: str
    pairs: list[tuple[Any, Any]]
    signed: NDArray[np.float64]
    convex: bool


def convex_sets(rng: np.random.Generator, count: int) -> list[PairSet]:
    drawn = {f"convex {k}": convex_pairs(rng, k, count) for k in (4, 8, 32, 100)}
    drawn |= {
        name: squares(rng, count, ulps)
        for name, ulps in (("flush", 0), ("gap 1 ulp", 1), ("deep 1 ulp", -1))
    }
    drawn["corner on edge"] = corners_on_edges(rng, count)
    drawn["contained"] = [
        (ring(rng, 8), ring(rng, 6) * 0.3 + rng.uniform(-0.3, 0.3, 2)) for _ in range(count)
    ]
    return [
        PairSet(title, pairs, np.array([signed_distance(*pair) for pair in pairs]), True)
        for title, pairs in drawn.items()
    ]


def concave_sets(rng: np.random.Generator, count: int) -> list[PairSet]:
    sets: dict[str, list[tuple[Any, Any, bool]]] = {}
    for k in (16, 100, 1000):
        pairs = [pair for pair in stars(rng, k, count) if not touches(*pair)]
        sets[f"concave {k}"] = [(a, b, star_truth(a, b)) for a, b in pairs]
    combs = [comb(rng, 12) for _ in range(count)]
    for title, ulps in (("flush", 0.0), ("gap 1 ulp", 1.0), ("deep 1 ulp", -1.0)):
        sets[f"combs {title}"] = [(teeth, counterpart(teeth, ulps), ulps < 0) for teeth in combs]
    sets["concave contained"] = [
        (a * 4, b * 0.25, True) for a, b in stars(rng, 100, count, apart=0.0)
    ]
    sets["peg in a hole"] = [peg_in_hole(rng) for _ in range(count)]
    sets["flush, as concave"] = [(a, b, False) for a, b in squares(rng, count, 0)]
    return [
        PairSet(
            title,
            [(a, b) for a, b, _ in pairs],
            np.array([-1.0 if meet else distance(a, b) for a, b, meet in pairs]),
            False,
        )
        for title, pairs in sets.items()
    ]


def loops_of(outline: Any) -> list[Polygon]:
    return outline if isinstance(outline, list) else [outline]


def distance(a: Any, b: Any) -> float:
    """Of outlines that do not overlap, correctly to a few ulp."""
    squares = (_best(p, q, _squares, min, per_edge=False) for p in loops_of(a) for q in loops_of(b))
    return math.sqrt(min(squares))


def peg_in_hole(rng: np.random.Generator) -> tuple[list[Polygon], Polygon, bool]:
    """A plate with a convex hole, a convex peg that about fits, and whether they overlap."""
    plate = np.array([[-2.0, -2], [2, -2], [2, 2], [-2, 2]])
    hole, peg = ring(rng, 32), ring(rng, 16) * 0.7 + rng.uniform(-0.25, 0.25, 2)
    sides = (
        _sign(p, q, c) for p, q in zip(hole, np.roll(hole, -1, axis=0), strict=True) for c in peg
    )
    return [plate, hole[::-1]], peg, min(sides) < 0


def _sign(p: Polygon, q: Polygon, c: Polygon) -> Fraction:
    (px, py), (qx, qy), (cx, cy) = ([Fraction(x) for x in point.tolist()] for point in (p, q, c))
    return (qx - px) * (cy - py) - (qy - py) * (cx - px)


def ring(rng: np.random.Generator, corners: int) -> Polygon:
    """Convex: corners on a circle."""
    turns = (np.arange(corners) + rng.uniform(0, 0.6, corners)) * 2 * np.pi / corners
    return np.column_stack((np.cos(turns), np.sin(turns)))


def convex_pairs(rng: np.random.Generator, corners: int, count: int) -> list[PolygonPair]:
    """From deep overlaps to gaps of about the width of a polygon."""
    pairs = []
    for _ in range(count):
        turn, apart = rng.uniform(0, 2 * np.pi), rng.uniform(0, 4)
        shift = apart * np.array([np.cos(turn), np.sin(turn)])
        pairs.append((ring(rng, corners), ring(rng, corners) + shift))
    return pairs


def squares(rng: np.random.Generator, count: int, ulps: int) -> list[PolygonPair]:
    """Two squares edge to edge, the second moved to the right by so many ulp."""
    pairs = []
    for _ in range(count):
        x, y = rng.uniform(1, 1.9), rng.uniform(-0.5, 0.5)
        start = x + ulps * np.spacing(x)
        left = np.array([[0, 0], [x, 0], [x, 1], [0, 1]])
        pairs.append((left, np.array([[start, y], [3, y], [3, y + 1], [start, y + 1]])))
    return pairs


def corners_on_edges(rng: np.random.Generator, count: int) -> list[PolygonPair]:
    """A corner of a triangle on the middle of a slope, exactly: coordinates have few digits."""
    pairs = []
    for _ in range(count):
        x, y = rng.integers(1, 1000, 2) / 512
        slope = np.array([[0, 0], [2 * x, 0], [0, 2 * y]])
        pairs.append((slope, np.array([[x, y], [x + 3 * y, y + x], [x + y, y + 3 * x]])))
    return pairs


def stars(
    rng: np.random.Generator, corners: int, count: int, apart: float = 1.9
) -> list[PolygonPair]:
    """Concave, on a grid, so that 64 bits hold every orientation."""

    def star() -> Polygon:
        turns = np.arange(corners) * 2 * np.pi / corners
        radii = rng.uniform(0.5, 1, corners)[:, None] * 2**20
        return np.asarray(np.rint(radii * np.column_stack((np.cos(turns), np.sin(turns)))))

    return [(star(), star() + np.rint(rng.uniform(-apart, apart, 2) * 2**20)) for _ in range(count)]


def comb(rng: np.random.Generator, teeth: int) -> Polygon:
    """Teeth of random widths and lengths upwards, from a bar."""
    across = np.cumsum(rng.uniform(0.5, 1.5, 2 * teeth))
    points = [(0.0, -1.0), (float(across[-1]), -1.0)]
    for k in range(teeth - 1, -1, -1):
        height = float(rng.uniform(1, 2))
        right, left = float(across[2 * k + 1]), float(across[2 * k])
        points += [(right, height), (left, height)]
        if k:
            points += [(left, 0.5), (float(across[2 * k - 1]), 0.5)]
    points += [(float(across[0]), 0.0), (0.0, 0.0)]
    return np.array(points)


def counterpart(teeth: Polygon, ulps: float) -> Polygon:
    """What fills the space above a comb up to y = 3, raised by so many ulp of its coordinates."""
    upper = teeth[2:]
    raised = upper[:, 1] + ulps * np.spacing(upper[:, 1])
    sides = [[upper[-1, 0], 3.0], [upper[0, 0], 3.0]]
    return np.concatenate((np.column_stack((upper[:, 0], raised))[::-1], sides[::-1]))


def signed_distance(a: Polygon, b: Polygon) -> float:
    """Of convex polygons: the gap, or minus the depth, correctly to a few ulp."""
    heights = _best(a, b, _heights, max, per_edge=True)
    if heights <= 0:
        return -math.sqrt(-heights)
    return math.sqrt(_best(a, b, _squares, min, per_edge=False))


def _best(
    a: Polygon,
    b: Polygon,
    measure: Callable[..., Any],
    choose: Callable[..., Any],
    *,
    per_edge: bool,
) -> Fraction:
    """The best figure over edges of one polygon and corners of the other."""
    figures: list[tuple[float, Polygon, Polygon, Polygon]] = []
    for one, other in ((a, b), (b, a)):
        ends = np.roll(one, -1, axis=0)
        rough = measure(one[:, None], ends[:, None], other[None])
        for k in range(len(one)):
            corners = other if per_edge else other[rough[k] <= rough.min() + CLOSE]
            if len(corners):
                figures.append((float(rough[k].min()), one[k], ends[k], corners))
    best = choose(figure[0] for figure in figures)
    chosen: Fraction = choose(
        min(measure(_exact(p), _exact(q), _exact(c)) for c in corners)
        for rough, p, q, corners in figures
        if abs(rough - best) <= CLOSE
    )
    return chosen


def _exact(point: Polygon) -> Any:
    return np.array([Fraction(x) for x in point.tolist()], dtype=object)


def _heights(p: Any, q: Any, c: Any) -> Any:
    """Squared heights above an edge, with their signs."""
    along, w = q - p, c - p
    cross = along[..., 1] * w[..., 0] - along[..., 0] * w[..., 1]
    return cross * abs(cross) / (along**2).sum(axis=-1)


def _squares(p: Any, q: Any, c: Any) -> Any:
    """Squared distances from an edge."""
    along, w = q - p, c - p
    share = (along * w).sum(axis=-1) / (along**2).sum(axis=-1)
    share = np.minimum(np.maximum(share, 0), 1)
    return ((w - along * np.asarray(share)[..., None]) ** 2).sum(axis=-1)


def touches(a: Polygon, b: Polygon) -> bool:
    """Whether edges meet, but none cross in their inner points."""
    proper, meet = _crossings(a, b)
    return meet and not proper


def star_truth(a: Polygon, b: Polygon) -> bool:
    return _crossings(a, b)[0] or within(a[0], b) or within(b[0], a)


def _crossings(a: Polygon, b: Polygon) -> tuple[bool, bool]:
    p, r = a.astype(np.int64)[:, None], b.astype(np.int64)[None]
    q, s = np.roll(p, -1, axis=0), np.roll(r, -1, axis=1)
    sides = [np.sign(turn(*t)) for t in ((p, q, r), (p, q, s), (r, s, p), (r, s, q))]
    first, second = sides[0] * sides[1], sides[2] * sides[3]
    return bool(((first < 0) & (second < 0)).any()), bool(((first <= 0) & (second <= 0)).any())


def turn(p: NDArray[Any], q: NDArray[Any], r: NDArray[Any]) -> NDArray[Any]:
    d, e = q - p, r - p
    return np.asarray(d[..., 0] * e[..., 1] - d[..., 1] * e[..., 0])


def within(point: Polygon, polygon: Polygon) -> bool:
    p, q = polygon.astype(np.int64), np.roll(polygon, -1, axis=0).astype(np.int64)
    x = point.astype(np.int64)
    up, down = (p[:, 1] <= x[1]) & (q[:, 1] > x[1]), (p[:, 1] > x[1]) & (q[:, 1] <= x[1])
    side = turn(p, q, np.broadcast_to(x, p.shape))
    return bool((up & (side > 0)).sum() != (down & (side < 0)).sum())
