"""Outlines that a scene states."""

from __future__ import annotations

import random
from fractions import Fraction
from typing import Any

import numpy as np
import pytest

from satcheck.core import Mesh
from satcheck.scene.planar.outline import Outline, shape_from

Corners = tuple[tuple[float, float], ...]
SQUARE: Corners = ((0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0))


def test_points_stand_counter_clockwise_from_the_least() -> None:
    for first in range(4):
        points = SQUARE[first:] + SQUARE[:first]
        assert Outline(points).points == Outline(points[::-1]).points == SQUARE


def test_points_are_corners_of_its_mesh_as_they_are() -> None:
    points = ((0.1, 0.2), (0.7, 0.1), (0.3, 0.3), (0.2, 0.9))
    vertices = np.asarray(Outline(points).mesh().vertices)
    assert sorted(map(tuple, vertices.tolist())) == sorted((x, y, 0.0) for x, y in points)


@pytest.mark.parametrize(
    ("points", "message"),
    [
        ([[0, 0], [1, 0]], "length >= 3"),
        ([[0, 0], [1, 1], [3, 3]], "no area"),
        ([[0, 0], [1, 1], [1, 0], [0, 1]], r"from points\[0\] and points\[2\] cross"),
        ([[0, 0], [2, 0], [1, 0], [1, 1]], r"points\[0\] and points\[2\] cross or touch"),
        ([[0, 0], [4, 0], [4, 4], [2, 0], [0, 4]], "cross or touch"),
        ([[0, 0], [1, 0], [1, 1], [0, 0]], r"points\[3\] repeats points\[0\]"),
        ([[0, 0], [-0.0, 0.0], [1, 1]], r"points\[1\] repeats points\[0\]"),
        ([[0, 0], [1, 0], [float("nan"), 1]], r"points\[2\]"),
        ([[0, 0], [1, 0], [10**400, 1]], r"points\[2\]"),
        ([[0, 0], [1, 0], [1, True]], r"points\[2\]"),
        ([[0, 0], [1, 0], [1, 1, 0]], r"points\[2\]"),
        ([[0, 0], "x", [1, 1]], r"points\[1\]"),
        (5, "array"),
    ],
)
def test_what_bounds_no_region_is_refused(points: Any, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        shape_from({"type": "outline", "points": points})


def test_an_outline_has_no_other_key() -> None:
    with pytest.raises(ValueError, match="height"):
        shape_from({"type": "outline", "points": SQUARE, "height": 1.0})


def test_simple_polygons_alone_are_taken() -> None:
    """Of random polygons on a small grid, whose edges often meet in corners or run along each
    other."""
    rng = random.Random(1)
    taken = refused = 0
    for _ in range(3000):
        count = rng.randint(3, 7)
        points = tuple((float(rng.randint(0, 4)), float(rng.randint(0, 4))) for _ in range(count))
        if len(set(points)) < count:
            continue
        if is_simple(points):
            taken += 1
            outline = Outline(points)
            assert area_of(outline.mesh()) == abs(shoelace(points))
            assert outline.mesh().triangle_count == count - 2
        else:
            refused += 1
            with pytest.raises(ValueError, match=r"cross or touch|no area"):
                Outline(points)
    assert min(taken, refused) > 500


def is_simple(points: Corners) -> bool:
    """Whether edges have no common points but the corners of neighbours, by rational arithmetic."""
    edges = list(zip(points, points[1:] + points[:1], strict=True))
    return not any(meet(p, q) for k, p in enumerate(edges) for q in edges[:k])


def meet(p: Corners, q: Corners) -> bool:
    shared = {*p} & {*q}
    if any(lies_on(corner, p) for corner in {*q} - shared):
        return True
    if any(lies_on(corner, q) for corner in {*p} - shared):
        return True
    across_p, across_q = turn(*p, q[0]) * turn(*p, q[1]), turn(*q, p[0]) * turn(*q, p[1])
    return across_p < 0 and across_q < 0


def lies_on(point: tuple[float, float], edge: Corners) -> bool:
    (ax, ay), (bx, by) = edge
    x, y = point
    within = min(ax, bx) <= x <= max(ax, bx) and min(ay, by) <= y <= max(ay, by)
    return within and turn(*edge, point) == 0


def turn(a: tuple[float, float], b: tuple[float, float], c: tuple[float, float]) -> Fraction:
    (ax, ay), (bx, by), (cx, cy) = (tuple(map(Fraction, p)) for p in (a, b, c))
    return (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)


def shoelace(points: Corners) -> float:
    return sum(a[0] * b[1] - a[1] * b[0] for a, b in zip(points, points[1:] + points[:1])) / 2  # noqa: B905


def area_of(mesh: Mesh) -> float:
    corners = np.asarray(mesh.vertices)[np.asarray(mesh.triangles)][:, :, :2]
    return float(sum(turn(*map(tuple, triangle)) for triangle in corners.tolist())) / 2
