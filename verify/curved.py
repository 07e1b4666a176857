"""A curved shape, in rationals: the exact image of a primitive under a matrix."""

from __future__ import annotations

import math
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property

import numpy as np

from satcheck.core.shapes import Capsule, Cone, Cylinder, Ellipsoid, ShapeImage, Sphere
from satcheck.verify.exact import Floats, Point, Reach, Rejected, cross, dot, point, root, sign, sub


@dataclass(frozen=True)
class Curved:
    """A closed convex shape with an inside. Raises Rejected if the matrix flattens it."""

    image: ShapeImage

    def __post_init__(self) -> None:
        if self.determinant == 0:
            raise Rejected("its placement flattens it")

    def moved(self, offset: list[float]) -> Curved:
        """Each coordinate of the origin is rounded once."""
        x, y, z = (c + d for c, d in zip(self.image.origin, offset, strict=True))
        if not all(map(math.isfinite, (x, y, z))):
            raise Rejected("a translation is finite")
        return Curved(ShapeImage(self.image.primitive, self.image.columns, (x, y, z)))

    @cached_property
    def _columns(self) -> tuple[Point, Point, Point]:
        x, y, z = map(point, self.image.columns)
        return x, y, z

    @cached_property
    def _origin(self) -> Point:
        return point(self.image.origin)

    @cached_property
    def _rows(self) -> tuple[Point, Point, Point]:
        """Of the inverse of the matrix, times its determinant."""
        x, y, z = self._columns
        return cross(y, z), cross(z, x), cross(x, y)

    @cached_property
    def determinant(self) -> Fraction:
        """Of the matrix."""
        return Fraction(dot(self._columns[0], self._rows[0]))

    def reach(self, n: Point) -> Reach:
        """The largest n . x of its points x = M y + t, by the support of the primitive in M^T n."""
        base = Fraction(dot(self._origin, n))
        x, y, z = (Fraction(dot(column, n)) for column in self._columns)
        across = x * x + y * y
        match self.image.primitive:
            case Sphere(radius):
                return Reach(base, Fraction(radius) ** 2 * (across + z * z))
            case Capsule(radius, length):
                along = Fraction(length) / 2 * abs(z)
                return Reach(base + along, Fraction(radius) ** 2 * (across + z * z))
            case Cylinder(radius, height):
                return Reach(base + Fraction(height) / 2 * abs(z), Fraction(radius) ** 2 * across)
            case Cone(radius, height):
                up, out = Fraction(height) * z, Fraction(radius) ** 2 * across
                if up > 0 and up * up >= out:
                    return Reach(base + up / 2)
                return Reach(base - up / 2, out)
            case Ellipsoid((a, b, c)):
                parts = (Fraction(r) * m for r, m in ((a, x), (b, y), (c, z)))
                return Reach(base, sum((p * p for p in parts), Fraction(0)))
            case _:
                raise Rejected("no curved shape")

    def side(self, p: Point) -> int:
        """1 inside, 0 on its border, -1 outside."""
        step = sub(p, self._origin)
        x, y, z = (Fraction(dot(row, step)) / self.determinant for row in self._rows)
        across = x * x + y * y
        match self.image.primitive:
            case Sphere(radius):
                return sign(Fraction(radius) ** 2 - across - z * z)
            case Capsule(radius, length):
                beyond = max(abs(z) - Fraction(length) / 2, Fraction(0))
                return sign(Fraction(radius) ** 2 - across - beyond * beyond)
            case Cylinder(radius, height):
                ends = sign(Fraction(height) / 2 - abs(z))
                return min(sign(Fraction(radius) ** 2 - across), ends)
            case Cone(radius, height):
                left = Fraction(height) / 2 - z  # below the apex
                width = Fraction(radius) * left / Fraction(height)
                mantle = sign(width * width - across) if left >= 0 else -1
                return min(mantle, sign(Fraction(height) - left))
            case Ellipsoid((a, b, c)):
                parts = (m / Fraction(r) for r, m in ((a, x), (b, y), (c, z)))
                return sign(1 - sum((q * q for q in parts), Fraction(0)))
            case _:
                raise Rejected("no curved shape")

    @cached_property
    def bounds(self) -> tuple[Floats, Floats]:
        """A box around it, rounded outward."""
        low, high = np.empty(3), np.empty(3)
        for k in range(3):
            forth, back = (self.reach(point(way * (j == k) for j in range(3))) for way in (1, -1))
            low[k] = _outward(-(back.q + root(back.p)[1]), -math.inf)
            high[k] = _outward(forth.q + root(forth.p)[1], math.inf)
        return low, high


def _outward(number: Fraction, way: float) -> float:
    try:
        near = float(number)
    except OverflowError:
        raise Rejected("its placement is out of range") from None
    is_beyond = Fraction(near) >= number if way > 0 else Fraction(near) <= number
    return near if is_beyond else math.nextafter(near, way)
