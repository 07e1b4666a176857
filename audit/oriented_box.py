"""Oriented boxes for free: the file's own bounding box, carried by the body's transform.

No box is fitted to the vertices. Where a transform turns a body, its file box turns with it; where
it does not, the oriented box is the world box, which rung 0 has already tried.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from satcheck import core
from satcheck.audit.boxes import Box
from satcheck.audit.report import Vector
from satcheck.audit.tolerances import ORTHOGONALITY, rounding_pad
from satcheck.audit.vectors import dot

if TYPE_CHECKING:
    from satcheck.scene import Body

    RigidPose = tuple[float, float, float, float, float, float, float]
    PosedBox = tuple[core.Box, RigidPose]

Transform = tuple[float, ...]
IDENTITY: Transform = tuple(float(row == column) for row in range(4) for column in range(4))


@dataclass(frozen=True, slots=True)
class OrientedBox:
    """turned: not along the world's axes. posed: None where the transform shears."""

    turned: bool
    posed: PosedBox | None


def oriented_box(body: Body, pad: float) -> OrientedBox:
    """A box that holds every point within `pad` of the body."""
    transform = body.transform or IDENTITY
    posed = None
    if _is_orthogonal(transform):
        posed = _carried(body.file.mesh.bounds, transform, pad)
    return OrientedBox(not _keeps_axes(transform), posed)


def nothing_new(a: OrientedBox, b: OrientedBox) -> str:
    """Why these boxes say no more than the world boxes, where one shears or none is turned."""
    if a.turned or b.turned:
        return "a transform shears: the carried box is no box"
    return "neither body is turned: its oriented box is its world box"


def _column(transform: Transform, axis: int) -> Vector:
    return transform[axis], transform[4 + axis], transform[8 + axis]


def _keeps_axes(transform: Transform) -> bool:
    """Whether every column runs along one world axis."""
    return all(sum(c != 0 for c in _column(transform, axis)) == 1 for axis in range(3))


def _is_orthogonal(transform: Transform) -> bool:
    columns = [_column(transform, axis) for axis in range(3)]
    return all(
        abs(dot(columns[i], columns[j]))
        <= ORTHOGONALITY * math.hypot(*columns[i]) * math.hypot(*columns[j])
        for i, j in ((0, 1), (0, 2), (1, 2))
    )


def _carried(bounds: Box, transform: Transform, padding: float) -> PosedBox:
    low, high = bounds
    columns = [_column(transform, axis) for axis in range(3)]
    stretch = [math.hypot(*column) for column in columns]
    centre = [0.5 * low[axis] + 0.5 * high[axis] for axis in range(3)]
    half = [(0.5 * high[axis] - 0.5 * low[axis]) * stretch[axis] for axis in range(3)]
    terms = [
        [*(columns[axis][row] * centre[axis] for axis in range(3)), transform[4 * row + 3]]
        for row in range(3)
    ]
    origin = [math.fsum(row) for row in terms]
    reach = max(abs(term) for row in terms for term in row) + math.hypot(*half)
    pad = padding + rounding_pad(reach) + 4 * ORTHOGONALITY * math.hypot(*half)
    units = [tuple(c / stretch[axis] for c in columns[axis]) for axis in range(3)]
    quaternion = _quaternion(units[0], units[1], units[2])
    box = core.Box((half[0] + pad, half[1] + pad, half[2] + pad))
    return box, (origin[0], origin[1], origin[2], *quaternion)


def _quaternion(
    x: tuple[float, ...], y: tuple[float, ...], z: tuple[float, ...]
) -> tuple[float, float, float, float]:
    """(qx, qy, qz, qw) of the rotation with these columns; a mirrored one has its z turned round,
    which leaves a box about its centre as it is.

    Method: Stanley W. Shepperd, "Quaternion from Rotation Matrix" (1978): divide by the largest of
    the four candidates.
    """
    handed = (
        x[0] * (y[1] * z[2] - y[2] * z[1])
        - x[1] * (y[0] * z[2] - y[2] * z[0])
        + x[2] * (y[0] * z[1] - y[1] * z[0])
    )
    if handed < 0:
        z = (-z[0], -z[1], -z[2])
    squares = (
        1 + x[0] - y[1] - z[2],
        1 - x[0] + y[1] - z[2],
        1 - x[0] - y[1] + z[2],
        1 + x[0] + y[1] + z[2],
    )
    rows = (
        (squares[0], y[0] + x[1], z[0] + x[2], y[2] - z[1]),
        (y[0] + x[1], squares[1], z[1] + y[2], z[0] - x[2]),
        (z[0] + x[2], z[1] + y[2], squares[2], x[1] - y[0]),
        (y[2] - z[1], z[0] - x[2], x[1] - y[0], squares[3]),
    )
    row = rows[squares.index(max(squares))]
    length = math.hypot(*row)
    return row[0] / length, row[1] / length, row[2] / length, row[3] / length
