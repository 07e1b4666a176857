"""decompose/error_bounds.py, cutting: no area is lost or made."""

from __future__ import annotations

import numpy as np
import pytest

from satcheck.decompose.error_bounds import Plane, Polygon, halves, heights, without

SQUARE: Polygon = [(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (1.0, 1.0, 0.0), (0.0, 1.0, 0.0)]


def area(polygon: Polygon) -> float:
    if len(polygon) < 3:
        return 0.0
    corners = np.array(polygon)
    fan = np.cross(corners[1:-1] - corners[0], corners[2:] - corners[0])
    return float(np.linalg.norm(fan.sum(axis=0))) / 2.0


def random_planes(count: int, seed: int) -> list[Plane]:
    random = np.random.default_rng(seed)
    normals = random.normal(size=(count, 3))
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    points = random.uniform(-0.2, 1.2, size=(count, 3)) * [1.0, 1.0, 0.2]
    offsets = (normals * points).sum(axis=1)
    return list(zip(map(tuple, normals.tolist()), offsets.tolist(), strict=True))


@pytest.mark.parametrize("seed", range(20))
def test_halves_share_the_area_and_the_cut(seed: int) -> None:
    (plane,) = random_planes(1, seed)
    lower, upper = halves(SQUARE, heights(SQUARE, plane))
    assert area(lower) + area(upper) == pytest.approx(1.0)
    assert all(height <= 1e-15 for height in heights(lower, plane))
    assert all(height >= -1e-15 for height in heights(upper, plane))


def test_a_corner_on_the_plane_belongs_to_both_halves() -> None:
    diagonal: Plane = ((2.0**-0.5, -(2.0**-0.5), 0.0), 0.0)
    lower, upper = halves(SQUARE, heights(SQUARE, diagonal))
    assert len(lower) == len(upper) == 3
    assert area(lower) == area(upper) == 0.5


@pytest.mark.parametrize("seed", range(20))
def test_what_is_inside_and_the_rest_are_the_whole(seed: int) -> None:
    planes = random_planes(4, seed)
    inside, rest = without(SQUARE, planes, 0.05)
    assert area(inside) + sum(map(area, rest)) == pytest.approx(1.0)
    for plane in planes:
        assert all(height <= 0.05 + 1e-15 for height in heights(inside, plane))


def test_a_polygon_above_some_plane_stays_whole() -> None:
    planes: list[Plane] = [((1.0, 0.0, 0.0), 0.5), ((0.0, 0.0, -1.0), -1.0)]
    assert without(SQUARE, planes, 0.0) == ([], [SQUARE])
