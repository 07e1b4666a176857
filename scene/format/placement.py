"""Reads a placement, by position, rotation and scale or as a matrix, into one transform."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from satcheck.core.conventions import Vector
from satcheck.core.transform import (
    Quaternion,
    Rotation,
    Transform,
    about_fixed_axes,
    cos_sin,
    quaternion_matrix,
)
from satcheck.scene.format.problems import Wrong
from satcheck.scene.format.table import Table
from satcheck.scene.format.values import (
    items,
    number,
    numbers,
    quadruple,
    shown,
    triple,
)

# A matrix counts as singular if its determinant is smaller than this share of the product of its
# row lengths. Such a determinant may come from the rounding of the entries alone.
_SINGULAR = 2.0**-40

_TURNS = ("quaternion", "euler")
PARTS = ("position", *_TURNS, "scale")
KEYS = frozenset((*PARTS, "matrix"))

_NO_TURN: Rotation = (1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0)
_NO_SCALE = (1.0, 1.0, 1.0)
_ORIGIN = (0.0, 0.0, 0.0)


def placement(table: Table) -> Transform | None:
    """Scales first, then rotates, then translates; None if the table has no such keys."""
    if table.values.keys().isdisjoint(KEYS):
        return None
    if "matrix" in table:
        for key in PARTS:
            if key in table:
                table.wrong("the matrix already places the body: remove this key", key)
        return table.read("matrix", matrix, None)
    if all(key in table for key in _TURNS):
        table.wrong("the quaternion already sets the rotation: remove this key", "euler")
    x, y, z = table.read("position", triple, _ORIGIN)
    turn = table.read("quaternion", _quaternion, None) or table.read("euler", _euler, _NO_TURN)
    scale = table.read("scale", _scale, _NO_SCALE)
    made = moved(turn, scale, (x, y, z))
    if scale is not _NO_SCALE and (fault := singular(made)) is not None:
        table.wrong(fault, "scale", code="singular-transform")
    return made


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


def matrix(rows: Any) -> Transform:
    """Four rows of four numbers, affine and not singular. Raises Wrong, which names the first entry
    that is not a finite number."""
    if not isinstance(rows, list) or [_length(row) for row in rows] != [4, 4, 4, 4]:
        raise Wrong(f"4 rows of 4 numbers expected, not {shown(rows)}")
    entries = numbers([entry for row in rows for entry in row])
    if entries is None:
        entries = [value for row in items(rows, lambda row: items(row, number)) for value in row]
    transform = tuple(entries)
    if (fault := singular(transform)) is not None:
        raise Wrong(fault, code="singular-transform")
    return transform


def _length(row: Any) -> int:
    return len(row) if isinstance(row, list) else -1


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


def quaternion(value: Any) -> Quaternion:
    """(x, y, z, w) from [w, x, y, z], the order of scene files; of any length except zero."""
    w, x, y, z = quadruple(value)
    if not any((w, x, y, z)):
        raise Wrong("a quaternion must not be zero")
    return x, y, z, w


def _quaternion(value: Any) -> Rotation:
    return quaternion_matrix(*quaternion(value))


def _euler(value: Any) -> Rotation:
    return euler_matrix(triple(value))


def _scale(value: Any) -> Vector:
    factors = triple(value) if isinstance(value, list) else (number(value),) * 3
    if 0.0 in factors:
        raise Wrong("a scale must not be 0", code="singular-transform")
    return factors


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
