"""A curved primitive in the world: a core shape, its pose, and what placing it may have rounded."""

from __future__ import annotations

import math

from msgspec import Struct
from msgspec.structs import replace

from satcheck import core
from satcheck.audit.bodies.boxes import Box
from satcheck.audit.tolerances import CHAIN_ROUNDOFFS, ORTHOGONALITY, UNIT_ROUNDOFF
from satcheck.scene.primitives import (
    Capsule,
    Cone,
    Cylinder,
    Ellipsoid,
    Primitive,
    Sphere,
)
from satcheck.scene.shape_image import UNTURNED, ShapeImage, image_of

Pose = tuple[float, ...]  # (tx, ty, tz, qx, qy, qz, qw)
Vector = tuple[float, float, float]
_NO_TURN = (0.0, 0.0, 0.0, 1.0)


class CurvedShape(Struct, frozen=True):
    """shape: in its own frame; pose: rigid. slack: no point of the body is farther from where the
    pose puts it than this, world units. primitive: the shape's sizes, scaling folded in. image:
    what the pose and the sizes are rounded from."""

    primitive: Primitive
    shape: core.Shape
    pose: Pose
    slack: float
    image: ShapeImage

    @property
    def centre(self) -> Vector:
        return self.pose[0], self.pose[1], self.pose[2]

    @property
    def inner_radius(self) -> float:
        """No more than that of a ball about the centre within the shape, world units."""
        return _inner_radius(self.primitive) - self.slack

    def at(self, by: Vector) -> ShapeImage:
        """The body, moved as a pose is: each coordinate of its origin is rounded once."""
        x, y, z = self.moved(by)[:3]
        return replace(self.image, origin=(x, y, z))

    def moved(self, by: Vector) -> Pose:
        return (*(c + d for c, d in zip(self.centre, by, strict=True)), *self.pose[3:])

    def bounds(self) -> Box:
        """A world box around the shape, by its support along each axis, rounded outward."""
        rows = rows_of(self.pose[3:])
        reach = [support(self.primitive, row) for row in rows]
        pads = [
            self.slack + CHAIN_ROUNDOFFS * UNIT_ROUNDOFF * (abs(c) + r)
            for c, r in zip(self.centre, reach, strict=True)
        ]
        # All of them but the cone are symmetric; the cone's base reaches as far on the other side.
        back = [support(self.primitive, (-x, -y, -z)) for x, y, z in rows]
        low = tuple(c - b - p for c, b, p in zip(self.centre, back, pads, strict=True))
        high = tuple(c + r + p for c, r, p in zip(self.centre, reach, pads, strict=True))
        return low, high  # type: ignore[return-value]


def curved_shape(primitive: Primitive, transform: tuple[float, ...] | None) -> CurvedShape:
    """The shape placed by a row-major 4x4; ValueError when its image is no such shape."""
    image = image_of(primitive, transform)
    columns, centre = image.columns, image.origin
    if transform is None:
        return CurvedShape(primitive, core_shape(primitive), (*centre, *_NO_TURN), 0.0, image)
    stretch = [math.hypot(*column) for column in columns]
    axes = [tuple(c / s for c in column) for column, s in zip(columns, stretch, strict=True)]
    skew = max(abs(sum(p * q for p, q in zip(axes[i], axes[j], strict=True))) for i, j in _PAIRS)
    if skew > ORTHOGONALITY:
        raise ValueError("a curved shape cannot be skewed")
    if _determinant(axes) < 0:  # every one of the shapes is its own image under x -> -x
        axes[0] = tuple(-c for c in axes[0])
    scaled = _scaled(primitive, stretch)
    turn = quaternion_of(axes[0], axes[1], axes[2])
    is_exact = stretch == [1.0, 1.0, 1.0] and tuple(axes) == UNTURNED
    rounding = CHAIN_ROUNDOFFS * UNIT_ROUNDOFF + 2 * ORTHOGONALITY * (skew > 0)
    slack = 0.0 if is_exact else rounding * _extent(scaled)
    return CurvedShape(scaled, core_shape(scaled), (*centre, *turn), slack, image)


_PAIRS = ((0, 1), (0, 2), (1, 2))


def core_shape(primitive: Primitive) -> core.Shape:
    match primitive:
        case Sphere(radius):
            return core.Sphere(radius)
        case Capsule(radius, length):
            return core.Capsule(radius, length / 2)
        case Cylinder(radius, height):
            return core.Cylinder(radius, height / 2)
        case Cone(radius, height):
            return core.Cone(radius, height / 2)
        case Ellipsoid(radii):
            return core.Ellipsoid(radii)
        case _:
            raise ValueError("a box is its mesh")


def support(primitive: Primitive, direction: Vector) -> float:
    """The largest product of the direction with a point of the shape, in its own frame."""
    x, y, z = direction
    across = math.hypot(x, y)
    match primitive:
        case Sphere(radius):
            return radius * math.hypot(x, y, z)
        case Capsule(radius, length):
            return radius * math.hypot(x, y, z) + length / 2 * abs(z)
        case Cylinder(radius, height):
            return radius * across + height / 2 * abs(z)
        case Cone(radius, height):
            return max(height / 2 * z, radius * across - height / 2 * z)
        case Ellipsoid((a, b, c)):
            return math.hypot(a * x, b * y, c * z)
        case _:
            raise ValueError("a box is its mesh")


def _inner_radius(primitive: Primitive) -> float:
    match primitive:
        case Cylinder(radius, height):
            return min(radius, height / 2)
        case Cone(radius, height):  # half way up, by the slope of its side
            return min(height / 2, radius / 2 * (height / math.hypot(radius, height)))
        case Ellipsoid(radii):
            return min(radii)
        case Sphere(radius) | Capsule(radius, _):
            return radius
        case _:
            raise ValueError("a box is its mesh")


def _extent(primitive: Primitive) -> float:
    return sum(support(primitive, axis) for axis in ((1.0, 0, 0), (0, 1.0, 0), (0, 0, -1.0)))


def _scaled(primitive: Primitive, by: list[float]) -> Primitive:
    a, b, c = by
    across = _same(a, b)
    evenly = across and _same(a, c)
    match primitive:
        case Sphere(radius) if not evenly:
            return Ellipsoid((radius * a, radius * b, radius * c))
        case Sphere(radius):
            return Sphere(radius * a)
        case Ellipsoid((x, y, z)):
            return Ellipsoid((x * a, y * b, z * c))
        case Capsule(radius, length) if evenly:
            return Capsule(radius * a, length * c)
        case Cylinder(radius, height) if across:
            return Cylinder(radius * a, height * c)
        case Cone(radius, height) if across:
            return Cone(radius * a, height * c)
    kind = type(primitive).__name__.lower()
    raise ValueError(f"a {kind} scaled unevenly is no {kind}")


def _same(a: float, b: float) -> bool:
    """Up to the rounding of the lengths of two columns."""
    return abs(a - b) <= CHAIN_ROUNDOFFS * UNIT_ROUNDOFF * max(a, b)


def _determinant(columns: list[tuple[float, ...]]) -> float:
    a, b, c = columns
    return (
        a[0] * (b[1] * c[2] - b[2] * c[1])
        - a[1] * (b[0] * c[2] - b[2] * c[0])
        + a[2] * (b[0] * c[1] - b[1] * c[0])
    )


def rows_of(quaternion: tuple[float, ...]) -> list[Vector]:
    """The rows of the rotation: world axes in the shape's frame."""
    x, y, z, w = quaternion
    return [
        (1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)),
        (2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)),
        (2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)),
    ]


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
