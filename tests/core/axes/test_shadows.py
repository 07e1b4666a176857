"""Shadows and the signs of their gaps, against rational numbers."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest

from satcheck.core.axes import Corners, Floats, Indices, Shadows, corners_of, shadows, unit_of
from tests.oracles.random_shapes import random_quaternion, rotation_matrix

UNIT = 1e-15


def on_axes(points: Floats, rows: Indices) -> list[Shadows]:
    """A has the first half of the points. Each row p q r s is the axis (q - p) x (s - r)."""
    (together,) = corners_of(points)
    half = len(points) // 2
    a, b = (
        Corners(points[side], together.exact[side], together.scale)
        for side in (slice(half), slice(half, 2 * half))
    )
    p, q, r, s = (together.exact[column] for column in rows.T)
    normal = np.cross(q - p, s - r)
    return [shadows(n, unit, a, b) for n, unit in zip(normal, unit_of(normal), strict=True)]


def exact_gap_squared(points: Floats, corners: Indices, a: Indices, b: Indices) -> Fraction:
    """The larger gap along the axis times its size, with its sign."""
    world = [[Fraction(float(c)) for c in point] for point in points]
    p, q, r, s = (world[k] for k in corners)
    u = [y - x for x, y in zip(p, q, strict=True)]
    v = [y - x for x, y in zip(r, s, strict=True)]
    n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
    along_a, along_b = (
        [sum(x * y for x, y in zip(n, world[k], strict=True)) for k in side] for side in (a, b)
    )
    gap = max(min(along_b) - max(along_a), min(along_a) - max(along_b))
    return Fraction(gap * abs(gap) / sum(x * x for x in n))


def random_case(rng: np.random.Generator, kind: str) -> tuple[Floats, Indices]:
    """Ten points, the first five A; any two pairs of them span an axis."""
    points = rng.normal(size=(10, 3))
    if kind != "generic":  # many points in few planes: gaps of exactly 0 and next to it
        points = rng.integers(-2, 3, (10, 3)).astype(float)
        points[5:, 0] = np.abs(points[5:, 0])
        points[:5, 0] = -np.abs(points[:5, 0])
    if kind == "turned":
        points = points @ rotation_matrix(random_quaternion(rng)).T
    if kind == "far":
        points += 1e6 * rng.normal(size=3)
    if kind == "tiny":
        points *= 1e-40
    return points, rng.integers(0, 10, (40, 4))


@pytest.mark.parametrize("kind", ["generic", "grid", "turned", "far", "tiny"])
def test_signs_are_those_of_rational_numbers(kind: str) -> None:
    rng = np.random.default_rng(5)
    a, b = np.arange(5), np.arange(5, 10)
    seen = set()
    for _ in range(30):
        points, corners = random_case(rng, kind)
        (exact,) = (each.exact for each in corners_of(points))
        p, q, r, s = (exact[column] for column in corners.T)
        corners = corners[np.cross(q - p, s - r).any(axis=1)]
        size = float(np.ptp(points, axis=0).max())
        for found, row in zip(on_axes(points, corners), corners, strict=True):
            truth = exact_gap_squared(points, row, a, b)
            assert abs(np.linalg.norm(found.direction) - 1) <= UNIT
            assert found.sign == (truth > 0) - (truth < 0)
            gap = np.sign(float(truth)) * abs(float(truth / Fraction(size) ** 2)) ** 0.5 * size
            assert abs(found.gap - gap) <= 1e-14 * abs(gap)
            seen.add(found.sign)
    assert seen >= ({-1, 0} if kind == "grid" else {-1})


def test_shadows_lie_where_the_points_do_and_the_axis_leads_from_a_to_b() -> None:
    points = np.array([[5.0, 0, 0], [6, 0, 0], [5, 1, 0], [1, 0, 0], [2, 0, 0], [1, 1, 0]])
    with pytest.raises(ZeroDivisionError):  # an axis without a direction is the caller's mistake
        on_axes(points, np.array([[0, 1, 3, 4]]))
    found = on_axes(points, np.array([[0, 2, 3, 4], [0, 1, 0, 2]]))
    assert found[0].direction == (0.0, 0.0, 1.0)
    assert [each.sign for each in found] == [0, 0]
    a, b = corners_of(points[:3], points[3:])
    across = np.array([[1, 0, 0]], dtype=object)
    (found_there,) = (
        shadows(n, unit, a, b) for n, unit in zip(across, unit_of(across), strict=True)
    )
    assert found_there.direction == (-1.0, 0.0, 0.0)
    assert found_there.a == (-6.0, -5.0)
    assert found_there.b == (-2.0, -1.0)
    assert found_there.gap == 3.0
