"""Simple bodies around a curved shape and inside it, in the frame of the shape."""

from __future__ import annotations

import math

from msgspec import Struct

from satcheck.core.conventions import Vector
from satcheck.core.shapes import (
    Capsule,
    Cone,
    Cylinder,
    Primitive,
    Sphere,
    half_sizes,
)

# Sides of the prism around a cylinder.
_SIDES = 16
# Outer bodies are larger, and inner balls smaller, by far more than any rounding.
_LARGER, _SMALLER = 1 + 1e-9, 1 - 1e-9
# The most balls along the axis of a shape.
_MOST_BALLS = 16


class ShapeBounds(Struct, frozen=True):
    """The shape lies in the hull of the corners, grown by the margin; the balls (centre, radius)
    lie in the shape."""

    corners: list[Vector]
    margin: float
    inner: list[tuple[Vector, float]]


def shape_bounds(shape: Primitive) -> ShapeBounds:
    a, b, c = half_sizes(shape)
    match shape:
        case Sphere():
            return ShapeBounds([(0.0, 0.0, 0.0)], a * _LARGER, [((0.0, 0.0, 0.0), a * _SMALLER)])
        case Capsule():
            ends = [(0.0, 0.0, -c * _LARGER), (0.0, 0.0, c * _LARGER)]
            return ShapeBounds(ends, a * _LARGER, _along_axis(a, c))
        case Cylinder():
            return ShapeBounds(_prism(a, c), 0.0, _along_axis(min(a, c), c - min(a, c)))
        case Cone():
            # The largest inner ball touches the base and the mantle.
            radius = 2 * a * c / (a + math.hypot(a, 2 * c))
            return ShapeBounds(_prism(a, c), 0.0, [((0.0, 0.0, radius - c), radius * _SMALLER)])
        case _:
            corners = [
                (x * a * _LARGER, y * b * _LARGER, z * c * _LARGER)
                for x in (-1, 1)
                for y in (-1, 1)
                for z in (-1, 1)
            ]
            return ShapeBounds(corners, 0.0, [((0.0, 0.0, 0.0), min(a, b, c) * _SMALLER)])


def _along_axis(radius: float, half: float) -> list[tuple[Vector, float]]:
    """Balls with centres on the z axis, up to `half` from the origin."""
    count = 1 + min(_MOST_BALLS - 1, math.ceil(2 * half / radius))
    if count == 1:
        return [((0.0, 0.0, 0.0), radius * _SMALLER)]
    heights = [half * (2 * k / (count - 1) - 1) for k in range(count)]
    return [((0.0, 0.0, height * _SMALLER), radius * _SMALLER) for height in heights]


def _prism(radius: float, half: float) -> list[Vector]:
    """The corners of a prism around a cylinder about z."""
    wide = radius / math.cos(math.pi / _SIDES) * _LARGER
    angles = [2 * math.pi * k / _SIDES for k in range(_SIDES)]
    return [
        (wide * math.cos(angle), wide * math.sin(angle), end)
        for angle in angles
        for end in (-half * _LARGER, half * _LARGER)
    ]
