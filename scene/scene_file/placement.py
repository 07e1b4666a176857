"""Where the bodies of a scene file are, and how they move.

A placement, by position, rotation and scale or as a matrix, becomes one transform.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from itertools import pairwise

from msgspec import UNSET

from satcheck.core.errors import SatcheckError
from satcheck.core.transform import (
    Quaternion,
    Transform,
    about_fixed_axes,
    cos_sin,
    quaternion_matrix,
)
from satcheck.core.transform import Rotation as RotationMatrix
from satcheck.scene.document import Item
from satcheck.scene.motion import (
    NO_TURN,
    Motion,
    Path,
    PosePath,
    Rotation,
    Translation,
    Waypoint,
)
from satcheck.scene.rules import Selector
from satcheck.scene.scene_file import document
from satcheck.scene.scene_file.document import Body, Row
from satcheck.scene.scene_file.form import Wrong, shown

# A matrix counts as singular if its determinant is smaller than this share of the product of its
# row lengths. Such a determinant may come from the rounding of the entries alone.
_SINGULAR = 2.0**-40

_STRAIGHT: RotationMatrix = (1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0)
_NO_SCALE = (1.0, 1.0, 1.0)
_ORIGIN = (0.0, 0.0, 0.0)
_HALF_TURN = 180.0


def placement(body: Body) -> Transform | None:
    """Scales first, then rotates, then translates; None if the body states none of it. Raises
    Wrong."""
    if body.matrix is not UNSET:
        return matrix(body.matrix, "matrix")
    if body.position is body.quaternion is body.euler is body.scale is UNSET:
        return None
    turn = _STRAIGHT
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


def moved(turn: RotationMatrix, scale: Sequence[float], position: Sequence[float]) -> Transform:
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


def euler_matrix(degrees: Sequence[float]) -> RotationMatrix:
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


def selector(text: str, *keys: str | int) -> Selector:
    """keys: to the text, for the error. Raises Wrong."""
    try:
        return Selector(text)
    except SatcheckError as error:
        raise Wrong(error.message, *keys, code=error.code) from None


def motion_of(
    table: document.Motion, number: int, bodies: Sequence[Item] | None, moved: dict[str, int]
) -> list[Motion]:
    """The motion, if the bodies of the scene are known. Raises Wrong and SatcheckError.

    moved: id of each moving body -> number of its motion; this call adds to it.
    """
    path = _path(table)
    if isinstance(table.bodies, str):
        choices = [selector(table.bodies, "bodies")]
    else:
        choices = [selector(text, "bodies", k) for k, text in enumerate(table.bodies)]
    if bodies is None:
        return []
    ids: dict[str, None] = {}
    for choice in choices:
        chosen = choice.select(bodies)
        if not chosen:
            raise _refused(f"no body matches {shown(choice.text)}")
        for body in chosen:
            if body.static:
                raise _refused(f"body {shown(body.id)} is static")
            ids[body.id] = None
    for id_ in ids:
        if (other := moved.setdefault(id_, number)) != number:
            raise _refused(f"body {shown(id_)} is moved by motion[{other}] already")
    return [Motion(tuple(ids), path, table.clear)]


def _refused(message: str) -> Wrong:
    return Wrong(message, "bodies", code="bad-motion")


def _path(table: document.Motion) -> Path:
    if table.translation is not UNSET:
        return Translation(table.translation)
    if (turn := table.rotation) is not UNSET:
        return Rotation(turn.point, turn.axis, turn.degrees)
    points = table.path or ()
    for k, (before, after) in enumerate(pairwise(points), 1):
        if before.quaternion is after.quaternion is UNSET and _turns_far(before, after):
            message = "more than half a turn from the pose before: give a pose between"
            raise Wrong(message, "path", k, "euler")
    return PosePath(
        tuple(Waypoint(p.time, p.position, _orientation(p, k)) for k, p in enumerate(points))
    )


def _turns_far(before: document.Waypoint, after: document.Waypoint) -> bool:
    """Whether an angle changes by more than half a turn: a body takes the shortest turn, which may
    differ from what the angles mean."""
    start, end = before.euler or _ORIGIN, after.euler or _ORIGIN
    return any(abs(b - a) > _HALF_TURN for a, b in zip(start, end, strict=True))


def _orientation(point: document.Waypoint, number: int) -> Quaternion:
    if point.quaternion is not UNSET:
        return quaternion(point.quaternion, "path", number)
    return NO_TURN if point.euler is UNSET else quaternion_of_euler(point.euler)
