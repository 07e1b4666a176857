"""Rotations as people write them in a scene file, in degrees."""

from __future__ import annotations

from collections.abc import Sequence

from satcheck.core.transform import Rotation, about_fixed_axes, cos_sin

Quaternion = tuple[float, float, float, float]  # (x, y, z, w)


def of_euler(degrees: Sequence[float]) -> Rotation:
    """Turned about the fixed axes x, then y, then z. Quarter turns are exact."""
    x, y, z = map(cos_sin, degrees)
    return about_fixed_axes(x, y, z)


def quaternion_of_euler(degrees: Sequence[float]) -> Quaternion:
    """The same turn as a unit quaternion (x, y, z, w)."""
    (cx, sx), (cy, sy), (cz, sz) = (cos_sin(angle / 2.0) for angle in degrees)
    return (
        sx * cy * cz - cx * sy * sz,
        cx * sy * cz + sx * cy * sz,
        cx * cy * sz - sx * sy * cz,
        cx * cy * cz + sx * sy * sz,
    )
