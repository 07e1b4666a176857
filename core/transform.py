"""Builds and composes the matrices of placements.

`core/native/mesh/transform.cpp` applies them to the vertices of meshes.

A rotation is nine entries, a placement sixteen, by rows, for column vectors, right-handed.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

from satcheck.core.conventions import Vector

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Poses = NDArray[np.float64]

Quaternion = tuple[float, float, float, float]  # x, y, z, w
Rotation = tuple[float, ...]
Transform = tuple[float, ...]


def cos_sin(degrees: float) -> tuple[float, float]:
    """(cosine, sine). Exact at multiples of 90, because full and quarter turns are removed without
    rounding."""
    turned = math.fmod(degrees, 360.0)
    rest = math.remainder(turned, 90.0)
    quarter = round((turned - rest) / 90.0) % 4
    cosine, sine = math.cos(math.radians(rest)), math.sin(math.radians(rest)) + 0.0
    return ((cosine, sine), (0.0 - sine, cosine), (-cosine, 0.0 - sine), (sine, -cosine))[quarter]


def quaternion_matrix(x: float, y: float, z: float, w: float) -> Rotation:
    """The rotation of a quaternion of any length except zero. It needs no root, so (s, 0, 0, s)
    gives an exact quarter turn."""
    largest = max(abs(x), abs(y), abs(z), abs(w))
    x, y, z, w = x / largest, y / largest, z / largest, w / largest
    s = 2.0 / (x * x + y * y + z * z + w * w)
    return (
        *(1.0 - s * (y * y + z * z), s * (x * y - w * z), s * (x * z + w * y)),
        *(s * (x * y + w * z), 1.0 - s * (x * x + z * z), s * (y * z - w * x)),
        *(s * (x * z - w * y), s * (y * z + w * x), 1.0 - s * (x * x + y * y)),
    )


def about_fixed_axes(
    x: tuple[float, float], y: tuple[float, float], z: tuple[float, float]
) -> Rotation:
    """The rotation about the fixed axes x, then y, then z; each angle is given as (cosine,
    sine)."""
    (cx, sx), (cy, sy), (cz, sz) = x, y, z
    return (
        *(cz * cy, cz * sy * sx - sz * cx, cz * sy * cx + sz * sx),
        *(sz * cy, sz * sy * sx + cz * cx, sz * sy * cx - cz * sx),
        *(0.0 - sy, cy * sx, cy * cx),  # not -0.0
    )


def about(axis: Vector, angle: tuple[float, float]) -> Rotation:
    """The rotation about a unit axis; the angle is (cosine, sine). Formula: Rodrigues (1840).

    Entries are exactly 0 or 1 where they should be if the axis is an axis of the frame.
    """
    x, y, z = axis
    c, s = angle
    t = 1.0 - c
    return (
        *(x * x + c * (1.0 - x * x), t * x * y - s * z, t * x * z + s * y),
        *(t * x * y + s * z, y * y + c * (1.0 - y * y), t * y * z - s * x),
        *(t * x * z - s * y, t * y * z + s * x, z * z + c * (1.0 - z * z)),
    )


def compose(outer: Transform, inner: Transform) -> Transform:
    """The matrix product: first `inner`, then `outer`; both affine.

    Each entry is summed from left to right in float64, so that it is the same everywhere.
    """
    columns = [inner[column:12:4] for column in range(4)]
    rows: list[float] = []
    for row in (outer[0:4], outer[4:8], outer[8:12]):
        entries = [row[0] * x + row[1] * y + row[2] * z for x, y, z in columns]
        rows += [*entries[:3], entries[3] + row[3]]
    return (*rows, 0.0, 0.0, 0.0, 1.0)


def within(outer: Poses, inner: Poses) -> Poses:
    """Return many placements in the frames of others, to the bits of `compose`, shape (3, 4, n) or
    (3, 4, 1)."""
    poses: Poses = outer[:, 0:1] * inner[0] + outer[:, 1:2] * inner[1] + outer[:, 2:3] * inner[2]
    poses[:, 3] += outer[:, 3]
    return poses


def placed(rotation: Sequence[float], origin: Sequence[float]) -> Transform:
    """The placement that rotates, then translates to `origin`."""
    return (
        *(*rotation[0:3], origin[0]),
        *(*rotation[3:6], origin[1]),
        *(*rotation[6:9], origin[2]),
        *(0.0, 0.0, 0.0, 1.0),
    )
