"""Rotations as people write them -> matrices, row-major 3x3 for column vectors, right-handed."""

from __future__ import annotations

import math
from collections.abc import Sequence

Rotation = tuple[float, ...]
Quaternion = tuple[float, float, float, float]

_QUARTER_TURN = 90.0
_COSINES = (1.0, 0.0, -1.0, 0.0)


def of_quaternion(w: float, x: float, y: float, z: float) -> Rotation:
    """Of any length but zero."""
    largest = max(abs(w), abs(x), abs(y), abs(z))
    w, x, y, z = w / largest, x / largest, y / largest, z / largest
    s = 2.0 / (w * w + x * x + y * y + z * z)
    return (
        *(1.0 - s * (y * y + z * z), s * (x * y - w * z), s * (x * z + w * y)),
        *(s * (x * y + w * z), 1.0 - s * (x * x + z * z), s * (y * z - w * x)),
        *(s * (x * z - w * y), s * (y * z + w * x), 1.0 - s * (x * x + y * y)),
    )


def of_euler(degrees: Sequence[float]) -> Rotation:
    """Turned about the fixed axes x, then y, then z. Quarter turns are exact."""
    (cx, sx), (cy, sy), (cz, sz) = map(cosine_and_sine, degrees)
    return (
        *(cz * cy, cz * sy * sx - sz * cx, cz * sy * cx + sz * sx),
        *(sz * cy, sz * sy * sx + cz * cx, sz * sy * cx - cz * sx),
        *(0.0 - sy, cy * sx, cy * cx),  # not -0.0
    )


def quaternion_of_euler(degrees: Sequence[float]) -> Quaternion:
    """The same turn as a unit quaternion (w, x, y, z)."""
    (cx, sx), (cy, sy), (cz, sz) = (cosine_and_sine(angle / 2.0) for angle in degrees)
    return (
        cx * cy * cz + sx * sy * sz,
        sx * cy * cz - cx * sy * sz,
        cx * sy * cz + sx * cy * sz,
        cx * cy * sz - sx * sy * cz,
    )


def cosine_and_sine(degrees: float) -> tuple[float, float]:
    """Exact for multiples of a quarter turn."""
    if degrees % _QUARTER_TURN == 0.0:
        quarter = int(math.fmod(degrees, 4 * _QUARTER_TURN) / _QUARTER_TURN)
        return _COSINES[quarter % 4], _COSINES[(quarter - 1) % 4]
    angle = math.radians(math.fmod(degrees, 4 * _QUARTER_TURN))
    return math.cos(angle), math.sin(angle)
