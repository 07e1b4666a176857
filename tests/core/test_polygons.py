"""Convex polygons in a plane against rational arithmetic."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from fractions import Fraction

import numpy as np
import pytest
from numpy.typing import NDArray

from satcheck.core import PairResult, Polygons, check_polygon_pair, check_polygons
from tests.oracles.exact_polygons import signed_square

Corners = NDArray[np.float64]
# The relative error of a figure (`kAccurate`), squared.
ACCURATE = Fraction(1, 2**38)


def hull(points: Corners) -> Corners:
    """The corners of the convex hull, exactly, counter-clockwise (A. M. Andrew 1979)."""
    ordered = sorted({(x, y) for x, y in points.tolist()})
    halves = []
    for run in (ordered, ordered[::-1]):
        half: list[tuple[float, float]] = []
        for p in run:
            while len(half) > 1 and turn(half[-2], half[-1], p) <= 0:
                half.pop()
            half.append(p)
        halves.append(half[:-1])
    return np.array(halves[0] + halves[1])


def turn(p: tuple[float, float], q: tuple[float, float], r: tuple[float, float]) -> Fraction:
    (px, py), (qx, qy), (rx, ry) = ([Fraction(x) for x in point] for point in (p, q, r))
    return (qx - px) * (ry - py) - (qy - py) * (rx - px)


def outlines(draw: Callable[[], Corners], count: int) -> Iterator[Corners]:
    made = 0
    while made < count:
        corners = hull(draw())
        if len(corners) > 2:
            made += 1
            yield corners


def on_grid(rng: np.random.Generator) -> Iterator[Corners]:
    """Small grids: shared lines, corners on edges, equal depths."""
    return outlines(
        lambda: rng.integers(0, 5, (int(rng.integers(3, 9)), 2)).astype(np.float64), 400
    )


def round_ones(rng: np.random.Generator) -> Iterator[Corners]:
    def draw() -> Corners:
        turns = rng.uniform(0, 2 * math.pi, int(rng.choice([3, 6, 20, 60])))
        circle = np.column_stack((np.cos(turns), np.sin(turns)))
        return np.asarray(circle * rng.uniform(0.1, 1) + rng.uniform(-1.2, 1.2, 2))

    return outlines(draw, 240)


def an_ulp_off(rng: np.random.Generator) -> Iterator[Corners]:
    """Neighbours of grid points, by up to two ulp."""

    def draw() -> Corners:
        points = rng.integers(1, 5, (5, 2)) * 0.3
        return np.asarray(points + rng.integers(-2, 3, (5, 2)) * np.spacing(points))

    return outlines(draw, 400)


def nearly_parallel(rng: np.random.Generator) -> Iterator[Corners]:
    """Long edges along one line, turned by about 1e-16."""

    def draw() -> Corners:
        x = rng.uniform(-1, 1, 4)
        side = rng.choice([-1.0, 1.0])
        low = x[:2] / 3 + rng.integers(-2, 3, 2) * 2.0**-54
        high = x[2:] / 3 + side * rng.uniform(0.1, 1, 2)
        return np.column_stack((x, np.concatenate((low, high))))

    return outlines(draw, 400)


def far_away(rng: np.random.Generator) -> Iterator[Corners]:
    return outlines(lambda: np.rint(rng.normal(0, 3, (6, 2))) * 2.0**-20 + 2.0**32, 240)


def of_all_sizes(rng: np.random.Generator) -> Iterator[Corners]:
    def draw() -> Corners:
        size = 10.0 ** rng.integers(-40, 44, (5, 2))
        return np.asarray(rng.normal(0, 1, (5, 2)) * size)

    return outlines(draw, 240)


def near_zero(rng: np.random.Generator) -> Iterator[Corners]:
    """Corners at distances far below the size, down to subnormal numbers."""

    def draw() -> Corners:
        size = 10.0 ** rng.integers(-310, 1, (5, 2))
        return np.concatenate((rng.normal(0, 1, (5, 2)) * size, rng.normal(0, 1, (1, 2))))

    return outlines(draw, 240)


FAMILIES = [on_grid, round_ones, an_ulp_off, nearly_parallel, far_away, of_all_sizes, near_zero]


def polygons_of(outlines: list[Corners]) -> Polygons:
    starts = np.cumsum([0, *map(len, outlines)]).astype(np.uint32)
    return Polygons(np.concatenate(outlines), starts)


@pytest.mark.parametrize("family", FAMILIES)
def test_outcomes_and_figures_are_those_of_rational_arithmetic(
    family: Callable[[np.random.Generator], Iterator[Corners]],
) -> None:
    drawn = list(family(np.random.default_rng(5)))
    polygons = polygons_of(drawn)
    first = np.arange(0, len(drawn), 2, dtype=np.uint32)
    asked = {
        query: check_polygons(polygons, first, first + np.uint32(1), query=query)
        for query in ("overlap", "depth", "distance")
    }
    seen = set()
    for row, k in enumerate(first.tolist()):
        truth = signed_square(drawn[k], drawn[k + 1])
        expected = "separated" if truth > 0 else "penetrating" if truth < 0 else "touching"
        assert {results[row].outcome for results in asked.values()} == {expected}
        assert_figures(asked["distance"][row], truth)
        assert_figures(asked["depth"][row], truth)
        seen.add(expected)
    assert len(seen) > 1


def assert_figures(result: PairResult, truth: Fraction) -> None:
    assert result.distance is not None
    assert result.lower is not None
    assert result.upper is not None
    found, low, high = (
        Fraction(x) * abs(Fraction(x)) for x in (result.distance, result.lower, result.upper)
    )
    if abs(truth) < Fraction(2) ** -2000:  # the figure is subnormal: no digits are promised
        return
    assert low <= truth <= high
    assert abs(found - truth) <= ACCURATE * abs(truth)


@pytest.mark.parametrize("family", FAMILIES)
def test_the_translation_and_the_witness_points_fit_the_figure(
    family: Callable[[np.random.Generator], Iterator[Corners]],
) -> None:
    drawn = list(family(np.random.default_rng(6)))
    for a, b in zip(drawn[::2], drawn[1::2], strict=True):
        result = check_polygon_pair(a, b)
        swapped = check_polygon_pair(b, a)
        assert (swapped.distance, swapped.witness_a) == (result.distance, result.witness_b)
        assert result.distance is not None
        assert result.normal is not None
        assert result.witness_a is not None
        assert result.witness_b is not None
        assert math.hypot(*result.normal) == pytest.approx(1, abs=2.0**-50)
        # A foot has a product and a sum of coordinates up to the largest one.
        largest = float(np.abs((a, b)[0]).max() + np.abs(b).max())
        apart = np.subtract(result.witness_b, result.witness_a)
        off = apart - result.distance * np.array(result.normal)
        assert np.abs(off).max() <= 2.0**-50 * largest


def test_a_batch_is_the_same_on_any_number_of_threads() -> None:
    drawn = list(round_ones(np.random.default_rng(7)))
    polygons = polygons_of(drawn)
    index_a, index_b = (x.ravel().astype(np.uint32) for x in np.indices((len(drawn), len(drawn))))
    alone = check_polygons(polygons, index_a, index_b, threads=1)
    shared = check_polygons(polygons, index_a, index_b, threads=3)
    assert np.array_equal(alone.outcome, shared.outcome)
    assert np.array_equal(alone.distance, shared.distance)
    assert np.array_equal(alone.witness_b, shared.witness_b)


def test_what_does_not_fit_is_refused() -> None:
    square = polygons_of([np.array([[0.0, 0], [1, 0], [1, 1], [0, 1]])])
    zero, two = np.zeros(1, np.uint32), np.zeros(2, np.uint32)
    with pytest.raises(ValueError, match="differ in length"):
        check_polygons(square, zero, two)
    with pytest.raises(ValueError, match="out of range"):
        check_polygons(square, zero, zero + np.uint32(1))
    with pytest.raises(ValueError, match="polygon 0 is not convex"):
        polygons_of([np.array([[0.0, 0], [0, 1], [1, 0]])])
