"""Prisms are compared in the plane. Prisms whose ends are not equally far from 0 are compared in
space: both ways have to agree."""

from __future__ import annotations

import math

import manifold3d
import numpy as np
import pytest
from numpy.typing import NDArray

from satcheck import core
from satcheck.scene.planar.region import prism

Loop = list[tuple[float, float]]
HEIGHTS = (64.0, 96.0)


def surface(loops: list[Loop], height: float, lift: float, axis: int = 2) -> core.Surface:
    """Of the region within the first loop and outside of the others."""
    outer, *holes = (np.array(loop) for loop in loops)
    rings = [_wound(outer, 1), *(_wound(hole, -1) for hole in holes)]
    triangles = np.asarray(manifold3d.triangulate(rings), dtype=np.int64)
    mesh = prism(np.concatenate(rings), triangles, height)
    vertices = np.roll(np.array(mesh.vertices) + np.array([0, 0, lift]), axis - 2, axis=1)
    return core.Surface(core.Mesh(np.ascontiguousarray(vertices), mesh.triangles), solid=True)


def _wound(loop: NDArray[np.float64], sign: int) -> NDArray[np.float64]:
    """Counter-clockwise for 1, clockwise for -1."""
    x, y = loop.T
    area = np.sum(x * np.roll(y, -1) - y * np.roll(x, -1))
    return loop if area * sign > 0 else loop[::-1]


def relation(a: list[Loop], b: list[Loop], lift: float, axis: int = 2) -> str:
    found = core.mesh_relation(
        surface(a, HEIGHTS[0], lift, axis), surface(b, HEIGHTS[1], lift, axis)
    )
    assert found.proven
    return found.relation


def staircase(rng: np.random.Generator, scale: float) -> Loop:
    """Columns of random heights over a common base, with slopes or steps between them."""
    columns = int(rng.integers(2, 5))
    left, base = rng.integers(0, 4, 2) * scale
    top: Loop = []
    for k in range(columns):
        height = base + int(rng.integers(1, 4)) * scale
        top.append((left + k * scale, height))
        if rng.random() < 0.5:
            top.append((left + (k + 1) * scale, height))
    loop = [(left, base), (top[-1][0] + scale, base), *top[::-1]]
    return [p for k, p in enumerate(loop) if p != loop[k - 1]]


def moved(loop: Loop, x: float, y: float) -> Loop:
    return [(p + x, q + y) for p, q in loop]


def turned(loop: Loop) -> Loop:
    return [(-q, p) for p, q in loop]


@pytest.mark.parametrize("axis", [2, 0, 1])
@pytest.mark.parametrize("scale", [1.0, 0.1])
def test_both_ways_agree_on_grids(scale: float, axis: int) -> None:
    """Walls and corners meet in most pairs; at 0.1, sums of coordinates are rounded."""
    rng = np.random.default_rng(3)
    seen = set()
    for _ in range(150):
        a, b = staircase(rng, scale), staircase(rng, scale)
        if rng.random() < 0.5:
            b = moved(turned(turned(b)), 6 * scale, 6 * scale)
        in_plane = relation([a], [b], 0.0, axis)
        in_space = relation([a], [b], 0.125, axis)
        assert in_plane == in_space, (a, b)
        seen.add(in_plane)
    assert {"separated", "touching", "penetrating"} <= seen


@pytest.mark.parametrize("axis", [2, 0, 1])
def test_both_ways_measure_the_same_distance(axis: int) -> None:
    rng = np.random.default_rng(4)
    positive = 0
    for _ in range(150):
        a, b = [staircase(rng, 0.1)], [moved(staircase(rng, 0.1), 0.35, -0.2)]
        pairs = [
            (surface(a, HEIGHTS[0], lift, axis), surface(b, HEIGHTS[1], lift, axis))
            for lift in (0.0, 0.125)
        ]
        in_plane, in_space = (core.mesh_distance(*pair) for pair in pairs)
        assert in_plane.distance == pytest.approx(in_space.distance, rel=2.0**-40, abs=2.0**-60)
        apart = np.subtract(in_plane.witness_b, in_plane.witness_a)
        assert np.linalg.norm(apart) == pytest.approx(in_plane.distance, rel=2.0**-40, abs=2.0**-60)
        assert core.mesh_distance(*pairs[0], in_plane.distance / 2).distance in (0.0, math.inf)
        positive += in_plane.distance > 0
    assert 20 < positive < 150


SQUARE = [(0.0, 0.0), (8.0, 0.0), (8.0, 8.0), (0.0, 8.0)]
HOLE = [(2.0, 2.0), (2.0, 6.0), (6.0, 6.0), (6.0, 2.0)]
SMALL = [(3.0, 3.0), (5.0, 3.0), (5.0, 5.0), (3.0, 5.0)]
PLUG = [(2.0, 2.0), (6.0, 2.0), (6.0, 6.0), (2.0, 6.0)]


@pytest.mark.parametrize(
    ("a", "b", "expected"),
    [
        ([SQUARE, HOLE], [SMALL], "separated"),
        ([SQUARE, HOLE], [PLUG], "touching"),
        ([SQUARE, HOLE], [moved(PLUG, 2.0**-50, 0)], "penetrating"),
        ([SQUARE, HOLE], [SQUARE], "penetrating"),
        ([SMALL], [SQUARE], "inside"),
        ([SQUARE], [SMALL], "penetrating"),  # the higher prism is within the lower one
        ([SMALL], [SQUARE, HOLE], "separated"),
        ([SQUARE], [moved(SQUARE, 8, 1)], "touching"),
        ([SQUARE], [moved(SQUARE, 8, 8)], "touching"),
        ([SQUARE], [moved(SQUARE, 8 + 2.0**-49, 0)], "separated"),
        ([SQUARE], [moved(SQUARE, 8 - 2.0**-50, 0)], "penetrating"),
        ([SQUARE], [[(8.0, 4.0), (12.0, 2.0), (12.0, 6.0)]], "touching"),
        ([SQUARE], [[(4.0, 4.0), (8.0, 2.0), (8.0, 6.0)]], "penetrating"),
        ([SQUARE, SMALL], [moved(SMALL, 2.0**-50, 2.0**-50)], "penetrating"),
    ],
)
def test_holes_and_single_ulps(a: list[Loop], b: list[Loop], expected: str) -> None:
    assert relation(a, b, 0.0) == expected


def test_the_evidence_is_a_common_point() -> None:
    for a, b in (
        ([SMALL], [SQUARE]),
        ([SQUARE], [moved(SQUARE, 4, 0)]),
        ([SQUARE], [moved(SQUARE, 8, 4)]),
        ([SQUARE], [moved(SQUARE, 3, 4)]),
    ):
        found = core.mesh_relation(surface(a, HEIGHTS[0], 0), surface(b, HEIGHTS[1], 0))
        assert found.point is not None
        x, y, z = found.point
        assert abs(z) <= HEIGHTS[0]
        for (low_x, low_y), _, (high_x, high_y), _ in (a[0], b[0]):
            assert low_x <= x <= high_x
            assert low_y <= y <= high_y
