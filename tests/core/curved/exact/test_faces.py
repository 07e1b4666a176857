"""Common points of faces in one plane, against the exact distance of their corners."""

from __future__ import annotations

from fractions import Fraction

import numpy as np

from satcheck.core.curved.exact.curved_body import CurvedBody
from satcheck.core.curved.exact.faces import Disc, Polygon, common_points, outline
from satcheck.core.curved.exact.lattice import IntVector, Point, cross, dot
from satcheck.core.shapes import Cylinder, ShapeImage
from tests.oracles.exact_distance import exact_truth

U, V = (1, 2, 2), (2, 1, -2)
AXIS = cross(U, V)


def corners(rng: np.random.Generator) -> list[IntVector]:
    """Of a polygon, a segment or a point in the plane of u and v."""
    middle = rng.integers(-4, 5, 2)
    return [
        tuple(int(i) * u + int(j) * v for u, v in zip(U, V, strict=True))  # type: ignore[misc]
        for i, j in rng.integers(-3, 4, (rng.integers(1, 5), 2)) + middle
    ]


def polygon(points: list[IntVector]) -> Polygon:
    return Polygon(tuple((*p, 1) for p in points))


def lies_in(p: Point, points: list[IntVector], u: IntVector = U, v: IntVector = V) -> bool:
    """Whether it adds no corner to the outline of the points of the plane."""
    flat = {(Fraction(dot(u, q)), Fraction(dot(v, q))) for q in points}
    at = Fraction(dot(u, p), p[3]), Fraction(dot(v, p), p[3])
    assert dot(cross(u, v), p) == 0
    loop = outline(list(flat))
    return outline([*loop, at]) == loop or at in loop or (len(loop) == 2 and _on(at, loop))


def _on(at: tuple[Fraction, Fraction], ends: list[tuple[Fraction, Fraction]]) -> bool:
    return len(outline([*ends, at])) == 2 and min(ends) <= at <= max(ends)


def test_polygons() -> None:
    rng, seen = np.random.default_rng(8), set()
    for _ in range(400):
        f, g = corners(rng), corners(rng)
        found = [
            p
            for p in common_points(polygon(f), polygon(g), AXIS)
            if lies_in(p, f) and lies_in(p, g)
        ]
        truth = exact_truth(f, g).outcome == "touching"
        assert bool(found) == truth, (f, g)
        seen.add(truth)
    assert seen == {True, False}


def disc(radius: float, centre: tuple[float, float, float]) -> tuple[CurvedBody, Disc]:
    """The lower end of a can, in the plane z = 0."""
    columns = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)
    x, y, z = centre
    can = CurvedBody(ShapeImage(Cylinder(radius, 2.0), columns, (x, y, z + 1.0)), 8, 0)
    face = can.face((0, 0, -1))
    assert isinstance(face, Disc)
    return can, face


def test_a_disc_and_polygons() -> None:
    """Its squared distance from the polygon, in the plane, against its squared radius."""
    rng, seen = np.random.default_rng(9), set()
    for _ in range(400):
        can, face = disc(5.0 / 8, (0.25, 0.5, 0.0))
        points = rng.integers(-3, 4, (rng.integers(1, 5), 2)) * 128 + rng.choice((0, 96), 2)
        flat = [(int(x), int(y), 0) for x, y in points]
        found = [
            p
            for p in common_points(polygon(flat), face, (0, 0, 1))
            if can.side(p) >= 0 and lies_in(p, flat, (1, 0, 0), (0, 1, 0))
        ]
        truth = exact_truth(flat, [(64, 128, 0)])
        near = truth.high <= 160
        assert bool(found) == near
        seen.add((near, truth.low == 160))
    assert seen == {(True, True), (True, False), (False, False)}


def test_discs() -> None:
    for x, near in ((3.0, True), (3.25, False), (0.5, True), (3.0 - 2.0**-8, True)):
        (a, f), (b, g) = disc(1.75, (0, 0, 0)), disc(1.25, (0.0, x, 0.0))
        found = [p for p in common_points(f, g, (0, 0, 1)) if a.side(p) >= 0 and b.side(p) >= 0]
        assert bool(found) == near
