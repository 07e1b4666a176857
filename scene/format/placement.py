"""Reads a placement, by position, rotation and scale or as a matrix, into one transform."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence

from msgspec import UNSET

from satcheck.core.transform import (
    Quaternion,
    Rotation,
    Transform,
    about_fixed_axes,
    cos_sin,
    quaternion_matrix,
)
from satcheck.scene.format.document import Body, Row
from satcheck.scene.format.form import Wrong

# A matrix counts as singular if its determinant is smaller than this share of the product of its
# row lengths. Such a determinant may come from the rounding of the entries alone.
_SINGULAR = 2.0**-40

_NO_TURN: Rotation = (1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0)
_NO_SCALE = (1.0, 1.0, 1.0)
_ORIGIN = (0.0, 0.0, 0.0)


def placement(body: Body) -> Transform | None:
    """Scales first, then rotates, then translates; None if the body states none of it. Raises
    Wrong."""
    if body.matrix is not UNSET:
        return matrix(body.matrix, "matrix")
    if body.position is body.quaternion is body.euler is body.scale is UNSET:
        return None
    turn = _NO_TURN
    if body.quaternion is not UNSET:
        turn = quaternion_matrix(*quaternion(body.quaternion))
    elif body.euler is not UNSET:
        turn = euler_matrix(body.euler)
    position = _ORIGIN if body.position is UNSET else body.position
    if body.scale is UNSET:
        return moved(turn, _NO_SCALE, position)
    scale = body.scale if isinstance(body.scale, tuple) else (body.scale,) * 3
    if 0.0 in scale:
        raise Wrong("a scale must not be 0", "scale", code="singular-transform")
    return _regular(moved(turn, scale, position), "scale")


def moved(turn: Rotation, scale: Sequence[float], position: Sequence[float]) -> Transform:
    """world = turn * (scale * (x, y, z)) + position."""
    a, b, c = scale
    x, y, z = position
    return (
        *(turn[0] * a, turn[1] * b, turn[2] * c, x),
        *(turn[3] * a, turn[4] * b, turn[5] * c, y),
        *(turn[6] * a, turn[7] * b, turn[8] * c, z),
        *(0.0, 0.0, 0.0, 1.0),
    )


def matrix(rows: Iterable[Row], key: str) -> Transform:
    """An affine matrix that is not singular. Raises Wrong. key: of the rows."""
    return _regular(tuple(entry for row in rows for entry in row), key)


def _regular(transform: Transform, key: str) -> Transform:
    if (fault := singular(transform)) is not None:
        raise Wrong(fault, key, code="singular-transform")
    return transform


def singular(transform: Transform) -> str | None:
    """The reason why the matrix cannot place a body; None: it can. All entries are finite."""
    if transform[12:] != (0.0, 0.0, 0.0, 1.0):
        return "the last row should be 0 0 0 1"
    a, b, c, _, d, e, f, _, g, h, i, _ = transform[:12]
    length_x, length_y, length_z = math.hypot(a, b, c), math.hypot(d, e, f), math.hypot(g, h, i)
    if 0.0 in (length_x, length_y, length_z):
        return "singular transform: it scales by 0"
    a, b, c = a / length_x, b / length_x, c / length_x
    d, e, f = d / length_y, e / length_y, f / length_y
    g, h, i = g / length_z, h / length_z, i / length_z
    determinant = a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g)
    return "singular transform: it flattens space" if abs(determinant) < _SINGULAR else None


def quaternion(value: Row, *keys: str | int) -> Quaternion:
    """(x, y, z, w) from [w, x, y, z], the order of scene files; of any length except zero. Raises
    Wrong. keys: to the table that states it."""
    w, x, y, z = value
    if not any(value):
        raise Wrong("a quaternion must not be zero", *keys, "quaternion")
    return x, y, z, w


def euler_matrix(degrees: Sequence[float]) -> Rotation:
    """The rotation about the fixed axes x, then y, then z. Quarter turns are exact."""
    x, y, z = map(cos_sin, degrees)
    return about_fixed_axes(x, y, z)


def quaternion_of_euler(degrees: Sequence[float]) -> Quaternion:
    """The same rotation as a unit quaternion (x, y, z, w)."""
    (cx, sx), (cy, sy), (cz, sz) = (cos_sin(angle / 2.0) for angle in degrees)
    return (
        sx * cy * cz - cx * sy * sz,
        cx * sy * cz + sx * cy * sz,
        cx * cy * sz - sx * sy * cz,
        cx * cy * cz + sx * sy * sz,
    )
