"""The height of a body over a plane, with 60 decimal digits: brute force over all its vertices, or
the support value of a curved shape."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from decimal import Decimal, localcontext
from fractions import Fraction
from typing import Any

Matrix = Sequence[Sequence[float]]
DIGITS = 60


def exact(value: Fraction) -> Decimal:
    return Decimal(value.numerator) / Decimal(value.denominator)


def normal_of(plane: Matrix) -> list[Fraction]:
    """Across the images of the axes x and y, exactly."""
    (a, d), (b, e), (c, f) = (map(Fraction, row[:2]) for row in plane[:3])
    return [b * f - c * e, c * d - a * f, a * e - b * d]


def rounded_once(matrix: Matrix, vertex: Sequence[float]) -> list[Fraction]:
    return [
        Fraction(
            float(sum(Fraction(row[k]) * Fraction(vertex[k]) for k in range(3)) + Fraction(row[3]))
        )
        for row in matrix[:3]
    ]


def heights_of_vertices(
    plane: Matrix, matrix: Matrix, vertices: Sequence[Sequence[float]]
) -> tuple[Fraction, Fraction]:
    """Least and greatest."""
    normal = normal_of(plane)
    over = [
        sum(
            n * (c - Fraction(row[3]))
            for n, c, row in zip(normal, rounded_once(matrix, vertex), plane, strict=False)
        )
        for vertex in vertices
    ]
    with localcontext() as context:
        context.prec = DIGITS
        length = exact(sum(n * n for n in normal) or Fraction(0)).sqrt()
        low, high = exact(Fraction(min(over))) / length, exact(Fraction(max(over))) / length
    return Fraction(low), Fraction(high)


def heights_of_shape(
    plane: Matrix, matrix: Matrix, shape: Mapping[str, Any]
) -> tuple[Fraction, Fraction]:
    """Of a curved shape of a scene file. The rotation of a sphere does not count."""
    normal = normal_of(plane)
    centre = sum(
        n * (Fraction(m[3]) - Fraction(p[3]))
        for n, m, p in zip(normal, matrix, plane, strict=False)
    )
    axes = [[Fraction(row[k]) for row in matrix[:3]] for k in range(3)]
    if shape["type"] == "sphere":
        axes = [[Fraction(i == k) for i in range(3)] for k in range(3)]
    slopes = [sum(n * c for n, c in zip(normal, axis, strict=True)) for axis in axes]
    with localcontext() as context:
        context.prec = DIGITS
        along = [exact(Fraction(slope)) for slope in slopes]
        length = exact(sum(n * n for n in normal) or Fraction(0)).sqrt()
        middle = exact(Fraction(centre))
        down = _support(shape, [-c for c in along])
        up = _support(shape, along)
        low, high = (middle - down) / length, (middle + up) / length
    return Fraction(low), Fraction(high)


def _support(shape: Mapping[str, Any], along: Sequence[Decimal]) -> Decimal:
    x, y, z = along
    size = {key: Decimal(value) for key, value in shape.items() if isinstance(value, float)}
    across = (x * x + y * y).sqrt()
    match shape["type"]:
        case "sphere":
            return size["radius"] * (x * x + y * y + z * z).sqrt()
        case "capsule":
            ball = size["radius"] * (x * x + y * y + z * z).sqrt()
            return ball + size["length"] / 2 * abs(z)
        case "cylinder":
            return size["radius"] * across + size["height"] / 2 * abs(z)
        case "cone":
            half = size["height"] / 2 * z
            return max(half, size["radius"] * across - half)
        case "ellipsoid":
            ends = [Decimal(r) * c for r, c in zip(shape["radii"], along, strict=True)]
            return sum((end * end for end in ends), Decimal(0)).sqrt()
    raise ValueError(shape["type"])
