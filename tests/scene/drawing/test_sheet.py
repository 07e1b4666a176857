"""Triangles that the contours bound, edge by edge."""

from __future__ import annotations

import math

import numpy as np
import pytest

from satcheck.core import Surface
from satcheck.scene.drawing.contour import Contour, DrawnShape, FillRule, Point
from satcheck.scene.drawing.sheet import sheet_of, united
from satcheck.scene.errors import MeshFileError
from satcheck.scene.planar.prism import prism


def square(low: float, high: float) -> tuple[Point, ...]:
    return ((low, low), (high, low), (high, high), (low, high))


def winding(contours: list[tuple[Point, ...]], rule: FillRule, x: float, y: float) -> int | None:
    sheet = sheet_of(DrawnShape("s", tuple(Contour(points) for points in contours), rule))
    solid = Surface(prism(sheet.points, sheet.triangles, 1.0).welded(), True)
    return solid.winding_number((x, y, 0.5))


def test_the_fill_rules() -> None:
    nested = [square(0, 10), square(2, 8)]
    assert [winding(nested, "nonzero", x, 5) for x in (1.0, 5.0, 11.0)] == [1, 2, 0]
    assert [winding(nested, "evenodd", x, 5) for x in (1.0, 5.0, 11.0)] == [1, 0, 0]
    hole = [square(0, 10), square(2, 8)[::-1]]
    assert winding(hole, "nonzero", 5.0, 5.0) == 0


EIGHT: tuple[Point, ...] = ((0, 0), (4, 4), (4, 0), (0, 4))
PENTAGRAM: tuple[Point, ...] = ((50, 0), (79, 90), (2, 35), (98, 35), (21, 90))


@pytest.mark.parametrize(
    "contours", [[square(0, 4), square(2, 6)[::-1]], [EIGHT], [PENTAGRAM], [PENTAGRAM[::-1]]]
)
def test_outlines_whose_triangles_cover_empty_places_are_refused(
    contours: list[tuple[Point, ...]],
) -> None:
    """The common square of two squares, or the notches between the lobes, are empty, but any
    triangles between these corners lie over them."""
    with pytest.raises(MeshFileError, match="its outlines cross") as caught:
        winding(contours, "nonzero", 0, 0)
    assert caught.value.code == "unsupported-feature"


def test_outlines_that_leave_nothing_between_are_read() -> None:
    """Squares that cross in the same direction, squares apart in opposite directions, and a
    clockwise comb: the library splits it well only the other way round."""
    crossed = [square(0, 4), square(2, 6)]
    assert [winding(crossed, "nonzero", x, x) for x in (1.0, 3.0, 5.0, 7.0)] == [1, 2, 1, 0]
    apart = [square(0, 4), square(5, 6)[::-1]]
    assert [winding(apart, "nonzero", x, x) for x in (1.0, 4.5, 5.5)] == [1, 0, 1]
    teeth = [p for x in (0, 2, 4) for p in ((x, 0), (x, 5), (x + 1, 5), (x + 1, 0))]
    comb: tuple[Point, ...] = (*teeth, (5, -2), (0, -2))
    found = [winding([comb], "nonzero", x, y) for x, y in ((0.5, 3), (1.5, 3), (2.5, 4), (3, -1))]
    assert found == [1, 0, 1, 1]


def test_an_island_in_a_hole() -> None:
    contours = [square(4, 6), square(0, 10), square(2, 8)]
    found = [winding(contours, "evenodd", x, 5) for x in (1.0, 3.0, 5.0)]
    assert found == [1, 0, 1]


def test_outlines_that_cross_have_no_even_odd_reading() -> None:
    with pytest.raises(MeshFileError) as caught:
        winding([square(0, 4), square(2, 6)], "evenodd", 0, 0)
    assert caught.value.code == "unsupported-feature"


def test_a_ragged_outline_keeps_its_winding() -> None:
    rng = np.random.default_rng(5)
    angles = np.arange(60) * 2 * math.pi / 60
    radii = rng.uniform(1.0, 3.0, 60)
    points = tuple((r * math.cos(t), r * math.sin(t)) for r, t in zip(radii, angles, strict=True))
    for x, y in rng.uniform(-3, 3, (50, 2)):
        expected = _inside(points, x, y)
        assert winding([points], "nonzero", x, y) == int(expected)


def _inside(points: tuple[Point, ...], x: float, y: float) -> bool:
    turns = 0.0
    for (ax, ay), (bx, by) in zip(points, (*points[1:], points[0]), strict=True):
        a, b = math.atan2(ay - y, ax - x), math.atan2(by - y, bx - x)
        turns += (b - a + math.pi) % (2 * math.pi) - math.pi
    return round(turns / (2 * math.pi)) == 1


@pytest.mark.parametrize("turned", [False, True])
def test_shapes_together_cover_what_any_of_them_covers(turned: bool) -> None:
    """One against the clock, one with it: where they overlap the sum would be 0."""
    shapes = [square(0, 4), square(2, 6)[::-1]]
    sheets = [sheet_of(DrawnShape("s", (Contour(points),), "nonzero")) for points in shapes]
    sheet = united(sheets[::-1] if turned else sheets)
    solid = Surface(prism(sheet.points, sheet.triangles, 1.0).welded(), True)
    assert [solid.winding_number((c, c, 0.5)) for c in (1.0, 3.0, 5.0, 7.0)] == [1, 2, 1, 0]


def test_areas_of_opposite_directions_are_refused_if_one_lies_in_the_box_of_the_other() -> None:
    corner: tuple[Point, ...] = ((0, 0), (4, 0), (4, 4), (3, 4), (3, 1), (0, 1))
    both = (Contour(corner), Contour(square(1.5, 2)[::-1]))
    with pytest.raises(MeshFileError) as caught:
        sheet_of(DrawnShape("s", both, "nonzero"))
    assert caught.value.code == "unsupported-feature"


def test_what_is_filled_lies_on_top_of_the_rest() -> None:
    ring = (Contour(square(0, 10)), Contour(square(2, 8)))
    sheet = sheet_of(DrawnShape("s", ring, "evenodd", (Contour(square(1, 5)[::-1]),)))
    solid = Surface(prism(sheet.points, sheet.triangles, 1.0).welded(), True)
    assert [solid.winding_number((c, c, 0.5)) for c in (0.5, 1.5, 3.0, 6.0)] == [1, 2, 1, 0]
