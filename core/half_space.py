"""The exact signed distance of a body from a half space: its least height over the plane.

A height is (p + q sqrt(w)) / sqrt(n . n) in rational numbers, n being a normal of the plane. q is 0
for the vertex of a mesh. Signs of sums of two square roots are found by squaring, so no height is
rounded before it is compared.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from fractions import Fraction
from functools import lru_cache

import numpy as np
from msgspec import Struct
from numpy.typing import NDArray

from satcheck.core.conventions import Vector
from satcheck.core.rounding import UNIT_ROUNDOFF
from satcheck.core.shapes import (
    Capsule,
    Cone,
    Cylinder,
    Ellipsoid,
    Primitive,
    ShapeImage,
    Sphere,
)
from satcheck.core.transform import Transform

Exact = tuple[Fraction, Fraction, Fraction]

# Bits of a square root in a height, far more than a rounded height needs.
_BITS = 400
# Roundings in a height in float64: a difference, a product and a sum for each coordinate.
_HEIGHT_ROUNDOFFS = 16


class Plane(Struct, frozen=True):
    """The plane that bounds a half space. normal: away from it, of any length."""

    origin: Exact
    normal: Exact

    @property
    def unit(self) -> Vector:
        """The unit normal, rounded; exact along an axis."""
        return _unit(self.normal)


@lru_cache(maxsize=64)  # a floor is asked about many bodies
def _unit(normal: Exact) -> Vector:
    if sum(c != 0 for c in normal) == 1:
        x, y, z = (float((c > 0) - (c < 0)) for c in normal)
        return x, y, z
    length = _root(_dot(normal, normal))
    x, y, z = (float(c / length) for c in normal)
    return x, y, z


class Height(Struct, frozen=True):
    """The height (p + q sqrt(w)) / sqrt(square). point: of the body, at this height, rounded.
    value: the height, rounded once."""

    p: Fraction
    q: Fraction
    w: Fraction
    square: Fraction
    point: Vector
    value: float

    def compare(self, length: float) -> int:
        """The sign of (height - length)."""
        if self.value > math.nextafter(length, math.inf):
            return 1
        if self.value < math.nextafter(length, -math.inf):
            return -1
        return _sign_of_three(self.p, self.q, self.w, -Fraction(length), self.square)


def _height(p: Fraction, q: Fraction, w: Fraction, square: Fraction, point: Vector) -> Height:
    if _sign_of_roots(p, Fraction(1), q, w) == 0:
        value = 0.0
    elif q == 0:  # an integer divided by another is rounded once
        root = _root(square)
        value = (p.numerator * root.denominator) / (p.denominator * root.numerator)
    else:
        value = float((p + q * _root(w)) / _root(square))
    return Height(p, q, w, square, point, value)


def plane_of(transform: Transform | None) -> Plane:
    """The exact image of the plane z = 0 under an affine matrix, row-major 4x4; the half space is
    that of the points with z <= 0. Raises ValueError if the image is no plane."""
    if transform is None:
        return Plane((Fraction(0),) * 3, (Fraction(0), Fraction(0), Fraction(1)))
    rows = [[Fraction(entry) for entry in transform[4 * row : 4 * row + 4]] for row in range(3)]
    x, y, z = (tuple(row[k] for row in rows) for k in range(3))
    normal = (
        x[1] * y[2] - x[2] * y[1],
        x[2] * y[0] - x[0] * y[2],
        x[0] * y[1] - x[1] * y[0],
    )
    up = _dot(normal, z)
    if up == 0:
        raise ValueError("the image of a half space has no boundary plane")
    if up < 0:
        normal = -normal[0], -normal[1], -normal[2]
    return Plane((rows[0][3], rows[1][3], rows[2][3]), normal)


def heights_of_points(plane: Plane, points: NDArray[np.float64]) -> tuple[Height, Height]:
    """The least and the greatest height of points, shape (n, 3)."""
    origin = np.array([float(c) for c in plane.origin])
    normal = np.array(plane.unit)
    rough = (points - origin) @ normal
    largest = float(np.abs(points).max() + np.abs(origin).max())
    slack = 2 * _HEIGHT_ROUNDOFFS * UNIT_ROUNDOFF * largest
    low, high = points[rough <= rough.min() + slack], points[rough >= rough.max() - slack]
    return _extreme(plane, low, 1), _extreme(plane, high, -1)


def heights_of_shape(plane: Plane, image: ShapeImage) -> tuple[Height, Height]:
    """The least and the greatest height of a curved shape, as its matrix places it."""
    middle = _over(plane, [Fraction(c) for c in image.origin])
    slopes = [_dot(plane.normal, [Fraction(c) for c in column]) for column in image.columns]
    square = _dot(plane.normal, plane.normal)

    def extreme(sign: int) -> Height:
        terms = list(_supports(image.primitive, [sign * slope for slope in slopes]))
        p, q, w, at = terms[0]
        for other in terms[1:]:
            if _sign_of_three(other[0] - p, other[1], other[2], -q, w) > 0:
                p, q, w, at = other
        point = tuple(
            float(o) + sum(c[k] * y for c, y in zip(image.columns, at, strict=True))
            for k, o in enumerate(image.origin)
        )
        return _height(middle + sign * p, sign * q, w, square, point)  # type: ignore[arg-type]

    return extreme(-1), extreme(1)


def gap_of_planes(a: Plane, b: Plane) -> int | None:
    """The sign of the gap of two half spaces that face each other; None: they share a region
    without end, somewhere."""
    cross = [
        a.normal[i] * b.normal[j] - a.normal[j] * b.normal[i] for i, j in ((1, 2), (2, 0), (0, 1))
    ]
    if any(cross) or _dot(a.normal, b.normal) > 0:
        return None
    gap = _over(a, b.origin)
    return (gap > 0) - (gap < 0)


def _supports(
    shape: Primitive, along: Sequence[Fraction]
) -> Iterator[tuple[Fraction, Fraction, Fraction, Vector]]:
    """The support value of a shape as p + q sqrt(w), and a point of it, rounded; of a cone, those
    of its apex and of its base. The greatest counts."""
    z = along[2]
    none = Fraction(0)
    up = (z > 0) - (z < 0)

    def stretched(radii: Sequence[float]) -> tuple[Fraction, Vector]:
        """(the square of the support value, the point) of an ellipsoid."""
        exact = [Fraction(radius) for radius in radii]
        ends = [radius * c for radius, c in zip(exact, along, strict=True)]
        length = _dot(ends, ends)
        root = _root(length) if length else Fraction(1)
        a, b, c = (float(r * end / root) for r, end in zip(exact, ends, strict=True))
        return length, (a, b, c)

    match shape:
        case Sphere(radius):
            square, at = stretched((radius, radius, radius))
            yield none, Fraction(1), square, at
        case Ellipsoid(radii):
            square, at = stretched(radii)
            yield none, Fraction(1), square, at
        case Capsule(radius, length):
            square, (a, b, c) = stretched((radius, radius, radius))
            half = Fraction(length) / 2
            yield half * abs(z), Fraction(1), square, (a, b, c + up * float(half))
        case Cylinder(radius, height):
            square, (a, b, _) = stretched((radius, radius, 0.0))
            half = Fraction(height) / 2
            yield half * abs(z), Fraction(1), square, (a, b, up * float(half))
        case Cone(radius, height):
            half = Fraction(height) / 2
            yield half * z, none, none, (0.0, 0.0, float(half))
            square, (a, b, _) = stretched((radius, radius, 0.0))
            yield -half * z, Fraction(1), square, (a, b, -float(half))
        case _:
            raise ValueError(f"a {type(shape).__name__} is no curved shape")


def _extreme(plane: Plane, points: NDArray[np.float64], sign: int) -> Height:
    """sign: 1, the least height; -1, the greatest."""
    square, none = _dot(plane.normal, plane.normal), Fraction(0)
    heights = [
        (_over(plane, (x, y, z)), (x, y, z)) for x, y, z in sorted(set(map(tuple, points.tolist())))
    ]
    over, point = min(heights, key=lambda height: sign * height[0])
    return _height(over, none, none, square, point)


def _over(plane: Plane, point: Sequence[Fraction | float]) -> Fraction:
    (normal, a), (origin, b), (at, c) = map(_integers, (plane.normal, plane.origin, point))
    height = sum(n * (p * b - o * c) for n, o, p in zip(normal, origin, at, strict=True))
    return Fraction(height, a * b * c)


def _integers(values: Sequence[Fraction | float]) -> tuple[list[int], int]:
    """Return the values times a power of two, and that: all of them are sums and products of
    floats."""
    ratios = [value.as_integer_ratio() for value in values]
    most = max(bottom for _, bottom in ratios)
    return [top * (most // bottom) for top, bottom in ratios], most


def _dot(a: Sequence[Fraction], b: Sequence[Fraction]) -> Fraction:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@lru_cache(maxsize=64)
def _root(square: Fraction) -> Fraction:
    """The square root with a relative error below 2**-_BITS; exact for squares of fractions."""
    top, bottom = square.numerator, square.denominator
    scale = max(0, _BITS + (bottom.bit_length() - top.bit_length()) // 2 + 1)
    product = top * bottom << (2 * scale)
    root = math.isqrt(product)
    return Fraction(root, bottom << scale)


def _sign(value: Fraction) -> int:
    return (value > 0) - (value < 0)


def _sign_of_roots(q: Fraction, w: Fraction, u: Fraction, v: Fraction) -> int:
    """Return the sign of q sqrt(w) + u sqrt(v)."""
    a, b = _sign(q) * _sign(w), _sign(u) * _sign(v)
    if a == b or b == 0:
        return a
    if a == 0:
        return b
    larger = _sign(q * q * w - u * u * v)
    return a if larger > 0 else b if larger < 0 else 0


def _sign_of_three(p: Fraction, q: Fraction, w: Fraction, u: Fraction, v: Fraction) -> int:
    """Return the sign of p + q sqrt(w) + u sqrt(v)."""
    a, b = _sign(p), _sign_of_roots(q, w, u, v)
    if a == b or b == 0:
        return a
    if a == 0:
        return b
    rest = p * p - q * q * w - u * u * v
    larger = _sign_of_roots(rest, Fraction(1), -2 * q * u, w * v)
    return a if larger > 0 else b if larger < 0 else 0
