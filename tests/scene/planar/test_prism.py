"""Prisms over signed triangles: closed, and as wound as the triangles."""

from __future__ import annotations

import numpy as np

from satcheck.core import Surface
from satcheck.scene.planar.prism import prism

SQUARE = np.array([(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0)])
HALVES = np.array([(0, 1, 2), (0, 2, 3)])


def winding(points: np.ndarray, triangles: np.ndarray, x: float, y: float) -> int | None:
    return Surface(prism(points, triangles, 8.0).welded(), True).winding_number((x, y, 3.0))


def test_a_square() -> None:
    mesh = prism(SQUARE, HALVES, 8.0).welded()
    assert mesh.topology().solid
    assert mesh.topology().volume == 4 * 4 * 16
    assert mesh.bounds == ((0.0, 0.0, -8.0), (4.0, 4.0, 8.0))


def test_winding_numbers_add_up() -> None:
    points = np.concatenate((SQUARE, SQUARE / 2))
    inner = HALVES + 4
    over = np.concatenate((HALVES, inner))
    hole = np.concatenate((HALVES, inner[:, ::-1]))
    assert [winding(points, over, x, 1.5) for x in (1.0, 3.0, 5.0)] == [2, 1, 0]
    assert [winding(points, hole, x, 1.5) for x in (1.0, 3.0, 5.0)] == [0, 1, 0]


def test_no_wall_between_neighbours() -> None:
    assert prism(SQUARE, HALVES, 8.0).triangle_count == 2 * 2 + 4 * 2
