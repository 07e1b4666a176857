"""Rotations: about an axis by degrees, and between two orientations.

Rotations are 3x3 matrices in rows, right-handed; quaternions are (x, y, z, w) of any length except
0. Quarter turns about a coordinate axis are exact.
"""

from __future__ import annotations

import math

from satcheck.core import transform
from satcheck.core.conventions import Vector
from satcheck.core.transform import about, cos_sin

Quaternion = tuple[float, float, float, float]
Matrix = tuple[Vector, Vector, Vector]

STILL: Matrix = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
_X: Vector = (1.0, 0.0, 0.0)


def rotation(axis: Vector, degrees: float) -> Matrix:
    """The rotation about a unit axis."""
    return _rows(about(axis, cos_sin(degrees)))


def unit(v: Vector) -> Vector:
    """The unit vector along v, which is not zero; safe for very large and very small v."""
    largest = max(abs(c) for c in v)
    small = (v[0] / largest, v[1] / largest, v[2] / largest)
    length = math.hypot(*small)
    return small[0] / length, small[1] / length, small[2] / length


def applied(m: Matrix, v: Vector) -> Vector:
    return (
        math.fsum(m[0][k] * v[k] for k in range(3)),
        math.fsum(m[1][k] * v[k] for k in range(3)),
        math.fsum(m[2][k] * v[k] for k in range(3)),
    )


def product(m: Matrix, n: Matrix) -> Matrix:
    """The product m n: first n, then m."""
    columns = tuple(zip(*n, strict=True))
    return tuple(  # type: ignore[return-value]
        tuple(math.fsum(a * b for a, b in zip(row, column, strict=True)) for column in columns)
        for row in m
    )


def quaternion_matrix(q: Quaternion) -> Matrix:
    return _rows(transform.quaternion_matrix(*q))


def between(start: Quaternion, end: Quaternion) -> tuple[Vector, float]:
    """Unit axis (world) and degrees, 0 to 180, of the shortest turn from one orientation to the
    other. For half a turn the signs of the quaternions choose the axis."""
    p, q = _unit_quaternion(start), _unit_quaternion(end)
    if math.fsum(a * b for a, b in zip(p, q, strict=True)) < 0:
        q = (-q[0], -q[1], -q[2], -q[3])
    return axis_angle(_times(q, (-p[0], -p[1], -p[2], p[3])))


def axis_angle(q: Quaternion) -> tuple[Vector, float]:
    """The axis and angle of a unit quaternion; degrees from 0 to 360."""
    sine = math.hypot(q[0], q[1], q[2])
    if sine == 0.0:
        return _X, 0.0
    return unit((q[0], q[1], q[2])), math.degrees(2.0 * math.atan2(sine, q[3]))


def _unit_quaternion(q: Quaternion) -> Quaternion:
    largest = max(abs(c) for c in q)
    small = [c / largest for c in q]
    length = math.hypot(*small)
    return small[0] / length, small[1] / length, small[2] / length, small[3] / length


def _rows(m: transform.Rotation) -> Matrix:
    return (m[0], m[1], m[2]), (m[3], m[4], m[5]), (m[6], m[7], m[8])


def _times(p: Quaternion, q: Quaternion) -> Quaternion:
    """The Hamilton product: the turn q, then p."""
    px, py, pz, pw = p
    qx, qy, qz, qw = q
    return (
        math.fsum((pw * qx, px * qw, py * qz, -pz * qy)),
        math.fsum((pw * qy, -px * qz, py * qw, pz * qx)),
        math.fsum((pw * qz, px * qy, -py * qx, pz * qw)),
        math.fsum((pw * qw, -px * qx, -py * qy, -pz * qz)),
    )
