"""No triangle of a sheet that is read lies over a place that its outlines leave empty."""

from __future__ import annotations

import itertools
from fractions import Fraction

import numpy as np

from satcheck.scene.drawing.contour import Contour, DrawnShape, Point
from satcheck.scene.drawing.sheet import Sheet, sheet_of
from satcheck.scene.errors import MeshFileError

SIZE = 8


def winding(outline: list[Point], x: Fraction, y: Fraction) -> int:
    """Of a point on no edge and on the height of no corner."""
    count = 0
    for (ax, ay), (bx, by) in zip(outline, outline[1:] + outline[:1], strict=True):
        if (ay < y) != (by < y):
            crossing = int(ax) + (y - int(ay)) * Fraction(int(bx - ax), int(by - ay))
            count += (1 if by > ay else -1) if crossing > x else 0
    return count


def covers(corners: list[list[float]], x: Fraction, y: Fraction) -> bool:
    return winding([(cx, cy) for cx, cy in corners], x, y) != 0


def drawn(seed: int) -> tuple[list[Point], Sheet | None]:
    """A random outline on a grid, and its sheet; None: it is refused."""
    rng = np.random.default_rng(seed)
    outline = [(float(x), float(y)) for x, y in rng.integers(0, SIZE, (int(rng.integers(3, 6)), 2))]
    try:
        return outline, sheet_of(DrawnShape("s", (Contour(tuple(outline)),), "nonzero"))
    except MeshFileError:
        return outline, None


def test_what_the_triangles_cover_is_filled() -> None:
    """Most outlines cross themselves. The samples lie on no line through two points of the grid:
    their coordinates have large denominators."""
    refused = 0
    for seed in range(60):
        outline, sheet = drawn(seed)
        if sheet is None:
            refused += 1
            continue
        triangles = sheet.points[sheet.triangles].tolist()
        for k, n in itertools.product(range(2 * SIZE), repeat=2):
            x, y = Fraction(k, 2) + Fraction(1, 101), Fraction(n, 2) + Fraction(1, 10007)
            if any(covers(corners, x, y) for corners in triangles):
                assert winding(outline, x, y) != 0, seed
    assert 10 < refused < 50
