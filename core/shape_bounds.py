"""A simple body around a curved shape, in the frame of the shape."""

from __future__ import annotations

import math

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
# Outer bodies are larger by far more than any rounding.
_LARGER = 1 + 1e-9


def shape_bounds(shape: Primitive) -> tuple[list[Vector], float]:
    """(corners, margin): the shape lies in the hull of the corners, grown by the margin."""
    a, b, c = half_sizes(shape)
    match shape:
        case Sphere():
            return [(0.0, 0.0, 0.0)], a * _LARGER
        case Capsule():
            return [(0.0, 0.0, -c * _LARGER), (0.0, 0.0, c * _LARGER)], a * _LARGER
        case Cylinder() | Cone():
            return _prism(a, c), 0.0
        case _:
            x, y, z = a * _LARGER, b * _LARGER, c * _LARGER
            return [(u, v, w) for u in (-x, x) for v in (-y, y) for w in (-z, z)], 0.0


def _prism(radius: float, half: float) -> list[Vector]:
    """The corners of a prism around a cylinder about z."""
    wide = radius / math.cos(math.pi / _SIDES) * _LARGER
    angles = [2 * math.pi * k / _SIDES for k in range(_SIDES)]
    return [
        (wide * math.cos(angle), wide * math.sin(angle), end)
        for angle in angles
        for end in (-half * _LARGER, half * _LARGER)
    ]
