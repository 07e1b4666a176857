"""Curved shapes as the checker sees them, against the same shapes as the solver sees them."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest

from satcheck.core.curved.exact.curved_body import CurvedBody
from satcheck.core.curved.exact.lattice import from_rational
from satcheck.core.curved.exact.pair import Lattice
from satcheck.core.shapes import Capsule, Cone, Cylinder, Ellipsoid, Primitive, ShapeImage, Sphere
from satcheck.verify import Rejected
from satcheck.verify.curved import Curved
from satcheck.verify.exact import Point

SHAPES: tuple[Primitive, ...] = (
    Sphere(1.0),
    Capsule(0.5, 1.0),
    Cylinder(0.75, 1.5),
    Cone(1.0, 2.0),
    Ellipsoid((1.0, 0.5, 0.75)),
)


@pytest.mark.parametrize("shape", SHAPES, ids=lambda s: type(s).__name__)
def test_both_see_the_same_body(shape: Primitive) -> None:
    rng, seen = np.random.default_rng(7), set()
    for _ in range(20):
        # Quarters, so that points meet borders and axes meet apexes.
        numbers = (rng.integers(-4, 5, (4, 3)) / 4).tolist()
        image = ShapeImage(shape, tuple(map(tuple, numbers[:3])), tuple(numbers[3]))  # type: ignore[arg-type]
        if abs(np.linalg.det(numbers[:3])) < 2.0**-7:  # of quarters: 0, or at least 2^-6
            with pytest.raises(Rejected, match="flattens"):
                Curved(image)
            continue
        theirs, lattice = Curved(image), Lattice((image,))
        ours = lattice.body(image)
        assert isinstance(ours, CurvedBody)
        scale = 1 << lattice.bits
        for n in rng.integers(-3, 4, (12, 3)).tolist():
            mine, other = ours.reach(tuple(n)), theirs.reach(as_point(n))
            assert (other.q * scale, other.p * scale * scale) == (mine.q, mine.p)
        for p in rng.integers(-8, 9, (60, 3)).tolist():
            point = as_point([Fraction(c, 4) for c in p])
            x, y, z, w = from_rational(point)
            side = theirs.side(point)
            assert side == ours.side((x * scale, y * scale, z * scale, w))
            seen.add(side)
            low, high = theirs.bounds
            if side >= 0:
                assert all(low[k] <= point[k] <= high[k] for k in range(3))
    assert seen >= {-1, 1}


def as_point(v: list[Fraction] | list[int]) -> Point:
    x, y, z = map(Fraction, v)
    return x, y, z
