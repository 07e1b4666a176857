"""Outlines of meshes with holes."""

from __future__ import annotations

import math
from fractions import Fraction
from itertools import product

import numpy as np
import pytest

from satcheck.audit import Settings, check
from satcheck.scene.planar.region import Region, covers
from tests.audit.shapes import Mesh, open_box, scene_of, unit_box

SQUARE = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]


def region(*triangles: tuple[tuple[float, float], ...]) -> Region:
    points = np.array([point for triangle in triangles for point in triangle])
    return Region(points, np.arange(len(points)).reshape(-1, 3))


def test_two_halves_cover_a_square_and_one_does_not():
    lower, upper = tuple(SQUARE[:3]), (SQUARE[0], SQUARE[2], SQUARE[3])
    assert covers(region(lower, upper), np.array(SQUARE))
    assert not covers(region(lower), np.array(SQUARE))
    assert covers(region(((-9.0, -9.0), (9.0, -9.0), (0.0, 9.0))), np.array(SQUARE))


def test_a_gap_of_one_unit_in_the_last_place_is_seen():
    end = math.nextafter(1.0, 0.0)
    lower = ((0.0, 0.0), (1.0, 0.0), (1.0, 1.0))
    for tip, closed in (((0.0, 1.0), True), ((0.0, end), False)):
        upper = ((0.0, 0.0), (1.0, 1.0), tip)
        assert covers(region(lower, upper), np.array(SQUARE)) == closed


@pytest.mark.parametrize("seed", range(20))
def test_points_on_a_grid_agree(seed):
    """Triangles with corners on a grid: what is covered, every cell of a finer one says too."""
    draw = np.random.default_rng(seed)
    triangles = []
    while len(triangles) < 6:
        p, q, r = (tuple(float(c) for c in draw.integers(-1, 3, 2)) for _ in range(3))
        turn = (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])
        if turn:
            triangles.append((p, q, r) if turn > 0 else (p, r, q))
    steps = [Fraction(2 * k + 1, 101) for k in range(50)]

    def is_in(x, y, triangle):
        ends = zip(triangle, (*triangle[1:], triangle[0]), strict=True)
        return all((b[0] - a[0]) * (y - a[1]) >= (b[1] - a[1]) * (x - a[0]) for a, b in ends)

    every = all(any(is_in(x, y, t) for t in triangles) for x, y in product(steps, steps))
    if not every:
        assert not covers(region(*triangles), np.array(SQUARE))
    if covers(region(*triangles), np.array(SQUARE)):
        assert every


def tube() -> Mesh:
    """Twelve walls, open at both ends, a little wider above."""
    around = [(math.cos(math.tau * k / 12), math.sin(math.tau * k / 12)) for k in range(12)]
    points = [(r * x, r * y, z) for r, z in ((2.0, 0.0), (2.2, 3.0)) for x, y in around]
    return points, [(k, (k + 1) % 12, 12 + (k + 1) % 12, 12 + k) for k in range(12)]


@pytest.mark.parametrize(
    ("plane", "allow_open", "expected"),
    [
        ("xy", False, "indeterminate"),
        ("xy", True, "separated"),
        ("xz", False, "contains"),
        ("xz", True, "contains"),
    ],
)
def test_what_fills_the_ends_of_a_tube_decides_its_outline(tmp_path, plane, allow_open, expected):
    scene = scene_of(tmp_path, a=tube(), b=unit_box(-0.5, -0.5, 1.0))
    report = check(scene, Settings(planar=plane, allow_open=allow_open))
    (finding,) = report.findings
    assert finding.relation == expected
    verdicts = {"indeterminate": "incomplete", "separated": "pass", "contains": "fail"}
    assert report.summary.verdict == verdicts[expected]


def test_a_hole_with_a_wall_behind_it_leaves_the_outline(tmp_path):
    scene = scene_of(tmp_path, a=open_box(), b=unit_box(1, 1, 9))
    (finding,) = check(scene, Settings(planar="xy")).findings
    assert finding.relation == "contains"
