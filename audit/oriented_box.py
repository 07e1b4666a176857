"""Oriented boxes for free: the file's own bounding box, carried by the body's transform.

No box is fitted to the vertices. Where a transform turns a body, its file box turns with it; where
it does not, the oriented box is the world box, which rung 0 has already tried.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from satcheck import core
from satcheck.audit.tolerances import ORTHOGONALITY, rounding_pad
from satcheck.core.frozen import frozen
from satcheck.scene.bodies import IDENTITY

if TYPE_CHECKING:
    from satcheck.scene import Body

    RigidPose = tuple[float, float, float, float, float, float, float]
    PosedBox = tuple[core.Box, RigidPose]


@frozen
class OrientedBox:
    """turned: not along the world's axes. posed: None where the transform shears."""

    turned: bool
    posed: PosedBox | None


def oriented_box(body: Body, pad: float) -> OrientedBox:
    """A box that holds every point within `pad` of the body."""
    transform = body.transform or IDENTITY
    # Spelled out number by number: a scene asks for one of these for each of its bodies.
    a, b, c, x, d, e, f, y, g, h, i, z = transform[:12]
    turned = not _keeps_axes(a, b, c, d, e, f, g, h, i)
    p, q, r = math.hypot(a, d, g), math.hypot(b, e, h), math.hypot(c, f, i)
    is_orthogonal = (
        abs(a * b + d * e + g * h) <= ORTHOGONALITY * p * q
        and abs(a * c + d * f + g * i) <= ORTHOGONALITY * p * r
        and abs(b * c + e * f + h * i) <= ORTHOGONALITY * q * r
    )
    if not is_orthogonal:
        return OrientedBox(turned, None)
    (x0, y0, z0), (x1, y1, z1) = body.file.mesh.bounds
    u, v, w = 0.5 * x0 + 0.5 * x1, 0.5 * y0 + 0.5 * y1, 0.5 * z0 + 0.5 * z1
    half = ((0.5 * x1 - 0.5 * x0) * p, (0.5 * y1 - 0.5 * y0) * q, (0.5 * z1 - 0.5 * z0) * r)
    rows = ((a * u, b * v, c * w, x), (d * u, e * v, f * w, y), (g * u, h * v, i * w, z))
    radius = math.hypot(*half)
    reach = max(map(abs, (*rows[0], *rows[1], *rows[2]))) + radius
    pad += rounding_pad(reach) + 4 * ORTHOGONALITY * radius
    turn = quaternion_of((a / p, d / p, g / p), (b / q, e / q, h / q), (c / r, f / r, i / r))
    box = core.Box((half[0] + pad, half[1] + pad, half[2] + pad))
    return OrientedBox(turned, (box, (sum(rows[0]), sum(rows[1]), sum(rows[2]), *turn)))


def nothing_new(a: OrientedBox, b: OrientedBox) -> str:
    """Why these boxes say no more than the world boxes, where one shears or none is turned."""
    if a.turned or b.turned:
        return "a transform shears: the carried box is no box"
    return "neither body is turned: its oriented box is its world box"


def _keeps_axes(*m: float) -> bool:
    """Whether every column of the 3 x 3 matrix, given row by row, runs along one world axis."""
    return all((m[k] != 0) + (m[3 + k] != 0) + (m[6 + k] != 0) == 1 for k in range(3))


def quaternion_of(
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
