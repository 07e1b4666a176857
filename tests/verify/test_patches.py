"""Pieces of a surface: which triangles make a convex piece, and how far points are from it."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest

from satcheck.report.certificate import Face, Plane
from satcheck.verify import Rejected
from satcheck.verify.exact import Point, root
from satcheck.verify.partition import Frame
from satcheck.verify.surfaces import next_points, slack, squared_distance
from satcheck.verify.thickness import Side, patch_of, planar_hull
from satcheck.verify.world import Exact
from tests.audit.shapes import Mesh, bracket, unit_box
from tests.verify.test_cover import pair_of

EXACTLY = Fraction(1, 1 << 120)


def body(mesh: Mesh) -> Exact:
    return pair_of(mesh, mesh).a


def frame(box: Exact | None = None) -> Frame:
    return Frame((0.0, 0.0, 0.0), 0 if box is None else box.k)


def at(x: float, y: float, z: float, k: int) -> Point:
    return Fraction(x) * (1 << k), Fraction(y) * (1 << k), Fraction(z) * (1 << k)


def grid(mesh: Mesh) -> Mesh:
    """The same mesh, each quad as nine."""
    points, faces = mesh
    found: list[tuple[float, float, float]] = []
    quads = []
    for a, b, c, d in faces:
        p, q, r, s = (np.array(points[v]) for v in (a, b, c, d))
        first = len(found)
        for i in range(4):
            for j in range(4):
                u, v = i / 4 if i < 3 else 1.0, j / 4 if j < 3 else 1.0
                x, y, z = p * (1 - u) * (1 - v) + q * u * (1 - v) + r * u * v + s * (1 - u) * v
                found.append((float(x), float(y), float(z)))
        quads += [
            (first + 4 * i + j, first + 4 * i + j + 4, first + 4 * i + j + 5, first + 4 * i + j + 1)
            for i in range(3)
            for j in range(3)
        ]
    return found, quads


def test_two_triangles_are_the_square_that_they_fill() -> None:
    box = body(unit_box())
    square = patch_of(Face("a", (10, 11)), box, frame(box))
    for y, z in ((0.0, 0.0), (1.0, 0.0), (0.25, 0.75), (0.5, 0.5)):
        assert square.distance(at(0.5, y, z, box.k)) == Fraction(1, 2)
    assert square.distance(at(1.0, 4.0, 5.0, box.k)) == 5


def test_many_triangles_are_the_polygon_that_they_fill() -> None:
    box = body(grid(unit_box()))
    wall = tuple(range(90, 108))
    square = patch_of(Face("a", wall), box, frame(box))
    assert square.distance(at(0.5, 0.9, 0.1, box.k)) == Fraction(1, 2) * (1 << box.k)
    left = 0
    for missing in range(18):
        corners = box.corners(wall[missing])
        x, y, z = (Fraction(sum(c[k] for c in corners), 3) for k in range(3))
        try:
            square = patch_of(Face("a", wall[:missing] + wall[missing + 1 :]), box, frame(box))
        except Rejected:
            continue
        left += 1  # without a triangle at a corner it is a polygon of five corners
        assert square.distance((x, y, z)) > 0
    assert left == 2


@pytest.mark.parametrize("triangles", [(10, 8), (10, 10, 11), (8, 11)])
def test_triangles_that_fill_no_polygon_are_no_patch(triangles: tuple[int, ...]) -> None:
    with pytest.raises(Rejected):
        patch_of(Face("a", triangles), body(unit_box()), frame())


def test_an_end_of_a_bracket_is_not_convex_and_its_arms_are() -> None:
    box = body(bracket())
    patch_of(Face("a", (12, 13)), box, frame(box))
    with pytest.raises(Rejected):
        patch_of(Face("a", (12, 13, 14, 15)), box, frame(box))


@pytest.mark.parametrize("off", [2.0**-40, 0.125])
def test_what_a_piece_is_bent_is_added(off: float) -> None:
    points, faces = unit_box()
    points[7] = (1.0 + off, 1.0, 1.0)
    box = body((points, faces))
    scale = 1 << box.k
    piece = patch_of(Face("a", (10, 11)), box, frame(box))
    bound = piece.distance(at(0.5, 0.5, 0.5, box.k)) / scale
    nearest = min(
        root(squared_distance(at(0.5, 0.5, 0.5, box.k), box.corners(t)))[1] / scale
        for t in (10, 11)
    )
    assert Fraction(1, 2) < bound
    assert nearest <= bound <= nearest + 4 * Fraction(off)


def test_a_plane_supports_a_body_that_lies_behind_it() -> None:
    box = body(unit_box())
    plane = patch_of(Plane("a", (2.0, 0.0, 0.0), 2.0), box, frame(box))
    assert isinstance(plane, Side)
    assert plane.supports
    assert plane.distance(at(0.25, 7.0, -3.0, box.k)) == Fraction(3, 4)
    assert plane.distance(at(4.0, 7.0, -3.0, box.k)) == -3
    nearer = patch_of(Plane("a", (2.0, 0.0, 0.0), 2.0 - 2.0**-52), box, frame(box))
    assert isinstance(nearer, Side)
    assert not nearer.supports


def test_float64_heights_hold_for_exact_ones() -> None:
    rng = np.random.default_rng(11)
    box = body(unit_box())
    for scale in (1e-9, 1.0, 1e9):
        where = Frame(rng.normal(size=3).tolist(), box.k)
        normal, height = rng.normal(size=3) * scale, float(rng.normal()) * scale
        plane = patch_of(Plane("a", tuple(normal.tolist()), height), box, where)
        points = rng.normal(size=(50, 3)) * 4
        for p, above in zip(points.tolist(), plane.above(points).tolist(), strict=True):
            exact = plane.distance(at(p[0], p[1], p[2], box.k)) / (1 << box.k)
            assert exact <= above <= exact + Fraction(1, 1 << 40)


def test_float64_bounds_hold_for_exact_distances() -> None:
    rng = np.random.default_rng(7)
    for scale in (1e-6, 1.0, 1e6):
        corners = np.round(rng.normal(size=(300, 3, 3)) * 2**20) * scale
        corners[::3, 2] = corners[::3, 1]  # needles
        corners[1::3, 2] = corners[1::3, 0] + (corners[1::3, 1] - corners[1::3, 0]) * 2.0**-20
        feet = next_points(corners)
        below = np.linalg.norm(feet, axis=1) - slack(corners)
        above = np.linalg.norm(feet, axis=1) + slack(corners)
        unit = feet / np.linalg.norm(feet, axis=1)[:, None]
        lower = np.einsum("nkj,nj->nk", corners, unit).min(axis=1) - slack(corners)
        for k in range(len(corners)):
            exact = [tuple(map(Fraction, p)) for p in corners[k].tolist()]
            zero = Fraction(0)
            squared = squared_distance((zero, zero, zero), exact)  # type: ignore[arg-type]
            assert squared <= Fraction(above[k]) ** 2
            assert lower[k] <= 0 or Fraction(lower[k]) ** 2 <= squared
            assert below[k] <= 0 or Fraction(below[k]) ** 2 <= squared * (1 + Fraction(1, 1 << 20))


def test_a_hull_has_the_corners_only() -> None:
    square = [(0, 0), (2, 0), (2, 2), (0, 2)]
    assert planar_hull([*square, (1, 0), (1, 1), (0, 2)]) == square
    assert len(planar_hull([(0, 0), (1, 1), (2, 2)])) < 3
    assert len(planar_hull([(1, 1)])) < 3
