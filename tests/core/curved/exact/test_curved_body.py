"""The exact image of a shape under any matrix: reach, faces and sides agree with each other, and
with the shape in float64."""

from __future__ import annotations

import math
from fractions import Fraction

import numpy as np
import pytest

from satcheck.core.curved.exact.curved_body import CurvedBody
from satcheck.core.curved.exact.faces import Disc, Polygon
from satcheck.core.curved.exact.lattice import IntVector, Point, dot
from satcheck.core.curved.exact.pair import Lattice
from satcheck.core.shapes import (
    Capsule,
    Cone,
    Cylinder,
    Ellipsoid,
    Primitive,
    ShapeImage,
    Sphere,
    support,
)

SHAPES: tuple[Primitive, ...] = (
    Sphere(1.0),
    Capsule(0.5, 1.0),
    Cylinder(0.75, 1.5),
    Cone(1.0, 2.0),
    Ellipsoid((1.0, 0.5, 0.75)),
)


def placed(rng: np.random.Generator, shape: Primitive) -> tuple[ShapeImage, CurvedBody, int]:
    numbers = rng.normal(size=(4, 3)).tolist()
    x, y, z, origin = (tuple(row) for row in numbers)
    image = ShapeImage(shape, (x, y, z), origin)
    lattice = Lattice((image,))
    body = lattice.body(image)
    assert isinstance(body, CurvedBody)
    return image, body, lattice.bits


def directions(rng: np.random.Generator, body: CurvedBody) -> list[IntVector]:
    """Random ones, along and across the axis: those that tell apart flat ends and mantle lines."""
    free = [tuple(rng.integers(-9, 10, 3).tolist()) for _ in range(6)]
    rows = [*body.inverse, *(tuple(-c for c in row) for row in body.inverse)]
    return [n for n in (*free, *rows) if any(n)]


def at(p: Point, bits: int) -> list[float]:
    return [float(Fraction(c, p[3] << bits)) for c in p[:3]]


@pytest.mark.parametrize("shape", SHAPES, ids=lambda s: type(s).__name__)
def test_reach_is_the_support_of_the_image(shape: Primitive) -> None:
    rng = np.random.default_rng(1)
    for _ in range(20):
        image, body, bits = placed(rng, shape)
        for n in directions(rng, body):
            reach = body.reach(n)
            unit = np.array([c / max(map(abs, n)) for c in n])
            x, y, z = (float(np.dot(column, unit)) for column in image.columns)
            expected = support(shape, (x, y, z)) + float(np.dot(image.origin, unit))
            scale = max(map(abs, n)) << bits
            found = reach.q / scale + math.sqrt(Fraction(reach.p, scale * scale))
            assert found == pytest.approx(expected, abs=64 * 2.0**-50)


@pytest.mark.parametrize("shape", SHAPES, ids=lambda s: type(s).__name__)
def test_faces_reach_farthest_and_lie_on_the_border(shape: Primitive) -> None:
    rng, kinds = np.random.default_rng(2), set()
    for _ in range(10):
        _, body, bits = placed(rng, shape)
        for n in directions(rng, body):
            face, reach = body.face(n), body.reach(n)
            points = face.points if isinstance(face, Polygon) else (face.centre,)
            kinds.add((type(face), len(points)))
            for p in points:
                height = Fraction(dot(n, p), p[3])
                assert float((height - reach.q) ** 2 - reach.p) == pytest.approx(
                    0.0, abs=2.0**-60 * (float(height) ** 2 + float(reach.q) ** 2 + reach.p)
                )
                x, y, z = (p[k] + (1 << bits - 20) * n[k] * p[3] for k in range(3))
                if isinstance(face, Disc) or reach.p == 0:
                    assert body.side(p) == 0
                assert body.side((x, y, z, p[3])) == -1
    assert (
        len(kinds)
        == {"Sphere": 1, "Ellipsoid": 1, "Capsule": 2, "Cylinder": 3, "Cone": 2}[
            type(shape).__name__
        ]
    )


@pytest.mark.parametrize("shape", SHAPES, ids=lambda s: type(s).__name__)
def test_sides_of_points_by_all_planes_around(shape: Primitive) -> None:
    """A point that some plane keeps out is outside; one inside is kept out by none."""
    rng = np.random.default_rng(3)
    seen = set()
    for _ in range(20):
        image, body, bits = placed(rng, shape)
        for p in rng.normal(size=(20, 3)) * 0.75:
            world = image.origin + np.array(image.columns).T @ p
            x, y, z = (int(c * 2.0**60) << bits >> 60 for c in world.tolist())
            side = body.side((x, y, z, 1))
            lengths = [
                float(np.dot(p, d) - support(shape, tuple(d))) for d in rng.normal(size=(400, 3))
            ]
            if max(lengths) > 1e-9:
                assert side == -1
            seen.add(side)
            if side == 1:
                assert max(lengths) < 0
    assert seen >= {-1, 1}


def test_the_tip_and_the_rim_of_a_cone() -> None:
    columns = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)
    cone = CurvedBody(ShapeImage(Cone(3.0, 4.0), columns, (0.0, 0.0, 0.0)), 0, 0)
    sides = {
        (0, 0, 2, 1): 0,
        (0, 0, 5, 2): -1,
        (0, 0, 3, 2): 1,
        (3, 0, -2, 1): 0,
        (4, 0, -2, 1): -1,
        (1, 0, -2, 1): 0,
        (3, 0, 0, 2): 0,
        (31, 0, 0, 20): -1,
        (0, 0, -3, 1): -1,
    }
    assert {p: cone.side(p) for p in sides} == sides
    # Across a line of its mantle, from the apex to the rim: 4 out for every 3 up.
    line = cone.face((4, 0, 3))
    assert isinstance(line, Polygon)
    assert [tuple(c // p[3] for c in p[:3]) for p in line.points] == [(0, 0, 2), (3, 0, -2)]
